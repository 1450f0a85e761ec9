// SPDX-License-Identifier: BSD-3-Clause
/**
 * The hierarchy: every closed surface has the right number of components and handles and no border,
 * whatever the choice of points, the lattice, the number of levels and the rows that normals give.
 * TestSurfaceReconstruction has the same with nothing set.
 */
#include "IPIATestShapes.h"
#include "IPIATestTopology.h"
#include "IPIATestUtilities.h"

#include <functional>

namespace
{
using ipiatest::Checks;
using ipiatest::Text;

/// What is set on the fitter.
struct Setting
{
  std::string Name;
  std::function<void(vtkIPIAImplicitFitter*)> Apply;
};

/// Sizes with the number of levels that they have by themselves, and one more. With fewer levels
/// the coarsest lattice does not carry the sides of the surface into the whole volume: a known
/// limit.
std::vector<Setting> Settings()
{
  std::vector<Setting> settings;
  for (auto size : { std::make_pair(24, 2), std::make_pair(48, 3), std::make_pair(70, 4) })
  {
    const auto withSize = [&](const std::string& name, auto apply)
    {
      settings.push_back({ Text(size.first, "^3", name),
        [=](vtkIPIAImplicitFitter* fitter)
        {
          fitter->SetGridSize(size.first, size.first, size.first);
          apply(fitter);
        } });
    };
    withSize("", [](auto*) {});
    withSize(", two-sided offsets", [](auto* f) { f->SetNormalConstraintToTwoSidedOffset(); });
    withSize(", outward offsets", [](auto* f) { f->SetNormalConstraintToOutwardOffset(); });
    withSize(Text(", ", size.second + 1, " levels"),
      [=](auto* f) { f->SetNumberOfLevels(size.second + 1); });
  }
  return settings;
}

void TestSurface(
  Checks& checks, const ipiatest::KnownSurface& surface, const std::vector<Setting>& settings)
{
  auto cloud = ipiatest::ToPolyData(surface.Cloud);
  for (const Setting& setting : settings)
  {
    vtkNew<vtkIPIAImplicitFitter> fitter;
    fitter->SetInputData(cloud);
    setting.Apply(fitter);
    checks.Equal(ipiatest::TopologyOf(ipiatest::ZeroSurface(fitter)),
      ipiatest::Topology{ surface.Components, surface.Genus, 0, 0 },
      Text(surface.Name, ", ", surface.Cloud.Positions.size(), " points, ", setting.Name));
  }
}
}

int TestImplicitFitterHierarchy(int, char*[])
{
  Checks checks;
  const auto settings = Settings();
  for (auto choice : { ipiatest::Choice::Even, ipiatest::Choice::Random })
  {
    for (const auto& surface : ipiatest::KnownSurfaces(10000, choice))
    {
      TestSurface(checks, surface, settings);
    }
  }
  return checks.Result();
}
