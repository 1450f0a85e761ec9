// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * The memory of the machine, for what is estimated before it is allocated.
 */
#ifndef IPIAMemory_h
#define IPIAMemory_h

#include "vtksys/SystemInformation.hxx"

namespace ipia
{
/// Share of the machine's memory that a fit may be expected to take.
constexpr double MemoryShare = 0.9;

constexpr double Gibibyte = 1073741824;

/// In bytes.
inline double memoryOfMachine()
{
  vtksys::SystemInformation information;
  information.RunMemoryCheck();
  return 1024.0 * static_cast<double>(information.GetHostMemoryTotal());
}
}

#endif
