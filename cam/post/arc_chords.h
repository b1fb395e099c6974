// G2/G3 as chords.
#pragma once

#include <vector>

#include <absl/status/statusor.h>

#include "core/base/vec.h"

namespace patchmill {

// In axes of the arc's plane: x first, y second, counter-clockwise from x to y; z along the plane's normal.
struct PlaneArc {
  Vec3 from = Vec3::Zero(), to = Vec3::Zero();  // mm
  Vec2 center = Vec2::Zero();
  bool clockwise = false;
};

struct ArcChords {
  std::vector<Vec3> points;  // the end of each chord; the last is exactly `to`
  double chord_error = 0.0;  // mm: sagitta plus what the two radii differ by
};

// A helix or spiral with linear rise and radius; equal ends in the plane are a full circle. `chord_error` >
// 0, mm. INVALID_ARGUMENT when the radii at both ends differ by more than 0.005 mm and by more than 0.1 %
// (the strictest usual control, [machining M19]), by more than 0.5 mm, or when the radius vanishes;
// RESOURCE_EXHAUSTED for more than `max_chords`.
absl::StatusOr<ArcChords> ChordArc(const PlaneArc& arc, double chord_error, std::size_t max_chords);

// Centre of the arc of a given radius (R word): the shorter way round for radius > 0, else the longer.
absl::StatusOr<Vec2> CenterFromRadius(const Vec2& from, const Vec2& to, double radius, bool clockwise);

}  // namespace patchmill
