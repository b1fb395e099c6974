// Finds the round holes of a part: hollow cylinders that close around their axis.
#pragma once

#include <array>
#include <vector>

#include <absl/status/statusor.h>

#include "core/base/run_context.h"
#include "core/surface/surface.h"

namespace patchmill {

enum class HoleEnd {
  kOpen,   // the wall ends in a rim that sticks out, sharp or rounded, or in no other face
  kFloor,  // the wall ends in an inner corner, sharp or rounded, all around
  kStep,   // as kFloor, and a narrower hole of the same axis begins in that floor
};
constexpr HoleEnd LastOf(HoleEnd) { return HoleEnd::kStep; }

struct Hole {
  std::vector<FaceId> faces;       // ascending; CAD systems split a cylinder into two faces or more
  double diameter = 0.0;           // mm
  double depth = 0.0;              // mm, from end to end of the cylinder, where it is longest
  Vec3 mouth = Vec3::Zero();       // mm, on the axis, at the first end
  Vec3 direction = Vec3::UnitZ();  // unit vector along the axis, from the first end to the second
  // The first end is the open one. Of two alike it is the higher one, of two of one height the one with the
  // larger x, then y.
  std::array<HoleEnd, 2> ends{};
};

// The holes in the faces of the surface's model, by their first face. Each one's faces look to the axis
// (u x v points out of the body), are joined to each other, and lie on one cylinder to 1e-4 of its radius.
// The cylinder closes around the axis to 5 degrees; slots and fillets do not. A face of kind cylinder has its
// radius from the file, and the radius of a spline face is measured. Cost: some 300 evaluations a piece of
// such faces, parallel over faces. Errors: those of `run`.
absl::StatusOr<std::vector<Hole>> FindHoles(const Surface& surface, const RunContext& run);

}  // namespace patchmill
