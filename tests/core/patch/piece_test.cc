// Pieces against native evaluation, for every kind.
#include "core/patch/piece.h"

#include <random>

#include <gtest/gtest.h>

namespace patchmill {
namespace {

std::mt19937 rng(7);
double Unit() { return static_cast<double>(rng()) / 4294967295.0; }
Vec3 Any() { return Vec3(Unit(), Unit(), Unit()); }

PatchShape RandomGregory(GregoryPatch::Blend blend) {
  GregoryPatch g;
  g.blend = blend;
  for (Vec3& p : g.points) p = Any();
  return g;
}

PatchShape RandomBezier(int p, int q, bool rational) {
  BezierPatch b;
  b.degree_u = p;
  b.degree_v = q;
  for (int k = 0; k < (p + 1) * (q + 1); ++k) {
    b.points.push_back(Any());
    if (rational) b.weights.push_back(0.2 + Unit());
  }
  return b;
}

PatchShape RandomTriangle(int n, bool rational) {
  BezierTriangle b;
  b.degree = n;
  for (int k = 0; k < (n + 1) * (n + 2) / 2; ++k) {
    b.points.push_back(Any());
    if (rational) b.weights.push_back(0.2 + Unit());
  }
  return b;
}

PatchShape RandomNurbs(int p, int q, bool rational) {
  BsplinePatch b;
  b.degree_u = p;
  b.degree_v = q;
  const auto knots = [](int degree, bool clamped) {
    std::vector<double> k;
    double t = -3.0;
    for (int i = 0; i < degree + 1; ++i) k.push_back(clamped ? t : t += Unit());
    for (int i = 0; i < 4; ++i) {
      t += 0.2 + Unit();
      k.push_back(t);
      if (i == 1) {
        for (int m = 1; m < degree; ++m) k.push_back(t);  // a crease: multiplicity = degree
      }
    }
    t += 0.3;
    for (int i = 0; i < degree + 1; ++i) k.push_back(clamped ? t : t += 0.1 + Unit());
    return k;
  };
  b.knots_u = knots(p, true);
  b.knots_v = knots(q, false);
  const std::size_t count = (b.knots_u.size() - p - 1) * (b.knots_v.size() - q - 1);
  for (std::size_t k = 0; k < count; ++k) {
    b.points.push_back(Any());
    if (rational) b.weights.push_back(0.2 + Unit());
  }
  return b;
}

Vec3 NetPoint(const BernsteinNet& net, double u, double v) {
  Piece piece;
  piece.net = net;
  return Position(piece, u, v);
}

// The piece's own jet is the native one by the chain rule through the bilinear parameter map.
void ExpectPiecesMatch(const PatchShape& shape, int tries) {
  const std::vector<Piece> pieces = SplitIntoPieces(PatchId(3), shape);
  ASSERT_FALSE(pieces.empty());
  for (const Piece& piece : pieces) {
    EXPECT_EQ(piece.patch, PatchId(3));
    for (int k = 0; k < tries; ++k) {
      const double u = Unit(), v = Unit();
      const Vec2 q = NativeParameters(piece, u, v);
      const SurfaceJet native = Evaluate(shape, q.x(), q.y());
      ASSERT_LE((NetPoint(piece.net, u, v) - native.p).norm(), 1e-12);
      ASSERT_LE((Position(piece, u, v) - native.p).norm(), 1e-12);
      ASSERT_LE((Position(shape, q.x(), q.y()) - native.p).norm(), 1e-12);
      const SurfaceJet own = Evaluate(piece, u, v);
      ASSERT_LE((own.p - native.p).norm(), 1e-12);
      const auto& c = piece.native;
      const Vec2 qu = (1 - v) * (c[1] - c[0]) + v * (c[3] - c[2]),
                 qv = (1 - u) * (c[2] - c[0]) + u * (c[3] - c[1]);
      const Vec2 quv = c[3] - c[2] - c[1] + c[0];
      const Vec3 du = native.du * qu.x() + native.dv * qu.y(), dv = native.du * qv.x() + native.dv * qv.y();
      const auto second = [&](const Vec2& a, const Vec2& b) -> Vec3 {
        return native.duu * a.x() * b.x() + native.duv * (a.x() * b.y() + a.y() * b.x()) +
               native.dvv * a.y() * b.y();
      };
      const double scale = 1 + own.duu.norm() + own.dvv.norm() + own.duv.norm();
      ASSERT_LE((own.du - du).norm(), 1e-11 * scale);
      ASSERT_LE((own.dv - dv).norm(), 1e-11 * scale);
      ASSERT_LE((own.duu - second(qu, qu)).norm(), 1e-10 * scale);
      ASSERT_LE((own.dvv - second(qv, qv)).norm(), 1e-10 * scale);
      ASSERT_LE((own.duv - second(qu, qv) - native.du * quv.x() - native.dv * quv.y()).norm(), 1e-10 * scale);
    }
  }
}

TEST(Pieces, BezierAreOne) {
  for (int p : {1, 2, 3, 5, 15}) {
    for (bool rational : {false, true}) {
      const PatchShape shape = RandomBezier(p, 16 - p, rational);
      EXPECT_EQ(SplitIntoPieces(PatchId(0), shape).size(), 1u);
      ExpectPiecesMatch(shape, 100);
      ExpectPiecesMatch(RandomBezier(p, p, rational), 100);
    }
  }
}

TEST(Pieces, BsplineOnePerKnotRectangle) {
  for (int p : {1, 2, 3, 6}) {
    for (bool rational : {false, true}) {
      const PatchShape shape = RandomNurbs(p, 3, rational);
      EXPECT_EQ(SplitIntoPieces(PatchId(0), shape).size(), 25u);
      ExpectPiecesMatch(shape, 30);
    }
  }
}

TEST(Pieces, TrianglesAreThree) {
  for (int n : {1, 2, 3, 4, 9, 15}) {
    for (bool rational : {false, true}) {
      const PatchShape shape = RandomTriangle(n, rational);
      EXPECT_EQ(SplitIntoPieces(PatchId(0), shape).size(), 3u);
      ExpectPiecesMatch(shape, 100);
    }
  }
}

TEST(Pieces, GregoryNetsEqualTheBlend) {
  for (auto blend : {GregoryPatch::Blend::kCorner, GregoryPatch::Blend::kEdge}) {
    const PatchShape shape = RandomGregory(blend);
    ExpectPiecesMatch(shape, 10000);
    const Piece piece = SplitIntoPieces(PatchId(0), shape)[0];
    int zeros = 0;
    for (const Vec4& p : piece.net.points) {
      EXPECT_GE(p.w(), 0.0);
      if (p.w() == 0.0) {
        EXPECT_TRUE(p == Vec4::Zero());
        ++zeros;
      } else {
        EXPECT_GT(p.w(), 1e-3);
      }
    }
    EXPECT_EQ(zeros, 4);
  }
}

TEST(SubNet, IsThePartOfTheNet) {
  for (auto blend : {GregoryPatch::Blend::kCorner, GregoryPatch::Blend::kEdge}) {
    const BernsteinNet net = SplitIntoPieces(PatchId(0), RandomGregory(blend))[0].net;
    for (int k = 0; k < 1000; ++k) {
      const double u0 = 0.9 * Unit(), v0 = 0.9 * Unit(), u1 = u0 + (1 - u0) * Unit(),
                   v1 = v0 + (1 - v0) * Unit();
      const BernsteinNet sub = SubNet(net, u0, u1, v0, v1);
      for (const Vec4& p : sub.points) ASSERT_GT(p.w(), 0.0);
      const double a = Unit(), b = Unit();
      const Vec3 expected = NetPoint(net, u0 + a * (u1 - u0), v0 + b * (v1 - v0));
      ASSERT_LE((NetPoint(sub, a, b) - expected).norm(), 1e-12);
    }
  }
}

}  // namespace
}  // namespace patchmill
