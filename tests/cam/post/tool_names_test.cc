// Tools that programs call by their names.
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "cam/post/program_reader.h"

namespace patchmill {
namespace {

using ::testing::HasSubstr;

std::string Siemens(const std::string& first, const std::string& second) {
  return "G71 G90 G17 G54\n" + first +
         "\nM6\nS8000 M3\nG0 SUPA Z0\nG0 X0 Y0\nG0 Z10\nG1 Z5 F300\nG0 SUPA Z0\n" + second +
         "\nM6\nS9000 M3\nG0 X1 Y1\nG0 Z10\nG1 Z4 F300\nG0 SUPA Z0\nM30\n";
}
std::string Klartext(const std::string& first, const std::string& second) {
  return "0 BEGIN PGM A MM\n1 TOOL CALL " + first +
         " Z S8000\n2 L X+0 Y+0 R0 FMAX M3\n3 L Z+5 R0 F300\n4 L Z+0 R0 FMAX M91\n5 TOOL CALL " + second +
         " Z S9000\n6 L X+1 Y+1 R0 FMAX M3\n7 L Z+4 R0 F300\n8 L Z+0 R0 FMAX M91 M30\n9 END PGM A MM\n";
}

absl::StatusOr<ProgramMotion> ReadBy(const std::string& text, const char* dialect,
                                     const std::map<std::string, int>& names, bool several = true) {
  return ReadProgram(text,
                     {.dialect = *FindDialect(dialect), .several_tools = several, .tools_by_name = names});
}

// The number of the tool that goes down to this height.
int ToolAt(const absl::StatusOr<ProgramMotion>& motion, double z) {
  if (!motion.ok()) return -2;
  for (const ProgramMove& move : motion->moves) {
    if (move.kind == ProgramMove::Kind::kFeed && move.to.z() == z) return move.tool;
  }
  return -3;
}

class ToolNames : public ::testing::TestWithParam<const char*> {
 protected:
  static std::string Program(const std::string& first, const std::string& second) {
    if (std::string(GetParam()) == "heidenhain") return Klartext('"' + first + '"', '"' + second + '"');
    return Siemens("T=\"" + first + '"', "T=\"" + second + '"');
  }
};

TEST_P(ToolNames, StandForTheToolsOfTheCall) {
  const auto motion = ReadBy(Program("BALL_6", "Ball_3"), GetParam(), {{"ball_6", 7}, {"ball_3", 12}});
  ASSERT_TRUE(motion.ok()) << motion.status();
  EXPECT_EQ(ToolAt(motion, 5.0), 7);
  EXPECT_EQ(ToolAt(motion, 4.0), 12);
  for (const Diagnostic& finding : motion->assumptions) EXPECT_NE(finding.code, "TOOL_NAME_ASSUMED");
}

TEST_P(ToolNames, ThatNoToolHasAreErrorsWithTheirLine) {
  const auto motion = ReadBy(Program("BALL_6", "OTHER"), GetParam(), {{"ball_6", 7}, {"ball_3", 12}});
  ASSERT_FALSE(motion.ok());
  EXPECT_THAT(std::string(motion.status().message()), HasSubstr("\"OTHER\" is none of the tools"));
  EXPECT_THAT(std::string(motion.status().message()), HasSubstr("line "));
}

TEST_P(ToolNames, OfASingleToolAreAssumedButNotASecondOne) {
  const auto one = ReadBy(Program("BALL_6", "BALL_6"), GetParam(), {}, false);
  ASSERT_TRUE(one.ok()) << one.status();
  bool assumed = false;
  for (const Diagnostic& finding : one->assumptions) assumed = assumed || finding.code == "TOOL_NAME_ASSUMED";
  EXPECT_TRUE(assumed);
  EXPECT_FALSE(ReadBy(Program("BALL_6", "BALL_3"), GetParam(), {}, false).ok());
}

INSTANTIATE_TEST_SUITE_P(Dialects, ToolNames, ::testing::Values("siemens", "heidenhain"));

TEST(ToolNamesAndNumbers, MayBeMixed) {
  const auto motion = ReadBy(Siemens("T=\"BALL_6\"", "T12"), "siemens", {{"ball_6", 7}, {"ball_3", 12}});
  ASSERT_TRUE(motion.ok()) << motion.status();
  EXPECT_EQ(ToolAt(motion, 5.0), 7);
  EXPECT_EQ(ToolAt(motion, 4.0), 12);
}

}  // namespace
}  // namespace patchmill
