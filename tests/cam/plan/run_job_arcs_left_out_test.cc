// The finding ARCS_LEFT_OUT: a program with arcs that would break a promise is written with straight moves.
#include <algorithm>
#include <string>

#include <gtest/gtest.h>

#include "tests/support/jobs/jobs.h"
#include "tests/support/shapes.h"

namespace patchmill {
namespace {

using namespace testing;  // NOLINT: the support folder's

bool Has(const JobResult& result, std::string_view code) {
  const Diagnostics& findings = result.report.diagnostics;
  return std::any_of(findings.begin(), findings.end(), [&](const Diagnostic& d) { return d.code == code; });
}

bool HasArc(const Toolpath& path) {
  return std::any_of(path.moves.begin(), path.moves.end(),
                     [](const Move& move) { return move.arc.has_value(); });
}

// Round a dome the arcs bulge beyond the chords that they replace, by up to their share of the tolerance. An
// axis that travels just as far as the chords need is too short for the arcs.
TEST(JobArcs, AreLeftOutWhereTheyGoBeyondTheTravel) {
  const Surface dome = PlacedSurface(Sphere(Vec3::Zero(), 15.0, Half::kUpper));
  Job job = BallJob(3.0);
  job.operation.tolerance = 0.1;
  job.operation.scallop = 0.2;
  const JobResult round = Mill(dome, job);
  ASSERT_FALSE(round.program.empty()) << Describe(round);
  ASSERT_TRUE(HasArc(round.posted));
  ASSERT_FALSE(Has(round, "ARCS_LEFT_OUT"));
  job.arcs = false;
  const JobResult straight = Mill(dome, job);
  ASSERT_FALSE(straight.program.empty()) << Describe(straight);
  const Box3 &of_arcs = round.report.verify.tip_box, &of_chords = straight.report.verify.tip_box;
  const Vec3 size = of_chords.max - of_chords.min, more = of_arcs.max - of_arcs.min - size;
  const std::size_t axis = more.x() > more.y() ? 0 : 1;
  ASSERT_GT(more[static_cast<Eigen::Index>(axis)], 1e-3);

  Machine machine;
  for (MachineAxis& each : machine.axes) each = {0.0, 1000.0, 10000.0, 5000.0, 500.0};
  machine.axes[axis].travel_max = size[static_cast<Eigen::Index>(axis)];
  job.setup.machine = machine;
  job.arcs = true;
  const JobResult left_out = Mill(dome, job);
  EXPECT_TRUE(Has(left_out, "ARCS_LEFT_OUT"));
  EXPECT_EQ(left_out.report.outcome, straight.report.outcome) << Describe(left_out);
  EXPECT_FALSE(HasArc(left_out.posted));
  EXPECT_EQ(left_out.report.verify.arc_blocks, 0);
  EXPECT_EQ(left_out.posted.moves.size(), left_out.motion.toolpath.moves.size());
  EXPECT_EQ(left_out.report.point_count, static_cast<int>(left_out.posted.moves.size()));
  EXPECT_TRUE(left_out.report.verify.ok());
  EXPECT_TRUE(left_out.report.times.has_value());

  // Too short for the chords, too: nothing is left out, and there is no program.
  job.setup.machine->axes[axis].travel_max -= 0.1;
  const JobResult failed = Mill(dome, job);
  EXPECT_EQ(failed.report.outcome, Outcome::kVerificationFailed);
  EXPECT_FALSE(Has(failed, "ARCS_LEFT_OUT"));
  EXPECT_TRUE(Has(failed, "BEYOND_TRAVEL"));
  EXPECT_TRUE(failed.program.empty());
}

}  // namespace
}  // namespace patchmill
