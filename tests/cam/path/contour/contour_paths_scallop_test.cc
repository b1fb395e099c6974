// One finish number on walls: what neighbouring levels leave is the scallop, also where the step differs
// around a level.
#include <cmath>

#include <gtest/gtest.h>

#include "cam/path/contour/contour_paths.h"
#include "cam/path/stepover/step_over.h"
#include "core/diffgeo/forms.h"
#include "tests/support/joined_surface.h"
#include "tests/support/leftover.h"
#include "tests/support/random.h"
#include "tests/support/shapes.h"

namespace patchmill {
namespace {

using namespace testing;  // NOLINT: the support folder's

constexpr double kRadius = 3.0, kScallop = 0.02;

ContourParams WallParams() {
  ContourParams params;
  params.pass.scallop = kScallop;
  params.pass.chord_tolerance = 5e-4;
  params.pass.window = {Radians(40), Radians(90)};
  return params;
}

// The worst leftover where the slope is within the levels' window by 5 degrees.
double WorstLeftover(const Surface& surface, const std::vector<CutterPath>& paths) {
  const DistanceToPaths distance(paths);
  Random random(3);
  double worst = 0.0;
  for (int k = 0; k < 30000; ++k) {
    const PieceId piece(random.Int(static_cast<int>(surface.pieces.size())));
    const SurfaceJet jet = Evaluate(surface, piece, random.Uniform(0, 1), random.Uniform(0, 1));
    const auto e = UpwardNormal(jet);
    if (!e || e->z() > std::cos(Radians(45)) || e->z() < std::cos(Radians(85))) continue;
    worst = std::max(worst, distance.At(jet.p, kRadius + 1.0) - kRadius);
  }
  return worst;
}

std::vector<CutterPath> Levels(const Surface& surface) {
  const Locator locator(surface, kRadius);
  const auto contours = ContourPaths(locator, WallParams(), RunContext(2));
  EXPECT_TRUE(contours.ok()) << contours.status();
  return contours->paths;
}

TEST(LevelSteps, OfADomeAreAsWideAsItsCurvatureAllows) {
  const double rho = 12.0, c = rho + kRadius;
  const Surface surface = JoinedSurface(Sphere(Vec3::Zero(), rho, Half::kUpper));
  const auto paths = Levels(surface);
  const double worst = WorstLeftover(surface, paths);
  EXPECT_LE(worst, 1.05 * kScallop);
  EXPECT_GE(worst, 0.85 * kScallop);
  // No more than two levels above the area of the centres over the step.
  const double least = 2.0 * kPi * c * c * std::cos(Radians(40)) / CenterStep(kRadius, kScallop, -1.0 / rho);
  EXPECT_LE(TotalLength(paths), least + 2.0 * 2.0 * kPi * c);
}

TEST(LevelSteps, LeaveTheScallopWhereTheyDifferAroundALevel) {
  // 24 mm and 10 mm long half axes: the ends bend five times as much as the sides.
  Eigen::Affine3d stretch = Eigen::Affine3d::Identity();
  stretch.scale(Vec3(24.0, 10.0, 12.0));
  const Surface surface = JoinedSurface(Transformed(Sphere(Vec3::Zero(), 1.0, Half::kUpper), stretch));
  const auto paths = Levels(surface);
  const double worst = WorstLeftover(surface, paths);
  EXPECT_LE(worst, 1.06 * kScallop);
  EXPECT_GE(worst, 0.85 * kScallop);
}

}  // namespace
}  // namespace patchmill
