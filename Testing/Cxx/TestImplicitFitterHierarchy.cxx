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

/// Sizes with the number of levels that they have by themselves, down to one and one more.
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
    for (int levels = 1; levels <= size.second + 1; ++levels)
    {
      withSize(Text(", ", levels, " levels"), [=](auto* f) { f->SetNumberOfLevels(levels); });
    }
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
