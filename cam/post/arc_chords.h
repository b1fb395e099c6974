// Divides the arcs of G2 and G3 into chords.
#pragma once

#include <vector>

#include <absl/status/statusor.h>

#include "core/base/vec.h"

namespace patchmill {

// An arc in the axes of its plane: x is the first axis, y the second, z the plane's normal. Counter-clockwise
// is from x to y.
struct PlaneArc {
  Vec3 from = Vec3::Zero(), to = Vec3::Zero();  // mm
  Vec2 center = Vec2::Zero();
  bool clockwise = false;
  int turns = 1;                // the arc ends in this turn, >= 1
  double radius_slack = 0.005;  // mm: by how much the radii at both ends may differ; 0.1 % if that is more
};

struct ArcChords {
  std::vector<Vec3> points;  // end of each chord; the last one is exactly `to`
  double chord_error = 0.0;  // mm, sagitta plus the difference of the two radii
};

// The arc may be a helix or a spiral; rise and radius change linearly. If both ends are equal in the plane,
// it is a full circle. `chord_error` > 0 is the largest sagitta, mm. INVALID_ARGUMENT if the radii at both
// ends differ by more than the slack and by more than 0.1 %, or by more than a hundred times the slack, or if
// a radius vanishes. The default slack is that of the strictest usual control [machining M19].
// RESOURCE_EXHAUSTED if more than `max_chords` are needed.
absl::StatusOr<ArcChords> ChordArc(const PlaneArc& arc, double chord_error, std::size_t max_chords);

// Centre of the arc with a given radius (R word), which may be negative. If radius > 0 the arc is the shorter
// of the two, else the longer. INVALID_ARGUMENT if both ends are equal or farther apart than the diameter.
absl::StatusOr<Vec2> CenterFromRadius(const Vec2& from, const Vec2& to, double radius, bool clockwise);

}  // namespace patchmill
