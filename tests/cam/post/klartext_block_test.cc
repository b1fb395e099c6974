// Heidenhain's conversational programs and Siemens' words, read as the makers' manuals say.
#include "cam/post/klartext_block.h"

#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "cam/post/program_reader.h"

namespace patchmill {
namespace {

using ::testing::HasSubstr;

absl::StatusOr<ProgramMotion> Read(const std::string& text, const char* dialect) {
  return ReadProgram(text, {.dialect = *FindDialect(dialect)});
}

// After the example of a contour with a full circle and a rounded corner in the manual for iTNC 530
// (conversational programming, path functions), written anew.
TEST(Klartext, LinesAndCircles) {
  const auto motion = Read(
      "0 BEGIN PGM PLATE MM\n"
      "1 BLK FORM 0.1 Z X+0 Y+0 Z-20\n"
      "2 BLK FORM 0.2 X+100 Y+100 Z+0\n"
      "3 TOOL CALL 5 Z S3200 F400 ; ball of 6 mm\n"
      "4 L Z+0 R0 FMAX M91\n"
      "5 CYCL DEF 32.0 TOLERANCE\n"
      "6 CYCL DEF 32.1 T0.012\n"
      "7 CYCL DEF 32.2 HSC-MODE:0 TA0\n"
      "8 L X-20 Y+50 R0 FMAX M13\n"
      "9 L Z+2 FMAX\n"
      "10 L Z-5 F150\n"
      "11 L X+5 F400\n"
      "12 CC X+50 Y+50\n"
      "13 C X+5 Y+50 DR-\n"
      "14 CR X+50 Y+95 R+45 DR-\n"
      "15 L Z+100 FMAX M9\n"
      "16 M5\n"
      "17 L Z+0 FMAX M91\n"
      "18 M30\n"
      "19 END PGM PLATE MM\n",
      "heidenhain");
  ASSERT_TRUE(motion.ok()) << motion.status();
  EXPECT_TRUE(motion->assumptions.empty()) << motion->assumptions.front().message;
  EXPECT_EQ(motion->tool_number, 5);
  EXPECT_DOUBLE_EQ(motion->controller_tolerance, 0.012);
  EXPECT_TRUE(motion->first_motion_is_up);
  EXPECT_TRUE(motion->ends_with_spindle_off);
  EXPECT_TRUE(motion->ends_with_coolant_off);
  double circle = 0.0, quarter = 0.0, plunge = 0.0;
  for (const ProgramMove& move : motion->moves) {
    if (move.line == 14) circle += (move.to - move.from).norm();
    if (move.line == 15) quarter += (move.to - move.from).norm();
    if (move.line == 11) plunge = move.feed;
    EXPECT_TRUE(move.spindle_speed > 0.0F || move.kind == ProgramMove::Kind::kRapid);
  }
  EXPECT_NEAR(circle, 2.0 * kPi * 45.0, 0.01);
  EXPECT_NEAR(quarter, 0.5 * kPi * 45.0, 0.01);
  EXPECT_EQ(plunge, 150.0);
  EXPECT_EQ(motion->moves.back().kind, ProgramMove::Kind::kRapid);
}

TEST(Klartext, RefusesWithTheLine) {
  const std::string start = "0 BEGIN PGM A MM\n1 TOOL CALL 1 Z S1000\n2 L X+0 Y+0 R0 FMAX M3\n";
  for (const auto& [line, word] :
       std::vector<std::pair<std::string, std::string>>{{"L X+5 RL F100", "radius compensation"},
                                                        {"L IX+Q5 F100", "Q parameters"},
                                                        {"L X+Q5 F100", "Q parameters"},
                                                        {"LP PR+5 PA+30", "LP is not supported"},
                                                        {"C X+5 Y+5 DR+", "without CC"},
                                                        {"CR X+5 Y+5 R+5", "DR+ or DR-"},
                                                        {"CALL LBL 1", "CALL is not supported"},
                                                        {"FN 0: Q1 = 5", "FN is not supported"},
                                                        {"CYCL DEF 19.1 A+10", "CYCL DEF 19.1"},
                                                        {"PLANE SPATIAL SPA+10", "PLANE is not supported"},
                                                        {"L X+1 X+2 F100", "X is given twice"},
                                                        {"L X+1 F100 FMAX", "F and FMAX"},
                                                        {"L Z-5 R0 FMAX M91", "machine zero"},
                                                        {"TOOL CALL 2 Z S100 DL+0.5", "DL+0.5"},
                                                        {"G1 X5", "G1 is not supported"},
                                                        {"L X+1.2.3 F100", "not a number"},
                                                        {"L X+-1 F100", "not a number"},
                                                        {"M116", "M116"}}) {
    const auto motion = Read(start + "3 " + line + "\n", "heidenhain");
    ASSERT_FALSE(motion.ok()) << line;
    EXPECT_THAT(std::string(motion.status().message()), HasSubstr("line 4: ")) << line;
    EXPECT_THAT(std::string(motion.status().message()), HasSubstr(word)) << line;
  }
  EXPECT_THAT(std::string(Read("L X+5 F100\n", "heidenhain").status().message()), HasSubstr("BEGIN PGM"));
  EXPECT_FALSE(Read(start + "3 END PGM A MM\n4 L X+1 F1\n", "heidenhain").ok());
}

TEST(Klartext, ToleranceOfTheMachineIsNoTolerance) {
  const auto motion = Read(
      "0 BEGIN PGM A INCH\n1 TOOL CALL 1 Z S1000\n2 CYCL DEF 32.0 TOLERANCE\n3 CYCL DEF 32.1\n"
      "4 L X+0 Y+0 R0 FMAX M3\n5 L Z+1 FMAX\n6 L X+1 F10\n",
      "heidenhain");
  ASSERT_TRUE(motion.ok()) << motion.status();
  EXPECT_EQ(motion->controller_tolerance, kInfinity);
  EXPECT_DOUBLE_EQ(motion->moves.back().to.x(), 25.4);
  EXPECT_NEAR(motion->moves.back().feed, 25.4, 1e-12) << "F counts tenths of an inch in a program in inches";
}

// After the examples for SUPA, G4 and CYCLE832 in the manuals of 840D sl, written anew.
TEST(Siemens, OwnWords) {
  const auto motion = Read(
      "%_N_PLATE_MPF\n"
      "; plate\n"
      "N10 G17 G40 G64 G90 G94 G710 G54\n"
      "N20 G0 SUPA Z0 D0\n"
      "N30 T5 M6\n"
      "N40 D1\n"
      "N50 CYCLE832(0.01,1,1)\n"
      "N60 S3200 M3\n"
      "N70 G4 F2\n"
      "N80 G0 X10 Y20\n"
      "N90 Z5\n"
      "N100 G1 Z-1 F300\n"
      "N110 G2 X10 Y20 I5 J0\n"
      "N120 G0 SUPA Z0 D0\n"
      "N130 M5\n"
      "N140 M30\n",
      "siemens");
  ASSERT_TRUE(motion.ok()) << motion.status();
  EXPECT_TRUE(
      motion->assumptions.empty());  // I and J count from the arc's start, as Siemens always takes them
  EXPECT_EQ(motion->tool_number, 5);
  EXPECT_DOUBLE_EQ(motion->controller_tolerance, 0.01);
  EXPECT_TRUE(motion->last_motion_is_up);
  EXPECT_TRUE(motion->ends_with_spindle_off);
  double circle = 0.0;
  for (const ProgramMove& move : motion->moves) {
    if (move.line == 13) circle += (move.to - move.from).norm();
  }
  EXPECT_NEAR(circle, 2.0 * kPi * 5.0, 0.01);
}

TEST(Siemens, TolerancesAndRefusals) {
  const std::string start = "G17 G40 G90 G94 G710 G54\nG0 SUPA Z0 D0\nT1 M6\nD1\nS100 M3\nG0 X0 Y0\nZ5\n";
  const auto tolerance = [&](const std::string& words) {
    const auto motion = Read(start + words + "\nG1 X5 F100\n", "siemens");
    EXPECT_TRUE(motion.ok()) << words << ": " << motion.status();
    return motion.ok() ? motion->controller_tolerance : -1.0;
  };
  EXPECT_EQ(tolerance("G60"), 0.0);
  EXPECT_EQ(tolerance("G64"), kInfinity);
  EXPECT_EQ(tolerance("G64\nCYCLE832(0.02,3,1)"), 0.02);
  EXPECT_EQ(tolerance("G64\nCYCLE832(0.02,0,1)"), kInfinity);
  EXPECT_EQ(tolerance("G64\nCYCLE832()"), kInfinity);
  EXPECT_EQ(tolerance("CYCLE832(0.02,1,1)\nG60"), 0.0);
  for (const char* line : {"R1=5", "X=R1", "CYCLE800(0,\"\",0,57,0,0,0,30,0,0)", "TRANS X5", "G1 X5 F=R2",
                           "D2", "CYCLE832(0.1", "REPEAT A B", "IF R1==5 GOTOF ENDE", "T=\"BALL\""}) {
    const auto motion = Read(start + line + "\n", "siemens");
    EXPECT_FALSE(motion.ok()) << line;
    EXPECT_THAT(std::string(motion.status().message()), HasSubstr("line 8: "));
  }
}

}  // namespace
}  // namespace patchmill
