// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkPIPIAImplicitFitter
 * @brief   vtkIPIAImplicitFitter for ParaView: domain as a box, parallel servers
 *
 * A vtkIPIAImplicitFitter that ParaView's panel and parallel servers can use.
 *
 * ### Domain
 * UsePointBounds, ModelBoundsOrigin and ModelBoundsLength take the place of ModelBounds: a tick box
 * and what ParaView's interactive box gives.
 *
 * ### Parallel servers
 * With more than one rank each asks its input for its own part; the points of all are gathered on
 * the first rank, which fits them and has the whole output, with a warning. The other ranks know
 * the extents and have empty outputs. The result is that of a single rank; memory and time are not
 * shared out.
 *
 * @sa vtkIPIAImplicitFitter vtkPIPIASurfaceReconstruction
 */
#ifndef vtkPIPIAImplicitFitter_h
#define vtkPIPIAImplicitFitter_h

#include "IPIADomainBox.h"
#include "IPIAPanelArrays.h"
#include "vtkFiltersIPIAParaViewModule.h" // for the export macro
#include "vtkIPIAImplicitFitter.h"
#include "vtkSmartPointer.h" // for the gathered points

#include <memory> // for std::unique_ptr

namespace ipia
{
class ReplacedInput;
class SteadyCopy;
}

class VTKFILTERSIPIAPARAVIEW_EXPORT vtkPIPIAImplicitFitter : public vtkIPIAImplicitFitter
{
public:
  static vtkPIPIAImplicitFitter* New();
  vtkTypeMacro(vtkPIPIAImplicitFitter, vtkIPIAImplicitFitter);
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
  vtkPIPIAImplicitFitter();
  ~vtkPIPIAImplicitFitter() override;

  void BringInputUpToDate(vtkInformation* outInfo) override;
  int RequestInformation(
    vtkInformation* request, vtkInformationVector** input, vtkInformationVector* output) override;
  int RequestUpdateExtent(
    vtkInformation* request, vtkInformationVector** input, vtkInformationVector* output) override;
  int RequestData(
    vtkInformation* request, vtkInformationVector** input, vtkInformationVector* output) override;

private:
  vtkPIPIAImplicitFitter(const vtkPIPIAImplicitFitter&) = delete;
  void operator=(const vtkPIPIAImplicitFitter&) = delete;

  std::unique_ptr<ipia::ReplacedInput> Steady(vtkInformationVector** input);

  ipia::DomainBox Box;
  ipia::HiddenArrays Arrays;
  std::unique_ptr<ipia::SteadyCopy[]> Copies; // of each input port

  vtkSmartPointer<vtkDataObject> GatheredPoints[2]; // of each input port, on the first rank
  int RanksWithPoints;
};

#endif
