// Leads: the way between the outside of the stock and the end of a pass ([machining M6], [linking]).
#pragma once

#include <vector>

#include "cam/link/lead_shapes.h"
#include "cam/link/move_check.h"

namespace patchmill {

inline constexpr double kLeadSagitta = 0.1;  // chord tolerances: how far chords of arcs are off the arc

// The way from the outside of the stock to the end of a pass, or back. From `clear`, where the ball is clear
// of the stock, it goes straight down to places.front(), then along `places` to the pass.
struct Lead {
  LeadKind kind = LeadKind::kStraight;
  double radius = 0.0;  // mm, of an arc
  Vec3 clear = Vec3::Zero();
  std::vector<Vec3> places;  // ball centres; the last one is the end of the pass
};

// Returns a lead onto the start of a pass or off its end. The first arc of LeadArcs that is free is taken. A
// pass that begins in a corner is entered a little further in, and the ball goes back to its start; if no arc
// is free there either, it is entered by a ramp. Else the lead is straight: level and off the wall at a
// steep contact, along the contact's normal or turned from it, straight up at a gentle one, aslant if
// something stands above. Every move of it is proven as the moves of links are. Cost: some dozens of proofs,
// each of some microseconds, more where little is free.
Lead FindLead(const MoveCheck& check, const PassEnd& end);

}  // namespace patchmill
