// Profiles drawn along a line, as machines cut them every day: slots, grooves, chamfers.

#include <gtest/gtest.h>

#include "tests/support/jobs/jobs.h"
#include "tests/support/profiles.h"
#include "tests/support/shapes.h"

namespace patchmill {
namespace {

using namespace testing;  // NOLINT: the support folder's

double OverLeast(const JobResult& result) {
  return result.report.verify.cut_length / result.report.least_cut_length;
}

// A plane at the very angle that divides steep from gentle is cut in one of the two ways, not in both, nor
// by the rounding of its normals.
TEST(DrawnParts, PlanesAtTheSteepAngle) {
  for (const double degrees : {45.0, 30.0}) {
    Job job = BallJob(3.0);
    job.operation.steep_angle = Radians(degrees);
    const double high = 6.0 * std::tan(Radians(degrees));
    const JobResult roof =
        MillChecked(PlacedSurface(Drawn({Line({0, 0}, {6, high}), Line({6, high}, {12, 0})}, 25.0)), job);
    // Overlap at the ridge, and approaches and retracts on an area 12 mm wide. Lines in both directions are
    // at 2.2 and more.
    EXPECT_LT(OverLeast(roof), 1.65) << degrees;
    for (const Region& region : roof.report.regions) {
      if (region.kind == RegionKind::kUnreachable) continue;
      EXPECT_EQ(region.slope, SlopeClass::kSteep);
    }
  }
}

// The ball fills slot and groove: its centre has a line to go along, and no room beside it.
TEST(DrawnParts, SlotsOfTheBallsOwnWidth) {
  const JobResult slot =
      MillChecked(PlacedSurface(Drawn({Line({0, 6}, {6, 6}), Line({6, 6}, {6, 0}), Line({6, 0}, {12, 0}),
                                       Line({12, 0}, {12, 6}), Line({12, 6}, {18, 6})},
                                      15.0)));
  EXPECT_LE(slot.report.motion.retract_count, 12);
  const JobResult groove = MillChecked(
      PlacedSurface(Drawn({Line({0, 5}, {6, 5}), Line({6, 5}, {6, 3}), Round({6, 3}, {6, 0}, {9, 0}),
                           Round({9, 0}, {12, 0}, {12, 3}), Line({12, 3}, {12, 5}), Line({12, 5}, {18, 5})},
                          15.0)));
  EXPECT_EQ(groove.report.outcome, Outcome::kComplete);
  EXPECT_LE(groove.report.motion.retract_count, 12);
}

// Both walls of a wide slot in turn: where one pass ends the other begins.
TEST(DrawnParts, WallsOfASlotToAndFro) {
  const JobResult result = MillChecked(
      PlacedSurface(Drawn({Line({0, 10}, {10, 10}), Line({10, 10}, {10, 0}), Line({10, 0}, {22, 0}),
                           Line({22, 0}, {22, 10}), Line({22, 10}, {32, 10})},
                          30.0)));
  EXPECT_LE(result.report.motion.retract_count, 6);  // 28 passes along walls
}

// The ledges of a stepped pyramid are too narrow for regions of their own. Circles do not run along their
// borders.
TEST(DrawnParts, NoCirclesOverSquareLedges) {
  PatchModel model;
  const std::vector<Vec2> corners = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
  const auto add = [&](const Vec2& from, const Vec2& to) {  // (half side, z)
    for (std::size_t k = 0; k < 4; ++k) {
      BezierPatch patch;
      patch.degree_u = patch.degree_v = 1;
      for (const Vec2& c : {corners[k], corners[(k + 1) % 4]}) {
        for (const Vec2& end : {from, to}) patch.points.push_back(Lift(end.x() * c, end.y()));
      }
      model.patches.push_back({"", std::move(patch)});
    }
  };
  for (const double side : {20.0, 15.0}) {
    const double z = 20.0 - side;
    add({side, z}, {side - 5.0, z});
    add({side - 5.0, z}, {side - 5.0, z + 5.0});
  }
  const JobResult result = MillChecked(PlacedSurface(std::move(model)));
  int steep = 0;
  for (std::size_t id = 0; id < result.report.regions.size(); ++id) {
    const Region& region = result.report.regions[id];
    if (region.slope != SlopeClass::kSteep || region.kind == RegionKind::kUnreachable) continue;
    ++steep;
    EXPECT_TRUE(result.report.choices[id].around.empty());
  }
  EXPECT_GT(steep, 0);
}

}  // namespace
}  // namespace patchmill
