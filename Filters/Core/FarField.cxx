// SPDX-License-Identifier: BSD-3-Clause
#include "FarField.h"

#include "ImplicitSpline.h"
#include "Parallel.h"

namespace ipia
{
namespace
{
template <int Dim>
std::vector<double> atCellCentres(const Lattice<Dim>& lattice, const Vector& coefficients, int threads)
{
  AxisPositions<Dim> centres;
  for (int a = 0; a < Dim; ++a)
  {
    for (std::int64_t c = 0; c < lattice.cells(a); ++c)
    {
      centres[a].push_back((static_cast<double>(c) + 0.5) * lattice.Spacing[a]);
    }
  }
  std::vector<double> values(static_cast<std::size_t>(lattice.numberOfCells()));
  ImplicitSpline<Dim>(lattice, coefficients).sample(centres, values.data(), threads);
  return values;
}

}

template <int Dim>
double medianSupport(
  const Lattice<Dim>& lattice, const Vector& support, const Points<Dim>& dataPoints, int threads)
{
  if (dataPoints.cols() == 0)
  {
    return 0;
  }
  const ImplicitSpline<Dim> spline(lattice, support);
  std::vector<double> values(static_cast<std::size_t>(dataPoints.cols()));
  parallelChunks(dataPoints.cols(), threads,
    [&](std::int64_t begin, std::int64_t end)
    {
      for (std::int64_t k = begin; k < end; ++k)
      {
        values[static_cast<std::size_t>(k)] = spline.value(dataPoints.col(k));
      }
    });
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

template <int Dim>
FarField computeFarField(const Lattice<Dim>& lattice, const Vector& support,
  const Vector& coefficients, const FarFieldOptions& options)
{
  FarField far;
  far.Magnitude = options.Magnitude;
  const int threads = resolveThreads(options.Threads);
  const std::vector<double> s = atCellCentres(lattice, support, threads);
  const std::vector<double> f = atCellCentres(lattice, coefficients, threads);

  constexpr std::int8_t unvisited = 2;
  far.Sign.resize(s.size());
  for (std::size_t c = 0; c < s.size(); ++c)
  {
    far.Sign[c] = s[c] < options.Threshold ? unvisited : 0;
  }

  const Index<Dim> count = lattice.numberOfCellsPerAxis();
  std::vector<std::int64_t> region;
  for (std::size_t seed = 0; seed < s.size(); ++seed)
  {
    if (far.Sign[seed] != unvisited)
    {
      continue;
    }
    std::int64_t positive = 0, negative = 0;
    region.assign(1, static_cast<std::int64_t>(seed));
    far.Sign[seed] = 1;
    for (std::size_t next = 0; next < region.size(); ++next)
    {
      std::int64_t stride = 1;
      for (int a = 0; a < Dim; ++a)
      {
        const std::int64_t at = region[next] / stride % count[a];
        for (int side = -1; side <= 1; side += 2)
        {
          if (at + side < 0 || at + side >= count[a])
          {
            continue;
          }
          const auto neighbour = static_cast<std::size_t>(region[next] + side * stride);
          if (far.Sign[neighbour] == unvisited)
          {
            far.Sign[neighbour] = 1;
            region.push_back(static_cast<std::int64_t>(neighbour));
          }
          else if (far.Sign[neighbour] == 0)
          {
            positive += f[neighbour] > 0;
            negative += f[neighbour] < 0;
          }
        }
        stride *= count[a];
      }
    }
    if (negative > positive)
    {
      for (const std::int64_t c : region)
      {
        far.Sign[static_cast<std::size_t>(c)] = -1;
      }
    }
    far.NumberOfMixedRegions += positive > 0 && negative > 0;
  }
  return far;
}

template double medianSupport<2>(const Lattice<2>&, const Vector&, const Points<2>&, int);
template double medianSupport<3>(const Lattice<3>&, const Vector&, const Points<3>&, int);
template FarField computeFarField<2>(
  const Lattice<2>&, const Vector&, const Vector&, const FarFieldOptions&);
template FarField computeFarField<3>(
  const Lattice<3>&, const Vector&, const Vector&, const FarFieldOptions&);
}
