// Neighbouring lines leave the scallop between them, on convex and concave surfaces.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "cam/path/parallel/zigzag_paths.h"
#include "tests/support/joined_surface.h"
#include "tests/support/shapes.h"

namespace patchmill {
namespace {

using namespace testing;  // NOLINT: the support folder's

constexpr double kR = 3.0, kScallop = 0.002;

// Lines along the axis of a cylinder that rises (convex) or is hollow (concave): their centres lie on a
// circle about it, and the crest between two stands on the cylinder half way between them.
std::vector<double> PairLeftovers(double rho, bool convex) {
  Eigen::Affine3d turn = Eigen::Affine3d::Identity();
  if (!convex) turn.rotate(Eigen::AngleAxisd(kPi, Vec3::UnitY()));
  const Surface surface = JoinedSurface(Transformed(Cylinder(Vec3::Zero(), rho, 4.0, Half::kUpper), turn));
  const Locator locator(surface, kR);
  ZigzagParams params;
  params.pass.scallop = kScallop;
  params.pass.chord_tolerance = 1e-4;
  params.angle = kPi / 2.0;
  params.pass.window.max = Radians(45);
  const auto paths = ZigzagPaths(locator, params, RunContext(2));
  EXPECT_TRUE(paths.ok()) << paths.status();
  const double circle = convex ? rho + kR : rho - kR;
  std::vector<double> angles;
  for (const CutterPath& path : *paths) {
    const Vec3& c = path.points.front().center;
    if (std::abs(std::hypot(c.x(), c.z()) - circle) > 0.01) continue;  // over the rims of the hollow
    angles.push_back(std::atan2(c.x(), std::abs(c.z())));
  }
  std::sort(angles.begin(), angles.end());
  std::vector<double> left;
  for (std::size_t i = 0; i + 1 < angles.size(); ++i) {
    const double half = 0.5 * (angles[i + 1] - angles[i]);
    // Where the balls cross in the plane half way: a distance from the axis, and from it to the cylinder.
    const double along = circle * std::cos(half), beside = circle * std::sin(half);
    const double reach = std::sqrt(kR * kR - beside * beside);
    left.push_back(convex ? along - reach - rho : rho - along - reach);
  }
  return left;
}

class Pairs : public ::testing::TestWithParam<std::pair<double, bool>> {};

TEST_P(Pairs, LeaveTheScallop) {
  const auto [times, convex] = GetParam();
  const std::vector<double> left = PairLeftovers(times * kR, convex);
  ASSERT_GT(left.size(), 10u);
  const double worst = *std::max_element(left.begin(), left.end());
  EXPECT_LE(worst, 1.05 * kScallop);
  // Equal gaps: a whole number of them goes into the way, so each is up to a gap's share shorter.
  const double share = 1.0 - 1.0 / static_cast<double>(left.size());
  EXPECT_GE(worst, 0.95 * share * share * kScallop);
}

INSTANTIATE_TEST_SUITE_P(Radii, Pairs,
                         ::testing::Values(std::pair{1.25, false}, std::pair{1.5, false},
                                           std::pair{2.0, false}, std::pair{4.0, false},
                                           std::pair{20.0, false}, std::pair{1.25, true},
                                           std::pair{2.0, true}, std::pair{4.0, true},
                                           std::pair{20.0, true}));

}  // namespace
}  // namespace patchmill
