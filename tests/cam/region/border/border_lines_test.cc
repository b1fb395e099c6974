// Borders as lines of one kind each and the nodes between them, on shapes where both are known.
#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include <gtest/gtest.h>

#include "cam/region/split_regions.h"
#include "core/diffgeo/forms.h"
#include "core/surface/closest.h"
#include "tests/support/joined_surface.h"
#include "tests/support/model_table.h"
#include "tests/support/sanitized.h"
#include "tests/support/shapes.h"
#include "tests/support/surface_of.h"

namespace patchmill {
namespace {

using namespace testing;  // NOLINT: the support folder's

RegionParams Exact(double radius, double detail = 1.0, double chord = 1e-4) {
  RegionParams p;
  p.radius = radius;
  p.tolerance = 0.001;
  p.detail = detail;
  p.border_tolerance = chord;
  return p;
}

RegionMap Split(const Surface& surface, const RegionParams& params) {
  auto map = SplitRegions(surface, params, RunContext());
  EXPECT_TRUE(map.ok()) << map.status();
  return *std::move(map);
}

double Length(const std::vector<Vec3>& points, bool closed) {
  double sum = closed ? (points.front() - points.back()).norm() : 0.0;
  for (std::size_t i = 1; i < points.size(); ++i) sum += (points[i] - points[i - 1]).norm();
  return sum;
}

std::map<BorderKind, std::vector<const BorderLine*>> ByKind(const RegionMap& map) {
  std::map<BorderKind, std::vector<const BorderLine*>> by_kind;
  for (const BorderLine& line : map.border_lines) by_kind[line.kind].push_back(&line);
  return by_kind;
}

TEST(BorderLines, OfATorusAreCirclesWithoutNodes) {
  const double major = 20, minor = 6;
  const RegionMap map = Split(SurfaceOf(Torus(Vec3::Zero(), major, minor, Half::kUpper)), Exact(0.5));
  EXPECT_TRUE(map.nodes.empty());
  const auto by_kind = ByKind(map);
  ASSERT_EQ(map.border_lines.size(), 5u);
  ASSERT_EQ(by_kind.at(BorderKind::kSlope).size(), 2u);
  ASSERT_EQ(by_kind.at(BorderKind::kOpenEdge).size(), 2u);
  double slope = 0.0, edge = 0.0;
  for (const BorderLine& line : map.border_lines) {
    EXPECT_TRUE(line.closed) << Name(line.kind);
    const double length = Length(line.points, true);
    slope += line.kind == BorderKind::kSlope ? length : 0.0;
    edge += line.kind == BorderKind::kOpenEdge ? length : 0.0;
  }
  EXPECT_NEAR(slope, 4 * kPi * major, 1e-3);  // the outer one is as much longer as the inner one is shorter
  EXPECT_NEAR(edge, 4 * kPi * major, 1.0);    // cut into chords by the triangles alone
}

TEST(BorderLines, OfASaddleMeetInItsMiddle) {
  const double a = 0.05, b = 0.03, half = 8, k = std::sqrt(a / b);
  RegionParams params = Exact(0.5);
  params.steep_angle = Radians(85);
  const RegionMap map = Split(SurfaceOf(Saddle(a, b, half)), params);
  const auto by_kind = ByKind(map);
  ASSERT_EQ(by_kind.size(), 2u);
  ASSERT_EQ(by_kind.at(BorderKind::kCurvature).size(), 4u);
  ASSERT_EQ(by_kind.at(BorderKind::kOpenEdge).size(), 4u);
  for (const BorderLine* line : by_kind.at(BorderKind::kCurvature)) {
    EXPECT_FALSE(line->closed);
    EXPECT_LT(line->region, line->other);
    EXPECT_LT(std::min(line->points.front().norm(), line->points.back().norm()), 1e-9);
    for (const Vec3& p : line->points) EXPECT_NEAR(std::abs(p.y()), k * std::abs(p.x()), 1e-4);
  }
  ASSERT_EQ(map.nodes.size(), 5u);
  int middle = 0;
  for (const Vec3& node : map.nodes) {
    if (node.norm() < 1e-9) {
      ++middle;
      continue;
    }
    EXPECT_NEAR(std::abs(node.y()), half, 1e-9);
    EXPECT_NEAR(std::abs(node.x()), half / k, 1e-4);
  }
  EXPECT_EQ(middle, 1);
}

TEST(BorderLines, OfABallOnAPlateAreItsFootAndItsSteepPart) {
  const double r = 8, radius = 3;
  const RegionMap map =
      Split(SurfaceOf(Join({Plane(20), Sphere(Vec3::Zero(), r, Half::kUpper)})), Exact(radius));
  // Reach ends on the ball where the tool stands in the corner, and around the plate's part of it.
  const auto by_kind = ByKind(map);
  for (const BorderLine* line : by_kind.at(BorderKind::kReach)) {
    EXPECT_TRUE(line->closed);
    for (const Vec3& p : line->points) EXPECT_GT(std::hypot(p.x(), p.y()), 7.0);
  }
  ASSERT_EQ(by_kind.at(BorderKind::kSlope).size(), 1u);
  EXPECT_NEAR(Length(by_kind.at(BorderKind::kSlope)[0]->points, true), 2 * kPi * r * std::sqrt(0.5), 1e-3);
}

// mm of edges of patches where no other patch is.
double OpenEdges(const Surface& surface) {
  constexpr int kSteps = 512;
  double sum = 0.0;
  for (const EdgeLink& link : surface.network.edges) {
    if (link.neighbor || link.collapsed || link.on_t_junction) continue;
    const PatchShape& shape = surface.network.model.patches[link.self.patch.index()].shape;
    std::vector<Vec3> points;
    for (int i = 0; i <= kSteps; ++i) {
      const Vec2 uv = EdgeParameters(shape, link.self.edge, static_cast<double>(i) / kSteps);
      points.push_back(Evaluate(surface, link.self.patch, uv.x(), uv.y()).p);
    }
    sum += Length(points, false);
  }
  return sum;
}

// A watershed may leave a piece as near to its border as rounding allows: no crack stays beside it.
TEST(BorderLines, ARidgeBetweenSteepAndGentleIsASeam) {
  // A roof of 20 and 60 degrees: no line of 45 degrees lies in either plane.
  const double half = 10.0;
  const Eigen::Affine3d turn(Eigen::AngleAxisd(Radians(20), Vec3::UnitY()));
  const RegionMap map = Split(SurfaceOf(Transformed(TwoPlanes(Radians(-40), half), turn)), Exact(0.5));
  ASSERT_EQ(map.regions.size(), 2u);
  EXPECT_NE(map.regions[0].slope, map.regions[1].slope);
  const auto by_kind = ByKind(map);
  ASSERT_EQ(by_kind.size(), 2u);
  EXPECT_EQ(by_kind.count(BorderKind::kOpenEdge), 1u);
  ASSERT_EQ(by_kind.at(BorderKind::kSeam).size(), 1u);
  const BorderLine& ridge = *by_kind.at(BorderKind::kSeam).front();
  EXPECT_FALSE(ridge.closed);
  EXPECT_NEAR(Length(ridge.points, false), 2.0 * half, 1e-9);
  for (const Vec3& p : ridge.points) EXPECT_LT(Vec2(p.x(), p.z()).norm(), 1e-9);
}

// Coarse regions end along watersheds too, where nothing is as steep as the angle.
TEST(BorderLines, AreWhatTheirKindSays) {
  double slopes = 0.0, watersheds = 0.0, off = 0.0;
  for (std::uint64_t seed = 1; seed <= (kSanitized ? 2u : 8u); ++seed) {
    const Surface surface = SurfaceOf(RandomBspline(seed, {.size = 60.0, .amplitude = 14.0}));
    RegionParams params;
    params.radius = 3.0;
    params.tolerance = 0.01;
    params.steep_angle = Radians(30.0);
    params.detail = 0.4;
    const RegionMap map = Split(surface, params);
    for (const BorderLine& line : map.border_lines) {
      const double length = Length(line.points, line.closed);
      watersheds += line.kind == BorderKind::kWatershed ? length : 0.0;
      if (line.kind != BorderKind::kSlope) continue;
      slopes += length;
      for (std::size_t i = 1; i < line.points.size(); ++i) {
        const auto at = ClosestToPoint(surface, line.points[i], 1.0, 1e-6);
        ASSERT_TRUE(at);
        const auto jet = Evaluate(surface.pieces[at->at.piece.index()], at->at.u, at->at.v);
        const double slope = std::acos(UpwardNormal(jet)->z());
        if (std::abs(slope - params.steep_angle) > Radians(0.5))
          off += (line.points[i] - line.points[i - 1]).norm();
      }
    }
  }
  EXPECT_GT(slopes, kSanitized ? 50.0 : 300.0);
  EXPECT_GT(watersheds, kSanitized ? 10.0 : 50.0);
  EXPECT_LE(off, 0.005 * slopes);
}

TEST(BorderLines, OpenEdgesAreThoseOfTheSheet) {
  const Surface surface = JoinedSurface(TwoHills());
  const RegionMap map = Split(surface, RegionParams());
  const auto by_kind = ByKind(map);
  EXPECT_TRUE(by_kind.contains(BorderKind::kWatershed));
  double sum = 0.0;
  for (const BorderLine* line : by_kind.at(BorderKind::kOpenEdge)) sum += Length(line->points, line->closed);
  EXPECT_NEAR(sum, OpenEdges(surface), 0.1);
}

// Whatever the model: lines have two different regions and end at nodes, every region's lines are as long as
// its loops, and nodes are ends of lines.
TEST(BorderLines, OfAnyModelAreTheBordersOfItsRegions) {
  for (const TableRow& row : ModelTable()) {
    SCOPED_TRACE(row.file);
    auto model = ModelOf(row);
    if (!model) continue;
    const RegionMap map = Split(SurfaceOf(*model), Exact(3.0, 0.5, 1e-3));
    std::vector<double> length(map.regions.size(), 0.0);
    std::vector<bool> ended(map.nodes.size(), false);
    for (const BorderLine& line : map.border_lines) {
      ASSERT_GE(line.points.size(), 2u);
      ASSERT_NE(line.region, kNoRegion);
      EXPECT_NE(line.region, line.other);
      EXPECT_EQ(line.other == kNoRegion, line.kind == BorderKind::kOpenEdge);
      for (const RegionId id : {line.region, line.other}) {
        if (id != kNoRegion) length[id.index()] += Length(line.points, line.closed);
      }
      if (line.closed) {
        EXPECT_TRUE(line.from < 0 && line.to < 0);
        continue;
      }
      for (const auto& [node, end] :
           {std::pair(line.from, line.points.front()), std::pair(line.to, line.points.back())}) {
        ASSERT_GE(node, 0);
        ASSERT_LT(node, static_cast<int>(map.nodes.size()));
        ended[static_cast<std::size_t>(node)] = true;
        EXPECT_LT((map.nodes[static_cast<std::size_t>(node)] - end).norm(), 1e-5) << Name(line.kind);
      }
    }
    EXPECT_EQ(std::count(ended.begin(), ended.end(), false), 0);
    for (const Region& region : map.regions) {
      double loops = 0.0;
      for (const auto& loop : region.border) loops += Length(loop, true);
      // At seams whose sides are cut differently each joins what lies close together in its own way. Between
      // two reasons that part along a seam, some of it may be a line and in no loop: 0.8 mm of 46 where the
      // teacup's handle ends.
      const double share = region.kind == RegionKind::kUnreachable ? 0.02 : 0.01;
      EXPECT_NEAR(length[region.id.index()], loops, share * loops + 0.01) << region.id.value;
    }
  }
}

}  // namespace
}  // namespace patchmill
