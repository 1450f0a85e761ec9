// SPDX-License-Identifier: BSD-3-Clause
/**
 * What the filter for fair surfaces refuses and warns of: what both filters do, and grids.
 */
#include "IPIATestFairingRefusals.h"

namespace
{
using ipiatest::CheckRefused;
using ipiatest::Checks;
using ipiatest::NaN;
using ipiatest::SurfaceFilter;
using ipiatest::Vector3;

void TestGrids(Checks& checks)
{
  const auto refused = [&](const std::string& phrase, vtkDataObject* data,
                         const std::function<void(SurfaceFilter)>& more = {})
  {
    CheckRefused<SurfaceFilter>(checks, phrase, phrase,
      [&](SurfaceFilter f)
      {
        f->SetInputDataObject(data);
        if (more)
        {
          more(f);
        }
      });
  };
  refused("needs 16 at least", ipiatest::WavyGrid(3, 3));
  refused("The grid has 3 points along v", ipiatest::WavyGrid(20, 3));
  refused("NumberOfControlPoints along u is 21", ipiatest::WavyGrid(20, 20),
    [](SurfaceFilter f) { f->SetNumberOfControlPoints(21, 5); });
  refused("NumberOfControlPoints along v is -3", ipiatest::WavyGrid(20, 20),
    [](SurfaceFilter f) { f->SetNumberOfControlPoints(5, -3); });
  refused("whose points have no order", ipiatest::ToLine(ipiatest::WavePoints(30)));
  auto solid = ipiatest::WavyGrid(20, 20);
  solid->SetDimensions(10, 10, 4);
  refused("has dimensions (10, 10, 4)", solid);
  for (const int n : { 10, 30, 30000 })
  {
    auto other = ipiatest::WavyGrid(20, 20);
    other->SetDimensions(n, n, 1);
    refused("and 400 points", other);
    refused("and 400 points", other, [](SurfaceFilter f) { f->SetParametrizationToGiven(); });
  }
  auto bad = ipiatest::WavyGrid(20, 20);
  bad->GetPoints()->SetPoint(77, NaN, 0, 0);
  refused("Point 77 is not finite", bad);
  refused("points of lines 4 and 5",
    ipiatest::ToGrid(20, 20,
      [](double u, double v) {
        return Vector3{ std::abs(u - 5.0 / 19) < 1e-9 ? 4.0 / 19 : u, v, 0 };
      }));
  refused("points are equal",
    ipiatest::ToGrid(20, 20,
      [](double, double) {
        return Vector3{ 1, 2, 3 };
      }));
  refused("The knot 0 cannot be inserted", ipiatest::WavyGrid(20, 20),
    [](SurfaceFilter f) { f->InsertKnot(1, 0); });

  const auto given = [&](const std::string& phrase, double u, double v)
  {
    refused(phrase, ipiatest::WavyGrid(10, 10),
      [&](SurfaceFilter f)
      {
        auto* data = vtkDataSet::SafeDownCast(f->GetInputDataObject(0, 0));
        vtkNew<vtkDoubleArray> uv;
        uv->SetNumberOfComponents(2);
        for (int k = 0; k < 100; ++k)
        {
          uv->InsertNextTuple2(k % 10 / 9.0, k / 10 / 9.0);
        }
        uv->SetTuple2(55, u, v);
        data->GetPointData()->SetTCoords(uv);
        f->SetParametrizationToGiven();
      });
  };
  given("The parameter u of point 55 is 1.2", 1.2, 0.5);
  given("The parameter v of point 55 is -0.1", 0.5, -0.1);
  given("The parameter v of point 55 is nan", 0.5, NaN);
  refused("more than 4 times the 400 points", ipiatest::WavyGrid(20, 20),
    [](SurfaceFilter f)
    {
      auto* data = vtkDataSet::SafeDownCast(f->GetInputDataObject(0, 0));
      vtkNew<vtkDoubleArray> uv;
      uv->SetNumberOfComponents(2);
      for (int k = 0; k < 400; ++k)
      {
        uv->InsertNextTuple2(k % 20 / 19.0, k / 20 / 19.0);
      }
      data->GetPointData()->SetTCoords(uv);
      f->SetParametrizationToGiven();
      f->SetNumberOfControlPoints(2000000000, 100000);
    });
}
}

int TestFairingPIASurfaceRefusals(int, char*[])
{
  Checks checks;
  vtkNew<ipiatest::MessageObserver> window;
  ipiatest::WindowWatch watch(window);
  ipiatest::TestSharedRefusals<SurfaceFilter>(
    checks, "surface", ipiatest::WavyGrid(3, 3), ipiatest::WavyGrid(31, 17));
  TestGrids(checks);
  return checks.Result();
}
