// SPDX-License-Identifier: BSD-3-Clause
#include "KnotRefinement.h"

namespace ipia
{
template <int Dim>
Vector refineKnots(const Lattice<Dim>& coarse, const Vector& coefficients, const Lattice<Dim>& fine)
{
  Vector current = coefficients;
  Index<Dim> size = coarse.Size;
  for (int axis = 0; axis < Dim; ++axis)
  {
    // The lattice as (inner, axis, outer): inner axes run faster, outer ones slower.
    std::int64_t inner = 1, outer = 1;
    for (int a = 0; a < Dim; ++a)
    {
      (a < axis ? inner : outer) *= a == axis ? 1 : size[a];
    }
    const std::int64_t oldCount = size[axis], newCount = fine.Size[axis];
    Vector refined(inner * newCount * outer);
    for (std::int64_t o = 0; o < outer; ++o)
    {
      for (std::int64_t j = 0; j < newCount; ++j)
      {
        // Fine coefficient j sits at knot (j - 1) / 2 of the coarse lattice, counted from lo.
        const bool onOldKnot = (j % 2) == 1;
        const std::int64_t i = onOldKnot ? (j - 1) / 2 : j / 2;
        const auto old = [&](std::int64_t k)
        { return current.segment((o * oldCount + k) * inner, inner).array(); };
        auto out = refined.segment((o * newCount + j) * inner, inner).array();
        if (onOldKnot)
        {
          out = 0.125 * (old(i) + old(i + 2)) + 0.75 * old(i + 1);
        }
        else
        {
          out = 0.5 * (old(i) + old(i + 1));
        }
      }
    }
    current.swap(refined);
    size[axis] = newCount;
  }
  return current;
}

template Vector refineKnots<2>(const Lattice<2>&, const Vector&, const Lattice<2>&);
template Vector refineKnots<3>(const Lattice<3>&, const Vector&, const Lattice<3>&);
}
