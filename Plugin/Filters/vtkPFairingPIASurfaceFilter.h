// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkPFairingPIASurfaceFilter
 * @brief   vtkFairingPIASurfaceFilter for ParaView: parallel servers
 *
 * With more than one rank the pieces of the grid, or the points with given parameters, of all are
 * gathered on the first, which fairs them and has all outputs, with a warning; the others have none
 * of them. The result is that of a single rank. Blocks of composite data are then one, and refused
 * if they do not make up one grid.
 *
 * @sa vtkFairingPIASurfaceFilter vtkPIPIASurfaceReconstruction
 */
#ifndef vtkPFairingPIASurfaceFilter_h
#define vtkPFairingPIASurfaceFilter_h

#include "IPIAFairingPanel.h"
#include "vtkFairingPIASurfaceFilter.h"
#include "vtkFiltersIPIAParaViewModule.h" // for the export macro

class VTKFILTERSIPIAPARAVIEW_EXPORT vtkPFairingPIASurfaceFilter : public vtkFairingPIASurfaceFilter
{
public:
  static vtkPFairingPIASurfaceFilter* New();
  vtkTypeMacro(vtkPFairingPIASurfaceFilter, vtkFairingPIASurfaceFilter);

  ///@{
  /**
   * Names in place of SetInputArrayToProcess 1, 2 and 3: weights of the control points on port 1
   * (default FairingWeight), which of these may move, both if they are to be used, and the
   * parameters of the data, of two components, (u, v); empty (the default): the active texture
   * coordinates. A name that no array has is no array.
   */
  void SetControlPointWeightsArray(const char* name) { this->Arrays.Weights.SetName(name); }
  void SetMovablePointsArray(const char* name) { this->Arrays.Movable.SetName(name); }
  void SetParametersArray(const char* name)
  {
    this->Arrays.TakeOr("Active texture coordinates", 3, name);
  }
  ///@}

  ///@{
  /**
   * Whether the control points have weights of their own. Default on.
   */
  void SetUseControlPointWeights(bool use) { this->Arrays.Weights.SetUse(use); }
  bool GetUseControlPointWeights() const { return this->Arrays.Weights.GetUse(); }
  ///@}

  ///@{
  /**
   * Whether only the movable points move. Default off: all.
   */
  void SetUseMovablePoints(bool use) { this->Arrays.Movable.SetUse(use); }
  bool GetUseMovablePoints() const { return this->Arrays.Movable.GetUse(); }
  ///@}

  vtkTypeBool ProcessRequest(
    vtkInformation* request, vtkInformationVector** input, vtkInformationVector* output) override;

protected:
  vtkPFairingPIASurfaceFilter();
  ~vtkPFairingPIASurfaceFilter() override;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  int RequestUpdateExtent(
    vtkInformation* request, vtkInformationVector** input, vtkInformationVector* output) override;
  int RequestData(
    vtkInformation* request, vtkInformationVector** input, vtkInformationVector* output) override;

private:
  vtkPFairingPIASurfaceFilter(const vtkPFairingPIASurfaceFilter&) = delete;
  void operator=(const vtkPFairingPIASurfaceFilter&) = delete;

  ipia::FairingArrays Arrays;
};

#endif
