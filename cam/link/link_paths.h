// Joins passes to one safe motion: order, leads, links, rapids and feeds ([machining M1, M2, M6, M7, M11],
// [verification P3]).
#pragma once

#include <optional>
#include <vector>

#include <absl/status/statusor.h>

#include "cam/limits/stock_depth.h"
#include "cam/limits/stock_solid.h"
#include "cam/limits/upper_cylinders.h"
#include "cam/link/lead_shapes.h"
#include "cam/location/limits/operation_limits.h"
#include "cam/location/locator.h"
#include "cam/path/chord/scan_line.h"
#include "cam/region/map/region_map.h"
#include "cam/toolpath/toolpath.h"
#include "core/base/run_context.h"

namespace patchmill {

enum class CutDirection { kClimb, kConventional, kEither };

inline constexpr double kDefaultPlungeAngle = Radians(30.0);

struct LinkParams {
  double radius = 3.0;       // mm, radius of the ball itself (the locator's includes the stock to leave)
  double clearance_z = 0.0;  // mm, TIP height of rapids, above model and stock
  double stock_top_z = 0.0;  // mm
  StockDepth allowance;      // stock allowance along the normal
  // If true, the stock is known: rapids between passes run as low as they are proven clear of it, and links
  // at feed close to it may take their place. Else rapids run at the clearance plane.
  bool low_rapids = false;
  double tool_radius = 0.0;  // mm, larger radius of ball and shank; for low rapids only
  double shank_lower = 0.0;  // mm, how far below the ball's centre a wide shank begins, including the stock
                             // to leave; mostly 0. For low rapids only
  std::vector<UpperCylinder> holder = {};  // its cylinders, from the lowest on; for low rapids only
  double approach_gap = 1.0;               // mm; clear of the stock means allowance + gap from the surface
  double feed = 0.0, plunge_feed = 0.0;    // mm/min
  std::optional<double> link_feed, lead_feed;  // mm/min; default `feed`
  double plunge_angle = kDefaultPlungeAngle;   // steeper descents run at plunge feed
  bool keep_feed = false;                      // passes run at `feed` there, too
  CutDirection contour_direction = CutDirection::kClimb;
  LeadParams lead;
  double retract_time = 4.0;     // s that a retract costs beside its moves: it marks the surface, axes stop
  PassParams pass;               // for links along the centre surface
  double max_link_length = 0.0;  // mm; 0 means 6 ball radii. The tool retracts instead of a longer link
  // Feed moves stay where these limits allow them. Links keep clear of the stock where the surface is not to
  // be finished or the tip is too high; they may overrun the border of such places by about a step. null
  // allows everything.
  const OperationLimits* operation_limits = nullptr;
  // The stock beside and over the part; null: none but the allowance over the surface. Rapids and links above
  // it are clear of it by the approach gap. Leads and stay-down links cut into it no deeper than depth_limit.
  const StockSolid* stock = nullptr;
  StockDepth depth_limit;
};

// The longest stay-down link that is made instead of a retract, mm.
inline double MaxLinkLength(const LinkParams& params) {
  return params.max_link_length > 0.0 ? params.max_link_length : 6.0 * params.radius;
}

struct LinkStats {
  double cut_length = 0.0, link_length = 0.0, rapid_length = 0.0;  // mm
  double time = 0.0;                 // s, at the programmed feeds; rapids count at 5000 mm/min
  int retract_count = 0;             // rapids that follow on a feed move
  double steepest_descent = 0.0;     // rad, of any feed move
  double saved_by_low_rapids = 0.0;  // mm of rapids that low rapids would save
  double corner_length = 0.0;        // mm of passes that WithCornerFeeds made slower
};

struct LinkResult {
  Toolpath toolpath;
  std::vector<CutterPath> passes;  // in the order, direction and with the start points of the cut
  std::vector<LeadFigure> leads;   // in the order of the motion
  LinkStats stats;
};
absl::StatusOr<LinkResult> LinkPaths(const Locator& locator, const RegionMap& regions,
                                     std::vector<CutterPath> paths, const LinkParams& params,
                                     const RunContext& run);

}  // namespace patchmill
