#include "cam/path/edge/border_passes.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "cam/path/parallel/zigzag_paths.h"
#include "cam/path/stepover/step_over.h"
#include "cam/toolpath/segment_tree.h"
#include "tests/support/joined_surface.h"
#include "tests/support/shapes.h"

namespace patchmill {
namespace {

using testing::JoinedSurface;

constexpr double kRadius = 3.0, kScallop = 0.01;

ZigzagParams Params(double angle, double max_slope = kPi / 2) {
  ZigzagParams params;
  params.pass.scallop = kScallop;
  params.angle = angle;
  params.pass.window.max = max_slope;
  return params;
}

const double kFlat = CenterStep(kRadius, kScallop, 0.0);

struct Passes {
  std::vector<CutterPath> lines, borders;
};

Passes PassesOn(const Locator& locator, const ZigzagParams& params, const std::vector<BorderCurve>& borders,
                int threads = 1) {
  const auto lines = ZigzagPaths(locator, params, RunContext(threads));
  EXPECT_TRUE(lines.ok()) << lines.status();
  const auto passes = BorderPasses(locator, borders, *lines, params.pass, RunContext(threads));
  EXPECT_TRUE(passes.ok()) << passes.status();
  return {*lines, *passes};
}

// Places where the ball touches a border, in order, whose nearest pass is further away than `near`: the
// longest stretch of them, mm.
double LongestBare(const std::vector<Vec3>& centers, std::vector<CutterPath> paths,
                   const std::vector<CutterPath>& more, double near) {
  paths.insert(paths.end(), more.begin(), more.end());
  const SegmentTree tree(MovesOf(paths), Metric::kPath, kInfinity, RunContext(1));
  double longest = 0.0, length = 0.0;
  for (std::size_t i = 1; i < centers.size(); ++i) {
    length =
        tree.FindNearest(centers[i], near).segment >= 0 ? 0.0 : length + (centers[i] - centers[i - 1]).norm();
    longest = std::max(longest, length);
  }
  return longest;
}

TEST(BorderPasses, FinishTheEdgeThatLinesRunAlong) {
  constexpr double kHalf = 30.0;
  const Surface surface = JoinedSurface(testing::Plane(kHalf));
  const Locator locator(surface, kRadius);
  const BorderCurve edge{{Vec3(-kHalf, kHalf, 0), Vec3(kHalf, kHalf, 0)}, false};
  const BorderCurve across{{Vec3(kHalf, -kHalf, 0), Vec3(kHalf, kHalf, 0)}, false};
  const Passes found = PassesOn(locator, Params(Radians(3)), {edge, across});
  ASSERT_FALSE(found.borders.empty());
  double length = 0.0;
  for (const CutterPath& pass : found.borders) {
    EXPECT_EQ(pass.kind, PassKind::kBorder);
    length += Length(pass);
    for (const CutterPoint& p : pass.points) {
      EXPECT_NEAR(p.center.y(), kHalf, 0.02 * kFlat);  // none along the edge that lines run across
      EXPECT_NEAR(p.center.z(), kRadius, 1e-3);
    }
  }
  std::vector<Vec3> centers;
  for (double x = -kHalf; x <= kHalf; x += 0.01) centers.emplace_back(x, kHalf, kRadius);
  // The steps between the ends of lines are unfinished. Each is as long as the rise of a flat step-over at 3
  // degrees, less what half a step on either side finishes.
  const double before = LongestBare(centers, found.lines, {}, 0.6 * kFlat);
  EXPECT_GT(before, 4.0 * kFlat);
  EXPECT_LT(LongestBare(centers, found.lines, found.borders, 0.6 * kFlat), 4.0 * kFlat);
  EXPECT_LT(length, 2.0 * kHalf);
}

TEST(BorderPasses, AreNotNeededWhereLinesEndOnOrAcrossTheBorder) {
  constexpr double kHalf = 20.0;
  const Surface surface = JoinedSurface(testing::Plane(kHalf));
  const Locator locator(surface, kRadius);
  const BorderCurve edges{
      {Vec3(-kHalf, -kHalf, 0), Vec3(kHalf, -kHalf, 0), Vec3(kHalf, kHalf, 0), Vec3(-kHalf, kHalf, 0)}, true};
  for (const double angle : {0.0, 45.0, 90.0}) {
    EXPECT_TRUE(PassesOn(locator, Params(Radians(angle)), {edges}).borders.empty()) << angle;
  }
  EXPECT_TRUE(PassesOn(locator, Params(0.0), {}).borders.empty());
}

// A closed border begins anywhere: no pass is cut in two there.
TEST(BorderPasses, DoNotDependOnWhereAClosedBorderBegins) {
  constexpr double kHalf = 30.0;
  const Surface surface = JoinedSurface(testing::Plane(kHalf));
  const Locator locator(surface, kRadius);
  const ZigzagParams params = Params(Radians(1));  // bare for more than two passes of the shortest length
  std::vector<std::size_t> counts;
  for (double start = -25.0; start <= 25.0; start += 2.0) {
    const BorderCurve edges{{Vec3(start, kHalf, 0), Vec3(kHalf, kHalf, 0), Vec3(kHalf, -kHalf, 0),
                             Vec3(-kHalf, -kHalf, 0), Vec3(-kHalf, kHalf, 0)},
                            true};
    counts.push_back(PassesOn(locator, params, {edges}).borders.size());
  }
  EXPECT_GT(counts.front(), 2u);
  for (const std::size_t count : counts) EXPECT_EQ(count, counts.front());
}

// The edge x -> (x, half, z(x)) of a height field of gradient `slopes(x)`, with lines 3 degrees from it:
// contacts are on the edge, centres where the closed form has them, on any number of threads.
template <class Z, class Slopes>
void ExpectAlongEdge(const Surface& surface, double length, double half, const Z& z, const Slopes& slopes) {
  const Locator locator(surface, kRadius);
  BorderCurve edge;
  for (double x = -length; x <= length; x += 0.1) edge.points.emplace_back(x, half, z(x));
  const ZigzagParams params = Params(Radians(3));
  const Passes found = PassesOn(locator, params, {edge});
  ASSERT_FALSE(found.borders.empty());
  for (const CutterPath& pass : found.borders) {
    EXPECT_GE(Length(pass), 3.0 * kFlat);
    for (const CutterPoint& p : pass.points) {
      ASSERT_TRUE(p.contact);
      EXPECT_NEAR(p.contact->p.y(), half, 0.05 * kFlat);
      const Vec2 slope = slopes(p.contact->p.x());
      const Vec3 n = Vec3(-slope.x(), -slope.y(), 1.0).normalized();
      EXPECT_LT((p.contact->p + kRadius * n - p.center).norm(), 0.05 * kFlat);
    }
  }
  const Passes again = PassesOn(locator, params, {edge}, 3);
  ASSERT_EQ(found.borders.size(), again.borders.size());
  for (std::size_t k = 0; k < again.borders.size(); ++k) {
    ASSERT_EQ(found.borders[k].points.size(), again.borders[k].points.size());
    for (std::size_t i = 0; i < again.borders[k].points.size(); ++i) {
      EXPECT_EQ(found.borders[k].points[i].center, again.borders[k].points[i].center);
    }
  }
}

TEST(BorderPasses, TouchTheEdgeOfADome) {
  constexpr double kA = -0.01, kHalf = 25.0;
  ExpectAlongEdge(
      JoinedSurface(testing::Paraboloid(kA, kHalf)), kHalf, kHalf,
      [](double x) { return kA * (x * x + kHalf * kHalf); },
      [](double x) { return Vec2(2.0 * kA * x, 2.0 * kA * kHalf); });
}

// A hollow nearly as tight as the ball, where the contact moves three times as far as the ball, and lines
// that end at a border within.
TEST(BorderPasses, TouchABorderInAHollow) {
  constexpr double kA = 0.5 * 0.7 / kRadius, kHalf = 20.0;
  const double slope = Radians(35), x = std::tan(slope) / (2.0 * kA), z = kA * x * x;
  const double last = x - kRadius * std::sin(slope);  // centres of the border
  const Surface surface = JoinedSurface(testing::ParabolicValley(kA, kHalf));
  const Locator locator(surface, kRadius);
  const ZigzagParams params = Params(kPi / 2.0 + Radians(1));
  const auto lines = ZigzagPaths(locator, params, RunContext(1));
  ASSERT_TRUE(lines.ok());
  std::vector<CutterPath> ended;
  for (const CutterPath& line : *lines) {
    for (std::size_t i = 1; i < line.points.size(); ++i) {
      CutterPoint a = line.points[i - 1], b = line.points[i];
      if (a.center.x() > b.center.x()) std::swap(a, b);
      if (a.center.x() >= last) continue;
      if (b.center.x() > last)
        b.center = a.center + (last - a.center.x()) / (b.center.x() - a.center.x()) * (b.center - a.center);
      ended.push_back({.kind = PassKind::kZigzag, .points = {a, b}});
    }
  }
  const BorderCurve border{{Vec3(x, -kHalf, z), Vec3(x, kHalf, z)}, false};
  const auto passes = BorderPasses(locator, {border}, ended, params.pass, RunContext(1));
  ASSERT_TRUE(passes.ok()) << passes.status();
  ASSERT_FALSE(passes->empty());
  for (const CutterPath& pass : *passes) {
    for (const CutterPoint& p : pass.points) {
      ASSERT_TRUE(p.contact);
      EXPECT_NEAR(p.contact->p.x(), x, 0.05 * kFlat);
      EXPECT_NEAR(p.center.x(), last, 0.05 * kFlat);
    }
  }
}

// Where the slope ends the window lines overlap it by half a step: nothing is left between their ends.
TEST(BorderPasses, AreNotNeededWhereLinesOverlapTheirBorder) {
  constexpr double kSphere = 60.0;
  const double slope = Radians(40);
  const Surface surface = JoinedSurface(testing::Sphere({0, 0, 0}, kSphere, testing::Half::kUpper));
  BorderCurve border{{}, true};
  for (int k = 0; k < 720; ++k) {
    const double phi = 2.0 * kPi * k / 720.0, r = kSphere * std::sin(slope);
    border.points.emplace_back(r * std::cos(phi), r * std::sin(phi), kSphere * std::cos(slope));
  }
  EXPECT_TRUE(PassesOn(Locator(surface, kRadius), Params(0.0, slope), {border}).borders.empty());
}

}  // namespace
}  // namespace patchmill
