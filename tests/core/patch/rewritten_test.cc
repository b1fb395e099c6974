// The same surface written differently, for every kind: its other representations (pieces, reversed,
// transposed, raised in degree, moved) have the same curvatures, and its own layout turned round the same
// points.
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "core/curve/bezier_chain.h"
#include "core/diffgeo/forms.h"
#include "core/math/bernstein.h"
#include "core/patch/piece.h"
#include "tests/support/random.h"
#include "tests/support/shapes.h"

namespace patchmill {
namespace {

using testing::Random;

struct NamedShape {
  std::string name;
  PatchShape shape;
};
void PrintTo(const NamedShape& s, std::ostream* out) { *out << s.name; }

std::vector<NamedShape> EveryKind() {
  using Blend = GregoryPatch::Blend;
  return {{"Bezier", testing::RandomBezier(1, 3, 4, false)},
          {"RationalBezier", testing::RandomBezier(2, 4, 3, true)},
          {"Bspline", testing::RandomKnots(3, 3, 2, false)},
          {"Nurbs", testing::RandomKnots(4, 3, 3, true)},
          {"Triangle", testing::RandomTriangle(5, 4, false)},
          {"RationalTriangle", testing::RandomTriangle(6, 3, true)},
          {"GregoryCorner", testing::RandomGregory(7, Blend::kCorner)},
          {"GregoryEdge", testing::RandomGregory(8, Blend::kEdge)},
          {"Brown", testing::RandomBrown(9, 4, 5)},
          {"BrownChain", testing::RandomBrown(9, 3, 4, 20.0, {0.4}, {0.2, 0.7})},
          {"GregoryTriangleCorner", testing::RandomGregoryTriangle(10, Blend::kCorner)},
          {"GregoryTriangleEdge", testing::RandomGregoryTriangle(11, Blend::kEdge)},
          {"LoftTriangle", testing::RandomLoftTriangle(12, 3, false)},
          {"SquaredLoftTriangle", testing::RandomLoftTriangle(13, 4, true)},
          {"G2Gregory", testing::RandomG2Gregory(14, 6)},
          {"Hosaka", testing::RandomHosaka(15, 3, false, true)},
          {"HosakaWithBreaks", testing::RandomHosaka(16, 4, true, true)}};
}

class EveryKindOfPatch : public ::testing::TestWithParam<NamedShape> {
 protected:
  // Calls visit(piece, u, v) at random places inside pieces.
  template <class Visit>
  void ForPlaces(Visit visit) const {
    Random random(1);
    for (const Piece& piece : SplitIntoPieces(PatchId(0), GetParam().shape)) {
      for (int k = 0; k < 10; ++k) visit(piece, random.Uniform(0.05, 0.95), random.Uniform(0.05, 0.95));
    }
  }
};

// Places agree to 1e-12 of the size (20 mm), normals and curvatures to 1e-9 (second derivatives of degrees up
// to 14, over squares of first ones). `turned`: the normal points to the other side.
void ExpectSameShape(const SurfaceJet& a, const SurfaceJet& b, bool turned = false) {
  const double side = turned ? -1.0 : 1.0;
  EXPECT_LE((a.p - b.p).norm(), 2e-11);
  const auto n = UnitNormal(a), m = UnitNormal(b);
  ASSERT_TRUE(n && m);
  EXPECT_LE((*n - side * *m).norm(), 1e-9);
  const PrincipalCurvatures k = Principal(Forms(a, *n)), l = Principal(Forms(b, side * *m));
  const double size = 1.0 + std::max(std::abs(k.k_min), std::abs(k.k_max));
  EXPECT_NEAR(k.k_min, l.k_min, 1e-9 * size);
  EXPECT_NEAR(k.k_max, l.k_max, 1e-9 * size);
}

// A piece of nothing but this net.
Piece OfNet(BernsteinNet net) {
  Piece piece;
  piece.net = std::move(net);
  return piece;
}

TEST_P(EveryKindOfPatch, PiecesAreReparametrisations) {
  ForPlaces([&](const Piece& piece, double u, double v) {
    const Vec2 q = NativeParameters(piece, u, v);
    const SurfaceJet native = Evaluate(GetParam().shape, q.x(), q.y());
    ExpectSameShape(native, Evaluate(piece, u, v));
    ExpectSameShape(native, Evaluate(OfNet(piece.net), u, v));
  });
}

TEST_P(EveryKindOfPatch, OrientationOnlyTurnsTheNormal) {
  ForPlaces([&](const Piece& piece, double u, double v) {
    BernsteinNet reversed = piece.net, transposed = piece.net;
    const int n = piece.net.degree_u, m = piece.net.degree_v;
    std::swap(transposed.degree_u, transposed.degree_v);
    for (int i = 0; i <= n; ++i) {
      for (int j = 0; j <= m; ++j) {
        const Vec4& p = piece.net.points[static_cast<std::size_t>(i * (m + 1) + j)];
        reversed.points[static_cast<std::size_t>((n - i) * (m + 1) + j)] = p;
        transposed.points[static_cast<std::size_t>(j * (n + 1) + i)] = p;
      }
    }
    const SurfaceJet own = Evaluate(piece, u, v);
    ExpectSameShape(own, Evaluate(OfNet(reversed), 1 - u, v), true);
    ExpectSameShape(own, Evaluate(OfNet(transposed), v, u), true);
  });
}

TEST_P(EveryKindOfPatch, DegreeElevationChangesNothing) {
  ForPlaces([&](const Piece& piece, double u, double v) {
    BernsteinNet high = piece.net;
    high.points.clear();
    ++high.degree_v;
    const auto side = static_cast<std::size_t>(high.degree_v);
    for (std::size_t i = 0; i < piece.net.points.size(); i += side) {
      std::vector<Vec4> row(side + 1, Vec4::Zero());
      for (int c = 0; c < 4; ++c) {
        std::vector<double> low;
        for (std::size_t j = 0; j < side; ++j) low.push_back(piece.net.points[i + j][c]);
        const std::vector<double> raised = BernsteinElevate(low);
        for (std::size_t j = 0; j <= side; ++j) row[j][c] = raised[j];
      }
      high.points.insert(high.points.end(), row.begin(), row.end());
    }
    ExpectSameShape(Evaluate(piece, u, v), Evaluate(OfNet(high), u, v));
  });
}

TEST_P(EveryKindOfPatch, RigidMotionsLeaveCurvatures) {
  const Eigen::Affine3d motion =
      Eigen::Translation3d(5, -30, 12) * Eigen::AngleAxisd(2.3, Vec3(2, -1, 2).normalized());
  const PatchShape moved = testing::Transformed(testing::Single(GetParam().shape), motion).patches[0].shape;
  ForPlaces([&](const Piece& piece, double u, double v) {
    const Vec2 q = NativeParameters(piece, u, v);
    SurfaceJet s = Evaluate(GetParam().shape, q.x(), q.y());
    const Eigen::Matrix3d turn = motion.linear();
    s = {motion * s.p, turn * s.du, turn * s.dv, turn * s.duu, turn * s.duv, turn * s.dvv, {}};
    ExpectSameShape(s, Evaluate(moved, q.x(), q.y()));
  });
}

INSTANTIATE_TEST_SUITE_P(Rewritten, EveryKindOfPatch, ::testing::ValuesIn(EveryKind()),
                         [](const auto& kind) { return kind.param.name; });

// --- The layouts themselves, turned round ---

// make(u, v): where the rewritten patch has the old one's place.
template <class Old>
void ExpectSameAt(const PatchShape& old, const PatchShape& rewritten, Old to_old, bool turned) {
  Random random(2);
  for (int k = 0; k < 60; ++k) {
    const double u = random.Uniform(0.02, 0.98);
    const double v = IsTriangle(old) ? random.Uniform(0.02, 0.98) * (1 - u) : random.Uniform(0.02, 0.98);
    const Vec2 q = to_old(u, v);
    ExpectSameShape(Evaluate(old, q.x(), q.y()), Evaluate(rewritten, u, v), turned);
  }
}

TEST(Rewritten, QuadsFromTheNextCorner) {
  for (const auto blend : {GregoryPatch::Blend::kCorner, GregoryPatch::Blend::kEdge}) {
    const GregoryPatch old = testing::RandomGregory(21, blend);
    GregoryPatch next = old;
    std::rotate(next.points.begin(), next.points.begin() + 5, next.points.end());
    ExpectSameAt(
        old, next, [](double u, double v) { return Vec2(1 - v, u); }, false);
  }
}

TEST(Rewritten, TrianglesFromTheNextCorner) {
  const auto to_old = [](double s, double t) { return Vec2(1 - s - t, s); };
  for (const auto blend : {GregoryPatch::Blend::kCorner, GregoryPatch::Blend::kEdge}) {
    const GregoryTriangle old = testing::RandomGregoryTriangle(22, blend);
    GregoryTriangle next = old;
    std::rotate(next.points.begin(), next.points.begin() + 5, next.points.begin() + 15);
    std::rotate(next.points.begin() + 15, next.points.begin() + 16, next.points.end());
    ExpectSameAt(old, next, to_old, false);
  }
  for (const int degree : {3, 4}) {
    const LoftTriangle old = testing::RandomLoftTriangle(23, degree, degree == 4);
    LoftTriangle next = old;
    const auto rails = next.points.begin() + 3 * degree;
    std::rotate(next.points.begin(), next.points.begin() + degree, rails);
    std::rotate(rails, rails + degree - 1, next.points.end());
    ExpectSameAt(old, next, to_old, false);
  }
  const BezierTriangle old = testing::RandomTriangle(24, 4, true);
  BezierTriangle next = old;
  const auto at = [](int k, int r) { return static_cast<std::size_t>(r * (4 + 1) - r * (r - 1) / 2 + k); };
  for (int r = 0; r <= 4; ++r) {
    for (int k = 0; k <= 4 - r; ++k) {
      // s^k t^r of the new are powers of old t and old 1-s-t.
      next.points[at(k, r)] = old.points[at(4 - k - r, k)];
      next.weights[at(k, r)] = old.weights[at(4 - k - r, k)];
    }
  }
  ExpectSameAt(old, next, to_old, false);
}

const auto kTransposed = [](double u, double v) { return Vec2(v, u); };

TEST(Rewritten, TransposedG2Gregory) {
  const G2GregoryPatch old = testing::RandomG2Gregory(25, 6);
  G2GregoryPatch next = old;
  const auto inner = [](int i) { return i % 3 != 0; };
  const auto block = [](int i, int j) { return 49 + 4 * (i < 3 ? i - 1 : i - 2) + (j < 3 ? j - 1 : j - 2); };
  for (int i = 0; i <= 6; ++i) {
    for (int j = 0; j <= 6; ++j) {
      const bool two = inner(i) && inner(j);
      next.points[static_cast<std::size_t>(7 * i + j)] =
          old.points[static_cast<std::size_t>(two ? block(j, i) : 7 * j + i)];
      if (two)
        next.points[static_cast<std::size_t>(block(i, j))] = old.points[static_cast<std::size_t>(7 * j + i)];
    }
  }
  ExpectSameAt(old, next, kTransposed, true);
}

// The four rows of a boundary without the inner points: v=0 and v=1 whole, u=0 and u=1 inside; exchanged.
std::vector<Vec3> ExchangedRows(const std::vector<Vec3>& p, int n, int m) {
  const auto row = [&](int corner0, int inside, int count, int corner1) {
    std::vector<Vec3> points = {p[static_cast<std::size_t>(corner0)]};
    points.insert(points.end(), p.begin() + inside, p.begin() + inside + count);
    points.push_back(p[static_cast<std::size_t>(corner1)]);
    return points;
  };
  std::vector<Vec3> rows = row(0, 2 * n + 2, m - 1, n + 1), right = row(n, 2 * n + m + 1, m - 1, 2 * n + 1);
  rows.insert(rows.end(), right.begin(), right.end());
  rows.insert(rows.end(), p.begin() + 1, p.begin() + n);
  rows.insert(rows.end(), p.begin() + n + 2, p.begin() + 2 * n + 1);
  return rows;
}

TEST(Rewritten, TransposedBrown) {
  const int n = 4, m = 5;
  const BrownPatch old = testing::RandomBrown(26, n, m);
  BrownPatch next;
  next.degree_u = m;
  next.degree_v = n;
  next.points = ExchangedRows(old.points, n, m);
  const auto rails = old.points.begin() + 2 * (n + m), of_v = rails + 2 * (n - 1);
  next.points.insert(next.points.end(), of_v, old.points.end());
  next.points.insert(next.points.end(), rails, of_v);
  ExpectSameAt(old, next, kTransposed, true);
}

// Cut at breaks the chains stay what they are, and so does the surface; across a break of chains with
// continuous derivatives it has one tangent plane.
TEST(Rewritten, CutBrown) {
  const BrownPatch old = testing::RandomBrown(28, 4, 5);
  BrownPatch next = old;
  next.breaks_u = {0.25, 0.6};
  next.breaks_v = {0.45};
  const auto cut = [](std::vector<Vec3> row, const std::vector<double>& inner) {
    std::vector<double> breaks = {0.0};
    breaks.insert(breaks.end(), inner.begin(), inner.end());
    breaks.push_back(1.0);
    return CutAt(AsChain({std::move(row)}), breaks).points;
  };
  const auto at = [&](int from, int count) {
    return std::vector<Vec3>(old.points.begin() + from, old.points.begin() + from + count);
  };
  // The ends of columns and rails lie in the rows that cross there.
  const auto with_ends = [](const Vec3& a, std::vector<Vec3> row, const Vec3& b) {
    row.insert(row.begin(), a);
    row.push_back(b);
    return row;
  };
  const auto& p = old.points;
  const std::vector<Vec3> v0 = at(0, 5), v1 = at(5, 5);
  const std::vector<Vec3> u0 = with_ends(v0[0], at(10, 4), v1[0]), u1 = with_ends(v0[4], at(14, 4), v1[4]);
  const auto beside = [](const Vec3& corner, const Vec3& next_one, int degree) -> Vec3 {
    return corner + degree / 3.0 * (next_one - corner);
  };
  const std::vector<std::vector<Vec3>> rails = {
      with_ends(beside(u0[0], u0[1], 5), at(18, 3), beside(u1[0], u1[1], 5)),
      with_ends(beside(u0[5], u0[4], 5), at(21, 3), beside(u1[5], u1[4], 5)),
      with_ends(beside(v0[0], v0[1], 4), at(24, 4), beside(v1[0], v1[1], 4)),
      with_ends(beside(v0[4], v0[3], 4), at(28, 4), beside(v1[4], v1[3], 4))};
  ASSERT_EQ(p.size(), 32u);
  next.points = cut(v0, next.breaks_u);
  const auto add = [&](const std::vector<Vec3>& row, int ends) {
    next.points.insert(next.points.end(), row.begin() + ends, row.end() - ends);
  };
  add(cut(v1, next.breaks_u), 0);
  add(cut(u0, next.breaks_v), 1), add(cut(u1, next.breaks_v), 1);
  add(cut(rails[0], next.breaks_u), 1), add(cut(rails[1], next.breaks_u), 1);
  add(cut(rails[2], next.breaks_v), 1), add(cut(rails[3], next.breaks_v), 1);
  ExpectSameAt(
      old, next, [](double u, double v) { return Vec2(u, v); }, false);

  const BrownPatch chain = testing::RandomBrown(29, 3, 3, 20.0, {0.3}, {});
  for (double v = 0.0; v <= 1.0; v += 0.125) {
    const SurfaceJet before = Evaluate(chain, 0.3 - 1e-12, v), after = Evaluate(chain, 0.3, v);
    EXPECT_LE((before.du - after.du).norm(), 1e-8);
    EXPECT_LE((before.dv - after.dv).norm(), 1e-8);
  }
}

TEST(Rewritten, TransposedHosaka) {
  for (const bool breaks : {false, true}) {
    const HosakaPatch old = testing::RandomHosaka(27, 4, breaks, true);
    HosakaPatch next = old;
    const int n = old.degree;
    next.points = ExchangedRows(old.points, n, n);
    std::swap(next.inner_u, next.inner_v);
    std::swap(next.breaks[0], next.breaks[1]);
    std::swap(next.breaks[2], next.breaks[3]);
    for (int i = 0; i <= old.inner_v; ++i) {
      for (int j = 0; j <= old.inner_u; ++j)
        next.points.push_back(old.points[static_cast<std::size_t>(4 * n + j * (old.inner_v + 1) + i)]);
    }
    ExpectSameAt(old, next, kTransposed, true);
  }
}

// Boehm's knot insertion along u.
TEST(Rewritten, BsplineWithOneKnotMore) {
  for (const bool rational : {false, true}) {
    const BsplinePatch old = testing::RandomKnots(28, 3, 2, rational);
    BsplinePatch next = old;
    const int p = old.degree_u, count = static_cast<int>(old.knots_u.size()) - p - 1;
    const int columns = static_cast<int>(old.points.size()) / count;
    const auto& t = old.knots_u;
    const double knot = 0.4 * t[static_cast<std::size_t>(p)] + 0.6 * t[static_cast<std::size_t>(p + 1)];
    next.knots_u.insert(std::upper_bound(next.knots_u.begin(), next.knots_u.end(), knot), knot);
    next.points.clear();
    next.weights.clear();
    const auto at = [&](int i, int j) {
      const auto k = static_cast<std::size_t>(i * columns + j);
      const double w = rational ? old.weights[k] : 1.0;
      return Vec4(w * old.points[k].x(), w * old.points[k].y(), w * old.points[k].z(), w);
    };
    for (int i = 0; i <= count; ++i) {
      const auto from = static_cast<std::size_t>(i);
      const double a =
          i == 0 ? 1.0
          : i == count
              ? 0.0
              : std::clamp((knot - t[from]) / (t[from + static_cast<std::size_t>(p)] - t[from]), 0.0, 1.0);
      for (int j = 0; j < columns; ++j) {
        const Vec4 q = (a > 0 ? Vec4(a * at(i, j)) : Vec4::Zero()) +
                       (a < 1 ? Vec4((1 - a) * at(i - 1, j)) : Vec4::Zero());
        next.points.push_back(q.head<3>() / q.w());
        if (rational) next.weights.push_back(q.w());
      }
    }
    ExpectSameAt(
        old, next, [](double u, double v) { return Vec2(u, v); }, false);
  }
}

}  // namespace
}  // namespace patchmill
