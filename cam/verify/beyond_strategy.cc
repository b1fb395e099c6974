#include "cam/verify/beyond_strategy.h"

#include <algorithm>
#include <cmath>

#include "core/diffgeo/forms.h"

namespace patchmill {
namespace {

// The widest centre step of a ball of radius r that leaves the scallop s on a circle of curvature kappa
// [spacing (2)], mm. It follows from the triangle of the circle's centre, the ball's centre and the crest.
double WidestStep(double r, double s, double kappa) {
  constexpr double kFlat = 1e-4;  // |kappa r| below which the triangle loses digits; a series is exact enough
  const double flat = 2.0 * std::sqrt(s * (2.0 * r - s));
  if (std::abs(kappa * r) < kFlat) return flat * std::sqrt(1.0 - kappa * (r - s));
  const double ball = std::abs(1.0 / kappa - r), crest = std::abs(1.0 / kappa - s);
  const double cosine = (ball * ball + crest * crest - r * r) / (2.0 * ball * crest);
  return 2.0 * std::acos(std::clamp(cosine, -1.0, 1.0)) * ball;
}

// BeyondStrategy for the side with the normal e.
bool BeyondStrategyOn(const SurfaceJet& jet, const Vec3& e, const LeftoverParams& params) {
  constexpr double kMargin = 1.1;  // ratio to the planner's limit, so that borderline places are excused
  const double r = params.reach.radius, s = *params.finish.scallop;
  // Directions along the feed and across it, in the surface.
  const Vec2 d(std::cos(params.finish.zigzag_angle), std::sin(params.finish.zigzag_angle));
  const bool contours = params.finish.strategy == ForcedStrategy::kContour;
  const Vec3 feed = contours ? Vec3(e.y(), -e.x(), 0.0) : Lift(d * e.z(), -d.dot(Xy(e)));
  const double length = feed.norm();
  if (!(length > 1e-12)) return true;  // contours have no step on a horizontal surface
  const Vec3 across = e.cross(feed / length);
  const double kappa = NormalCurvature(Forms(jet, e), jet, across);
  if (!(kappa * r < 1.0)) return true;
  const double seen = contours ? std::abs(across.z()) : std::abs(Cross(d, Xy(across)));
  return seen * WidestStep(r, s, kappa) < kMargin * params.min_step_fraction * WidestStep(r, s, 0.0);
}

}  // namespace

bool BeyondStrategy(const SurfaceJet& jet, const Facing& facing, const LeftoverParams& params) {
  if (params.finish.strategy == ForcedStrategy::kNone || !params.finish.scallop) return false;
  return BeyondStrategyOn(jet, facing.e, params) &&
         (!facing.both || BeyondStrategyOn(jet, -facing.e, params));
}

}  // namespace patchmill
