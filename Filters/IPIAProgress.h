// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Progress of a filter, in VTK's versions with and without CheckAbort.
 */
#ifndef IPIAProgress_h
#define IPIAProgress_h

#include "vtkAlgorithm.h"
#include "vtkVersion.h"

namespace ipia
{
/// Reports the share of the work done, in [0, 1]; false if the filter is to abort.
inline bool reportProgress(vtkAlgorithm* filter, double share)
{
  filter->UpdateProgress(share);
#if VTK_VERSION_NUMBER >= VTK_VERSION_CHECK(9, 2, 20220823)
  return !filter->CheckAbort();
#else
  return !filter->GetAbortExecute();
#endif
}
}

#endif
