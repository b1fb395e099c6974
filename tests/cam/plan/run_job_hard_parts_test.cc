// Whole jobs over legal surfaces with awkward parameters: verified, and in the time of usual ones.
#include <gtest/gtest.h>

#include "tests/support/clock.h"
#include "tests/support/hard_parts.h"
#include "tests/support/jobs/jobs.h"

namespace patchmill {
namespace {

Job HardJob() {
  Job job = testing::BallJob(3.0);
  job.operation.scallop = 0.02;
  return job;
}

double ProcessorSeconds(const PatchModel& part) {
  const double start = testing::ClockSeconds(CLOCK_PROCESS_CPUTIME_ID);
  testing::MillChecked(testing::PlacedSurface(part), HardJob());
  return testing::ClockSeconds(CLOCK_PROCESS_CPUTIME_ID) - start;
}

TEST(RunJobHardParts, StationaryLines) {
  testing::MillChecked(testing::PlacedSurface(testing::CubedPlane()), HardJob());
  testing::MillChecked(testing::PlacedSurface(testing::CuspedRidge()), HardJob());
}

// Patches that coincide are milled once, and the lower bound of the length counts them once.
TEST(RunJobHardParts, Copies) {
  const PatchModel dome = testing::Paraboloid(-0.01, 20.0);
  PatchModel both = testing::Join({dome, dome});
  for (Vec3& p : std::get<BezierPatch>(both.patches[1].shape).points) p.z() += 1e-7;
  const JobResult one = testing::MillChecked(testing::PlacedSurface(dome), HardJob());
  const JobResult two = testing::MillChecked(testing::PlacedSurface(both), HardJob());
  EXPECT_NEAR(two.report.least_cut_length, one.report.least_cut_length, 0.01 * one.report.least_cut_length);
  EXPECT_GE(two.report.verify.cut_length, two.report.least_cut_length);
  EXPECT_LE(two.report.verify.cut_length, 1.1 * one.report.verify.cut_length);
}

TEST(RunJobHardParts, UnevenWeights) {
  const double even = ProcessorSeconds(testing::WeightedOctant(1.0));
  EXPECT_LE(ProcessorSeconds(testing::WeightedOctant(1e6)), 3.0 * even + 0.2);
}

}  // namespace
}  // namespace patchmill
