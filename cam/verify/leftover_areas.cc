#include <algorithm>
#include <cmath>
#include <optional>

#include "cam/verify/leftover.h"
#include "core/base/parallel.h"
#include "core/base/status.h"
#include "core/diffgeo/forms.h"

namespace patchmill {

namespace {

constexpr int kDeepestQuarter = 4;
constexpr double kFarSlack = 0.02;  // how exactly the distance of far unreachable points is known
constexpr double kNear = 2.0;       // of the radius: nearer ones are measured exactly

class AreaSampler {
 public:
  AreaSampler(const Surface& surface, const SegmentTree& tree, const LeftoverParams& params)
      : surface_(surface), tree_(tree), params_(params) {}

  void Add(const CellRect& cell, int depth, AreaReport& sums) {
    // The middle and near the corners: a border that crosses the cell shows. The weights make the area exact
    // for a cubic area element.
    constexpr double kInset = 0.02, kMiddleWeight = 2.0 / 3.0, kCornerWeight = 1.0 / 12.0;
    std::array<std::optional<FinishClass>, 5> kinds;
    std::array<double, 5> areas{};
    for (std::size_t k = 0; k < 5; ++k) {
      const double s = k == 4 ? 0.5 : k / 2 == 0 ? kInset : 1.0 - kInset;
      const double t = k == 4 ? 0.5 : k % 2 == 0 ? kInset : 1.0 - kInset;
      const SurfaceJet jet = Evaluate(surface_, cell.piece, cell.u0 + s * (cell.u1 - cell.u0),
                                      cell.v0 + t * (cell.v1 - cell.v0));
      areas[k] = (cell.u1 - cell.u0) * (cell.v1 - cell.v0) * (k == 4 ? kMiddleWeight : kCornerWeight) *
                 jet.du.cross(jet.dv).norm();
      kinds[k] = Classify(jet, cell.piece, sums);
    }
    const auto other = [&](const std::optional<FinishClass>& c) { return c && kinds[4] && *c != *kinds[4]; };
    if (depth < kDeepestQuarter && std::any_of(kinds.begin(), kinds.end(), other)) {
      for (int k = 0; k < 4; ++k) {
        CellRect part = cell;
        (k / 2 == 0 ? part.u1 : part.u0) = cell.u();
        (k % 2 == 0 ? part.v1 : part.v0) = cell.v();
        Add(part, depth + 1, sums);
      }
      return;
    }
    for (std::size_t k = 0; k < 5; ++k) {
      if (kinds[k]) sums.area[static_cast<std::size_t>(*kinds[k])] += areas[k];
    }
  }

 private:
  // nullopt where the surface has no normal: of no area.
  std::optional<FinishClass> Classify(const SurfaceJet& jet, PieceId piece, AreaReport& sums) {
    const auto facing = FacingAt(jet);
    if (!facing) return std::nullopt;
    FinishClass kind = FinishClass::kDone;
    switch (Reach(surface_, jet.p, *facing, params_.reach)) {
      case ReachClass::kReachable:
        break;
      case ReachClass::kUndercut:
        kind = FinishClass::kUndercut;
        break;
      case ReachClass::kConcave:
        kind = FinishClass::kConcave;
        break;
      case ReachClass::kFloor:
        kind = FinishClass::kFloor;
        break;
    }
    const double slack = kind == FinishClass::kDone ? 0.0 : kFarSlack;
    auto nearest = tree_.FindNearest(jet.p, kInfinity, hint_, slack);
    if (slack > 0.0 && nearest.distance < kNear * params_.reach.radius) {
      nearest = tree_.FindNearest(jet.p, kInfinity, nearest.segment);
    }
    hint_ = nearest.segment;
    const double left = std::min(params_.most, nearest.distance + params_.chord_error - params_.reach.radius);
    if (kind == FinishClass::kDone && left > params_.limit) {
      kind = BeyondStrategy(jet, facing->e, params_) ? FinishClass::kStrategy : FinishClass::kAboveLimit;
    }
    Extreme& deepest = sums.deepest[static_cast<std::size_t>(kind)];
    if (left > deepest.value) {
      deepest = {left, jet.p, piece, nearest.segment < 0 ? -1 : tree_.segment(nearest.segment).move};
    }
    return kind;
  }

  const Surface& surface_;
  const SegmentTree& tree_;
  const LeftoverParams& params_;
  int hint_ = -1;
};

}  // namespace

bool BeyondStrategy(const SurfaceJet& jet, const Vec3& e, const LeftoverParams& params) {
  if (params.strategy == ForcedStrategy::kNone || !params.scallop) return false;
  constexpr double kMargin = 1.1;
  const double r = params.reach.radius, s = *params.scallop;
  // Along the feed, and across it in the surface.
  Vec3 feed;
  if (params.strategy == ForcedStrategy::kContour) {
    feed = Vec3(e.y(), -e.x(), 0.0);
  } else {
    const Vec2 d(std::cos(params.zigzag_angle), std::sin(params.zigzag_angle));
    feed = Lift(d * e.z(), -d.dot(Plan(e)));
  }
  const double length = feed.norm();
  if (!(length > 1e-12)) return true;  // level ground for contours: no step at all
  const Vec3 across = e.cross(feed / length);
  const double kappa = NormalCurvature(Forms(jet, e), jet, across);
  const double bend = 1.0 - kappa * r;
  if (!(bend > 0.0)) return true;
  const double step = std::sqrt(8.0 * r * s * bend);
  const double flat = 2.0 * std::sqrt(s * (2.0 * r - s));
  const double share =
      params.strategy == ForcedStrategy::kContour
          ? std::abs(across.z())
          : std::abs(Cross(Vec2(std::cos(params.zigzag_angle), std::sin(params.zigzag_angle)), Plan(across)));
  return step * share < kMargin * params.min_step_fraction * flat;
}

absl::StatusOr<AreaReport> MeasureAreas(const Surface& surface, const std::vector<CellRect>& roots,
                                        const SegmentTree& tree, const LeftoverParams& params,
                                        const RunContext& run) {
  constexpr std::size_t kChunk = 32;
  const std::size_t chunks = (roots.size() + kChunk - 1) / kChunk;
  std::vector<AreaReport> parts(chunks);
  PM_RETURN_IF_ERROR(ParallelFor(run, "verify: reach", chunks, [&](std::size_t chunk) {
    AreaSampler sampler(surface, tree, params);
    const std::size_t end = std::min(roots.size(), (chunk + 1) * kChunk);
    for (std::size_t i = chunk * kChunk; i < end && !run.Cancelled(); ++i) {
      sampler.Add(roots[i], 0, parts[chunk]);
    }
  }));
  AreaReport sums;
  for (const AreaReport& part : parts) {
    for (std::size_t k = 0; k < kFinishClasses; ++k) {
      sums.area[k] += part.area[k];
      if (part.deepest[k].value > sums.deepest[k].value) sums.deepest[k] = part.deepest[k];
    }
  }
  return sums;
}

}  // namespace patchmill
