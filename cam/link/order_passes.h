// In which order, direction and from which start the passes are cut.
#pragma once

#include <cstddef>
#include <vector>

#include <absl/status/statusor.h>

#include "cam/link/shorten_order.h"
#include "cam/region/map/region_map.h"
#include "cam/toolpath/cutter_path.h"
#include "core/base/run_context.h"

namespace patchmill {

// Lines whose numbers differ by more are no neighbours; between two that are may lie some that are needed
// elsewhere.
inline constexpr int kLineReach = 6;

struct OrderParams {
  double neighbor_distance =
      3.0;               // mm in plan: passes of neighbouring lines closer than this belong together
  double at_hand = 0.0;  // mm: contours that begin this near to the tool go before others, the higher first
  bool reversible_contours = false;
  TravelTime travel =
      nullptr;  // about how long the way between two passes takes; none: no search for quicker orders
};

// Contours of a mountain or basin and lines of a region are parts that are cut in one go, in the order of
// OrderParts: from the top down, neighbours together; then borders, creases and rest. A contour is never cut
// before those of the two levels of its ground (cam/path/contour/level_groups.h) above it that it touches in
// plan;
// beyond that each mountain is cut from its top and each basin from its top inwards, down to where they end
// or join others that are not cut yet, before the next is begun, but for those at hand, and for those that
// `travel` shows to be on the way (ShortenOrder); open contours that end where others of about their height
// begin, as on the two walls of a slot, go with these, whatever ground they are on. Zig-zag lines follow each
// other to and fro; everything else goes to the nearest end. Closed passes are turned so that they start
// nearest to where the tool is. Deterministic. Cost O(n^2) in the passes of one part, and
// in open contours within a ball radius of one height. CANCELLED or
// DEADLINE_EXCEEDED when `run` says so.
absl::StatusOr<std::vector<CutterPath>> OrderPasses(const RegionMap& regions, std::vector<CutterPath> paths,
                                                    const OrderParams& params, const RunContext& run);

}  // namespace patchmill
