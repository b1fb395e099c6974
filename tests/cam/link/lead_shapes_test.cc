#include "cam/link/lead_shapes.h"

#include <cmath>

#include <gtest/gtest.h>

namespace patchmill {
namespace {

CutterPath PassOf(const std::vector<Vec3>& centers) {
  CutterPath pass;
  for (const Vec3& c : centers) pass.points.push_back({c, std::nullopt, std::nullopt});
  return pass;
}

constexpr LeadParams kParams{.radius = 1.5};

// Directions of passes and normals of contacts, gentle, steep and aslant.
std::vector<LeadPlace> Places() {
  std::vector<LeadPlace> places;
  for (const Vec3& normal : {Vec3(0, 0, 1), Vec3(0, -1, 0), Vec3(0, -0.8, 0.6), Vec3(0.6, -0.48, 0.64)}) {
    for (const Vec3& along : {Vec3(1, 0, 0), Vec3(0.6, 0.8, 0), Vec3(0.8, 0, -0.6)}) {
      const Vec3 tangent = (along - along.dot(normal) * normal).normalized();
      places.push_back({Vec3(3, -4, 5), normal, tangent, IsSteep(normal)});
    }
  }
  return places;
}

TEST(LeadShapes, ArcsAreTangentToThePassAndRound) {
  constexpr double kSagitta = 1e-3;
  for (const LeadPlace& place : Places()) {
    const std::vector<LeadArc> arcs = LeadArcs(place, kParams, kSagitta);
    ASSERT_FALSE(arcs.empty());
    EXPECT_EQ(arcs.front().radius, kParams.radius);
    for (std::size_t i = 0; i < arcs.size(); ++i) {
      const LeadArc& arc = arcs[i];
      if (i > 0) {
        EXPECT_LE(arc.radius, arcs[i - 1].radius);
      }
      EXPECT_GE(arc.radius, kLeastLeadRadius);
      ASSERT_GE(arc.places.size(), 3u);
      EXPECT_EQ(arc.places.front(), place.center);
      // The centre of the circle through three places of the arc, which is a radius from all of them.
      const Vec3 &a = arc.places.front(), &b = arc.places[1], &c = arc.places.back();
      const Vec3 plane = (b - a).cross(c - a).normalized();
      const Vec3 to_center = plane.cross(place.outwards);
      const Vec3 center = a + (to_center.dot(c - a) > 0.0 ? 1.0 : -1.0) * arc.radius * to_center;
      double turned = 0.0;
      for (std::size_t k = 0; k < arc.places.size(); ++k) {
        EXPECT_NEAR((arc.places[k] - center).norm(), arc.radius, 1e-9);
        if (k == 0) continue;
        const double chord = (arc.places[k] - arc.places[k - 1]).norm();
        turned += 2.0 * std::asin(0.5 * chord / arc.radius);
        EXPECT_LE(arc.radius - std::sqrt(arc.radius * arc.radius - 0.25 * chord * chord), kSagitta);
      }
      EXPECT_NEAR(turned, arc.sweep, 1e-9);
      EXPECT_NEAR((center - a).dot(place.outwards), 0.0, 1e-9);
    }
  }
}

TEST(LeadShapes, ArcsBesideWallsAreLevelAndOffTheWallAboveFloorsTheyRise) {
  const LeadArc wall = LeadArcs({Vec3::Zero(), Vec3(0, -1, 0), Vec3(1, 0, 0), true}, kParams, 1e-3).front();
  for (const Vec3& place : wall.places) EXPECT_EQ(place.z(), 0.0);
  EXPECT_NEAR(wall.places.back().x(), kParams.radius, 1e-12);
  EXPECT_NEAR(wall.places.back().y(), -kParams.radius, 1e-12);
  const LeadArc floor = LeadArcs({Vec3::Zero(), Vec3(0, 0, 1), Vec3(1, 0, 0), false}, kParams, 1e-3).front();
  for (const Vec3& place : floor.places) EXPECT_EQ(place.y(), 0.0);
  EXPECT_NEAR(floor.places.back().z(), kParams.radius, 1e-12);
}

// The ramp comes down to the start of the pass over the pass, never below it, and by no more than its angle.
TEST(LeadShapes, RampsRunOverThePass) {
  constexpr double kHeight = 0.5;
  for (const double length : {0.8, 2.0, 2.9, 40.0}) {
    CutterPath pass;
    for (int k = 0; k <= 10; ++k)
      pass.points.push_back({Vec3(0.1 * length * k, 0.0, 0.02 * k), std::nullopt, std::nullopt});
    const double whole = Length(pass);
    const std::vector<Vec3> ramp = RampAlong(PassEnd::Start(pass), kParams, kHeight);
    ASSERT_FALSE(ramp.empty());
    EXPECT_EQ(ramp.back(), pass.points.front().center);
    const auto above = [&](const Vec3& p) { return p.z() - 0.2 * p.x() / length; };
    EXPECT_NEAR(above(ramp.front()), kHeight, 1e-9);
    for (std::size_t k = 1; k < ramp.size(); ++k) {
      EXPECT_GE(above(ramp[k]), -1e-12);
      const double down = above(ramp[k - 1]) - above(ramp[k]);
      const double along = whole / length * std::abs(ramp[k].x() - ramp[k - 1].x());
      EXPECT_LE(down, std::tan(kParams.ramp_angle) * along + 1e-12);
      EXPECT_LE(ramp[k].x(), length + 1e-12);
    }
  }
  EXPECT_TRUE(RampAlong(PassEnd::Start(PassOf({Vec3::Zero(), Vec3(0.1, 0, 0)})), kParams, kHeight).empty());
  EXPECT_TRUE(RampAlong(PassEnd::Start(PassOf({Vec3::Zero()})), kParams, kHeight).empty());
}

TEST(LeadShapes, PassEndsKnowTheirDirections) {
  CutterPath pass = PassOf({Vec3(0, 0, 0), Vec3(2, 0, 0), Vec3(2, 3, 0)});
  EXPECT_EQ(PassEnd::Start(pass).Along(), Vec3(1, 0, 0));
  EXPECT_EQ(PassEnd::End(pass).Along(), Vec3(0, 1, 0));
  EXPECT_EQ(PassEnd::End(pass).Inwards(4.0).back(), Vec3(1, 0, 0));
  pass.closed = true;
  EXPECT_EQ(PassEnd::End(pass).center(), Vec3(0, 0, 0));
  EXPECT_LT((PassEnd::End(pass).Along() - Vec3(-2, -3, 0).normalized()).norm(), 1e-12);
}

}  // namespace
}  // namespace patchmill
