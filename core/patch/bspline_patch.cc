// B-spline and NURBS patches: evaluation on the knots, and exact extraction of the Bezier pieces.
#include "core/math/bspline_basis.h"
#include "core/patch/kinds.h"
#include "core/patch/tensor_kernel.h"

namespace patchmill::internal {
namespace {

// One parameter direction: [0,1] is mapped to the domain of the knots.
struct Direction {
  const std::vector<double>& knots;
  int degree;
  int count() const { return static_cast<int>(knots.size()) - degree - 1; }
  double begin() const { return knots[static_cast<std::size_t>(degree)]; }
  double end() const { return knots[static_cast<std::size_t>(count())]; }
  double length() const { return end() - begin(); }
  // The knot value of u; exactly the end knot for u = 1.
  double ToKnot(double u) const { return u == 1.0 ? end() : begin() + u * length(); }
  double FromKnot(double t) const { return t == end() ? 1.0 : (t - begin()) / length(); }

  // Basis and its derivatives with respect to u in [0,1]. Returns the number of the first function.
  int Basis(double u, BasisJet& out) const {
    const double t = ToKnot(u);
    const int k = FindSpan(knots, degree, t);
    BsplineBasisJet(knots, degree, k, t, out);
    const double c = length();
    for (int i = 0; i <= degree; ++i) {
      out.d[i] *= c;
      out.dd[i] *= c * c;
    }
    return k - degree;
  }
};

// Polls `run` once in 1024 points; a point takes half a microsecond at most.
class Poll {
 public:
  explicit Poll(const RunContext& run) : run_(run) {}
  bool Cancelled() { return ++points_ % 1024 == 0 && run_.Cancelled(); }

 private:
  const RunContext& run_;
  std::size_t points_ = 0;
};

}  // namespace

SurfaceJet EvaluateShape(const BsplinePatch& patch, double u, double v) {
  const Direction du{patch.knots_u, patch.degree_u}, dv{patch.knots_v, patch.degree_v};
  BasisJet bu, bv;
  const int i0 = du.Basis(u, bu), j0 = dv.Basis(v, bv), row = dv.count();
  const HomogeneousJet h = TensorJet(patch.degree_u, patch.degree_v, bu, bv, [&](int i, int j) {
    return Homogeneous(patch.points, patch.weights, (i0 + i) * row + j0 + j);
  });
  return patch.weights.empty() ? PolynomialJet(h) : RationalJet(h);
}

Vec3 ShapePosition(const BsplinePatch& patch, double u, double v) {
  const Direction du{patch.knots_u, patch.degree_u}, dv{patch.knots_v, patch.degree_v};
  BasisJet bu, bv;
  const int i0 = du.Basis(u, bu), j0 = dv.Basis(v, bv), row = dv.count();
  const Vec4 p = TensorPoint(patch.degree_u, patch.degree_v, bu.f, bv.f, [&](int i, int j) {
    return Homogeneous(patch.points, patch.weights, (i0 + i) * row + j0 + j);
  });
  return patch.weights.empty() ? Vec3(p.head<3>()) : Vec3(p.head<3>() / p.w());
}

// Extracts first along u, into a grid whose columns are still B-splines in v, then along v. Neighbouring
// spans share their border points, so the pieces of one patch fit bit for bit.
std::vector<Piece> ShapePieces(const BsplinePatch& patch, const RunContext& run) {
  const Direction du{patch.knots_u, patch.degree_u}, dv{patch.knots_v, patch.degree_v};
  const std::vector<int> spans_u = NonEmptySpans(patch.knots_u, patch.degree_u);
  const std::vector<int> spans_v = NonEmptySpans(patch.knots_v, patch.degree_v);
  const int p = patch.degree_u, q = patch.degree_v;
  const int columns = dv.count();
  const int fine_u = static_cast<int>(spans_u.size()) * p + 1,
            fine_v = static_cast<int>(spans_v.size()) * q + 1;

  std::vector<Vec4> given;
  given.reserve(patch.points.size());
  for (int k = 0; k < static_cast<int>(patch.points.size()); ++k) {
    given.push_back(Homogeneous(patch.points, patch.weights, k));
  }
  Poll poll(run);
  std::vector<Vec4> half(static_cast<std::size_t>(fine_u * columns));
  for (int a = 0; a < static_cast<int>(spans_u.size()); ++a) {
    const int k = spans_u[static_cast<std::size_t>(a)];
    for (int i = a == 0 ? 0 : 1; i <= p; ++i) {
      for (int c = 0; c < columns; ++c) {
        if (poll.Cancelled()) return {};
        half[static_cast<std::size_t>((a * p + i) * columns + c)] = BezierPointOfSpan(
            patch.knots_u, p, k, i, &given[static_cast<std::size_t>((k - p) * columns + c)], columns);
      }
    }
  }
  std::vector<Vec4> fine(static_cast<std::size_t>(fine_u * fine_v));
  for (int i = 0; i < fine_u; ++i) {
    for (int b = 0; b < static_cast<int>(spans_v.size()); ++b) {
      const int k = spans_v[static_cast<std::size_t>(b)];
      for (int j = b == 0 ? 0 : 1; j <= q; ++j) {
        if (poll.Cancelled()) return {};
        fine[static_cast<std::size_t>(i * fine_v + b * q + j)] = BezierPointOfSpan(
            patch.knots_v, q, k, j, &half[static_cast<std::size_t>(i * columns + k - q)], 1);
      }
    }
  }

  std::vector<Piece> pieces;
  pieces.reserve(spans_u.size() * spans_v.size());
  for (int a = 0; a < static_cast<int>(spans_u.size()); ++a) {
    for (int b = 0; b < static_cast<int>(spans_v.size()); ++b) {
      Piece piece;
      piece.net.degree_u = p;
      piece.net.degree_v = q;
      piece.net.rational = !patch.weights.empty();
      piece.net.points.reserve(static_cast<std::size_t>((p + 1) * (q + 1)));
      for (int i = 0; i <= p; ++i) {
        for (int j = 0; j <= q; ++j) {
          if (poll.Cancelled()) return pieces;
          Vec4 point = fine[static_cast<std::size_t>((a * p + i) * fine_v + b * q + j)];
          if (!piece.net.rational) point.w() = 1.0;
          piece.net.points.push_back(point);
        }
      }
      const auto at = [](const Direction& d, int k) {
        return d.FromKnot(d.knots[static_cast<std::size_t>(k)]);
      };
      const int ku = spans_u[static_cast<std::size_t>(a)], kv = spans_v[static_cast<std::size_t>(b)];
      piece.native = NativeRectangle(at(du, ku), at(du, ku + 1), at(dv, kv), at(dv, kv + 1));
      pieces.push_back(std::move(piece));
    }
  }
  return pieces;
}

}  // namespace patchmill::internal
