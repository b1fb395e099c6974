// Whole jobs over legal surfaces with awkward parameters: verified, and in the time of usual ones.
#include <algorithm>
#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

#include "cam/post/program_reader.h"
#include "cam/toolpath/segment_metric.h"
#include "tests/support/clock.h"
#include "tests/support/hard_parts.h"
#include "tests/support/jobs/jobs.h"
#include "tests/support/shapes.h"

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
  // Links of such a short job may differ by some percent.
  EXPECT_LE(two.report.verify.cut_length, 1.15 * one.report.verify.cut_length);
}

// The deepest leftover of a reason, against plain distances from a dense sample to the feed moves of the
// text.
TEST(RunJobHardParts, DeepestLeftover) {
  for (const std::uint64_t seed : {3u, 8u}) {
    const Surface surface =
        testing::PlacedSurface(testing::RandomBspline(seed, {.spans = 5, .size = 40.0, .amplitude = 2.5}));
    Job job = HardJob();
    job.operation.strategy = Strategy::kContour;
    const JobResult result = testing::Mill(surface, job);
    ASSERT_FALSE(result.program.empty()) << testing::Describe(result);
    std::vector<PathSegment> moves;
    const auto motion = ReadProgram(result.program);
    ASSERT_TRUE(motion.ok()) << motion.status();
    for (const ProgramMove& move : motion->moves) {
      if (move.kind == ProgramMove::Kind::kFeed)
        moves.push_back({move.from + Vec3(0, 0, 3.0), move.to + Vec3(0, 0, 3.0)});
    }
    double dense = 0.0, deepest = 0.0;
    for (const Piece& piece : surface.pieces) {
      constexpr int kSamples = 40;
      for (int k = 0; k < kSamples * kSamples; ++k) {
        const Vec3 p = Position(piece, (k / kSamples + 0.5) / kSamples, (k % kSamples + 0.5) / kSamples);
        double least = kInfinity;
        for (const PathSegment& move : moves) {
          if (least <= 3.0 + dense) break;  // nothing deeper
          least = std::min(least, PathDistance(move, p));
        }
        dense = std::max(dense, least - 3.0);
      }
    }
    for (const double of_reason : result.report.verify.deepest_unreachable)
      deepest = std::max(deepest, of_reason);
    ASSERT_GT(dense, 0.05) << "nothing is left by these contours";
    EXPECT_GE(deepest, 0.98 * dense) << seed;
    EXPECT_LE(deepest, 1.1 * dense + 0.005) << seed;  // a sample is not the deepest place
  }
}

TEST(RunJobHardParts, UnevenWeights) {
  const double even = ProcessorSeconds(testing::WeightedOctant(1.0));
  EXPECT_LE(ProcessorSeconds(testing::WeightedOctant(1e6)), 3.0 * even + 0.2);
}

}  // namespace
}  // namespace patchmill
