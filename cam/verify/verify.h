// The independent judge ([verification]): program motion against the exact surface. Sees tool,
// toolpath and core only.
//
// Gouge at p: R - dist(p, all moves swept upward); leftover at a reachable p: dist(p, feed moves) - R; R is
// the ball's radius plus the stock to leave. Both maxima are values at true surface points, and no point has
// more than `certainty` above them. Chords of arcs count with their error. [verification P1] and the rapids'
// distance from the stock add the control's own smoothing (G64 P + Q). A point is reachable or not by its own
// ball; along the border of the reachable set this is asked at points 0.5 to 2.5 % of R apart.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <absl/status/statusor.h>

#include "cam/limits/containment.h"
#include "cam/limits/surface_mask.h"
#include "cam/tool/tool.h"
#include "cam/toolpath/toolpath.h"
#include "core/base/diagnostic.h"
#include "core/base/run_context.h"
#include "core/surface/surface.h"

namespace patchmill {

enum class ForcedStrategy { kNone, kContour, kZigzag };

// What is asked for of the finish.
struct Finish {
  std::optional<double> scallop;  // mm; absent: leftover is measured, not judged
  // Excuses (reason STRATEGY) what a forced strategy cannot finish.
  ForcedStrategy strategy = ForcedStrategy::kNone;
  double zigzag_angle = 0.0;  // rad, for kZigzag
};

// The same for a part of the surface.
struct FinishPart : Finish {
  std::shared_ptr<const SurfaceMask> where;  // null: all of it
};

struct VerifyParams : Finish {
  double tolerance = 0.01;           // mm, [verification P1, P2]
  double leave = 0.0;                // mm: judged against the offset surface
  double certainty = 1e-3;           // mm: how exactly maxima are known
  double floor_z = -kInfinity;       // mm, tip, placed frame
  Vec3 program_zero = Vec3::Zero();  // placed point that is X0 Y0 Z0
  double stock_top_z = 0.0;          // mm, placed frame: highest material
  double allowance = 0.5;            // mm, stock along the normal, for the rapid check
  // Parts with a finish of their own; what lies in none of them is not to be finished. Empty: one, all of it,
  // with the finish above.
  std::vector<FinishPart> parts;
  double min_step_fraction = 0.25;
  Containment containment;  // placed frame: what is judged for finish, and where nothing may move
};

struct VerifyPlace {
  Vec3 point = Vec3::Zero();  // on the surface, placed frame
  int patch_index = -1;
  std::string patch_id;
  int line = 0;  // of the program: the move that did it, or the nearest one
};

// Upper edges of all leftover classes but the last, in scallops of the ground they are on.
inline constexpr std::array kLeftoverEdges = {0.25, 0.5, 0.75, 1.0};
inline constexpr std::size_t kLeftoverClasses = kLeftoverEdges.size() + 1;

// Index: UnreachableReason order UNDERCUT, CONCAVE, FLOOR, AVOIDED, STRATEGY, then SHANK, OUTSIDE.
struct VerifyReport {
  bool gouge_ok = false, finish_ok = false, motion_ok = false;  // [verification P1, P2, P3]
  double max_gouge = 0.0;
  VerifyPlace max_gouge_at;
  double max_leftover = 0.0;  // at reachable points
  VerifyPlace max_leftover_at;
  double reachable_area = 0.0, total_area = 0.0;  // mm^2
  // The reachable area in squares of the step over a plane that its scallop allows; absent without a scallop.
  std::optional<double> reachable_squares;
  std::array<double, 7> unreachable_area{};     // mm^2 by reason
  std::array<double, 7> deepest_unreachable{};  // mm of leftover by reason
  std::array<VerifyPlace, 7> deepest_unreachable_at;
  // Lowest tip that a place unreachable for FLOOR needs, placed frame, to about 0.001 mm and rounded down to
  // it: with this floor (almost) nothing is left for that reason. Absent: nothing is.
  std::optional<double> finishing_floor_z;
  // Length of flutes with which a shank as wide keeps the ball from (almost) nothing, mm: half of the
  // tolerance more than what was found to need most, to about 0.001 and rounded up to it. Absent: it keeps it
  // from nothing now.
  std::optional<double> finishing_flute_length;
  // mm^2 of reachable ground with a scallop, by leftover: good to 1 % of their sum. Passes as wide apart as a
  // scallop allows leave the roots of the edges, 50, 71 and 87 % of the ground below each; more there is
  // waste.
  std::array<double, kLeftoverClasses> leftover_area{};
  double leftover_above_limit_area = 0.0;  // mm^2, reachable and above scallop + tolerance
  double required_stickout = 0.0;          // mm: highest material near the tool minus the tip, from above
  double steepest_descent = 0.0;           // rad, of feed moves
  double tip_z_min = 0.0;
  Box3 tip_box;  // program frame, all moves that are not "above everything"
  double cut_length = 0.0, rapid_length = 0.0;
  // GOUGE, SHANK_GOUGE, LEFTOVER, RAPID_IN_STOCK, RAPID_DOG_LEG (each at most 20, of different lines and
  // places, the worst first), CONTROL_SMOOTHING, BELOW_FLOOR, STEEP_DESCENT, UNKNOWN_START,
  // FIRST_MOTION_NOT_UP, LAST_MOTION_NOT_UP, SPINDLE_STOPPED, SPINDLE_LEFT_ON, COOLANT_LEFT_ON,
  // OUTSIDE_BOUNDARY (feeds), ABOVE_TOP (feeds), OBSTACLE_HIT, BESIDE_PART, AVOID_MARGIN (at most 20 each as
  // above): errors. What the program leaves to the control's state (ProgramMotion::assumptions), and
  // PLUNGE_FEED_NOT_CHECKED: warnings.
  // MORE_FINDINGS when a list of 20 was not long enough: info.
  Diagnostics findings;
  bool ok() const { return gouge_ok && finish_ok && motion_ok; }
  // What the ball reaches is no ground for passes side by side: less than one step by one step, or none. Says
  // nothing of the program. False without a scallop.
  bool NothingToFinish() const { return reachable_squares && *reachable_squares < 1.0; }
};

// `surface` is placed. Parallel, the same answer for any number of threads. INVALID_ARGUMENT for a tool, a
// parameter or a motion that cannot be judged. Cost: about 0.3 CPU-seconds per 1000 mm^2 of a part with walls
// and undercuts at D 6, scallop 0.02; a program that fails in many places costs several times more.
absl::StatusOr<VerifyReport> Verify(const Surface& surface, const Tool& tool, const ProgramMotion& motion,
                                    const VerifyParams& params, const RunContext& run);

}  // namespace patchmill
