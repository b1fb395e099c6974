// The verifier: measures the motion of a program against the exact surface [verification]. It includes only
// tool, limits, toolpath and core.
//
// Gouge at p is R - distance(p, all moves swept upward). Leftover at a reachable p is
// distance(p, feed moves) - R. R is the ball's radius plus the stock to leave. Both maxima are values at true
// surface points, and no point exceeds them by more than `certainty`. The error of arcs' chords is added. For
// [verification P1] and for the rapids' distance from the stock the control's own smoothing (G64 P + Q) is
// added, too. Each point has its own reachability; along the border of the reachable set it is tested at
// points 0.5 to 2.5 % of R apart.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <absl/status/statusor.h>

#include "cam/limits/containment.h"
#include "cam/limits/stock_depth.h"
#include "cam/limits/stock_solid.h"
#include "cam/limits/surface_mask.h"
#include "cam/tool/tool.h"
#include "cam/toolpath/machine.h"
#include "cam/toolpath/toolpath.h"
#include "core/base/diagnostic.h"
#include "core/base/enum_array.h"
#include "core/base/run_context.h"
#include "core/surface/surface.h"

namespace patchmill {

enum class ForcedStrategy { kNone, kContour, kZigzag };

// The requested finish.
struct Finish {
  std::optional<double> scallop;  // mm; if absent, leftover is measured but not judged
  // Places that this forced strategy cannot finish are excused with the reason STRATEGY.
  ForcedStrategy strategy = ForcedStrategy::kNone;
  double zigzag_angle = 0.0;  // rad, for kZigzag
};

// The requested finish of a part of the surface.
struct FinishPart {
  Finish finish;
  std::shared_ptr<const SurfaceMask> where;  // null: the whole surface
};

struct VerifyParams {
  Finish finish;
  double tolerance = 0.01;           // mm, [verification P1, P2]
  double leave = 0.0;                // mm, stock to leave; the program is judged against the offset surface
  double certainty = 1e-3;           // mm; how exactly maxima are known
  double floor_z = -kInfinity;       // mm, lowest tip, placed frame
  Vec3 program_zero = Vec3::Zero();  // point of the placed frame that is X0 Y0 Z0
  double stock_top_z = 0.0;          // mm, placed frame; highest material
  StockDepth allowance;              // stock allowance along the normal; rapids keep clear of it
  // The stock beside and over the part; null: none but the allowance.
  std::shared_ptr<const StockSolid> stock = nullptr;
  StockDepth depth_limit;  // feeds may cut so deep into the stock
  // Steep descents may run at any feed: what they cut is no deeper than the allowance, or CUT_TOO_DEEP.
  bool keep_feed = false;
  std::optional<Machine> machine = std::nullopt;
  // Parts with a finish of their own. Places in none of them are not to be finished. If empty, the whole
  // surface has the finish above.
  std::vector<FinishPart> parts;
  double min_step_fraction = 0.25;  // of the centre step on a plane: smallest step of a forced strategy
  bool sample_leftover = false;     // fill VerifyReport::leftover_map
  Containment containment;          // placed frame; what is to be finished, and where nothing may move
};

struct VerifyPlace {
  Vec3 point = Vec3::Zero();  // on the surface, placed frame
  int patch_index = -1;
  std::string patch_id, face_id;
  int line = 0;  // program line of the move that caused it, or of the nearest move
};

// What the feed moves leave at one place. The corners of its cell, about a hundredth of the part wide, are
// given in the order of the cell's border.
struct LeftoverPlace {
  Vec3 point = Vec3::Zero();  // on the surface, placed frame
  std::array<Vec3, 4> corners = {};
  int patch_index = -1;
  std::optional<double> leftover;  // mm, below 0 where the ball goes deeper; absent where it does not reach
};

// Upper edges of all leftover classes but the last, in scallops of the part that a place lies in.
inline constexpr std::array kLeftoverEdges = {0.25, 0.5, 0.75, 1.0};
inline constexpr std::size_t kLeftoverClasses = kLeftoverEdges.size() + 1;

// Why material stays uncut at a place.
enum class UncutReason { kUndercut, kConcave, kFloor, kAvoided, kStrategy, kShank, kHolder, kOutside };
constexpr UncutReason LastOf(UncutReason) { return UncutReason::kOutside; }

struct VerifyReport {
  bool gouge_ok = false, finish_ok = false, motion_ok = false;  // [verification P1, P2, P3]
  std::optional<bool> holder_ok;  // whether the holder keeps off everything; absent if none is given
  double max_gouge = 0.0;         // mm
  VerifyPlace max_gouge_at;
  double max_leftover = 0.0;  // mm, at reachable points
  VerifyPlace max_leftover_at;
  double reachable_area = 0.0, total_area = 0.0;  // mm^2
  // mm^2, not reached, where the outer side of a closed body looks down: neither unreachable nor in the
  // total.
  double underside_area = 0.0;
  // The reachable area in squares whose side is the flat step-over of its scallop; absent without a scallop.
  std::optional<double> reachable_squares;
  EnumArray<UncutReason, double> unreachable_area{};  // mm^2
  // mm^2: the reachable and the unreachable area as seen along Z. Upright walls count nothing.
  double reachable_plan_area = 0.0;
  EnumArray<UncutReason, double> unreachable_plan_area{};
  EnumArray<UncutReason, double> deepest_unreachable{};  // mm, deepest leftover
  EnumArray<UncutReason, VerifyPlace> deepest_unreachable_at;
  // The floor with which (almost) nothing would be unreachable for FLOOR: lowest tip, placed frame, mm. It is
  // found to about 0.001 mm and rounded down to 0.001. Absent if nothing is unreachable for FLOOR.
  std::optional<double> finishing_floor_z;
  // The flute length with which a shank of the same width would block (almost) nothing, mm: the largest need
  // that was found, plus half the tolerance. It is found to about 0.001 mm and rounded up to 0.001. Absent if
  // the shank blocks nothing.
  std::optional<double> finishing_flute_length;
  // The stick-out with which the same holder would block (almost) nothing, mm, found and rounded in the same
  // way. Absent if the holder blocks nothing.
  std::optional<double> finishing_stickout;
  // Reachable area with a scallop by leftover class, mm^2, good to 1 % of their sum. Passes as far apart as
  // the scallop allows leave 50, 71 and 87 % of the area below the first three edges (the roots of the
  // edges). More area there means that passes are closer together than needed.
  std::array<double, kLeftoverClasses> leftover_area{};
  double leftover_above_limit_area = 0.0;       // mm^2, reachable with more than scallop + tolerance left
  std::vector<LeftoverPlace> leftover_map;      // if VerifyParams::sample_leftover is set, all over the part
  double required_stickout = 0.0;               // mm, an upper bound (RequiredStickout)
  double steepest_descent = 0.0;                // rad, of feed moves
  double tip_z_min = 0.0;                       // mm, lowest tip, program frame
  Box3 tip_box;                                 // program frame; places of the tip below machine zero
  double cut_length = 0.0, rapid_length = 0.0;  // mm, of moves that do not touch machine zero
  int feed_blocks = 0, arc_blocks = 0;  // lines of the program with such feed moves; the arcs among them
  // Errors: GOUGE, SHANK_GOUGE, LEFTOVER, RAPID_IN_STOCK, RAPID_DOG_LEG, OUTSIDE_BOUNDARY (feeds), ABOVE_TOP
  // (feeds), OBSTACLE_HIT, CUT_TOO_DEEP, BEYOND_TRAVEL, FEED_BEYOND_RANGE, SHANK_IN_STOCK, HOLDER_GOUGE,
  // HOLDER_IN_STOCK, HOLDER_HIT, BESIDE_PART, AVOID_MARGIN (of each of these codes at most 20, of different
  // lines and places, the worst first), CONTROL_SMOOTHING, BELOW_FLOOR, STEEP_DESCENT, UNKNOWN_START,
  // FIRST_MOTION_NOT_UP, LAST_MOTION_NOT_UP, SPINDLE_STOPPED, SPINDLE_LEFT_ON, COOLANT_LEFT_ON.
  // Warnings: what the program leaves to the control's state (ProgramMotion::assumptions), and
  // PLUNGE_FEED_NOT_CHECKED.
  // Info: MORE_FINDINGS if there were more than 20 of a code.
  Diagnostics findings;
  bool ok() const { return gouge_ok && finish_ok && motion_ok; }
  // True if the reachable area has no room for passes side by side: it is smaller than a square of one flat
  // step-over. This does not depend on the program. False without a scallop.
  bool NothingToFinish() const { return reachable_squares && *reachable_squares < 1.0; }
};

// `surface` is in the placed frame. Runs in parallel, with the same result for any number of threads.
// INVALID_ARGUMENT if the tool, a parameter or the motion cannot be judged. CANCELLED and DEADLINE_EXCEEDED
// from `run`. Cost: about 0.3 CPU-seconds per 1000 mm^2 of a part with walls and undercuts at D 6, scallop
// 0.02; several times more for a program that fails in many places.
absl::StatusOr<VerifyReport> Verify(const Surface& surface, const Tool& tool, const ProgramMotion& motion,
                                    const VerifyParams& params, const RunContext& run);

}  // namespace patchmill
