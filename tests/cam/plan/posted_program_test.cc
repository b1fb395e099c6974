// Programs of post files with a fault: none is given out.
#include "cam/plan/posted_program.h"

#include <array>
#include <string>
#include <vector>

#include <absl/strings/str_replace.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/jobs/jobs.h"
#include "tests/support/walls.h"

namespace patchmill {
namespace {

using namespace testing;  // NOLINT: the support folder's
using ::testing::HasSubstr;

// A post file of the user's own: the Fanuc one with a text in it replaced everywhere.
Dialect OwnFanuc(const std::string& from, const std::string& to) {
  const std::string text = absl::StrReplaceAll(FindDialect("fanuc")->text, {{"name = fanuc", "name = own"}});
  EXPECT_NE(text.find(from), std::string::npos) << from;
  const absl::StatusOr<Dialect> dialect = ParseDialect(absl::StrReplaceAll(text, {{from, to}}));
  EXPECT_TRUE(dialect.ok()) << dialect.status();
  return dialect.value_or(LinuxCnc());
}

class PostedProgram : public ::testing::Test {
 protected:
  PostedProgram() : surface_(PlacedSurface(Sphere(Vec3(1, 2, 0), 12.0, Half::kUpper))), job_(BallJob(3.0)) {
    job_.operation.tolerance = 0.03;
    job_.operation.scallop = 0.3;
    job_.operation.tool.coolant = Coolant::kFlood;
  }
  // The errors of the job with this post file, "CODE message"; empty if there is a program.
  std::string ErrorsWith(Dialect dialect) {
    job_.dialect = std::move(dialect);
    const JobResult result = Mill(surface_, job_);
    std::string errors;
    for (const Diagnostic& finding : result.report.diagnostics)
      if (finding.severity == Severity::kError) errors += finding.code + " " + finding.message + "\n";
    EXPECT_EQ(result.program.empty(), !errors.empty());
    return errors;
  }

  const Surface surface_;
  Job job_;
};

TEST_F(PostedProgram, OfAnUnchangedPostFileIsGivenOut) { EXPECT_EQ(ErrorsWith(OwnFanuc("M7", "M7")), ""); }

TEST_F(PostedProgram, CallsTheToolOfTheJob) {
  const std::string errors = ErrorsWith(OwnFanuc("T{tool} M6", "T5 M6"));
  EXPECT_THAT(errors, HasSubstr("POST_OTHER_TOOL the post file own calls tool 5, and the job has T1"));
}

TEST_F(PostedProgram, UsesTheLengthOfTheTool) {
  EXPECT_THAT(ErrorsWith(OwnFanuc("H{tool}", "H2 (T{tool})")),
              HasSubstr("POST_OTHER_OFFSET the post file own has G43 H2, and the job's tool is T1"));
  EXPECT_THAT(ErrorsWith(OwnFanuc("G43 H{tool}", "G43 (T{tool})")), HasSubstr("G43 without H"));
  EXPECT_THAT(ErrorsWith(OwnFanuc("G43 H{tool} Z{z}", "Z{z} (T{tool})")), HasSubstr("no G43 is in force"));
}

TEST_F(PostedProgram, OfAControlWithoutLengthOffsetsNeedsNone) {
  const std::string text = absl::StrReplaceAll(
      FindDialect("fanuc")->text,
      {{"name = fanuc", "name = own\nlength_offset = no"}, {"G43 H{tool} Z{z}", "Z{z} (T{tool})"}});
  const absl::StatusOr<Dialect> dialect = ParseDialect(text);
  ASSERT_TRUE(dialect.ok()) << dialect.status();
  EXPECT_EQ(ErrorsWith(*dialect), "");
}

TEST_F(PostedProgram, RunsAtTheSpeedOfTheJob) {
  const std::string errors = ErrorsWith(OwnFanuc("S{speed} M3", "S6000 M3"));
  EXPECT_THAT(errors, HasSubstr("lets the spindle turn at 6000 rpm, and the job has 12000"));
}

TEST_F(PostedProgram, StatesTheModes) {
  EXPECT_THAT(ErrorsWith(OwnFanuc("{work_offset}\n", "\n")), HasSubstr("no work offset is in force"));
  EXPECT_THAT(ErrorsWith(OwnFanuc("{unit} G40", "G40 ({unit})")), HasSubstr("neither G20 nor G21"));
}

TEST_F(PostedProgram, ChoosesTheWorkOffsetOfTheJob) {
  EXPECT_THAT(ErrorsWith(OwnFanuc("{work_offset}\n", "G55 (was {work_offset})\n")),
              HasSubstr("POST_OTHER_OFFSET the post file own chooses G55, and the job has G54"));
}

TEST_F(PostedProgram, SwitchesTheCoolantOfTheJob) {
  EXPECT_THAT(ErrorsWith(OwnFanuc("{coolant}", "({coolant})")), HasSubstr("POST_OTHER_COOLANT"));
  job_.operation.tool.coolant = Coolant::kOff;
  EXPECT_EQ(ErrorsWith(OwnFanuc("M7", "M7")), "");
  EXPECT_THAT(ErrorsWith(OwnFanuc("S{speed} M3", "S{speed} M3\nM8")), HasSubstr("the coolant is on"));
}

TEST_F(PostedProgram, StatesModesThatTheLastProgramMayHaveLeft) {
  for (const std::string word : {"G94", "G40", "G80"}) {
    EXPECT_THAT(ErrorsWith(OwnFanuc(" " + word, "")), HasSubstr("states no " + word)) << word;
  }
}

TEST_F(PostedProgram, HasPointsWhereTheControlMayCountIncrements) {
  EXPECT_THAT(ErrorsWith(OwnFanuc("G43 H{tool} Z{z}", "G43 H{tool} Z100\nZ{z}")),
              HasSubstr("Z100 has no decimal point"));
}

TEST_F(PostedProgram, MayBeStartedAtItsRestartPoints) {
  job_.restart_points = true;
  job_.operation.high_rapids = true;
  EXPECT_EQ(ErrorsWith(OwnFanuc("M7", "M7")), "");
  const std::string text = FindDialect("fanuc")->text;
  const std::size_t restart = text.find("[restart]");
  const std::string section = text.substr(restart, text.find("[end]") - restart);
  for (const auto& [from, to, fault] : std::vector<std::array<std::string, 3>>{
           {"G91 G28 Z0.\n", "", "the first motion is not straight up to machine zero"},
           {"S{speed} M3", "S{speed}", "the spindle stands still"},
           {"{coolant}", "({coolant})", "the coolant is off"},
           {"G43 H{tool} Z{z}", "(T{tool})\nZ{z}", "no G43 is in force"},
           {"{unit}", "({unit})", "neither G20 nor G21"}}) {
    const std::string changed = absl::StrReplaceAll(section, {{from, to}});
    ASSERT_NE(changed, section) << from;
    const absl::StatusOr<Dialect> dialect =
        ParseDialect(absl::StrReplaceAll(text, {{"name = fanuc", "name = own"}, {section, changed}}));
    ASSERT_TRUE(dialect.ok()) << dialect.status();
    const std::string errors = ErrorsWith(*dialect);
    EXPECT_THAT(errors, HasSubstr("RESTART_INCOMPLETE restart point 1")) << from;
    EXPECT_THAT(errors, HasSubstr(fault)) << from;
  }
}

TEST_F(PostedProgram, NamesTheLineThatCannotBeReadBack) {
  job_.dialect = OwnFanuc("S{speed} M3", "S{speed} M3\nG123");
  const absl::StatusOr<JobResult> result = RunJob(surface_, job_, RunContext());
  ASSERT_FALSE(result.ok());
  EXPECT_THAT(std::string(result.status().message()), HasSubstr("in \"G123\""));
}

}  // namespace
}  // namespace patchmill
