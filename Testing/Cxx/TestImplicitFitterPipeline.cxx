// SPDX-License-Identifier: BSD-3-Clause
/**
 * The fitter in a pipeline: nothing set and one Update() at the end, changed input, time steps,
 * extents, each port alone, what makes it fit anew and what does not.
 */
#include "IPIATestPipeline.h"

#include "vtkContourFilter.h"
#include "vtkFlyingEdges2D.h"
#include "vtkIPIAImplicitFunction.h"

#include <functional>
#include <utility>

namespace
{
using ipiatest::Checks;
using ipiatest::CheckSphere;
using ipiatest::NewClassicFitter;
using ipiatest::SphereCloud;
using ipiatest::Text;
using ipiatest::TimedSphere;

void TestNothingSet(Checks& checks)
{
  vtkNew<vtkIPIAImplicitFitter> fitter;
  fitter->SetInputData(SphereCloud());
  vtkNew<vtkFlyingEdges3D> surface;
  surface->SetInputConnection(fitter->GetOutputPort());
  surface->SetValue(0, 0.0);
  vtkNew<ipiatest::MessageObserver> messages;
  messages->Watch(fitter);
  messages->Watch(surface);
  surface->Update();
  CheckSphere(checks, surface->GetOutput(), 1, 0, "nothing set");
  messages->CheckSilence(checks, "nothing set");

  fitter->SetInputData(SphereCloud(900, 50, { 1000, 0, 0 }));
  surface->Update();
  CheckSphere(checks, surface->GetOutput(), 50, 1000, "bigger and moved input");
  messages->CheckSilence(checks, "bigger and moved input");
}

void TestNothingSetInThePlane(Checks& checks)
{
  auto cloud = ipiatest::ToPolyData(ipiatest::PointsOn(ipiatest::Circle(1), 100));
  vtkNew<vtkIPIAImplicitFitter> fitter;
  fitter->SetInputData(cloud);
  vtkNew<vtkFlyingEdges2D> curve;
  curve->SetInputConnection(fitter->GetOutputPort());
  curve->SetValue(0, 0.0);
  curve->Update();
  checks.Equal(ipiatest::CountComponents(curve->GetOutput()), 1, "nothing set in 2-D: loops");
  checks.That(ipiatest::IsClosedCurve(curve->GetOutput()), "nothing set in 2-D: closed");
}

/// The input's own points are edited in place.
void TestEditedInput(Checks& checks)
{
  auto cloud = SphereCloud();
  vtkNew<vtkIPIAImplicitFitter> fitter;
  fitter->SetInputData(cloud);
  vtkNew<vtkFlyingEdges3D> surface;
  surface->SetInputConnection(fitter->GetOutputPort());
  surface->SetValue(0, 0.0);
  surface->Update();
  for (vtkIdType i = 0; i < cloud->GetNumberOfPoints(); ++i)
  {
    double x[3];
    cloud->GetPoint(i, x);
    cloud->GetPoints()->SetPoint(i, 2 * x[0] + 5, 2 * x[1], 2 * x[2]);
  }
  cloud->GetPoints()->Modified();
  surface->Update();
  CheckSphere(checks, surface->GetOutput(), 2, 5, "points edited in place");
}

template <typename Contour>
void TestTimeSteps(Checks& checks)
{
  vtkNew<TimedSphere> source;
  vtkNew<vtkIPIAImplicitFitter> fitter;
  fitter->SetInputConnection(source->GetOutputPort());
  vtkNew<Contour> surface;
  surface->SetInputConnection(fitter->GetOutputPort());
  surface->SetValue(0, 0.0);
  ipiatest::CheckTimeSteps(checks, source, fitter, surface);
}

void TestTimeStepsOfTheFitter(Checks& checks)
{
  vtkNew<TimedSphere> source;
  vtkNew<vtkIPIAImplicitFitter> fitter;
  fitter->SetInputConnection(source->GetOutputPort());
  for (double time : { 2., 0., 1. })
  {
    fitter->UpdateTimeStep(time);
    checks.AtMost(std::abs(fitter->GetOutput()->GetCenter()[0] - 3 * time), 0.2 * (1 + time),
      Text("time ", time, ": distance of the centre of the image from that of the sphere"));
  }
}

void CheckAnnounced(Checks& checks, vtkIPIAImplicitFitter* fitter, const std::string& what)
{
  vtkInformation* info = fitter->GetOutputInformation(0);
  int extent[6];
  double origin[3], spacing[3];
  info->Get(vtkStreamingDemandDrivenPipeline::WHOLE_EXTENT(), extent);
  info->Get(vtkDataObject::ORIGIN(), origin);
  info->Get(vtkDataObject::SPACING(), spacing);
  vtkImageData* image = fitter->GetOutput();
  checks.That(std::equal(extent, extent + 6, image->GetExtent()), what + ": announced extent");
  checks.That(std::equal(origin, origin + 3, image->GetOrigin()), what + ": announced origin");
  checks.That(std::equal(spacing, spacing + 3, image->GetSpacing()), what + ": announced spacing");

  info = fitter->GetOutputInformation(2);
  info->Get(vtkStreamingDemandDrivenPipeline::WHOLE_EXTENT(), extent);
  info->Get(vtkDataObject::ORIGIN(), origin);
  info->Get(vtkDataObject::SPACING(), spacing);
  vtkImageData* lattice = ipiatest::ControlLattice(fitter);
  checks.That(std::equal(extent, extent + 6, lattice->GetExtent()) &&
      std::equal(origin, origin + 3, lattice->GetOrigin()) &&
      std::equal(spacing, spacing + 3, lattice->GetSpacing()),
    what + ": announced control lattice");
}

void TestAnnouncedIsDelivered(Checks& checks)
{
  vtkNew<vtkIPIAImplicitFitter> fitter;
  fitter->SetInputData(SphereCloud());
  fitter->Update();
  CheckAnnounced(checks, fitter, "automatic");
  fitter->SetGridSize(13, 0, 9);
  fitter->Update();
  CheckAnnounced(checks, fitter, "GridSize (13, 0, 9)");
  fitter->SetSampleDimensions(7, 0, 31);
  fitter->Update();
  CheckAnnounced(checks, fitter, "SampleDimensions (7, 0, 31)");
  fitter->SetModelBounds(-2, 2, -1.5, 1.25, -1.1, 3);
  fitter->Update();
  CheckAnnounced(checks, fitter, "ModelBounds");
  checks.Equal(fitter->GetOutput()->GetBounds()[3], 1.25, "upper bound along y");
  fitter->SetInputData(ipiatest::ToPolyData(ipiatest::PointsOn(ipiatest::Circle(1), 100)));
  fitter->Update();
  CheckAnnounced(checks, fitter, "planar input");
}

/// The value of every point of a part is, bit for bit, that of the same point of the whole.
bool IsPartOf(vtkImageData* part, vtkImageData* whole)
{
  const int* e = part->GetExtent();
  for (int z = e[4]; z <= e[5]; ++z)
  {
    for (int y = e[2]; y <= e[3]; ++y)
    {
      for (int x = e[0]; x <= e[1]; ++x)
      {
        if (part->GetScalarComponentAsDouble(x, y, z, 0) !=
          whole->GetScalarComponentAsDouble(x, y, z, 0))
        {
          return false;
        }
      }
    }
  }
  return true;
}

void TestSubExtents(Checks& checks, vtkPolyData* cloud, const int dimensions[3])
{
  vtkNew<vtkIPIAImplicitFitter> fitter;
  fitter->SetInputData(cloud);
  fitter->SetSampleDimensions(dimensions[0], dimensions[1], dimensions[2]);
  fitter->SetOutputScalarTypeToDouble();
  fitter->Update();
  vtkNew<vtkImageData> whole;
  whole->DeepCopy(fitter->GetOutput());
  const int* d = whole->GetDimensions();
  const int extents[][6] = {
    { 0, d[0] - 1, 0, d[1] - 1, 0, d[2] - 1 },
    { 0, 0, 0, 0, 0, 0 },
    { d[0] - 1, d[0] - 1, d[1] - 1, d[1] - 1, d[2] - 1, d[2] - 1 },
    { d[0] / 2, d[0] / 2, 0, d[1] - 1, 0, d[2] - 1 },
    { 0, d[0] - 1, d[1] / 3, d[1] / 3, 0, d[2] - 1 },
    { 0, d[0] - 1, 0, d[1] - 1, d[2] / 2, d[2] / 2 },
    { 1, d[0] / 2, d[1] / 3, d[1] - 2, d[2] / 4, d[2] - 1 },
    { d[0] / 3, d[0] - 1, 0, d[1] / 2, 0, d[2] / 3 },
  };
  for (const auto& extent : extents)
  {
    // A new fitter has no image yet that the part could be cut from.
    vtkNew<vtkIPIAImplicitFitter> fresh;
    fresh->SetInputData(cloud);
    fresh->SetSampleDimensions(dimensions[0], dimensions[1], dimensions[2]);
    fresh->SetOutputScalarTypeToDouble();
    fresh->UpdateExtent(extent);
    const std::string what = Text("extent ", extent[0], " ", extent[1], " ", extent[2], " ",
      extent[3], " ", extent[4], " ", extent[5]);
    checks.That(std::equal(extent, extent + 6, fresh->GetOutput()->GetExtent()), what);
    checks.That(IsPartOf(fresh->GetOutput(), whole), what + ": equal to the whole image there");
  }
}

void TestPortsAlone(Checks& checks)
{
  auto cloud = SphereCloud();
  auto all = NewClassicFitter(cloud);
  all->Update();
  auto points = NewClassicFitter(cloud);
  points->Update(1);
  checks.That(
    ipiatest::SameArray(ipiatest::FittedPoints(points)->GetPointData()->GetArray("Residual"),
      ipiatest::FittedPoints(all)->GetPointData()->GetArray("Residual")),
    "port 1 alone gives the fitted points");
  auto lattice = NewClassicFitter(cloud);
  lattice->Update(2);
  checks.That(ipiatest::SameImage(ipiatest::ControlLattice(lattice), ipiatest::ControlLattice(all)),
    "port 2 alone gives the control lattice");
  lattice->Update(0);
  checks.That(ipiatest::SameOutputs(lattice, all), "port 0 after port 2 is the whole image");
}

/// Another port brought up to date with fewer or more samples than the image had at its last
/// update.
void TestPortsAfterResampling(Checks& checks)
{
  for (int port : { 1, 2 })
  {
    for (auto sizes : { std::make_pair(12, 24), std::make_pair(24, 12) })
    {
      auto fitter = NewClassicFitter(SphereCloud(), sizes.first);
      fitter->Update();
      fitter->SetGridSize(sizes.second, sizes.second, sizes.second);
      fitter->Update(port);
      fitter->Update();
      CheckAnnounced(
        checks, fitter, Text("GridSize ", sizes.first, ", then ", sizes.second, " on port ", port));
    }
  }
}

using Change = std::pair<std::string, std::function<void(vtkIPIAImplicitFitter*)>>;

/// The function is exchanged when there is a new fit.
bool Refits(vtkIPIAImplicitFitter* fitter, const Change& change)
{
  fitter->Update();
  const vtkMTimeType before = fitter->GetImplicitFunction()->GetMTime();
  change.second(fitter);
  fitter->Update();
  return fitter->GetImplicitFunction()->GetMTime() != before;
}

void TestWhatRefits(Checks& checks)
{
  const std::vector<Change> resampling = {
    { "SampleDimensions", [](auto* f) { f->SetSampleDimensions(20, 30, 40); } },
    { "one automatic sample dimension", [](auto* f) { f->SetSampleDimensions(0, 30, 40); } },
    { "GenerateGradient", [](auto* f) { f->GenerateGradientOn(); } },
    { "OutputScalarType", [](auto* f) { f->SetOutputScalarTypeToDouble(); } },
    { "an extent",
      [](auto* f)
      {
        const int extent[6] = { 1, 5, 2, 6, 3, 7 };
        f->UpdateExtent(extent);
      } },
    { "Modified", [](auto* f) { f->Modified(); } },
  };
  const std::vector<Change> fitting = {
    { "GridSize", [](auto* f) { f->SetGridSize(14, 14, 14); } },
    { "ModelBounds", [](auto* f) { f->SetModelBounds(-2, 2, -2, 2, -2, 2); } },
    { "Padding", [](auto* f) { f->SetPadding(0.5); } },
    { "NormalConstraint", [](auto* f) { f->SetNormalConstraintToOutwardOffset(); } },
    { "OffsetDistance", [](auto* f) { f->SetOffsetDistance(0.1); } },
    { "OffsetValue", [](auto* f) { f->SetOffsetValue(0.2); } },
    { "InwardOffsetDistance", [](auto* f) { f->SetInwardOffsetDistance(0.1); } },
    { "InwardOffsetValue", [](auto* f) { f->SetInwardOffsetValue(0.2); } },
    { "Solver", [](auto* f) { f->SetSolverToConjugateGradient(); } },
    { "MaximumNumberOfIterations", [](auto* f) { f->SetMaximumNumberOfIterations(7); } },
    { "Tolerance", [](auto* f) { f->SetTolerance(0.5); } },
    { "StepSize", [](auto* f) { f->SetStepSize(0.001); } },
  };
  for (const auto& change : resampling)
  {
    auto fitter = NewClassicFitter(SphereCloud(), 12);
    checks.That(!Refits(fitter, change), change.first + " does not fit anew");
  }
  for (const auto& change : fitting)
  {
    auto fitter = NewClassicFitter(SphereCloud(), 12);
    checks.That(Refits(fitter, change), change.first + " fits anew");
  }
}

void TestSecondInput(Checks& checks)
{
  auto reused = NewClassicFitter();
  auto second = SphereCloud(900, 3, { 10, 20, 30 });
  const auto state = [&]
  {
    std::ostringstream os;
    os << reused->GetModelBounds()[0] << " " << reused->GetModelBounds()[1] << " "
       << reused->GetPadding() << " " << reused->GetGridSize()[0] << " "
       << reused->GetSampleDimensions()[0] << " " << reused->GetDimension() << " "
       << reused->GetOffsetDistance() << " " << reused->GetOffsetValue() << " "
       << reused->GetInwardOffsetDistance() << " " << reused->GetInwardOffsetValue() << " "
       << reused->GetMaximumNumberOfIterations() << " " << reused->GetStepSize();
    return os.str();
  };
  const std::string before = state();
  reused->SetInputData(ipiatest::ToPolyData(ipiatest::PointsOn(ipiatest::Circle(1), 100)));
  reused->Update();
  checks.Equal(state(), before, "the parameters after the first input");
  reused->SetInputData(second);
  reused->Update();
  checks.Equal(state(), before, "the parameters after the second input");
  auto fresh = NewClassicFitter(second);
  fresh->Update();
  checks.That(ipiatest::SameOutputs(reused, fresh), "a second input gives what a new filter gives");
  checks.Equal(reused->GetEnergy(), fresh->GetEnergy(), "Energy on a second input");
}
}

int TestImplicitFitterPipeline(int, char*[])
{
  Checks checks;
  TestNothingSet(checks);
  TestNothingSetInThePlane(checks);
  TestEditedInput(checks);
  TestTimeSteps<vtkFlyingEdges3D>(checks);
  TestTimeSteps<vtkContourFilter>(checks);
  TestTimeStepsOfTheFitter(checks);
  TestAnnouncedIsDelivered(checks);
  const int spatial[3] = { 41, 37, 50 }, planar[3] = { 61, 47, 0 };
  TestSubExtents(checks, SphereCloud(), spatial);
  TestSubExtents(
    checks, ipiatest::ToPolyData(ipiatest::PointsOn(ipiatest::Circle(1), 100)), planar);
  TestPortsAlone(checks);
  TestPortsAfterResampling(checks);
  TestWhatRefits(checks);
  TestSecondInput(checks);
  return checks.Result();
}
