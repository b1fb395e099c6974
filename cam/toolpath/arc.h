// Arcs as controls drive them with G2 and G3: circular in the plane of two axes, straight along the third.
#pragma once

#include <vector>

#include "core/base/vec.h"

namespace patchmill {

// The plane of an arc, by its first and second axis. Counter-clockwise is from the first to the second, as
// seen from the positive end of the third.
enum class ArcPlane {
  kXy,  // G17
  kZx,  // G18
  kYz   // G19
};
constexpr ArcPlane LastOf(ArcPlane) { return ArcPlane::kYz; }

// The way from one place to another around a centre. If both places are equal in the plane, it is a full
// circle. The third axis moves in proportion to the angle: then the arc is a helix.
struct Arc {
  ArcPlane plane = ArcPlane::kXy;
  Vec2 center = Vec2::Zero();  // mm, along the first and the second axis of the plane
  bool clockwise = false;      // G2
};

// The coordinates along the first, the second and the third axis of the plane, and back.
Vec3 ToPlane(ArcPlane plane, const Vec3& p);
Vec3 FromPlane(ArcPlane plane, const Vec3& p);

struct ArcEnds {
  Vec3 from = Vec3::Zero(), to = Vec3::Zero();
};

// Rad, in (0, 2 pi]: by how much the arc turns, whatever its direction. The ends must not be the centre.
double Sweep(const Arc& arc, const ArcEnds& ends);

// mm, along the arc; of a helix the third axis counts, too.
double ArcLength(const Arc& arc, const ArcEnds& ends);

// The place at the share t of the sweep, 0 to 1. If the ends have different radii, the radius changes in
// proportion to t. The ends themselves are exact.
Vec3 PlaceOn(const Arc& arc, const ArcEnds& ends, double t);

// Ends of the fewest equal chords within `sagitta` > 0, mm, of the arc. The last is ends.to.
std::vector<Vec3> ChordEnds(const Arc& arc, const ArcEnds& ends, double sagitta);

// The places of the arc between its ends at which an axis of its plane is least or greatest.
std::vector<Vec3> TurningPlaces(const Arc& arc, const ArcEnds& ends);

}  // namespace patchmill
