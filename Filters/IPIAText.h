// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Messages from parts of any type.
 */
#ifndef IPIAText_h
#define IPIAText_h

#include <sstream>
#include <string>

namespace ipia
{
template <typename... Parts>
std::string text(const Parts&... parts)
{
  std::ostringstream stream;
  (stream << ... << parts);
  return stream.str();
}

/// "(a, b, c)"
template <typename Value>
std::string triple(const Value* v)
{
  return text("(", v[0], ", ", v[1], ", ", v[2], ")");
}
}

#endif
