// What the second-order model of a leaf leaves out (leaf_model.h), as plain numbers.
#pragma once

#include <cmath>

namespace patchmill::internal {

// Bounds, mm^2 resp. mm, rounded up; infinite where the rectangle holds a place without derivatives.
struct LeafErrors {
  float gram_uu = HUGE_VALF, gram_uv = HUGE_VALF, gram_vv = HUGE_VALF;  // of S_i.S_j + (S - s).s_ij
  float drift_uu = 0.0F, drift_uv = 0.0F, drift_vv = 0.0F;              // of S_ij
  float drift_a = 0.0F, drift_b = 0.0F;                                 // of S_u, S_v
  float reach = HUGE_VALF;                                              // of S - s
  double z_max = HUGE_VAL;                                              // of the hull
  float rest = 0.0F;  // of value and slopes at the middle where these are rounded (search_leaf.h): f is lower
                      // by up to rest (|s - c| + reach)
};

}  // namespace patchmill::internal
