// The inner loop of bicubic patches, the commonest ones. Private to core/patch.
#pragma once

#include "core/math/bernstein.h"

namespace patchmill::internal {

// Of 16 homogeneous points (four numbers each, i along u) and two bases of degree 3: p, du, dv, duu, duv,
// dvv, four numbers each, to out[24]. Four numbers at once: an AVX register where UsedInstructionSet() has
// them, else two of SSE2 or NEON; the operations of TensorJet in its order either way, hence its bits.
void SumBicubic(const double* points, const BasisJet& bu, const BasisJet& bv, double* out);
// Only p, du and dv of these, to out[12].
void SumBicubicSlopes(const double* points, const BasisJet& bu, const BasisJet& bv, double* out);

}  // namespace patchmill::internal
