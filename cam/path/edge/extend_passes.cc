#include "cam/path/edge/extend_passes.h"

#include <optional>

#include "cam/path/edge/limits_clip.h"
#include "cam/path/edge/sheet_border.h"
#include "cam/path/stepover/step_over.h"
#include "core/base/parallel.h"
#include "core/base/status.h"
#include "core/surface/closest.h"

namespace patchmill {
namespace {

constexpr int kLooks = 4;  // places looked at along a move

}  // namespace

absl::StatusOr<std::vector<CutterPath>> ExtendPasses(const Locator& locator, std::vector<CutterPath> paths,
                                                     const ExtendParams& params, const RunContext& run) {
  const OperationLimits* operation_limits = params.operation_limits;
  const SheetBorder border(locator.surface());
  const double floor_center = params.pass.floor_z + locator.radius();
  // Passes end a step beyond the selected surface (ClipToLimits). A pass that ends on the border there may
  // run along it.
  const double overrun = kOverrun * CenterStep(locator.radius(), params.pass.scallop, 0.0);
  const auto leaves_unwanted = [&](const Vec3& from, const Vec3& to) {
    if (operation_limits == nullptr || operation_limits->WantsAll()) return true;
    for (int k = 1; k <= kLooks; ++k) {
      const Vec3 at = from + (static_cast<double>(k) / kLooks) * (to - from);
      const auto nearest = ClosestToPoint(locator.surface(), at, kInfinity, 1e-3 * locator.radius());
      if (nearest && !operation_limits->WantsNear(nearest->at, overrun)) return false;
    }
    return true;
  };
  const auto beyond = [&](const CutterPoint& end, const CutterPoint& before) -> std::optional<CutterPoint> {
    const Vec3 way = end.center - before.center;
    if (!end.contact || !border.On(*end.contact) || !(way.norm() > 0.0)) return std::nullopt;
    for (const double part : {1.0, 0.5, 0.25}) {
      const Vec3 to = end.center + part * params.length * way.normalized();
      if (to.z() < floor_center) continue;
      if (operation_limits != nullptr &&
          !(operation_limits->AllowsMove(end.center, to, true) && leaves_unwanted(end.center, to)))
        continue;
      if (locator.GougeWithin(end.center, to, params.pass.chord_tolerance, 0.1 * params.pass.chord_tolerance))
        return CutterPoint{to, std::nullopt, std::nullopt};
    }
    return std::nullopt;
  };
  PM_RETURN_IF_ERROR(ParallelFor(run, nullptr, paths.size(), [&](std::size_t i) {
    std::vector<CutterPoint>& points = paths[i].points;
    // Passes along a border end on it, but do not leave it.
    if (paths[i].closed || paths[i].kind == PassKind::kBorder || points.size() < 2) return;
    const auto first = beyond(points.front(), points[1]);
    const auto last = beyond(points.back(), points[points.size() - 2]);
    if (first) points.insert(points.begin(), *first);
    if (last) points.push_back(*last);
  }));
  return paths;
}

}  // namespace patchmill
