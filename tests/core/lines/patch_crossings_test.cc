// Curves in which patches cross: circles in closed form, touches, neighbours, names.
#include "core/lines/patch_crossings.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/shapes.h"
#include "tests/support/surface_of.h"

namespace patchmill {
namespace {

using ::testing::HasSubstr;

Patch Plane(const std::string& id, const Vec3& corner, const Vec3& along, const Vec3& up) {
  return {id, BezierPatch{1, 1, {corner, corner + up, corner + along, corner + along + up}, {}}};
}
PatchModel Ball(const Vec3& center, double radius) { return testing::Sphere(center, radius); }
void Append(PatchModel& to, const PatchModel& from) {
  to.patches.insert(to.patches.end(), from.patches.begin(), from.patches.end());
}
// With its topology, so that neighbours are known.
Surface Joined(const PatchModel& model) {
  auto network = BuildNetwork(model);
  EXPECT_TRUE(network.ok()) << network.status();
  auto surface = BuildSurface(*std::move(network), {}, RunContext(1));
  EXPECT_TRUE(surface.ok()) << surface.status();
  return *std::move(surface);
}
Crossings3d Found(const Surface& surface, double tolerance = 1e-3) {
  auto found = FindPatchCrossings(surface, {.tolerance = tolerance}, RunContext());
  EXPECT_TRUE(found.ok()) << found.status();
  return *std::move(found);
}
double Length(const Crossings3d& found) {
  double length = 0.0;
  for (const PatchCrossing& pair : found.pairs) length += pair.length;
  return length;
}

TEST(PatchCrossings, APlaneCutsASphereInOneClosedCircle) {
  PatchModel model = Ball(Vec3::Zero(), 10);
  model.patches.push_back(Plane("table", Vec3(-20, -21, 3), Vec3(40, 0, 0), Vec3(0, 43, 0)));
  const Surface surface = Joined(model);
  const Crossings3d found = Found(surface);
  ASSERT_EQ(found.curves.size(), 1u);
  EXPECT_TRUE(found.curves[0].closed);
  const double radius = std::sqrt(91.0);
  for (const SurfacePoint& at : found.curves[0].points) {
    EXPECT_NEAR(at.p.z(), 3.0, kCrossingGap);
    EXPECT_NEAR(Xy(at.p).norm(), radius, kCrossingGap);
    EXPECT_LE((Evaluate(surface, at.piece, at.u, at.v).p - at.p).norm(), kCrossingGap);
  }
  // Chords keep 1e-3 of the circle: the length is short by at most (8/3) 1e-3 / radius of itself.
  EXPECT_NEAR(Length(found), 2 * kPi * radius, 2 * kPi * radius * 1e-3);
  EXPECT_TRUE(found.complete);
}

TEST(PatchCrossings, TwoSpheresCrossInACircle) {
  PatchModel model = Ball(Vec3::Zero(), 10);
  Append(model, Ball(Vec3(0.3, 12, 0.2), 7));
  const Vec3 axis = Vec3(0.3, 12, 0.2);
  const double d = axis.norm(), at = (d * d + 100 - 49) / (2 * d), radius = std::sqrt(100 - at * at);
  const Crossings3d found = Found(Joined(model));
  ASSERT_EQ(found.curves.size(), 1u);
  EXPECT_TRUE(found.curves[0].closed);
  for (const SurfacePoint& p : found.curves[0].points) {
    EXPECT_NEAR(p.p.norm(), 10.0, kCrossingGap);
    EXPECT_NEAR((p.p - axis).norm(), 7.0, kCrossingGap);
  }
  EXPECT_NEAR(Length(found), 2 * kPi * radius, 2 * kPi * radius * 1e-3);
}

TEST(PatchCrossings, NeighboursAndTouchesAreNone) {
  EXPECT_TRUE(Found(Joined(Ball(Vec3::Zero(), 10))).pairs.empty());
  // A wall that stands on a floor, and a ball that lies on it.
  PatchModel model;
  model.patches = {Plane("floor", Vec3(0, 0, 0), Vec3(40, 0, 0), Vec3(0, 40, 0)),
                   Plane("wall", Vec3(10, 5, 0), Vec3(0, 20, 0), Vec3(0, 0, 10))};
  Append(model, Ball(Vec3(25, 20, 6), 6));
  EXPECT_TRUE(Found(Joined(model)).pairs.empty());
}

TEST(PatchCrossings, AWallThroughAFloorIsALineWithEnds) {
  PatchModel model;
  model.patches = {Plane("floor", Vec3(0, 0, 0), Vec3(40, 0, 0), Vec3(0, 40, 0)),
                   Plane("wall", Vec3(10, 5, -3), Vec3(0, 20, 0), Vec3(0, 0, 10))};
  const Surface surface = Joined(model);
  const Crossings3d found = Found(surface);
  ASSERT_EQ(found.curves.size(), 1u);
  EXPECT_FALSE(found.curves[0].closed);
  EXPECT_NEAR(Length(found), 20.0, 1e-6);
  const Diagnostics findings = CrossingFindings(surface, found);
  ASSERT_EQ(findings.size(), 1u);
  EXPECT_EQ(findings[0].code, "PATCHES_CROSS");
  EXPECT_THAT(findings[0].message, HasSubstr("patch 0 (floor) and patch 1 (wall) cross along 20 mm"));
}

// Parts with straight walls: edges of the search's cells meet edges and corners of the other patch's cells.
TEST(PatchCrossings, WallsThatPassAlongLinesOfTheFloorAreFound) {
  const Patch floor = Plane("floor", Vec3(0, 0, 0), Vec3(40, 0, 0), Vec3(0, 40, 0));
  for (const double at : {5.0, 10.0, 20.0, 30.0}) {
    for (const double low : {-4.0, -8.0, -2.0}) {
      PatchModel model;
      model.patches = {floor, Plane("wall", Vec3(at, 10, low), Vec3(0, 20, 0), Vec3(0, 0, 8.5))};
      EXPECT_NEAR(Length(Found(Joined(model))), 20.0, 1e-6) << at << " " << low;
      model.patches[1] = Plane("wall", Vec3(10, at, low), Vec3(0, 0, 8.5), Vec3(20, 0, 0));
      EXPECT_NEAR(Length(Found(Joined(model))), 20.0, 1e-6) << at << " " << low;
    }
  }
  PatchModel diagonal;
  diagonal.patches = {floor, Plane("wall", Vec3(40, 0, -4), Vec3(-40, 40, 0), Vec3(0, 0, 8))};
  EXPECT_NEAR(Length(Found(Joined(diagonal))), 40.0 * std::sqrt(2.0), 1e-6);
}

// A part cut by its plane of symmetry: the curves run along borders of patches and of their pieces.
TEST(PatchCrossings, CurvesAlongSharedEdgesAreFoundOnce) {
  const auto cut = [](PatchModel model, const Vec3& corner, const Vec3& u, const Vec3& v) {
    model.patches.push_back(Plane("cut", corner, u, v));
    return Found(Joined(model), 1e-4);
  };
  for (const bool level : {true, false}) {
    const Vec3 corner = level ? Vec3(-30, -31, 0) : Vec3(-30, 0, -31);
    const Vec3 v = level ? Vec3(0, 63, 0) : Vec3(0, 0, 63);
    const Crossings3d ball = cut(Ball(Vec3::Zero(), 10), corner, Vec3(60, 0, 0), v);
    ASSERT_EQ(ball.curves.size(), 1u);
    EXPECT_TRUE(ball.curves[0].closed);
    EXPECT_NEAR(Length(ball), 20 * kPi, 0.01);
    const Crossings3d ring = cut(testing::Torus(Vec3::Zero(), 10, 3), corner, Vec3(60, 0, 0), v);
    ASSERT_EQ(ring.curves.size(), 2u);
    EXPECT_TRUE(ring.curves[0].closed && ring.curves[1].closed);
    EXPECT_NEAR(Length(ring), level ? 2 * kPi * (13 + 7) : 2 * 2 * kPi * 3, 0.02);
  }
}

TEST(PatchCrossings, PatchesThatShareAnEdgeMayCrossElsewhere) {
  PatchModel model;
  model.patches = {Plane("floor", Vec3(0, 0, 0), Vec3(10, 0, 0), Vec3(0, 10, 0)), {}};
  // Leaves the edge x = 0 upwards and comes down through the floor at x = 20/3.
  model.patches[1] = {"fold", BezierPatch{2,
                                          1,
                                          {Vec3(0, 0, 0), Vec3(0, 10, 0), Vec3(5, 0, 10), Vec3(5, 10, 10),
                                           Vec3(10, 0, -10), Vec3(10, 10, -10)},
                                          {}}};
  const Crossings3d found = Found(Joined(model));
  ASSERT_EQ(found.curves.size(), 1u);
  EXPECT_NEAR(Length(found), 10.0, 1e-6);
  for (const SurfacePoint& at : found.curves[0].points) EXPECT_NEAR(at.p.x(), 20.0 / 3, 1e-6);
}

TEST(PatchCrossings, BodiesAreNamedOnce) {
  PatchModel model = Ball(Vec3::Zero(), 10);
  const std::size_t first = model.patches.size();
  Append(model, Ball(Vec3(0, 12, 0), 7));
  model.faces.resize(2);
  model.faces[0].id = "f1", model.faces[0].body = "core";
  model.faces[1].id = "f2", model.faces[1].body = "insert";
  for (std::size_t k = 0; k < model.patches.size(); ++k) model.patches[k].face = FaceId{k < first ? 0 : 1};
  const Surface surface = Joined(model);
  const Diagnostics findings = CrossingFindings(surface, Found(surface));
  ASSERT_EQ(findings.size(), 1u);
  EXPECT_EQ(findings[0].code, "BODIES_CROSS");
  EXPECT_THAT(findings[0].message, HasSubstr("body core and body insert"));
}

TEST(PatchCrossings, ChordsKeepTheTolerance) {
  PatchModel model = Ball(Vec3::Zero(), 10);
  model.patches.push_back(Plane("", Vec3(-20, -20, 3), Vec3(40, 0, 0), Vec3(0, 40, 0)));
  const Surface surface = Joined(model);
  for (const double tolerance : {0.1, 1e-5}) {
    const Crossings3d found = Found(surface, tolerance);
    ASSERT_EQ(found.curves.size(), 1u);
    const auto& points = found.curves[0].points;
    for (std::size_t k = 0; k < points.size(); ++k) {
      const Vec3 middle = 0.5 * (points[k].p + points[(k + 1) % points.size()].p);
      EXPECT_LE(std::sqrt(91.0) - Xy(middle).norm(), tolerance + 1e-6);
    }
  }
}

TEST(PatchCrossings, EndWhenTheyAreCancelled) {
  const Surface surface = Joined(Ball(Vec3::Zero(), 10));
  RunContext run;
  run.Cancel();
  EXPECT_EQ(FindPatchCrossings(surface, {}, run).status().code(), absl::StatusCode::kCancelled);
}

}  // namespace
}  // namespace patchmill
