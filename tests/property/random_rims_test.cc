// Jobs over parts with an area around an axis, which circular lines cut, keep the promises [verification,
// section 1]: wavy, oval and tilted rings of any size.
#include "tests/property/random_job.h"

namespace patchmill {
namespace {

using namespace testing;  // NOLINT: the support folder's

class RandomRims : public ::testing::TestWithParam<int> {
 protected:
  // In a full run many jobs must have circular lines, or nothing is tested.
  static void TearDownTestSuite() {
    if (jobs_ < 10) return;
    EXPECT_GE(4 * round_, jobs_);
  }
  inline static int jobs_ = 0, round_ = 0;
};

// Rings of random height and width on a slope, with waves along and across them. They lie on squares and,
// more often, on round dishes, because circular lines are for areas whose borders they run along.
PatchModel DrawRims(Random& random) {
  const Vec2 center(random.Uniform(-2, 2), random.Uniform(-2, 2));
  const double ring = random.Uniform(6, 9), width = random.Uniform(1.0, 4.0),
               high = random.Uniform(-2.0, 4.0);
  const double waves = random.Int(2) == 0 ? 0.0 : random.Uniform(0.0, 0.3), around = 2.0 + random.Int(6);
  const double oval = random.Int(3) == 0 ? random.Uniform(0.8, 1.2) : 1.0, phase = random.Uniform(0.0, kPi);
  const Vec2 fall(random.Uniform(-0.1, 0.1), random.Uniform(-0.1, 0.1));
  const auto height = [=](double x, double y) {
    const Vec2 p = Vec2(x, oval * y) - center;
    const double d = (p.norm() - ring) / width, angle = std::atan2(p.y(), p.x());
    return high * std::exp(-d * d) * (1.0 + waves * std::cos(around * angle + phase)) + fall.dot(p);
  };
  if (random.Int(3) == 0) return Single(InterpolatedHeights(height, -15, 15, -15, 15, 24, 24));
  // A dish with a hole, cut round: the net of a rectangle of angles and radii, wrapped.
  const double inner = random.Uniform(1.5, 4.0), outer = random.Uniform(12.0, 16.0);
  BsplinePatch wrapped = InterpolatedHeights(
      [&](double turn, double r) {
        return height(center.x() + r * std::cos(turn), center.y() + r * std::sin(turn));
      },
      0.0, 2.0 * kPi, inner, outer, 32, 16);
  for (Vec3& p : wrapped.points) p = Lift(center + p.y() * Vec2(std::cos(p.x()), std::sin(p.x())), p.z());
  return Single(std::move(wrapped));
}

TEST_P(RandomRims, KeepThePromises) {
  const auto seed = static_cast<std::uint64_t>(GetParam());
  Random random(seed);
  RandomJob drawn = DrawJob(seed, false, false);
  drawn.model = DrawRims(random);
  Operation& op = drawn.job.operation;
  op.scallop = random.Uniform(0.015, 0.05);
  op.detail = random.Int(2) == 0 ? op.detail : random.Uniform(0.2, 0.9);
  op.spirals = random.Int(4) == 0;
  op.edge_rule = static_cast<EdgeRule>(random.Int(3));
  const Surface surface = PlacedSurface(drawn.model);
  const JobResult result = Mill(surface, drawn.job);
  bool round = false;
  for (const RegionChoice& choice : result.report.choices) round = round || !choice.around.empty();
  ++jobs_;
  round_ += round ? 1 : 0;
  SCOPED_TRACE(drawn.text + (round ? ", circular lines" : ""));
  CheckProgram(surface, drawn.job, result, random, kSanitized ? 50 : 500);
}
INSTANTIATE_TEST_SUITE_P(Seeds, RandomRims, JobSeeds(7000, kSanitized ? 3 : 12));

}  // namespace
}  // namespace patchmill
