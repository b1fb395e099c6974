#include "cam/path/forced_steps.h"

#include <algorithm>
#include <cmath>

#include "cam/path/across_feed.h"
#include "cam/path/spacing.h"
#include "core/diffgeo/forms.h"

namespace patchmill {

double NeededStep(const ForcedSteps& forced, const SurfaceJet& jet, const Vec3& e, double radius,
                  double scallop) {
  if (forced.passes == ForcedPasses::kNone) return 1.0;
  const bool levels = forced.passes == ForcedPasses::kContours;
  const auto across = levels ? AcrossContours(e) : AcrossLines(e, forced.angle);
  if (!across) return 0.0;
  const Vec2 line(std::cos(forced.angle), std::sin(forced.angle));
  const double seen = levels ? std::abs(across->z()) : std::abs(Cross(line, Plan(*across)));
  const double kappa = NormalCurvature(Forms(jet, e), jet, *across);
  return seen * CenterStep(radius, scallop, kappa) / CenterStep(radius, scallop, 0.0);
}

bool NeedsShorterSteps(const ForcedSteps& forced, const Surface& surface, const SurfaceRect& rect,
                       double radius, double scallop, double fraction) {
  if (forced.passes == ForcedPasses::kNone) return false;
  std::array<Vec3, 9> step;
  double most = 0.0;
  const auto uv = NineParameters(rect);
  for (std::size_t k = 0; k < 9; ++k) {
    const SurfaceJet jet = Evaluate(surface, rect.piece, uv[k].x(), uv[k].y());
    const auto e = UpwardNormal(jet);
    if (!e) return false;
    step[k] = Vec3(NeededStep(forced, jet, *e, radius, scallop), 0.0, 0.0);
    most = std::max(most, step[k].x());
  }
  return most + BendOver(step) < fraction;
}

}  // namespace patchmill
