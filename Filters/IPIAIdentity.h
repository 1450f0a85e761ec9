// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * What a result depends on that identifies data: what it was made of and when.
 */
#ifndef IPIAIdentity_h
#define IPIAIdentity_h

#include "vtkCompositeDataIterator.h"
#include "vtkCompositeDataSet.h"
#include "vtkDataArray.h"
#include "vtkDataObject.h"
#include "vtkSmartPointer.h"

#include <cstdint>
#include <vector>

namespace ipia
{
using Identity = std::vector<vtkMTimeType>;

inline void appendIdentity(vtkDataObject* data, Identity& identity)
{
  if (auto* composite = vtkCompositeDataSet::SafeDownCast(data))
  {
    auto iterator = vtkSmartPointer<vtkCompositeDataIterator>::Take(composite->NewIterator());
    for (iterator->InitTraversal(); !iterator->IsDoneWithTraversal(); iterator->GoToNextItem())
    {
      appendIdentity(iterator->GetCurrentDataObject(), identity);
    }
  }
  identity.push_back(reinterpret_cast<std::uintptr_t>(data));
  identity.push_back(data ? data->GetMTime() : 0);
}

inline void appendArrayIdentity(vtkDataArray* array, Identity& identity)
{
  identity.push_back(reinterpret_cast<std::uintptr_t>(array));
  identity.push_back(array ? array->GetMTime() : 0);
}
}

#endif
