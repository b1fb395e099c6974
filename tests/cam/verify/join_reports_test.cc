// Verdicts of the parts of a program, joined.
#include "cam/verify/join_reports.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "cam/verify/tool_moves.h"

namespace patchmill {
namespace {

using ::testing::HasSubstr;

VerifyReport Good() {
  VerifyReport report;
  report.gouge_ok = report.finish_ok = report.motion_ok = true;
  return report;
}

std::string Codes(const VerifyReport& report) {
  std::string text;
  for (const Diagnostic& d : report.findings) text += d.code + ":" + d.message + "|";
  return text;
}

TEST(JoinReports, EveryWayOfRunningMustBeGood) {
  VerifyReport run = Good(), skipped = Good();
  run.cut_length = 100.0;
  skipped.cut_length = 80.0;
  skipped.gouge_ok = false;
  skipped.max_gouge = 0.3;
  skipped.max_gouge_at.line = 7;
  run.max_leftover = 0.02;
  skipped.max_leftover = 0.5;
  skipped.finish_ok = false;
  run.findings = {MakeWarning("A", "of both", {})};
  skipped.findings = {MakeError("GOUGE", "deep", {}), MakeWarning("A", "of both", {})};
  for (const bool swapped : {false, true}) {
    std::vector<PartReport> parts = {{"run", run}, {"skipped", skipped}};
    if (swapped) std::swap(parts[0], parts[1]);
    const VerifyReport joined = JoinReports(parts, PartsOfProgram::kWays);
    EXPECT_TRUE(!joined.gouge_ok && !joined.finish_ok && joined.motion_ok);
    EXPECT_EQ(joined.max_gouge, 0.3);
    EXPECT_EQ(joined.max_gouge_at.line, 7);
    EXPECT_EQ(joined.max_leftover, 0.5);
    EXPECT_EQ(joined.cut_length, 100.0);
    EXPECT_THAT(Codes(joined), HasSubstr("GOUGE:deep (skipped)|"));
    EXPECT_THAT(Codes(joined), HasSubstr("A:of both|"));
    EXPECT_EQ(joined.findings.size(), 2u);
  }
}

TEST(JoinReports, TheFinishOfToolsIsThatOfTheBest) {
  VerifyReport rough = Good(), fine = Good();
  rough.finish_ok = false;
  rough.max_leftover = 2.0;
  rough.cut_length = 100.0;
  rough.required_stickout = 30.0;
  rough.tip_box.Add(Vec3(0, 0, 5));
  rough.tip_z_min = 5.0;
  rough.findings = {MakeError("LEFTOVER", "much", {})};
  fine.max_leftover = 0.01;
  fine.reachable_area = 70.0;
  fine.cut_length = 50.0;
  fine.required_stickout = 20.0;
  fine.motion_ok = false;
  fine.findings = {MakeError("RAPID_IN_STOCK", "there", {})};
  const VerifyReport joined = JoinReports({{"tool 1", rough}, {"tool 2", fine}}, PartsOfProgram::kTools);
  EXPECT_TRUE(joined.finish_ok && joined.gouge_ok && !joined.motion_ok);
  EXPECT_EQ(joined.max_leftover, 0.01);
  EXPECT_EQ(joined.reachable_area, 70.0);
  EXPECT_EQ(joined.cut_length, 150.0);
  EXPECT_EQ(joined.required_stickout, 30.0);
  EXPECT_EQ(joined.tip_z_min, 5.0);
  EXPECT_EQ(joined.tip_box.min, Vec3(0, 0, 5));
  EXPECT_THAT(Codes(joined), HasSubstr("RAPID_IN_STOCK:there (tool 2)|"));
  EXPECT_THAT(Codes(joined), HasSubstr("FINISH_OF_TOOL:the finish is that of tool 2;"));
  EXPECT_THAT(Codes(joined), ::testing::Not(HasSubstr("LEFTOVER")));
}

TEST(JoinReports, OnePartStaysAsItIs) {
  VerifyReport one = Good();
  one.findings = {MakeError("LEFTOVER", "much", {})};
  EXPECT_EQ(Codes(JoinReports({{"tool 1", one}}, PartsOfProgram::kTools)), "LEFTOVER:much|");
}

TEST(ToolMoves, EachToolHasItsOwnAndItsEndOfTheProgram) {
  ProgramMotion motion;
  for (const int tool : {-1, 1, 1, 2, 1}) {
    ProgramMove move;
    move.tool = tool;
    move.line = static_cast<int>(motion.moves.size()) + 1;
    motion.moves.push_back(move);
  }
  motion.controller_tolerance = 0.01;
  ProgramMove parking;  // it changes nothing about who moves first and last
  parking.from_above = parking.to_above = true;
  parking.tool = 9;
  motion.moves.push_back(parking);
  motion.moves.insert(motion.moves.begin(), parking);
  EXPECT_EQ(ToolsOf(motion), (std::vector<int>{-1, 1, 2}));
  const ProgramMotion before = MovesOfTool(motion, -1), one = MovesOfTool(motion, 1),
                      two = MovesOfTool(motion, 2);
  EXPECT_EQ(one.moves.size(), 3u);
  EXPECT_EQ(two.moves.front().line, 4);
  EXPECT_EQ(two.controller_tolerance, 0.01);
  // The program neither begins nor ends as it should.
  EXPECT_TRUE(!before.first_motion_is_up && before.last_motion_is_up && before.ends_with_spindle_off);
  EXPECT_TRUE(one.first_motion_is_up && !one.last_motion_is_up && !one.ends_with_spindle_off);
  EXPECT_TRUE(two.first_motion_is_up && two.last_motion_is_up && two.ends_with_coolant_off);
}

}  // namespace
}  // namespace patchmill
