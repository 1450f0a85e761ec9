// SPDX-License-Identifier: BSD-3-Clause
/**
 * The parameters of the hierarchy: combinations that are refused, levels, iterations, fairing,
 * extra rows, weights, and a saved control lattice.
 */
#include "IPIATestShapes.h"
#include "IPIATestUtilities.h"

#include "vtkIPIAImplicitFunction.h"
#include "vtkSphereSource.h"
#include "vtkTriangle.h"
#include "vtkXMLImageDataReader.h"
#include "vtkXMLImageDataWriter.h"

#include <functional>
#include <limits>

namespace
{
using ipiatest::Checks;
using ipiatest::Method;
using ipiatest::SphereCloud;
using ipiatest::Text;

using Setup = std::function<void(vtkIPIAImplicitFitter*)>;

void CheckCombination(
  Checks& checks, const std::string& what, const std::string& refusal, const Setup& setup)
{
  vtkNew<vtkIPIAImplicitFitter> fitter;
  fitter->SetInputData(SphereCloud());
  fitter->SetGridSize(12, 12, 12);
  setup(fitter);
  vtkNew<ipiatest::MessageObserver> messages;
  messages->Watch(fitter);
  fitter->Update();
  if (refusal.empty())
  {
    messages->CheckSilence(checks, what);
    checks.That(ipiatest::OutputsAreSound(fitter), what + ": all outputs are finite");
  }
  else
  {
    messages->CheckOneError(checks, refusal, what);
    checks.That(ipiatest::OutputsAreEmpty(fitter), what + ": all outputs are empty");
  }
}

void TestCombinations(Checks& checks)
{
  const std::string solver = "ProgressiveIteration solves a single level with offset rows";
  const std::string step = "StepSize belongs to ProgressiveIteration";
  const std::string fairing = "FairingWeight and local fairing weights belong to the hierarchy";
  const Setup classic = [](auto* f)
  {
    f->SetNumberOfLevels(1);
    f->SetNormalConstraintToTwoSidedOffset();
  };
  CheckCombination(checks, "ProgressiveIteration with levels", solver,
    [](auto* f) { f->SetSolverToProgressiveIteration(); });
  CheckCombination(checks, "ProgressiveIteration with levels and offsets", solver,
    [](auto* f)
    {
      f->SetSolverToProgressiveIteration();
      f->SetNormalConstraintToOutwardOffset();
    });
  CheckCombination(checks, "ProgressiveIteration with gradient rows on one level", solver,
    [](auto* f)
    {
      f->SetSolverToProgressiveIteration();
      f->SetNumberOfLevels(1);
    });
  CheckCombination(checks, "StepSize with levels", step, [](auto* f) { f->SetStepSize(0.01); });
  CheckCombination(checks, "FairingWeight on one level with offsets", fairing,
    [&](auto* f)
    {
      classic(f);
      f->SetFairingWeight(1e-4);
    });
  CheckCombination(checks, "FairingWeight 0 on one level with offsets", "",
    [&](auto* f)
    {
      classic(f);
      f->SetFairingWeight(0);
    });
  CheckCombination(checks, "FairingWeight on one level with gradient rows", "",
    [](auto* f)
    {
      f->SetNumberOfLevels(1);
      f->SetFairingWeight(1e-3);
    });
  CheckCombination(checks, "ProgressiveIteration with StepSize on one level with offsets", "",
    [&](auto* f)
    {
      classic(f);
      f->SetSolverToProgressiveIteration();
      f->SetStepSize(1e-3);
    });
}

/// Cells along the longest side are halved (rounded up) until there are no more than 16, or as
/// often as is asked for and possible.
void TestNumberOfLevels(Checks& checks)
{
  const int cases[][3] = {
    // GridSize, NumberOfLevels, levels used
    { 19, 0, 1 }, // 16 cells
    { 20, 0, 2 }, // 17, 9
    { 35, 0, 2 }, // 32, 16
    { 36, 0, 3 }, // 33, 17, 9
    { 67, 0, 3 }, // 64, 32, 16
    { 36, 1, 1 },
    { 70, 1, 1 },
    { 36, 2, 2 },
    { 36, 5, 5 },
    { 12, 20, 5 }, // 9, 5, 3, 2, 1
    { 4, 0, 1 },
  };
  for (const auto& c : cases)
  {
    auto fitter = NewFitter(Method::Default, SphereCloud(), c[0]);
    fitter->SetNumberOfLevels(c[1]);
    fitter->Update();
    const std::string what = Text("GridSize ", c[0], ", NumberOfLevels ", c[1]);
    checks.Equal(fitter->GetNumberOfLevelsUsed(), c[2], what + ": levels used");
    checks.Equal(fitter->GetNumberOfLevels(), c[1], what + ": the parameter stays");
    checks.That(ipiatest::OutputsAreSound(fitter), what + ": all outputs are finite");
    checks.Equal(
      fitter->GetOutput()->GetFieldData()->GetArray("NumberOfLevelsUsed")->GetComponent(0, 0),
      static_cast<double>(c[2]), what + ": field data");
  }
  auto classic = NewFitter(Method::Classic, SphereCloud(), 12);
  classic->Update();
  checks.Equal(classic->GetNumberOfLevelsUsed(), 1, "levels of the classic method");
}

vtkDataArray* History(vtkIPIAImplicitFitter* fitter)
{
  return fitter->GetOutput()->GetFieldData()->GetArray("ResidualHistory");
}

/// Of the finest level.
void TestIterations(Checks& checks)
{
  auto fitter = NewFitter(Method::Default, SphereCloud(2000), 40);
  fitter->Update();
  const int automatic = fitter->GetNumberOfIterationsUsed();
  checks.That(automatic > 0 && automatic <= 12, Text("iterations by default (", automatic, ")"));
  checks.That(automatic == 12 || History(fitter)->GetComponent(automatic, 0) < 1e-3,
    "fewer than 12 iterations only below 1e-3");
  for (int given : { 1, 5, 40 })
  {
    fitter->SetMaximumNumberOfIterations(given);
    fitter->Update();
    const std::string what = Text("MaximumNumberOfIterations ", given);
    checks.Equal(fitter->GetNumberOfIterationsUsed(), given, what);
    checks.Equal(
      History(fitter)->GetNumberOfTuples(), vtkIdType(given + 1), what + ": ResidualHistory");
    checks.Equal(History(fitter)->GetComponent(0, 0), 1.0, what + ": first residual");
  }
  checks.AtMost(History(fitter)->GetComponent(40, 0), 0.1 * History(fitter)->GetComponent(5, 0),
    "residual after 40 iterations");
}

void TestTolerance(Checks& checks)
{
  for (int rule : { vtkIPIAImplicitFitter::RelativeResidual, vtkIPIAImplicitFitter::EnergyChange })
  {
    for (int most : { 0, 50 })
    {
      auto fitter = NewFitter(Method::Default, SphereCloud(2000), 40);
      fitter->SetMaximumNumberOfIterations(most);
      fitter->SetStoppingRule(rule);
      fitter->SetTolerance(rule == vtkIPIAImplicitFitter::RelativeResidual ? 0.1 : 0.01);
      fitter->Update();
      const std::string what = Text("stopping rule ", rule, ", at most ", most);
      const int used = fitter->GetNumberOfIterationsUsed();
      checks.That(
        used > 0 && used < (most > 0 ? most : 12), Text(what, " ends the iteration (", used, ")"));
      if (rule == vtkIPIAImplicitFitter::RelativeResidual)
      {
        checks.That(History(fitter)->GetComponent(used, 0) < 0.1 &&
            History(fitter)->GetComponent(used - 1, 0) >= 0.1,
          what + ": at the first residual below the tolerance");
      }
    }
  }
}

/// The sum of the squared differences of neighbouring coefficients, first or second ones.
double Roughness(vtkIPIAImplicitFitter* fitter, int order)
{
  vtkImageData* lattice = ipiatest::ControlLattice(fitter);
  const int* n = lattice->GetDimensions();
  auto* c = vtkDoubleArray::SafeDownCast(lattice->GetPointData()->GetScalars());
  const vtkIdType stride[3] = { 1, n[0], static_cast<vtkIdType>(n[0]) * n[1] };
  double sum = 0;
  for (int z = 0; z < n[2]; ++z)
  {
    for (int y = 0; y < n[1]; ++y)
    {
      for (int x = 0; x < n[0]; ++x)
      {
        const int at[3] = { x, y, z };
        const vtkIdType i = x + y * stride[1] + z * stride[2];
        for (int a = 0; a < 3; ++a)
        {
          if (at[a] + order < n[a])
          {
            const double first = c->GetValue(i + stride[a]) - c->GetValue(i);
            const double d = order == 1
              ? first
              : c->GetValue(i + 2 * stride[a]) - c->GetValue(i + stride[a]) - first;
            sum += d * d;
          }
        }
      }
    }
  }
  return sum;
}

/// The larger the weight, the less of the energy of its order is left and the farther f is from the
/// noisy points.
void TestFairing(Checks& checks)
{
  auto cloud = ipiatest::ToPolyData(ipiatest::NoisySphere(6000, 0.02));
  for (int order : { 1, 2 })
  {
    double roughness = std::numeric_limits<double>::infinity(), error = 0;
    for (double weight : { 0., 1e-3, 0.1, 10. })
    {
      auto fitter = NewFitter(Method::Default, cloud, 48);
      fitter->SetFairingOrder(order);
      fitter->SetFairingWeight(weight);
      fitter->SetMaximumNumberOfIterations(40);
      fitter->Update();
      const std::string what = Text("FairingOrder ", order, ", FairingWeight ", weight);
      const double rough = Roughness(fitter, order);
      checks.That(rough < roughness, Text(what, ": smoother than ", roughness, " (", rough, ")"));
      checks.That(fitter->GetAverageError() > error,
        Text(what, ": farther than ", error, " (", fitter->GetAverageError(), ")"));
      checks.Equal(fitter->GetSmoothingLengthUsed(), 0.0, what + ": SmoothingLengthUsed");
      checks.Equal(fitter->GetFairingWeight(), weight, what + ": the parameter stays");
      roughness = rough;
      error = fitter->GetAverageError();
    }
  }
}

/// Automatic fairing smooths noisy points and only those; then the order does not count.
void TestAutomaticFairing(Checks& checks)
{
  for (double noise : { 0., 0.05 })
  {
    auto cloud = ipiatest::ToPolyData(ipiatest::NoisySphere(20000, noise));
    auto fitter = NewFitter(Method::Default, cloud, 70);
    fitter->Update();
    const std::string what = Text("noise ", noise);
    checks.Equal(fitter->GetSmoothingLengthUsed() > 0, noise > 0, what + ": smoothing");
    if (noise > 0)
    {
      // The spread of a uniform deviation; some of it is fitted.
      const double expected = noise / std::sqrt(3.);
      checks.That(
        fitter->GetNoiseFound() > 0.3 * expected && fitter->GetNoiseFound() < 1.1 * expected,
        Text(what, ": NoiseFound ", fitter->GetNoiseFound(), " near ", expected));
    }
    else
    {
      checks.AtMost(fitter->GetNoiseFound(), 0.01, what + ": NoiseFound");
    }
    auto other = NewFitter(Method::Default, cloud, 70);
    other->SetFairingOrder(1);
    other->Update();
    checks.That(ipiatest::SameOutputs(fitter, other), what + ": FairingOrder without a weight");
  }
}

/// Points at random on the faces of a sphere of triangles, with their normals.
ipiatest::OrientedPoints FacetedSphere(int seed, int n)
{
  vtkNew<vtkSphereSource> sphere;
  sphere->SetThetaResolution(16);
  sphere->SetPhiResolution(12);
  sphere->Update();
  vtkNew<vtkMinimalStandardRandomSequence> random;
  random->SetSeed(seed);
  const auto next = [&random]()
  {
    random->Next();
    return random->GetValue();
  };
  ipiatest::OrientedPoints points;
  for (int k = 0; k < n; ++k)
  {
    vtkPoints* corners =
      sphere->GetOutput()->GetCell(k % sphere->GetOutput()->GetNumberOfCells())->GetPoints();
    double u = next(), v = next();
    if (u + v > 1)
    {
      u = 1 - u;
      v = 1 - v;
    }
    double c[3][3], normal[3];
    for (vtkIdType i = 0; i < 3; ++i)
    {
      corners->GetPoint(i, c[i]);
    }
    vtkTriangle::ComputeNormal(c[0], c[1], c[2], normal);
    ipiatest::Vector3 x{};
    for (std::size_t i = 0; i < 3; ++i)
    {
      x[i] = (1 - u - v) * c[0][i] + u * c[1][i] + v * c[2][i];
    }
    points.Add(x, { normal[0], normal[1], normal[2] });
  }
  return points;
}

/// A lattice that is finer than the points is no less accurate, as its fairing is stronger.
void TestLatticesFinerThanThePoints(Checks& checks)
{
  auto cloud = ipiatest::ToPolyData(FacetedSphere(1, 6000));
  const ipiatest::OrientedPoints truth = FacetedSphere(2, 5000);
  const auto errorOf = [&](int cells, double fairingWeight)
  {
    auto fitter = NewFitter(Method::Default, cloud);
    fitter->SetGridSize(cells > 0 ? cells + 3 : 0, 0, 0);
    fitter->SetFairingWeight(fairingWeight);
    fitter->Update();
    double sum = 0;
    for (ipiatest::Vector3 x : truth.Positions)
    {
      sum += std::abs(fitter->GetImplicitFunction()->EvaluateFunction(x.data()));
    }
    return sum / 5000;
  };
  const double automatic = errorOf(0, -1);
  for (int cells : { 128, 256 })
  {
    const double finer = errorOf(cells, -1), unscaled = errorOf(cells, 5e-5);
    checks.AtMost(finer, automatic, Text("mean error on ", cells, " cells"));
    checks.That(finer < 0.9 * unscaled,
      Text("mean error on ", cells, " cells, less than unscaled: ", finer, ", ", unscaled));
  }
}

/// Nothing else smooths levels of up to 32 cells.
void TestFairingOfCoarseLevels(Checks& checks)
{
  auto plain = NewFitter(Method::Default, SphereCloud(), 30);
  auto faired = NewFitter(Method::Default, SphereCloud(), 30);
  faired->SetFairingWeight(10);
  plain->Update();
  faired->Update();
  checks.That(ipiatest::SameOutputs(plain, faired), "FairingWeight on 27 cells changes nothing");
}

vtkSmartPointer<vtkDoubleArray> AddWeights(vtkPolyData* cloud)
{
  auto weights = ipiatest::Constant("Importance", cloud->GetNumberOfPoints(), 1);
  cloud->GetPointData()->AddArray(weights);
  return weights;
}

vtkSmartPointer<vtkIPIAImplicitFitter> WeightedFit(vtkPolyData* cloud, int gridSize)
{
  auto fitter = NewFitter(Method::Default, cloud, gridSize);
  fitter->SetOutputScalarTypeToDouble();
  fitter->SetInputArrayToProcess(1, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, "Importance");
  fitter->Update();
  return fitter;
}

/// Two spheres that cannot both be met: heavier points win. Weight 0 is no row.
void TestWeights(Checks& checks)
{
  ipiatest::OrientedPoints both = ipiatest::SpherePoints(600, 1);
  both.Append(ipiatest::SpherePoints(600, 1.1));
  auto cloud = ipiatest::ToPolyData(both);
  auto weights = AddWeights(cloud);
  const double heavy[] = { 1, 100, 0 }, expected[] = { -0.05, 0, -0.1 };
  for (int k = 0; k < 3; ++k)
  {
    for (vtkIdType i = 0; i < 1200; ++i)
    {
      weights->SetValue(i, i < 600 ? heavy[k] : 1);
    }
    double x[3] = { 0, 0, 1 };
    checks.AtMost(
      std::abs(WeightedFit(cloud, 12)->GetImplicitFunction()->EvaluateFunction(x) - expected[k]),
      0.02, Text("f at a point of weight ", heavy[k], " from ", expected[k]));
  }
}

/// All weights times the same number change nothing, however large or small it is.
void TestScaledWeights(Checks& checks)
{
  auto cloud = SphereCloud();
  auto weights = AddWeights(cloud);
  auto plain = NewFitter(Method::Default, SphereCloud(), 24);
  plain->SetOutputScalarTypeToDouble();
  plain->Update();
  for (double weight : { 8., 0.3, 1e12, 1e-12, 1e45, 1e-50, 1e300, 1e-300 })
  {
    weights->Fill(weight);
    weights->Modified();
    auto weighted = WeightedFit(cloud, 24);
    const std::string what = Text("weights of ", weight);
    checks.That(ipiatest::OutputsAreSound(weighted), what + ": all outputs are finite");
    checks.AtMost(ipiatest::LargestDifference(weighted->GetOutput()->GetPointData()->GetScalars(),
                    plain->GetOutput()->GetPointData()->GetScalars()),
      1e-4, what + ": difference of f");
  }
}

/// Points known to lie inside, by active scalars and by name.
void TestExtraRows(Checks& checks)
{
  auto rows = SphereCloud(50, 0.3);
  vtkNew<vtkDoubleArray> seven, four;
  for (auto values : { std::make_pair(seven.Get(), -0.7), std::make_pair(four.Get(), -0.4) })
  {
    values.first->SetNumberOfTuples(50);
    values.first->Fill(values.second);
    values.first->SetName(values.second == -0.7 ? "Seven" : "Four");
    rows->GetPointData()->AddArray(values.first);
  }
  rows->GetPointData()->SetActiveScalars("Seven");
  double x[3] = { 0, 0, 0.3 };
  for (Method method : ipiatest::Methods)
  {
    auto fitter = NewFitter(method, SphereCloud(), 12);
    fitter->SetSolverToConjugateGradient();
    fitter->SetExtraRowsData(rows);
    const auto check = [&](double expected, const std::string& how)
    {
      fitter->Update();
      checks.AtMost(std::abs(fitter->GetImplicitFunction()->EvaluateFunction(x) - expected), 0.05,
        Text("f at extra rows ", how, ", ", NameOf(method)));
    };
    check(-0.7, "by active scalars");
    fitter->SetInputArrayToProcess(2, 1, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, "Four");
    check(-0.4, "by name");
    fitter->SetInputArrayToProcess(2, 1, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, "Seven");
    check(-0.7, "by another name");
    seven->Fill(-0.4);
    seven->Modified();
    check(-0.4, "changed");
    seven->Fill(-0.7);
    seven->Modified();
  }
}

/// The rows' own values: outward and inward distances and values may differ. In a hierarchy they
/// take the place of gradient rows.
void TestOffsets(Checks& checks)
{
  double out[3] = { 0, 0, 1.1 }, in[3] = { 0, 0, 0.88 };
  for (Method method : ipiatest::Methods)
  {
    const std::string name = NameOf(method) + ", ";
    auto fitter = NewFitter(method, SphereCloud(4000), 40);
    fitter->SetNormalConstraintToTwoSidedOffset();
    fitter->SetSolverToConjugateGradient();
    fitter->SetMaximumNumberOfIterations(50);
    fitter->SetOffsetDistance(0.1);
    fitter->SetOffsetValue(0.3);
    fitter->SetInwardOffsetDistance(0.12);
    fitter->SetInwardOffsetValue(0.2);
    fitter->Update();
    vtkIPIAImplicitFunction* f = fitter->GetImplicitFunction();
    checks.AtMost(std::abs(f->EvaluateFunction(out) - 0.3), 0.03, name + "f at the outward rows");
    checks.AtMost(std::abs(f->EvaluateFunction(in) + 0.2), 0.03, name + "f at the inward rows");
    checks.Equal(fitter->GetOffsetDistanceUsed(), 0.1, name + "OffsetDistanceUsed");
    if (method == Method::Default)
    {
      fitter->SetNormalConstraintToGradient();
      fitter->Update();
      checks.AtMost(std::abs(f->EvaluateFunction(out) - 0.1), 0.03, "f outside with gradient rows");
      checks.Equal(fitter->GetOffsetDistanceUsed(), 0.0, "OffsetDistanceUsed with gradient rows");
    }
  }
}

/// Written and read back, the control lattice is the function.
void TestSavedLattice(Checks& checks)
{
  for (bool planar : { false, true })
  {
    auto cloud = planar ? ipiatest::ToPolyData(
                            ipiatest::InPlane(ipiatest::PointsOn(ipiatest::Flower(), 400), 0, 2, 3))
                        : SphereCloud(2000);
    auto fitter = NewFitter(Method::Default, cloud);
    fitter->Update();
    vtkNew<vtkXMLImageDataWriter> writer;
    writer->SetInputData(ipiatest::ControlLattice(fitter));
    writer->WriteToOutputStringOn();
    writer->Write();
    vtkNew<vtkXMLImageDataReader> reader;
    reader->ReadFromInputStringOn();
    reader->SetInputString(writer->GetOutputString());
    reader->Update();
    vtkNew<vtkIPIAImplicitFunction> saved;
    saved->SetControlLattice(reader->GetOutput());
    const double* b = fitter->GetModelBoundsUsed();
    double difference = 0;
    for (int i = 0; i < 1000; ++i)
    {
      double x[3];
      for (int a = 0; a < 3; ++a)
      {
        // From well outside to well outside.
        const double share = std::fmod(0.37 * (a + 1) * i, 1.6) - 0.3;
        x[a] = b[2 * a] + share * (b[2 * a + 1] - b[2 * a]);
      }
      difference = std::max(difference,
        std::abs(saved->EvaluateFunction(x) - fitter->GetImplicitFunction()->EvaluateFunction(x)));
    }
    checks.AtMost(difference, 1e-12, planar ? "saved planar lattice" : "saved lattice");
  }
}
}

int TestImplicitFitterHierarchyParameters(int, char*[])
{
  Checks checks;
  TestCombinations(checks);
  TestNumberOfLevels(checks);
  TestIterations(checks);
  TestTolerance(checks);
  TestFairing(checks);
  TestAutomaticFairing(checks);
  TestLatticesFinerThanThePoints(checks);
  TestFairingOfCoarseLevels(checks);
  TestWeights(checks);
  TestScaledWeights(checks);
  TestExtraRows(checks);
  TestOffsets(checks);
  TestSavedLattice(checks);
  return checks.Result();
}
