#include "core/trim/edge_fit.h"

#include <algorithm>
#include <cstddef>
#include <utility>

namespace patchmill {
namespace {

constexpr int kMaxHalvings = 14;
constexpr double kSameBreak = 1e-10;  // of the range of the parameter

// What stays the same while parts of one edge are halved.
struct EdgeFitter {
  const SpannedCurve& curve;
  const std::vector<EdgeSide>& sides;
  const double tolerance;
  const RunContext& run;

  void Fit(double from, double to, int halvings, std::vector<std::vector<FittedGraph>>& graphs) const {
    std::vector<FittedGraph> fits;
    double error = 0.0, allowed = 0.5 * tolerance;
    for (const EdgeSide& side : sides) {
      allowed = std::max(allowed, 0.5 * side.trace->gap);
      fits.push_back(FitGraph(*side.grid, curve, *side.trace, from, to));
      error = std::max(error, fits.back().error);
    }
    if (error > allowed && halvings < kMaxHalvings && !run.Cancelled()) {
      const double middle = 0.5 * (from + to);
      Fit(from, middle, halvings + 1, graphs);
      Fit(middle, to, halvings + 1, graphs);
      return;
    }
    for (std::size_t k = 0; k < fits.size(); ++k) graphs[k].push_back(std::move(fits[k]));
  }
};

}  // namespace

std::vector<std::vector<FittedGraph>> FitEdge(const SpannedCurve& curve, const std::vector<EdgeSide>& sides,
                                              std::vector<double> breaks, double tolerance,
                                              const RunContext& run) {
  std::vector<std::vector<FittedGraph>> graphs(sides.size());
  if (sides.empty()) return graphs;
  const double first = curve.first(), last = curve.last(), same = kSameBreak * (last - first);
  std::sort(breaks.begin(), breaks.end());
  const EdgeFitter fitter{curve, sides, tolerance, run};
  double from = first;
  for (const double to : breaks) {
    if (to <= from + same || to >= last - same) continue;
    fitter.Fit(from, to, 0, graphs);
    from = to;
  }
  fitter.Fit(from, last, 0, graphs);
  return graphs;
}

std::vector<double> SharpKnots(const BrepCurve& curve) {
  std::vector<double> sharp;
  const auto p = static_cast<std::size_t>(curve.degree);
  const double first = curve.knots[p], last = curve.knots[curve.knots.size() - 1 - p];
  for (std::size_t k = p + 1; k + p + 1 < curve.knots.size();) {
    std::size_t end = k;
    while (end < curve.knots.size() && curve.knots[end] == curve.knots[k]) ++end;
    if (end - k + 1 >= p && curve.knots[k] > first && curve.knots[k] < last) sharp.push_back(curve.knots[k]);
    k = end;
  }
  return sharp;
}

}  // namespace patchmill
