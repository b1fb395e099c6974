// The moves of a canned drilling cycle: G73, G81, G82, G83 in G17 [rs274ngc].
#pragma once

#include <vector>

#include "cam/toolpath/toolpath.h"
#include "core/base/vec.h"

namespace patchmill {

// One hole. Heights are Z of the tip, mm, program frame.
struct DrillingCycle {
  Vec3 from = Vec3::Zero();
  bool from_above = false;  // `from` is above everything; its Z does not count
  Vec2 hole = Vec2::Zero();
  double retract_z = 0.0;  // R: rapids end and feeds begin here
  double bottom_z = 0.0;   // at most retract_z
  // Height to which the tool rises after the hole: retract_z (G99), or that at which the series of cycles
  // began (G98).
  double end_z = 0.0;
  bool ends_above = false;
};

struct CycleMove {
  ProgramMove::Kind kind = ProgramMove::Kind::kRapid;
  Vec3 to = Vec3::Zero();
  bool to_above = false;
};

// Up to R if the tool is below it, over the hole, down to R, down to the bottom at feed, and up. G73 and G83
// lift the tool between pecks; these moves are left out, because the tool has just been there. Moves of no
// length are left out, too.
std::vector<CycleMove> ExpandCycle(const DrillingCycle& cycle);

}  // namespace patchmill
