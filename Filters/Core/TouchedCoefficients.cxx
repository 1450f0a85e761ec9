// SPDX-License-Identifier: BSD-3-Clause
#include "TouchedCoefficients.h"

namespace ipia
{
template <int Dim>
TouchedCoefficients::TouchedCoefficients(const ConstraintRows<Dim>& rows)
{
  const Lattice<Dim>& lattice = rows.lattice();
  const std::int64_t n = lattice.numberOfCoefficients(), sizeX = lattice.Size[0];
  std::vector<bool> touched(static_cast<std::size_t>(n), false);
  const std::int64_t occupied = rows.tileBegin(rows.numberOfTiles());
  for (std::int64_t cell = 0; cell < occupied; ++cell)
  {
    for (std::int64_t line = 0; line < (Dim == 3 ? Order * Order : Order); ++line)
    {
      const std::int64_t first = rows.cells()[cell].Coefficient + line % Order * sizeX +
        (Dim == 3 ? line / Order * sizeX * lattice.Size[1] : 0);
      std::fill_n(touched.begin() + first, static_cast<std::int64_t>(Order), true);
    }
  }
  this->TaskBegin.push_back(0);
  std::int64_t inTask = 0;
  for (std::int64_t i = 0, end = 0; i < n; i = end)
  {
    const bool use = touched[static_cast<std::size_t>(i)];
    for (end = i + 1; end < n && touched[static_cast<std::size_t>(end)] == use &&
         (!use || end - i < VectorChunk);)
    {
      ++end;
    }
    if (use)
    {
      this->Runs.emplace_back(i, end);
      inTask += end - i;
      if (inTask >= VectorChunk)
      {
        this->TaskBegin.push_back(this->Runs.size());
        inTask = 0;
      }
    }
  }
  if (this->TaskBegin.back() != this->Runs.size())
  {
    this->TaskBegin.push_back(this->Runs.size());
  }
}

template TouchedCoefficients::TouchedCoefficients(const ConstraintRows<2>&);
template TouchedCoefficients::TouchedCoefficients(const ConstraintRows<3>&);
}
