// Triangular Bezier patches: de Casteljau evaluation.
#include "core/math/triangle_bernstein.h"
#include "core/patch/kinds.h"
#include "core/patch/tensor_kernel.h"
#include "core/patch/triangle_pieces.h"

namespace patchmill::internal {
namespace {

constexpr int kMaxTrianglePoints = (kMaxDegree + 1) * (kMaxDegree + 2) / 2;

// De Casteljau from degree n down to degree `stop`, in place. Rows keep the layout of their own degree.
void Reduce(Vec4* b, int n, int stop, double s, double t) {
  const double w = 1.0 - s - t;
  for (int m = n - 1; m >= stop; --m) {
    for (int r = 0; r <= m; ++r) {
      for (int k = 0; k <= m - r; ++k) {  // reads entries at or after the one it writes
        b[TriangleIndex(m, r, k)] = w * b[TriangleIndex(m + 1, r, k)] +
                                    s * b[TriangleIndex(m + 1, r, k + 1)] +
                                    t * b[TriangleIndex(m + 1, r + 1, k)];
      }
    }
  }
}

void Load(const BezierTriangle& patch, Vec4* b) {
  const int count = (patch.degree + 1) * (patch.degree + 2) / 2;
  for (int k = 0; k < count; ++k) b[k] = Homogeneous(patch.points, patch.weights, k);
}

}  // namespace

SurfaceJet EvaluateShape(const BezierTriangle& patch, double s, double t) {
  const int n = patch.degree;
  Vec4 b[kMaxTrianglePoints];
  Load(patch, b);
  HomogeneousJet h;
  h.duu = h.duv = h.dvv = Vec4::Zero();
  if (n >= 2) {  // degree 2: rows (b0 b1 b2) (b3 b4) (b5)
    Reduce(b, n, 2, s, t);
    const double c = static_cast<double>(n) * (n - 1);
    h.duu = c * (b[2] - 2.0 * b[1] + b[0]);
    h.duv = c * (b[4] - b[1] - b[3] + b[0]);
    h.dvv = c * (b[5] - 2.0 * b[3] + b[0]);
    Reduce(b, 2, 1, s, t);
  }
  h.du = static_cast<double>(n) * (b[1] - b[0]);  // degree 1: (b0 b1) (b2)
  h.dv = static_cast<double>(n) * (b[2] - b[0]);
  h.p = (1.0 - s - t) * b[0] + s * b[1] + t * b[2];
  return patch.weights.empty() ? PolynomialJet(h) : RationalJet(h);
}

Vec3 ShapePosition(const BezierTriangle& patch, double s, double t) {
  Vec4 b[kMaxTrianglePoints];
  Load(patch, b);
  Reduce(b, patch.degree, 0, s, t);
  return patch.weights.empty() ? Vec3(b[0].head<3>()) : Vec3(b[0].head<3>() / b[0].w());
}

std::vector<Piece> ShapePieces(const BezierTriangle& patch) {
  std::vector<Vec4> points;
  for (int k = 0; k < TriangleCount(patch.degree); ++k) {
    points.push_back(Homogeneous(patch.points, patch.weights, k));
  }
  return TrianglePieces(patch.degree, points, !patch.weights.empty());
}

}  // namespace patchmill::internal
