// SPDX-License-Identifier: BSD-3-Clause
/**
 * Rational splines and the oscillation's weight: what is refused, the weights on output 2, samples
 * and gradients against the function, a round through a file, and the reconstruction in one step.
 */
#include "IPIATestShapes.h"
#include "IPIATestTopology.h"
#include "IPIATestUtilities.h"

#include "vtkIPIAImplicitFunction.h"
#include "vtkIPIASurfaceReconstruction.h"
#include "vtkMath.h"
#include "vtkTestUtilities.h"
#include "vtkXMLImageDataReader.h"
#include "vtkXMLImageDataWriter.h"

#include <functional>
#include <limits>

namespace
{
using ipiatest::Checks;
using ipiatest::ControlLattice;
using ipiatest::Text;

using Fitter = vtkSmartPointer<vtkIPIAImplicitFitter>;

vtkSmartPointer<vtkPolyData> Cloud(bool planar)
{
  return ipiatest::ToPolyData(planar
      ? ipiatest::InPlane(ipiatest::PointsOn(ipiatest::Flower(), 300), 1, 2, 4)
      : ipiatest::PointsOn(ipiatest::Torus(1, 0.4), 3000));
}

/// The weights move by more than 1 %.
Fitter NewRationalFitter(vtkDataObject* cloud, int gridSize = 24)
{
  auto fitter = ipiatest::NewClassicFitter(cloud, gridSize);
  fitter->SetBasisTypeToUniformRational();
  fitter->SetWeightStepSize(2);
  fitter->SetMaximumNumberOfIterations(30);
  return fitter;
}

void TestParameters(Checks& checks)
{
  vtkNew<vtkIPIAImplicitFitter> fitter;
  checks.Equal(fitter->GetBasisType(), 0, "default BasisType");
  checks.Equal(fitter->GetWeightStepSize(), 0.01, "default WeightStepSize");
  checks.Equal(fitter->GetOscillationWeight(), 0., "default OscillationWeight");
  checks.Equal(fitter->GetOscillationStep(), 0, "default OscillationStep");
  fitter->SetBasisTypeToUniformRational();
  checks.Equal(fitter->GetBasisType(), 1, "UniformRational");
  fitter->SetBasisTypeToBSpline();
  checks.Equal(fitter->GetBasisType(), 0, "BSpline");
  fitter->SetOscillationStepToAsPrinted();
  checks.Equal(fitter->GetOscillationStep(), 1, "AsPrinted");
  fitter->SetOscillationStepToEnergy();
  checks.Equal(fitter->GetOscillationStep(), 0, "Energy");
  fitter->SetWeightStepSize(-1);
  fitter->SetOscillationWeight(-1);
  checks.Equal(fitter->GetWeightStepSize(), 0., "a negative WeightStepSize becomes 0");
  checks.Equal(fitter->GetOscillationWeight(), 0., "a negative OscillationWeight becomes 0");
  std::ostringstream os;
  fitter->Print(os);
  for (const char* name : { "BasisType:", "WeightStepSize:", "OscillationWeight:",
         "OscillationStep:", "WeightStepSizeUsed:" })
  {
    checks.That(os.str().find(name) != std::string::npos, Text("PrintSelf has ", name));
  }
}

using Setup = std::function<void(vtkIPIAImplicitFitter*)>;

/// One error with the phrase and nothing left, at first and after a good run.
void CheckRefused(Checks& checks, const std::string& what, const std::string& phrase,
  const Setup& setup, bool planar = true)
{
  for (const bool afterGoodRun : { false, true })
  {
    auto fitter = ipiatest::NewClassicFitter(Cloud(planar), 12);
    vtkNew<ipiatest::MessageObserver> messages;
    messages->Watch(fitter);
    if (afterGoodRun)
    {
      fitter->Update();
      messages->CheckSilence(checks, what + ", good run");
      checks.That(fitter->GetOutput()->GetNumberOfPoints() > 0, what + ": the good run");
    }
    setup(fitter);
    fitter->Update();
    messages->CheckOneError(checks, phrase, what);
    checks.That(ipiatest::OutputsAreEmpty(fitter), what + ": all outputs are empty");
    checks.That(
      !fitter->GetImplicitFunction()->HasControlLattice(), what + ": no function is left");
    checks.Equal(fitter->GetEnergy(), 0., what + ": energy");
    checks.Equal(fitter->GetWeightStepSizeUsed(), 0., what + ": WeightStepSizeUsed");
  }
}

void TestRefusedCombinations(Checks& checks)
{
  const Setup rational = [](auto* fitter) { fitter->SetBasisTypeToUniformRational(); };
  const Setup smooth = [](auto* fitter) { fitter->SetOscillationWeight(0.01); };
  const auto both = [](const Setup& a, const Setup& b)
  {
    return [=](vtkIPIAImplicitFitter* fitter)
    {
      a(fitter);
      b(fitter);
    };
  };
  const Setup levels = [](auto* fitter)
  {
    fitter->SetNumberOfLevels(0);
    fitter->SetSolverToConjugateGradient();
  };
  const Setup gradient = [](auto* fitter)
  {
    fitter->SetNormalConstraintToGradient();
    fitter->SetSolverToConjugateGradient();
  };
  const Setup conjugate = [](auto* fitter) { fitter->SetSolverToConjugateGradient(); };
  const Setup fairing = [](auto* fitter) { fitter->SetFairingWeight(1e-4); };
  const Setup printed = [](auto* fitter) { fitter->SetOscillationStepToAsPrinted(); };

  const std::string single = " belongs to a single level with offset rows";
  CheckRefused(checks, "rational, levels", "UniformRational" + single, both(rational, levels));
  CheckRefused(checks, "rational, gradient", "UniformRational" + single, both(rational, gradient));
  CheckRefused(checks, "lambda, levels", "OscillationWeight" + single, both(smooth, levels));
  CheckRefused(checks, "lambda, gradient", "OscillationWeight" + single, both(smooth, gradient));
  CheckRefused(checks, "rational, conjugate gradients", "UniformRational is fitted by Progressive",
    both(rational, conjugate));
  CheckRefused(checks, "printed, conjugate gradients", "AsPrinted is a step of Progressive",
    both(both(smooth, printed), conjugate));
  CheckRefused(checks, "rational, fairing", "belong to the hierarchy, BasisType UniformRational",
    both(rational, fairing));
  CheckRefused(
    checks, "lambda, fairing", "belong to the hierarchy, OscillationWeight", both(smooth, fairing));
  CheckRefused(checks, "rational, local fairing", "belong to the hierarchy, BasisType Uniform",
    both(rational,
      [](auto* fitter)
      {
        auto* cloud = vtkPolyData::SafeDownCast(fitter->GetInput());
        cloud->GetPointData()->AddArray(
          ipiatest::Constant("LocalFairing", cloud->GetNumberOfPoints(), 1));
        fitter->SetInputArrayToProcess(
          3, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, "LocalFairing");
      }));
}

void TestRefusedValues(Checks& checks)
{
  const double nan = std::numeric_limits<double>::quiet_NaN();
  CheckRefused(checks, "lambda NaN", "OscillationWeight is nan",
    [=](auto* fitter) { fitter->SetOscillationWeight(nan); });
  CheckRefused(checks, "tau NaN", "WeightStepSize is nan",
    [=](auto* fitter)
    {
      fitter->SetBasisTypeToUniformRational();
      fitter->SetWeightStepSize(nan);
    });
  for (const double value : { 1e100, 1e300, std::numeric_limits<double>::infinity() })
  {
    CheckRefused(checks, "lambda out of reach", "counts for nothing beside it",
      [=](auto* fitter) { fitter->SetOscillationWeight(value); });
    CheckRefused(checks, "tau out of reach", "far too long a step",
      [=](auto* fitter)
      {
        fitter->SetBasisTypeToUniformRational();
        fitter->SetWeightStepSize(value);
      });
  }
  for (const bool planar : { true, false })
  {
    const double limit = planar ? 1. / 16 : 1. / 24;
    CheckRefused(
      checks, "printed, lambda at its limit", "must be less than 1 / (8 Dimension)",
      [=](auto* fitter)
      {
        fitter->SetOscillationStepToAsPrinted();
        fitter->SetOscillationWeight(limit);
      },
      planar);
  }
  CheckRefused(checks, "printed, diverging", "diverges with StepSize",
    [](auto* fitter)
    {
      fitter->SetOscillationStepToAsPrinted();
      fitter->SetOscillationWeight(0.01);
      fitter->SetStepSize(100);
    });
  CheckRefused(checks, "rational, diverging", "diverges with StepSize",
    [](auto* fitter)
    {
      fitter->SetBasisTypeToUniformRational();
      fitter->SetStepSize(100);
    });
}

/// Rows at knots whose values change sign from one to the next, the fastest mode of the printed
/// step.
void TestPrintedStepDiverges(Checks& checks)
{
  auto fitter = ipiatest::NewClassicFitter(
    ipiatest::ToPolyData(ipiatest::PointsOn(ipiatest::Circle(18), 40)), 43);
  fitter->SetModelBounds(-20, 20, -20, 20, 0, 0);
  vtkNew<vtkPolyData> extra;
  vtkNew<vtkPoints> points;
  vtkNew<vtkDoubleArray> values;
  for (int y = -20; y <= 20; ++y)
  {
    for (int x = -20; x <= 20; ++x)
    {
      points->InsertNextPoint(x, y, 0);
      values->InsertNextValue((x + y) % 2 ? 1 : -1);
    }
  }
  extra->SetPoints(points);
  extra->GetPointData()->SetScalars(values);
  fitter->SetExtraRowsData(extra);
  fitter->SetMaximumNumberOfIterations(20000);
  fitter->SetOscillationStepToAsPrinted();
  fitter->SetOscillationWeight(0.0624);
  vtkNew<ipiatest::MessageObserver> messages;
  messages->Watch(fitter);
  fitter->Update();
  messages->CheckOneError(
    checks, "diverges with OscillationWeight 0.0624 and OscillationStep AsPrinted", "diverging");
  checks.That(ipiatest::OutputsAreEmpty(fitter), "diverging: all outputs are empty");
  fitter->SetOscillationStepToEnergy();
  fitter->SetMaximumNumberOfIterations(50);
  fitter->Update();
  checks.That(messages->Errors.empty(), "the other step does not diverge");
  checks.That(ipiatest::OutputsAreSound(fitter), "and has outputs");
}

void TestWeights(Checks& checks, bool planar)
{
  const std::string what = planar ? "2-D" : "3-D";
  auto fitter = NewRationalFitter(Cloud(planar));
  fitter->SetOutputScalarTypeToDouble();
  fitter->GenerateGradientOn();
  fitter->SetSampleDimensions(31, 33, 29);
  vtkNew<ipiatest::MessageObserver> messages;
  messages->Watch(fitter);
  fitter->Update();
  messages->CheckSilence(checks, what);
  checks.That(ipiatest::OutputsAreSound(fitter), what + ": outputs are sound");
  vtkDataArray* weights = ControlLattice(fitter)->GetPointData()->GetArray("Weight");
  if (!checks.That(weights != nullptr, what + ": there are weights"))
  {
    return;
  }
  checks.Equal(
    weights->GetNumberOfTuples(), ControlLattice(fitter)->GetNumberOfPoints(), what + ": number");
  checks.That(weights->GetRange()[0] >= 0, what + ": no weight is negative");
  checks.That(weights->GetRange()[1] - weights->GetRange()[0] > 0.01, what + ": weights differ");
  checks.That(fitter->GetWeightStepSizeUsed() > 0 && fitter->GetWeightStepSizeUsed() <= 2,
    what + ": WeightStepSizeUsed");

  // Samples and gradients are those of the function, and these of one another.
  vtkImageData* image = fitter->GetOutput();
  vtkDataArray* f = image->GetPointData()->GetScalars();
  vtkDataArray* gradient = image->GetPointData()->GetArray("Gradient");
  vtkIPIAImplicitFunction* function = fitter->GetImplicitFunction();
  double values = 0, slopes = 0, differences = 0;
  const double step = 1e-5;
  int compared = 0;
  for (vtkIdType i = 0; i < image->GetNumberOfPoints(); ++i)
  {
    double x[3], g[3];
    image->GetPoint(i, x);
    values = std::max(values, std::abs(function->EvaluateFunction(x) - f->GetComponent(i, 0)));
    function->EvaluateGradient(x, g);
    for (int a = 0; a < 3; ++a)
    {
      slopes = std::max(slopes, std::abs(g[a] - gradient->GetComponent(i, a)));
    }
    if (i % 7 == 0 && vtkMath::Norm(g) > 0)
    {
      for (int a = planar ? 1 : 0; a < 3; ++a)
      {
        double above[3] = { x[0], x[1], x[2] }, below[3] = { x[0], x[1], x[2] };
        above[a] += step;
        below[a] -= step;
        const double there = function->EvaluateFunction(above),
                     here = function->EvaluateFunction(below);
        // Not across the border of the far field, where f jumps, or of the domain.
        double ga[3], gb[3];
        function->EvaluateGradient(above, ga);
        function->EvaluateGradient(below, gb);
        if (std::abs(ga[a] - gb[a]) < 0.01)
        {
          differences = std::max(differences, std::abs((there - here) / (2 * step) - g[a]));
          ++compared;
        }
      }
    }
  }
  checks.AtMost(values, 1e-13, what + ": samples are the function's values");
  checks.AtMost(slopes, 1e-11, what + ": sampled gradients are the function's");
  checks.AtMost(differences, 1e-6, what + ": gradients agree with central differences");
  checks.That(compared > 100, what + ": differences compared");

  // Any part of the image has the same bits.
  auto parts = NewRationalFitter(Cloud(planar));
  parts->SetOutputScalarTypeToDouble();
  parts->SetSampleDimensions(31, 33, 29);
  parts->UpdateInformation();
  int extent[6];
  image->GetExtent(extent);
  for (int axis = 0; axis < 3; ++axis)
  {
    if (extent[2 * axis + 1] > 0)
    {
      extent[2 * axis] = 5;
      extent[2 * axis + 1] = 23;
    }
  }
  parts->UpdateExtent(extent);
  double different = 0;
  for (int z = extent[4]; z <= extent[5]; ++z)
  {
    for (int y = extent[2]; y <= extent[3]; ++y)
    {
      for (int x = extent[0]; x <= extent[1]; ++x)
      {
        different += image->GetScalarComponentAsDouble(x, y, z, 0) !=
          parts->GetOutput()->GetScalarComponentAsDouble(x, y, z, 0);
      }
    }
  }
  checks.Equal(different, 0., what + ": samples of a part that differ");

  // A B-spline afterwards has none.
  fitter->SetBasisTypeToBSpline();
  fitter->Update();
  checks.That(!ControlLattice(fitter)->GetPointData()->HasArray("Weight"),
    what + ": no weights with BSpline");
  checks.Equal(fitter->GetWeightStepSizeUsed(), 0., what + ": WeightStepSizeUsed of BSpline");
}

void TestFile(Checks& checks, bool planar, const std::string& folder)
{
  const std::string what = planar ? "2-D file" : "3-D file";
  auto fitter = NewRationalFitter(Cloud(planar));
  fitter->SetOscillationWeight(0.001);
  vtkNew<vtkXMLImageDataWriter> writer;
  const std::string name = Text(folder, "/rational-", planar ? 2 : 3, ".vti");
  writer->SetFileName(name.c_str());
  writer->SetInputConnection(fitter->GetOutputPort(2));
  writer->Write();
  vtkNew<vtkXMLImageDataReader> reader;
  reader->SetFileName(name.c_str());
  reader->Update();
  vtkNew<vtkIPIAImplicitFunction> function;
  function->SetControlLattice(reader->GetOutput());
  fitter->Update();
  int different = 0;
  for (vtkIdType i = 0; i < fitter->GetOutput()->GetNumberOfPoints(); ++i)
  {
    double x[3], g[3], h[3];
    fitter->GetOutput()->GetPoint(i, x);
    const double a = function->EvaluateFunctionAndGradient(x, g);
    const double b = fitter->GetImplicitFunction()->EvaluateFunctionAndGradient(x, h);
    different += a != b || g[0] != h[0] || g[1] != h[1] || g[2] != h[2];
  }
  checks.Equal(different, 0, what + ": values that differ");

  // Weights that are no weights.
  vtkNew<ipiatest::MessageObserver> messages;
  messages->WatchObject(function);
  const auto refuse = [&](
                        const std::string& phrase, const std::function<void(vtkDataArray*)>& spoil)
  {
    vtkNew<vtkImageData> spoilt;
    spoilt->DeepCopy(reader->GetOutput());
    spoil(spoilt->GetPointData()->GetArray("Weight"));
    function->SetControlLattice(spoilt);
    messages->CheckOneError(checks, phrase, what + ", " + phrase);
    checks.That(!function->HasControlLattice(), what + ": not taken");
  };
  refuse("Weight of the control lattice has negative values",
    [](auto* w) { w->SetComponent(3, 0, -1); });
  refuse("value 3 of the point array Weight of the control lattice is not finite",
    [](auto* w) { w->SetComponent(3, 0, std::nan("")); });
  refuse("0 all around a knot", [](auto* w) { w->Fill(0); });
  refuse("no point array Weight with one value", [](auto* w) { w->SetNumberOfTuples(5); });
}

/// What works with rational weights and lambda: row weights, extra rows, one-sided offsets, both
/// stopping rules.
void TestCombinations(Checks& checks)
{
  for (const bool rational : { false, true })
  {
    auto fitter = ipiatest::NewClassicFitter(Cloud(false), 20);
    fitter->SetBasisType(rational);
    fitter->SetMaximumNumberOfIterations(40);
    fitter->Update();
    const double rough = fitter->GetOscillation(), energy = fitter->GetEnergy();
    for (const int step : { 0, 1 })
    {
      fitter->SetOscillationStep(step);
      fitter->SetOscillationWeight(0.02);
      fitter->Update();
      checks.That(ipiatest::OutputsAreSound(fitter), "outputs with lambda are sound");
      checks.AtMost(fitter->GetOscillation(), 0.9 * rough, "lambda makes R smaller");
      checks.That(fitter->GetEnergy() > energy, "the energy holds lambda R");
      fitter->SetNormalConstraintToOutwardOffset();
      fitter->SetStoppingRuleToEnergyChange();
      fitter->SetTolerance(1e-3);
      fitter->SetMaximumNumberOfIterations(4000);
      fitter->Update();
      checks.That(fitter->GetNumberOfIterationsUsed() < 4000, "the change of the energy stops it");
      fitter->SetTolerance(0);
      fitter->SetMaximumNumberOfIterations(40);
      fitter->SetNormalConstraintToTwoSidedOffset();
      fitter->SetOscillationWeight(0);
    }
  }
  // Conjugate gradients reach the same minimum of E + lambda R.
  auto progressive = ipiatest::NewClassicFitter(Cloud(true), 16);
  progressive->SetOscillationWeight(0.5);
  progressive->SetMaximumNumberOfIterations(5000);
  progressive->Update();
  auto conjugate = ipiatest::NewClassicFitter(Cloud(true), 16);
  conjugate->SetOscillationWeight(0.5);
  conjugate->SetSolverToConjugateGradient();
  conjugate->SetMaximumNumberOfIterations(300);
  conjugate->Update();
  checks.AtMost(std::abs(progressive->GetEnergy() / conjugate->GetEnergy() - 1), 1e-9,
    "both solvers have the same energy");
  checks.AtMost(
    ipiatest::LargestDifference(ControlLattice(progressive)->GetPointData()->GetScalars(),
      ControlLattice(conjugate)->GetPointData()->GetScalars()),
    1e-7, "and the same coefficients");
}

void TestReconstruction(Checks& checks)
{
  vtkNew<vtkIPIASurfaceReconstruction> reconstruction;
  reconstruction->SetInputData(Cloud(false));
  vtkIPIAImplicitFitter* fitter = reconstruction->GetFitter();
  fitter->SetNumberOfLevels(1);
  fitter->SetNormalConstraintToTwoSidedOffset();
  fitter->SetSolverToProgressiveIteration();
  fitter->SetBasisTypeToUniformRational();
  fitter->SetWeightStepSize(2);
  fitter->SetGridSize(30, 30, 20);
  reconstruction->Update();
  checks.Equal(ipiatest::TopologyOf(reconstruction->GetOutput()), ipiatest::Topology{ 1, 1, 0, 0 },
    "the torus");
  double largest = 0;
  for (vtkIdType i = 0; i < reconstruction->GetOutput()->GetNumberOfPoints(); ++i)
  {
    double x[3];
    reconstruction->GetOutput()->GetPoint(i, x);
    largest = std::max(largest, std::abs(fitter->GetImplicitFunction()->EvaluateFunction(x)));
  }
  checks.AtMost(largest, 1e-4, "vertices are on f = 0");
}
}

int TestImplicitFitterRational(int argc, char* argv[])
{
  char* folder =
    vtkTestUtilities::GetArgOrEnvOrDefault("-T", argc, argv, "VTK_TEMP_DIR", "Testing/Temporary");
  Checks checks;
  TestParameters(checks);
  TestRefusedCombinations(checks);
  TestRefusedValues(checks);
  TestPrintedStepDiverges(checks);
  for (const bool planar : { true, false })
  {
    TestWeights(checks, planar);
    TestFile(checks, planar, folder);
  }
  TestCombinations(checks);
  TestReconstruction(checks);
  delete[] folder;
  return checks.Result();
}
