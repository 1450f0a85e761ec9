// SPDX-License-Identifier: BSD-3-Clause
/**
 * Scans that were moved apart come together, by one motion each, with all their arrays; scans that
 * agree stay; and the reconstruction of scans uses it.
 */
#include "IPIATestPipeline.h"
#include "IPIATestReconstruction.h"
#include "IPIATestShapes.h"
#include "IPIATestUtilities.h"

#include "vtkIPIAScanRegistration.h"

#include "vtkIntArray.h"
#include "vtkMatrix4x4.h"
#include "vtkMultiBlockDataSet.h"
#include "vtkPartitionedDataSet.h"
#include "vtkStringArray.h"
#include "vtkTransform.h"
#include "vtkUnsignedCharArray.h"

#include <omp.h>

namespace
{
using ipiatest::Checks;
using ipiatest::Text;
using ipiatest::Vector3;

constexpr int Scans = 6;

/// Where a scan is put: in degrees and lengths of about 0.3 % and less.
vtkSmartPointer<vtkTransform> Placed(int scan, double share)
{
  vtkNew<vtkMinimalStandardRandomSequence> random;
  random->SetSeed(31 + scan);
  double v[6];
  for (double& value : v)
  {
    random->Next();
    value = share * random->GetRangeValue(-1, 1);
  }
  auto motion = vtkSmartPointer<vtkTransform>::New();
  motion->Translate(0.006 * v[0], 0.006 * v[1], 0.006 * v[2]);
  motion->RotateX(0.5 * v[3]);
  motion->RotateY(0.5 * v[4]);
  motion->RotateZ(0.5 * v[5]);
  return motion;
}

/// What is seen of an ellipsoid from one side, which its points fill in another way each time.
vtkSmartPointer<vtkPolyData> ScanOf(int scan, int n, int type = VTK_DOUBLE)
{
  const Vector3 axes{ 1, 0.8, 0.6 };
  vtkNew<vtkTransform> turn;
  turn->RotateWXYZ(40 * scan, 1, 2, 3);
  ipiatest::OrientedPoints part;
  for (const Vector3& even : ipiatest::SpherePoints(n).Positions)
  {
    double u[3];
    turn->TransformVector(even.data(), u);
    const double side = scan % 2 == 0 ? 1 : -1;
    if (side * u[scan / 2] < -0.2)
    {
      continue;
    }
    Vector3 normal{ u[0] / axes[0], u[1] / axes[1], u[2] / axes[2] };
    vtkMath::Normalize(normal.data());
    part.Add({ axes[0] * u[0], axes[1] * u[1], axes[2] * u[2] }, normal);
  }
  return ipiatest::ToPolyData(part, type);
}

vtkSmartPointer<vtkPolyData> Moved(vtkPolyData* data, vtkTransform* motion)
{
  auto moved = vtkSmartPointer<vtkPolyData>::New();
  moved->ShallowCopy(data);
  vtkNew<vtkPoints> points;
  points->SetDataType(data->GetPoints()->GetDataType());
  motion->TransformPoints(data->GetPoints(), points);
  moved->SetPoints(points);
  auto normals =
    vtkSmartPointer<vtkDataArray>::Take(data->GetPointData()->GetNormals()->NewInstance());
  normals->SetName("Normals");
  normals->SetNumberOfComponents(3);
  motion->TransformVectors(data->GetPointData()->GetNormals(), normals);
  moved->GetPointData()->SetNormals(normals);
  return moved;
}

vtkSmartPointer<vtkMultiBlockDataSet> ScansOf(double share, int n = 4000)
{
  auto blocks = vtkSmartPointer<vtkMultiBlockDataSet>::New();
  for (int scan = 0; scan < Scans; ++scan)
  {
    blocks->SetBlock(static_cast<unsigned>(scan), Moved(ScanOf(scan, n), Placed(scan, share)));
  }
  return blocks;
}

vtkSmartPointer<vtkMultiBlockDataSet> MovedAlike(vtkMultiBlockDataSet* scans, vtkTransform* motion)
{
  auto blocks = vtkSmartPointer<vtkMultiBlockDataSet>::New();
  for (unsigned scan = 0; scan < scans->GetNumberOfBlocks(); ++scan)
  {
    blocks->SetBlock(scan, Moved(vtkPolyData::SafeDownCast(scans->GetBlock(scan)), motion));
  }
  return blocks;
}

vtkSmartPointer<vtkIPIAScanRegistration> Registered(vtkDataObject* scans)
{
  auto registration = vtkSmartPointer<vtkIPIAScanRegistration>::New();
  registration->SetInputDataObject(scans);
  registration->Update();
  return registration;
}

vtkPolyData* Block(vtkAlgorithm* filter, unsigned scan)
{
  return vtkPolyData::SafeDownCast(
    vtkMultiBlockDataSet::SafeDownCast(filter->GetOutputDataObject(0))->GetBlock(scan));
}

void MatrixOf(vtkAlgorithm* registration, unsigned scan, vtkMatrix4x4* matrix)
{
  matrix->DeepCopy(
    Block(registration, scan)->GetFieldData()->GetArray("RegistrationMatrix")->GetTuple(0));
}

/// After registration all scans are where one common motion would have put them: the largest
/// difference at corners of their box.
double Disagreement(vtkIPIAScanRegistration* registration, double share)
{
  double largest = 0;
  vtkNew<vtkMatrix4x4> first;
  for (int scan = 0; scan < Scans; ++scan)
  {
    vtkNew<vtkMatrix4x4> whole;
    MatrixOf(registration, static_cast<unsigned>(scan), whole);
    vtkMatrix4x4::Multiply4x4(whole, Placed(scan, share)->GetMatrix(), whole);
    if (scan == 0)
    {
      first->DeepCopy(whole);
    }
    for (int corner = 0; corner < 8; ++corner)
    {
      const double x[4] = { corner & 1 ? 1. : -1., corner & 2 ? 0.8 : -0.8, corner & 4 ? 0.6 : -0.6,
        1 };
      double a[4], b[4];
      whole->MultiplyPoint(x, a);
      first->MultiplyPoint(x, b);
      largest = std::max(largest, std::sqrt(vtkMath::Distance2BetweenPoints(a, b)));
    }
  }
  return largest;
}

void TestComeTogether(Checks& checks)
{
  auto scans = ScansOf(1);
  vtkNew<ipiatest::MessageObserver> messages;
  vtkNew<vtkIPIAScanRegistration> registration;
  messages->Watch(registration);
  registration->SetInputDataObject(scans);
  registration->Update();
  messages->CheckSilence(checks, "registration");
  std::cout << "misfit " << registration->GetMisfitBefore() << " to "
            << registration->GetMisfitAfter() << ", largest motion "
            << registration->GetLargestMotion() << ", " << registration->GetNumberOfIterationsUsed()
            << " iterations, disagreement " << Disagreement(registration, 1) << "\n";
  checks.That(registration->GetMisfitBefore() > 1e-3, "the scans lay apart");
  checks.AtMost(registration->GetMisfitAfter(), 0.05 * registration->GetMisfitBefore(), "misfit");
  // They were up to 0.02 apart.
  checks.AtMost(Disagreement(registration, 1), 4e-4, "what is left between the scans");
  checks.That(registration->GetLargestMotion() > 0.005 && registration->GetLargestMotion() < 0.03,
    Text("largest motion ", registration->GetLargestMotion()));

  Vector3 shift{ 0, 0, 0 }, rotation{ 0, 0, 0 };
  double centre[3];
  for (int scan = 0; scan < Scans; ++scan)
  {
    vtkPolyData* block = Block(registration, static_cast<unsigned>(scan));
    vtkPolyData* given = vtkPolyData::SafeDownCast(scans->GetBlock(static_cast<unsigned>(scan)));
    vtkNew<vtkMatrix4x4> matrix;
    MatrixOf(registration, static_cast<unsigned>(scan), matrix);
    vtkNew<vtkTransform> motion;
    motion->SetMatrix(matrix);
    auto expected = Moved(given, motion);
    checks.That(
      ipiatest::SameArray(expected->GetPoints()->GetData(), block->GetPoints()->GetData()) &&
        ipiatest::SameArray(
          expected->GetPointData()->GetNormals(), block->GetPointData()->GetNormals()),
      Text("scan ", scan, " is moved by its matrix"));
    checks.AtMost(std::abs(matrix->Determinant() - 1), 1e-12, "determinant - 1");
    const double none[3] = { 0, 0, 0 };
    motion->TransformPoint(none, centre);
    vtkMath::Add(shift.data(), centre, shift.data());
    for (int a = 0; a < 3; ++a)
    {
      const int b = (a + 1) % 3, c = (a + 2) % 3;
      rotation[static_cast<std::size_t>(a)] +=
        (matrix->GetElement(c, b) - matrix->GetElement(b, c)) / 2;
    }
  }
  checks.AtMost(vtkMath::Norm(shift.data()) / Scans, 1e-4, "mean shift");
  checks.AtMost(vtkMath::Norm(rotation.data()) / Scans, 1e-4, "mean rotation");
}

/// The very arrays that came in.
void CheckUntouched(Checks& checks, vtkIPIAScanRegistration* registration,
  vtkMultiBlockDataSet* scans, const std::string& what)
{
  for (unsigned scan = 0; scan < scans->GetNumberOfBlocks(); ++scan)
  {
    vtkPolyData* given = vtkPolyData::SafeDownCast(scans->GetBlock(scan));
    vtkPolyData* block = Block(registration, scan);
    checks.That(block && block->GetPoints() == given->GetPoints() &&
        block->GetPointData()->GetNormals() == given->GetPointData()->GetNormals(),
      Text(what, ": scan ", scan, " is untouched"));
    vtkNew<vtkMatrix4x4> matrix;
    MatrixOf(registration, scan, matrix);
    checks.That(matrix->IsIdentity(), what + ": its matrix is the identity");
  }
  checks.Equal(registration->GetLargestMotion(), 0.0, what + ": largest motion");
  checks.Equal(
    registration->GetMisfitAfter(), registration->GetMisfitBefore(), what + ": misfit after");
}

void TestStay(Checks& checks)
{
  auto agreeing = ScansOf(0);
  auto registration = Registered(agreeing);
  CheckUntouched(checks, registration, agreeing, "scans that agree");
  checks.Equal(registration->GetNumberOfIterationsUsed(), 0, "iterations for scans that agree");

  // Tiles of one surface, with no more than a seam in common.
  vtkNew<vtkMultiBlockDataSet> tiles;
  const auto whole = ipiatest::SpherePoints(6000);
  for (int tile = 0; tile < 3; ++tile)
  {
    ipiatest::OrientedPoints part;
    for (std::size_t k = 0; k < whole.Positions.size(); ++k)
    {
      if (static_cast<int>((whole.Positions[k][0] + 1) * 1.4999) == tile)
      {
        part.Add(whole.Positions[k], whole.Normals[k]);
      }
    }
    tiles->SetBlock(static_cast<unsigned>(tile), ipiatest::ToPolyData(part));
  }
  CheckUntouched(checks, Registered(tiles), tiles, "tiles");

  // A scan of one point hardly says that it is out of place.
  vtkNew<vtkMultiBlockDataSet> withPoint;
  ipiatest::OrientedPoints point;
  point.Add({ 0, 0, 0.6 }, { 0, 0, 1 });
  withPoint->SetBlock(0, ScanOf(0, 4000));
  withPoint->SetBlock(1, ipiatest::ToPolyData(point));
  CheckUntouched(checks, Registered(withPoint), withPoint, "a scan and one point");

  auto apart = ScansOf(1);
  vtkNew<vtkIPIAScanRegistration> never;
  never->SetRequiredReduction(1);
  never->SetInputDataObject(apart);
  never->Update();
  CheckUntouched(checks, never, apart, "RequiredReduction 1");

  vtkNew<vtkMultiBlockDataSet> one;
  one->SetBlock(0, ScanOf(0, 1000));
  auto single = Registered(one);
  CheckUntouched(checks, single, one, "one scan");
  checks.Equal(single->GetMisfitBefore(), 0.0, "misfit of one scan");
}

/// What belongs to a scan goes with it: vectors turn, other arrays and the structure stay.
void TestCarries(Checks& checks)
{
  auto scans = ScansOf(1, 2000);
  vtkPolyData* first = vtkPolyData::SafeDownCast(scans->GetBlock(0));
  vtkNew<vtkUnsignedCharArray> colours;
  colours->SetName("RGB");
  colours->SetNumberOfComponents(3);
  colours->SetNumberOfTuples(first->GetNumberOfPoints());
  colours->Fill(7);
  first->GetPointData()->AddArray(colours);
  vtkNew<vtkFloatArray> wind;
  wind->SetName("Wind");
  wind->SetNumberOfComponents(3);
  wind->SetNumberOfTuples(first->GetNumberOfPoints());
  wind->Fill(2);
  first->GetPointData()->SetVectors(wind);
  vtkNew<vtkStringArray> scanner;
  scanner->SetName("Scanner");
  scanner->InsertNextValue("left");
  first->GetFieldData()->AddArray(scanner);
  // Normals may be any array, of any length.
  vtkDataArray* normals = first->GetPointData()->GetNormals();
  vtkNew<vtkDoubleArray> longer;
  longer->DeepCopy(normals);
  for (vtkIdType i = 0; i < longer->GetNumberOfValues(); ++i)
  {
    longer->SetValue(i, 3 * longer->GetValue(i));
  }
  longer->SetName("Direction");
  for (unsigned scan = 1; scan < Scans; ++scan)
  {
    vtkPointData* arrays = vtkPolyData::SafeDownCast(scans->GetBlock(scan))->GetPointData();
    vtkNew<vtkDoubleArray> copy;
    copy->DeepCopy(arrays->GetNormals());
    copy->SetName("Direction");
    arrays->AddArray(copy);
  }
  first->GetPointData()->AddArray(longer);

  vtkNew<vtkMultiBlockDataSet> nested, inner;
  vtkNew<vtkPolyData> empty;
  nested->SetBlock(0, empty);
  nested->SetBlock(1, nullptr);
  for (unsigned scan = 0; scan < Scans; ++scan)
  {
    inner->SetBlock(scan, scans->GetBlock(scan));
  }
  inner->GetMetaData(0u)->Set(vtkCompositeDataSet::NAME(), "front");
  nested->SetBlock(2, inner);
  vtkNew<vtkIPIAScanRegistration> registration;
  registration->SetInputDataObject(nested);
  registration->SetInputArrayToProcess(
    0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, "Direction");
  registration->Update();
  auto* output = vtkMultiBlockDataSet::SafeDownCast(registration->GetOutputDataObject(0));
  checks.That(registration->GetLargestMotion() > 0, "nested scans are moved");
  if (!checks.Equal(output->GetNumberOfBlocks(), 3u, "blocks") ||
    !checks.That(output->GetBlock(0) && !output->GetBlock(1), "an empty and a null block"))
  {
    return;
  }
  auto* moved = vtkMultiBlockDataSet::SafeDownCast(output->GetBlock(2));
  checks.That(std::string("front") == moved->GetMetaData(0u)->Get(vtkCompositeDataSet::NAME()),
    "the name of a block");
  vtkPolyData* block = vtkPolyData::SafeDownCast(moved->GetBlock(0));
  vtkNew<vtkMatrix4x4> matrix;
  matrix->DeepCopy(block->GetFieldData()->GetArray("RegistrationMatrix")->GetTuple(0));
  vtkNew<vtkTransform> motion;
  motion->SetMatrix(matrix);
  const auto turned = [&](vtkDataArray* array)
  {
    auto result = vtkSmartPointer<vtkDataArray>::Take(array->NewInstance());
    result->SetNumberOfComponents(3);
    motion->TransformVectors(array, result);
    return result;
  };
  vtkPointData* arrays = block->GetPointData();
  checks.That(arrays->GetArray("RGB") == colours, "colours are shared");
  checks.That(block->GetFieldData()->GetAbstractArray("Scanner") == scanner, "field data");
  checks.That(ipiatest::SameArray(arrays->GetVectors(), turned(wind)) &&
      std::string("Wind") == arrays->GetVectors()->GetName(),
    "active vectors are turned");
  checks.That(ipiatest::SameArray(arrays->GetNormals(), turned(normals)), "active normals");
  checks.That(ipiatest::SameArray(arrays->GetArray("Direction"), turned(longer)),
    "chosen normals, with their lengths");
  checks.Equal(arrays->GetNumberOfArrays(), first->GetPointData()->GetNumberOfArrays(), "arrays");
  checks.That(
    first->GetPointData()->GetVectors() == wind && first->GetPoint(0)[0] != block->GetPoint(0)[0],
    "the input is as it was");

  vtkNew<vtkPartitionedDataSet> parts;
  for (unsigned scan = 0; scan < Scans; ++scan)
  {
    parts->SetPartition(scan, vtkPolyData::SafeDownCast(scans->GetBlock(scan)));
  }
  auto partitioned = Registered(parts);
  auto* partitions = vtkPartitionedDataSet::SafeDownCast(partitioned->GetOutputDataObject(0));
  checks.That(partitions && partitions->GetNumberOfPartitions() == Scans &&
      partitioned->GetLargestMotion() > 0,
    "vtkPartitionedDataSet");
}

/// Neither the place in the world nor the unit of length matters, nor the type of the points.
void TestInvariance(Checks& checks)
{
  auto scans = ScansOf(1);
  auto reference = Registered(scans);
  for (const auto& [scale, far] : { std::pair{ 1., 5e6 }, { 1e-3, 0. }, { 1e4, 0. } })
  {
    vtkNew<vtkTransform> place;
    place->Translate(far, 2 * far, 0);
    place->Scale(scale, scale, scale);
    auto registration = Registered(MovedAlike(scans, place));
    double largest = 0;
    for (unsigned scan = 0; scan < Scans; ++scan)
    {
      for (vtkIdType k = 0; k < 100; ++k)
      {
        double expected[3];
        place->TransformPoint(Block(reference, scan)->GetPoint(k), expected);
        largest = std::max(largest,
          std::sqrt(
            vtkMath::Distance2BetweenPoints(expected, Block(registration, scan)->GetPoint(k))));
      }
    }
    checks.AtMost(largest / scale, 1e-6, Text("moved points, scale ", scale, ", at ", far));
    checks.AtMost(
      std::abs(registration->GetMisfitBefore() / scale / reference->GetMisfitBefore() - 1), 1e-4,
      Text("misfit, scale ", scale, ", at ", far));
  }

  vtkNew<vtkMultiBlockDataSet> floats;
  for (int scan = 0; scan < Scans; ++scan)
  {
    floats->SetBlock(
      static_cast<unsigned>(scan), Moved(ScanOf(scan, 4000, VTK_FLOAT), Placed(scan, 1)));
  }
  auto registration = Registered(floats);
  checks.Equal(Block(registration, 0)->GetPoints()->GetDataType(), VTK_FLOAT, "type of the points");
  checks.AtMost(Disagreement(registration, 1), 4e-4, "float points: what is left");
}

void TestThreads(Checks& checks)
{
  auto scans = ScansOf(1);
  const int before = omp_get_max_threads();
  omp_set_num_threads(1);
  auto one = Registered(scans);
  for (int threads : { 2, 4 })
  {
    omp_set_num_threads(threads);
    auto other = Registered(scans);
    for (unsigned scan = 0; scan < Scans; ++scan)
    {
      checks.That(ipiatest::SameArray(Block(one, scan)->GetPoints()->GetData(),
                    Block(other, scan)->GetPoints()->GetData()),
        Text("scan ", scan, ", ", threads, " threads: same bits"));
    }
  }
  omp_set_num_threads(before);
}

/// Weights of 0 and outliers do not count: scans with a heap of nonsense are moved as without.
void TestFaults(Checks& checks)
{
  auto scans = ScansOf(1);
  for (unsigned scan = 0; scan < Scans; ++scan)
  {
    vtkPolyData* block = vtkPolyData::SafeDownCast(scans->GetBlock(scan));
    vtkNew<vtkMinimalStandardRandomSequence> random;
    random->SetSeed(static_cast<int>(scan) + 1);
    const vtkIdType n = block->GetNumberOfPoints();
    for (vtkIdType k = 0; k < n / 50; ++k)
    {
      double x[3];
      for (double& v : x)
      {
        random->Next();
        v = random->GetRangeValue(-1.1, 1.1);
      }
      block->GetPoints()->InsertNextPoint(x);
      block->GetPointData()->GetNormals()->InsertNextTuple3(0, 0, 1);
    }
    block->GetPoints()->Modified();
  }
  auto registration = Registered(scans);
  checks.AtMost(Disagreement(registration, 1), 1e-3, "2 % of outliers: what is left");
}

void TestInPlane(Checks& checks)
{
  vtkNew<vtkMultiBlockDataSet> scans;
  for (unsigned scan = 0; scan < 3; ++scan)
  {
    ipiatest::OrientedPoints part;
    const double turn = 0.01 * (scan - 1.0), shift = scan == 1 ? -0.01 : 0.005;
    for (int k = 0; k < 400; ++k)
    {
      const double angle = 2 * vtkMath::Pi() * (k + 0.3 * scan) / 400;
      const double x = 1.5 * std::cos(angle), y = std::sin(angle);
      Vector3 normal{ std::cos(angle + turn) / 1.5, std::sin(angle + turn), 0 };
      vtkMath::Normalize(normal.data());
      part.Add({ x - turn * y + shift, y + turn * x, 2 }, normal);
    }
    scans->SetBlock(scan, ipiatest::ToPolyData(part));
  }
  auto registration = Registered(scans);
  checks.AtMost(
    registration->GetMisfitAfter(), 0.1 * registration->GetMisfitBefore(), "curves: misfit");
  double off = 0;
  for (unsigned scan = 0; scan < 3; ++scan)
  {
    for (vtkIdType k = 0; k < 400; ++k)
    {
      off = std::max(off, std::abs(Block(registration, scan)->GetPoint(k)[2] - 2));
    }
  }
  checks.Equal(off, 0.0, "curves stay in their plane");
}

void TestRefusals(Checks& checks)
{
  auto scans = ScansOf(1, 500);
  vtkPolyData* second = vtkPolyData::SafeDownCast(scans->GetBlock(1));
  vtkSmartPointer<vtkDataArray> normals = second->GetPointData()->GetNormals();
  vtkNew<ipiatest::MessageObserver> messages;
  vtkNew<vtkIPIAScanRegistration> registration;
  messages->Watch(registration);
  registration->SetInputDataObject(scans);
  const auto isEmpty = [&]
  {
    return vtkMultiBlockDataSet::SafeDownCast(registration->GetOutputDataObject(0))
             ->GetNumberOfBlocks() == 0;
  };
  second->GetPointData()->RemoveArray("Normals");
  registration->Update();
  messages->CheckOneError(checks, "Block 1 of the input has no point normals", "no normals");
  checks.That(isEmpty(), "no normals: the output is empty");
  second->GetPointData()->SetNormals(normals);
  registration->SetRequiredReduction(std::nan(""));
  registration->Update();
  messages->CheckOneError(checks, "RequiredReduction is not a number", "NaN");
  checks.That(isEmpty(), "NaN: the output is empty");
  registration->SetRequiredReduction(-1);
  checks.Equal(registration->GetRequiredReduction(), 0.0, "RequiredReduction is clamped");
  registration->SetMaximumNumberOfIterations(0);
  checks.Equal(registration->GetMaximumNumberOfIterations(), 1, "iterations are clamped");
  registration->Update();
  messages->CheckSilence(checks, "after refusals");
  checks.Equal(registration->GetNumberOfIterationsUsed(), 1, "one iteration");
  checks.That(registration->GetLargestMotion() > 0, "any gain will do");

  for (double share : { 0.0, 0.3, 0.6 })
  {
    auto aborted = vtkSmartPointer<vtkIPIAScanRegistration>::New();
    vtkNew<ipiatest::ProgressObserver> progress;
    progress->AbortAt = share;
    aborted->AddObserver(vtkCommand::ProgressEvent, progress);
    aborted->SetInputDataObject(scans);
    aborted->Update();
    auto* output = vtkMultiBlockDataSet::SafeDownCast(aborted->GetOutputDataObject(0));
    checks.Equal(output->GetNumberOfBlocks(), 0u, Text("abort at ", share, ": blocks"));
  }
  auto whole = vtkSmartPointer<vtkIPIAScanRegistration>::New();
  vtkNew<ipiatest::ProgressObserver> all;
  whole->AddObserver(vtkCommand::ProgressEvent, all);
  whole->SetInputDataObject(scans);
  whole->Update();
  all->CheckRise(checks, "progress of the registration");

  std::ostringstream os;
  whole->Print(os);
  checks.That(os.str().find("RequiredReduction: 0.5") != std::string::npos, "PrintSelf");
}

/// Root mean square distance of the points from the surface that was made of them.
double Thickness(vtkIPIASurfaceReconstruction* reconstruction, vtkMultiBlockDataSet* scans)
{
  double squares = 0, points = 0;
  for (unsigned scan = 0; scan < scans->GetNumberOfBlocks(); ++scan)
  {
    vtkPolyData* block = vtkPolyData::SafeDownCast(scans->GetBlock(scan));
    for (vtkIdType k = 0; k < block->GetNumberOfPoints(); ++k)
    {
      const double f =
        reconstruction->GetFitter()->GetImplicitFunction()->EvaluateFunction(block->GetPoint(k));
      squares += f * f;
      ++points;
    }
  }
  return std::sqrt(squares / points);
}

void TestReconstruction(Checks& checks)
{
  auto scans = ScansOf(1);
  vtkNew<vtkIPIASurfaceReconstruction> reconstruction;
  vtkNew<ipiatest::MessageObserver> messages;
  messages->Watch(reconstruction);
  reconstruction->SetInputDataObject(scans);
  reconstruction->Update();
  messages->CheckOneWarning(checks, "The scans were moved, by up to", "scans that lie apart");
  checks.Equal(ipiatest::TopologyOf(reconstruction->GetOutput()), ipiatest::Topology{ 1, 0, 0, 0 },
    "registered scans");
  auto registration = Registered(scans);
  const double together = Thickness(
    reconstruction, vtkMultiBlockDataSet::SafeDownCast(registration->GetOutputDataObject(0)));
  checks.AtMost(together, 1e-4, "distance of registered points");
  checks.Equal(reconstruction->GetRegistration()->GetMisfitAfter(), registration->GetMisfitAfter(),
    "misfit, as of the filter alone");

  // Nothing that comes later registers again.
  reconstruction->SetTrimDistance(4);
  reconstruction->Update();
  messages->CheckSilence(checks, "another trim distance");
  reconstruction->RegisterScansOff();
  reconstruction->Update();
  messages->CheckSilence(checks, "RegisterScans off");
  checks.That(Thickness(reconstruction, scans) > 10 * together, "without registration");
  vtkNew<vtkIPIAImplicitFitter> fitter;
  fitter->SetInputDataObject(scans);
  fitter->Update();
  double largest = 0;
  for (vtkIdType k = 0; k < 100; ++k)
  {
    double* x = Block(registration, 0)->GetPoint(k);
    largest = std::max(largest,
      std::abs(fitter->GetImplicitFunction()->EvaluateFunction(x) -
        reconstruction->GetFitter()->GetImplicitFunction()->EvaluateFunction(x)));
  }
  checks.AtMost(largest, 1e-15, "without registration as the fitter");
  reconstruction->RegisterScansOn();
  reconstruction->GetFitter()->IncrementalOn();
  reconstruction->Update();
  messages->CheckSilence(checks, "Incremental");
  reconstruction->GetFitter()->IncrementalOff();
  reconstruction->GetRegistration()->SetRequiredReduction(1);
  reconstruction->Update();
  messages->CheckSilence(checks, "RequiredReduction 1");
  reconstruction->GetRegistration()->SetRequiredReduction(0.5);
  reconstruction->Update();
  messages->CheckOneWarning(checks, "The scans were moved, by up to", "and back");

  vtkPolyData::SafeDownCast(scans->GetBlock(3))->GetPointData()->RemoveArray("Normals");
  scans->Modified();
  for (int time = 0; time < 2; ++time)
  {
    reconstruction->Modified();
    reconstruction->Update();
    messages->CheckOneError(checks, "Block 3 of the input has no point normals", "no normals");
    checks.That(ipiatest::IsEmpty(reconstruction->GetOutput()), "no normals: no surface");
  }
}
}

int TestScanRegistration(int, char*[])
{
  Checks checks;
  TestComeTogether(checks);
  TestStay(checks);
  TestCarries(checks);
  TestInvariance(checks);
  TestThreads(checks);
  TestFaults(checks);
  TestInPlane(checks);
  TestRefusals(checks);
  TestReconstruction(checks);
  return checks.Result();
}
