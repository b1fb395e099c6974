// The shapes of leads: tangent arcs onto a pass, and ramps along it.
#pragma once

#include <optional>
#include <vector>

#include "cam/link/pass_end.h"

namespace patchmill {

struct LeadParams {
  double radius = 0.0;                // mm, of the arcs, > 0
  double sweep = 0.5 * kPi;           // rad, of the arcs, (0, pi/2]
  double ramp_angle = Radians(10.0);  // rad, how much steeper than the pass a ramp descends
};

inline constexpr double kLeastLeadRadius = 0.2;  // mm; smaller arcs mark the surface like a straight lead

enum class LeadKind {
  kArc,       // tangent to the pass
  kBack,      // tangent to the pass a little further in, then back along the pass to its start
  kRamp,      // along the pass and down to its start
  kStraight,  // level from beside the wall, or from above: steeper against the pass than a ramp
};
constexpr LeadKind LastOf(LeadKind) { return LeadKind::kStraight; }

// A lead as the report counts it.
struct LeadFigure {
  LeadKind kind = LeadKind::kStraight;
  bool in = true;             // onto a pass; false: off it
  double radius = 0.0;        // mm, of an arc
  bool whole = false;         // that is the whole radius
  Vec3 place = Vec3::Zero();  // ball centre where it meets the pass
};

// A lead between the pass and a place beside it or above it.
struct LeadArc {
  double radius = 0.0;       // mm
  double sweep = 0.0;        // rad
  std::vector<Vec3> places;  // ball centres, from the end of the pass outwards
};

// The place where an arc meets a pass.
struct LeadPlace {
  Vec3 center = Vec3::Zero();    // of the ball
  Vec3 normal = Vec3::UnitZ();   // unit, of the contact
  Vec3 outwards = Vec3::Zero();  // unit, along the pass and away from what is cut
  bool steep = false;            // IsSteep(normal), and the ball touches the surface
};
// The end of a pass. nullopt if the pass has no length.
std::optional<LeadPlace> PlaceOf(const PassEnd& end);

// Returns the arcs that are tangent to the pass at a place, the best first: those of the whole radius before
// smaller ones, down to kLeastLeadRadius; wide sweeps before narrow ones. On a steep contact they turn away
// from the wall, first in the horizontal plane; else they rise in the vertical plane of the pass. Chords of
// each arc deviate from it by at most `sagitta` (mm).
std::vector<LeadArc> LeadArcs(const LeadPlace& place, const LeadParams& params, double sagitta);

// Returns a ramp onto the start of a pass: ball centres from `height` (mm, > 0) above the pass, back and
// forth along it, and down to its start. The ramp descends by params.ramp_angle against the pass.
// Everything above a free centre is free [location T1], so the ramp gouges no more than the pass. Empty if
// the pass is so short that the ramp would go over it more than five times.
std::vector<Vec3> RampAlong(const PassEnd& start, const LeadParams& params, double height);

// The contact normal there, unit length: at a corner the bisector of both normals, without a contact e_z.
Vec3 NormalAt(const CutterPoint& point);
// True if a contact with this normal is so steep that a lead comes from beside it, not from above.
bool IsSteep(const Vec3& normal);
bool IsSteepContact(const CutterPoint& point);

}  // namespace patchmill
