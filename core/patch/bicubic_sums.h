// The inner loop of bicubic patches, which are the most common. Private to core/patch.
#pragma once

#include "core/math/bernstein.h"

namespace patchmill::internal {

// Sums 16 homogeneous points (four numbers each, i along u) with two bases of degree 3. out[24] holds p, du,
// dv, duu, duv and dvv, four numbers each. Four numbers are summed at once in an AVX register if
// UsedInstructionSet() has these, else in two of SSE2 or NEON. Either way the operations are those of
// TensorJet in its order, hence its bits.
void SumBicubic(const double* points, const BasisJet& bu, const BasisJet& bv, double* out);
// As SumBicubic, but only p, du and dv, to out[12].
void SumBicubicSlopes(const double* points, const BasisJet& bu, const BasisJet& bv, double* out);

}  // namespace patchmill::internal
