// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * What a filter tells while it works: progress, in VTK's versions with and without CheckAbort, and
 * messages of filters that it is made of.
 */
#ifndef IPIAProgress_h
#define IPIAProgress_h

#include "vtkAlgorithm.h"
#include "vtkCommand.h"
#include "vtkOutputWindow.h"
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

/// Passes an error or a warning of another filter on as one of this.
inline void forwardMessage(vtkObject* filter, unsigned long event, void* text)
{
  if (filter->HasObserver(event))
  {
    filter->InvokeEvent(event, text);
  }
  else if (event == vtkCommand::ErrorEvent)
  {
    vtkOutputWindowDisplayErrorText(static_cast<const char*>(text));
  }
  else
  {
    vtkOutputWindowDisplayWarningText(static_cast<const char*>(text));
  }
}
}

#endif
