#include "core/surface/concave_radius.h"

#include <cmath>

#include <gtest/gtest.h>

#include "core/base/status.h"
#include "tests/support/faced_turning.h"
#include "tests/support/shapes.h"

namespace patchmill {
namespace {

using namespace testing;  // NOLINT: the support folder's

Surface Build(PatchModel model) {
  const RunContext run;
  auto network = BuildNetwork(std::move(model));
  PM_CHECK(network.ok());
  auto surface = BuildSurface(*std::move(network), SurfaceParams{}, run);
  PM_CHECK(surface.ok());
  return *std::move(surface);
}

ConcaveSpot Smallest(PatchModel model) {
  auto spot = SmallestConcaveRadius(Build(std::move(model)), RunContext());
  PM_CHECK(spot.ok());
  return *spot;
}

std::vector<double> OfFaces(PatchModel model) {
  auto spots = ConcaveRadiiOfFaces(Build(std::move(model)), RunContext());
  PM_CHECK(spots.ok());
  std::vector<double> radii;
  for (const ConcaveSpot& spot : *spots) radii.push_back(spot.radius);
  return radii;
}

TEST(SmallestConcaveRadius, MatchesClosedForms) {
  EXPECT_NEAR(Smallest(Paraboloid(0.05, 10)).radius, 1 / (2 * 0.05), 0.02);
  const ConcaveSpot valley = Smallest(ParabolicValley(0.1, 10));
  EXPECT_NEAR(valley.radius, 5.0, 0.01);
  EXPECT_NEAR(valley.at.p.x(), 0.0, 0.3);
  EXPECT_EQ(Smallest(Sphere(Vec3::Zero(), 10, Half::kUpper)).radius, kInfinity);
  EXPECT_EQ(Smallest(Plane(10)).radius, kInfinity);
}

// A pocket with an upright round wall is as tight as its wall.
TEST(SmallestConcaveRadius, CountsUprightWallsWhoseAirSideIsKnown) {
  const PatchModel pocket = TurnedPart({Ring(20, 4, 10), Bore(4, 10, 2), Ring(4, 0, 2)});
  EXPECT_NEAR(Smallest(pocket).radius, 4.0, 1e-9);
  const PatchModel pin = TurnedPart({Ring(20, 4, 2), Pin(4, 2, 10), Ring(4, 0, 10)});
  EXPECT_EQ(Smallest(pin).radius, kInfinity);
}

// Far from the origin and turned, the points of a plane round off. A plane stays one, whatever rounding adds.
TEST(SmallestConcaveRadius, RoundingIsNoCurvature) {
  for (const double place : {0.0, 1e3, 1e6}) {
    PatchModel plane;
    const Mat3 turn = Eigen::AngleAxisd(0.3, Vec3(1, 2, 0.5).normalized()).toRotationMatrix();
    BezierPatch patch;
    patch.degree_u = patch.degree_v = 3;
    for (int i = 0; i <= 3; ++i) {
      for (int j = 0; j <= 3; ++j)
        patch.points.push_back(Vec3::Constant(place) + turn * Vec3(i * i + i, 0.3 * j * j + j, 0));
    }
    plane.patches.push_back({"", patch});
    EXPECT_EQ(Smallest(plane).radius, kInfinity) << place;
  }
}

// Beside a pole of a dome, and at the tip of a needle, parameters say nothing about the shape.
TEST(ConcaveRadiiOfFaces, PolesAndNeedlesAreNotConcave) {
  // A ball: its faces look outwards.
  const TurnedFace lower{Round({0, -5}, {5, -5}, {5, 0}), SurfaceKind::kSphere, 5};
  const TurnedFace upper{Round({5, 0}, {5, 5}, {0, 5}), SurfaceKind::kSphere, 5};
  EXPECT_EQ(OfFaces(TurnedPart({lower, upper})), (std::vector<double>{kInfinity, kInfinity}));
  // A level triangle as a quad whose side is 1e-12 mm long.
  PatchModel needle = TurnedPart({Ring(5, 1e-12, 0)});
  EXPECT_EQ(OfFaces(needle), std::vector<double>{kInfinity});
}

TEST(ConcaveRadiiOfFaces, MatchClosedForms) {
  // A bowl of radius 7, a fillet of radius 1.5 around the foot of a pin, a hole, and the mouth of a hole with
  // a rounding of radius 2: its throat has radius 4 - 2 across, 4 around.
  const TurnedFace bowl{Round({7, 0}, {7, -7}, {0, -7}), SurfaceKind::kSphere, 7, true};
  EXPECT_NEAR(OfFaces(TurnedPart({bowl}))[0], 7.0, 1e-6);
  const TurnedFace fillet{Round({6.5, 0}, {5, 0}, {5, 1.5}), SurfaceKind::kTorus, 1.5, true};
  EXPECT_NEAR(OfFaces(TurnedPart({fillet}))[0], 1.5, 1e-6);
  EXPECT_NEAR(OfFaces(TurnedPart({Bore(3, 5, 0)}))[0], 3.0, 1e-9);
  const TurnedFace mouth{Round({6, 10}, {4, 10}, {4, 8}), SurfaceKind::kTorus, 2};
  EXPECT_NEAR(OfFaces(TurnedPart({mouth}))[0], 4.0, 1e-3);
  EXPECT_EQ(OfFaces(TurnedPart({Pin(3, 0, 5)}))[0], kInfinity);
}

}  // namespace
}  // namespace patchmill
