// The user's control points of a G2-Gregory patch: the vector of [editing, section 3] and what it promises.
#include "core/editing/section_points.h"

#include <gtest/gtest.h>

#include "tests/support/json.h"

namespace patchmill {
namespace {

using testing::Json;

struct Vector {
  const Json data = testing::LoadJson(PATCHMILL_SOURCE_DIR "/tests/vectors/g2gregory_patch.json");
  G2GregoryPatch patch;
  Vector() {
    patch.degree = 6;
    for (int i = 0; i < 7; ++i) {
      for (int j = 0; j < 7; ++j) patch.points.push_back(data["P0"][i][j].Vector());
    }
    for (const int i : {1, 2, 4, 5}) {
      for (const int j : {1, 2, 4, 5}) patch.points.push_back(data["P1"][i][j].Vector());
    }
  }
};

TEST(SectionPoints, AreTheQuinticOfTheVector) {
  const Vector v;
  const SectionPoints low = SectionPointsOf(AcrossMiddle(v.patch, 0)),
                      high = SectionPointsOf(AcrossMiddle(v.patch, 2));
  const Vec3 made[6] = {low.q0, low.q1, low.q2, high.q2, high.q1, high.q0};
  for (int k = 0; k < 6; ++k) EXPECT_LE((made[k] - v.data["quintic_Q"][k].Vector()).norm(), 1e-12) << k;
  const MiddleCross back = CrossOf(low);
  EXPECT_LE((back.first - v.data["quintic_T"].Vector()).norm(), 1e-12);
  EXPECT_LE((back.second - v.data["quintic_C"].Vector()).norm(), 1e-11);
  EXPECT_LE((SectionCurvature(back.first, back.second) - v.data["quintic_kvec"].Vector()).norm(), 1e-12);
}

TEST(SectionPoints, PrescribedCurvatureMovesQ2AsTheVectorSays) {
  const Vector v;
  const MiddleCross cross = AcrossMiddle(v.patch, 0);
  const Vec3 bend = SectionCurvature(cross.first, cross.second);
  const double sign = bend.dot(cross.normal) < 0 ? -1 : 1, wanted = sign * v.data["kappa_new"].Number();
  MiddleCross bent = cross;
  bent.second = SecondForCurvature(cross, wanted);
  EXPECT_LE((SectionPointsOf(bent).q2 - v.data["Q2_new"].Vector()).norm(), 1e-12);
  const Vec3 made = SectionCurvature(bent.first, bent.second);
  EXPECT_LE((made - bend.normalized() * std::abs(wanted)).norm(), 1e-13);
  // None at all: the three points in line.
  bent.second = SecondForCurvature(cross, 0.0);
  const SectionPoints q = SectionPointsOf(bent);
  EXPECT_LE((q.q2 - 2 * q.q1 + q.q0).norm(), 1e-15);
  // From a straight section: along the normal.
  const Vec3 second = SecondForCurvature(bent, -0.25);
  EXPECT_LE((SectionCurvature(bent.first, second) + 0.25 * cross.normal).norm(), 1e-10);
}

// Every side, against a one-sided difference of the section.
TEST(SectionPoints, TheQuinticFollowsTheSectionToSecondOrder) {
  const Vector v;
  const Vec2 foot[4] = {{0.5, 0}, {1, 0.5}, {0.5, 1}, {0, 0.5}}, in[4] = {{0, 1}, {-1, 0}, {0, -1}, {1, 0}};
  for (int side = 0; side < 4; ++side) {
    const SectionPoints q = SectionPointsOf(AcrossMiddle(v.patch, side));
    double last = 0.0;
    for (const double t : {0.02, 0.01}) {
      const Vec2 at = foot[side] + t * in[side];
      const double s = 1 - t;  // the first three terms; the others are of third order
      const Vec3 quintic = q.q0 * (s * s * s * s * s) + 5 * s * s * s * s * t * q.q1 +
                           10 * s * s * s * t * t * q.q2 +
                           (1 - s * s * s * s * s - 5 * s * s * s * s * t - 10 * s * s * s * t * t) * q.q2;
      const double error = (Position(v.patch, at.x(), at.y()) - quintic).norm();
      if (last > 0.0) {
        EXPECT_NEAR(last / error, 8.0, 1.0) << side;
      }
      last = error;
    }
  }
}

}  // namespace
}  // namespace patchmill
