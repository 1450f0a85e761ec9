// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkPFairingPIACurveFilter
 * @brief   vtkFairingPIACurveFilter for ParaView: parallel servers
 *
 * With more than one rank the lines of all are gathered on the first, which fairs them and has all
 * outputs, with a warning; the others have none of them. The result is that of a single rank.
 * Blocks of composite data are then faired as one.
 *
 * @sa vtkFairingPIACurveFilter vtkPIPIASurfaceReconstruction
 */
#ifndef vtkPFairingPIACurveFilter_h
#define vtkPFairingPIACurveFilter_h

#include "IPIAFairingPanel.h"
#include "vtkFairingPIACurveFilter.h"
#include "vtkFiltersIPIAParaViewModule.h" // for the export macro

class VTKFILTERSIPIAPARAVIEW_EXPORT vtkPFairingPIACurveFilter : public vtkFairingPIACurveFilter
{
public:
  static vtkPFairingPIACurveFilter* New();
  vtkTypeMacro(vtkPFairingPIACurveFilter, vtkFairingPIACurveFilter);

  ///@{
  /**
   * Names in place of SetInputArrayToProcess 1, 2 and 3: weights of the control points on port 1
   * (default FairingWeight), which of these may move, both if they are to be used, and the
   * parameters of the data, of one component. A name that no array has is no array.
   */
  void SetControlPointWeightsArray(const char* name) { this->Arrays.Weights.SetName(name); }
  void SetMovablePointsArray(const char* name) { this->Arrays.Movable.SetName(name); }
  void SetParametersArray(const char* name) { this->Arrays.Take(3, name); }
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
  vtkPFairingPIACurveFilter();
  ~vtkPFairingPIACurveFilter() override;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  int RequestUpdateExtent(
    vtkInformation* request, vtkInformationVector** input, vtkInformationVector* output) override;
  int RequestData(
    vtkInformation* request, vtkInformationVector** input, vtkInformationVector* output) override;

private:
  vtkPFairingPIACurveFilter(const vtkPFairingPIACurveFilter&) = delete;
  void operator=(const vtkPFairingPIACurveFilter&) = delete;

  ipia::FairingArrays Arrays;
};

#endif
