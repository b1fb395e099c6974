// Rounds arcs to the decimals of a program, so that every control accepts them.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "cam/toolpath/arc.h"

namespace patchmill {

// A place in ticks, units of the last decimal.
using Ticks = std::array<std::int64_t, 3>;

// mm, in total and as a share of the radius: by how much the radii at both ends of a written arc differ at
// most. Both limits hold. The first is that of Mach3; GRBL, the strictest of the others, takes 0.005 mm, or
// more where the second allows it [machining M19].
inline constexpr double kEndRadiusSlack = 0.002;
inline constexpr double kRelativeEndRadiusSlack = 1e-3;

// An arc before it is rounded. Its places are those of the tip in the program frame.
struct ExactArc {
  Arc arc;
  ArcEnds ends;
};

// The centre of a rounded arc along X, Y and Z, in ticks of `tick` mm, counted from its start. It is 0 along
// the third axis of the plane.
//
// The centre is chosen anew for the rounded ends, among the places near the exact one, so that the radii at
// both ends are as equal as possible. The written arc deviates from the exact one by what rounding moves its
// ends, and by half a unit more. Absent if no such centre is within kEndRadiusSlack, if the ends are too
// close to each other, or if the arc would turn by another angle: then it must be written as chords. Cost: 50
// centres.
std::optional<Ticks> RoundedCenter(const ExactArc& exact, const Ticks& from, const Ticks& to, double tick);

}  // namespace patchmill
