#include "core/curve/mean_breaks.h"

#include <fmt/format.h>

#include "core/base/index.h"
#include "core/curve/spline.h"

namespace patchmill {
namespace {

// The spline through the ends of the spans of `chain` over `breaks`.
BezierChain Over(const BezierChain& chain, const std::vector<double>& breaks) {
  std::vector<Vec3> points;
  std::vector<double> spans;
  for (int k = 0; k <= chain.spans(); ++k) points.push_back(chain.points[At(k * chain.degree)]);
  for (std::size_t k = 1; k < breaks.size(); ++k) spans.push_back(breaks[k] - breaks[k - 1]);
  // The derivatives at the ends are those of the chain, per share of the end span.
  SplineEnds ends;
  ends.start = Evaluate(chain, 0.0).d * ((chain.breaks[1] - chain.breaks[0]) / spans.front());
  ends.end =
      Evaluate(chain, 1.0).d * ((chain.breaks.back() - chain.breaks[chain.breaks.size() - 2]) / spans.back());
  BezierChain made{3, breaks, {points.front()}};
  for (const HermiteCurve& span : SplineOver(points, spans, ends)) {
    const std::vector<Vec3> bezier = ToBezier(span).points;
    made.points.insert(made.points.end(), bezier.begin() + 1, bezier.end());
  }
  return made;
}

}  // namespace

absl::StatusOr<std::vector<BezierChain>> WithMeanBreaks(const std::vector<BezierChain>& chains) {
  if (chains.empty()) return chains;
  std::vector<double> breaks(chains[0].breaks.size(), 0.0);
  for (std::size_t c = 0; c < chains.size(); ++c) {
    if (chains[c].breaks.size() != breaks.size()) {
      return absl::InvalidArgumentError(
          fmt::format("curve 0 has {} spans, curve {} has {}", chains[0].spans(), c, chains[c].spans()));
    }
    for (std::size_t k = 0; k < breaks.size(); ++k)
      breaks[k] += chains[c].breaks[k] / static_cast<double>(chains.size());
  }
  breaks.back() = 1.0;
  std::vector<BezierChain> made;
  for (const BezierChain& chain : chains) made.push_back(Over(chain, breaks));
  return made;
}

}  // namespace patchmill
