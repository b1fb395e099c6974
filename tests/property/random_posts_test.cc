// Random parts in every dialect, with arcs and without, in millimetres and in inches: each text is verified,
// keeps the promises [verification, section 1], and is read back as the motion that was planned.
#include "cam/post/program_reader.h"
#include "tests/property/random_job.h"

namespace patchmill {
namespace {

using namespace testing;  // NOLINT: the support folder's

RandomJob DrawSmallJob(std::uint64_t seed) {
  Random random(seed);
  RandomBsplineParams part;
  part.spans = 3;
  part.size = random.Uniform(6.0, 9.0);
  part.amplitude = random.Uniform(1.0, 3.0);
  RandomJob drawn;
  drawn.model = RandomBspline(seed, part);
  drawn.job = BallJob(random.Uniform(1.5, 3.0), random.Int(2) == 0);
  Operation& op = drawn.job.operation;
  op.scallop = random.Uniform(0.04, 0.1);
  op.tolerance = random.Uniform(0.025, 0.04);  // room for the decimals of every dialect
  op.steep_angle = Radians(random.Uniform(15.0, 75.0));
  op.zigzag_angle = random.Uniform(0.0, kPi);
  op.contour_direction = static_cast<CutDirection>(random.Int(3));
  op.tool.coolant = random.Int(2) == 0 ? Coolant::kOff : Coolant::kFlood;
  drawn.text = fmt::format("seed {}: size {:.2f}, R {:.3f}, scallop {:.4f}, tolerance {:.4f}", seed,
                           part.size, BallRadius(op.tool), op.scallop, op.tolerance);
  return drawn;
}

// Every place to which the planner sends the tip is one of the text, in the same order, to half a last digit;
// and the ways between them are as long.
void ExpectSameMotion(const Job& job, const JobResult& result) {
  const auto motion = ReadProgram(
      result.program,
      {.arc_chord_error = 1e-6, .dialect = job.dialect, .control_deviation = job.control_deviation});
  ASSERT_TRUE(motion.ok()) << motion.status();
  const double tick = TickOf(job.dialect, job.unit);
  const Vec3 tip(0.0, 0.0, -BallRadius(job.operation.tool));
  std::vector<const ProgramMove*> read;
  double read_length = 0.0;
  for (const ProgramMove& move : motion->moves) {
    if (move.to_above || move.from_above) continue;
    read.push_back(&move);
    if (move.kind == ProgramMove::Kind::kFeed) read_length += (move.to - move.from).norm();
  }
  ASSERT_FALSE(read.empty());
  std::size_t next = 0;
  double length = 0.0;
  const std::vector<Move>& moves = result.posted.moves;
  Vec3 at = read.front()->from;
  for (std::size_t k = 1; k < moves.size(); ++k) {
    const Vec3 to = moves[k].to + tip;
    const auto is_there = [&](const Vec3& p) { return (p - to).cwiseAbs().maxCoeff() <= 0.5000001 * tick; };
    while (next < read.size() && !is_there(at)) at = read[next++]->to;
    ASSERT_TRUE(is_there(at)) << "move " << k << " to " << to.transpose() << " is not in the text";
    if (moves[k].kind != MoveKind::kRapid)
      length += moves[k].arc ? ArcLength(*moves[k].arc, {moves[k - 1].to, moves[k].to})
                             : (moves[k].to - moves[k - 1].to).norm();
  }
  EXPECT_EQ(next, read.size()) << "the text goes on after the last move";
  EXPECT_NEAR(read_length, length, 1e-3 * length + tick * static_cast<double>(moves.size()));
}

class RandomPosts : public ::testing::TestWithParam<int> {};

TEST_P(RandomPosts, KeepThePromisesInEveryDialect) {
  const auto seed = static_cast<std::uint64_t>(GetParam());
  RandomJob drawn = DrawSmallJob(seed);
  SCOPED_TRACE(drawn.text);
  const Surface surface = PlacedSurface(drawn.model);
  Random random(seed + 1000);
  // In CI every other dialect, and one of the four ways to write it, so that ten seeds have each pair of
  // them. All in the long tests.
  const bool all = LongTests();
  int number = 0;
  for (const Dialect& dialect : Dialects()) {
    if (!all && (number++ + GetParam() / 4) % 2 != 0) continue;
    for (int way = all ? 0 : GetParam() % 4; way < (all ? 4 : GetParam() % 4 + 1); ++way) {
      Job& job = drawn.job;
      job.dialect = dialect;
      job.arcs = way % 2 == 0;
      job.unit = way < 2 ? ProgramUnit::kMillimeter : ProgramUnit::kInch;
      SCOPED_TRACE(
          fmt::format("{}, {}, {}", dialect.name, job.arcs ? "arcs" : "no arcs", way < 2 ? "mm" : "inch"));
      const JobResult result = Mill(surface, job);
      CheckProgram(surface, job, result, random, kSanitized ? 10 : 100);
      if (HasFatalFailure()) return;
      ExpectSameMotion(job, result);
    }
  }
}
INSTANTIATE_TEST_SUITE_P(Seeds, RandomPosts, JobSeeds(1, kSanitized ? 2 : 10));

}  // namespace
}  // namespace patchmill
