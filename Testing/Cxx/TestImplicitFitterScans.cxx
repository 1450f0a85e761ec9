// SPDX-License-Identifier: BSD-3-Clause
/**
 * Scanned models at 70^3 with 100 classic iterations are one component, for both
 * kinds of offset rows.
 */
#include "IPIATestScans.h"
#include "IPIATestTopology.h"
#include "IPIATestUtilities.h"

int TestImplicitFitterScans(int argc, char* argv[])
{
  ipiatest::Checks checks;
  for (const char* name : { "bunny00", "elephant", "refined_elephant", "armadillo" })
  {
    auto cloud = ipiatest::ReadScan(ipiatest::ScanFolder(argc, argv), name);
    if (!checks.That(cloud->GetNumberOfPoints() > 0, ipiatest::Text(name, " is read")))
    {
      continue;
    }
    for (int constraint :
      { vtkIPIAImplicitFitter::OutwardOffset, vtkIPIAImplicitFitter::TwoSidedOffset })
    {
      auto fitter = ipiatest::NewClassicFitter(cloud, 70);
      fitter->SetNormalConstraint(constraint);
      fitter->SetMaximumNumberOfIterations(100);
      auto surface = ipiatest::ZeroSurface(fitter);
      checks.Equal(ipiatest::CountComponents(surface), 1,
        ipiatest::Text(name, ", constraint ", constraint, ": components"));
      std::cout << name << ", constraint " << constraint << ": " << ipiatest::TopologyOf(surface)
                << "\n";
    }
  }
  return checks.Result();
}
