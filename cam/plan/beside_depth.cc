#include "cam/plan/beside_depth.h"

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "core/base/status.h"
#include "core/surface/closest.h"

namespace patchmill {
namespace {

constexpr double kBeside = 0.1, kLeastDepth = 0.5, kProof = 0.01;  // of the ball's radius

}  // namespace

std::vector<Vec3> TipsOf(const Toolpath& toolpath) {
  std::vector<Vec3> tips;
  for (const Move& move : toolpath.moves) tips.push_back(move.to - Vec3(0.0, 0.0, toolpath.ball_radius));
  return tips;
}

std::vector<Vec3> TipsOf(const ProgramMotion& motion, const Vec3& program_zero) {
  std::vector<Vec3> tips;
  for (const ProgramMove& move : motion.moves) {
    if (!move.to_above) tips.push_back(move.to + program_zero);
  }
  return tips;
}

absl::StatusOr<std::optional<BesideDepth>> DeepestBeside(const Surface& surface, std::vector<Vec3> tips,
                                                         double radius, const RunContext& run) {
  const double top_z = surface.box.max.z(), below_all = surface.box.min.z() - 1.0;
  std::erase_if(tips, [&](const Vec3& tip) { return !(tip.z() < top_z - kLeastDepth * radius); });
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

absl::StatusOr<Diagnostics> FindToolBesidePart(const Surface& surface, std::vector<Vec3> tips, double radius,
                                               const Vec3& program_zero, const RunContext& run) {
  Diagnostics found;
  PM_ASSIGN_OR_RETURN(const std::optional<BesideDepth> deepest,
                      DeepestBeside(surface, std::move(tips), radius, run));
  if (!deepest) return found;
  const Vec3 tip = deepest->tip - program_zero;
  found.push_back(MakeWarning(
      "TOOL_BESIDE_PART",
      fmt::format(
          "the tool goes down beside the part to Z{:.4f} at X{:.4f} Y{:.4f}, {:.3f} mm below the part's "
          "top: nothing may stand there",
          tip.z(), tip.x(), tip.y(), deepest->below_top),
      {.point = deepest->tip}));
  return found;
}

}  // namespace patchmill
