// Whole jobs of unlike parts stop within 0.2 s of a cancel, at random moments: in proofs, trees, regions,
// passes, links and verification. Hard parts, whose proofs are long, are among them.
#include <algorithm>
#include <functional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "cam/plan/plan.h"
#include "tests/support/cancel_latency.h"
#include "tests/support/clock.h"
#include "tests/support/fuzz.h"
#include "tests/support/hard_parts.h"
#include "tests/support/jobs/jobs.h"
#include "tests/support/random.h"
#include "tests/support/sanitized.h"
#include "tests/support/shapes.h"
#include "tests/support/walls.h"

namespace patchmill {
namespace {

struct CancelledJob {
  std::string name;
  std::function<PatchModel()> part;
  double radius = 3.0, scallop = 0.02;  // mm
};

class CancelJobs : public ::testing::TestWithParam<CancelledJob> {};

TEST_P(CancelJobs, StopWithinAFifthOfASecond) {
  const CancelledJob& given = GetParam();
  const PatchModel model = given.part();
  Job job = testing::BallJob(given.radius);
  job.operation.scallop = given.scallop;
  const auto work = [&](const RunContext& run) -> absl::Status {
    const auto surface = BuildPlacedSurface(model, {}, run);
    if (!surface.ok()) return surface.status();
    return RunJob(*surface, job, run).status();
  };
  constexpr double kLatency = testing::kSanitized ? 3.0 : 0.2;
  // Moments lie within this processor time: a hard job need not come to its end. A short one ends before.
  double most = testing::kSanitized ? 10.0 : testing::LongTests() ? 6.0 : 1.5;
  const double begin = testing::ClockSeconds(CLOCK_PROCESS_CPUTIME_ID);
  const testing::CancelLatency whole = testing::CancelAfter(most, work);
  EXPECT_LE(whole.seconds, kLatency) << "cancelled after " << most << " s";
  if (whole.status.ok()) most = std::min(most, testing::ClockSeconds(CLOCK_PROCESS_CPUTIME_ID) - begin);
  testing::Random random(461);
  double longest = whole.seconds;
  int stopped = 0;
  for (int k = 0; k < testing::CountOf(testing::kSanitized ? 2 : 5, 40); ++k) {
    const double after = random.Uniform(0.0, most);
    const testing::CancelLatency latency = testing::CancelAfter(after, work);
    EXPECT_LE(latency.seconds, kLatency) << "cancelled after " << after << " s";
    longest = std::max(longest, latency.seconds);
    if (latency.status.ok()) continue;  // the job was done before
    EXPECT_EQ(latency.status.code(), absl::StatusCode::kCancelled) << latency.status;
    ++stopped;
  }
  EXPECT_GE(stopped, 1) << "the job is too short for this test";
  RecordProperty("longest latency", std::to_string(longest));
}

INSTANTIATE_TEST_SUITE_P(
    Jobs, CancelJobs,
    ::testing::Values(
        CancelledJob{"CuspedRidge", [] { return testing::CuspedRidge(0.05); }, 0.5},
        CancelledJob{"CubedPlane", [] { return testing::CubedPlane(); }},
        CancelledJob{"WeightedOctant", [] { return testing::WeightedOctant(1e6); }},
        CancelledJob{"Cylinder", [] { return testing::Cylinder(Vec3::Zero(), 15.0, 30.0); }},
        CancelledJob{"HighDegree",
                     [] { return testing::Single(testing::RandomBezier(3, 15, 15, true, 60.0)); }},
        CancelledJob{"Bumps", [] { return testing::RandomBspline(7, {.spans = 12, .size = 50.0}); }, 2.0},
        CancelledJob{"OpenBox", [] { return testing::OpenBox(60, 40, 20); }},
        CancelledJob{"Torus", [] { return testing::Torus(Vec3::Zero(), 30.0, 8.0, testing::Half::kUpper); },
                     2.0},
        CancelledJob{"GregoryTriangle",
                     [] {
                       return testing::Single(
                           testing::RandomGregoryTriangle(5, GregoryPatch::Blend::kCorner, 40.0));
                     }},
        CancelledJob{"TwoHills", [] { return testing::TwoHills(); }, 2.0, 0.005}),
    [](const auto& of) { return of.param.name; });

}  // namespace
}  // namespace patchmill
