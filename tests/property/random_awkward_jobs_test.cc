// Jobs over awkward parts - every kind of patch, doubled ones, slivers, walls, tiny and huge ones - keep the
// promises [verification, section 1], or have nothing to cut.
#include <algorithm>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "core/surface/surface.h"
#include "tests/support/fuzz.h"
#include "tests/support/jobs/jobs.h"
#include "tests/support/random_part.h"

namespace patchmill {
namespace {

using namespace testing;  // NOLINT: the support folder's

struct AwkwardJob {
  Surface surface;
  Job job;
  std::string text;
};

AwkwardJob Draw(std::uint64_t seed) {
  Random random(seed);
  PatchModel model = DrawPart(random).model;
  const double size = BuildPlacedSurface(model, {}, RunContext())->box.Diagonal();
  double wanted = random.Uniform(8.0, 24.0);
  if (const int scale = random.Int(6); scale < 2) wanted *= scale == 0 ? 0.05 : 20.0;
  model = Transformed(model, Eigen::Affine3d(Eigen::Scaling(wanted / size)));
  const double radius = wanted * random.Uniform(0.05, 0.2);
  AwkwardJob drawn{PlacedSurface(model), BallJob(radius, random.Int(2) == 0), {}};
  Operation& op = drawn.job.operation;
  op.scallop = radius * random.Uniform(0.005, 0.03);
  op.tolerance = std::max(2e-4, radius * random.Uniform(0.003, 0.02));
  op.steep_angle = Radians(random.Uniform(15.0, 75.0));
  op.zigzag_angle = random.Uniform(0.0, kPi);
  drawn.text = fmt::format("seed {}: {} patches, {:.3g} mm, R {:.4g}, scallop {:.4g}, tolerance {:.4g}", seed,
                           model.patches.size(), wanted, radius, op.scallop, op.tolerance);
  return drawn;
}

class RandomAwkwardJobs : public ::testing::TestWithParam<int> {};

TEST_P(RandomAwkwardJobs, KeepThePromises) {
  const auto seed = static_cast<std::uint64_t>(GetParam());
  const AwkwardJob drawn = Draw(seed);
  SCOPED_TRACE(drawn.text);
  const JobResult result = Mill(drawn.surface, drawn.job);
  if (result.report.outcome == Outcome::kNothingToCut) {
    EXPECT_TRUE(result.program.empty());
    // A square of one flat step-over is the least that passes side by side finish.
    const double scallop = drawn.job.operation.scallop, radius = BallRadius(drawn.job.operation.tool);
    EXPECT_LT(result.report.verify.reachable_area, 4.0 * scallop * (2.0 * radius - scallop))
        << Describe(result);
    return;
  }
  Random random(seed + 1000);
  CheckProgram(drawn.surface, drawn.job, result, random, kSanitized ? 50 : 500);
}
INSTANTIATE_TEST_SUITE_P(Seeds, RandomAwkwardJobs, JobSeeds(7000, kSanitized ? 4 : 12));

}  // namespace
}  // namespace patchmill
