// How far the points and derivatives of a polynomial bicubic net deviate from a LeafModel. Several control
// points are computed at a time.
#pragma once

namespace patchmill::internal {

// The vectors of the model, three numbers each.
struct ModelVectors {
  const double *s, *a, *b, *uu, *uv, *vv;
};

// The largest values over the control points of each net: of the squared length of the difference from the
// model's vector, and of the parts of the difference along a and b.
struct BicubicBounds {
  double reach2, reach_a, reach_b, reach_uu, reach_uv, reach_vv;  // of S - s
  double z_max;                                                   // of S
  double du2, du_a, du_b;                                         // of S_u - a
  double dv2, dv_a, dv_b;                                         // of S_v - b
  double uu2, uv2, vv2;                                           // of the second derivatives
};

// `points`: 4 x 4 control points, v fastest, four numbers each; the last number is not used. The result has
// the same bits on every processor. Cost: some 0.1 us.
BicubicBounds BoundBicubic(const double* points, const ModelVectors& model);

}  // namespace patchmill::internal
