// Cutting a patch of many pieces: what it costs, known beforehand, and how it ends early.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/base/run_context.h"
#include "core/patch/piece.h"

namespace patchmill {

// As SplitIntoPieces(id, shape), but kinds of many pieces (B-spline, Brown) poll `run`: once it is cancelled
// the pieces are not complete, and the caller asks run.Check().
std::vector<Piece> SplitIntoPieces(PatchId id, const PatchShape& shape, const RunContext& run);
std::vector<Piece> SplitIntoPieces(PatchId id, const PatchShape&& shape, const RunContext& run) = delete;

// One direction of a B-spline.
struct SplineDirection {
  int degree = 0;
  std::span<const double> knots;
};

// Control points of all Bezier pieces that a B-spline is cut into. Of any numbers: 0 where they make no
// B-spline of degrees 1 to kMaxDegree. Cost O(knots).
std::size_t CountSplinePiecePoints(const SplineDirection& u, const SplineDirection& v);

}  // namespace patchmill
