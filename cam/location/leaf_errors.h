// What the second-order model of a leaf (leaf_model.h) leaves out, as plain numbers.
#pragma once

#include <cmath>

namespace patchmill::internal {

// Bounds in mm^2 or mm, rounded up. They are infinite if the rectangle holds a place without derivatives.
struct LeafErrors {
  float gram_uu = HUGE_VALF, gram_uv = HUGE_VALF, gram_vv = HUGE_VALF;  // of S_i.S_j + (S - s).s_ij
  float drift_uu = 0.0F, drift_uv = 0.0F, drift_vv = 0.0F;              // of S_ij
  float drift_a = 0.0F, drift_b = 0.0F;                                 // of S_u, S_v
  float reach = HUGE_VALF;                                              // of S - s
  double z_max = HUGE_VAL;                                              // of the hull
  float rest = 0.0F;  // of value and slopes at the middle, if these are rounded (search_leaf.h): f may be
                      // lower by rest (|s - c| + reach)
};

}  // namespace patchmill::internal
