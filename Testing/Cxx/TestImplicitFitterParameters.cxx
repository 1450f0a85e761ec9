// SPDX-License-Identifier: BSD-3-Clause
/**
 * Parameters, optional inputs and the figures of the fit.
 */
#include "IPIATestShapes.h"
#include "IPIATestUtilities.h"

#include "vtkFieldData.h"
#include "vtkIPIAImplicitFunction.h"

namespace
{
using ipiatest::Checks;
using ipiatest::NewClassicFitter;
using ipiatest::SphereCloud;
using ipiatest::Text;

void TestEnumerations(Checks& checks)
{
  vtkNew<vtkIPIAImplicitFitter> fitter;
  fitter->SetNormalConstraintToOutwardOffset();
  checks.Equal(fitter->GetNormalConstraint(), 0, "OutwardOffset");
  fitter->SetNormalConstraintToTwoSidedOffset();
  checks.Equal(fitter->GetNormalConstraint(), 1, "TwoSidedOffset");
  fitter->SetSolverToConjugateGradient();
  checks.Equal(fitter->GetSolver(), 1, "ConjugateGradient");
  fitter->SetSolverToProgressiveIteration();
  checks.Equal(fitter->GetSolver(), 0, "ProgressiveIteration");
  fitter->SetStoppingRuleToEnergyChange();
  checks.Equal(fitter->GetStoppingRule(), 1, "EnergyChange");
  fitter->SetStoppingRuleToRelativeResidual();
  checks.Equal(fitter->GetStoppingRule(), 0, "RelativeResidual");
  fitter->SetOutputScalarTypeToDouble();
  checks.Equal(fitter->GetOutputScalarType(), VTK_DOUBLE, "double");
  fitter->SetOutputScalarTypeToFloat();
  checks.Equal(fitter->GetOutputScalarType(), VTK_FLOAT, "float");
}

/// The name of every property occurs.
void TestPrintSelf(Checks& checks)
{
  auto fitter = NewClassicFitter(SphereCloud(), 12);
  fitter->Update();
  std::ostringstream os;
  fitter->Print(os);
  for (const char* name : { "ModelBounds:", "Padding:", "GridSize:", "SampleDimensions:",
         "Dimension:", "NormalConstraint:", "OffsetDistance:", "OffsetValue:",
         "InwardOffsetDistance:", "InwardOffsetValue:", "Solver:", "NumberOfLevels:",
         "MaximumNumberOfIterations:", "Tolerance:", "StoppingRule:", "StepSize:",
         "GenerateGradient:", "GenerateSupport:", "OutputScalarType:", "NumberOfIterationsUsed:",
         "StepSizeUsed:", "Energy:", "AverageError:", "MaximumError:", "Oscillation:",
         "OffsetDistanceUsed:", "GridSizeUsed: (12, 12, 12)", "ModelBoundsUsed:" })
  {
    checks.That(os.str().find(name) != std::string::npos, Text("PrintSelf has ", name));
  }
  std::ostringstream function;
  fitter->GetImplicitFunction()->Print(function);
  checks.That(
    function.str().find("ControlLattice: set") != std::string::npos, "PrintSelf of the function");
}

double FieldValue(vtkIPIAImplicitFitter* fitter, const char* name, int component = 0)
{
  vtkDataArray* array = fitter->GetOutput()->GetFieldData()->GetArray(name);
  return array ? array->GetComponent(0, component) : std::nan("");
}

void TestFieldData(Checks& checks)
{
  auto fitter = NewClassicFitter(SphereCloud(), 12);
  fitter->Update();
  checks.Equal(FieldValue(fitter, "NumberOfIterationsUsed"), 20., "NumberOfIterationsUsed");
  checks.Equal(fitter->GetNumberOfIterationsUsed(), 20, "GetNumberOfIterationsUsed");
  checks.Equal(FieldValue(fitter, "StepSizeUsed"), fitter->GetStepSizeUsed(), "StepSizeUsed");
  checks.Equal(FieldValue(fitter, "Energy"), fitter->GetEnergy(), "Energy");
  checks.Equal(FieldValue(fitter, "AverageError"), fitter->GetAverageError(), "AverageError");
  checks.Equal(FieldValue(fitter, "MaximumError"), fitter->GetMaximumError(), "MaximumError");
  checks.Equal(FieldValue(fitter, "Oscillation"), fitter->GetOscillation(), "Oscillation");
  checks.Equal(FieldValue(fitter, "OffsetDistanceUsed"), fitter->GetOffsetDistanceUsed(),
    "OffsetDistanceUsed");
  for (int axis = 0; axis < 3; ++axis)
  {
    checks.Equal(FieldValue(fitter, "GridSizeUsed", axis), 12., "GridSizeUsed");
    checks.Equal(fitter->GetGridSizeUsed()[axis], 12, "GetGridSizeUsed");
  }
  for (int i = 0; i < 6; ++i)
  {
    checks.Equal(
      FieldValue(fitter, "ModelBoundsUsed", i), fitter->GetModelBoundsUsed()[i], "ModelBoundsUsed");
  }
  checks.AtMost(std::abs(fitter->GetOffsetDistanceUsed() / ipiatest::KnotSpacing(fitter) - 1.5),
    1e-12, "OffsetDistanceUsed is 1.5 knot spacings");
}

/// The errors are what the residuals of port 1 and the lattice of port 2 say.
void TestFigures(Checks& checks)
{
  auto fitter = NewClassicFitter(SphereCloud(), 12);
  fitter->Update();
  vtkDataArray* residual = ipiatest::FittedPoints(fitter)->GetPointData()->GetArray("Residual");
  vtkDataArray* distance = ipiatest::FittedPoints(fitter)->GetPointData()->GetArray("Distance");
  double squares = 0, largest = 0, distances = 0;
  for (vtkIdType i = 0; i < residual->GetNumberOfTuples(); ++i)
  {
    double x[3], g[3];
    ipiatest::FittedPoints(fitter)->GetPoint(i, x);
    const double f = residual->GetComponent(i, 0);
    squares += f * f;
    largest = std::max(largest, std::abs(f));
    fitter->GetImplicitFunction()->EvaluateGradient(x, g);
    const double slope = std::sqrt(g[0] * g[0] + g[1] * g[1] + g[2] * g[2]);
    distances = std::max(distances, std::abs(distance->GetComponent(i, 0) - f / slope));
  }
  checks.AtMost(distances, 1e-12, "Distance is f over its slope");
  checks.AtMost(std::abs(squares / 600 / fitter->GetAverageError() - 1), 1e-9, "AverageError");
  checks.Equal(fitter->GetMaximumError(), largest, "MaximumError");

  vtkImageData* lattice = ipiatest::ControlLattice(fitter);
  double oscillation = 0;
  for (int z = 0; z < 12; ++z)
  {
    for (int y = 0; y < 12; ++y)
    {
      for (int x = 0; x < 12; ++x)
      {
        const double c = lattice->GetScalarComponentAsDouble(x, y, z, 0);
        for (int axis = 0; axis < 3; ++axis)
        {
          const int n[3] = { x + (axis == 0), y + (axis == 1), z + (axis == 2) };
          if (n[axis] < 12)
          {
            const double d = lattice->GetScalarComponentAsDouble(n[0], n[1], n[2], 0) - c;
            oscillation += 2 * d * d; // as seen from either end
          }
        }
      }
    }
  }
  checks.AtMost(std::abs(oscillation / fitter->GetOscillation() - 1), 1e-9, "Oscillation");
}

void TestResidualHistory(Checks& checks, int solver)
{
  auto fitter = NewClassicFitter(SphereCloud(), 12);
  fitter->SetSolver(solver);
  fitter->Update();
  vtkDataArray* history = fitter->GetOutput()->GetFieldData()->GetArray("ResidualHistory");
  checks.Equal(history->GetNumberOfTuples(), vtkIdType(21), "values of ResidualHistory");
  checks.Equal(history->GetComponent(0, 0), 1.0, "first value of ResidualHistory");
  checks.AtMost(history->GetComponent(20, 0), 0.1, "last value of ResidualHistory");
}

void TestTolerance(Checks& checks)
{
  for (int rule : { vtkIPIAImplicitFitter::RelativeResidual, vtkIPIAImplicitFitter::EnergyChange })
  {
    auto fitter = NewClassicFitter(SphereCloud(), 12);
    fitter->SetMaximumNumberOfIterations(500);
    fitter->SetStoppingRule(rule);
    fitter->SetTolerance(0.05);
    fitter->Update();
    const std::string what = Text("stopping rule ", rule);
    const int used = fitter->GetNumberOfIterationsUsed();
    checks.That(used > 1 && used < 500, Text(what, " ends the iteration (", used, ")"));
    if (rule == vtkIPIAImplicitFitter::RelativeResidual)
    {
      vtkDataArray* history = fitter->GetOutput()->GetFieldData()->GetArray("ResidualHistory");
      checks.That(
        history->GetComponent(used, 0) < 0.05 && history->GetComponent(used - 1, 0) >= 0.05,
        what + ": at the first residual below the tolerance");
    }
  }
}

/// A step given is the step used; the automatic one given gives the same fit.
void TestStepSize(Checks& checks)
{
  auto automatic = NewClassicFitter(SphereCloud(), 12);
  automatic->Update();
  auto given = NewClassicFitter(SphereCloud(), 12);
  given->SetStepSize(automatic->GetStepSizeUsed());
  given->Update();
  checks.That(ipiatest::SameOutputs(automatic, given), "the automatic step size given");
  given->SetStepSize(automatic->GetStepSizeUsed() / 2);
  given->Update();
  checks.Equal(
    given->GetStepSizeUsed(), automatic->GetStepSizeUsed() / 2, "half the automatic step size");
  given->SetSolverToConjugateGradient();
  given->Update();
  checks.Equal(given->GetStepSizeUsed(), 0.0, "the step size of conjugate gradients");
}

/// Two spheres that cannot both be met: heavier points win. Weight 0 is no row.
void TestWeights(Checks& checks)
{
  ipiatest::OrientedPoints both = ipiatest::SpherePoints(600, 1);
  both.Append(ipiatest::SpherePoints(600, 1.1));
  auto cloud = ipiatest::ToPolyData(both);
  auto weights = ipiatest::Constant("Importance", 1200, 1);
  cloud->GetPointData()->AddArray(weights);
  double value[3];
  int k = 0;
  for (double heavy : { 1., 100., 0. })
  {
    for (vtkIdType i = 0; i < 1200; ++i)
    {
      weights->SetValue(i, i < 600 ? heavy : 1);
    }
    auto fitter = NewClassicFitter(cloud, 12);
    fitter->SetSolverToConjugateGradient();
    fitter->SetOffsetDistance(0.3);
    fitter->SetInputArrayToProcess(1, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, "Importance");
    fitter->Update();
    double x[3] = { 0, 0, 1 };
    value[k++] = fitter->GetImplicitFunction()->EvaluateFunction(x);
  }
  checks.AtMost(std::abs(value[0] + 0.05), 0.02, "f at a point of weight 1, half way between");
  checks.AtMost(std::abs(value[1]), 0.02, "f at a point of weight 100");
  checks.AtMost(std::abs(value[2] + 0.1), 0.03, "f at a point of weight 0, 0.1 inside the other");
}

/// All weights times the same number change nothing but the energy.
void TestScaledWeights(Checks& checks)
{
  auto cloud = SphereCloud();
  cloud->GetPointData()->AddArray(ipiatest::Constant("Importance", 600, 8));
  auto weighted = NewClassicFitter(cloud, 12);
  weighted->SetInputArrayToProcess(1, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, "Importance");
  weighted->Update();
  auto plain = NewClassicFitter(SphereCloud(), 12);
  plain->Update();
  checks.AtMost(ipiatest::LargestDifference(weighted->GetOutput()->GetPointData()->GetScalars(),
                  plain->GetOutput()->GetPointData()->GetScalars()),
    1e-6, "weights of 8: difference of f");
  checks.AtMost(
    std::abs(weighted->GetEnergy() / plain->GetEnergy() - 8), 1e-6, "weights of 8: energy");
}

/// Points known to lie inside, by active scalars and by name.
void TestExtraRows(Checks& checks)
{
  auto rows = SphereCloud(50, 0.3);
  auto values = ipiatest::Constant("Target", 50, -0.7);
  double centre[3] = { 0, 0, 0.3 };
  for (bool byName : { false, true })
  {
    rows->GetPointData()->SetScalars(byName ? nullptr : values.GetPointer());
    rows->GetPointData()->AddArray(values);
    auto fitter = NewClassicFitter(SphereCloud(), 12);
    fitter->SetSolverToConjugateGradient();
    fitter->SetExtraRowsData(rows);
    if (byName)
    {
      fitter->SetInputArrayToProcess(2, 1, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, "Target");
    }
    fitter->Update();
    checks.AtMost(std::abs(fitter->GetImplicitFunction()->EvaluateFunction(centre) + 0.7), 0.05,
      byName ? "extra rows by name" : "extra rows by active scalars");
  }
  // The rows that move the function away are a new fit.
  auto fitter = NewClassicFitter(SphereCloud(), 12);
  fitter->SetSolverToConjugateGradient();
  fitter->SetExtraRowsData(rows);
  rows->GetPointData()->SetScalars(values);
  fitter->Update();
  values->Fill(-0.4);
  values->Modified();
  fitter->Update();
  checks.AtMost(std::abs(fitter->GetImplicitFunction()->EvaluateFunction(centre) + 0.4), 0.05,
    "changed extra rows");
}

/// Dimension 3 for planar points gives a volume, 0 and 2 a slice.
void TestDimension(Checks& checks)
{
  auto cloud = ipiatest::ToPolyData(ipiatest::PointsOn(ipiatest::Circle(1), 100));
  for (int dimension : { 0, 2, 3 })
  {
    auto fitter = NewClassicFitter(cloud, 12);
    fitter->SetDimension(dimension);
    fitter->Update();
    checks.Equal(fitter->GetOutput()->GetDataDimension(), dimension == 3 ? 3 : 2,
      Text("dimension of the image with Dimension ", dimension));
  }
}

/// Planar points whose normals point out of their plane are a surface in a padded box.
void TestPlaneInSpace(Checks& checks)
{
  ipiatest::OrientedPoints plane;
  for (int i = 0; i < 400; ++i)
  {
    plane.Add({ 0.1 * (i % 20), 0.1 * (i / 20), 5 }, { 0, 0, 1 });
  }
  auto fitter = NewClassicFitter(ipiatest::ToPolyData(plane));
  vtkNew<ipiatest::MessageObserver> messages;
  messages->Watch(fitter);
  fitter->Update();
  messages->CheckOneWarning(checks, "which is open there", "plane in space");
  checks.Equal(fitter->GetOutput()->GetDataDimension(), 3, "dimension of a plane in space");
  double above[3] = { 1, 1, 5.1 }, below[3] = { 1, 1, 4.9 };
  vtkIPIAImplicitFunction* f = fitter->GetImplicitFunction();
  checks.That(f->EvaluateFunction(above) > 0.05 && f->EvaluateFunction(below) < -0.05,
    "the sides of a plane in space");
}
}

int TestImplicitFitterParameters(int, char*[])
{
  Checks checks;
  TestEnumerations(checks);
  TestPrintSelf(checks);
  TestFieldData(checks);
  TestFigures(checks);
  TestResidualHistory(checks, vtkIPIAImplicitFitter::ProgressiveIteration);
  TestResidualHistory(checks, vtkIPIAImplicitFitter::ConjugateGradient);
  TestTolerance(checks);
  TestStepSize(checks);
  TestWeights(checks);
  TestScaledWeights(checks);
  TestExtraRows(checks);
  TestDimension(checks);
  TestPlaneInSpace(checks);
  return checks.Result();
}
