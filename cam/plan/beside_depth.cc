#include "cam/plan/beside_depth.h"

#include <algorithm>
#include <cstddef>
#include <vector>

#include "core/base/status.h"
#include "core/surface/closest.h"

namespace patchmill {
namespace {

constexpr double kBeside = 0.1, kLeastDepth = 0.5, kProof = 0.01;  // of the ball's radius

}  // namespace

absl::StatusOr<std::optional<BesideDepth>> DeepestBeside(const Surface& surface, const Toolpath& toolpath,
                                                         double top_z, const RunContext& run) {
  const double radius = toolpath.ball_radius, below_all = surface.box.min.z() - 1.0;
  std::vector<Vec3> tips;
  for (const Move& move : toolpath.moves) {
    const Vec3 tip = move.to - Vec3(0.0, 0.0, radius);
    if (tip.z() < top_z - kLeastDepth * radius) tips.push_back(tip);
  }
  std::stable_sort(tips.begin(), tips.end(), [](const Vec3& a, const Vec3& b) { return a.z() < b.z(); });
  for (const Vec3& tip : tips) {
    PM_RETURN_IF_ERROR(run.Check());
    // The upward ray from below the part is the whole axis.
    const Vec3 foot = Lift(Xy(tip), below_all);
    if (!AnythingNearUpwardRay(surface, foot, kBeside * radius, kProof * radius))
      return BesideDepth{tip, top_z - tip.z()};
  }
  return std::nullopt;
}

}  // namespace patchmill
