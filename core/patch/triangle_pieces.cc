#include "core/patch/triangle_pieces.h"

#include "core/math/tensor_bernstein.h"
#include "core/math/triangle_bernstein.h"
#include "core/patch/kinds.h"

namespace patchmill::internal {

// One piece lies around each vertex: vertex, middle of the edge that leaves it, centroid, middle of the edge
// that arrives. On the unit square each area coordinate is bilinear. De Casteljau with these bilinear forms
// in place of numbers gives the net of bidegree (n,n) exactly, by convex combinations only.
std::vector<Piece> TrianglePieces(int degree, const std::vector<Vec4>& points, bool rational) {
  const int n = degree;
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
    for (const Vec4& point : points) level.emplace_back(0, 0, point);
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
    piece.net.rational = rational;
    piece.net.points = level[0].Unscaled();
    if (!piece.net.rational) {
      for (Vec4& p : piece.net.points) p.w() = 1.0;
    }
    pieces.push_back(std::move(piece));
  }
  return pieces;
}

}  // namespace patchmill::internal
