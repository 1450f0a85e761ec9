// SPDX-License-Identifier: BSD-3-Clause
/**
 * Overlapping scans are feathered: points near the border of their scan count less where another
 * one has seen the same place better, by the factors that the fitter's documentation tells.
 */
#include "IPIATestShapes.h"
#include "IPIATestUtilities.h"

#include "vtkIPIAImplicitFunction.h"
#include "vtkMultiBlockDataSet.h"

#include <omp.h>

#include <algorithm>
#include <cmath>

namespace
{
using ipiatest::Checks;
using ipiatest::MessageObserver;
using ipiatest::OrientedPoints;
using ipiatest::Vector3;

constexpr double LeftEnd = 1, RightBegin = 0.6, Width = 1.6, Step = 0.02;

/// A scan of the plane z = 0 between two x, on a grid. Its points rise towards both ends, as they
/// do at silhouettes.
OrientedPoints PlaneScan(double begin, double end, double rise)
{
  OrientedPoints scan;
  for (double x = begin; x < end; x += Step)
  {
    for (double y = begin / 100; y < 1; y += Step)
    {
      const double toEnd = std::min(x - begin, end - x);
      scan.Add({ x, y, rise * std::exp(-toEnd / Step) }, { 0, 0, 1 });
    }
  }
  return scan;
}

vtkSmartPointer<vtkMultiBlockDataSet> BlocksOf(const std::vector<OrientedPoints>& scans)
{
  auto blocks = vtkSmartPointer<vtkMultiBlockDataSet>::New();
  for (const OrientedPoints& scan : scans)
  {
    blocks->SetBlock(blocks->GetNumberOfBlocks(), ipiatest::ToPolyData(scan));
  }
  return blocks;
}

/// Two scans of a plane, whose ends overlap.
vtkSmartPointer<vtkMultiBlockDataSet> TwoScans(double rise)
{
  return BlocksOf({ PlaneScan(0, LeftEnd, rise), PlaneScan(RightBegin + Step / 3, Width, rise) });
}

vtkSmartPointer<vtkIPIAImplicitFitter> Fitted(vtkDataObject* input, bool feather = true)
{
  auto fitter = vtkSmartPointer<vtkIPIAImplicitFitter>::New();
  fitter->SetInputDataObject(input);
  fitter->SetGridSize(40, 0, 0);
  fitter->SetFeatherScans(feather);
  fitter->Update();
  return fitter;
}

vtkDataArray* FactorsOf(vtkIPIAImplicitFitter* fitter)
{
  return vtkPolyData::SafeDownCast(fitter->GetOutputDataObject(1))
    ->GetPointData()
    ->GetArray("Feathering");
}

double Distance(const Vector3& a, const Vector3& b)
{
  return std::sqrt(vtkMath::Distance2BetweenPoints(a.data(), b.data()));
}

/// The distances of a scan's points to a position, in order, each with its point.
std::vector<std::pair<double, std::size_t>> Nearest(const OrientedPoints& scan, const Vector3& x)
{
  std::vector<std::pair<double, std::size_t>> near;
  for (std::size_t k = 0; k < scan.Positions.size(); ++k)
  {
    near.emplace_back(Distance(x, scan.Positions[k]), k);
  }
  std::sort(near.begin(), near.end());
  return near;
}

double Confidence(const OrientedPoints& scan, const Vector3& x)
{
  const auto near = Nearest(scan, x);
  const std::size_t count = std::min<std::size_t>(33, near.size());
  Vector3 shift{ 0, 0, 0 };
  for (std::size_t i = 0; i < count; ++i)
  {
    for (std::size_t a = 0; a < 3; ++a)
    {
      shift[a] += (scan.Positions[near[i].second][a] - x[a]) / static_cast<double>(count);
    }
  }
  const double s = vtkMath::Norm(shift.data()) / near[count - 1].first;
  return 0.05 + 0.95 * std::exp(-(s / 0.1) * (s / 0.1));
}

/// The median distance of the fourth neighbours.
double SpacingOf(const OrientedPoints& scan)
{
  std::vector<double> fourth;
  for (const Vector3& x : scan.Positions)
  {
    fourth.push_back(Nearest(scan, x)[4].first);
  }
  std::sort(fourth.begin(), fourth.end());
  return fourth[fourth.size() / 2];
}

/// Points at random, so that no two neighbours are equally far.
OrientedPoints RandomScan(int seed, int n, double begin, double end)
{
  vtkNew<vtkMinimalStandardRandomSequence> random;
  random->SetSeed(seed);
  const auto next = [&random](double low, double high)
  {
    random->Next();
    return random->GetRangeValue(low, high);
  };
  OrientedPoints scan;
  for (int k = 0; k < n; ++k)
  {
    const double x = next(begin, end), y = next(0, 1);
    scan.Add({ x, y, 0.1 * std::sin(3 * x) * std::cos(2 * y) }, { 0, 0, 1 });
  }
  return scan;
}

/// The documented factors, by comparing everything with everything; a point that is no number comes
/// before each scan and is left out.
void TestFactors(Checks& checks)
{
  const std::vector<OrientedPoints> scans{ RandomScan(1, 900, 0, 1), RandomScan(2, 700, 0.5, 1.5),
    RandomScan(3, 300, 0.8, 1.2), RandomScan(4, 20, 0.2, 0.4) };
  std::vector<OrientedPoints> given;
  std::vector<double> spacings;
  for (const OrientedPoints& scan : scans)
  {
    spacings.push_back(SpacingOf(scan));
    given.emplace_back();
    given.back().Add({ std::nan(""), 0, 0 }, { 0, 0, 1 });
    for (std::size_t k = 0; k < scan.Positions.size(); ++k)
    {
      given.back().Add(scan.Positions[k], scan.Normals[k]);
    }
  }
  vtkNew<MessageObserver> messages;
  auto fitter = vtkSmartPointer<vtkIPIAImplicitFitter>::New();
  messages->Watch(fitter);
  fitter->SetInputDataObject(BlocksOf(given));
  fitter->Update();
  messages->CheckOneWarning(checks, "4 non-finite", "a point less in each scan");
  vtkDataArray* factors = FactorsOf(fitter);
  if (!checks.That(factors && factors->GetNumberOfTuples() == 1920, "a factor for each point"))
  {
    return;
  }
  double largest = 0;
  vtkIdType id = 0, smaller = 0;
  for (std::size_t own = 0; own < scans.size(); ++own)
  {
    for (const Vector3& x : scans[own].Positions)
    {
      double cover = 0;
      for (std::size_t other = 0; other < scans.size(); ++other)
      {
        const auto near = other == own ? Nearest({}, x) : Nearest(scans[other], x);
        if (!near.empty() && near[0].first <= 2 * std::max(spacings[own], spacings[other]))
        {
          const Vector3& there = scans[other].Positions[near[0].second];
          cover = std::max(cover, Confidence(scans[other], there));
        }
      }
      const double confidence = Confidence(scans[own], x);
      const double expected = std::max(0.05, cover > confidence ? confidence / cover : 1.0);
      smaller += expected < 1 ? 1 : 0;
      largest = std::max(largest, std::abs(factors->GetComponent(id++, 0) - expected));
    }
  }
  checks.AtMost(largest, 1e-12, "factors as documented");
  checks.That(
    smaller > 400 && smaller < 1500, "some count less, not all: " + std::to_string(smaller));
}

/// Ends that rise are told from the plane that the other scan has seen.
void TestRisingEnds(Checks& checks)
{
  auto scans = TwoScans(0.02);
  const auto errorOf = [](vtkIPIAImplicitFitter* fitter)
  {
    double sum = 0;
    int count = 0;
    for (double x = RightBegin + 0.01; x < LeftEnd; x += 0.005)
    {
      for (double y = 0.2; y < 0.8; y += 0.05)
      {
        double at[3] = { x, y, 0 };
        sum += std::abs(fitter->GetImplicitFunction()->EvaluateFunction(at));
        ++count;
      }
    }
    return sum / count;
  };
  const double with = errorOf(Fitted(scans)), without = errorOf(Fitted(scans, false));
  checks.AtMost(with, without / 2, "mean distance of the plane where scans overlap");

  // What only one scan has seen counts fully, its border too.
  auto fitter = Fitted(scans);
  vtkPolyData* points = vtkPolyData::SafeDownCast(fitter->GetOutputDataObject(1));
  double least = 1, leastOfOverlap = 1;
  for (vtkIdType k = 0; k < points->GetNumberOfPoints(); ++k)
  {
    const double x = points->GetPoint(k)[0];
    const bool isAlone = x < RightBegin - 3 * Step || x > LeftEnd + 3 * Step;
    double& part = isAlone ? least : leastOfOverlap;
    part = std::min(part, FactorsOf(fitter)->GetComponent(k, 0));
  }
  checks.Equal(least, 1.0, "factor where one scan is alone");
  checks.That(leastOfOverlap >= 0.05 && leastOfOverlap < 0.3,
    "least factor of the overlap: " + std::to_string(leastOfOverlap));
}

/// Points of which there are several, as of triangles that are not merged, and single points.
void TestRepeatedAndStrayPoints(Checks& checks)
{
  const auto leastOf = [](vtkIPIAImplicitFitter* fitter)
  {
    double range[2];
    FactorsOf(fitter)->GetRange(range);
    return range[0];
  };
  std::vector<OrientedPoints> repeated(2);
  for (std::size_t scan = 0; scan < 2; ++scan)
  {
    const OrientedPoints once =
      scan == 0 ? PlaneScan(0, LeftEnd, 0) : PlaneScan(RightBegin + Step / 3, Width, 0);
    for (std::size_t k = 0; k < once.Positions.size(); ++k)
    {
      for (int time = 0; time < 6; ++time)
      {
        repeated[scan].Add(once.Positions[k], once.Normals[k]);
      }
    }
  }
  checks.AtMost(leastOf(Fitted(BlocksOf(repeated))), 0.3, "least factor of repeated points");

  for (int copies : { 1, 40 })
  {
    OrientedPoints stray;
    for (int k = 0; k < copies; ++k)
    {
      stray.Add({ LeftEnd - Step / 2, 0.5, 0 }, { 0, 0, 1 });
    }
    const double least = leastOf(Fitted(BlocksOf({ PlaneScan(0, LeftEnd, 0), stray })));
    checks.That(least > 0.999,
      std::to_string(copies) + " points at one place cover nothing: " + std::to_string(least));
  }
}

/// Point arrays are fitted with the same weights as f, also when these change.
void TestPointArrays(Checks& checks)
{
  auto scans = TwoScans(0);
  for (unsigned b = 0; b < 2; ++b)
  {
    auto* scan = vtkPolyData::SafeDownCast(scans->GetBlock(b));
    scan->GetPointData()->AddArray(
      ipiatest::Constant("c", scan->GetNumberOfPoints(), b == 0 ? 0.0 : 100.0));
  }
  auto changed = Fitted(scans);
  const auto arrayOf = [](vtkIPIAImplicitFitter* fitter)
  { return fitter->GetOutput()->GetPointData()->GetArray("c"); };
  auto off = Fitted(scans, false), on = Fitted(scans);
  checks.That(!ipiatest::SameArray(arrayOf(on), arrayOf(off)), "feathered: another array");
  changed->FeatherScansOff();
  changed->Update();
  checks.That(ipiatest::SameArray(arrayOf(changed), arrayOf(off)), "turned off: as without");
  changed->FeatherScansOn();
  changed->Update();
  checks.That(ipiatest::SameArray(arrayOf(changed), arrayOf(on)), "turned on: as with");
}

bool SameSamples(vtkIPIAImplicitFitter* a, vtkIPIAImplicitFitter* b)
{
  return ipiatest::SameImage(a->GetOutput(), b->GetOutput());
}

/// Factors of 1, no scans, and methods that do not use them: the same bits as without.
void TestWithout(Checks& checks)
{
  const OrientedPoints one = RandomScan(5, 900, 0, 1);
  auto twice = BlocksOf({ one, one });
  auto fitter = Fitted(twice);
  double range[2];
  FactorsOf(fitter)->GetRange(range);
  checks.Equal(range[0], 1.0, "the same scan twice: least factor");
  checks.That(SameSamples(fitter, Fitted(twice, false)), "the same scan twice: the same f");
  const std::vector<vtkSmartPointer<vtkDataObject>> ofOne{ ipiatest::ToPolyData(one),
    BlocksOf({ one }) };
  for (const auto& input : ofOne)
  {
    auto single = Fitted(input);
    checks.That(!FactorsOf(single), "one scan: no factors");
    checks.That(SameSamples(single, Fitted(input, false)), "one scan: the same f");
  }

  auto scans = TwoScans(0.02);
  auto on = Fitted(scans), off = Fitted(scans, false);
  checks.That(!FactorsOf(off), "off: no factors");
  checks.That(!SameSamples(on, off), "two scans: another f");
  for (vtkIPIAImplicitFitter* each : { on.Get(), off.Get() })
  {
    each->SetNumberOfLevels(1);
    each->SetNormalConstraintToOutwardOffset();
    each->Update();
  }
  checks.That(!FactorsOf(on) && SameSamples(on, off), "one level with offset rows: the same f");
  for (vtkIPIAImplicitFitter* each : { on.Get(), off.Get() })
  {
    each->SetNumberOfLevels(0);
    each->SetNormalConstraintToGradient();
    each->IncrementalOn();
    each->Update();
  }
  checks.That(!FactorsOf(on) && SameSamples(on, off), "Incremental: the same f");
  on->IncrementalOff();
  on->Update();
  checks.That(FactorsOf(on) && SameSamples(on, Fitted(scans)), "and back");
}

vtkSmartPointer<vtkMultiBlockDataSet> Weighted(
  vtkMultiBlockDataSet* scans, const std::vector<double>& weights)
{
  auto weighted = vtkSmartPointer<vtkMultiBlockDataSet>::New();
  auto next = weights.begin();
  for (unsigned b = 0; b < scans->GetNumberOfBlocks(); ++b)
  {
    vtkNew<vtkPolyData> scan;
    scan->ShallowCopy(scans->GetBlock(b));
    vtkNew<vtkDoubleArray> array;
    array->SetName("w");
    for (vtkIdType k = 0; k < scan->GetNumberOfPoints(); ++k)
    {
      array->InsertNextValue(*next++);
    }
    scan->GetPointData()->AddArray(array);
    weighted->SetBlock(b, scan);
  }
  return weighted;
}

vtkSmartPointer<vtkIPIAImplicitFitter> FittedByWeights(vtkDataObject* scans, bool feather)
{
  auto fitter = vtkSmartPointer<vtkIPIAImplicitFitter>::New();
  fitter->SetInputDataObject(scans);
  fitter->SetInputArrayToProcess(1, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, "w");
  fitter->SetGridSize(40, 0, 0);
  fitter->SetFeatherScans(feather);
  fitter->Update();
  return fitter;
}

/// Factors multiply weights; points of weight 0 cover nothing, nor do those that face elsewhere.
void TestWeights(Checks& checks)
{
  auto scans = TwoScans(0.02);
  auto fitter = Fitted(scans);
  const vtkIdType n = FactorsOf(fitter)->GetNumberOfTuples();
  std::vector<double> weights, products;
  for (vtkIdType k = 0; k < n; ++k)
  {
    weights.push_back(1 + static_cast<double>(k % 3));
    products.push_back(weights.back() * FactorsOf(fitter)->GetComponent(k, 0));
  }
  checks.That(SameSamples(FittedByWeights(Weighted(scans, weights), true),
                FittedByWeights(Weighted(scans, products), false)),
    "factors multiply weights");

  const vtkIdType ofFirst = vtkPolyData::SafeDownCast(scans->GetBlock(0))->GetNumberOfPoints();
  std::fill(weights.begin() + ofFirst, weights.end(), 0.0);
  const auto leastOfFirst = [&](vtkIPIAImplicitFitter* each)
  {
    double least = 1;
    for (vtkIdType k = 0; k < ofFirst; ++k)
    {
      least = std::min(least, FactorsOf(each)->GetComponent(k, 0));
    }
    return least;
  };
  checks.That(leastOfFirst(fitter) < 0.3, "the second scan covers the end of the first");
  checks.Equal(leastOfFirst(FittedByWeights(Weighted(scans, weights), true)), 1.0,
    "a scan of weight 0 covers nothing");

  // The two sides of a thin plate.
  OrientedPoints back = PlaneScan(RightBegin + Step / 3, Width, 0);
  for (std::size_t k = 0; k < back.Positions.size(); ++k)
  {
    back.Positions[k][2] = -Step;
    back.Normals[k] = { 0, 0, -1 };
  }
  checks.Equal(leastOfFirst(Fitted(BlocksOf({ PlaneScan(0, LeftEnd, 0), back }))), 1.0,
    "the other side of a plate covers nothing");
}

void TestThreads(Checks& checks)
{
  auto scans = TwoScans(0.02);
  auto first = Fitted(scans);
  const int threads = omp_get_max_threads();
  for (int count : { 1, 3, 4 })
  {
    omp_set_num_threads(count);
    auto other = Fitted(scans);
    checks.That(
      SameSamples(first, other) && ipiatest::SameArray(FactorsOf(first), FactorsOf(other)),
      std::to_string(count) + " threads: the same bits");
  }
  omp_set_num_threads(threads);
}

/// Scans of a few points, equal points, points without normals and points that are left out.
void TestFaults(Checks& checks)
{
  OrientedPoints single, equal, bare = RandomScan(7, 300, 0.5, 1);
  single.Add({ 0.5, 0.5, 0 }, { 0, 0, 1 });
  for (int k = 0; k < 40; ++k)
  {
    equal.Add({ 0.3, 0.5, 0 }, { 0, 0, 1 });
  }
  for (Vector3& normal : bare.Normals)
  {
    normal = { 0, 0, 0 };
  }
  OrientedPoints broken = RandomScan(8, 300, 0, 1);
  broken.Positions[10][0] = std::nan("");
  for (const OrientedPoints& other : { single, equal, bare, broken, OrientedPoints() })
  {
    auto fitter = Fitted(BlocksOf({ RandomScan(6, 900, 0, 1), other }));
    vtkDataArray* factors = FactorsOf(fitter);
    const std::string what = "with a scan of " + std::to_string(other.Positions.size());
    checks.That(ipiatest::OutputsAreSound(fitter), what + ": sound");
    if (!other.Positions.empty() && checks.That(factors != nullptr, what + ": factors"))
    {
      double range[2];
      factors->GetRange(range);
      checks.That(range[0] >= 0.05 && range[1] <= 1, what + ": factors from 0.05 to 1");
    }
  }
}
}

int TestScanFeathering(int, char*[])
{
  Checks checks;
  TestFactors(checks);
  TestRisingEnds(checks);
  TestRepeatedAndStrayPoints(checks);
  TestPointArrays(checks);
  TestWithout(checks);
  TestWeights(checks);
  TestThreads(checks);
  TestFaults(checks);
  return checks.Result();
}
