// The whole motion, as it is posted, drawn and streamed. Positions are those of the ball CENTRE in the placed
// model's frame (mm). The post subtracts the radius (for the tip) and the program zero.
#pragma once

#include <optional>
#include <vector>

#include "cam/toolpath/arc.h"
#include "core/base/diagnostic.h"
#include "core/base/typed_id.h"
#include "core/base/vec.h"

namespace patchmill {

enum class MoveKind { kRapid, kApproach, kPlunge, kLead, kCut, kLink, kRetract };
constexpr MoveKind LastOf(MoveKind) { return MoveKind::kRetract; }

// The place where the ball touches the surface.
struct MoveContact {
  Vec3 p = Vec3::Zero();
  PatchId patch;
};

// A move from `to` of the previous move, straight or along an arc. The first move starts at machine zero,
// above everything.
struct Move {
  MoveKind kind = MoveKind::kRapid;
  Vec3 to = Vec3::Zero();
  double feed = 0.0;            // mm/min; ignored for kRapid
  RegionId region = kNoRegion;  // region of the pass; none between passes
  int pass = -1;                // index of the pass in the linked order; -1 between passes
  std::optional<MoveContact> contact = std::nullopt;  // at `to`
  std::optional<Arc> arc = std::nullopt;              // never of a rapid
};

struct Toolpath {
  std::vector<Move> moves;
  double ball_radius = 0.0;
};

// The meaning of a program text, as read back from it. Positions are those of the TIP in the program frame,
// mm.
struct ProgramMove {
  enum class Kind { kRapid, kFeed };
  Kind kind = Kind::kRapid;
  float spindle_speed = 0.0F;  // 1/min; 0 while the spindle stands still
  Vec3 from = Vec3::Zero();
  Vec3 to = Vec3::Zero();
  double feed = 0.0;        // mm/min
  int line = 0;             // 1-based line of the text
  bool from_above = false;  // starts at machine Z zero ("above everything"); from.z() means +infinity
  bool to_above = false;    // ends at machine Z zero
  bool coolant_on = false;
  // X or Y of `from` was never stated, so the axis may have been anywhere. `from` then holds the place to
  // which the axis is first sent. Or X or Y goes to a place of the machine (G28 X0, G53 X0), which is
  // unknown.
  bool from_anywhere = false;
  double chord_error = 0.0;  // mm, if the move is one chord of an arc
  int tool = -1;             // number of the tool in the spindle; -1 before the first tool change
};

struct ProgramMotion {
  std::vector<ProgramMove> moves;
  // What the program leaves to the state of the control (cam/post/program_assumptions.h), and
  // FEED_IN_UNIT_BEFORE (an F on a line that changes the unit). All are warnings with their program lines.
  Diagnostics assumptions;
  int tool_number = 0;
  bool has_deletable_lines = false;  // some lines start with / (block delete)
  // mm, the largest G64 P + Q in force (Q absent: P); kInfinity for G64 without P or with P0.
  // controller_tolerance holds while feeding, rapid_tolerance over rapids below machine zero.
  double controller_tolerance = 0.0;
  double rapid_tolerance = 0.0;
  bool ends_with_spindle_off = false;
  bool ends_with_coolant_off = false;
  bool first_motion_is_up = false;
  bool last_motion_is_up = false;
};

}  // namespace patchmill
