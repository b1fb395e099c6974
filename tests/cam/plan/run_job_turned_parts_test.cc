// Turned shapes with upright walls, as machines cut every day: pockets, pins and bosses.
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/fuzz.h"
#include "tests/support/jobs/jobs.h"
#include "tests/support/profiles.h"
#include "tests/support/shapes.h"

namespace patchmill {
namespace {

using namespace testing;  // NOLINT: the support folder's

TEST(RoundParts, Pocket) {
  const double radius = 12.0, fillet = 4.0, deep = 8.0;
  const Surface surface = PlacedSurface(
      Turned({Line({0, 0}, {radius - fillet, 0}), Round({radius - fillet, 0}, {radius, 0}, {radius, fillet}),
              Line({radius, fillet}, {radius, deep}), Line({radius, deep}, {20, deep})}));
  const JobResult result = MillChecked(surface);
  // The top, the wall and the floor are left for each other once; not once for each piece of the rim.
  EXPECT_LE(result.report.motion.retract_count, 10);
  EXPECT_EQ(result.report.outcome, Outcome::kComplete);
}

// The ball's centre goes around in the hole, not around the wall from outside.
TEST(RoundParts, LeastFeedInAHole) {
  const double hole = 8.0, deep = 10.0, radius = 3.0;
  const Surface surface = PlacedSurface(
      Turned({Line({0, 0}, {hole, 0}), Line({hole, 0}, {hole, deep}), Line({hole, deep}, {20, deep})}));
  const JobResult result = MillChecked(surface);
  const double floor = kPi * std::pow(hole - radius, 2.0), top = kPi * (400.0 - hole * hole);
  const double wall = 2.0 * kPi * (hole - radius) * (deep - radius);
  const double s = BallJob(radius).operation.scallop, flat = 2.0 * std::sqrt(2.0 * radius * s - s * s);
  const double least = (floor + top + wall) / flat;
  EXPECT_NEAR(result.report.least_cut_length, least, 0.01 * least);
  EXPECT_GT(result.report.verify.cut_length, least);
}

// The hole is a thousandth wider than the ball. Every query beside its wall is a hard one.
TEST(RoundParts, HoleThatTheBallJustFits) {
  const double hole = 3.001, deep = 10.0;
  const Surface surface = PlacedSurface(
      Turned({Line({0, 0}, {hole, 0}), Line({hole, 0}, {hole, deep}), Line({hole, deep}, {12, deep})}));
  const JobResult result = MillChecked(surface);
  EXPECT_EQ(result.report.outcome, Outcome::kCompleteWhereReachable);
  EXPECT_GT(result.report.verify.cut_length, result.report.least_cut_length);
}

// The centre runs in rings shorter than a step. They are contours of the wall, not short passes of a level
// that barely touches something.
TEST(RoundParts, RingsInACloseHoleAreItsContours) {
  const double hole = 3.06, deep = 20.0;
  const Surface surface = PlacedSurface(
      Turned({Line({0, 0}, {hole, 0}), Line({hole, 0}, {hole, deep}), Line({hole, deep}, {12, deep})}));
  Job job = BallJob(3.0);
  const double s = job.operation.scallop, flat = 2.0 * std::sqrt(6.0 * s - s * s);
  ASSERT_LT(2.0 * kPi * (hole - 3.0), flat);
  const auto rings = [](const JobResult& result) {
    return std::count_if(result.motion.passes.begin(), result.motion.passes.end(),
                         [](const CutterPath& p) { return p.kind == PassKind::kContour && p.closed; });
  };
  EXPECT_GE(rings(MillChecked(surface, job)), (deep - 3.0) / flat - 1.0);
  job.operation.spirals = true;
  const JobResult wound = MillChecked(surface, job);
  EXPECT_TRUE(std::any_of(wound.motion.passes.begin(), wound.motion.passes.end(),
                          [](const CutterPath& p) { return p.traversal == Traversal::kSpiral; }));
}

// A hole as wide as the ball: it goes straight down. Where it is free there is one point to a level, and no
// height beside it.
TEST(RoundParts, HoleOfTheBallsOwnSize) {
  const double hole = 3.0, deep = 10.0;
  const Surface surface = PlacedSurface(
      Turned({Line({0, 0}, {hole, 0}), Line({hole, 0}, {hole, deep}), Line({hole, deep}, {12, deep})}));
  const JobResult result = MillChecked(surface);
  // What the ball leaves of a flat bottom; the wall above is finished.
  const double corner = kPi * hole * hole + 2.0 * kPi * hole * 3.0;
  double unreachable = 0.0;
  for (const double area : result.report.verify.unreachable_area) unreachable += area;
  EXPECT_LT(unreachable, 1.01 * corner);
  EXPECT_LE(result.report.motion.retract_count, 10);
}

// The hole is narrower than the ball by less than half the tolerance on each side. The ball enters and cuts
// into both sides by that.
TEST(RoundParts, HolesAndSlotsBarelyNarrowerThanTheBall) {
  for (const double half : {2.9995, 2.998, 2.995}) {
    if (half == 2.998 && !LongTests()) continue;
    const Surface hole = PlacedSurface(
        Turned({Line({0, 0}, {half, 0}), Line({half, 0}, {half, 6}), Line({half, 6}, {12, 6})}));
    EXPECT_LE(MillChecked(hole).report.motion.retract_count, 20) << half;
    const Surface slot = PlacedSurface(
        Drawn({Line({-12, 6}, {-half, 6}), Line({-half, 6}, {-half, 0}), Line({-half, 0}, {half, 0}),
               Line({half, 0}, {half, 6}), Line({half, 6}, {12, 6})},
              15.0));
    EXPECT_LE(MillChecked(slot).report.motion.retract_count, 20) << half;
  }
}

// The hole is narrower by more than that and by less than the whole tolerance. The part that the ball cannot
// enter is unreachable, and the rest is cut.
TEST(RoundParts, HolesAndSlotsThatTheToleranceAloneLetsTheBallInto) {
  for (const double half : {2.9945, 2.9905}) {
    if (half == 2.9945 && !LongTests()) continue;
    SCOPED_TRACE(half);
    const std::vector<Profile> narrow = {Line({0, 0}, {half, 0}), Line({half, 0}, {half, 6}),
                                         Line({half, 6}, {12, 6})};
    std::vector<Profile> slot = narrow;
    for (Profile profile : narrow) {
      for (Vec2& p : profile.points) p.x() = -p.x();
      std::reverse(profile.points.begin(), profile.points.end());
      slot.push_back(profile);
    }
    for (const PatchModel& model : {Turned(narrow), Drawn(slot, 15.0)}) {
      const JobResult result = MillChecked(PlacedSurface(model));
      EXPECT_EQ(result.report.outcome, Outcome::kCompleteWhereReachable);
      double concave = 0.0;
      for (const Region& r : result.report.regions)
        if (r.kind == RegionKind::kUnreachable && r.reason == UnreachableReason::kConcave) concave += r.area;
      EXPECT_GT(concave, half * 12.0);
    }
  }
}

// In a groove that bends, chords and links between centres within the reach tolerance may use the tolerance,
// too.
TEST(RoundParts, RingGroovesBarelyNarrowerThanTheBall) {
  for (const double gap : {5.9955, 5.99495}) {
    if (gap == 5.9955 && !LongTests()) continue;
    SCOPED_TRACE(gap);
    const double pin = 4.0, wall = pin + gap;
    MillChecked(
        PlacedSurface(Turned({Line({1, 4}, {pin, 4}), Line({pin, 4}, {pin, 0}), Line({pin, 0}, {wall, 0}),
                              Line({wall, 0}, {wall, 4}), Line({wall, 4}, {15, 4})})));
  }
}

// Caps of a sphere a little smaller than the ball. Near the limit it depends on the tolerance at the rim
// whether the bottom is reachable.
TEST(RoundParts, DimplesBarelySmallerThanTheBall) {
  for (const auto& [half_angle, radius] :
       {std::pair(70.0, 2.9985), {70.0, 2.993}, {70.0, 2.986}, {88.0, 2.996}}) {
    if (radius > 2.99 && half_angle == 70.0 && !LongTests()) continue;
    SCOPED_TRACE(::testing::Message() << half_angle << " degrees, radius " << radius);
    const double a = Radians(half_angle);
    const Vec2 rim(radius * std::sin(a), radius * (1.0 - std::cos(a)));
    const Profile cap{{{0, 0}, {radius * std::tan(0.5 * a), 0}, rim}, {1.0, std::cos(0.5 * a), 1.0}};
    MillChecked(PlacedSurface(Turned({cap, Line(rim, {8, rim.y()})})));
  }
}

// A bowl and a ring of the ball's own size: it touches the one all over, the other along whole circles.
TEST(RoundParts, HollowsOfTheBallsOwnSize) {
  for (const auto& profiles :
       {std::vector{Round({0, 0}, {3, 0}, {3, 3}), Line({3, 3}, {10, 3})},
        std::vector{Line({4, 4}, {6, 4}), Line({6, 4}, {6, 3}), Round({6, 3}, {6, 0}, {9, 0}),
                    Round({9, 0}, {12, 0}, {12, 3}), Line({12, 3}, {12, 4}), Line({12, 4}, {14, 4})},
        std::vector{Line({0, 0}, {6, 0}), Round({6, 0}, {9, 0}, {9, 3}), Line({9, 3}, {9, 5}),
                    Line({9, 5}, {14, 5})}}) {
    const JobResult result = MillChecked(PlacedSurface(Turned(profiles)));
    EXPECT_EQ(result.report.outcome, Outcome::kComplete);
    EXPECT_LE(result.report.motion.retract_count, 20);
  }
}

// A cap that overhangs: lines over it and over the plate around it end at its rim, they do not go up and down
// there.
TEST(RoundParts, CapOverAPlate) {
  const JobResult result = MillChecked(
      PlacedSurface(Turned({Line({0, 12}, {12, 12}), Line({12, 12}, {12, 10}), Line({12, 10}, {4, 10}),
                            Line({4, 10}, {4, 0}), Line({4, 0}, {20, 0})})));
  double upright = 0.0;
  const std::vector<Move>& moves = result.motion.toolpath.moves;
  for (std::size_t i = 1; i < moves.size(); ++i) {
    const Vec3 d = moves[i].to - moves[i - 1].to;
    if (moves[i].kind == MoveKind::kCut && Xy(d).norm() < 1e-9) upright += std::abs(d.z());
  }
  EXPECT_LT(upright, 20.0);  // mm; 140 lines cross a rim 9 mm high
  EXPECT_LT(result.report.verify.cut_length, 1.4 * result.report.least_cut_length);
  EXPECT_LE(result.report.motion.retract_count, 10);
}

// A rim that bulges by less than it is high: its ends lie over each other. Contours below it look at its plan
// alone.
TEST(RoundParts, BulgingRim) {
  const Profile rim{{{12, 14}, {12.02, 12}, {12, 10}}, {1.0, std::sqrt(0.5), 1.0}};
  PatchModel model = Turned({Line({0, 14}, {12, 14}), rim, Line({12, 10}, {4, 10}), Line({4, 10}, {4, 0})});
  for (Patch& patch : Turned({Line({0, 9}, {6, 0})}).patches) {
    for (Vec3& p : std::get<BezierPatch>(patch.shape).points) p.x() += 20.0;
    model.patches.push_back(std::move(patch));
  }
  BezierPatch plate;
  plate.degree_u = plate.degree_v = 1;
  plate.points = {{-20, -20, 0}, {-20, 20, 0}, {35, -20, 0}, {35, 20, 0}};
  model.patches.push_back({"", std::move(plate)});
  MillChecked(PlacedSurface(std::move(model)));
}

std::vector<Profile> Terraces() {
  return {Line({0, 20}, {5, 20}), Line({5, 20}, {5, 10}), Line({5, 10}, {10, 10}), Line({10, 10}, {10, 5}),
          Line({10, 5}, {15, 5}), Line({15, 5}, {15, 0}), Line({15, 0}, {20, 0})};
}

// What the ball reaches of them is too narrow for regions of its own, and cut along circles all the same.
TEST(RoundParts, TerracesAlongCircles) {
  const JobResult result = MillChecked(PlacedSurface(Turned(Terraces())));
  int around = 0;
  for (const RegionChoice& choice : result.report.choices) around += !choice.around.empty();
  EXPECT_EQ(around, 3);
  // 1.51 along straight lines.
  EXPECT_LT(result.report.verify.cut_length, 1.35 * result.report.least_cut_length);
  EXPECT_LE(result.report.motion.retract_count, 8);
}

// Tilted, so that contours roll over all of the edges.
TEST(RoundParts, NoContourOverEdgesAlone) {
  PatchModel model = Turned(Terraces());
  const Eigen::Matrix3d tilt = Eigen::AngleAxisd(Radians(20.0), Vec3::UnitX()).toRotationMatrix();
  for (Patch& patch : model.patches) {
    for (Vec3& p : std::get<BezierPatch>(patch.shape).points) p = tilt * p;
  }
  const JobResult result = MillChecked(PlacedSurface(std::move(model)));
  const double radius = 3.0, s = BallJob(radius).operation.scallop,
               flat = 2.0 * std::sqrt(2.0 * radius * s - s * s);
  // The sine of the angle between the way to the centre and the normal of a ledge or a wall there.
  const auto off_ground = [&](const Vec3& center, const std::optional<SurfacePoint>& at) {
    if (!at) return 1.0;
    if (Xy(tilt.transpose() * at->p).norm() > 19.999) return 0.0;  // a sheet's highest border
    const Vec3 e = tilt.transpose() * (center - at->p).normalized(), p = tilt.transpose() * at->p;
    return std::min(e.cross(Vec3::UnitZ()).norm(), e.cross(Lift(Xy(p).normalized(), 0.0)).norm());
  };
  int contours = 0;
  for (const CutterPath& pass : result.motion.passes) {
    if (pass.kind != PassKind::kContour) continue;
    ++contours;
    double least = 1.0;
    for (const CutterPoint& p : pass.points) {
      least = std::min({least, off_ground(p.center, p.contact), off_ground(p.center, p.other_contact)});
    }
    EXPECT_LT(least, 0.51 * flat / radius) << "at z " << pass.points.front().center.z();
  }
  EXPECT_GT(contours, 20);
}

TEST(RoundParts, PinOnAPlate) {
  const double radius = 6.0, round = 1.0, fillet = 4.0, high = 8.0;
  const Surface surface = PlacedSurface(Turned(
      {Line({0, high}, {radius - round, high}),
       Round({radius - round, high}, {radius, high}, {radius, high - round}),
       Line({radius, high - round}, {radius, fillet}),
       Round({radius, fillet}, {radius, 0}, {radius + fillet, 0}), Line({radius + fillet, 0}, {18, 0})}));
  const JobResult result = MillChecked(surface);
  EXPECT_LE(result.report.motion.retract_count, 10);
  EXPECT_EQ(result.report.outcome, Outcome::kComplete);
}

// A drilled hole with a round bottom, 3 um narrower than the ball all around: everywhere about as near to the
// limit as the reach tolerance allows. Whether it is reachable must be found without looking at every micron
// of it.
TEST(RoundParts, ABlindHoleALittleTooNarrow) {
  const double radius = 2.997;
  MillChecked(PlacedSurface(Turned({Line({9, 0}, {radius, 0}), Line({radius, 0}, {radius, -4}),
                                    Round({radius, -4}, {radius, -4 - radius}, {0, -4 - radius})})));
}

}  // namespace
}  // namespace patchmill
