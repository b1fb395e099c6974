// Rapids below the clearance plane ([verification P3]): clear of the stock over the whole rectangle between
// their ends, judged here by heights of the ball with the stock around it.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "cam/location/locator.h"
#include "tests/support/fuzz.h"
#include "tests/support/jobs/limited_job.h"
#include "tests/support/random_part.h"
#include "tests/support/shapes.h"

namespace patchmill {
namespace {

using namespace testing;  // NOLINT: the support folder's

struct Rapid {
  Vec3 from, to;  // centres
};

// Those that go across, but for the first and the last, which are at clearance.
std::vector<Rapid> RapidsAcross(const JobResult& result) {
  std::vector<Rapid> rapids;
  const std::vector<Move>& moves = result.motion.toolpath.moves;
  for (std::size_t i = 1; i < moves.size(); ++i) {
    if (moves[i].kind != MoveKind::kRapid || Xy(moves[i].to - moves[i - 1].to).norm() < 1e-6) continue;
    EXPECT_NEAR(moves[i].to.z(), moves[i - 1].to.z(), 1e-9) << "across, then down";
    rapids.push_back({moves[i - 1].to, moves[i].to});
  }
  return rapids;
}

// Largest height of `locator` over the rectangle between the ends, above the rapid.
double Excess(const Locator& locator, const Rapid& rapid, int n) {
  double most = -kInfinity;
  for (int i = 0; i <= n; ++i) {
    for (int j = 0; j <= n; ++j) {
      const Vec2 share(double(i) / n, double(j) / n);
      const Vec2 q = Xy(rapid.from) + share.cwiseProduct(Xy(rapid.to - rapid.from));
      if (const auto h = locator.Height(q)) most = std::max(most, h->z - rapid.from.z());
    }
  }
  return most;
}

TEST(LowRapids, ClearTheStockOverTheRectangleOnRandomParts) {
  Random random(77);
  int low = 0;
  double at_clearance = 0.0, lower = 0.0;
  for (int i = 0; i < (kSanitized ? 2 : CountOf(3, 12)); ++i) {
    SCOPED_TRACE(i);
    const RandomPart part = DrawPart(random);
    const Surface surface = PlacedSurface(part.model);
    Job job = BallJob(part.radius);
    job.operation.one_way = i % 3 == 0;
    const JobResult high = Mill(surface, job);
    job.setup.allowance_stated = true;
    const JobResult result = Mill(surface, job);
    ASSERT_EQ(result.report.outcome, high.report.outcome) << Describe(result);
    if (result.program.empty()) continue;
    Random places(static_cast<std::uint64_t>(i));  // so that the next part does not depend on this program
    CheckProgram(surface, job, result, places, 200);
    at_clearance += high.report.motion.time;
    lower += result.report.motion.time;
    const Locator stock(surface, part.radius + job.setup.allowance.walls + job.operation.approach_gap);
    for (const Rapid& rapid : RapidsAcross(result)) {
      ASSERT_LE(Excess(stock, rapid, 12), 1e-6) << rapid.from.transpose() << " to " << rapid.to.transpose();
      ++low;
    }
  }
  EXPECT_GT(low, CountOf(5, 20));
  EXPECT_LT(lower, at_clearance);
}

// A plateau on either side of a ridge, and a tower far away. Rapids go as high as the ridge, not as the
// tower.
TEST(LowRapids, AreAsHighAsTheSurfaceBetween) {
  const Surface surface = PlacedSurface(Join(
      {Plane(40), Cylinder(Vec3::Zero(), 6, 40, Half::kUpper), Sphere(Vec3(30, 30, 20), 5, Half::kAll)}));
  Job job = LimitedJob();
  job.setup.allowance_stated = true;
  job.operation.selection.boundary = {RingOfBox(-20, -20, -12, -10), RingOfBox(12, -20, 20, -10)};
  const JobResult result = Mill(surface, job);
  ASSERT_EQ(result.report.outcome, Outcome::kCompleteWhereReachable) << Describe(result);
  const double clear = kLimitedRadius + job.setup.allowance.walls + job.operation.approach_gap;
  double highest = 0.0;
  for (const Rapid& rapid : RapidsAcross(result)) {
    if (rapid.from.x() * rapid.to.x() < 0.0) highest = std::max(highest, rapid.from.z());
  }
  EXPECT_GE(highest, 6.0 + clear);
  EXPECT_LE(highest, 6.0 + clear + 0.1 + 1e-9);
  EXPECT_LT(result.report.verify.rapid_length, 200.0);
}

TEST(LowRapids, PassOverClampsWithTheirMargins) {
  const Surface surface = PlacedSurface(Plane(40));
  Job job = LimitedJob();
  job.setup.allowance_stated = true;
  job.setup.stock_top_z = 12.0;
  job.operation.selection.boundary = {RingOfBox(-20, -20, -12, 10), RingOfBox(12, -20, 20, 10)};
  job.setup.obstacles = {{"clamp", RingOfBox(-1, -40, 1, 40), 5.0, 2.0}};
  const JobResult result = Mill(surface, job);
  ASSERT_EQ(result.report.outcome, Outcome::kCompleteWhereReachable) << Describe(result);
  int over = 0;
  for (const Rapid& rapid : RapidsAcross(result)) {
    const double tip = rapid.from.z() - kLimitedRadius;
    if (rapid.from.x() * rapid.to.x() < 0.0) {
      EXPECT_NEAR(tip, 7.0, 1e-9);
      ++over;
    } else {
      EXPECT_LE(tip, 1.6 + 1e-9);
    }
  }
  EXPECT_GE(over, 1);
}

TEST(LowRapids, KeepTheMarginOfAvoidedPatches) {
  const Surface surface = PlacedSurface(Join({Plane(40), Cylinder(Vec3::Zero(), 6, 40, Half::kUpper)}));
  Job job = LimitedJob();
  job.setup.allowance_stated = true;
  job.setup.stock_top_z = 30.0;
  job.operation.selection.boundary = {RingOfBox(-25, -20, -16, -10), RingOfBox(16, -20, 25, -10)};
  for (std::size_t i = 1; i < surface.network.model.patches.size(); ++i)
    job.operation.selection.avoid.push_back(fmt::format("#{}", i));
  job.operation.selection.avoid_margin = 6.0;
  const JobResult result = Mill(surface, job);
  ASSERT_EQ(result.report.outcome, Outcome::kCompleteWhereReachable) << Describe(result);
  double highest = 0.0;
  for (const Rapid& rapid : RapidsAcross(result)) {
    if (rapid.from.x() * rapid.to.x() < 0.0) highest = std::max(highest, rapid.from.z());
  }
  EXPECT_GE(highest, 6.0 + kLimitedRadius + 6.0);
  EXPECT_LE(highest, 6.0 + kLimitedRadius + 6.0 + 0.1 + 1e-9);
}

}  // namespace
}  // namespace patchmill
