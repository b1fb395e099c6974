#include "cam/path/reach/forced_steps.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "cam/path/stepover/across_feed.h"
#include "cam/path/stepover/step_over.h"
#include "core/diffgeo/forms.h"

namespace patchmill {

namespace {

struct AcrossPasses {
  double seen = 0.0;   // share of a step on the centre surface that the spacing of the passes sees
  double kappa = 0.0;  // 1/mm, across the feed
};

std::optional<AcrossPasses> Across(const ForcedSteps& forced, const SurfaceJet& jet, const Vec3& e) {
  const bool levels = forced.passes == ForcedPasses::kContours;
  const auto across = levels ? AcrossContours(e) : AcrossLines(e, forced.angle);
  if (!across) return std::nullopt;
  const Vec2 line(std::cos(forced.angle), std::sin(forced.angle));
  const double seen = levels ? std::abs(across->z()) : std::abs(Cross(line, Xy(*across)));
  return AcrossPasses{seen, NormalCurvature(Forms(jet, e), jet, *across)};
}

}  // namespace

double NeededStep(const ForcedSteps& forced, const SurfaceJet& jet, const Vec3& e, const BallFinish& ball) {
  const auto& [radius, scallop] = ball;
  if (forced.passes == ForcedPasses::kNone) return 1.0;
  const auto across = Across(forced, jet, e);
  if (!across) return 0.0;
  return across->seen * CenterStep(radius, scallop, across->kappa) / CenterStep(radius, scallop, 0.0);
}

double NeededFineStep(const ForcedSteps& forced, const SurfaceJet& jet, const Vec3& e, double radius) {
  if (forced.passes == ForcedPasses::kNone) return 1.0;
  const auto needed = [&](const Vec3& side) {
    const auto across = Across(forced, jet, side);
    return across ? across->seen * std::sqrt(std::max(0.0, 1.0 - across->kappa * radius)) : 0.0;
  };
  return HasTwoSides(jet, e) ? std::max(needed(e), needed(-e)) : needed(e);
}

double LeftByStep(const ForcedSteps& forced, const SurfaceJet& jet, const Vec3& e, const BallFinish& ball,
                  double fraction) {
  const double radius = ball.radius, scallop = ball.scallop;
  if (forced.passes == ForcedPasses::kNone) return scallop;
  const auto left = [&](const Vec3& side) {
    const auto across = Across(forced, jet, side);
    if (!across || !(across->seen > 0.0)) return kInfinity;
    const double step = fraction * CenterStep(radius, scallop, 0.0) / across->seen;
    return std::max(scallop, ScallopOfStep(radius, step, across->kappa));
  };
  return HasTwoSides(jet, e) ? std::min(left(e), left(-e)) : left(e);
}

bool NeedsShorterSteps(const ForcedSteps& forced, const Surface& surface, const SurfaceRect& rect,
                       const BallFinish& ball, double fraction) {
  if (forced.passes == ForcedPasses::kNone) return false;
  std::array<SurfaceJet, 9> jets;
  std::array<Vec3, 9> normals, step;
  const auto uv = NineParameters(rect);
  for (std::size_t k = 0; k < 9; ++k) {
    jets[k] = Evaluate(surface, rect.piece, uv[k].x(), uv[k].y());
    const auto normal = UnitNormal(jets[k]);
    if (!normal) return false;
    normals[k] = *normal;
  }
  const double turn = BendOver(normals);
  for (const double sign : {1.0, -1.0}) {
    double highest_normal = -1.0, most = 0.0;
    for (std::size_t k = 0; k < 9; ++k) {
      const Vec3 n = sign * normals[k];
      highest_normal = std::max(highest_normal, n.z());
      step[k] = Vec3(NeededStep(forced, jets[k], n, ball), 0.0, 0.0);
      most = std::max(most, step[k].x());
    }
    if (jets.back().sides.RulesOut(sign, highest_normal + turn)) continue;
    if (most + BendOver(step) >= fraction) return false;
  }
  return true;
}

double NeededStepOfSides(const ForcedSteps& forced, const SurfaceJet& jet, const Vec3& e,
                         const BallFinish& ball) {
  const double step = NeededStep(forced, jet, e, ball);
  return HasTwoSides(jet, e) ? std::max(step, NeededStep(forced, jet, -e, ball)) : step;
}

}  // namespace patchmill
