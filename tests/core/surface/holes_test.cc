#include "core/surface/holes.h"

#include <gtest/gtest.h>

#include "core/base/status.h"
#include "tests/support/faced_turning.h"

namespace patchmill {
namespace {

using namespace testing;  // NOLINT: the support folder's

std::vector<Hole> HolesOf(PatchModel model, const Placement& placement = {}) {
  auto network = BuildNetwork(Place(placement, std::move(model)));
  PM_CHECK(network.ok());
  auto surface = BuildSurface(*std::move(network), SurfaceParams{}, RunContext());
  PM_CHECK(surface.ok());
  auto holes = FindHoles(*surface, RunContext());
  PM_CHECK(holes.ok());
  return *std::move(holes);
}

using Ends = std::array<HoleEnd, 2>;

TEST(FindHoles, AThroughHoleOfTwoHalves) {
  TurnedFace bore = Bore(3, 10, 0);
  bore.halves = true;
  const std::vector<Hole> holes =
      HolesOf(TurnedPart({Pin(20, 0, 10), Ring(20, 3, 10), bore, Ring(3, 20, 0)}));
  ASSERT_EQ(holes.size(), 1U);
  EXPECT_EQ(holes[0].faces, (std::vector<FaceId>{FaceId(2), FaceId(3)}));
  EXPECT_EQ(holes[0].diameter, 6.0);
  EXPECT_NEAR(holes[0].depth, 10.0, 1e-12);
  EXPECT_LT((holes[0].mouth - Vec3(0, 0, 10)).norm(), 1e-12);
  EXPECT_LT((holes[0].direction - Vec3(0, 0, -1)).norm(), 1e-12);
  EXPECT_EQ(holes[0].ends, (Ends{HoleEnd::kOpen, HoleEnd::kOpen}));
}

// Floors that are level, a drill's tip, half a ball, and rounded at their rim.
TEST(FindHoles, BlindHoles) {
  const TurnedFace tip{Line({3, 2}, {0, 0.2}), SurfaceKind::kCone};
  const TurnedFace ball{Round({3, 3}, {3, 0}, {0, 0}), SurfaceKind::kSphere, 3, true};
  const TurnedFace fillet{Round({3, 2}, {3, 1}, {2, 1}), SurfaceKind::kTorus, 1, true};
  for (const auto& [bottom, floor] : {std::pair(2.0, std::vector{Ring(3, 0, 2)}),
                                      {2.0, {tip}},
                                      {3.0, {ball}},
                                      {2.0, {fillet, Ring(2, 0, 1)}}}) {
    std::vector<TurnedFace> faces = {Ring(20, 3, 10), Bore(3, 10, bottom)};
    faces.insert(faces.end(), floor.begin(), floor.end());
    const std::vector<Hole> holes = HolesOf(TurnedPart(faces));
    ASSERT_EQ(holes.size(), 1U);
    EXPECT_NEAR(holes[0].depth, 10.0 - bottom, 1e-12);
    EXPECT_EQ(holes[0].ends, (Ends{HoleEnd::kOpen, HoleEnd::kFloor}));
  }
}

// Chamfered and rounded mouths are open.
TEST(FindHoles, MouthsWithChamfersAndRoundings) {
  const TurnedFace chamfer{Line({4, 10}, {3, 9}), SurfaceKind::kCone};
  const TurnedFace rounding{Round({4, 10}, {3, 10}, {3, 9}), SurfaceKind::kTorus, 1};
  for (const TurnedFace& mouth : {chamfer, rounding}) {
    const std::vector<Hole> holes =
        HolesOf(TurnedPart({Ring(20, 4, 10), mouth, Bore(3, 9, 0), Ring(3, 20, 0)}));
    ASSERT_EQ(holes.size(), 1U);
    EXPECT_NEAR(holes[0].depth, 9.0, 1e-12);
    EXPECT_EQ(holes[0].ends, (Ends{HoleEnd::kOpen, HoleEnd::kOpen}));
  }
}

TEST(FindHoles, ACounterboreEndsInAStep) {
  const std::vector<Hole> holes =
      HolesOf(TurnedPart({Ring(20, 5, 10), Bore(5, 10, 6), Ring(5, 3, 6), Bore(3, 6, 0), Ring(3, 20, 0)}));
  ASSERT_EQ(holes.size(), 2U);
  EXPECT_EQ(holes[0].diameter, 10.0);
  EXPECT_NEAR(holes[0].depth, 4.0, 1e-12);
  EXPECT_EQ(holes[0].ends, (Ends{HoleEnd::kOpen, HoleEnd::kStep}));
  EXPECT_EQ(holes[1].diameter, 6.0);
  EXPECT_NEAR(holes[1].depth, 6.0, 1e-12);
  EXPECT_EQ(holes[1].ends, (Ends{HoleEnd::kOpen, HoleEnd::kOpen}));
}

// A hole from below begins at its lower end.
TEST(FindHoles, HolesThatOpenElsewhere) {
  const PatchModel part = TurnedPart({Ring(0, 3, 8), Bore(3, 8, 0), Ring(3, 20, 0)});
  Placement placement;
  const std::vector<Hole> below = HolesOf(part, placement);
  ASSERT_EQ(below.size(), 1U);
  EXPECT_LT((below[0].mouth - Vec3(0, 0, 0)).norm(), 1e-12);
  EXPECT_LT((below[0].direction - Vec3(0, 0, 1)).norm(), 1e-12);
  placement.turn = Mat3(Eigen::AngleAxisd(0.7, Vec3(1, 2, 0.4).normalized()));
  placement.translation = Vec3(100, -20, 3);
  placement.scale = 2.0;
  const std::vector<Hole> moved = HolesOf(part, placement);
  ASSERT_EQ(moved.size(), 1U);
  EXPECT_NEAR(moved[0].diameter, 12.0, 1e-9);
  EXPECT_NEAR(moved[0].depth, 16.0, 1e-9);
  EXPECT_LT((moved[0].mouth - Place(placement, Vec3::Zero())).norm(), 1e-9);
  EXPECT_LT((moved[0].direction - *placement.turn * Vec3::UnitZ()).norm(), 1e-9);
  EXPECT_EQ(moved[0].ends, (Ends{HoleEnd::kOpen, HoleEnd::kFloor}));
}

// A cylinder that a reader could not name is a hole, too, if it is one.
TEST(FindHoles, SplineFacesThatAreCylinders) {
  TurnedFace bore = Bore(3, 10, 0);
  bore.kind = SurfaceKind::kSpline;
  bore.radius = 0.0;
  bore.hollow = false;
  const std::vector<Hole> holes = HolesOf(TurnedPart({Ring(20, 3, 10), bore, Ring(3, 20, 0)}));
  ASSERT_EQ(holes.size(), 1U);
  EXPECT_NEAR(holes[0].diameter, 6.0, 1e-9);
  TurnedFace taper = bore;
  taper.profile = Line({3.1, 10}, {3, 0});
  EXPECT_TRUE(HolesOf(TurnedPart({Ring(20, 3.1, 10), taper, Ring(3, 20, 0)})).empty());
}

TEST(FindHoles, PinsAndPartsOfATurnAreNone) {
  EXPECT_TRUE(HolesOf(TurnedPart({Ring(20, 3, 0), Pin(3, 0, 10), Ring(3, 0, 10)})).empty());
  PatchModel slot = TurnedPart({Bore(3, 10, 0)});
  slot.patches.pop_back();
  EXPECT_TRUE(HolesOf(slot).empty());
  EXPECT_EQ(HolesOf(TurnedPart({Bore(3, 10, 0)})).size(), 1U);
}

}  // namespace
}  // namespace patchmill
