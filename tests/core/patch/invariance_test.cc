// The same surface written differently: degree elevation, reversal, transposition, motion, other layouts.
#include <cmath>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "core/math/bernstein.h"
#include "core/patch/piece.h"
#include "tests/support/random.h"
#include "tests/support/shapes.h"

namespace patchmill {
namespace {

using testing::Random;

std::vector<PatchShape> OneOfEachKind() {
  std::vector<PatchShape> shapes;
  for (const bool rational : {false, true}) {
    shapes.push_back(testing::RandomBezier(1, 3, 3, rational));
    shapes.push_back(testing::RandomBezier(2, 2, 4, rational));
    shapes.push_back(testing::RandomKnots(3, 3, 2, rational));
    shapes.push_back(testing::RandomTriangle(4, 3, rational));
  }
  shapes.push_back(testing::RandomGregory(5, GregoryPatch::Blend::kCorner));
  shapes.push_back(testing::RandomGregory(6, GregoryPatch::Blend::kEdge));
  for (PatchShape& shape : testing::SingularKinds()) shapes.push_back(std::move(shape));
  shapes.push_back(testing::RandomHosaka(7, 3, false, false));
  shapes.push_back(testing::RandomHosaka(8, 4, true, true));
  for (PatchShape& shape : testing::BulgedKinds()) shapes.push_back(std::move(shape));
  return shapes;
}

void ExpectSameJet(const SurfaceJet& a, const SurfaceJet& b, double tolerance) {
  EXPECT_LE((a.p - b.p).norm(), tolerance);
  EXPECT_LE((a.du - b.du).norm(), 10 * tolerance);
  EXPECT_LE((a.dv - b.dv).norm(), 10 * tolerance);
  EXPECT_LE((a.duu - b.duu).norm(), 1000 * tolerance);
  EXPECT_LE((a.duv - b.duv).norm(), 1000 * tolerance);
  EXPECT_LE((a.dvv - b.dvv).norm(), 1000 * tolerance);
}

TEST(Invariance, RotationAndTranslation) {
  const Eigen::Affine3d motion =
      Eigen::Translation3d(3, -70, 11) * Eigen::AngleAxisd(1.1, Vec3(1, 2, -2).normalized());
  const Eigen::Matrix3d turn = motion.linear();
  Random random(1);
  for (const PatchShape& shape : OneOfEachKind()) {
    const PatchShape moved = testing::Transformed(testing::Single(shape), motion).patches[0].shape;
    for (int k = 0; k < 50; ++k) {
      const double u = random.Unit(), v = IsTriangle(shape) ? random.Uniform(0, 1 - u) : random.Unit();
      SurfaceJet s = Evaluate(shape, u, v);
      s = {motion * s.p, turn * s.du, turn * s.dv, turn * s.duu, turn * s.duv, turn * s.dvv, {}};
      ExpectSameJet(Evaluate(moved, u, v), s, 1e-12);
    }
  }
}

TEST(Invariance, ConstantShapeHasNoDerivatives) {  // partition of unity through every kind
  for (PatchShape shape : OneOfEachKind()) {
    std::visit(
        [](auto& s) {
          for (Vec3& p : s.points) p = Vec3(7, -8, 9);
          if constexpr (requires { s.bulges; }) s.bulges.clear();
        },
        shape);
    for (const Vec2& q : {Vec2(0.2, 0.3), Vec2(0, 0), Vec2(1, 0), Vec2(0.6, 0.4)}) {
      const SurfaceJet s = Evaluate(shape, q.x(), q.y());
      SurfaceJet constant;
      constant.p = Vec3(7, -8, 9);
      ExpectSameJet(s, constant, 1e-13);
    }
  }
}

TEST(Invariance, AffineMapsAreReproduced) {
  // Control points of a linear map sit at their Greville places: u, v then come back exactly.
  const Vec3 origin(1, 2, 3), a(4, 1, -2), b(-1, 5, 2);
  const auto linear = [&](double u, double v) -> Vec3 { return origin + u * a + v * b; };
  const auto expect = [&](const PatchShape& shape) {
    Random random(2);
    for (int k = 0; k < 50; ++k) {
      const double u = random.Unit(), v = IsTriangle(shape) ? random.Uniform(0, 1 - u) : random.Unit();
      ExpectSameJet(Evaluate(shape, u, v), {linear(u, v), a, b, Vec3::Zero(), Vec3::Zero(), Vec3::Zero(), {}},
                    1e-12);
    }
  };
  for (int n = 1; n <= kMaxDegree; ++n) {
    BezierPatch bezier;
    bezier.degree_u = n;
    bezier.degree_v = 16 - n;
    for (int i = 0; i <= n; ++i) {
      for (int j = 0; j <= 16 - n; ++j) bezier.points.push_back(linear(double(i) / n, j / (16.0 - n)));
    }
    expect(bezier);
    BezierTriangle triangle;
    triangle.degree = n;
    for (int r = 0; r <= n; ++r) {
      for (int k = 0; k <= n - r; ++k) triangle.points.push_back(linear(double(k) / n, double(r) / n));
    }
    expect(triangle);
  }
  BsplinePatch spline = testing::RandomKnots(3, 3, 2, false);
  const auto greville = [](const std::vector<double>& knots, int p, int i) {
    double sum = 0;
    for (int m = 1; m <= p; ++m) sum += knots[i + m];
    return (sum / p - knots[p]) / (knots[knots.size() - p - 1] - knots[p]);
  };
  const int nv = static_cast<int>(spline.knots_v.size()) - 3;
  for (int k = 0; k < static_cast<int>(spline.points.size()); ++k) {
    spline.points[k] = linear(greville(spline.knots_u, 3, k / nv), greville(spline.knots_v, 2, k % nv));
  }
  expect(spline);
}

TEST(Invariance, DegreeElevation) {
  for (const bool rational : {false, true}) {
    const BezierPatch low = testing::RandomBezier(11, 3, 4, rational);
    // Elevate along v, homogeneous, with the one-variable routine on each coordinate.
    BezierPatch high = low;
    high.degree_v = 5;
    high.points.clear();
    high.weights.clear();
    for (int i = 0; i <= 3; ++i) {
      std::vector<double> row[4];
      for (int j = 0; j <= 4; ++j) {
        const double w = rational ? low.weights[i * 5 + j] : 1.0;
        for (int c = 0; c < 3; ++c) row[c].push_back(w * low.points[i * 5 + j][c]);
        row[3].push_back(w);
      }
      for (auto& r : row) r = BernsteinElevate(r);
      for (int j = 0; j <= 5; ++j) {
        high.points.push_back(Vec3(row[0][j], row[1][j], row[2][j]) / row[3][j]);
        if (rational) high.weights.push_back(row[3][j]);
      }
    }
    Random random(3);
    for (int k = 0; k < 100; ++k) {
      const double u = random.Unit(), v = random.Unit();
      ExpectSameJet(Evaluate(PatchShape(low), u, v), Evaluate(PatchShape(high), u, v), 1e-12);
    }
  }
}

TEST(Invariance, TransposedAndReversedBezier) {
  for (const bool rational : {false, true}) {
    const BezierPatch a = testing::RandomBezier(12, 3, 5, rational);
    BezierPatch t;  // t(u,v) = a(1-v, u)
    t.degree_u = 5;
    t.degree_v = 3;
    for (int i = 0; i <= 5; ++i) {
      for (int j = 0; j <= 3; ++j) {
        t.points.push_back(a.points[(3 - j) * 6 + i]);
        if (rational) t.weights.push_back(a.weights[(3 - j) * 6 + i]);
      }
    }
    Random random(4);
    for (int k = 0; k < 100; ++k) {
      const double u = random.Unit(), v = random.Unit();
      const SurfaceJet s = Evaluate(PatchShape(a), 1 - v, u);
      ExpectSameJet(Evaluate(PatchShape(t), u, v), {s.p, s.dv, -s.du, s.dvv, -s.duv, s.duu, {}}, 1e-12);
    }
  }
}

TEST(Invariance, UniformWeightsDoNothing) {
  BezierPatch plain = testing::RandomBezier(13, 4, 3, false), heavy = plain;
  heavy.weights.assign(plain.points.size(), 0.37);
  Random random(5);
  for (int k = 0; k < 100; ++k) {
    const double u = random.Unit(), v = random.Unit();
    ExpectSameJet(Evaluate(PatchShape(plain), u, v), Evaluate(PatchShape(heavy), u, v), 1e-12);
  }
}

TEST(Invariance, BsplineKnotsMayBeShiftedAndStretched) {
  const BsplinePatch a = testing::RandomKnots(14, 3, 2, true);
  BsplinePatch b = a;
  for (double& t : b.knots_u) t = 5 + 8 * t;
  Random random(6);
  for (int k = 0; k < 100; ++k) {
    const double u = random.Unit(), v = random.Unit();
    ExpectSameJet(Evaluate(PatchShape(a), u, v), Evaluate(PatchShape(b), u, v), 1e-11);
  }
}

TEST(Pieces, OfOneBsplineFitBitForBit) {
  const PatchShape shape = testing::RandomKnots(15, 3, 4, true);
  const auto pieces = SplitIntoPieces(PatchId(0), shape);
  ASSERT_EQ(pieces.size(), 25u);
  for (int a = 0; a < 5; ++a) {
    for (int b = 0; b < 5; ++b) {
      const Piece& here = pieces[a * 5 + b];
      if (b + 1 < 5) {
        for (int i = 0; i <= 3; ++i)
          EXPECT_EQ(here.net.points[i * 5 + 4], pieces[a * 5 + b + 1].net.points[i * 5]);
        EXPECT_EQ(here.native[3], pieces[a * 5 + b + 1].native[1]);
      }
      if (a + 1 < 5) {
        for (int j = 0; j <= 4; ++j)
          EXPECT_EQ(here.net.points[15 + j], pieces[(a + 1) * 5 + b].net.points[j]);
        EXPECT_EQ(here.native[3], pieces[(a + 1) * 5 + b].native[2]);
      }
    }
  }
  EXPECT_EQ(pieces.front().native[0], Vec2(0, 0));
  EXPECT_EQ(pieces.back().native[3], Vec2(1, 1));
}

TEST(Pieces, KeepTheOrientationOfATriangle) {
  const PatchShape shape = testing::RandomTriangle(1, 4, false);
  for (const Piece& piece : SplitIntoPieces(PatchId(0), shape)) {
    double area = 0;
    for (int k = 0; k < 400; ++k) {
      const double u = (k % 20 + 0.5) / 20, v = (k / 20 + 0.5) / 20;
      const auto& c = piece.native;
      const double det =
          Cross((1 - v) * (c[1] - c[0]) + v * (c[3] - c[2]), (1 - u) * (c[2] - c[0]) + u * (c[3] - c[1]));
      EXPECT_GT(det, 0.0);
      area += det / 400;
    }
    EXPECT_NEAR(area, 0.5 / 3, 1e-14);  // a third of the parameter triangle each: they cover it
  }
}

RC_GTEST_PROP(SubNet, PartOfAPartIsAPart, (std::uint64_t seed)) {
  Random random(seed);
  const auto interval = [&] {
    const double a = random.Unit(), b = random.Unit();
    return std::pair(std::min(a, b), std::max(a, b) + 1e-3 * (1 - std::max(a, b)));
  };
  for (const PatchShape& shape : OneOfEachKind()) {
    const BernsteinNet net = SplitIntoPieces(PatchId(0), shape).back().net;
    const auto [u0, u1] = interval();
    const auto [v0, v1] = interval();
    const auto [a0, a1] = interval();
    const auto [b0, b1] = interval();
    const BernsteinNet twice = SubNet(SubNet(net, u0, u1, v0, v1), a0, a1, b0, b1);
    const double du = u1 - u0, dv = v1 - v0;
    const BernsteinNet once = SubNet(net, u0 + a0 * du, u0 + a1 * du, v0 + b0 * dv, v0 + b1 * dv);
    for (std::size_t k = 0; k < once.points.size(); ++k) {
      RC_ASSERT((twice.points[k] - once.points[k]).norm() <= 1e-12 * (1 + once.points[k].norm()));
    }
  }
}

}  // namespace
}  // namespace patchmill
