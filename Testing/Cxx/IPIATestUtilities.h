// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * What all tests of the filters share: checks, the messages of a pipeline, fitters with the classic
 * method, and comparisons of images.
 */
#ifndef IPIATestUtilities_h
#define IPIATestUtilities_h

#include "vtkIPIAImplicitFitter.h"

#include "vtkCommand.h"
#include "vtkDataArray.h"
#include "vtkDataObject.h"
#include "vtkDoubleArray.h"
#include "vtkExecutive.h"
#include "vtkFieldData.h"
#include "vtkImageData.h"
#include "vtkLogger.h"
#include "vtkNew.h"
#include "vtkOutputWindow.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkSmartPointer.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <sstream>
#include <string>
#include <vector>

namespace ipiatest
{
/// The parts written one after the other.
template <typename... Parts>
std::string Text(const Parts&... parts)
{
  std::ostringstream stream;
  (stream << ... << parts);
  return stream.str();
}

/// Counts what does not hold. CTest sees "ERROR: " too.
class Checks
{
public:
  bool That(bool holds, const std::string& what)
  {
    ++this->Done;
    if (!holds)
    {
      ++this->Failed;
      std::cout << "ERROR: not so: " << what << std::endl;
    }
    return holds;
  }

  template <typename A, typename B>
  bool Equal(const A& value, const B& expected, const std::string& what)
  {
    return this->That(value == expected, Text(what, " is ", expected, " (", value, ")"));
  }

  /// NaN does not pass.
  bool AtMost(double value, double bound, const std::string& what)
  {
    return this->That(value <= bound, Text(what, " <= ", bound, " (", value, ")"));
  }

  /// What main returns; a test without a check has failed.
  int Result() const
  {
    std::cout << this->Done - this->Failed << " of " << this->Done << " checks hold\n";
    return this->Done > 0 && this->Failed == 0 ? EXIT_SUCCESS : EXIT_FAILURE;
  }

private:
  int Done = 0;
  int Failed = 0;
};

/// Counts and keeps the errors and warnings of algorithms and their executives.
class MessageObserver : public vtkCommand
{
public:
  static MessageObserver* New() { return new MessageObserver; }
  vtkTypeMacro(MessageObserver, vtkCommand);

  void Watch(vtkAlgorithm* algorithm)
  {
    for (vtkObject* subject :
      { static_cast<vtkObject*>(algorithm), static_cast<vtkObject*>(algorithm->GetExecutive()) })
    {
      this->WatchObject(subject);
    }
  }

  void WatchObject(vtkObject* subject)
  {
    subject->AddObserver(vtkCommand::ErrorEvent, this);
    subject->AddObserver(vtkCommand::WarningEvent, this);
  }

  void Execute(vtkObject*, unsigned long event, void* message) override
  {
    auto& messages = event == vtkCommand::ErrorEvent ? this->Errors : this->Warnings;
    messages.emplace_back(static_cast<const char*>(message));
  }

  void Clear()
  {
    this->Errors.clear();
    this->Warnings.clear();
  }

  /// One error that holds the phrase, and no warning.
  void CheckOneError(Checks& checks, const std::string& phrase, const std::string& what)
  {
    CheckOne(checks, this->Errors, phrase, what + ": errors");
    CheckNone(checks, this->Warnings, what + ": warnings");
    this->Clear();
  }

  /// One warning that holds the phrase, and no error.
  void CheckOneWarning(Checks& checks, const std::string& phrase, const std::string& what)
  {
    CheckOne(checks, this->Warnings, phrase, what + ": warnings");
    CheckNone(checks, this->Errors, what + ": errors");
    this->Clear();
  }

  void CheckSilence(Checks& checks, const std::string& what)
  {
    CheckNone(checks, this->Errors, what + ": errors");
    CheckNone(checks, this->Warnings, what + ": warnings");
    this->Clear();
  }

  std::vector<std::string> Errors, Warnings;

private:
  static std::string All(const std::vector<std::string>& messages)
  {
    std::string all;
    for (const std::string& message : messages)
    {
      all += "\n  " + message;
    }
    return all;
  }

  static void CheckOne(Checks& checks, const std::vector<std::string>& messages,
    const std::string& phrase, const std::string& what)
  {
    checks.That(messages.size() == 1 && messages.front().find(phrase) != std::string::npos,
      Text(what, " are one with \"", phrase, "\" (", messages.size(), ":", All(messages), ")"));
  }

  static void CheckNone(
    Checks& checks, const std::vector<std::string>& messages, const std::string& what)
  {
    checks.That(messages.empty(), Text(what, " are none (", All(messages), ")"));
  }
};

/// Watches the output window, where messages go that no observer takes, as long as it lives. They
/// are not logged then: CTest takes a logged error for a failure.
class WindowWatch
{
public:
  explicit WindowWatch(MessageObserver* observer)
    : Observer(observer)
  {
    observer->WatchObject(vtkOutputWindow::GetInstance());
    vtkLogger::SetStderrVerbosity(vtkLogger::VERBOSITY_OFF);
  }

  ~WindowWatch()
  {
    vtkOutputWindow::GetInstance()->RemoveObserver(this->Observer);
    vtkLogger::SetStderrVerbosity(this->Verbosity);
  }

  WindowWatch(const WindowWatch&) = delete;
  void operator=(const WindowWatch&) = delete;

private:
  MessageObserver* Observer;
  const vtkLogger::Verbosity Verbosity = vtkLogger::GetCurrentVerbosityCutoff();
};

/// A fitter set to the classic method of one level, with few iterations for a quick test.
inline vtkSmartPointer<vtkIPIAImplicitFitter> NewClassicFitter(
  vtkDataObject* cloud = nullptr, int gridSize = 0)
{
  auto fitter = vtkSmartPointer<vtkIPIAImplicitFitter>::New();
  fitter->SetNumberOfLevels(1);
  fitter->SetNormalConstraintToTwoSidedOffset();
  fitter->SetSolverToProgressiveIteration();
  fitter->SetMaximumNumberOfIterations(20);
  fitter->SetGridSize(gridSize, gridSize, gridSize);
  if (cloud)
  {
    fitter->SetInputDataObject(0, cloud);
  }
  return fitter;
}

/// The methods that tests of input, errors and pipelines run for.
enum class Method
{
  Classic,
  Default ///< nothing set: the hierarchy
};

constexpr Method Methods[] = { Method::Classic, Method::Default };

inline std::string NameOf(Method method)
{
  return method == Method::Classic ? "classic" : "default";
}

/// A fitter set to a method.
inline vtkSmartPointer<vtkIPIAImplicitFitter> NewFitter(
  Method method, vtkDataObject* cloud = nullptr, int gridSize = 0)
{
  if (method == Method::Classic)
  {
    return NewClassicFitter(cloud, gridSize);
  }
  auto fitter = vtkSmartPointer<vtkIPIAImplicitFitter>::New();
  fitter->SetGridSize(gridSize, gridSize, gridSize);
  if (cloud)
  {
    fitter->SetInputDataObject(0, cloud);
  }
  return fitter;
}

/// The control lattice of an updated fitter.
inline vtkImageData* ControlLattice(vtkIPIAImplicitFitter* fitter)
{
  return vtkImageData::SafeDownCast(fitter->GetOutputDataObject(2));
}

/// The fitted points of an updated fitter.
inline vtkPolyData* FittedPoints(vtkIPIAImplicitFitter* fitter)
{
  return vtkPolyData::SafeDownCast(fitter->GetOutputDataObject(1));
}

/// The largest knot spacing of an updated fitter.
inline double KnotSpacing(vtkIPIAImplicitFitter* fitter)
{
  const double* h = ControlLattice(fitter)->GetSpacing();
  return std::max({ h[0], h[1], h[2] });
}

/// No point, cell or array.
inline bool IsEmpty(vtkDataSet* data)
{
  return data->GetNumberOfPoints() == 0 && data->GetNumberOfCells() == 0 &&
    data->GetPointData()->GetNumberOfArrays() == 0 &&
    data->GetFieldData()->GetNumberOfArrays() == 0;
}

/// No point, cell or array on any port.
inline bool OutputsAreEmpty(vtkIPIAImplicitFitter* fitter)
{
  for (int port = 0; port < fitter->GetNumberOfOutputPorts(); ++port)
  {
    if (!IsEmpty(vtkDataSet::SafeDownCast(fitter->GetOutputDataObject(port))))
    {
      return false;
    }
  }
  return true;
}

/// Every value of an array is finite.
inline bool IsFinite(vtkDataArray* array)
{
  for (vtkIdType i = 0; i < array->GetNumberOfTuples(); ++i)
  {
    for (int c = 0; c < array->GetNumberOfComponents(); ++c)
    {
      if (!std::isfinite(array->GetComponent(i, c)))
      {
        return false;
      }
    }
  }
  return true;
}

inline bool IsFinite(vtkFieldData* field)
{
  for (int i = 0; i < field->GetNumberOfArrays(); ++i)
  {
    if (!IsFinite(field->GetArray(i)))
    {
      return false;
    }
  }
  return true;
}

/// All outputs hold something, and what the fitter made is finite (port 1 also passes the arrays of
/// the input on).
inline bool OutputsAreSound(vtkIPIAImplicitFitter* fitter)
{
  vtkImageData* image = fitter->GetOutput();
  vtkPolyData* points = FittedPoints(fitter);
  vtkImageData* lattice = ControlLattice(fitter);
  return image->GetNumberOfPoints() > 0 && points->GetNumberOfPoints() > 0 &&
    lattice->GetNumberOfPoints() > 0 && IsFinite(image->GetPointData()) &&
    IsFinite(image->GetFieldData()) && IsFinite(points->GetPoints()->GetData()) &&
    IsFinite(points->GetPointData()->GetArray("Residual")) &&
    IsFinite(points->GetPointData()->GetArray("Distance")) && IsFinite(lattice->GetPointData()) &&
    IsFinite(lattice->GetFieldData());
}

/// An array of one number.
inline vtkSmartPointer<vtkDoubleArray> Constant(
  const char* name, vtkIdType tuples, double value, int components = 1)
{
  auto array = vtkSmartPointer<vtkDoubleArray>::New();
  array->SetName(name);
  array->SetNumberOfComponents(components);
  array->SetNumberOfTuples(tuples);
  array->Fill(value);
  return array;
}

/// Same type, size and bits.
inline bool SameArray(vtkDataArray* a, vtkDataArray* b)
{
  if (!a || !b || a->GetDataType() != b->GetDataType() ||
    a->GetNumberOfTuples() != b->GetNumberOfTuples() ||
    a->GetNumberOfComponents() != b->GetNumberOfComponents())
  {
    return false;
  }
  for (vtkIdType i = 0; i < a->GetNumberOfTuples(); ++i)
  {
    for (int c = 0; c < a->GetNumberOfComponents(); ++c)
    {
      if (a->GetComponent(i, c) != b->GetComponent(i, c))
      {
        return false;
      }
    }
  }
  return true;
}

/// Same place and the same bits of f.
inline bool SameImage(vtkImageData* a, vtkImageData* b)
{
  return std::equal(a->GetExtent(), a->GetExtent() + 6, b->GetExtent()) &&
    std::equal(a->GetOrigin(), a->GetOrigin() + 3, b->GetOrigin()) &&
    std::equal(a->GetSpacing(), a->GetSpacing() + 3, b->GetSpacing()) &&
    SameArray(a->GetPointData()->GetScalars(), b->GetPointData()->GetScalars());
}

/// The same far field, or none in both.
inline bool SameFarField(vtkImageData* a, vtkImageData* b)
{
  vtkDataArray* first = a->GetFieldData()->GetArray("FarField");
  vtkDataArray* second = b->GetFieldData()->GetArray("FarField");
  return (!first && !second) || SameArray(first, second);
}

/// Same image, coefficients, far field and residuals, bit for bit.
inline bool SameOutputs(vtkIPIAImplicitFitter* a, vtkIPIAImplicitFitter* b)
{
  return SameImage(a->GetOutput(), b->GetOutput()) &&
    SameImage(ControlLattice(a), ControlLattice(b)) &&
    SameFarField(ControlLattice(a), ControlLattice(b)) &&
    SameArray(FittedPoints(a)->GetPointData()->GetArray("Residual"),
      FittedPoints(b)->GetPointData()->GetArray("Residual"));
}

/// The largest difference of two arrays of equal size, infinite if the sizes differ.
inline double LargestDifference(vtkDataArray* a, vtkDataArray* b)
{
  if (!a || !b || a->GetNumberOfTuples() != b->GetNumberOfTuples() ||
    a->GetNumberOfComponents() != b->GetNumberOfComponents())
  {
    return HUGE_VAL;
  }
  double largest = 0;
  for (vtkIdType i = 0; i < a->GetNumberOfTuples(); ++i)
  {
    for (int c = 0; c < a->GetNumberOfComponents(); ++c)
    {
      const double difference = std::abs(a->GetComponent(i, c) - b->GetComponent(i, c));
      // So that NaN is not lost in a maximum.
      largest = difference <= largest ? largest : difference;
    }
  }
  return largest;
}
}

#endif
