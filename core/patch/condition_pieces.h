// Better parameters for the pieces of a tensor patch whose weights are far apart. The point set stays.
//
// Weights w_ij times a^i b^j describe the same points: only the parameters change, by a linear fractional map
// (Farin: Curves and Surfaces for CAGD, 13.7). Weights of 1e-6 to 1e6 may so be those of a plain sphere. What
// no such factor evens out is cut.
#pragma once

#include <vector>

#include "core/patch/piece.h"

namespace patchmill::internal {

// Weights of a piece whose logarithms (base 2) differ by less along each line of its net are left alone.
inline constexpr double kEvenWeights = 4.0;

// The pieces of a rational tensor patch, in order of u span, then v span, as SplitIntoPieces makes them;
// returned in the same order. All pieces of one u span are multiplied and cut alike, and all of one v span,
// so that pieces still meet along whole sides. Factors are powers of two: no coordinate is rounded by them.
// Unchanged if the weights of each piece are even. Cost O(points) then; else about 20 spans each way at most
// for weights 1e12 apart.
std::vector<Piece> ConditionPieces(std::vector<Piece> pieces);

}  // namespace patchmill::internal
