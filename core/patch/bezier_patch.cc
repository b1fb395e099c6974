// Tensor Bezier patches, polynomial and rational.
#include "core/base/status.h"
#include "core/patch/kinds.h"
#include "core/patch/tensor_kernel.h"

namespace patchmill::internal {

SurfaceJet EvaluateShape(const BezierPatch& patch, double u, double v) {
  PM_CHECK(!patch.points.empty());  // empty in the model of a Surface, where the piece holds the points
  BasisJet bu, bv;
  AllBernsteinJet(patch.degree_u, u, bu);
  AllBernsteinJet(patch.degree_v, v, bv);
  const int row = patch.degree_v + 1;
  const HomogeneousJet h = TensorJet(patch.degree_u, patch.degree_v, bu, bv, [&](int i, int j) {
    return Homogeneous(patch.points, patch.weights, i * row + j);
  });
  return patch.weights.empty() ? PolynomialJet(h) : RationalJet(h);
}

Vec3 ShapePosition(const BezierPatch& patch, double u, double v) {
  PM_CHECK(!patch.points.empty());
  double bu[kMaxBasisDegree + 1], bv[kMaxBasisDegree + 1];
  AllBernstein(patch.degree_u, u, bu);
  AllBernstein(patch.degree_v, v, bv);
  const int row = patch.degree_v + 1;
  const Vec4 p = TensorPoint(patch.degree_u, patch.degree_v, bu, bv, [&](int i, int j) {
    return Homogeneous(patch.points, patch.weights, i * row + j);
  });
  return patch.weights.empty() ? Vec3(p.head<3>()) : Vec3(p.head<3>() / p.w());
}

std::vector<Piece> ShapePieces(const BezierPatch& patch) {
  PM_CHECK(!patch.points.empty());
  std::vector<Piece> pieces(1);
  BernsteinNet& net = pieces[0].net;
  net.degree_u = patch.degree_u;
  net.degree_v = patch.degree_v;
  net.rational = !patch.weights.empty();
  net.points.reserve(patch.points.size());
  for (int k = 0; k < static_cast<int>(patch.points.size()); ++k) {
    net.points.push_back(Homogeneous(patch.points, patch.weights, k));
  }
  pieces[0].native = NativeRectangle(0, 1, 0, 1);
  return pieces;
}

}  // namespace patchmill::internal
