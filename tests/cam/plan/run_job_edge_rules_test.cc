// What the ball does at open borders: STOP, ROLL, EXTEND, judged by the program's text.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "cam/plan/resolve.h"
#include "cam/post/program_reader.h"
#include "tests/support/jobs/jobs.h"
#include "tests/support/profiles.h"
#include "tests/support/shapes.h"

namespace patchmill {
namespace {

using namespace testing;  // NOLINT: the support folder's

constexpr double kHalf = 8.0, kRadius = 3.0;

Job EdgeJob(EdgeRule rule) {
  Job job = BallJob(kRadius);
  job.operation.scallop = 0.03;
  job.operation.edge_rule = rule;
  return job;
}

// Centres of feed moves that no plunge or retract makes, from the text.
struct Feed {
  Vec3 from, to;
};
std::vector<Feed> LevelFeeds(const JobResult& result) {
  const auto motion = ReadProgram(result.program);
  EXPECT_TRUE(motion.ok()) << motion.status();
  std::vector<Feed> feeds;
  for (const ProgramMove& m : motion->moves) {
    if (m.kind != ProgramMove::Kind::kFeed || Xy(Vec3(m.to - m.from)).norm() < 1e-9) continue;
    feeds.push_back({m.from + Vec3(0, 0, kRadius), m.to + Vec3(0, 0, kRadius)});
  }
  return feeds;
}

double FarthestCut(const JobResult& result, int axis) {
  double most = 0.0;
  for (const CutterPath& pass : result.motion.passes) {
    for (const CutterPoint& p : pass.points) most = std::max(most, std::abs(p.center[axis]));
  }
  return most;
}

double Distance(const Vec3& p, const std::vector<Feed>& feeds) {
  double least = kInfinity;
  for (const Feed& f : feeds) {
    const Vec3 d = f.to - f.from;
    const double t = std::clamp((p - f.from).dot(d) / d.squaredNorm(), 0.0, 1.0);
    least = std::min(least, (p - f.from - t * d).norm());
  }
  return least;
}

// What stands at most of a layer as thick as the allowance around the border of the plate, seen from the
// border outward in directions up to 90 degrees from the plate's normal: the fin.
double Fin(const JobResult& result, double allowance) {
  const std::vector<Feed> feeds = LevelFeeds(result);
  double fin = 0.0;
  for (int k = 0; k < 40; ++k) {
    const double along = kHalf * (2.0 * (k + 0.5) / 40.0 - 1.0);
    for (int side = 0; side < 4; ++side) {
      const Vec2 out = side < 2 ? Vec2(side == 0 ? 1 : -1, 0) : Vec2(0, side == 2 ? 1 : -1);
      const Vec2 border = kHalf * out + along * Vec2(out.y(), out.x());
      for (int a = 0; a <= 90; a += 10) {
        const Vec3 e(std::sin(Radians(a)) * out.x(), std::sin(Radians(a)) * out.y(), std::cos(Radians(a)));
        for (double t = 0.05; t <= allowance + 1e-9; t += 0.05) {
          if (Distance(Lift(border, 0.0) + t * e, feeds) > kRadius) fin = std::max(fin, t);
        }
      }
    }
  }
  return fin;
}

TEST(EdgeRules, StopStaysWithinTheBorder) {
  const Job job = EdgeJob(EdgeRule::kStop);
  const JobResult result = Mill(PlacedSurface(Plane(kHalf)), job);
  ASSERT_TRUE(result.report.verify.ok()) << Describe(result);
  for (int axis = 0; axis < 2; ++axis) EXPECT_LE(FarthestCut(result, axis), kHalf + 1e-3);
}

TEST(EdgeRules, RollLeavesNoFin) {
  const Surface surface = PlacedSurface(Plane(kHalf));
  const Job job = EdgeJob(EdgeRule::kRoll);
  const JobResult result = Mill(surface, job);
  ASSERT_TRUE(result.report.verify.ok()) << Describe(result);
  // To the split angle of 45 degrees and half a step on, never farther than the ball touches.
  const double reach = kRadius * std::sin(job.operation.steep_angle);
  for (int axis = 0; axis < 2; ++axis) {
    EXPECT_GE(FarthestCut(result, axis), kHalf + reach - 1e-3);
    EXPECT_LE(FarthestCut(result, axis), kHalf + kRadius);
  }
  // Between lines that end with a contact at 45 degrees, seen at 90: the scallop over the cosine, in steps
  // of 0.05.
  EXPECT_LE(Fin(result, job.setup.allowance.walls), job.operation.scallop / std::cos(Radians(45.0)) + 0.05);
  const JobResult stopped = Mill(surface, EdgeJob(EdgeRule::kStop));
  EXPECT_GT(Fin(stopped, job.setup.allowance.walls), 0.3) << "else this test shows nothing";
  Random random(3);
  CheckProgram(surface, job, result, random, 2000);
}

TEST(EdgeRules, RollIsHeldByTheFloor) {
  Job job = EdgeJob(EdgeRule::kRoll);
  job.operation.floor_z = 0.0;
  const JobResult result = Mill(PlacedSurface(Plane(kHalf)), job);
  ASSERT_TRUE(result.report.verify.ok()) << Describe(result);
  EXPECT_GE(result.report.verify.tip_z_min, -1e-4);
}

// Passes run around the rim of a cup. They do not cross it in short passes with an approach and a retract
// each. Still nothing stays of the layer on the rim, from its top to the place that the contours of the wall
// touch.
TEST(EdgeRules, RimOfACupIsGoneAround) {
  const double rim = 12.6, high = 12.0;
  const Surface surface = PlacedSurface(
      Turned({Line({0, 0}, {9, 0}), Round({9, 0}, {12, 0}, {12, 3}), Line({12, 3}, {rim, high})}));
  const Job job = EdgeJob(EdgeRule::kStop);
  const JobResult result = Mill(surface, job);
  ASSERT_TRUE(result.report.verify.ok()) << Describe(result);
  EXPECT_LE(result.report.motion.retract_count, 4);
  const std::vector<Feed> feeds = LevelFeeds(result);
  for (int k = 0; k < 36; ++k) {
    const double turn = 2.0 * kPi * (k + 0.5) / 36.0;
    const Vec2 out(std::cos(turn), std::sin(turn));
    for (int a = 0; a <= 85; a += 5) {
      const Vec3 e = Lift(-std::sin(Radians(a)) * out, std::cos(Radians(a)));
      for (double t = 0.05; t <= job.setup.allowance.walls + 1e-9; t += 0.05)
        EXPECT_LE(Distance(Lift(rim * out, high) + t * e, feeds), kRadius + job.operation.scallop)
            << Degrees(turn) << " " << a << " " << t;
    }
  }
  Random random(5);
  CheckProgram(surface, job, result, random, 1000);
}

TEST(EdgeRules, ExtendRunsOnByABallRadius) {
  const Surface surface = PlacedSurface(Plane(kHalf));
  const Job job = EdgeJob(EdgeRule::kExtend);
  const JobResult result = Mill(surface, job);
  ASSERT_TRUE(result.report.verify.ok()) << Describe(result);
  EXPECT_NEAR(FarthestCut(result, 0), kHalf + kRadius, 1e-3);  // lines run along x
  EXPECT_LE(FarthestCut(result, 1), kHalf + 1e-3);
  for (const CutterPath& pass : result.motion.passes) {
    if (pass.kind != PassKind::kZigzag) continue;
    EXPECT_NEAR(std::abs(pass.points.front().center.x()), kHalf + kRadius, 1e-3);
    EXPECT_NEAR(std::abs(pass.points.back().center.x()), kHalf + kRadius, 1e-3);
    EXPECT_FALSE(pass.points.front().contact.has_value());
  }
  Random random(4);
  CheckProgram(surface, job, result, random, 2000);
}

// A line along the border that ends where the selection does has no edge before it.
TEST(EdgeRules, ExtendDoesNotRunOverWhatIsNotSelected) {
  // The edge bends outwards where the selection ends: y = x^2 / 30 - 8.
  const auto half = [](double side) {
    BezierPatch patch{2, 1, {}, {}};
    for (const Vec2& p :
         {Vec2(0, -kHalf), Vec2(0.5 * kHalf, -kHalf), Vec2(kHalf, kHalf * kHalf / 30.0 - kHalf)}) {
      for (const double y : {p.y(), kHalf}) patch.points.emplace_back(side * p.x(), y, 0.0);
    }
    return Single(std::move(patch));
  };
  const Surface surface = PlacedSurface(Join({half(-1.0), half(1.0)}));
  for (const bool borders : {true, false}) {
    Job job = EdgeJob(EdgeRule::kExtend);
    job.operation.border_passes = borders;
    job.operation.selection.patches = {"#0"};
    const JobResult result = Mill(surface, job);
    ASSERT_TRUE(result.report.verify.ok()) << Describe(result);
    const double step = 2.0 * std::sqrt(2.0 * kRadius * job.operation.scallop);
    double left = 0.0, right = -kHalf;
    for (const CutterPath& pass : result.motion.passes) {
      for (const CutterPoint& p : pass.points) {
        left = std::min(left, p.center.x());
        right = std::max(right, p.center.x());
      }
    }
    EXPECT_NEAR(left, -kHalf - kRadius, 1e-3);
    EXPECT_LE(right, 1.3 * step);
  }
}

TEST(EdgeRules, ExtendEndsBeforeWhatIsInTheWay) {
  // A wall 5 mm beyond the border: the centre of a ball of 3 mm may go 2 mm beyond it, no whole radius.
  const Surface surface = PlacedSurface(Join(
      {Plane(kHalf), Transformed(Plane(kHalf), Eigen::Affine3d(Eigen::Translation3d(10 + kRadius, 0, 0) *
                                                               Eigen::AngleAxisd(kPi / 2, Vec3::UnitY())))}));
  const Job job = EdgeJob(EdgeRule::kExtend);
  const JobResult result = Mill(surface, job);
  ASSERT_TRUE(result.report.verify.ok()) << Describe(result);
  double least = 0.0, most = 0.0;
  for (const CutterPath& pass : result.motion.passes) {
    if (pass.kind != PassKind::kZigzag || std::abs(pass.points.front().center.z() - kRadius) > 1e-6) continue;
    for (const CutterPoint* p : {&pass.points.front(), &pass.points.back()}) {
      least = std::min(least, p->center.x());
      most = std::max(most, p->center.x());
    }
  }
  EXPECT_NEAR(least, -kHalf - kRadius, 1e-3);
  EXPECT_NEAR(most, kHalf + 0.5 * kRadius, 1e-3);  // half a radius fits
  Random random(5);
  CheckProgram(surface, job, result, random, 2000);
}

// A sheet that bends both ways, so that its borders are curves in space.
class CurvedSheet : public ::testing::TestWithParam<double> {
 protected:
  static Surface Sheet(double bend) {
    const auto height = [bend](double x, double y) { return bend * (x * x - 0.5 * y * y) + 0.1 * x; };
    return PlacedSurface(Single(InterpolatedHeights(height, -kHalf, kHalf, -kHalf, kHalf, 8, 8)));
  }
};

TEST_P(CurvedSheet, RollGoesOverTheBorderAndKeepsThePromises) {
  const Surface surface = Sheet(GetParam());
  const Job job = EdgeJob(EdgeRule::kRoll);
  const JobResult result = Mill(surface, job);
  ASSERT_TRUE(result.report.verify.ok()) << Describe(result);
  const JobResult stopped = Mill(surface, EdgeJob(EdgeRule::kStop));
  ASSERT_TRUE(stopped.report.verify.ok()) << Describe(stopped);
  const auto resolved = Resolve(surface, job, RunContext());
  ASSERT_TRUE(resolved.ok()) << resolved.status();
  for (int axis = 0; axis < 2; ++axis) {
    // To where it touches the border at the split angle at least, and farther than when it stops there. The
    // sheet bends along the border: where a line as long as the ball's radius ends it has the slope `along`.
    const double flattest = std::cos(resolved->split_angle), along = GetParam() * kRadius;
    const double reach = kRadius * std::sqrt(1.0 - flattest * flattest * (1.0 + along * along));
    EXPECT_GE(FarthestCut(result, axis), kHalf + reach);
    EXPECT_GE(FarthestCut(result, axis), FarthestCut(stopped, axis) + 0.2 * kRadius);
    EXPECT_LE(FarthestCut(result, axis), kHalf + kRadius + 1e-6);
  }
  Random random(6);
  CheckProgram(surface, job, result, random, 2000);
}

TEST_P(CurvedSheet, ExtendLeavesAlongTheSurface) {
  const Surface surface = Sheet(GetParam());
  const Job job = EdgeJob(EdgeRule::kExtend);
  const JobResult result = Mill(surface, job);
  ASSERT_TRUE(result.report.verify.ok()) << Describe(result);
  int ends = 0;
  for (const CutterPath& pass : result.motion.passes) {
    if (pass.kind != PassKind::kZigzag || pass.points.size() < 3) continue;
    for (const bool last : {false, true}) {
      const std::size_t n = pass.points.size();
      const CutterPoint &end = pass.points[last ? n - 1 : 0], &border = pass.points[last ? n - 2 : 1],
                        &before = pass.points[last ? n - 3 : 2];
      if (end.contact || !border.contact) continue;
      ++ends;
      EXPECT_NEAR(std::abs(border.contact->p.x()), kHalf, 1e-6);
      EXPECT_NEAR((end.center - border.center).norm(), kRadius, 1e-6);
      const Vec3 out = (end.center - border.center).normalized();
      const Vec3 along = (border.center - before.center).normalized();
      EXPECT_LT(std::acos(std::min(1.0, out.dot(along))), Radians(10.0));
    }
  }
  EXPECT_GE(ends, 20);
  Random random(7);
  CheckProgram(surface, job, result, random, 2000);
}

INSTANTIATE_TEST_SUITE_P(Bends, CurvedSheet, ::testing::Values(0.02, -0.02, 0.05));

}  // namespace
}  // namespace patchmill
