#include "cam/post/program_writer.h"

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <regex>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "cam/post/program_reader.h"
#include "tests/support/rs274.h"

namespace patchmill {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
namespace fs = std::filesystem;

Tool BallTool() {
  Tool tool;
  tool.number = 3;
  tool.name = "ball (carbide)";
  tool.cutter = BallEnd{3.0};
  tool.spindle_rpm = 12000;
  tool.feed = 1200;
  tool.plunge_feed = 400;
  tool.coolant = Coolant::kFlood;
  return tool;
}

PostParams Params() {
  PostParams params;
  params.controller_tolerance = 0.003;
  params.clearance_z = 20.0;
  params.header = {"Patchmill test", "model: two planes"};
  return params;
}

Move To(MoveKind kind, double x, double y, double tip_z, double feed) {
  Move move;
  move.kind = kind;
  move.to = Vec3(x, y, tip_z + 3.0);
  move.feed = feed;
  return move;
}

// A pass with its approach, a step that vanishes in rounding, a link and a retract.
Toolpath SmallPath() {
  Toolpath path;
  path.ball_radius = 3.0;
  path.moves = {To(MoveKind::kRapid, 1, 2, 20, 0),
                To(MoveKind::kRapid, 1, 2, 6.5, 0),
                To(MoveKind::kPlunge, 1, 2, 5, 400),
                To(MoveKind::kCut, 10, 2, 5, 1200),
                To(MoveKind::kCut, 10.00004, 2, 5.00003, 1200),
                To(MoveKind::kCut, 20, 2, -0.00004, 1200),
                To(MoveKind::kLink, 20, 2.5, 0, 1200),
                To(MoveKind::kCut, 1, 2.5, 5, 1200),
                To(MoveKind::kRetract, 1, 2.5, 8, 1200),
                To(MoveKind::kRapid, 1, 2.5, 20, 0),
                To(MoveKind::kRapid, -4, -3, 20, 0),
                To(MoveKind::kRapid, -4, -3, 6, 0),
                To(MoveKind::kPlunge, -4, -3, 5, 400),
                To(MoveKind::kCut, -4, 9, 5.12345, 1200),
                To(MoveKind::kRapid, -4, 9, 20, 0)};
  return path;
}

std::string Golden(const std::string& name, const std::string& text) {
  const fs::path file = fs::path(PATCHMILL_SOURCE_DIR) / "tests/golden" / name;
  if (std::getenv("PATCHMILL_UPDATE_GOLDEN") != nullptr) std::ofstream(file, std::ios::binary) << text;
  std::ifstream in(file, std::ios::binary);
  std::stringstream all;
  all << in.rdbuf();
  return all.str();
}

// Rewritten only by PATCHMILL_UPDATE_GOLDEN=1; read the difference before committing it.
TEST(ProgramWriter, GoldenPrograms) {
  const auto plain = WriteProgram(SmallPath(), BallTool(), Params());
  ASSERT_TRUE(plain.ok()) << plain.status();
  EXPECT_EQ(*plain, Golden("small_path.ngc", *plain));

  Tool tool = BallTool();
  tool.coolant = Coolant::kOff;
  tool.name.clear();
  tool.shank_diameter = 8.0;
  tool.flute_length = 12.0;
  PostParams params = Params();
  params.work_offset = "G57";
  params.program_zero = Vec3(10, -5.5, 4);
  params.zero_name = "top center of the model's box";
  params.controller_tolerance = 5e-5;
  params.header = {"(msg, not a command)", "MSG,neither", "größe 5 mm", std::string(150, 'x') + " end"};
  const auto moved = WriteProgram(SmallPath(), tool, params);
  ASSERT_TRUE(moved.ok()) << moved.status();
  EXPECT_EQ(*moved, Golden("moved_zero.ngc", *moved));
}

TEST(ProgramWriter, EveryLineIsWhatAControlCanRead) {
  const auto program = WriteProgram(SmallPath(), BallTool(), Params());
  ASSERT_TRUE(program.ok());
  EXPECT_EQ(program->back(), '\n');
  EXPECT_THAT(*program, Not(HasSubstr("-0.0000")));
  std::istringstream lines(*program);
  const std::regex move(
      "(G[01] )?(X-?[0-9]+\\.[0-9]{4} ?)?(Y-?[0-9]+\\.[0-9]{4} ?)?(Z-?[0-9]+\\.[0-9]{4} ?)?(F[0-9.]+)?");
  int moves = 0;
  for (std::string line; std::getline(lines, line);) {
    EXPECT_LE(line.size(), 120u);
    EXPECT_FALSE(line.empty());
    for (const char c : line) EXPECT_TRUE(c >= ' ' && c <= '~') << line;
    if (line.find_first_of("XYZ") == 0 || line.rfind("G0", 0) == 0 || line.rfind("G1 ", 0) == 0) {
      EXPECT_TRUE(std::regex_match(line, move)) << line;
      ++moves;
    }
  }
  EXPECT_EQ(moves, 2 + 13);  // to the first place; all others but the one that vanishes in rounding
}

TEST(ProgramWriter, FeedIsRepeatedAfterEveryRapid) {
  const auto program = WriteProgram(SmallPath(), BallTool(), Params());
  ASSERT_TRUE(program.ok());
  std::istringstream lines(*program);
  bool rapid = true;
  int feeds = 0;
  for (std::string line; std::getline(lines, line);) {
    if (line.rfind("G1 ", 0) == 0) {
      EXPECT_TRUE(rapid) << "G1 is modal: " << line;
      EXPECT_THAT(line, HasSubstr(" F"));
      rapid = false;
      ++feeds;
    } else if (line.rfind("G0 ", 0) == 0) {
      rapid = true;
    }
  }
  EXPECT_EQ(feeds, 2);
}

TEST(ProgramWriter, HeaderStatesTheRangeOfAllMoves) {
  const auto program = WriteProgram(SmallPath(), BallTool(), Params());
  ASSERT_TRUE(program.ok());
  EXPECT_THAT(*program, HasSubstr("X -4.0000 to 20.0000, Y -3.0000 to 9.0000, Z 0.0000 to 20.0000"));
  EXPECT_THAT(*program, HasSubstr("tool tip"));
  EXPECT_THAT(*program, HasSubstr("MM"));
}

TEST(ProgramWriter, OrderOfStartAndEnd) {
  const auto program = WriteProgram(SmallPath(), BallTool(), Params());
  ASSERT_TRUE(program.ok());
  std::size_t at = 0;
  for (const char* word : {"G17 G21 G40 G49 G54 G80 G90 G91.1 G94\n", "G64 P0.0030 Q0\n", "G53 G0 Z0\n",
                           "T3 M6\n", "S12000 M3\n", "M8\n", "G43 H3\n", "G0 X1.0000 Y2.0000\n", "Z20.0000\n",
                           "M9\n", "M5\n", "G53 G0 Z0\n", "M2\n"}) {
    const std::size_t found = program->find(word, at);
    ASSERT_NE(found, std::string::npos) << word;
    at = found + 1;
  }
}

TEST(ProgramWriter, RefusesWhatItCannotWrite) {
  PostParams params = Params();
  params.program_number = 10'000;
  auto result = WriteProgram(SmallPath(), BallTool(), params);
  EXPECT_EQ(result.status().code(), absl::StatusCode::kInvalidArgument);
  EXPECT_THAT(std::string(result.status().message()), HasSubstr("program_number"));
  params = Params();
  params.work_offset = "G60";
  EXPECT_FALSE(WriteProgram(SmallPath(), BallTool(), params).ok());
  params = Params();
  params.controller_tolerance = -0.001;
  EXPECT_FALSE(WriteProgram(SmallPath(), BallTool(), params).ok());
  Toolpath path = SmallPath();
  path.moves[4].to.x() = std::nan("");
  EXPECT_FALSE(WriteProgram(path, BallTool(), Params()).ok());
  path = SmallPath();
  path.moves[4].to.x() = 1e9;
  EXPECT_FALSE(WriteProgram(path, BallTool(), Params()).ok());
  path = SmallPath();
  path.moves[4].feed = 0.0;
  EXPECT_FALSE(WriteProgram(path, BallTool(), Params()).ok());
  EXPECT_FALSE(WriteProgram(Toolpath{}, BallTool(), Params()).ok());
}

// What is read back is what was planned, to half a last digit.
TEST(ProgramWriter, RoundTrip) {
  std::uint64_t state = 7;
  const auto random = [&](double low, double high) {
    state = state * 6364136223846793005ULL + 1442695040888963407ULL;
    return low + (high - low) * static_cast<double>(state >> 11) * 0x1p-53;
  };
  Toolpath path;
  path.ball_radius = 2.5;
  const Vec3 zero(11.1, -7.7, 3.3);
  path.moves.push_back({.kind = MoveKind::kRapid, .to = Vec3(0, 0, 60)});
  for (int i = 0; i < 3000; ++i) {
    const bool rapid = i % 50 == 49;
    path.moves.push_back({.kind = rapid ? MoveKind::kRapid : MoveKind::kCut,
                          .to = Vec3(random(-80, 80), random(-80, 80), random(-20, 50)),
                          .feed = rapid ? 0.0 : std::floor(random(100, 2000))});
  }
  path.moves.push_back({.kind = MoveKind::kRapid, .to = path.moves.back().to + Vec3(0, 0, 100)});
  PostParams params = Params();
  params.program_zero = zero;
  params.clearance_z = 57.5;
  const auto program = WriteProgram(path, BallTool(), params);
  ASSERT_TRUE(program.ok()) << program.status();
  const auto motion = ReadProgram(*program);
  ASSERT_TRUE(motion.ok()) << motion.status();
  EXPECT_TRUE(motion->first_motion_is_up);
  EXPECT_TRUE(motion->last_motion_is_up);
  EXPECT_TRUE(motion->ends_with_coolant_off);
  EXPECT_TRUE(motion->ends_with_spindle_off);
  EXPECT_EQ(motion->tool_number, 3);
  EXPECT_DOUBLE_EQ(motion->controller_tolerance, 0.003);
  // Up, over the first point, down to clearance, the path but for its first point, up.
  ASSERT_EQ(motion->moves.size(), path.moves.size() + 3);
  EXPECT_TRUE(motion->moves.front().to_above);
  EXPECT_TRUE(motion->moves.back().to_above);
  for (std::size_t i = 1; i < path.moves.size(); ++i) {
    const ProgramMove& read = motion->moves[i + 2];
    const Vec3 tip = path.moves[i].to - Vec3(0, 0, 2.5) - zero;
    EXPECT_LE((read.to - tip).cwiseAbs().maxCoeff(), 0.5e-4 + 1e-9);
    EXPECT_EQ(read.kind == ProgramMove::Kind::kRapid, path.moves[i].kind == MoveKind::kRapid);
    EXPECT_EQ(read.feed, path.moves[i].feed);
    EXPECT_EQ(read.from, motion->moves[i + 1].to);
  }
}

// The real interpreter (linuxcnc-uspace; scripts/setup.sh installs it).
TEST(ProgramWriter, Rs274AcceptsTheProgram) {
  ASSERT_TRUE(testing::HasRs274()) << "rs274 is missing; run scripts/setup.sh";
  for (const bool moved : {false, true}) {
    Tool tool = BallTool();
    PostParams params = Params();
    if (moved) {
      params.work_offset = "G58";
      params.controller_tolerance = 5e-5;
      params.header = {"MSG,x", "((nested))", "DEBUG,#1", std::string(400, 'y')};
      tool.coolant = Coolant::kAir;
    }
    const auto program = WriteProgram(SmallPath(), tool, params);
    ASSERT_TRUE(program.ok());
    // Work offsets put program zero 100 inches below machine zero: G54 5221.., G58 5301..
    std::ostringstream variables;
    for (int base = 5221; base <= 5381; base += 20) {
      for (int k = 0; k < 10; ++k) variables << base + k << '\t' << (k == 2 ? -100.0 : 0.0) << '\n';
    }
    const auto [status, out] = testing::RunRs274(
        *program, {.tool_table = "T3 P3 D0.23622 Z0 ;ball, inches\n", .variables = variables.str()});
    EXPECT_EQ(status, 0) << out;
    EXPECT_THAT(out, HasSubstr("PROGRAM_END()"));
    EXPECT_THAT(out, HasSubstr("STRAIGHT_TRAVERSE(1.0000, 2.0000, 2540.0000"));
    EXPECT_THAT(out, HasSubstr("STRAIGHT_FEED(20.0000, 2.0000, 0.0000"));
    EXPECT_THAT(out, Not(HasSubstr("MESSAGE(")));
    // No move between machine zero and the clearance plane but the vertical ones.
    EXPECT_LT(out.find("STRAIGHT_TRAVERSE(1.0000, 2.0000, 2540.0000"),
              out.find("STRAIGHT_TRAVERSE(1.0000, 2.0000, 20.0000"));
  }
}

}  // namespace
}  // namespace patchmill
