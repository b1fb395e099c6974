// Whole jobs in every dialect and both units: each program is verified, keeps the floor, and is as long as
// the others.
#include <algorithm>
#include <string>
#include <tuple>

#include <gtest/gtest.h>

#include "cam/post/program_reader.h"
#include "tests/support/jobs/jobs.h"
#include "tests/support/walls.h"

namespace patchmill {
namespace {

using namespace testing;  // NOLINT: the support folder's

class JobOfDialect : public ::testing::TestWithParam<std::tuple<std::string, ProgramUnit>> {
 protected:
  static Job Coarse() {
    Job job = BallJob(3.0);
    job.operation.tolerance = 0.03;  // for four decimals of an inch
    job.operation.scallop = 0.1;
    return job;
  }
  static Job Of(Job job, const std::string& dialect, ProgramUnit unit) {
    job.dialect = *FindDialect(dialect);
    job.unit = unit;
    return job;
  }
  Job Of(Job job) const { return Of(std::move(job), std::get<0>(GetParam()), std::get<1>(GetParam())); }
  static ProgramMotion Read(const Job& job, const std::string& program) {
    const auto motion = ReadProgram(program, {.dialect = job.dialect});
    EXPECT_TRUE(motion.ok()) << motion.status();
    return motion.ok() ? *motion : ProgramMotion();
  }
  static double FeedLength(const ProgramMotion& motion) {
    double length = 0.0;
    for (const ProgramMove& move : motion.moves) {
      if (move.kind == ProgramMove::Kind::kFeed) length += (move.to - move.from).norm();
    }
    return length;
  }
};

TEST_P(JobOfDialect, IsVerifiedAndAsLongAsOnLinuxCnc) {
  const Surface surface = PlacedSurface(Sphere(Vec3(1.2345678, 2.7182818, 0.0), 12.0, Half::kUpper));
  const Job job = Of(Coarse());
  const JobResult result = Mill(surface, job);
  ASSERT_FALSE(result.program.empty()) << Describe(result) << result.report.diagnostics.back().message;
  const Job reference = Of(Coarse(), "linuxcnc", ProgramUnit::kMillimeter);
  const double length = FeedLength(Read(reference, Mill(surface, reference).program));
  EXPECT_NEAR(FeedLength(Read(job, result.program)), length, 0.02 * length);
  EXPECT_EQ(result.program.find("INCH") != std::string::npos, std::get<1>(GetParam()) == ProgramUnit::kInch);
}

// A floor between two coordinates: the tip stays above it all the same, on arcs too.
TEST_P(JobOfDialect, KeepsAFloorOfManyDecimals) {
  const Surface surface =
      PlacedSurface(Join({OpenBox(12, 10, 8), Torus(Vec3::Zero(), 4.0, 2.0, Half::kUpper)}));
  for (const double floor : {1.00049, 0.9987}) {
    Job job = Of(Coarse());
    job.operation.floor_z = floor;
    const JobResult result = Mill(surface, job);
    ASSERT_FALSE(result.program.empty())
        << floor << Describe(result) << result.report.diagnostics.back().message;
    double lowest = kInfinity;
    for (const ProgramMove& move : Read(job, result.program).moves) {
      if (!move.to_above) lowest = std::min(lowest, move.to.z());
    }
    EXPECT_GE(lowest, floor - 1e-4);
    EXPECT_LE(lowest, floor + 0.01);
  }
}

INSTANTIATE_TEST_SUITE_P(Posts, JobOfDialect,
                         ::testing::Combine(::testing::Values("fanuc", "grbl", "haas", "heidenhain",
                                                              "linuxcnc", "mach3", "siemens"),
                                            ::testing::Values(ProgramUnit::kMillimeter, ProgramUnit::kInch)),
                         [](const auto& of) {
                           return std::get<0>(of.param) +
                                  (std::get<1>(of.param) == ProgramUnit::kInch ? "_inch" : "_mm");
                         });

}  // namespace
}  // namespace patchmill
