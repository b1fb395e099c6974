#include "cam/link/leads.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "tests/support/shapes.h"
#include "tests/support/surface_of.h"

namespace patchmill {
namespace {

constexpr double kRadius = 3.0;

LinkParams Params() {
  LinkParams p;
  p.radius = kRadius;
  p.clearance_z = 40;
  p.stock_top_z = 30;
  p.feed = 1200;
  p.plunge_feed = 400;
  p.pass.chord_tolerance = 0.005;
  p.lead.radius = 0.5 * kRadius;
  return p;
}

// A pass along the x axis, at the height of the ball's centre.
CutterPath Along(const Locator& locator, const Vec2& a, const Vec2& b) {
  CutterPath pass;
  const int n = 2 + static_cast<int>((b - a).norm());
  for (int i = 0; i <= n; ++i) {
    const Vec2 q = a + (b - a) * i / n;
    const auto h = locator.Height(q);
    if (h) pass.points.push_back({Lift(q, h->z), h->contact, std::nullopt});
  }
  return pass;
}

// The angle between the last move of the lead and the pass as lines, rad.
double AngleAtStart(const Lead& lead, const CutterPath& pass) {
  const Vec3 last = (lead.places.back() - lead.places[lead.places.size() - 2]).normalized();
  return std::acos(std::min(1.0, std::abs(last.dot(PassEnd::Start(pass).Along()))));
}

struct Setting {
  explicit Setting(const PatchModel& model)
      : surface(testing::SurfaceOf(model)), locator(surface, kRadius), stock(surface, kRadius + 1.5) {}
  Surface surface;
  Locator locator, stock;
  LinkParams params = Params();
};

// Nothing of the lead gouges by more than its tolerance, measured by distances to the surface.
void ExpectFree(const Setting& setting, const Lead& lead) {
  const Locator ball(setting.surface, kRadius - 0.01);
  for (std::size_t k = 1; k < lead.places.size(); ++k) {
    for (int i = 0; i <= 20; ++i)
      EXPECT_TRUE(ball.Free(lead.places[k - 1] + i / 20.0 * (lead.places[k] - lead.places[k - 1]), 1e-9));
  }
}

TEST(Leads, OnAFloorAnArcComesDownOntoThePass) {
  const Setting setting(testing::Plane(30));
  const MoveCheck check(setting.locator, setting.stock, setting.params);
  const CutterPath pass = Along(setting.locator, {-10, 0}, {10, 0});
  const Lead lead = FindLead(check, PassEnd::Start(pass));
  EXPECT_EQ(lead.kind, LeadKind::kArc);
  EXPECT_EQ(lead.radius, setting.params.lead.radius);
  EXPECT_LT(AngleAtStart(lead, pass), Radians(10.0));
  EXPECT_GT(lead.places.front().z(), kRadius + 1.0);
  ExpectFree(setting, lead);
}

// The pass begins in the corner between floor and wall: there is no room before it, so the ball comes onto it
// a little further in.
TEST(Leads, InACornerTheBallGoesBackToTheStart) {
  const Setting setting(testing::Block(6, 20, 30));
  const MoveCheck check(setting.locator, setting.stock, setting.params);
  const CutterPath pass = Along(setting.locator, {6.0 + kRadius + 1e-6, 0}, {25, 0});
  const Lead lead = FindLead(check, PassEnd::Start(pass));
  EXPECT_EQ(lead.kind, LeadKind::kBack);
  EXPECT_EQ(lead.radius, setting.params.lead.radius);
  EXPECT_EQ(lead.places.back(), pass.points.front().center);
  EXPECT_LT(AngleAtStart(lead, pass), Radians(10.0));
  ExpectFree(setting, lead);
}

// In a slot hardly wider than the ball there is no room for arcs beside the walls.
TEST(Leads, InASlotThePassIsEnteredAlongItself) {
  PatchModel slot;
  for (const double side : {-1.0, 1.0}) {
    const double y = side * (kRadius + 0.05);
    slot = testing::Join(
        {slot, testing::Single(testing::Bilinear({-20, y, 0}, {20, y, 0}, {-20, y, 25}, {20, y, 25}))});
  }
  slot = testing::Join({slot, testing::Plane(20)});
  const Setting setting(slot);
  const MoveCheck check(setting.locator, setting.stock, setting.params);
  const CutterPath pass = Along(setting.locator, {-15, 0}, {15, 0});
  ASSERT_GE(pass.points.size(), 2u);
  const Lead lead = FindLead(check, PassEnd::Start(pass));
  EXPECT_NE(lead.kind, LeadKind::kStraight);
  EXPECT_LT(AngleAtStart(lead, pass), Radians(10.0));
  ExpectFree(setting, lead);
}

// The pass ends on its way down a slope, just above the floor: an arc that goes on down would cross it.
TEST(Leads, StayAboveTheFloor) {
  Setting setting(testing::Plane(30, 0.0, 0.5, 0.0));
  CutterPath pass = Along(setting.locator, {10, 0}, {-10, 0});
  const double end = pass.points.back().center.z();
  setting.params.pass.floor_z = end - kRadius - 0.05;
  const MoveCheck check(setting.locator, setting.stock, setting.params);
  const Lead lead = FindLead(check, PassEnd::End(pass));
  for (const Vec3& place : lead.places) EXPECT_GE(place.z(), end - 0.05 - 1e-6);
  setting.params.pass.floor_z = -kInfinity;
  double lowest = kInfinity;
  for (const Vec3& place : FindLead(check, PassEnd::End(pass)).places) lowest = std::min(lowest, place.z());
  EXPECT_LT(lowest, end - 0.05);
}

TEST(Leads, RadiusAndSweepAreThoseOfTheParameters) {
  Setting setting(testing::Plane(30));
  setting.params.lead = {.radius = 4.0, .sweep = Radians(40.0)};
  const MoveCheck check(setting.locator, setting.stock, setting.params);
  const CutterPath pass = Along(setting.locator, {-10, 0}, {10, 0});
  const Lead lead = FindLead(check, PassEnd::Start(pass));
  EXPECT_EQ(lead.radius, 4.0);
  const Vec3 &outer = lead.places.front(), &start = pass.points.front().center;
  EXPECT_NEAR(start.x() - outer.x(), 4.0 * std::sin(Radians(40.0)), 1e-9);
  EXPECT_NEAR(outer.z() - start.z(), 4.0 * (1.0 - std::cos(Radians(40.0))), 1e-9);
}

}  // namespace
}  // namespace patchmill
