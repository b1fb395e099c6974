// What is selected is cut to its ends, in corners too, and nothing else is: not by passes, not by links.
#include <cmath>

#include <gtest/gtest.h>

#include "core/surface/closest.h"
#include "tests/support/jobs/jobs.h"
#include "tests/support/shapes.h"

namespace patchmill {
namespace {

using namespace testing;  // NOLINT: the support folder's

Job SelectedJob(double radius, double scallop, std::vector<std::string> patches) {
  Job job = BallJob(radius, /*deep=*/false);
  job.operation.scallop = scallop;
  job.operation.selection.patches = std::move(patches);
  return job;
}

double FlatStep(double radius, double scallop) { return 2.0 * std::sqrt(scallop * (2.0 * radius - scallop)); }

// visit(centre, cut) every 0.05 mm of all feed moves.
template <class Visit>
void AlongFeeds(const JobResult& result, const Visit& visit) {
  const auto& moves = result.motion.toolpath.moves;
  for (std::size_t i = 1; i < moves.size(); ++i) {
    if (moves[i].kind == MoveKind::kRapid) continue;
    const Vec3 a = moves[i - 1].to, b = moves[i].to;
    const int n = 1 + static_cast<int>((b - a).norm() / 0.05);
    for (int k = 0; k <= n; ++k)
      visit(Vec3(a + (b - a) * (static_cast<double>(k) / n)), moves[i].kind == MoveKind::kCut);
  }
}

// A level floor, y from 0 to `foot`, and a wall of some draft at its end.
PatchModel FloorAndWall(double foot, double draft, double height) {
  const double back = foot + height * std::tan(draft);
  return Join({Single(Bilinear({0, 0, 0}, {30, 0, 0}, {0, foot, 0}, {30, foot, 0})),
               Single(Bilinear({0, foot, 0}, {30, foot, 0}, {0, back, height}, {30, back, height}))});
}

TEST(SelectedArea, FloorsAreFinishedToTheFootOfWalls) {
  for (const double draft : {3.0, 10.0}) {
    for (const double radius : {1.5, 3.0}) {
      for (const double foot : {20.0, 20.2, 20.37}) {
        for (const double scallop : {0.01, 0.03}) {
          const Surface surface = PlacedSurface(FloorAndWall(foot, Radians(draft), 4.0));
          const JobResult result = Mill(surface, SelectedJob(radius, scallop, {"#0"}));
          EXPECT_TRUE(result.report.verify.ok())
              << draft << " " << radius << " " << foot << " " << Describe(result);
          AlongFeeds(result, [&](const Vec3& c, bool cut) {
            if (cut) {
              EXPECT_LE(c.z(), radius + 0.6 * FlatStep(radius, scallop));
            }
          });
        }
      }
    }
  }
}

TEST(SelectedArea, ContactBoundariesAreReachedAtTheFootOfWalls) {
  for (const double line : {17.6, 19.0, 19.8}) {
    const Surface surface = PlacedSurface(FloorAndWall(20.0, Radians(3.0), 4.0));
    Job job = SelectedJob(3.0, 0.01, {});
    job.operation.selection.boundary = {{{-1, -1}, {31, -1}, {31, line}, {-1, line}}};
    job.operation.selection.boundary_mode = BoundaryMode::kContact;
    const JobResult result = Mill(surface, job);
    EXPECT_TRUE(result.report.verify.ok()) << line << " " << Describe(result);
  }
}

// Three strips of a plate; the ball is lifted over the one between, which a link would groove.
TEST(SelectedArea, LinksAreLiftedOverOtherSurface) {
  const auto strip = [](double x0, double x1) {
    return Single(Bilinear({x0, 0, 0}, {x1, 0, 0}, {x0, 20, 0}, {x1, 20, 0}));
  };
  const Surface surface = PlacedSurface(Join({strip(0, 10), strip(10, 18), strip(18, 28)}));
  const double step = FlatStep(3.0, 0.02);
  for (const bool avoid : {false, true}) {
    Job job = SelectedJob(3.0, 0.02, {});
    if (avoid) job.operation.selection.avoid = {"#1"};
    if (!avoid) job.operation.selection.patches = {"#0", "#2"};
    for (const double angle : {0.0, 90.0}) {
      job.operation.zigzag_angle = Radians(angle);
      const JobResult result = Mill(surface, job);
      EXPECT_TRUE(result.report.verify.ok()) << Describe(result);
      EXPECT_GT(result.report.motion.cut_length, 500.0);
      // Lines along the strips come in two groups. Lines across the strips end at other areas, beside the
      // next line.
      EXPECT_LE(result.report.motion.retract_count, 4) << Describe(result);
      AlongFeeds(result, [&](const Vec3& c, bool) {
        if (c.x() < 10.0 + 1.3 * step || c.x() > 18.0 - 1.3 * step) return;
        EXPECT_GE(c.z(), 3.0 + job.setup.allowance.walls + job.operation.approach_gap - 0.02)
            << c.transpose();
      });
    }
  }
}

// The same where a region between two others is switched off: a ridge between two levels.
TEST(SelectedArea, LinksAreLiftedOverRegionsThatAreOff) {
  const double side = 12.0, run = 1.2, height = run * std::tan(Radians(60.0)), end = 2.0 * (side + run);
  const auto strip = [](double x0, double z0, double x1, double z1) {
    return Single(Bilinear({x0, 0, z0}, {x1, 0, z1}, {x0, 20, z0}, {x1, 20, z1}));
  };
  const Surface surface =
      PlacedSurface(Join({strip(0, 0, side, 0), strip(side, 0, side + run, height),
                          strip(side + run, height, side + 2 * run, 0), strip(side + 2 * run, 0, end, 0)}));
  Job job = SelectedJob(1.0, 0.02, {});
  job.operation.clearance_above = 30.0;  // going over the ridge at feed is quicker
  const auto regions = PlanRegions(surface, job, RunContext());
  ASSERT_TRUE(regions.ok());
  for (const Region& region : regions->map.regions) {
    if (region.slope != SlopeClass::kSteep) continue;
    RegionOverride off;
    off.region = region.id;
    off.skip = true;
    job.operation.overrides.push_back(off);
  }
  ASSERT_FALSE(job.operation.overrides.empty());
  const JobResult result = Mill(surface, job);
  EXPECT_TRUE(result.report.verify.ok()) << Describe(result);
  EXPECT_GT(result.report.motion.cut_length, 500.0);
  const double step = FlatStep(1.0, 0.02);
  AlongFeeds(result, [&](const Vec3& c, bool) {
    const auto near = ClosestToPoint(surface, c, 5.0, 1e-3);
    if (!near || near->at.p.z() < 1.3 * step) return;
    EXPECT_GE(near->distance, 1.0 + job.setup.allowance.walls) << c.transpose();
  });
}

TEST(SelectedArea, LinksDoNotCutAboveTheHighestTip) {
  const auto wave = [](double x, double y) { return 1.5 * std::sin(x / 3.0) + 0.5 * std::sin(y / 4.0); };
  const Surface surface = PlacedSurface(Single(InterpolatedHeights(wave, 0, 40, 0, 20, 30, 16)));
  for (const double top : {0.0, 1.0}) {
    Job job = SelectedJob(2.0, 0.02, {});
    job.operation.top_z = top;
    const JobResult result = Mill(surface, job);
    EXPECT_TRUE(result.report.verify.ok()) << Describe(result);
    EXPECT_GT(result.report.motion.cut_length, 200.0);
    const auto& moves = result.motion.toolpath.moves;
    for (std::size_t i = 1; i < moves.size(); ++i) {
      if (moves[i].kind != MoveKind::kCut && moves[i].kind != MoveKind::kLink) continue;
      for (const double t : {0.0, 0.25, 0.5, 0.75, 1.0}) {
        const Vec3 c = moves[i - 1].to + t * (moves[i].to - moves[i - 1].to);
        if (c.z() - 2.0 <= top + 0.5 * job.operation.tolerance + 1e-9) continue;
        EXPECT_FALSE(ClosestToPoint(surface, c, 2.0 + job.setup.allowance.walls, 1e-3)) << c.transpose();
      }
    }
  }
}

// An upright wall is touched all along its height, its upper edge too: that does not make it a part of the
// top.
TEST(SelectedArea, TheTopOfABossIsNotItsWalls) {
  for (const double radius : {1.5, 3.0}) {
    const double height = 6.0;
    const Surface surface = PlacedSurface(Block(8.0, height, 20.0));
    int top = -1;
    for (std::size_t i = 0; i < surface.first_piece.size(); ++i) {
      const Vec3 p = Evaluate(surface, surface.first_piece[i], 0.5, 0.5).p;
      if (p.z() > height - 1e-9) top = static_cast<int>(i);
    }
    ASSERT_GE(top, 0);
    const JobResult result = Mill(surface, SelectedJob(radius, 0.02, {"#" + std::to_string(top)}));
    EXPECT_TRUE(result.report.verify.ok()) << Describe(result);
    AlongFeeds(result, [&](const Vec3& c, bool cut) {
      if (cut) {
        EXPECT_GE(c.z(), height - FlatStep(radius, 0.02));
      }
    });
  }
}

// What is selected of a line stays one chord.
TEST(SelectedArea, LinesStayWhole) {
  const PatchModel part = Plane(10.0);
  const PatchModel other = Single(Bilinear({40, 0, 0}, {50, 0, 0}, {40, 10, 0}, {50, 10, 0}));
  Job all = SelectedJob(3.0, 0.01, {}), first = SelectedJob(3.0, 0.01, {"#0"});
  all.operation.border_passes = first.operation.border_passes = false;
  const int alone = Mill(PlacedSurface(part), all).report.point_count;
  const int selected = Mill(PlacedSurface(Join({part, other})), first).report.point_count;
  EXPECT_GT(alone, 80);  // two points on each of 41 lines
  EXPECT_LE(selected, 1.2 * alone);
}

}  // namespace
}  // namespace patchmill
