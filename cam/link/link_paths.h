// Order, leads, links, rapids, feeds: passes -> one safe motion ([machining M1, M2, M6, M7, M11],
// [verification P3]).
#pragma once

#include <vector>

#include <absl/status/statusor.h>

#include "cam/location/limits/operation_limits.h"
#include "cam/location/locator.h"
#include "cam/path/chord/scan_line.h"
#include "cam/region/map/region_map.h"
#include "cam/toolpath/toolpath.h"
#include "core/base/run_context.h"

namespace patchmill {

enum class CutDirection { kClimb, kConventional, kEither };

struct LinkParams {
  double radius = 3.0;       // mm, the ball's own radius (the locator's includes the stock to leave)
  double clearance_z = 0.0;  // mm, TIP height of rapids, above model and stock
  double stock_top_z = 0.0;  // mm
  double allowance = 0.5;    // mm of stock along the normal
  // Rapids between passes as low as they are proven clear of the stock, not at the clearance plane.
  bool low_rapids = false;
  double tool_radius = 0.0;   // mm, the wider one of ball and shank; only low rapids ask
  double shank_lower = 0.0;   // mm, how far below the ball's centre a wide shank begins, the stock to leave
                              // counted in; mostly 0. Only low rapids ask
  double approach_gap = 1.0;  // mm: clear means allowance + gap from the surface
  double feed = 0.0, plunge_feed = 0.0;  // mm/min
  double plunge_angle = Radians(30.0);   // descents steeper than this run at plunge feed
  CutDirection contour_direction = CutDirection::kClimb;
  PassParams pass;               // for links along the centre surface
  double max_link_length = 0.0;  // mm in plan; 0: 6 ball radii. Longer ones retract
  // Feeds stay where it allows them; links keep clear of the stock over ground that is not wanted and above
  // the highest tip, but for a step. Null: anywhere.
  const OperationLimits* operation_limits = nullptr;
};

// mm in plan: the longest link made instead of a retract.
inline double MaxLinkLength(const LinkParams& params) {
  return params.max_link_length > 0.0 ? params.max_link_length : 6.0 * params.radius;
}

struct LinkStats {
  double cut_length = 0.0, link_length = 0.0, rapid_length = 0.0;  // mm
  double time = 0.0;  // s, feeds only; rapids counted at 5000 mm/min
  int retract_count = 0;
  double steepest_descent = 0.0;  // rad, of any feed move
};

// s: of a move that is `length` mm long, at its feed; rapids as in LinkStats.
double EstimatedTime(const Move& move, double length);

struct LinkResult {
  Toolpath toolpath;
  std::vector<CutterPath> passes;  // in the order they are cut, as cut (direction, start point)
  LinkStats stats;
};
absl::StatusOr<LinkResult> LinkPaths(const Locator& locator, const RegionMap& regions,
                                     std::vector<CutterPath> paths, const LinkParams& params,
                                     const RunContext& run);

}  // namespace patchmill
