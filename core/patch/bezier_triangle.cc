// Triangular Bezier patches: de Casteljau evaluation, and three rectangles around the centroid.
#include "core/math/tensor_bernstein.h"
#include "core/patch/kinds.h"
#include "core/patch/tensor_kernel.h"

namespace patchmill::internal {
namespace {

constexpr int kMaxTrianglePoints = (kMaxDegree + 1) * (kMaxDegree + 2) / 2;

// Point k of row r of a triangle of degree n; rows shrink by one.
constexpr int TriangleIndex(int n, int r, int k) { return r * (n + 1) - r * (r - 1) / 2 + k; }

// De Casteljau from degree n down to degree `stop` in place (rows keep the layout of their own degree).
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

// Around each vertex: vertex, middle of the edge that leaves it, centroid, middle of the edge that arrives.
// Along the unit square each area coordinate is bilinear; de Casteljau with these bilinear forms in place of
// numbers gives the net of bidegree (n,n) exactly, by convex combinations only.
std::vector<Piece> ShapePieces(const BezierTriangle& patch) {
  const int n = patch.degree;
  const Vec2 vertex[3] = {{0, 0}, {1, 0}, {0, 1}};
  const Vec2 centroid(1.0 / 3.0, 1.0 / 3.0);
  std::vector<Piece> pieces;
  for (int corner = 0; corner < 3; ++corner) {
    const Vec2& a = vertex[corner];
    const Vec2 next = 0.5 * (a + vertex[(corner + 1) % 3]), last = 0.5 * (a + vertex[(corner + 2) % 3]);
    Piece piece;
    piece.native = {a, next, last, centroid};

    using Form = ScaledBernstein<double>;
    Form s(1, 1, 0.0), t(1, 1, 0.0), w(1, 1, 0.0);
    for (std::size_t k = 0; k < 4; ++k) {  // (0,0) (0,1) (1,0) (1,1): the forms' order
      const Vec2& q = piece.native[k == 1 ? 2 : k == 2 ? 1 : k];
      s.c[k] = q.x();
      t.c[k] = q.y();
      w.c[k] = k == 3 ? 1.0 / 3.0 : 1.0 - q.x() - q.y();
    }
    std::vector<ScaledBernstein<Vec4>> level;
    for (int k = 0; k < (n + 1) * (n + 2) / 2; ++k) {
      level.emplace_back(0, 0, Homogeneous(patch.points, patch.weights, k));
    }
    for (int m = n - 1; m >= 0; --m) {
      std::vector<ScaledBernstein<Vec4>> lower;
      for (int r = 0; r <= m; ++r) {
        for (int k = 0; k <= m - r; ++k) {
          ScaledBernstein<Vec4> form(n - m, n - m, Vec4::Zero());
          level[static_cast<std::size_t>(TriangleIndex(m + 1, r, k))].MultiplyInto(w, form);
          level[static_cast<std::size_t>(TriangleIndex(m + 1, r, k + 1))].MultiplyInto(s, form);
          level[static_cast<std::size_t>(TriangleIndex(m + 1, r + 1, k))].MultiplyInto(t, form);
          lower.push_back(std::move(form));
        }
      }
      level = std::move(lower);
    }
    piece.net.degree_u = piece.net.degree_v = n;
    piece.net.rational = !patch.weights.empty();
    piece.net.points = level[0].Unscaled();
    if (!piece.net.rational) {
      for (Vec4& p : piece.net.points) p.w() = 1.0;
    }
    pieces.push_back(std::move(piece));
  }
  return pieces;
}

}  // namespace patchmill::internal
