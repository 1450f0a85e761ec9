// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkPIPIASurfaceReconstruction
 * @brief   vtkIPIASurfaceReconstruction for ParaView: one panel, parallel servers
 *
 * A vtkIPIASurfaceReconstruction whose fitter's parameters are its own, as ParaView's panel needs
 * them, with the domain given as in vtkPIPIAImplicitFitter.
 *
 * With more than one rank the points of all are gathered on the first, which fits them and has the
 * whole surface, with a warning; the others have none of it.
 *
 * @sa vtkIPIASurfaceReconstruction vtkPIPIAImplicitFitter
 */
#ifndef vtkPIPIASurfaceReconstruction_h
#define vtkPIPIASurfaceReconstruction_h

#include "IPIADomainBox.h"
#include "IPIAPanelArrays.h"
#include "vtkFiltersIPIAParaViewModule.h" // for the export macro
#include "vtkIPIASurfaceReconstruction.h"

class VTKFILTERSIPIAPARAVIEW_EXPORT vtkPIPIASurfaceReconstruction
  : public vtkIPIASurfaceReconstruction
{
public:
  static vtkPIPIASurfaceReconstruction* New();
  vtkTypeMacro(vtkPIPIASurfaceReconstruction, vtkIPIASurfaceReconstruction);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * Whether the domain is derived from the points (and Padding); otherwise it is the box below.
   * Default on.
   */
  void SetUsePointBounds(bool use) { this->Box.SetUsePointBounds(use); }
  bool GetUsePointBounds() const { return this->Box.GetUsePointBounds(); }
  ///@}

  ///@{
  /**
   * Lower corner and side lengths of the domain, world units. Default: the unit cube.
   */
  void SetModelBoundsOrigin(double x, double y, double z) { this->Box.SetOrigin(x, y, z); }
  void SetModelBoundsLength(double x, double y, double z) { this->Box.SetLength(x, y, z); }
  double* GetModelBoundsOrigin() { return this->Box.GetOrigin(); }
  double* GetModelBoundsLength() { return this->Box.GetLength(); }
  ///@}

  ///@{
  /**
   * Parameters of the fitter, see vtkIPIAImplicitFitter.
   */
  void SetGridSize(int x, int y, int z);
  void SetSampleDimensions(int x, int y, int z);
  void SetPadding(double value);
  void SetDimension(int value);
  void SetNormalConstraint(int value);
  void SetOffsetDistance(double value);
  void SetOffsetValue(double value);
  void SetInwardOffsetDistance(double value);
  void SetInwardOffsetValue(double value);
  void SetBasisType(int value);
  void SetWeightStepSize(double value);
  void SetOscillationWeight(double value);
  void SetOscillationStep(int value);
  void SetFairingWeight(double value);
  void SetFairingOrder(int value);
  void SetSolver(int value);
  void SetNumberOfLevels(int value);
  void SetMaximumNumberOfIterations(int value);
  void SetTolerance(double value);
  void SetStoppingRule(int value);
  void SetStepSize(double value);
  void SetUseNormalLengths(bool value);
  void SetFeatherScans(bool value);
  ///@}

  /// The point array of the extra rows (port 1) with the values of f; "Active scalars" (the
  /// default) stands for these. Takes the place of SetInputArrayToProcess 2.
  void SetExtraValuesArray(const char* name) { this->Arrays.TakeOr("Active scalars", 2, name); }

  using vtkAlgorithm::SetInputArrayToProcess;

  /// As ParaView chooses arrays: normals that it has not chosen yet are the active ones.
  void SetInputArrayToProcess(
    int index, int port, int connection, int association, const char* name) override;

  vtkTypeBool ProcessRequest(
    vtkInformation* request, vtkInformationVector** input, vtkInformationVector* output) override;

protected:
  vtkPIPIASurfaceReconstruction();
  ~vtkPIPIASurfaceReconstruction() override;

  int RequestUpdateExtent(
    vtkInformation* request, vtkInformationVector** input, vtkInformationVector* output) override;
  int RequestData(
    vtkInformation* request, vtkInformationVector** input, vtkInformationVector* output) override;

private:
  vtkPIPIASurfaceReconstruction(const vtkPIPIASurfaceReconstruction&) = delete;
  void operator=(const vtkPIPIASurfaceReconstruction&) = delete;

  ipia::DomainBox Box;
  ipia::HiddenArrays Arrays;
};

#endif
