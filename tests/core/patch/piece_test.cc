// Pieces against native evaluation, for every kind.
#include "core/patch/piece.h"

#include <set>

#include <gtest/gtest.h>

#include "tests/support/random.h"
#include "tests/support/shapes.h"

namespace patchmill {
namespace {

using testing::Random;

Vec3 NetPoint(const BernsteinNet& net, double u, double v) {
  Piece piece;
  piece.net = net;
  return Position(piece, u, v);
}

// The piece's own jet is the native one by the chain rule through the bilinear parameter map.
void ExpectPiecesMatch(const PatchShape& shape, int tries) {
  const std::vector<Piece> pieces = SplitIntoPieces(PatchId(3), shape);
  Random random(5);
  ASSERT_FALSE(pieces.empty());
  for (const Piece& piece : pieces) {
    EXPECT_EQ(piece.patch, PatchId(3));
    for (int k = 0; k < tries; ++k) {
      const double u = random.Unit(), v = random.Unit();
      const Vec2 q = NativeParameters(piece, u, v);
      const SurfaceJet native = Evaluate(shape, q.x(), q.y());
      ASSERT_LE((NetPoint(piece.net, u, v) - native.p).norm(), 1e-12);
      ASSERT_LE((Position(piece, u, v) - native.p).norm(), 1e-12);
      ASSERT_LE((Position(shape, q.x(), q.y()) - native.p).norm(), 1e-12);
      const SurfaceJet own = Evaluate(piece, u, v);
      ASSERT_LE((own.p - native.p).norm(), 1e-12);
      const SurfaceJet slopes = EvaluateSlopes(piece, u, v);
      ASSERT_TRUE(slopes.p == own.p && slopes.du == own.du && slopes.dv == own.dv);
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
      const PatchShape shape = testing::RandomBezier(p, p, 16 - p, rational, 1.0);
      EXPECT_EQ(SplitIntoPieces(PatchId(0), shape).size(), 1u);
      ExpectPiecesMatch(shape, 100);
      ExpectPiecesMatch(testing::RandomBezier(p, p, p, rational, 1.0), 100);
    }
  }
}

TEST(Pieces, BsplineOnePerKnotRectangle) {
  for (int p : {1, 2, 3, 6}) {
    for (bool rational : {false, true}) {
      const PatchShape shape = testing::RandomKnots(p, p, 3, rational, 1.0);
      EXPECT_EQ(SplitIntoPieces(PatchId(0), shape).size(), 25u);
      ExpectPiecesMatch(shape, 30);
    }
  }
}

TEST(Pieces, TrianglesAreThree) {
  for (int n : {1, 2, 3, 4, 9, 15}) {
    for (bool rational : {false, true}) {
      const PatchShape shape = testing::RandomTriangle(n, n, rational, 1.0);
      EXPECT_EQ(SplitIntoPieces(PatchId(0), shape).size(), 3u);
      ExpectPiecesMatch(shape, 100);
    }
  }
}

TEST(Pieces, GregoryNetsEqualTheBlend) {
  for (auto blend : {GregoryPatch::Blend::kCorner, GregoryPatch::Blend::kEdge}) {
    const PatchShape shape = testing::RandomGregory(1, blend, 1.0);
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

TEST(Pieces, BlendedNetsEqualTheBlend) {
  for (const PatchShape& shape : testing::SingularKinds(1.0)) {
    ExpectPiecesMatch(shape, 2000);
    EXPECT_EQ(SplitIntoPieces(PatchId(0), shape).size(), IsTriangle(shape) ? 3u : 1u);
  }
}

TEST(Pieces, BrownOnePerBreakRectangle) {
  const PatchShape shape = testing::RandomBrown(4, 4, 3, 1.0, {0.3, 0.5}, {0.6});
  ExpectPiecesMatch(shape, 500);
  EXPECT_EQ(SplitIntoPieces(PatchId(0), shape).size(), 6u);
}

TEST(Pieces, HosakaOnePerBreakRectangle) {
  for (const bool inner : {false, true}) {
    for (const int n : {1, 3, 11}) {
      HosakaPatch linear = testing::RandomHosaka(n, n, false, inner, 1.0);
      linear.blend = HosakaPatch::Blend::kLinear;
      ExpectPiecesMatch(linear, 200);
      const PatchShape whole = testing::RandomHosaka(n, n, false, inner, 1.0);
      EXPECT_EQ(SplitIntoPieces(PatchId(0), whole).size(), 1u);
      ExpectPiecesMatch(whole, 200);
      const PatchShape broken = testing::RandomHosaka(n, n, true, inner, 1.0);
      EXPECT_EQ(SplitIntoPieces(PatchId(0), broken).size(), 6u);
      ExpectPiecesMatch(broken, 200);
    }
  }
}

TEST(Pieces, BulgesCutThemAtTheirPlaces) {
  for (const PatchShape& shape : testing::BulgedKinds(1.0)) {
    ExpectPiecesMatch(shape, 200);
    std::set<double> us = {0.0, 0.2, 0.5, 0.9}, vs = {0.0, 0.05, 0.8};
    if (const auto* brown = std::get_if<BrownPatch>(&shape)) {
      us.insert(brown->breaks_u.begin(), brown->breaks_u.end());
      vs.insert(brown->breaks_v.begin(), brown->breaks_v.end());
    } else if (const auto* hosaka = std::get_if<HosakaPatch>(&shape)) {
      for (const int k : {0, 1, 2, 3}) {
        for (const HosakaPatch::Break& at : hosaka->breaks[static_cast<std::size_t>(k)]) {
          (k % 2 == 0 ? us : vs).insert(at.at);
        }
      }
    }
    EXPECT_EQ(SplitIntoPieces(PatchId(0), shape).size(), us.size() * vs.size());
  }
}

TEST(Pieces, BulgesKeepTheDegreesLow) {
  for (const PatchShape& shape : testing::BulgedKinds(1.0)) {
    for (const Piece& piece : SplitIntoPieces(PatchId(0), shape)) {
      EXPECT_LE(std::max(piece.net.degree_u, piece.net.degree_v), kMaxDegree);
      for (const Vec4& p : piece.net.points) {
        EXPECT_GE(p.w(), 0.0);
        if (p.w() == 0.0) {
          EXPECT_EQ(p, Vec4::Zero());
        }
      }
    }
  }
}

TEST(SubNet, IsThePartOfTheNet) {
  for (auto blend : {GregoryPatch::Blend::kCorner, GregoryPatch::Blend::kEdge}) {
    Random random(6);
    const PatchShape shape = testing::RandomGregory(1, blend, 1.0);
    const BernsteinNet net = SplitIntoPieces(PatchId(0), shape)[0].net;
    for (int k = 0; k < 1000; ++k) {
      const double u0 = 0.9 * random.Unit(), v0 = 0.9 * random.Unit(), u1 = u0 + (1 - u0) * random.Unit(),
                   v1 = v0 + (1 - v0) * random.Unit();
      const BernsteinNet sub = SubNet(net, u0, u1, v0, v1);
      for (const Vec4& p : sub.points) ASSERT_GT(p.w(), 0.0);
      const double a = random.Unit(), b = random.Unit();
      const Vec3 expected = NetPoint(net, u0 + a * (u1 - u0), v0 + b * (v1 - v0));
      ASSERT_LE((NetPoint(sub, a, b) - expected).norm(), 1e-12);
    }
  }
}

}  // namespace
}  // namespace patchmill
