// Decides the order of the passes, their directions and their start points.
#pragma once

#include <cstddef>
#include <vector>

#include <absl/status/statusor.h>

#include "cam/link/shorten_order.h"
#include "cam/region/map/region_map.h"
#include "cam/toolpath/cutter_path.h"
#include "core/base/run_context.h"

namespace patchmill {

// Lines whose order keys differ by more than this are no neighbours. Between two neighbours there may be
// lines that lie elsewhere.
inline constexpr int kLineReach = 6;

struct OrderParams {
  double neighbor_distance =
      3.0;               // mm in plan; passes of neighbouring lines that are closer than this belong together
  double at_hand = 0.0;  // mm; contours that begin this near to the tool come first, higher ones before lower
  bool reversible_contours = false;
  TravelTime travel = nullptr;  // estimated time between two passes; if empty, no quicker order is looked for
};

// The contours of a mountain or basin, and the lines of a region, are parts that are cut in one go. Parts are
// cut in the order of OrderParts: from the top down, neighbours together. Then come border, pencil and rest
// passes.
//
// A contour is never cut before the contours of the two levels above it in its group
// (cam/path/contour/level_groups.h) that are near to it in plan. Apart from that, each mountain is cut from
// its top and each basin from its top inwards, down to its end or to where it joins another that is not cut
// yet, before the next one is begun. There are two exceptions: contours at hand, and contours that are on the
// way according to `travel` (ShortenOrder). Open contours that end where others of about their height begin,
// as on the two walls of a slot, belong to the same part as these, in whatever group they are. Zig-zag lines
// run back and forth; every other pass starts at its nearest end. Closed passes start at the vertex nearest
// to the tool.
//
// Deterministic. Cost: O(n^2) in the passes of one part, and in the open contours within one
// neighbor_distance of a height. CANCELLED and DEADLINE_EXCEEDED from `run`.
absl::StatusOr<std::vector<CutterPath>> OrderPasses(const RegionMap& regions, std::vector<CutterPath> paths,
                                                    const OrderParams& params, const RunContext& run);

}  // namespace patchmill
