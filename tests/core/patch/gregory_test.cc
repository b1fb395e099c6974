// Gregory quads: vectors of [shapes (7), (9)], boundaries, corners, and the hull of nets with zero weights.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "core/patch/piece.h"
#include "tests/support/eigen_matchers.h"
#include "tests/support/json.h"
#include "tests/support/random.h"
#include "tests/support/shapes.h"

namespace patchmill {
namespace {

using testing::IsNear;
using testing::Json;
using testing::Random;
using Blend = GregoryPatch::Blend;

constexpr Blend kBlends[] = {Blend::kCorner, Blend::kEdge};

// Corner data of the paper -> twenty points, [shapes (9)]: net 1 has the twists W1 of the edges v=0, v=1.
GregoryPatch FromCorners(const Json& data) {
  constexpr int kFirst[2][2] = {{0, 15}, {5, 10}};   // [i][j]: P of corner u=i, v=j
  constexpr int kAlongU[2][2] = {{1, 17}, {7, 11}};  // the edge point next to it along u
  constexpr int kAlongV[2][2] = {{2, 16}, {6, 12}};
  constexpr int kNet1[2][2] = {{3, 19}, {9, 13}};
  constexpr int kNet2[2][2] = {{4, 18}, {8, 14}};
  GregoryPatch patch;
  patch.blend = Blend::kEdge;
  for (int i = 0; i < 2; ++i) {
    for (int j = 0; j < 2; ++j) {
      const double si = i == 0 ? 1 : -1, sj = j == 0 ? 1 : -1;
      const auto at = [&](const char* key) { return data[key][i][j].Vector(); };
      const Vec3 along_u = at("P") + si / 3 * at("Pu"), along_v = at("P") + sj / 3 * at("Pv");
      const Vec3 both = along_u + along_v - at("P");
      patch.points[kFirst[i][j]] = at("P");
      patch.points[kAlongU[i][j]] = along_u;
      patch.points[kAlongV[i][j]] = along_v;
      patch.points[kNet1[i][j]] = both + si * sj / 9 * at("W1");
      patch.points[kNet2[i][j]] = both + si * sj / 9 * at("W2");
    }
  }
  return patch;
}

class GregoryVectors : public ::testing::Test {
 protected:
  const Json data_ = testing::LoadJson(PATCHMILL_SOURCE_DIR "/tests/vectors/gregory_quad.json");
  const GregoryPatch patch_ = FromCorners(data_);
};

TEST_F(GregoryVectors, JetsOfTheEdgeBlend) {
  ASSERT_GE(data_["points"].Items().size(), 3u);
  for (const Json& point : data_["points"].Items()) {
    const SurfaceJet s = Evaluate(PatchShape(patch_), point["u"].Number(), point["v"].Number());
    EXPECT_THAT(s.p, IsNear(point["S"].Vector(), 1e-12)) << "S";
    EXPECT_THAT(s.du, IsNear(point["Su"].Vector(), 1e-12)) << "Su";
    EXPECT_THAT(s.dv, IsNear(point["Sv"].Vector(), 1e-12)) << "Sv";
    EXPECT_THAT(s.duu, IsNear(point["Suu"].Vector(), 1e-12)) << "Suu";
    EXPECT_THAT(s.duv, IsNear(point["Suv"].Vector(), 1e-12)) << "Suv";
    EXPECT_THAT(s.dvv, IsNear(point["Svv"].Vector(), 1e-12)) << "Svv";
  }
}

TEST_F(GregoryVectors, BicubicNetsAndTheirLofts) {
  for (const auto& [net, loft] : {std::pair("B1", "S1"), std::pair("B2", "S2")}) {
    BezierPatch bezier;
    bezier.degree_u = bezier.degree_v = 3;
    for (int i = 0; i < 4; ++i) {
      for (int j = 0; j < 4; ++j) bezier.points.push_back(data_[net][i][j].Vector());
    }
    for (std::size_t k = 0; k < data_["points"].Items().size(); ++k) {
      const Json& at = data_["points"][static_cast<int>(k)];
      EXPECT_THAT(Position(PatchShape(bezier), at["u"].Number(), at["v"].Number()),
                  IsNear(data_[loft][static_cast<int>(k)].Vector(), 1e-12))
          << loft;
    }
  }
}

TEST_F(GregoryVectors, CornerValues) {
  for (int i = 0; i < 2; ++i) {
    for (int j = 0; j < 2; ++j) {
      const SurfaceJet s = Evaluate(PatchShape(patch_), i, j);
      EXPECT_EQ(s.p, data_["P"][i][j].Vector());
      EXPECT_THAT(s.du, IsNear(data_["Pu"][i][j].Vector(), 1e-14)) << "Pu";
      EXPECT_THAT(s.dv, IsNear(data_["Pv"][i][j].Vector(), 1e-14)) << "Pv";
      EXPECT_THAT(s.du.cross(s.dv).normalized(), IsNear(data_["normals"][i][j].Vector(), 1e-12)) << "normal";
      EXPECT_THAT(s.duv, IsNear(0.5 * (data_["W1"][i][j].Vector() + data_["W2"][i][j].Vector()), 1e-12))
          << "Suv";
      // The boundary curves through the corner: cubic Hermite second derivatives.
      const auto second = [&](const char* slope, int i2, int j2) -> Vec3 {
        const Vec3 chord = data_["P"][i2][j2].Vector() - data_["P"][i][j].Vector();
        const double sign = i2 + j2 > i + j ? 1 : -1;
        return 6 * chord - sign * (4 * data_[slope][i][j].Vector() + 2 * data_[slope][i2][j2].Vector());
      };
      EXPECT_THAT(s.duu, IsNear(second("Pu", 1 - i, j), 1e-12)) << "Suu";
      EXPECT_THAT(s.dvv, IsNear(second("Pv", i, 1 - j), 1e-12)) << "Svv";
    }
  }
}

TEST_F(GregoryVectors, LimitsAlongRaysIntoTheCorner) {
  const double r = 1e-5;  // outside the radius with fixed corner values; the limit is reached linearly
  for (const Json& ray : data_["corner_rays"].Items()) {
    const double m = ray["m"].Number();
    const SurfaceJet s = Evaluate(PatchShape(patch_), r, m * r);
    EXPECT_THAT(s.duu, IsNear(ray["Suu"].Vector(), 1e-3)) << "Suu";
    EXPECT_THAT(s.duv, IsNear(ray["Suv"].Vector(), 1e-3)) << "Suv";
    EXPECT_THAT(s.dvv, IsNear(ray["Svv"].Vector(), 1e-3)) << "Svv";
  }
}

TEST(Gregory, CornerBlendIsItsReadmeFormula) {
  const GregoryPatch g = testing::RandomGregory(4, Blend::kCorner);
  const auto& p = g.points;
  Random random(1);
  for (int k = 0; k < 500; ++k) {
    const double u = random.Unit(), v = random.Unit(), a = 1 - u, b = 1 - v;
    const Vec3 b11 = (u * p[3] + v * p[4]) / (u + v), b21 = (v * p[8] + a * p[9]) / (a + v);
    const Vec3 b22 = (a * p[13] + b * p[14]) / (a + b), b12 = (b * p[18] + u * p[19]) / (u + b);
    const Vec3 rows[4][4] = {{p[0], p[2], p[16], p[15]},
                             {p[1], b11, b12, p[17]},
                             {p[7], b21, b22, p[11]},
                             {p[5], p[6], p[12], p[10]}};
    const double bu[4] = {a * a * a, 3 * a * a * u, 3 * a * u * u, u * u * u};
    const double bv[4] = {b * b * b, 3 * b * b * v, 3 * b * v * v, v * v * v};
    Vec3 expected = Vec3::Zero();
    for (int i = 0; i < 4; ++i) {
      for (int j = 0; j < 4; ++j) expected += bu[i] * bv[j] * rows[i][j];
    }
    EXPECT_THAT(Evaluate(PatchShape(g), u, v).p, IsNear(expected, 1e-13)) << "value";
    EXPECT_THAT(Position(PatchShape(g), u, v), IsNear(expected, 1e-13)) << "position";
  }
}

TEST(Gregory, BlendsAgreeOnTheBoundaryWithFirstDerivatives) {
  const GregoryPatch corner = testing::RandomGregory(2, Blend::kCorner);
  const GregoryPatch edge = testing::RandomGregory(2, Blend::kEdge);
  Random random(2);
  double difference = 0;
  for (int k = 0; k < 200; ++k) {
    const double t = random.Unit();
    for (const Vec2& q : {Vec2(t, 0), Vec2(t, 1), Vec2(0, t), Vec2(1, t)}) {
      const SurfaceJet a = Evaluate(PatchShape(corner), q.x(), q.y()),
                       b = Evaluate(PatchShape(edge), q.x(), q.y());
      EXPECT_THAT(a.p, IsNear(b.p, 1e-13)) << "p";
      // Along the edge both have the curve's derivative; across, the corner blend's inner points tend to the
      // same points as the edge blend's.
      EXPECT_THAT(a.du, IsNear(b.du, 1e-12)) << "du";
      EXPECT_THAT(a.dv, IsNear(b.dv, 1e-12)) << "dv";
    }
    const double v = random.Unit();
    difference =
        std::max(difference, (Position(PatchShape(corner), t, v) - Position(PatchShape(edge), t, v)).norm());
  }
  EXPECT_GT(difference, 0.01);  // inside they are different surfaces
}

TEST(Gregory, EqualPairsGiveTheBicubic) {
  for (const Blend blend : kBlends) {
    GregoryPatch g = testing::RandomGregory(3, blend);
    for (const int k : {3, 8, 13, 18}) g.points[k + 1] = g.points[k];
    const auto& p = g.points;
    BezierPatch bezier;
    bezier.degree_u = bezier.degree_v = 3;
    bezier.points = {p[0], p[2], p[16], p[15], p[1], p[3], p[18], p[17],
                     p[7], p[8], p[13], p[11], p[5], p[6], p[12], p[10]};
    Random random(3);
    for (int k = 0; k < 100; ++k) {
      const double u = random.Unit(), v = random.Unit();
      const SurfaceJet a = Evaluate(PatchShape(g), u, v), b = Evaluate(PatchShape(bezier), u, v);
      EXPECT_THAT(a.p, IsNear(b.p, 1e-13)) << "p";
      EXPECT_THAT(a.duv, IsNear(b.duv, 1e-11)) << "duv";
      EXPECT_THAT(a.dvv, IsNear(b.dvv, 1e-11)) << "dvv";
    }
  }
}

TEST(Gregory, IsFiniteAndC1ArbitrarilyCloseToCorners) {
  for (const Blend blend : kBlends) {
    const PatchShape g = testing::RandomGregory(6, blend);
    for (int corner = 0; corner < 4; ++corner) {
      const double u0 = corner % 2, v0 = corner / 2;
      const SurfaceJet limit = Evaluate(g, u0, v0);
      for (const double r : {1e-3, 1e-6, 1e-9, 1e-15, 1e-300}) {
        for (const Vec2& d : {Vec2(1, 0), Vec2(0, 1), Vec2(1, 1), Vec2(0.1, 0.7)}) {
          const SurfaceJet s =
              Evaluate(g, u0 == 0 ? r * d.x() : 1 - r * d.x(), v0 == 0 ? r * d.y() : 1 - r * d.y());
          EXPECT_LE((s.p - limit.p).norm(), 100 * r);
          EXPECT_LE((s.du - limit.du).norm(), 1e-13 + 1000 * r);
          EXPECT_LE((s.dv - limit.dv).norm(), 1e-13 + 1000 * r);
          EXPECT_TRUE(s.duu.allFinite() && s.duv.allFinite() && s.dvv.allFinite());
        }
      }
    }
  }
}

// The promise of BernsteinNet: zero points are exactly zero, all others positive, and the surface lies in the
// box of the others; parts that touch a singular corner shrink to it.
TEST(GregoryNet, HullHoldsDownToTheSingularCorners) {
  Random random(7);
  for (const Blend blend : kBlends) {
    const PatchShape shape = testing::RandomGregory(8, blend);
    const BernsteinNet net = SplitIntoPieces(PatchId(0), shape)[0].net;
    for (int corner = 0; corner < 4; ++corner) {
      double previous = 0;
      for (int depth = 0; depth <= 40; depth += 2) {
        const double size = std::ldexp(1.0, -depth);
        const double u0 = corner % 2 ? 1 - size : 0, v0 = corner / 2 ? 1 - size : 0;
        const BernsteinNet sub = SubNet(net, u0, u0 + size, v0, v0 + size);
        Box3 box;
        int zeros = 0;
        for (const Vec4& p : sub.points) {
          if (p.w() == 0.0) {
            EXPECT_EQ(p, Vec4(Vec4::Zero()));
            ++zeros;
          } else {
            ASSERT_GT(p.w(), 0.0);
            box.Add(Vec3(p.head<3>() / p.w()));
          }
        }
        EXPECT_EQ(zeros, depth == 0 ? 4 : 1);
        for (int k = 0; k < 100; ++k) {
          const Vec3 s = Position(shape, u0 + size * random.Unit(), v0 + size * random.Unit());
          const double slack = 1e-12 * 20;
          EXPECT_TRUE((s.array() >= box.min.array() - slack).all() &&
                      (s.array() <= box.max.array() + slack).all());
        }
        if (depth >= 6 && depth <= 36) {
          EXPECT_NEAR(box.Diagonal() / previous, 0.25, 0.03) << depth;
        }
        previous = box.Diagonal();
      }
    }
  }
}

}  // namespace
}  // namespace patchmill
