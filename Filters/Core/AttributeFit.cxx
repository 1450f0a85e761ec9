// SPDX-License-Identifier: BSD-3-Clause
#include "AttributeFit.h"

#include "HierarchyLevel.h"
#include "Parallel.h"

#include <Eigen/Eigenvalues>

#include <limits>

namespace ipia
{
namespace
{
/// tau_1 and tau_2 of the levels that are solved everywhere, and tau_2 of the bands.
constexpr float DenseMembrane = 1e-3F, DenseThinPlate = 1e-4F, BandThinPlate = 5e-5F;
constexpr int DenseIterations = 20, BandIterations = 8, SmoothingIterations = 12;
constexpr int FinalIterations = 12;
constexpr double Tolerance = 1e-3;
/// Prediction: one point of so many is held out, if that gives at least so many; the smoothest
/// choice that predicts within the slack of the best is taken.
constexpr std::size_t HeldOutPeriod = 8, FewestHeldOut = 8;
constexpr double PredictionSlack = 1.0025;
/// Where levels still gain this factor detail is what they miss, not noise. Else tau_2 grows in
/// such steps, as often as prediction gains by it.
constexpr double FallOfDetail = 0.75;
constexpr float ThinPlateStep = 8;
constexpr int MostThinPlateSteps = 6;
/// What a linear function leaves is rounding below this share of the values.
constexpr double RoundingOfValues = 1e-12;
/// Extents of the points below this share of the largest, squared, give no slope.
constexpr double LeastExtent = 1e-12;

/// An array while it is fitted.
template <int Dim>
struct Target
{
  double Scale = 0; ///< the largest rest
  std::vector<typename AttributeSpline<Dim>::Component> Components;
  std::vector<std::vector<float>> Rest; ///< by component and point, in units of the scale
  AttributeReport Report;

  struct Candidate
  {
    std::size_t OnLevel;
    float ThinPlate;
    double Error;
    std::vector<BrickValues> Solution; ///< coefficients by component
  };
  std::vector<Candidate> Candidates; ///< of all levels, coarse to fine, then of more fairing

  bool isSpline() const { return this->Scale > 0; }
};

/// The weighted least-squares linear function of the values, and what it leaves.
template <int Dim>
Target<Dim> makeTarget(
  const Points<Dim>& positions, const Vector& weights, const Eigen::MatrixXd& values)
{
  const std::int64_t n = positions.cols();
  const auto weightOf = [&](std::int64_t k) { return weights.size() > 0 ? weights[k] : 1.0; };
  const auto m = static_cast<Eigen::Index>(values.rows());
  double total = 0;
  Point<Dim> centre = Point<Dim>::Zero();
  Vector mean = Vector::Zero(m);
  for (std::int64_t k = 0; k < n; ++k)
  {
    total += weightOf(k);
    centre += weightOf(k) * (positions.col(k) - positions.col(0));
    mean += weightOf(k) * (values.col(k) - values.col(0));
  }
  centre = positions.col(0) + centre / total;
  mean = values.col(0) + mean / total;
  using Matrix = Eigen::Matrix<double, Dim, Dim>;
  Matrix moments = Matrix::Zero();
  Eigen::Matrix<double, Dim, Eigen::Dynamic> products(Dim, m);
  products.setZero();
  for (std::int64_t k = 0; k < n; ++k)
  {
    const Point<Dim> d = positions.col(k) - centre;
    moments += weightOf(k) * d * d.transpose();
    products += weightOf(k) * d * (values.col(k) - mean).transpose();
  }
  // Points in a plane or on a line say nothing about the slope across it: none is taken there.
  const Eigen::SelfAdjointEigenSolver<Matrix> axes(moments);
  Matrix inverse = Matrix::Zero();
  for (int a = 0; a < Dim; ++a)
  {
    const double moment = axes.eigenvalues()[a];
    if (moment > LeastExtent * axes.eigenvalues()[Dim - 1])
    {
      inverse += axes.eigenvectors().col(a) * axes.eigenvectors().col(a).transpose() / moment;
    }
  }
  const Eigen::Matrix<double, Dim, Eigen::Dynamic> slopes = inverse * products;

  Target<Dim> target;
  target.Components.resize(static_cast<std::size_t>(m));
  target.Rest.resize(static_cast<std::size_t>(m));
  double largest = 0;
  for (Eigen::Index c = 0; c < m; ++c)
  {
    auto& component = target.Components[static_cast<std::size_t>(c)];
    component.Slope = slopes.col(c);
    component.Constant = mean[c] - component.Slope.dot(centre);
    component.Low = values.row(c).minCoeff();
    component.High = values.row(c).maxCoeff();
    largest = std::max({ largest, std::abs(component.Low), std::abs(component.High) });
  }
  const auto restOf = [&](std::int64_t k, Eigen::Index c)
  { return values(c, k) - mean[c] - slopes.col(c).dot(positions.col(k) - centre); };
  for (std::int64_t k = 0; k < n; ++k)
  {
    for (Eigen::Index c = 0; c < m; ++c)
    {
      target.Scale = std::max(target.Scale, std::abs(restOf(k, c)));
    }
  }
  if (!(target.Scale > RoundingOfValues * largest))
  {
    target.Scale = 0;
    return target;
  }
  for (Eigen::Index c = 0; c < m; ++c)
  {
    std::vector<float>& rest = target.Rest[static_cast<std::size_t>(c)];
    rest.resize(static_cast<std::size_t>(n));
    for (std::int64_t k = 0; k < n; ++k)
    {
      rest[static_cast<std::size_t>(k)] = static_cast<float>(restOf(k, c) / target.Scale);
    }
  }
  return target;
}

/// Points in their order, the levels that see them, and which of the input they are.
template <int Dim>
struct Dataset
{
  std::vector<Level<Dim>> Levels;
  std::vector<std::int64_t> Source;
};

/// The rows of a dataset on a level; their values are set for one component at a time.
template <int Dim>
struct LevelRows
{
  HermiteRows<Dim> Rows;
  std::vector<std::size_t> Begin; ///< the first point of each row, and the end
};

template <int Dim>
class AttributeFitter
{
public:
  AttributeFitter(const Lattice<Dim>& lattice, AttributeInput<Dim>& input, int threads,
    const ProgressCallback& progress)
    : Threads(threads)
    , Progress(progress)
  {
    for (Eigen::MatrixXd& values : input.Arrays)
    {
      this->Targets.push_back(makeTarget<Dim>(input.Positions, input.Weights, values));
      values.resize(0, 0);
    }
    HermiteInput<Dim> rows;
    rows.ExtraPositions = std::move(input.Positions);
    rows.ExtraValues = Vector::Zero(rows.ExtraPositions.cols());
    // Only ratios count; the rows are of single precision.
    rows.ExtraWeights = input.Weights / (input.Weights.size() ? input.Weights.maxCoeff() : 1.0);
    Dataset<Dim>& all = this->All;
    Samples<Dim> samples = sortedSamples(lattice, rows, threads, &all.Source);
    rows = {};
    Samples<Dim> kept;
    for (std::size_t k = 0; k < samples.size(); ++k)
    {
      const bool hold = k % HeldOutPeriod == HeldOutPeriod - 1 && samples[k].Weight > 0;
      (hold ? this->HeldOut : kept).push_back(samples[k]);
      (hold ? this->HeldOutSource : this->Training.Source).push_back(all.Source[k]);
    }
    all.Levels = makeLevels(lattice, std::move(samples), {}, threads);
    this->Training.Levels = makeLevels(lattice, std::move(kept), {}, threads);
    this->Bricks = makeBricks(all.Levels, threads);
  }

  AttributeResult<Dim> run()
  {
    AttributeResult<Dim> result;
    if (this->HeldOut.size() < FewestHeldOut)
    {
      this->HeldOut.clear();
      this->Training = {};
    }
    this->countWork();
    this->solveLevels();
    for (Target<Dim>& target : this->Targets)
    {
      if (target.isSpline() && !this->HeldOut.empty() && !this->Aborted)
      {
        this->trySmoothing(target);
        this->choose(target);
      }
    }
    for (std::size_t l = 0; l < this->Bricks.size() && !this->HeldOut.empty(); ++l)
    {
      this->solveChosen(l);
    }
    result.Aborted = this->Aborted;
    if (this->Aborted)
    {
      return result;
    }
    for (BrickLattice<Dim>& bricks : this->Bricks)
    {
      bricks.coefficients() = {};
    }
    const auto levels =
      std::make_shared<const std::vector<BrickLattice<Dim>>>(std::move(this->Bricks));
    for (Target<Dim>& target : this->Targets)
    {
      target.Report.NumberOfLevels = static_cast<int>(levels->size());
      for (auto& ofLevel : target.Candidates)
      {
        for (std::size_t c = 0; c < target.Components.size(); ++c)
        {
          target.Components[c].Splines.push_back(std::move(ofLevel.Solution[c]));
        }
      }
      result.Arrays.emplace_back(levels, target.Scale, std::move(target.Components));
      result.Reports.push_back(target.Report);
    }
    return result;
  }

private:
  static FairingWeights fairing(const Level<Dim>& level, float thinPlate)
  {
    FairingWeights weights;
    weights.Membrane = level.Dense ? DenseMembrane : 0.F;
    weights.ThinPlate = thinPlate;
    return weights;
  }

  static float leastThinPlate(const Level<Dim>& level)
  {
    return level.Dense ? DenseThinPlate : BandThinPlate;
  }

  LevelRows<Dim> rowsOf(const Dataset<Dim>& data, std::size_t l) const
  {
    LevelRows<Dim> rows;
    const Level<Dim>& level = data.Levels[l];
    rows.Rows = makeRows(level, this->Bricks[l], level.Data.data(),
      static_cast<std::int64_t>(level.Data.size()), 0, this->Threads);
    const double typical = typicalDensity(this->Bricks[l], rows.Rows, this->Threads);
    for (HermiteRow<Dim>& row : rows.Rows.Rows)
    {
      row.Weight = static_cast<float>(row.Weight / typical);
    }
    const Samples<Dim>& points = data.Levels.back().points();
    rows.Begin.reserve(level.Data.size() + 1);
    for (std::size_t k = 0; k < points.size() && rows.Begin.size() < level.Data.size(); ++k)
    {
      // A cluster has the key of its first point.
      if (points[k].Key == level.Data[rows.Begin.size()].Key)
      {
        rows.Begin.push_back(k);
      }
    }
    rows.Begin.push_back(points.size());
    return rows;
  }

  void setValues(const Dataset<Dim>& data, const std::vector<float>& rest, LevelRows<Dim>& rows)
  {
    const Samples<Dim>& points = data.Levels.back().points();
    parallelChunks(static_cast<std::int64_t>(rows.Rows.Rows.size()), this->Threads,
      [&](std::int64_t begin, std::int64_t end)
      {
        for (auto r = static_cast<std::size_t>(begin); r < static_cast<std::size_t>(end); ++r)
        {
          double sum = 0, weight = 0;
          for (std::size_t k = rows.Begin[r]; k < rows.Begin[r + 1]; ++k)
          {
            const double w = points[k].Weight;
            sum += w * rest[static_cast<std::size_t>(data.Source[k])];
            weight += w;
          }
          rows.Rows.Rows[r].Value = weight > 0 ? static_cast<float>(sum / weight) : 0.F;
        }
      });
  }

  /// Solves one component on level @a l from the coefficients that the level's bricks have.
  BrickValues solve(std::size_t l, const LevelRows<Dim>& rows, float thinPlate, int iterations)
  {
    const Level<Dim>& level = this->All.Levels[l];
    BrickLattice<Dim>& bricks = this->Bricks[l];
    const BrickOperator<Dim> system(bricks, rows.Rows, fairing(level, thinPlate), this->Threads);
    LevelReport report;
    const double work = static_cast<double>(bricks.numberOfActiveBricks());
    solveSystem(
      system, bricks, iterations, Tolerance, StoppingRule::RelativeResidual, 0, this->Threads,
      [&](double share)
      {
        return !this->Progress ||
          this->Progress(std::min((this->WorkDone + share * work) / this->Work, 1.0));
      },
      report);
    this->Aborted = this->Aborted || report.Aborted;
    this->WorkDone += work;
    return bricks.coefficients();
  }

  /// Sum of the weighted squared misses of the held-out values.
  double missOf(std::size_t l, const HermiteRows<Dim>& rows, const std::vector<float>& rest,
    const BrickValues& coefficients) const
  {
    BrickValues values;
    BrickOperator<Dim>(this->Bricks[l], rows, {}, this->Threads).evaluate(coefficients, values);
    double sum = 0;
    for (std::size_t k = 0; k < values.size(); ++k)
    {
      const double miss =
        static_cast<double>(values[k]) - rest[static_cast<std::size_t>(this->HeldOutSource[k])];
      sum += static_cast<double>(this->HeldOut[k].Weight) * miss * miss;
    }
    return sum;
  }

  HermiteRows<Dim> heldOutRows(std::size_t l) const
  {
    return makeRows(this->All.Levels[l], this->Bricks[l], this->HeldOut.data(),
      static_cast<std::int64_t>(this->HeldOut.size()), 0, this->Threads);
  }

  /// The root mean square miss of the held-out values.
  double errorOf(const Target<Dim>& target, std::size_t l, const HermiteRows<Dim>& heldOut,
    const std::vector<BrickValues>& solution) const
  {
    double sum = 0, total = 0;
    for (const Sample<Dim>& sample : this->HeldOut)
    {
      total += sample.Weight;
    }
    for (std::size_t c = 0; c < solution.size(); ++c)
    {
      sum += this->missOf(l, heldOut, target.Rest[c], solution[c]);
    }
    return total > 0 ? std::sqrt(sum / total) : 0.0;
  }

  /// Coarse to fine, each level from the one before: without the held-out points, if there are any.
  void solveLevels()
  {
    const Dataset<Dim>& data = this->HeldOut.empty() ? this->All : this->Training;
    for (std::size_t l = 0; l < this->Bricks.size(); ++l)
    {
      const Level<Dim>& level = this->All.Levels[l];
      LevelRows<Dim> rows = this->rowsOf(data, l);
      const HermiteRows<Dim> heldOut = this->heldOutRows(l);
      for (Target<Dim>& target : this->Targets)
      {
        if (!target.isSpline())
        {
          continue;
        }
        target.Report.Level = static_cast<int>(l);
        target.Report.ThinPlate = leastThinPlate(level);
        target.Candidates.push_back({ l, leastThinPlate(level), 0, {} });
        auto& solution = target.Candidates.back().Solution;
        for (std::size_t c = 0; c < target.Components.size() && !this->Aborted; ++c)
        {
          BrickValues& coefficients = this->Bricks[l].coefficients();
          if (l > 0)
          {
            this->Bricks[l - 1].coefficients() = target.Candidates[l - 1].Solution[c];
            this->Bricks[l].refineFrom(this->Bricks[l - 1], this->Threads);
          }
          else
          {
            std::fill(coefficients.begin(), coefficients.end(), 0.F);
          }
          this->setValues(data, target.Rest[c], rows);
          solution.push_back(this->solve(
            l, rows, leastThinPlate(level), level.Dense ? DenseIterations : BandIterations));
        }
        if (this->Aborted)
        {
          return;
        }
        target.Candidates.back().Error = this->errorOf(target, l, heldOut, solution);
      }
    }
  }

  /// More fairing on the level that predicts best, or, where that does not help, on the next one,
  /// which resolves more.
  void trySmoothing(Target<Dim>& target)
  {
    const auto byError = [](const auto& a, const auto& b) { return a.Error < b.Error; };
    const std::size_t best = static_cast<std::size_t>(
      std::min_element(target.Candidates.begin(), target.Candidates.end(), byError) -
      target.Candidates.begin());
    const std::size_t finest = this->Bricks.size() - 1;
    if (best > 0 && best == finest &&
      target.Candidates[best].Error < FallOfDetail * target.Candidates[best - 1].Error)
    {
      return;
    }
    if (!this->smoothOn(target, best) && best < finest && !this->Aborted)
    {
      this->smoothOn(target, best + 1);
    }
  }

  /// Whether more fairing on a level predicts better.
  bool smoothOn(Target<Dim>& target, std::size_t l)
  {
    LevelRows<Dim> rows = this->rowsOf(this->Training, l);
    const HermiteRows<Dim> heldOut = this->heldOutRows(l);
    std::size_t before = l;
    for (int step = 0; step < MostThinPlateSteps; ++step)
    {
      const float thinPlate = ThinPlateStep * target.Candidates[before].ThinPlate;
      std::vector<BrickValues> solution;
      for (std::size_t c = 0; c < target.Components.size() && !this->Aborted; ++c)
      {
        this->Bricks[l].coefficients() = target.Candidates[before].Solution[c];
        this->setValues(this->Training, target.Rest[c], rows);
        solution.push_back(this->solve(l, rows, thinPlate, SmoothingIterations));
      }
      if (this->Aborted)
      {
        return false;
      }
      const double error = this->errorOf(target, l, heldOut, solution);
      const bool gains = error < target.Candidates[before].Error;
      target.Candidates.push_back({ l, thinPlate, error, std::move(solution) });
      if (!gains)
      {
        break;
      }
      before = target.Candidates.size() - 1;
    }
    return before != l;
  }

  /// The smoothest candidate within the slack; it takes the place of its level, as the last one.
  void choose(Target<Dim>& target)
  {
    double best = std::numeric_limits<double>::max();
    for (const auto& candidate : target.Candidates)
    {
      best = std::min(best, candidate.Error);
    }
    auto chosen = target.Candidates.end();
    for (auto candidate = target.Candidates.begin(); candidate != target.Candidates.end();
         ++candidate)
    {
      const auto smoothness = [](const auto& c) { return std::pair(c->OnLevel, -c->ThinPlate); };
      if (candidate->Error <= PredictionSlack * best &&
        (chosen == target.Candidates.end() || smoothness(candidate) < smoothness(chosen)))
      {
        chosen = candidate;
      }
    }
    target.Report.Level = static_cast<int>(chosen->OnLevel);
    target.Report.ThinPlate = chosen->ThinPlate;
    target.Report.PredictionError = target.Scale * chosen->Error;
    const std::size_t level = chosen->OnLevel;
    std::swap(target.Candidates[level], *chosen);
    target.Candidates.resize(level + 1);
  }

  /// The fit to all points on a level, of the arrays that it is the last of.
  void solveChosen(std::size_t l)
  {
    LevelRows<Dim> rows;
    for (Target<Dim>& target : this->Targets)
    {
      if (!target.isSpline() || static_cast<std::size_t>(target.Report.Level) != l)
      {
        continue;
      }
      if (rows.Begin.empty())
      {
        rows = this->rowsOf(this->All, l);
      }
      auto& chosen = target.Candidates.back();
      for (std::size_t c = 0; c < target.Components.size() && !this->Aborted; ++c)
      {
        this->Bricks[l].coefficients() = chosen.Solution[c];
        this->setValues(this->All, target.Rest[c], rows);
        chosen.Solution[c] = this->solve(l, rows, chosen.ThinPlate, FinalIterations);
      }
    }
  }

  void countWork()
  {
    double components = 0, bricks = 0;
    for (const Target<Dim>& target : this->Targets)
    {
      components += target.isSpline() ? static_cast<double>(target.Components.size()) : 0.0;
    }
    for (const BrickLattice<Dim>& level : this->Bricks)
    {
      bricks += static_cast<double>(level.numberOfActiveBricks());
    }
    this->Work = std::max(1.0, (this->HeldOut.empty() ? 1 : 2) * components * bricks);
  }

  int Threads;
  const ProgressCallback& Progress;
  double Work = 1, WorkDone = 0; ///< in bricks that are solved for
  bool Aborted = false;
  std::vector<Target<Dim>> Targets;
  Dataset<Dim> All, Training;
  Samples<Dim> HeldOut;
  std::vector<std::int64_t> HeldOutSource;
  std::vector<BrickLattice<Dim>> Bricks;
};
}

template <int Dim>
AttributeResult<Dim> fitAttributes(const Lattice<Dim>& lattice, AttributeInput<Dim> input,
  int threads, const ProgressCallback& progress)
{
  return AttributeFitter<Dim>(lattice, input, resolveThreads(threads), progress).run();
}

template AttributeResult<2> fitAttributes<2>(
  const Lattice<2>&, AttributeInput<2>, int, const ProgressCallback&);
template AttributeResult<3> fitAttributes<3>(
  const Lattice<3>&, AttributeInput<3>, int, const ProgressCallback&);
}
