// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * How f goes on beyond its domain: as f at the nearest point of the domain, moved away from 0 by
 * the distance to it, so that the sign stays.
 */
#ifndef ipia_OutsideDomain_h
#define ipia_OutsideDomain_h

#include "Types.h"

namespace ipia
{
/**
 * @param away      from the nearest point of the domain to the position
 * @param f         at the nearest point
 * @param gradient  there, turned into that at the position; may be nullptr
 * @return f at the position
 */
template <int Dim>
double continueOutside(const Point<Dim>& away, double f, Point<Dim>* gradient)
{
  const double distance = away.norm();
  if (distance > 0 && gradient)
  {
    for (int a = 0; a < Dim; ++a)
    {
      (*gradient)[a] = away[a] == 0 ? (*gradient)[a] : 0.0;
    }
    *gradient += (f < 0 ? -1.0 : 1.0) / distance * away;
  }
  return f < 0 ? f - distance : f + distance;
}
}

#endif
