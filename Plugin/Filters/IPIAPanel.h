// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * What both filters for ParaView have in common: the domain as a tick box and a box, the choice of
 * arrays, and the warning of a parallel server.
 */
#ifndef IPIAPanel_h
#define IPIAPanel_h

#include "vtkAlgorithm.h"
#include "vtkDataObject.h"
#include "vtkDataSetAttributes.h"
#include "vtkIndent.h"
#include "vtkInformation.h"
#include "vtkMath.h"
#include "vtkSmartPointer.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <map>
#include <ostream>
#include <string>

namespace ipia
{
/// ModelBounds of a box; invalid ones, which mean those of the points, if these are to be used. A
/// negative length is as one of 0, an empty domain, which is refused: bounds the wrong way round
/// would be taken for none.
inline std::array<double, 6> boundsOfBox(
  bool usePointBounds, const double origin[3], const double length[3])
{
  std::array<double, 6> bounds;
  vtkMath::UninitializeBounds(bounds.data());
  for (std::size_t axis = 0; axis < 3 && !usePointBounds; ++axis)
  {
    bounds[2 * axis] = origin[axis];
    bounds[2 * axis + 1] = origin[axis] + std::max(length[axis], 0.0);
  }
  return bounds;
}

/// The values of extra rows as an array to process, and what the panel offers beside names.
constexpr int ExtraValuesIndex = 2;
constexpr char ActiveScalars[] = "Active scalars";                        // as in IPIA.xml
constexpr char ActiveTextureCoordinates[] = "Active texture coordinates"; // as in Fairing.xml

/// ParaView's choice of the array of extra rows. ParaView 5.11 crashes where the first array of an
/// input port has an index above 0: it sees this one (index 2 of port 1) only while the filter
/// works.
class ExtraValuesChoice
{
public:
  void Take(vtkAlgorithm* filter, const char* name)
  {
    const std::string chosen = name && std::strcmp(name, ActiveScalars) != 0 ? name : "";
    if (chosen != this->ExtraValues)
    {
      this->ExtraValues = chosen;
      filter->Modified();
    }
  }

  /// Shows the filter its extra values for as long as this lives.
  class Shown
  {
  public:
    Shown(const ExtraValuesChoice& chosen, vtkAlgorithm* filter)
      : Info(filter->GetInputArrayInformation(ExtraValuesIndex))
    {
      if (!chosen.ExtraValues.empty())
      {
        this->Info->Remove(vtkDataObject::FIELD_ATTRIBUTE_TYPE());
        this->Info->Set(vtkDataObject::FIELD_NAME(), chosen.ExtraValues.c_str());
      }
    }
    ~Shown()
    {
      this->Info->Remove(vtkDataObject::FIELD_NAME());
      this->Info->Set(vtkDataObject::FIELD_ATTRIBUTE_TYPE(), vtkDataSetAttributes::SCALARS);
    }
    Shown(const Shown&) = delete;
    void operator=(const Shown&) = delete;

  private:
    vtkInformation* Info;
  };

private:
  std::string ExtraValues;
};

/// Arrays to process by their indices that ParaView 5.11, for the reason above, sees only while the
/// filter works.
class HiddenArrays
{
public:
  static constexpr const char* NoArray = "None";

  /// nullptr: what the filter takes by itself; an empty name, as the panel's None: no array.
  void Take(vtkAlgorithm* filter, int index, const char* name)
  {
    const std::string chosen = !name ? "" : *name == 0 ? NoArray : name;
    if (chosen != this->Names[index])
    {
      this->Names[index] = chosen;
      filter->Modified();
    }
  }

  /// Shows the filter its arrays for as long as this lives.
  class Shown
  {
  public:
    Shown(const HiddenArrays& hidden, vtkAlgorithm* filter)
      : Filter(filter)
    {
      for (const auto& [index, name] : hidden.Names)
      {
        if (!name.empty())
        {
          vtkInformation* info = filter->GetInputArrayInformation(index);
          auto& before = this->Before[index];
          before = vtkSmartPointer<vtkInformation>::New();
          before->Copy(info);
          info->Remove(vtkDataObject::FIELD_ATTRIBUTE_TYPE());
          info->Set(vtkDataObject::FIELD_NAME(), name.c_str());
        }
      }
    }
    ~Shown()
    {
      for (const auto& [index, before] : this->Before)
      {
        this->Filter->GetInputArrayInformation(index)->Copy(before);
      }
    }
    Shown(const Shown&) = delete;
    void operator=(const Shown&) = delete;

  private:
    vtkAlgorithm* Filter;
    std::map<int, vtkSmartPointer<vtkInformation>> Before;
  };

  /// Hides an array that the filter has chosen by name.
  void Hide(vtkAlgorithm* filter, int index, int port, const char* name)
  {
    filter->SetInputArrayToProcess(index, port, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, name);
    filter->GetInputArrayInformation(index)->Remove(vtkDataObject::FIELD_NAME());
    this->Names[index] = name;
  }

private:
  std::map<int, std::string> Names;
};

/// Whether ParaView has chosen no array to process yet, as in a script that has not updated the
/// input: it then tells the index in place of a name.
inline bool isUnchosen(int index, const char* name)
{
  return !name || std::to_string(index) == name;
}

inline void printBox(std::ostream& os, vtkIndent indent, bool usePointBounds,
  const double origin[3], const double length[3])
{
  const auto print = [&](const char* name, const double* x)
  { os << indent << name << ": (" << x[0] << ", " << x[1] << ", " << x[2] << ")\n"; };
  os << indent << "UsePointBounds: " << usePointBounds << "\n";
  print("ModelBoundsOrigin", origin);
  print("ModelBoundsLength", length);
}

inline std::string gatheredWarning(int ranksWithPoints, int ranks)
{
  return "The points of " + std::to_string(ranksWithPoints) + " ranks are fitted on the first of " +
    std::to_string(ranks) +
    ", which has all of the output: the result is that of a single rank and takes its memory and "
    "time.";
}
}

#endif
