// Traces the curve of two contacts along a re-entrant crease ([spacing, section 7]).
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "cam/path/chord/segment_trace.h"
#include "cam/path/edge/sheet_border.h"
#include "cam/path/stepover/pass_params.h"

namespace patchmill {

// A centre that touches both sides of a crease.
struct PencilPoint {
  Vec3 center = Vec3::Zero();
  SurfacePoint first, second;
};

// Returns the centre nearest to q, within `reach` (mm) in plan, at which the ball touches both sides of a
// crease: a kink of the centre height h. It is searched along two crossing lines through q. nullopt if there
// is none, if the directions to the two contacts differ by less than 0.1 rad, or once `run` is cancelled.
std::optional<PencilPoint> FindPencilPoint(const Locator& locator, const Vec2& q, double reach,
                                           const PassParams& params, const RunContext& run);

// How far a crease is followed: as long as `center` is true of the centres, and past stretches of at most
// `patience` (mm) on which it is false.
struct PencilWanted {
  std::function<bool(const Vec3&)> center;
  double patience = 0.0;
};

// Follows the crease from `seed` both ways, with a predictor along the curve of equal heights and Newton
// steps back onto it. It continues as far as `wanted` says. It ends where a third contact takes over, the
// two contacts merge, the curve turns vertical or the sheet ends. Stations are on the crease to 1e-9 mm in
// plan and joined by chords within the tolerance ([location T2, T3]). Unwanted tails are cut off, and only
// one station may remain. A crease that runs back to the seed is followed once; its last station is the
// first.
std::vector<TraceStation> TracePencil(const Locator& locator, const SheetBorder& border,
                                      const PencilPoint& seed, const PassParams& params,
                                      const PencilWanted& wanted);

}  // namespace patchmill
