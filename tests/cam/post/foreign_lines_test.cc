// Lines as other people's programs have them, and what each of them must do.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "cam/post/program_assumptions.h"
#include "cam/post/program_reader.h"

namespace patchmill {
namespace {

using ::testing::HasSubstr;

ReaderParams As(const std::string& dialect) {
  ReaderParams params;
  params.dialect = *FindDialect(dialect);
  return params;
}

ProgramMotion Read(const std::string& text, const ReaderParams& params = {}) {
  auto motion = ReadProgram(text, params);
  EXPECT_TRUE(motion.ok()) << text << "\n" << motion.status();
  return motion.ok() ? *motion : ProgramMotion{};
}

std::string Refusal(const std::string& text, const ReaderParams& params = {}) {
  const auto motion = ReadProgram(text, params);
  EXPECT_FALSE(motion.ok()) << text;
  return std::string(motion.status().message());
}

bool Assumes(const ProgramMotion& motion, const std::string& code) {
  const std::vector<std::string> codes = AssumptionCodes(motion.assumptions);
  return std::find(codes.begin(), codes.end(), code) != codes.end();
}

// Four lines; the tool stands at X1 Y2 Z5.
const std::string kStart = "G21 G17 G90 G91.1 G54 G61\nT1 M6\nG43 H1\nG0 X1 Y2 Z5 F100\n";

TEST(ForeignLines, OneByOne) {
  const auto last = [](const std::string& line) {
    const ProgramMotion m = Read(kStart + line + "\n");
    return m.moves.empty() ? ProgramMove{} : m.moves.back();
  };
  EXPECT_EQ(last("N161830 G1 X3 Y4 Z1 F200").to, Vec3(3, 4, 1));
  EXPECT_EQ(last("N161830 G1 X3 Y4 Z1 F200").feed, 200.0);
  EXPECT_EQ(last("N0 G1 X3 Y4 Z1 F200").to, Vec3(3, 4, 1));
  EXPECT_EQ(last("g1x3y4z1f200").to, Vec3(3, 4, 1));
  EXPECT_EQ(last("G1 X-.5 Y+.5 F1200").to, Vec3(-0.5, 0.5, 5));
  EXPECT_EQ(last("G1 X (there) 3 (and) Y4 ; done").to, Vec3(3, 4, 5));
  EXPECT_EQ(last("G0 G90 G54 X3 Y4 S3500 M3").to, Vec3(3, 4, 5));
  EXPECT_EQ(last("M06 T1 (label only)\nG43 H1 Z20.").to.z(), 20.0);
  EXPECT_EQ(last("G4 P0.5\nS8000 M03 M08\nX3").to.x(), 3.0);
  EXPECT_EQ(last("G0 G17 G40 G80 G90 Z6").to, Vec3(1, 2, 6));
  EXPECT_EQ(last("X[1 + 2 * 2] Y SQRT[2 ** 4] Z-[10 MOD 4]").to, Vec3(5, 4, -2));
  EXPECT_EQ(Read("%\nO1000 (PART)\n" + kStart + "%\n").moves.size(), 1u);
  EXPECT_DOUBLE_EQ(Read(kStart + "G64 P0.01\nG1 X2\n").controller_tolerance, 0.02);
  const std::pair<const char*, const char*> refused[] = {
      {"G1 X3 F1.2E3", "E3"},       {"G41 D1 X5. F600", "G41"}, {"G42.1 D3", "G42.1"},
      {"O1000", "program number"},  {"#1=5", "parameters"},     {"X#1", "parameters"},
      {"o100 sub", "O-words"},      {"G92 X0", "G92"},          {"M98 P1", "subprograms"},
      {"G65 P9000", "subprograms"}, {"M99", "subprograms"},     {"G84 R1 Z-1", "G84"},
      {"G53 G0 Z-20", "machine"},   {"X[1 GT 2]", "]"},         {"X[1/0]", "range"},
      {"X SQRT[-1]", "range"},      {"X[#3+1]", "parameters"},  {"(a (b) c)", "comment within"},
  };
  for (const auto& [line, word] : refused) {
    const std::string message = Refusal(kStart + line + "\n");
    EXPECT_THAT(message, ::testing::StartsWith("line 5: ")) << line;
    EXPECT_THAT(message, HasSubstr(word)) << line;
  }
}

// A mode that does nothing by itself is refused where something moves under it, with both lines.
TEST(ForeignLines, FeedModesMatterOnlyWhereSomethingIsFed) {
  for (const char* mode : {"G93", "G95"}) {
    EXPECT_EQ(Read(kStart + mode + "\nG0 X9\n").moves.back().to.x(), 9.0);
    EXPECT_EQ(Read(kStart + mode + "\nG94 F50\nG1 X9\n").moves.back().feed, 50.0);
    EXPECT_THAT(Refusal(kStart + mode + "\nG94\nG1 X9\n"),
                HasSubstr("line 7: feed move without a feed rate"));
    const std::string message = Refusal(kStart + mode + "\n\nG1 X9 F1\n");
    EXPECT_THAT(message, HasSubstr(std::string("line 7: feed move under ") + mode + " of line 5"));
  }
}

TEST(ForeignLines, CutterRadiusCompensationWithoutAnOffset) {
  EXPECT_EQ(Read(kStart + "G40 G1 X9\n").moves.back().to.x(), 9.0);
  EXPECT_EQ(Read(kStart + "G41.1 D0 G1 X9\nG40\n").moves.back().to.x(), 9.0);
  // For LinuxCNC D0 is the radius of the loaded tool.
  EXPECT_THAT(Refusal(kStart + "G41 D0\n"), HasSubstr("line 5: G41: "));
  EXPECT_EQ(Read(kStart + "G41 D0 G1 X9\nG40\n", As("fanuc")).moves.back().to.x(), 9.0);
  EXPECT_EQ(Read(kStart + "G42 G1 X9\nG40\n", As("haas")).moves.back().to.x(), 9.0);
  EXPECT_THAT(Refusal(kStart + "G41 D5\n", As("haas")), HasSubstr("line 5: G41: "));
}

// The first leg of G28 and G30 is a rapid in the mode in force.
TEST(ForeignLines, ReferencePoints) {
  for (const std::string word : {"G28", "G30"}) {
    const ProgramMotion down = Read(kStart + "G90 " + word + " Z0\n");
    ASSERT_EQ(down.moves.size(), 3u);
    EXPECT_EQ(down.moves[1].kind, ProgramMove::Kind::kRapid);
    EXPECT_EQ(down.moves[1].to, Vec3(1, 2, 0)) << "work Z0 comes first";
    EXPECT_FALSE(down.moves[1].to_above);
    EXPECT_TRUE(down.moves[2].to_above);
    EXPECT_TRUE(Assumes(down, "REFERENCE_ASSUMED")) << word;
    const ProgramMotion up = Read(kStart + word + " G91 Z0\n");
    ASSERT_EQ(up.moves.size(), 2u);
    EXPECT_TRUE(up.moves[1].to_above && up.last_motion_is_up);
    EXPECT_EQ(Read(kStart + "G91 " + word + " Z3\n").moves[1].to.z(), 8.0);
    // All axes at once: nobody knows over which places.
    for (const std::string& all : {word, "G91 " + word + " X0 Y0 Z0"}) {
      const ProgramMotion aside = Read(kStart + all + "\n");
      EXPECT_TRUE(aside.moves.back().from_anywhere && aside.moves.back().to_above) << all;
      EXPECT_FALSE(aside.last_motion_is_up);
    }
    EXPECT_FALSE(Read(kStart + "G91 " + word + " Z0\n" + word + " X0 Y0\n").moves.back().from_anywhere);
    const ProgramMotion level = Read(kStart + "G91 " + word + " X0\n");
    EXPECT_TRUE(level.moves.back().from_anywhere && !level.moves.back().to_above);
    EXPECT_THAT(Refusal(kStart + "G91 " + word + " X0\nX1\n"), HasSubstr("line 6: X is incremental"));
  }
  // A dialect that goes up by G28 itself says where it leads.
  EXPECT_FALSE(Assumes(Read(kStart + "G91 G28 Z0\n", As("fanuc")), "REFERENCE_ASSUMED"));
  EXPECT_TRUE(Assumes(Read(kStart + "G91 G30 Z0\n", As("fanuc")), "REFERENCE_ASSUMED"));
}

TEST(ForeignLines, MachinePlaces) {
  ReaderParams safe;
  safe.machine_z_safe = -10.0;
  const ProgramMotion up = Read(kStart + "G53 G0 Z-5.0\n", safe);
  EXPECT_TRUE(up.moves.back().to_above && up.last_motion_is_up);
  EXPECT_TRUE(Assumes(up, "MACHINE_Z_ASSUMED"));
  EXPECT_TRUE(Read(kStart + "G53 G0 Z-10\n", safe).moves.back().to_above);
  EXPECT_THAT(Refusal(kStart + "G53 G0 Z-10.1\n", safe), HasSubstr("line 5: G53 with Z below machine Z-10"));
  EXPECT_FALSE(Assumes(Read(kStart + "G0 G53 Z0\n", safe), "MACHINE_Z_ASSUMED"));
  const ProgramMotion park = Read(kStart + "G53 G0 Z0\nG53 X-100 Y-100\n");
  EXPECT_TRUE(park.moves.back().to_above && park.last_motion_is_up);
  EXPECT_TRUE(Read(kStart + "G53 G0 X0 Y0 Z0\n").moves.back().from_anywhere);
  EXPECT_THAT(Refusal(kStart + "G53 G0\n"), HasSubstr("line 5: G53 without coordinates"));
}

TEST(ForeignLines, DeletableLines) {
  const std::string text = kStart + "/G0 Z20\n/2 N7 X3\n/ (nothing)\nX4\n";
  ReaderParams skip;
  skip.run_deletable_lines = false;
  const ProgramMotion run = Read(text), skipped = Read(text, skip);
  EXPECT_TRUE(run.has_deletable_lines && skipped.has_deletable_lines);
  EXPECT_EQ(run.moves.size(), 4u);
  EXPECT_EQ(run.moves.back().to, Vec3(4, 2, 20));
  EXPECT_EQ(skipped.moves.size(), 2u);
  EXPECT_EQ(skipped.moves.back().to, Vec3(4, 2, 5));
  EXPECT_EQ(skipped.moves.back().line, 8);
  EXPECT_FALSE(Read(kStart).has_deletable_lines);
}

// The angle that the chords of the last line turn through, rad, counter-clockwise.
double Turned(const ProgramMotion& motion, const Vec2& center) {
  double sum = 0.0;
  for (const ProgramMove& move : motion.moves) {
    if (move.chord_error == 0.0) continue;
    const Vec2 a = Xy(move.from) - center, b = Xy(move.to) - center;
    sum += std::atan2(Cross(a, b), a.dot(b));
  }
  return sum;
}

TEST(ForeignLines, TurnsOfArcs) {
  const std::string at = kStart + "G1 X5 Y0\n";
  const auto turned = [&](const std::string& arc) { return Turned(Read(at + arc + "\n"), Vec2::Zero()); };
  EXPECT_NEAR(turned("G3 X0 Y5 I-5 J0 P1"), 0.5 * kPi, 1e-9);
  EXPECT_NEAR(turned("G3 X0 Y5 I-5 J0 P3"), 4.5 * kPi, 1e-9);
  EXPECT_NEAR(turned("G2 I-5 J0 P15 Z0"), -30.0 * kPi, 1e-9);
  const ProgramMotion helix = Read(at + "G2 I-5 J0 P4 Z1\n");
  for (const ProgramMove& move : helix.moves) {
    if (move.chord_error == 0.0) continue;
    const double angle = std::atan2(-move.to.y(), move.to.x());
    const double turns = (5.0 - move.to.z()) * 1.0;  // 4 mm in 4 turns
    EXPECT_NEAR(std::remainder(turns - angle / (2.0 * kPi), 1.0), 0.0, 1e-9);
  }
  for (const char* p : {"P0", "P1.5", "P1000000001"})
    EXPECT_THAT(Refusal(at + "G2 I-5 " + p + "\n"), HasSubstr("line 6: P")) << p;
  EXPECT_THAT(Refusal(at + "G2 I-5 P2\n", As("grbl")), HasSubstr("line 6: P without"));
  const auto many = ReadProgram(at + "G2 I-5 P10000000\n");
  EXPECT_EQ(many.status().code(), absl::StatusCode::kResourceExhausted);
  const auto tiny = ReadProgram(kStart + "G2 I-0.00001 P10000000\n");
  EXPECT_EQ(tiny.status().code(), absl::StatusCode::kResourceExhausted);
}

// The places of the moves as "X Y Z" with r for rapids and f for feeds; up for above everything.
std::string Places(const ProgramMotion& motion, std::size_t first) {
  std::string text;
  for (std::size_t k = first; k < motion.moves.size(); ++k) {
    const ProgramMove& move = motion.moves[k];
    text += move.kind == ProgramMove::Kind::kFeed ? "f" : "r";
    text += move.to_above ? fmt::format("{:g},{:g},up ", move.to.x(), move.to.y())
                          : fmt::format("{:g},{:g},{:g} ", move.to.x(), move.to.y(), move.to.z());
  }
  return text;
}

TEST(ForeignLines, CannedCycles) {
  const auto places = [](const std::string& lines) { return Places(Read(kStart + lines), 1); };
  EXPECT_EQ(places("G98 G81 X3 Y4 R1 Z-2\n"), "r3,4,5 r3,4,1 f3,4,-2 r3,4,5 ");
  EXPECT_EQ(places("G99 G81 X3 Y4 R1 Z-2\nX6\nG80\nG0 X0\n"),
            "r3,4,5 r3,4,1 f3,4,-2 r3,4,1 r6,4,1 f6,4,-2 r6,4,1 r0,4,1 ");
  EXPECT_EQ(places("G99 G82 R1 Z-2 P0.5\n"), "r1,2,1 f1,2,-2 r1,2,1 ") << "at the place where it stands";
  EXPECT_EQ(places("G98 G83 X3 R1 Z-2 Q0.000001\n"), "r3,2,5 r3,2,1 f3,2,-2 r3,2,5 ");
  EXPECT_EQ(places("G99 G73 X3 R1 Z-2 Q1\n"), "r3,2,5 r3,2,1 f3,2,-2 r3,2,1 ");
  EXPECT_EQ(places("G98 G81 X3 R8 Z-2\n"), "r1,2,8 r3,2,8 f3,2,-2 r3,2,8 ") << "up to R first";
  EXPECT_EQ(places("G91 G98 G81 X1 Y0 R-1 Z-3 L2\n"),
            "r2,2,5 r2,2,4 f2,2,1 r2,2,5 r3,2,5 r3,2,4 f3,2,1 r3,2,5 ");
  EXPECT_EQ(places("G90 G81 X3 R1 Z0\nZ-1\n"), "r3,2,5 r3,2,1 f3,2,0 r3,2,5 r3,2,1 f3,2,-1 r3,2,5 ");
  EXPECT_EQ(Places(Read("G21 G90 G17 G61 G54 G43 F9\nG0 X0 Y0\nG81 X3 Y4 R1 Z-2\n"), 1),
            "r3,4,up r3,4,1 f3,4,-2 r3,4,up ");
  EXPECT_TRUE(Assumes(Read(kStart + "G81 R1 Z0\n"), "CYCLE_END_ASSUMED"));
  EXPECT_FALSE(Assumes(Read(kStart + "G98 G81 R1 Z0\n"), "CYCLE_END_ASSUMED"));
  const std::pair<const char*, const char*> refused[] = {
      {"G81 X3 Z-2", "R and Z"},  {"G83 R1 Z-2", "Q above 0"}, {"G81 R1 Z2", "above its R"},
      {"G81 R1 Z0 L1.5", "L of"}, {"G18 G81 R1 Z0", "G17"},    {"G81 R1 Z0 I3", "canned cycle"},
      {"G95 G81 R1 Z0", "G95"},   {"G99 G81 R1 Z0 K2", "K"},
  };
  for (const auto& [line, word] : refused) {
    const std::string message = Refusal(kStart + line + "\n");
    EXPECT_THAT(message, ::testing::StartsWith("line 5: ")) << line;
    EXPECT_THAT(message, HasSubstr(word)) << line;
  }
  ReaderParams few;
  few.max_moves = 100;
  const auto many = ReadProgram(kStart + "G91 G81 X1 R-1 Z-1 L1000000\n", few);
  EXPECT_EQ(many.status().code(), absl::StatusCode::kResourceExhausted);
}

TEST(ForeignLines, ToolChanges) {
  const std::string text = kStart + "T2 M6\nG43 H2\nG0 X0 Y0\nZ3\n";
  EXPECT_THAT(Refusal(text), HasSubstr("line 5: M6: tool 2 after tool 1"));
  ReaderParams several;
  several.several_tools = true;
  const ProgramMotion m = Read(text, several);
  EXPECT_TRUE(Assumes(m, "TOOL_CHANGE_ASSUMED"));
  EXPECT_EQ(m.moves.front().tool, 1);
  EXPECT_EQ(m.moves.back().tool, 2);
  EXPECT_TRUE(m.moves.back().from_above) << "nobody knows how high the new tool's tip is";
  const std::string up = kStart + "G53 G0 Z0\nT2 M6\nG43 H2\nG0 X0 Y0\nZ3\n";
  EXPECT_FALSE(Assumes(Read(up, several), "TOOL_CHANGE_ASSUMED"));
}

// One clear error each, in bounded time and memory.
TEST(ForeignLines, HostileTexts) {
  const auto line_of = [](const std::string& text) { return Refusal(kStart + text); };
  EXPECT_THAT(line_of(std::string(60'000'000, '1')), HasSubstr("line 5: longer than"));
  EXPECT_THAT(line_of("X" + std::string(900, '9')), HasSubstr("line 5: "));
  EXPECT_THAT(line_of("X" + std::string(900, '[')), HasSubstr("line 5: X: brackets more than 20 deep"));
  EXPECT_THAT(line_of("X" + std::string(900, '-')), HasSubstr("line 5: "));
  EXPECT_THAT(line_of(std::string(900, '(')), HasSubstr("line 5: comment within a comment"));
  EXPECT_THAT(line_of(std::string(900, '/')), HasSubstr("line 5: / within"));
  EXPECT_THAT(line_of(std::string("G1 X\0", 5)), HasSubstr("line 5: "));
  EXPECT_EQ(Read(kStart + std::string(20'000'000, '\n') + "X9\n").moves.back().line, 20'000'005);
}

}  // namespace
}  // namespace patchmill
