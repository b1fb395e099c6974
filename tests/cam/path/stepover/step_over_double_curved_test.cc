// Every two neighbouring lines or levels leave the scallop between them on double-curved surfaces, convex
// and concave, from a radius of 1.25 R upward.
#include <algorithm>
#include <cmath>
#include <ostream>
#include <set>

#include <gtest/gtest.h>

#include "cam/path/chord/chord_thinning.h"
#include "cam/path/contour/contour_paths.h"
#include "cam/path/parallel/zigzag_paths.h"
#include "cam/path/stepover/step_over.h"
#include "tests/support/joined_surface.h"
#include "tests/support/pair_crests.h"
#include "tests/support/shapes.h"

namespace patchmill {
namespace {

using namespace testing;  // NOLINT: the support folder's

constexpr double kR = 3.0, kScallop = 0.005;

// As jobs set it, here under a tolerance as wide as the scallop.
template <typename Params>
void SetFinish(Params& params, double scallop) {
  params.pass.scallop = scallop;
  params.pass.chord_tolerance = 0.5 * scallop;
  params.pass = WithFineChords(params.pass);
}

PatchModel Moved(PatchModel model, const Eigen::Affine3d& motion) {
  return Transformed(std::move(model), motion);
}
PatchModel UpsideDown(PatchModel model) {
  return Moved(std::move(model), Eigen::Affine3d(Eigen::AngleAxisd(kPi, Vec3::UnitY())));
}
PatchModel Ellipsoid(const Vec3& axes) {
  return Moved(Sphere(Vec3::Zero(), 1.0, Half::kUpper), Eigen::Affine3d(Eigen::Scaling(axes)));
}
PatchModel Dome(double times) { return Sphere(Vec3::Zero(), times * kR, Half::kUpper); }
PatchModel Bowl(double times) { return UpsideDown(Dome(times)); }
PatchModel Ring(double times) { return Torus(Vec3::Zero(), 3.0 * times * kR, times * kR, Half::kUpper); }
PatchModel Trench(double times) { return UpsideDown(Ring(times)); }
PatchModel Pass(double times) { return Saddle(0.5 / (times * kR), 0.5 / (times * kR), 8.0); }
PatchModel Valley(double times) { return ParabolicValley(0.5 / (times * kR), 8.0); }
// A spline through heights of an ellipsoid.
PatchModel Lens(double sign) {
  const auto height = [sign](double x, double y) {
    return sign * 10.0 * std::sqrt(1.0 - x * x / 256.0 - y * y / 169.0);
  };
  return Single(InterpolatedHeights(height, -8, 8, -7, 7, 8, 8));
}

PatchModel LongDome(double sign) {
  const PatchModel dome = Ellipsoid({12, 8, 10});
  return sign > 0.0 ? dome : UpsideDown(dome);
}

struct Measured {
  double least = kInfinity, worst = 0.0;  // of the pairs' worst leftovers, in scallops
  int pairs = 0;
};

// Pairs with crests in a few places only are the ends of partial passes.
Measured Measure(const Surface& surface, const std::vector<CutterPath>& paths, double apart,
                 const PlaceFilter& counts) {
  const double flat = CenterStep(kR, kScallop, 0.0);
  Measured all;
  for (const PairOfPasses& pair : CrestsOfPairs(surface, paths, kR, apart, flat / 6.0, 1.5 * flat, counts)) {
    all.worst = std::max(all.worst, pair.worst.leftover / kScallop);
    if (pair.crests < 8) continue;
    ++all.pairs;
    all.least = std::min(all.least, pair.worst.leftover / kScallop);
  }
  return all;
}

// The way is shared by a whole number of gaps, so each is shorter by up to a gap's share of it.
double LeastOfShared(const std::vector<CutterPath>& paths) {
  std::set<int> lines;
  for (const CutterPath& path : paths) lines.insert(path.order_key);
  return 0.95 * std::pow(1.0 - 1.0 / static_cast<double>(lines.size() - 1), 2.0);
}

// kSomeAreParted: partial passes, or needs that differ much from pair to pair: the worst pair alone is
// judged from below.
enum class Pairs { kAllShareTheWay, kSomeAreParted };

struct LineShape {
  const char* name;
  PatchModel (*model)(double);
  double size;
  double angle;       // degrees
  Vec2 middle, half;  // the part to finish, in plan: no rims
  Pairs pairs = Pairs::kAllShareTheWay;
};
void PrintTo(const LineShape& g, std::ostream* out) { *out << g.name << " " << g.size << " " << g.angle; }

class LinesOn : public ::testing::TestWithParam<LineShape> {};

TEST_P(LinesOn, LeaveTheScallop) {
  const LineShape& shape = GetParam();
  const Surface surface = JoinedSurface(shape.model(shape.size));
  const Locator locator(surface, kR);
  const Vec2 a = shape.middle - shape.half, b = shape.middle + shape.half;
  Containment containment;
  containment.boundary = Boundary{Outline({{a, {b.x(), a.y()}, b, {a.x(), b.y()}}}), BoundaryMode::kContact};
  const auto operation_limits =
      OperationLimits::Make(surface, containment, {.ball_radius = kR, .tool_radius = kR}, RunContext());
  ASSERT_TRUE(operation_limits.ok()) << operation_limits.status();
  ZigzagParams params;
  SetFinish(params, kScallop);
  params.angle = Radians(shape.angle);
  params.pass.window.max = Radians(45);
  params.part = &*operation_limits;
  const auto paths = ZigzagPaths(locator, params, RunContext(2));
  ASSERT_TRUE(paths.ok()) << paths.status();
  // Next to the part's border lines end, and border passes have the last word.
  const Vec2 inner = shape.half - Vec2(0.35, 0.35);
  const Measured all = Measure(surface, *paths, 0.25, [&](const Vec3& p, const Vec3& e) {
    return e.z() > std::cos(Radians(44)) && ((Xy(p) - shape.middle).cwiseAbs() - inner).maxCoeff() < 0.0;
  });
  const double least = LeastOfShared(*paths);
  EXPECT_GE(all.pairs, 4);
  EXPECT_LE(all.worst, 1.05);
  EXPECT_GE(all.worst, least);
  if (shape.pairs == Pairs::kAllShareTheWay) {
    EXPECT_GE(all.least, least - 0.5 * kGougeOfScallop);
  }
}

const Vec2 kHere(0, 0);

INSTANTIATE_TEST_SUITE_P(
    Shapes, LinesOn,
    ::testing::Values(LineShape{"dome", Dome, 1.25, 0, kHere, {1.8, 1.8}},
                      LineShape{"dome", Dome, 4.0, 0, kHere, {5.5, 5.5}},
                      LineShape{"bowl", Bowl, 1.25, 0, kHere, {1.8, 1.8}},
                      LineShape{"bowl", Bowl, 1.5, 0, kHere, {2.1, 2.1}, Pairs::kSomeAreParted},
                      LineShape{"bowl", Bowl, 4.0, 0, kHere, {5.5, 5.5}},
                      LineShape{"ring", Ring, 1.25, 0, {11.25, 0}, {2.4, 3.7}},
                      LineShape{"ring", Ring, 1.25, 90, {11.25, 0}, {2.4, 3.7}},
                      LineShape{"trench", Trench, 1.5, 0, {13.5, 0}, {2.9, 4.5}},
                      LineShape{"trench", Trench, 1.5, 30, {13.5, 0}, {2.9, 4.5}, Pairs::kSomeAreParted},
                      LineShape{"trench", Trench, 1.3, 15, {11.7, 0}, {2.5, 3.9}, Pairs::kSomeAreParted},
                      LineShape{"trench", Trench, 1.25, 90, {11.25, 0}, {2.4, 3.7}, Pairs::kSomeAreParted},
                      LineShape{"saddle", Pass, 1.25, 0, kHere, {1.8, 1.8}},
                      LineShape{"saddle", Pass, 1.25, 90, kHere, {1.8, 1.8}, Pairs::kSomeAreParted},
                      LineShape{"saddle", Pass, 4.0, 30, kHere, {6.0, 6.0}},
                      LineShape{"valley", Valley, 1.25, 0, kHere, {1.8, 1.8}},
                      LineShape{"valley", Valley, 1.5, 30, kHere, {2.2, 2.2}},
                      LineShape{"valley", Valley, 4.0, 90, kHere, {6.0, 6.0}},
                      LineShape{"lens", Lens, 1.0, 30, kHere, {6.0, 5.0}},
                      LineShape{"hollow lens", Lens, -1.0, 30, kHere, {6.0, 5.0}}));

// Over its rims lines may lie far apart, in the valley they are cut into parts: as few as they can be, not
// four to each gap of a few gaps too narrow.
TEST(LinesBetweenRims, AreAsFarApartAsTheyMayBe) {
  const Surface surface = JoinedSurface(Valley(4.0));
  const Locator locator(surface, kR);
  ZigzagParams params;
  params.pass.scallop = 0.01;
  params.pass.chord_tolerance = 1e-4;
  params.pass.window.max = Radians(45);
  const auto paths = ZigzagPaths(locator, params, RunContext(2));
  ASSERT_TRUE(paths.ok()) << paths.status();
  const double flat = CenterStep(kR, params.pass.scallop, 0.0);
  const auto pairs =
      CrestsOfPairs(surface, *paths, kR, 0.5, flat / 6.0, 1.5 * flat,
                    [](const Vec3& p, const Vec3&) { return Xy(p).cwiseAbs().maxCoeff() < 7.0; });
  EXPECT_GT(pairs.size(), 25u);
  for (const PairOfPasses& pair : pairs) {
    EXPECT_LE(pair.worst.leftover, 1.05 * params.pass.scallop);
    EXPECT_GE(pair.worst.leftover, 0.95 * params.pass.scallop);
  }
}

struct LevelShape {
  const char* name;
  PatchModel (*model)(double);
  double size;
  double apart;               // mm, of the lines that look for crests
  double within = kInfinity;  // mm, in x and y: beyond it the sheet's border is near
  Pairs pairs = Pairs::kAllShareTheWay;
};
void PrintTo(const LevelShape& g, std::ostream* out) { *out << g.name << " " << g.size; }

class LevelsOn : public ::testing::TestWithParam<LevelShape> {};

TEST_P(LevelsOn, LeaveTheScallop) {
  const LevelShape& shape = GetParam();
  const Surface surface = JoinedSurface(shape.model(shape.size));
  const Locator locator(surface, kR);
  ContourParams params;
  SetFinish(params, kScallop);
  params.pass.window = {Radians(45), Radians(90)};
  auto contours = ContourPaths(locator, params, RunContext(2));
  ASSERT_TRUE(contours.ok()) << contours.status();
  ASSERT_TRUE(
      ThinContours(
          locator, params.pass, [](const CutterPath&) { return true; }, RunContext(2), contours->paths)
          .ok());
  // Where levels cross the window's limit they end there, and border passes have the last word.
  const Measured all = Measure(surface, contours->paths, shape.apart, [&](const Vec3& p, const Vec3& e) {
    return e.z() < std::cos(Radians(49)) && e.z() > 1e-3 && Xy(p).cwiseAbs().maxCoeff() < shape.within;
  });
  const double least = LeastOfShared(contours->paths);
  EXPECT_GE(all.pairs, 3);
  EXPECT_LE(all.worst, 1.05);
  EXPECT_GE(all.worst, least);
  if (shape.pairs == Pairs::kAllShareTheWay) {
    EXPECT_GE(all.least, least - 0.5 * kGougeOfScallop);
  }
}

INSTANTIATE_TEST_SUITE_P(
    Shapes, LevelsOn,
    ::testing::Values(LevelShape{"dome", Dome, 1.25, 0.5}, LevelShape{"dome", Dome, 4.0, 1.5},
                      LevelShape{"bowl", Bowl, 1.25, 0.5}, LevelShape{"bowl", Bowl, 4.0, 1.5},
                      LevelShape{"ring", Ring, 1.25, 2.0}, LevelShape{"trench", Trench, 1.25, 2.0},
                      LevelShape{"saddle", Pass, 1.25, 0.3, 7.3, Pairs::kSomeAreParted},
                      LevelShape{"long dome", LongDome, 1.0, 0.5, kInfinity, Pairs::kSomeAreParted},
                      LevelShape{"long bowl", LongDome, -1.0, 0.5, kInfinity, Pairs::kSomeAreParted}));

// The hills of the example, concave and convex along and across. To make sure that pairs are measured at
// all, at least half of the lines at the flat step-over must be there, and several levels on the steep band
// of the larger hill.
TEST(TwoHillsUnderAWideTolerance, LeaveNoMoreThanFivePercentOnTop) {
  const Surface surface = JoinedSurface(TwoHills());
  const Locator locator(surface, kR);
  const double scallop = 0.01, flat = CenterStep(kR, scallop, 0.0), split = Radians(30);
  ZigzagParams gentle;
  SetFinish(gentle, scallop);
  gentle.pass.window.max = split;
  const auto lines = ZigzagPaths(locator, gentle, RunContext(2));
  ASSERT_TRUE(lines.ok()) << lines.status();
  ContourParams steep;
  SetFinish(steep, scallop);
  steep.pass.window = {split, Radians(90)};
  const auto contours = ContourPaths(locator, steep, RunContext(2));
  ASSERT_TRUE(contours.ok()) << contours.status();
  for (const bool level : {false, true}) {
    int pairs = 0;
    for (const PairOfPasses& pair :
         CrestsOfPairs(surface, level ? contours->paths : *lines, kR, 1.0, flat / 6.0, 1.5 * flat,
                       [&](const Vec3&p, const Vec3&e) {
                         const bool inside = (Xy(p) - Vec2(50, 50)).cwiseAbs().maxCoeff() < 48.0;
                         return inside && (level ? e.z() < std::cos(split + Radians(4))
                                                 : e.z() > std::cos(split - Radians(1)));
                       })) {
      ++pairs;
      EXPECT_LE(pair.worst.leftover, 1.05 * scallop) << level;
    }
    EXPECT_GT(pairs, level ? 10.0 : 0.5 * 96.0 / flat);
  }
}

// A rod of a small radius lets levels lie far apart; a trough at the same height needs five to each gap.
TEST(LevelsBesideARod, AreAsNearAsHollowSurfaceNeeds) {
  Eigen::Affine3d place(Eigen::Translation3d(15, 0, 2.4));
  place.rotate(Eigen::AngleAxisd(kPi, Vec3::UnitY()));
  const PatchModel trough = Moved(Cylinder(Vec3::Zero(), 1.25 * kR, 1.5, Half::kUpper), place);
  const PatchModel rod = Cylinder(Vec3::Zero(), 0.6, 10.0, Half::kUpper);
  const Surface surface = JoinedSurface(Join({rod, trough}));
  const Locator locator(surface, kR);
  ContourParams params;
  SetFinish(params, kScallop);
  params.pass.window = {Radians(45), Radians(90)};
  const auto contours = ContourPaths(locator, params, RunContext(2));
  ASSERT_TRUE(contours.ok()) << contours.status();
  const Measured all = Measure(surface, contours->paths, 0.25, [&](const Vec3& p, const Vec3& e) {
    return p.x() > 10.0 && e.z() < std::cos(Radians(49)) && e.z() > 1e-3;
  });
  EXPECT_GE(all.pairs, 6);
  EXPECT_LE(all.worst, 1.05);
}

}  // namespace
}  // namespace patchmill
