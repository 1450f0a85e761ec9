// SPDX-License-Identifier: BSD-3-Clause
#include "Oscillation.h"

#include "Parallel.h"

namespace ipia
{
template <int Dim>
double oscillation(const Lattice<Dim>& lattice, const Vector& coefficients)
{
  double sum = 0;
  std::int64_t stride = 1;
  for (int a = 0; a < Dim; ++a)
  {
    for (std::int64_t i = 0; i + stride < coefficients.size(); ++i)
    {
      if (i / stride % lattice.Size[a] + 1 < lattice.Size[a])
      {
        const double difference = coefficients[i + stride] - coefficients[i];
        sum += 2 * difference * difference;
      }
    }
    stride *= lattice.Size[a];
  }
  return sum;
}

template <int Dim>
double oscillation(
  const Lattice<Dim>& lattice, const Vector& coefficients, Vector& laplacian, int threads)
{
  laplacian.resize(coefficients.size());
  const double* const c = coefficients.data();
  const std::int64_t sizeX = lattice.Size[0];
  // From begin on, up to the end of its line along x or of the chunk.
  const auto part = [&](std::int64_t begin, std::int64_t end)
  {
    // Offsets to the neighbours across the line; 0 where there is none, for a difference of 0.
    std::array<std::int64_t, 2 * (Dim - 1)> offset{};
    std::int64_t stride = sizeX, line = begin / sizeX;
    for (std::size_t a = 1; a < Dim; ++a)
    {
      const std::int64_t at = line % lattice.Size[a];
      offset[2 * a - 2] = at > 0 ? -stride : 0;
      offset[2 * a - 1] = at + 1 < lattice.Size[a] ? stride : 0;
      line /= lattice.Size[a];
      stride *= lattice.Size[a];
    }
    const std::int64_t first = begin / sizeX * sizeX, last = first + sizeX - 1;
    double sum = 0;
    for (std::int64_t i = begin; i < end; ++i)
    {
      const double before = c[i] - c[std::max(i - 1, first)];
      const double after = c[i] - c[std::min(i + 1, last)];
      double total = before + after;
      sum += before * before + after * after;
      for (const std::int64_t o : offset)
      {
        const double difference = c[i] - c[i + o];
        total += difference;
        sum += difference * difference;
      }
      laplacian[i] = total;
    }
    return sum;
  };
  return parallelSum(coefficients.size(), threads,
    [&](std::int64_t begin, std::int64_t end)
    {
      double sum = 0;
      for (std::int64_t i = begin, next = begin; i < end; i = next)
      {
        next = std::min(end, (i / sizeX + 1) * sizeX);
        sum += part(i, next);
      }
      return sum;
    });
}

template <int Dim>
OscillationTerm<Dim>::OscillationTerm(
  const Lattice<Dim>& lattice, const OscillationOptions& options, int threads)
  : ControlLattice(lattice)
  , Options(options)
  , Threads(threads)
  , Kappa(2 * options.Weight)
{
}

template <int Dim>
double OscillationTerm<Dim>::chooseStepSize(double largestRowSum, double given)
{
  const double lambda = this->Options.Weight;
  const bool printed = this->Options.Step == OscillationStep::AsPrinted;
  const double bound = largestRowSum + (printed ? 0 : 8 * Dim * lambda);
  const double mu = given > 0 ? given : bound > 0 ? 2 / bound : 0.0;
  this->Kappa = printed && mu > 0 ? 4 * lambda / mu : 2 * lambda;
  return mu;
}

template <int Dim>
void OscillationTerm<Dim>::update(const Vector& coefficients)
{
  if (this->isActive())
  {
    this->Value = oscillation(this->ControlLattice, coefficients, this->Laplacian, this->Threads);
  }
}

template <int Dim>
double OscillationTerm<Dim>::sumOfWeights() const
{
  return 2 * Dim * this->Kappa * static_cast<double>(this->ControlLattice.numberOfCoefficients());
}

template double oscillation<2>(const Lattice<2>&, const Vector&);
template double oscillation<3>(const Lattice<3>&, const Vector&);
template double oscillation<2>(const Lattice<2>&, const Vector&, Vector&, int);
template double oscillation<3>(const Lattice<3>&, const Vector&, Vector&, int);
template class OscillationTerm<2>;
template class OscillationTerm<3>;
}
