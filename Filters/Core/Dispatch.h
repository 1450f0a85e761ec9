// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Run-time choice of the instruction set, so that one portable binary uses what the machine has.
 *
 * A kernel is a struct with a static, forcibly inlined run(...); dispatch<Kernel>(...) compiles it
 * once per instruction set and calls the best one. Kernels may use the vector types below; the
 * compiler splits them where the registers are narrower.
 */
#ifndef ipia_Dispatch_h
#define ipia_Dispatch_h

#if !defined(__GNUC__)
#error "The kernels are written with the vector extensions of GCC and Clang."
#endif

#define IPIA_INLINE inline __attribute__((always_inline))

namespace ipia
{
using Vector4 = double __attribute__((vector_size(32)));
using Vector8 = double __attribute__((vector_size(64)));
using FloatVector8 = float __attribute__((vector_size(32)));

enum class InstructionSet
{
  Baseline,
  Avx2,
  Avx512
};

#if defined(__x86_64__)
inline InstructionSet instructionSet()
{
  static const InstructionSet best = []
  {
    __builtin_cpu_init();
    const bool avx2 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
    const bool avx512 = avx2 && __builtin_cpu_supports("avx512f") &&
      __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl");
    return avx512 ? InstructionSet::Avx512 : avx2 ? InstructionSet::Avx2 : InstructionSet::Baseline;
  }();
  return best;
}

template <typename Kernel, typename... Arguments>
__attribute__((target("avx512f,avx512dq,avx512vl,avx2,fma"))) void runAvx512(
  Arguments&&... arguments)
{
  Kernel::run(arguments...);
}

template <typename Kernel, typename... Arguments>
__attribute__((target("avx2,fma"))) void runAvx2(Arguments&&... arguments)
{
  Kernel::run(arguments...);
}
#endif

/// Runs the first kernel where registers hold sixteen floats, otherwise the second.
template <typename WideKernel, typename Kernel, typename... Arguments>
void dispatchByWidth(Arguments&&... arguments)
{
#if defined(__x86_64__)
  switch (instructionSet())
  {
    case InstructionSet::Avx512:
      runAvx512<WideKernel>(arguments...);
      return;
    case InstructionSet::Avx2:
      runAvx2<Kernel>(arguments...);
      return;
    case InstructionSet::Baseline:
      break;
  }
#endif
  Kernel::run(arguments...);
}

template <typename Kernel, typename... Arguments>
void dispatch(Arguments&&... arguments)
{
  dispatchByWidth<Kernel, Kernel>(arguments...);
}
}

#endif
