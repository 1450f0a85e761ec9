// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Vectors of the size of the data.
 *
 * A std::vector is filled with zeros by one thread, which thereby waits for the kernel to provide
 * every page of it, before others overwrite them. A BulkVector's elements begin without a value:
 * memory is first touched by the threads that write the results.
 */
#ifndef ipia_BulkVector_h
#define ipia_BulkVector_h

#include <memory>
#include <new>
#include <utility>
#include <vector>

namespace ipia
{
template <typename T>
class BulkAllocator : public std::allocator<T>
{
public:
  template <typename U>
  struct rebind
  {
    using other = BulkAllocator<U>;
  };

  BulkAllocator() = default;
  template <typename U>
  BulkAllocator(const BulkAllocator<U>&)
  {
  }

  /// Without arguments the element is left as its type leaves it: numbers have no value.
  template <typename U, typename... Arguments>
  void construct(U* at, Arguments&&... arguments)
  {
    if constexpr (sizeof...(Arguments) == 0)
    {
      ::new (static_cast<void*>(at)) U;
    }
    else
    {
      ::new (static_cast<void*>(at)) U(std::forward<Arguments>(arguments)...);
    }
  }
};

/// resize() leaves new elements without a value; assign() and copies set them as ever.
template <typename T>
using BulkVector = std::vector<T, BulkAllocator<T>>;
}

#endif
