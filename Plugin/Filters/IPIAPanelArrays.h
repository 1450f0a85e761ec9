// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Arrays to process as ParaView chooses them.
 */
#ifndef IPIAPanelArrays_h
#define IPIAPanelArrays_h

#include "vtkFiltersIPIAParaViewModule.h" // for the export macro
#include "vtkSmartPointer.h"

#include <map>
#include <string>

class vtkAlgorithm;
class vtkInformation;

namespace ipia
{
/// Arrays of a filter by their indices that ParaView sees only while the filter works:
/// ParaView 5.11 crashes where the first array of an input port has an index above 0.
class VTKFILTERSIPIAPARAVIEW_EXPORT HiddenArrays
{
public:
  static constexpr const char* NoArray = "None";

  explicit HiddenArrays(vtkAlgorithm* filter);

  /// nullptr: what the filter takes by itself; an empty name, as the panel's None: no array.
  void Take(int index, const char* name);

  /// As Take, where the panel has `label` for what the filter takes by itself. So is no name.
  void TakeOr(const char* label, int index, const char* name);

  /// Hides an array that the filter has chosen by name.
  void Hide(int index, int port, const char* name);

  /// Shows the filter its arrays for as long as this lives.
  class VTKFILTERSIPIAPARAVIEW_EXPORT Shown
  {
  public:
    explicit Shown(const HiddenArrays& hidden);
    ~Shown();
    Shown(const Shown&) = delete;
    void operator=(const Shown&) = delete;

  private:
    vtkAlgorithm* Filter;
    std::map<int, vtkSmartPointer<vtkInformation>> Before;
  };

private:
  vtkAlgorithm* Filter;
  std::map<int, std::string> Names;
};

/// SetInputArrayToProcess of the filters whose array 0 are normals: those that ParaView has not
/// chosen yet, as in a script that has not updated the input, are the active ones.
void setArrayOrNormals(
  vtkAlgorithm* filter, int index, int port, int connection, int association, const char* name);
}

#endif
