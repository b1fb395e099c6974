// Sections and restart points in the text of programs: what a control that starts there would do.
#include <algorithm>
#include <sstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "cam/post/program_reader.h"
#include "cam/post/program_writer.h"

namespace patchmill {
namespace {

using ::testing::HasSubstr;

constexpr double kRadius = 3.0;

Move To(MoveKind kind, const Vec3& tip, double feed) {
  return {.kind = kind, .to = tip + Vec3(0, 0, kRadius), .feed = feed};
}

// Two passes with a retract between, the first with an arc in another plane at its end.
Toolpath TwoPasses() {
  Toolpath path;
  path.ball_radius = kRadius;
  path.moves = {To(MoveKind::kRapid, {1, 2, 20}, 0),    To(MoveKind::kRapid, {1, 2, 6}, 0),
                To(MoveKind::kPlunge, {1, 2, 5}, 400),  To(MoveKind::kCut, {10, 2, 5}, 1200),
                To(MoveKind::kCut, {20, 2, 5}, 1200),   To(MoveKind::kRapid, {20, 2, 12}, 0),
                To(MoveKind::kRapid, {-4, 3, 12}, 0),   To(MoveKind::kRapid, {-4, 3, 6}, 0),
                To(MoveKind::kPlunge, {-4, 3, 5}, 400), To(MoveKind::kCut, {-4, 9, 4}, 1200),
                To(MoveKind::kRapid, {-4, 9, 20}, 0)};
  path.moves[4].arc = Arc{ArcPlane::kZx, {5.0 + kRadius, 15.0}, true};
  return path;
}
constexpr std::size_t kOver = 6;  // the rapid over the second pass

PostParams Params(const Dialect& dialect) {
  PostParams params;
  params.dialect = dialect;
  params.clearance_z = 20.0;
  params.controller_tolerance = 0.003;
  params.sections = {{.first_move = 0, .comment = "first section", .first_pass = 0, .restart = true},
                     {.first_move = kOver, .comment = "second section", .first_pass = 1, .restart = true}};
  return params;
}

Tool BallTool() {
  Tool tool;
  tool.number = 3;
  tool.cutter = BallEnd{kRadius};
  tool.spindle_rpm = 12000;
  return tool;
}

std::string Write(const PostParams& params) {
  const auto text = WriteProgram(TwoPasses(), BallTool(), params);
  EXPECT_TRUE(text.ok()) << text.status();
  return text.value_or("");
}

ProgramMotion Read(const std::string& text, const Dialect& dialect) {
  ReaderParams params;
  params.dialect = dialect;
  const auto read = ReadProgram(text, params);
  EXPECT_TRUE(read.ok()) << read.status() << "\n" << text;
  return read.value_or(ProgramMotion{});
}

std::vector<Vec3> FeedEnds(const ProgramMotion& motion) {
  std::vector<Vec3> ends;
  for (const ProgramMove& move : motion.moves)
    if (move.kind == ProgramMove::Kind::kFeed) ends.push_back(move.to);
  return ends;
}

class RestartIn : public ::testing::TestWithParam<std::string> {
 protected:
  const Dialect& dialect_ = *FindDialect(GetParam());
};

TEST_P(RestartIn, SectionsChangeNoMove) {
  PostParams params = Params(dialect_);
  const std::string with = Write(params);
  EXPECT_THAT(with, HasSubstr(dialect_.upper_case ? "FIRST SECTION" : "first section"));
  params.sections.clear();
  const std::string without = Write(params);
  EXPECT_EQ(FeedEnds(Read(with, dialect_)), FeedEnds(Read(without, dialect_)));
  EXPECT_EQ(Read(with, dialect_).moves.size(), Read(without, dialect_).moves.size());
}

TEST_P(RestartIn, TheControlMayStartAtARestartPoint) {
  PostParams params = Params(dialect_);
  params.restart_points = true;
  const std::string text = Write(params);
  const ProgramMotion whole = Read(text, dialect_);
  EXPECT_TRUE(whole.last_motion_is_up);
  const std::size_t comment =
      text.find(dialect_.upper_case ? "RESTART POINT 1: THE CONTROL" : "restart point 1: the control");
  ASSERT_NE(comment, std::string::npos) << text;
  EXPECT_EQ(text.find(dialect_.upper_case ? "RESTART POINT 2" : "restart point 2"), std::string::npos);
  std::string rest = text.substr(text.find('\n', comment) + 1);
  if (dialect_.syntax == Syntax::kKlartext) rest = "0 BEGIN PGM 1 MM\n" + rest;
  const ProgramMotion tail = Read(rest, dialect_);
  EXPECT_TRUE(tail.first_motion_is_up);
  EXPECT_TRUE(tail.last_motion_is_up);
  const std::vector<Vec3> all = FeedEnds(whole), some = FeedEnds(tail);
  ASSERT_EQ(some.size(), 2u);
  EXPECT_EQ(some[0], all[all.size() - 2]);
  EXPECT_EQ(some[1], all.back());
  EXPECT_EQ(tail.controller_tolerance, whole.controller_tolerance);
  std::vector<double> feeds;
  for (const ProgramMove& move : tail.moves) {
    if (move.kind != ProgramMove::Kind::kFeed) continue;
    EXPECT_GT(move.spindle_speed, 0.0F);
    feeds.push_back(move.feed);
  }
  EXPECT_EQ(feeds, (std::vector<double>{400.0, 1200.0}));
  // It comes from above, over the second pass.
  ASSERT_GE(tail.moves.size(), 2u);
  const auto down = std::find_if(tail.moves.begin(), tail.moves.end(), [](const ProgramMove& move) {
    return !move.to_above && move.to.z() < 21.0;
  });
  ASSERT_NE(down, tail.moves.end());
  EXPECT_EQ(down->to, Vec3(-4, 3, 20));
}

INSTANTIATE_TEST_SUITE_P(All, RestartIn, ::testing::ValuesIn([] {
                           std::vector<std::string> names;
                           for (const Dialect& dialect : Dialects()) names.push_back(dialect.name);
                           return names;
                         }()),
                         [](const auto& dialect) { return dialect.param; });

TEST(RestartPoints, AreRefusedWithoutTheirLines) {
  Dialect dialect = LinuxCnc();
  dialect.restart.clear();
  PostParams params = Params(dialect);
  params.restart_points = true;
  const auto text = WriteProgram(TwoPasses(), BallTool(), params);
  ASSERT_FALSE(text.ok());
  EXPECT_THAT(std::string(text.status().message()), HasSubstr("has no section [restart]"));
}

TEST(RestartPoints, FaultsOfTheSection) {
  const std::string text = LinuxCnc().text;
  const std::string section = "[restart]\n", z = "Z{z}\n\n[end]";
  std::string header = text;
  header.insert(header.find(section) + section.size(), "{header}\n");
  EXPECT_THAT(std::string(ParseDialect(header).status().message()), HasSubstr("[restart] has no {header}"));
  std::string lost = text;
  lost.replace(lost.find(z), z.size(), "[end]");
  EXPECT_THAT(std::string(ParseDialect(lost).status().message()),
              HasSubstr("[restart] nowhere sends the tool to {z}"));
  std::string silent = text;
  const std::string speed = "S{speed} M3\n";
  silent.erase(silent.rfind(speed), speed.size());
  EXPECT_THAT(std::string(ParseDialect(silent).status().message()), HasSubstr("[restart] has no {speed}"));
}

// On some controls G49 moves the axis by the offset that it cancels. Programs for these have none;
// elsewhere it does not stand between a restart point and the way up.
TEST_P(RestartIn, NoOffsetIsCancelledWhileTheToolIsDown) {
  PostParams params = Params(dialect_);
  params.restart_points = true;
  const std::string text = Write(params);
  if (dialect_.name == "fanuc" || dialect_.name == "haas") {
    EXPECT_EQ(text.find("G49"), std::string::npos);
  }
  const std::size_t comment =
      text.find(dialect_.upper_case ? "RESTART POINT 1: THE CONTROL" : "restart point 1: the control");
  ASSERT_NE(comment, std::string::npos);
  const std::size_t up =
      std::min({text.find("Z0", comment), text.find("Z+0", comment), text.find("Z-2", comment)});
  ASSERT_NE(up, std::string::npos) << text;
  EXPECT_EQ(text.substr(comment, up - comment).find("G49"), std::string::npos);
}

// The numbers do not repeat while a step of 1 can prevent it.
TEST(LineNumbers, DoNotRepeat) {
  Toolpath path;
  path.ball_radius = kRadius;
  path.moves.push_back(To(MoveKind::kRapid, {0, 0, 20}, 0));
  for (int k = 0; k < 30'000; ++k)
    path.moves.push_back(To(MoveKind::kCut, {0.01 * k, 0.5 * (k % 2), 5}, 1200));
  PostParams params = Params(LinuxCnc());
  params.sections.clear();
  params.dialect.line_number_step = 10;
  const auto text = WriteProgram(path, BallTool(), params);
  ASSERT_TRUE(text.ok()) << text.status();
  int before = 0;
  std::istringstream lines(*text);
  for (std::string line; std::getline(lines, line);) {
    if (line[0] != 'N') continue;
    const int number = std::stoi(line.substr(1));
    EXPECT_GT(number, before);
    before = number;
  }
  EXPECT_GT(before, 30'000);
}

// The lines are numbered by the step, comments are not.
TEST(LineNumbers, CountByTheStep) {
  PostParams params = Params(LinuxCnc());
  params.dialect.line_number_step = 5;
  const std::string text = Write(params);
  EXPECT_THAT(text, HasSubstr("\nN5 G17 "));
  EXPECT_THAT(text, HasSubstr("\nN10 G64 "));
  EXPECT_THAT(text, HasSubstr("\n(second section)\nN"));
  PostParams plain = Params(LinuxCnc());
  EXPECT_EQ(FeedEnds(Read(text, LinuxCnc())), FeedEnds(Read(Write(plain), LinuxCnc())));
}

}  // namespace
}  // namespace patchmill
