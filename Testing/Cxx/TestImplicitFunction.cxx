// SPDX-License-Identifier: BSD-3-Clause
/**
 * The function of a fit: refused lattices, values against samples, against VTK's own spline
 * interpolator and after a round through a file, the gradient, and its use by VTK's filters.
 */
#include "IPIATestShapes.h"
#include "IPIATestTopology.h"
#include "IPIATestUtilities.h"

#include "vtkClipPolyData.h"
#include "vtkCutter.h"
#include "vtkIPIAImplicitFunction.h"
#include "vtkImageBSplineInterpolator.h"
#include "vtkMath.h"
#include "vtkMinimalStandardRandomSequence.h"
#include "vtkSampleFunction.h"
#include "vtkSphereSource.h"
#include "vtkTestUtilities.h"
#include "vtkXMLImageDataReader.h"
#include "vtkXMLImageDataWriter.h"

#include <cmath>
#include <limits>

namespace
{
using ipiatest::Checks;
using ipiatest::Text;

vtkSmartPointer<vtkPolyData> Cloud(bool planar)
{
  return ipiatest::ToPolyData(planar
      ? ipiatest::InPlane(ipiatest::PointsOn(ipiatest::Flower(), 300), 1, 2, 4)
      : ipiatest::PointsOn(ipiatest::Torus(1, 0.4), 3000));
}

vtkSmartPointer<vtkIPIAImplicitFitter> Fit(bool planar)
{
  auto fitter = ipiatest::NewClassicFitter(Cloud(planar), 30);
  fitter->SetSampleDimensions(41, 53, 47);
  fitter->SetOutputScalarTypeToDouble();
  fitter->GenerateGradientOn();
  fitter->GenerateSupportOn();
  fitter->Update();
  return fitter;
}

/// Positions all over the domain and beyond it.
std::vector<ipiatest::Vector3> Probes(vtkIPIAImplicitFitter* fitter, double enlarge)
{
  const double* b = fitter->GetOutput()->GetBounds();
  vtkNew<vtkMinimalStandardRandomSequence> random;
  random->SetSeed(7);
  std::vector<ipiatest::Vector3> probes(2000);
  for (auto& x : probes)
  {
    for (std::size_t a = 0; a < 3; ++a)
    {
      random->Next();
      const double side = b[2 * a + 1] - b[2 * a];
      x[a] = random->GetRangeValue(b[2 * a] - enlarge * side, b[2 * a + 1] + enlarge * side);
    }
  }
  return probes;
}

/// The far field at a position: 0 where the spline counts.
double FarField(vtkIPIAImplicitFitter* fitter, ipiatest::Vector3 x)
{
  vtkImageData* lattice = ipiatest::ControlLattice(fitter);
  const int* n = lattice->GetDimensions();
  vtkIdType box = 0;
  for (int a = 2; a >= 0; --a)
  {
    if (n[a] > 1)
    {
      // Box i is centred i / 2 spacings above the lower end of the domain, where u is 1.
      const double u =
        (x[static_cast<std::size_t>(a)] - lattice->GetOrigin()[a]) / lattice->GetSpacing()[a];
      const int boxes = 2 * (n[a] - 3) + 1;
      const int i = static_cast<int>(std::floor(2 * (u - 1) + 0.5));
      box = box * boxes + std::min(std::max(i, 0), boxes - 1);
    }
  }
  vtkFieldData* field = lattice->GetFieldData();
  return field->GetArray("FarField")->GetComponent(box, 0) *
    field->GetArray("FarFieldMagnitude")->GetComponent(0, 0);
}

void CheckRefusedLattice(Checks& checks, vtkImageData* lattice, const std::string& phrase)
{
  auto fitter = Fit(false);
  vtkNew<vtkIPIAImplicitFunction> function;
  function->SetControlLattice(ipiatest::ControlLattice(fitter));
  checks.That(function->HasControlLattice(), "a good lattice is taken");
  vtkNew<ipiatest::MessageObserver> messages;
  messages->WatchObject(function);
  function->SetControlLattice(lattice);
  messages->CheckOneError(checks, phrase, "bad lattice");
  checks.That(!function->HasControlLattice(), "a bad lattice leaves none: " + phrase);
  double x[3] = { 1, 0, 0 }, g[3];
  function->EvaluateGradient(x, g);
  checks.Equal(function->EvaluateFunction(x), 0.0, "f without a lattice");
  checks.Equal(vtkMath::Norm(g), 0.0, "gradient without a lattice");
}

vtkSmartPointer<vtkImageData> Lattice(int nx, int ny, int nz, const char* name, int components = 1)
{
  auto lattice = vtkSmartPointer<vtkImageData>::New();
  lattice->SetDimensions(nx, ny, nz);
  lattice->GetPointData()->AddArray(
    ipiatest::Constant(name, lattice->GetNumberOfPoints(), 1, components));
  return lattice;
}

/// A lattice of 8^3 coefficients with a far field of one sign.
vtkSmartPointer<vtkImageData> WithFarField(
  vtkIdType values, int components, double sign, double magnitude)
{
  auto lattice = Lattice(8, 8, 8, "Coefficient");
  lattice->GetFieldData()->AddArray(ipiatest::Constant("FarField", values, sign, components));
  lattice->GetFieldData()->AddArray(ipiatest::Constant("FarFieldMagnitude", 1, magnitude));
  return lattice;
}

void TestBadLattices(Checks& checks)
{
  vtkNew<vtkImageData> empty;
  CheckRefusedLattice(checks, empty, "fewer than two axes");
  CheckRefusedLattice(checks, Lattice(8, 1, 1, "Coefficient"), "fewer than two axes");
  CheckRefusedLattice(checks, Lattice(8, 3, 8, "Coefficient"), "3 coefficients on an axis");
  CheckRefusedLattice(checks, Lattice(8, 8, 8, "Other"), "no point array Coefficient");
  CheckRefusedLattice(checks, Lattice(8, 8, 8, "Coefficient", 2), "no point array Coefficient");
  auto flat = Lattice(8, 8, 8, "Coefficient");
  flat->SetSpacing(1, 0, 1);
  CheckRefusedLattice(checks, flat, "spacing of the control lattice is not positive");

  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  flat->SetSpacing(1, infinity, 1);
  CheckRefusedLattice(checks, flat, "spacing of the control lattice is not positive and finite");
  auto displaced = Lattice(8, 8, 8, "Coefficient");
  displaced->SetOrigin(0, nan, 0);
  CheckRefusedLattice(checks, displaced, "origin of the control lattice is not finite");
  for (const char* name : { "Coefficient", "Weight" })
  {
    for (double value : { nan, infinity })
    {
      auto lattice = Lattice(8, 8, 8, "Coefficient");
      lattice->GetPointData()->AddArray(Lattice(8, 8, 8, "Weight")->GetPointData()->GetArray(0));
      lattice->GetPointData()->GetArray(name)->SetTuple1(7, value);
      CheckRefusedLattice(checks, lattice, std::string("value 7 of the point array ") + name);
    }
  }

  constexpr vtkIdType boxes = 11 * 11 * 11;
  CheckRefusedLattice(checks, WithFarField(boxes - 1, 1, 1, 2), "1330 values of 1 component(s)");
  CheckRefusedLattice(checks, WithFarField(boxes, 2, 1, 2), "1331 values of 2 component(s)");
  CheckRefusedLattice(checks, WithFarField(boxes, 1, 3, 2), "values other than -1, 0 and 1");
  CheckRefusedLattice(checks, WithFarField(boxes, 1, 1, 0), "with one positive value");
  auto without = WithFarField(boxes, 1, 1, 2);
  without->GetFieldData()->RemoveArray("FarFieldMagnitude");
  CheckRefusedLattice(checks, without, "no field array FarFieldMagnitude");

  vtkNew<vtkIPIAImplicitFunction> function;
  function->SetControlLattice(WithFarField(boxes, 1, -1, 2));
  double x[3] = { 3, 3, 3 };
  checks.Equal(function->EvaluateFunction(x), -2.0, "a good far field is taken");
}

/// nullptr removes the lattice without a word.
void TestNoLattice(Checks& checks)
{
  auto fitter = Fit(false);
  vtkNew<vtkIPIAImplicitFunction> function;
  vtkNew<ipiatest::MessageObserver> messages;
  messages->WatchObject(function);
  function->SetControlLattice(ipiatest::ControlLattice(fitter));
  function->SetControlLattice(nullptr);
  checks.That(!function->HasControlLattice(), "the lattice is removed");
  messages->CheckSilence(checks, "nullptr");
}

/// All image points, those of the far field among them; Gradient is that of the function.
void TestSamples(Checks& checks, bool planar)
{
  auto fitter = Fit(planar);
  vtkIPIAImplicitFunction* function = fitter->GetImplicitFunction();
  vtkImageData* image = fitter->GetOutput();
  vtkDataArray* f = image->GetPointData()->GetArray("f");
  vtkDataArray* gradient = image->GetPointData()->GetArray("Gradient");
  double scale = 0, value = 0, slope = 0;
  int far = 0;
  for (vtkIdType i = 0; i < image->GetNumberOfPoints(); ++i)
  {
    ipiatest::Vector3 x, g;
    image->GetPoint(i, x.data());
    function->EvaluateGradient(x.data(), g.data());
    scale = std::max(scale, std::abs(f->GetComponent(i, 0)));
    value = std::max(value, std::abs(f->GetComponent(i, 0) - function->EvaluateFunction(x.data())));
    for (int a = 0; a < 3; ++a)
    {
      slope =
        std::max(slope, std::abs(gradient->GetComponent(i, a) - g[static_cast<std::size_t>(a)]));
    }
    far += FarField(fitter, x) != 0;
  }
  const std::string what = planar ? "planar" : "spatial";
  checks.That(far > 0 && far < image->GetNumberOfPoints(), what + ": far field and spline");
  checks.AtMost(value, 1e-13 * scale, what + ": samples against the function");
  checks.AtMost(slope, 1e-12, what + ": Gradient against the function");
}

/// Where the far field is not, within a step of central differences.
void TestGradient(Checks& checks, bool planar)
{
  auto fitter = Fit(planar);
  vtkIPIAImplicitFunction* function = fitter->GetImplicitFunction();
  const double step = 1e-5 * ipiatest::KnotSpacing(fitter);
  double largest = 0;
  int compared = 0;
  for (auto x : Probes(fitter, 0))
  {
    ipiatest::Vector3 g;
    function->EvaluateGradient(x.data(), g.data());
    for (std::size_t a = 0; a < 3; ++a)
    {
      auto before = x, after = x;
      before[a] -= step;
      after[a] += step;
      if (FarField(fitter, before) == 0 && FarField(fitter, after) == 0)
      {
        const double difference =
          (function->EvaluateFunction(after.data()) - function->EvaluateFunction(before.data())) /
          (2 * step);
        largest = std::max(largest, std::abs(difference - g[a]));
        ++compared;
      }
      else if (FarField(fitter, x) != 0)
      {
        checks.Equal(g[a], 0.0, "gradient in the far field");
      }
    }
  }
  checks.That(compared > 100, Text("many slopes are compared (", compared, ")"));
  checks.AtMost(largest, 1e-7, planar ? "planar gradient" : "spatial gradient");
}

void TestInterpolator(Checks& checks)
{
  auto fitter = Fit(false);
  vtkNew<vtkImageBSplineInterpolator> spline;
  spline->SetSplineDegree(3);
  spline->Initialize(ipiatest::ControlLattice(fitter));
  double largest = 0;
  int compared = 0;
  for (auto x : Probes(fitter, 0))
  {
    if (FarField(fitter, x) == 0)
    {
      double value = 0;
      checks.That(spline->Interpolate(x.data(), &value), "VTK interpolates");
      largest = std::max(
        largest, std::abs(value - fitter->GetImplicitFunction()->EvaluateFunction(x.data())));
      ++compared;
    }
  }
  checks.That(compared > 100, Text("many values are compared (", compared, ")"));
  checks.AtMost(largest, 1e-4 * ipiatest::KnotSpacing(fitter), "vtkImageBSplineInterpolator");
}

void TestFile(Checks& checks, bool planar, const std::string& folder)
{
  auto fitter = Fit(planar);
  const std::string file = folder + (planar ? "/planar.vti" : "/spatial.vti");
  vtkNew<vtkXMLImageDataWriter> writer;
  writer->SetFileName(file.c_str());
  writer->SetInputConnection(fitter->GetOutputPort(2));
  checks.Equal(writer->Write(), 1, "the file is written");
  vtkNew<vtkXMLImageDataReader> reader;
  reader->SetFileName(file.c_str());
  reader->Update();
  vtkNew<vtkIPIAImplicitFunction> function;
  function->SetControlLattice(reader->GetOutput());
  bool same = true;
  int far = 0, beyond = 0;
  const double* b = fitter->GetOutput()->GetBounds();
  for (auto x : Probes(fitter, 0.5))
  {
    ipiatest::Vector3 g, h;
    function->EvaluateGradient(x.data(), g.data());
    fitter->GetImplicitFunction()->EvaluateGradient(x.data(), h.data());
    same = same && g == h &&
      function->EvaluateFunction(x.data()) ==
        fitter->GetImplicitFunction()->EvaluateFunction(x.data());
    far += FarField(fitter, x) != 0;
    beyond += x[1] < b[2] || x[1] > b[3] || x[2] < b[4] || x[2] > b[5];
  }
  checks.That(far > 0 && beyond > 0, "probes in the far field and beyond the domain");
  checks.That(same, file + ": exactly the function of the fitter");
}

/// No crash, no number.
void TestNoNumber(Checks& checks)
{
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (bool planar : { false, true })
  {
    auto fitter = Fit(planar);
    for (int a = planar ? 1 : 0; a < 3; ++a) // across the plane f is the same everywhere
    {
      double x[3] = { 0, 0, 0 };
      x[a] = nan;
      checks.That(std::isnan(fitter->GetImplicitFunction()->EvaluateFunction(x)),
        ipiatest::Text("f where coordinate ", a, " is no number"));
    }
  }
}

/// A factor of all weights of a rational lattice changes nothing.
void TestScaledWeights(Checks& checks)
{
  vtkNew<vtkIPIAImplicitFunction> function;
  for (double factor : { 1., 1e-12 })
  {
    auto lattice = Lattice(8, 8, 8, "Coefficient");
    auto weights = Lattice(8, 8, 8, "Weight");
    vtkDataArray* values = weights->GetPointData()->GetArray(0);
    for (vtkIdType i = 0; i < values->GetNumberOfTuples(); ++i)
    {
      values->SetTuple1(i, factor);
      lattice->GetPointData()->GetArray(0)->SetTuple1(i, static_cast<double>(i % 8));
    }
    lattice->GetPointData()->AddArray(values);
    function->SetControlLattice(lattice);
    double x[3] = { 2.5, 3, 3 };
    checks.AtMost(std::abs(function->EvaluateFunction(x) - 2.5), 1e-12,
      ipiatest::Text("f with all weights ", factor));
  }
}

/// Beyond the domain the sign is kept and |f| grows with the distance.
void TestBeyondDomain(Checks& checks)
{
  auto fitter = Fit(false);
  vtkIPIAImplicitFunction* function = fitter->GetImplicitFunction();
  double border[3], beyond[3];
  fitter->GetOutput()->GetPoint(0, border);
  for (int a = 0; a < 3; ++a)
  {
    beyond[a] = border[a] - (a == 0 ? 5 : 0);
  }
  checks.That(function->EvaluateFunction(border) > 0, "f > 0 at the corner of the domain");
  checks.AtMost(
    std::abs(function->EvaluateFunction(beyond) - function->EvaluateFunction(border) - 5), 1e-12,
    "f beyond the domain");
}

/// About 1 at the data, 0 in the corner of the domain, whatever the unit of length.
void TestSupport(Checks& checks, ipiatest::Method method)
{
  for (double unit : { 1., 1000. })
  {
    auto fitter = ipiatest::NewFitter(method, ipiatest::SphereCloud(3000, unit), 30);
    fitter->SetSampleDimensions(101, 101, 101);
    fitter->GenerateSupportOn();
    fitter->Update();
    vtkImageData* image = fitter->GetOutput();
    vtkDataArray* support = image->GetPointData()->GetArray("Support");
    double least = VTK_DOUBLE_MAX, most = 0;
    for (vtkIdType i = 0; i < image->GetNumberOfPoints(); ++i)
    {
      if (std::abs(vtkMath::Norm(image->GetPoint(i)) - unit) < 0.1 * ipiatest::KnotSpacing(fitter))
      {
        least = std::min(least, support->GetComponent(i, 0));
        most = std::max(most, support->GetComponent(i, 0));
      }
    }
    const std::string what = Text(ipiatest::NameOf(method), ", radius ", unit);
    checks.That(
      least > 0.8 && most < 1.2, Text(what, ": support at the data (", least, " to ", most, ")"));
    checks.Equal(support->GetComponent(0, 0), 0.0, what + ": support in a corner");
  }
}

double LargestValueOn(vtkPolyData* data, vtkImplicitFunction* function)
{
  double largest = -VTK_DOUBLE_MAX;
  for (vtkIdType i = 0; i < data->GetNumberOfPoints(); ++i)
  {
    largest = std::max(largest, function->FunctionValue(data->GetPoint(i)));
  }
  return largest;
}

/// The function of a sphere clips and cuts a finer sphere that is shifted by half.
void TestFilters(Checks& checks)
{
  auto fitter = ipiatest::NewClassicFitter(ipiatest::SphereCloud(3000), 30);
  fitter->Update();
  vtkIPIAImplicitFunction* function = fitter->GetImplicitFunction();
  vtkNew<vtkSphereSource> other;
  other->SetRadius(1);
  other->SetCenter(1, 0, 0);
  other->SetThetaResolution(100);
  other->SetPhiResolution(100);

  vtkNew<vtkClipPolyData> clip;
  clip->SetInputConnection(other->GetOutputPort());
  clip->SetClipFunction(function);
  clip->InsideOutOn();
  clip->Update();
  checks.AtMost(std::abs(clip->GetOutput()->GetBounds()[1] - 0.5), 0.01, "where the clip ends");
  checks.AtMost(LargestValueOn(clip->GetOutput(), function), 0.01, "f on the clipped part");

  vtkNew<vtkCutter> cut;
  cut->SetInputConnection(other->GetOutputPort());
  cut->SetCutFunction(function);
  cut->Update();
  const double* bounds = cut->GetOutput()->GetBounds();
  checks.That(cut->GetOutput()->GetNumberOfCells() > 0, "the cut is not empty");
  checks.AtMost(
    std::max(std::abs(bounds[0] - 0.5), std::abs(bounds[1] - 0.5)), 0.01, "the plane of the cut");
  checks.AtMost(std::abs(bounds[3] - std::sqrt(0.75)), 0.01, "the radius of the cut");

  vtkNew<vtkSampleFunction> sample;
  sample->SetImplicitFunction(function);
  sample->SetModelBounds(-1.5, 1.5, -1.5, 1.5, -1.5, 1.5);
  sample->SetSampleDimensions(60, 60, 60);
  sample->ComputeNormalsOff();
  checks.Equal(ipiatest::TopologyOf(ipiatest::ZeroSurface(sample)),
    ipiatest::Topology{ 1, 0, 0, 0 }, "vtkSampleFunction on other samples");
}
}

int TestImplicitFunction(int argc, char* argv[])
{
  Checks checks;
  const char* folder =
    vtkTestUtilities::GetArgOrEnvOrDefault("-T", argc, argv, "VTK_TEMP_DIR", "Testing/Temporary");
  TestBadLattices(checks);
  TestNoLattice(checks);
  for (bool planar : { false, true })
  {
    TestSamples(checks, planar);
    TestGradient(checks, planar);
    TestFile(checks, planar, folder);
  }
  TestInterpolator(checks);
  TestNoNumber(checks);
  TestScaledWeights(checks);
  TestBeyondDomain(checks);
  for (ipiatest::Method method : ipiatest::Methods)
  {
    TestSupport(checks, method);
  }
  TestFilters(checks);
  delete[] folder;
  return checks.Result();
}
