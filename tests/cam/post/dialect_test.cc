// The dialects that Patchmill brings along, and post files of one's own.
#include "cam/post/dialect.h"

#include <algorithm>
#include <climits>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <optional>
#include <sstream>
#include <string>
#include <tuple>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "cam/post/program_reader.h"
#include "cam/post/program_writer.h"
#include "tests/support/random.h"

namespace patchmill {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using testing::Random;
namespace fs = std::filesystem;

constexpr double kRadius = 3.0;

Tool BallTool() {
  Tool tool;
  tool.number = 3;
  tool.name = "ball (carbide)";
  tool.cutter = BallEnd{kRadius};
  tool.spindle_rpm = 12000;
  tool.feed = 1200;
  tool.plunge_feed = 400;
  tool.coolant = Coolant::kFlood;
  return tool;
}

PostParams ParamsFor(const Dialect& dialect) {
  PostParams params;
  params.dialect = dialect;
  params.program_number = 42;
  params.controller_tolerance = dialect.path_tolerance.empty() ? 0.0 : 0.003;
  params.clearance_z = 20.0;
  params.header = {"Patchmill test", "model: two (planes)"};
  return params;
}

// A random walk of cuts with retracts. No move vanishes in rounding.
Toolpath RandomPath(std::uint64_t seed) {
  Random random(seed);
  Toolpath path;
  path.ball_radius = kRadius;
  const auto go = [&](MoveKind kind, double x, double y, double z, double feed) {
    Move move;
    move.kind = kind;
    move.to = Vec3(x, y, z + kRadius);
    move.feed = feed;
    path.moves.push_back(move);
  };
  for (int pass = 0; pass < 4; ++pass) {
    double x = random.Uniform(-50, 50), y = random.Uniform(-50, 50), z = random.Uniform(-9, 9);
    go(MoveKind::kRapid, x, y, 20.0, 0.0);
    go(MoveKind::kPlunge, x, y, z, 400.0);
    for (int k = 0; k < 20; ++k) {
      x += random.Uniform(0.1, 2.0);
      y += random.Uniform(-2.0, 2.0);
      z += random.Uniform(-0.3, 0.3);
      go(MoveKind::kCut, x, y, z, k % 7 == 3 ? 777.5 : 1200.0);
    }
    go(MoveKind::kRapid, x, y, 20.0, 0.0);
  }
  return path;
}

// Arcs of all planes between straight moves, both ways round, with full circles and helices.
Toolpath PathWithArcs(std::uint64_t seed) {
  Random random(seed);
  Toolpath path;
  path.ball_radius = kRadius;
  path.moves.push_back({.kind = MoveKind::kRapid, .to = Vec3(0, 0, 20.0 + kRadius)});
  path.moves.push_back({.kind = MoveKind::kPlunge, .to = Vec3(0, 0, 1.0), .feed = 400.0});
  for (int k = 0; k < 24; ++k) {
    const Vec3 from = path.moves.back().to;
    Move move = {.kind = MoveKind::kCut, .to = from, .feed = k % 7 == 3 ? 777.5 : 1200.0};
    const auto plane = static_cast<ArcPlane>(k / 4 % 3);
    const double radius = random.Uniform(1.0, 20.0), begin = random.Uniform(-kPi, kPi);
    const double turn = k % 4 == 0 ? 2.0 * kPi : random.Uniform(0.1, kPi);
    const bool clockwise = random.Int(2) == 1;
    const Vec3 start = ToPlane(plane, from);
    const Vec2 center = Xy(start) - radius * Vec2(std::cos(begin), std::sin(begin));
    const double end = begin + (clockwise ? -turn : turn);
    const double climb = k % 4 == 1 ? random.Uniform(-1.0, 1.0) : 0.0;
    if (k % 4 == 2) {
      move.to += Vec3(random.Uniform(0.1, 2.0), random.Uniform(-2.0, 2.0), random.Uniform(-0.3, 0.3));
    } else {
      move.arc = Arc{plane, center, clockwise};
      const Vec2 at = center + radius * Vec2(std::cos(end), std::sin(end));
      if (k % 4 != 0) move.to = FromPlane(plane, Lift(at, start.z() + climb));
    }
    path.moves.push_back(move);
  }
  path.moves.push_back({.kind = MoveKind::kRapid, .to = Lift(Xy(path.moves.back().to), 20.0 + kRadius)});
  return path;
}

// A move as it was sent: its length, and the distance of a place at the share t of it from the exact one.
struct SentMove {
  Vec3 from, to;
  std::optional<Arc> arc;

  double Radius() const { return (Xy(ToPlane(arc->plane, from)) - arc->center).norm(); }
  double Length() const {
    if (!arc) return (to - from).norm();
    const double climb = ToPlane(arc->plane, to).z() - ToPlane(arc->plane, from).z();
    return std::hypot(Radius() * Sweep(*arc, {from, to}), climb);
  }
  double Distance(const Vec3& p, double t) const {
    if (!arc) return (p - from - t * (to - from)).norm();
    const Vec3 q = ToPlane(arc->plane, p), a = ToPlane(arc->plane, from), b = ToPlane(arc->plane, to);
    return std::hypot((Xy(q) - arc->center).norm() - Radius(), q.z() - a.z() - t * (b.z() - a.z()));
  }
};

class EveryDialect : public ::testing::TestWithParam<std::tuple<std::string, ProgramUnit>> {
 protected:
  const std::string& name() const { return std::get<0>(GetParam()); }
  const Dialect& dialect() const { return *FindDialect(name()); }
  bool inch() const { return std::get<1>(GetParam()) == ProgramUnit::kInch; }
  // mm: the last decimal.
  double tick() const {
    return inch() ? 25.4 * std::pow(10.0, -dialect().decimals[ProgramUnit::kInch])
                  : std::pow(10.0, -dialect().decimals[ProgramUnit::kMillimeter]);
  }
  PostParams Params() const { return ParamsOf(dialect()); }
  PostParams ParamsOf(const Dialect& dialect) const {
    PostParams params = ParamsFor(dialect);
    params.unit = std::get<1>(GetParam());
    return params;
  }
};

TEST_P(EveryDialect, IsReadBackAsTheSameMotion) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const Toolpath path = RandomPath(seed);
    const auto program = WriteProgram(path, BallTool(), Params());
    ASSERT_TRUE(program.ok()) << program.status();
    const auto motion = ReadProgram(*program, {.dialect = dialect()});
    ASSERT_TRUE(motion.ok()) << motion.status() << "\n" << *program;
    // GRBL has no tool table: the tool's length is set by hand.
    ASSERT_EQ(motion->assumptions.size(), name() == "grbl" ? 1u : 0u) << motion->assumptions.front().message;
    if (name() == "grbl") {
      EXPECT_EQ(motion->assumptions.front().code, "LENGTH_OFFSET_ASSUMED");
    }
    EXPECT_TRUE(motion->first_motion_is_up);
    EXPECT_TRUE(motion->last_motion_is_up);
    EXPECT_TRUE(motion->ends_with_spindle_off);
    EXPECT_TRUE(motion->ends_with_coolant_off);
    // Rounded down, to five decimals of an inch.
    const double stated = dialect().path_tolerance.empty() ? 0.0 : 0.003;
    EXPECT_LE(motion->controller_tolerance, stated + 1e-15);
    EXPECT_NEAR(motion->controller_tolerance, stated, inch() ? 25.4e-5 : 1e-15);
    std::vector<const ProgramMove*> below;
    for (const ProgramMove& move : motion->moves) {
      if (!move.to_above && !move.from_above) below.push_back(&move);
    }
    ASSERT_EQ(below.size(), path.moves.size() - 1);
    const double half = 0.5000001 * tick();
    for (std::size_t i = 0; i < below.size(); ++i) {
      const Move& sent = path.moves[i + 1];
      const Vec3 tip = sent.to - Vec3(0, 0, kRadius);
      EXPECT_LE((below[i]->to - tip).cwiseAbs().maxCoeff(), half);
      EXPECT_EQ(below[i]->kind == ProgramMove::Kind::kRapid, sent.kind == MoveKind::kRapid);
      if (sent.kind != MoveKind::kRapid) {
        EXPECT_LE(below[i]->feed, sent.feed + 1e-9);
        EXPECT_NEAR(below[i]->feed, sent.feed, inch() ? 25.4e-4 : 0.0);
        EXPECT_GT(below[i]->spindle_speed, 0.0F);
      }
    }
  }
}

// Each arc is read back beside the one that was sent, move by move, and its ends to half a last digit.
TEST_P(EveryDialect, ArcsAreReadBackAsTheSameMotion) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const Toolpath path = PathWithArcs(seed);
    const auto program = WriteProgram(path, BallTool(), Params());
    ASSERT_TRUE(program.ok()) << program.status();
    const auto motion = ReadProgram(*program, {.arc_chord_error = 1e-6, .dialect = dialect()});
    ASSERT_TRUE(motion.ok()) << motion.status() << "\n" << *program;
    EXPECT_EQ(motion->assumptions.size(), name() == "grbl" ? 1u : 0u);
    const double unit = tick();
    std::vector<const ProgramMove*> below;
    for (const ProgramMove& move : motion->moves) {
      if (!move.to_above && !move.from_above) below.push_back(&move);
    }
    std::size_t next = 0;
    for (std::size_t i = 1; i < path.moves.size(); ++i) {
      const Vec3 tip(0, 0, -kRadius);
      SentMove sent{path.moves[i - 1].to + tip, path.moves[i].to + tip, path.moves[i].arc};
      if (sent.arc) sent.arc->center += Xy(ToPlane(sent.arc->plane, tip));
      // Read moves until the end of this one; a full circle ends where it starts.
      double most = 0.0, length = 0.0;
      while (next < below.size()) {
        const ProgramMove& read = *below[next++];
        length += (read.to - read.from).norm();
        most = std::max(most, sent.Distance(read.to, length / sent.Length()));
        if (length > 0.9 * sent.Length() && (read.to - sent.to).cwiseAbs().maxCoeff() <= 0.5000001 * unit)
          break;
      }
      EXPECT_LE(most, (sent.arc ? 2.0 : 1.0) * unit) << "seed " << seed << ", move " << i;
      EXPECT_NEAR(length, sent.Length(), 1e-3 * sent.Length() + 4.0 * unit)
          << "seed " << seed << ", move " << i;
    }
    EXPECT_EQ(next, below.size());
  }
}

// A line of the program for each move, also where arcs are several lines and moves vanish.
TEST_P(EveryDialect, KnowsTheLineOfEachMove) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    const Toolpath path = PathWithArcs(seed);
    PostParams params = Params();
    params.sections = {{.first_move = 5, .comment = "half"}};
    const auto program = WriteProgramWithLines(path, BallTool(), params);
    ASSERT_TRUE(program.ok()) << program.status();
    EXPECT_EQ(program->text, *WriteProgram(path, BallTool(), params));
    ASSERT_EQ(program->move_lines.size(), path.moves.size());
    const auto motion = ReadProgram(program->text, {.dialect = dialect()});
    ASSERT_TRUE(motion.ok()) << motion.status();
    for (std::size_t i = 1; i + 1 < path.moves.size(); ++i) {
      const int first = program->move_lines[i], next = program->move_lines[i + 1];
      EXPECT_GE(first, program->move_lines[i - 1]);
      // The last place of the lines from this one to the next move's is the end of the move.
      std::optional<Vec3> end;
      for (const ProgramMove& move : motion->moves) {
        if (move.line >= first && move.line < std::max(next, first + 1)) end = move.to;
      }
      ASSERT_TRUE(end) << i;
      EXPECT_LT((*end - (path.moves[i].to - Vec3(0, 0, kRadius))).cwiseAbs().maxCoeff(), tick())
          << "move " << i << ", line " << first;
    }
  }
}

// Heights in the comments of sections are in the unit of the coordinates below them.
TEST_P(EveryDialect, SectionsStateHeightsInTheUnitOfTheProgram) {
  PostParams params = Params();
  params.sections = {{.first_move = 1, .comment = "section 1", .tip = ProgramSection::Heights{-2.54, 25.4}}};
  const auto program = WriteProgram(RandomPath(1), BallTool(), params);
  ASSERT_TRUE(program.ok());
  std::string text = *program;
  std::transform(text.begin(), text.end(), text.begin(),
                 [](char c) { return static_cast<char>(std::tolower(c)); });
  EXPECT_THAT(text,
              HasSubstr(inch() ? "section 1, tip z1.0000 to z-0.1000" : "section 1, tip z25.400 to z-2.540"));
  EXPECT_EQ(text.find("program in inch") != std::string::npos, inch());
}

TEST_P(EveryDialect, ALevelCircleIsOneBlock) {
  Toolpath path;
  path.ball_radius = kRadius;
  path.moves.push_back({.kind = MoveKind::kRapid, .to = Vec3(5, 0, 23)});
  path.moves.push_back({.kind = MoveKind::kPlunge, .to = Vec3(5, 0, 1), .feed = 400.0});
  Move circle = {.kind = MoveKind::kCut, .to = Vec3(5, 0, 1), .feed = 1200.0};
  circle.arc = Arc{ArcPlane::kXy, Vec2::Zero(), true};
  path.moves.push_back(circle);
  const auto program = WriteProgram(path, BallTool(), Params());
  ASSERT_TRUE(program.ok());
  const auto motion = ReadProgram(*program, {.dialect = dialect()});
  ASSERT_TRUE(motion.ok()) << motion.status();
  double length = 0.0;
  std::vector<int> lines;
  for (const ProgramMove& move : motion->moves) {
    if (move.kind != ProgramMove::Kind::kFeed || move.feed < 1199.0) continue;
    length += (move.to - move.from).norm();
    if (lines.empty() || lines.back() != move.line) lines.push_back(move.line);
  }
  EXPECT_EQ(lines.size(), 1u);
  EXPECT_NEAR(length, 10.0 * kPi, 1e-2);
}

// Rewritten only by PATCHMILL_UPDATE_GOLDEN=1; read the difference before committing it.
TEST_P(EveryDialect, HasTheseBytes) {
  Toolpath path = RandomPath(5);
  path.moves.resize(12);
  const Toolpath arcs = PathWithArcs(5);
  path.moves.insert(path.moves.end(), arcs.moves.begin(), arcs.moves.begin() + 14);
  PostParams params = Params();
  params.chord_sagitta = 0.1;
  const auto program = WriteProgram(path, BallTool(), params);
  ASSERT_TRUE(program.ok()) << program.status();
  const fs::path file =
      fs::path(PATCHMILL_SOURCE_DIR) / "tests/golden/posts" / (name() + (inch() ? "_inch.ngc" : ".ngc"));
  if (std::getenv("PATCHMILL_UPDATE_GOLDEN") != nullptr) std::ofstream(file, std::ios::binary) << *program;
  std::ostringstream golden;
  golden << std::ifstream(file, std::ios::binary).rdbuf();
  EXPECT_EQ(*program, golden.str());
}

TEST_P(EveryDialect, LinesAreShortAndAscii) {
  const auto program = WriteProgram(RandomPath(2), BallTool(), Params());
  ASSERT_TRUE(program.ok());
  std::istringstream lines(*program);
  for (std::string line; std::getline(lines, line);) {
    EXPECT_LE(line.size(), dialect().max_comment_length) << line;
    EXPECT_FALSE(line.empty());
    for (const char c : line) EXPECT_TRUE(c >= ' ' && c <= '~') << line;
  }
  EXPECT_THAT(*program, Not(HasSubstr("{")));
}

TEST_P(EveryDialect, PostFileMakesTheSameDialect) {
  const auto again = ParseDialect(dialect().text);
  ASSERT_TRUE(again.ok()) << again.status();
  const Toolpath path = RandomPath(3);
  EXPECT_EQ(*WriteProgram(path, BallTool(), ParamsOf(*again)), *WriteProgram(path, BallTool(), Params()));
}

// Each line of an own post file that is damaged gives an error with its line, or another dialect; never a
// crash.
TEST_P(EveryDialect, DamagedPostFilesAreNamed) {
  Random random(9);
  const std::string& text = dialect().text;
  for (int k = 0; k < 400; ++k) {
    std::string damaged = text;
    const auto at = static_cast<std::size_t>(random.Int(static_cast<int>(text.size())));
    if (k % 3 == 0) damaged.erase(at, 1 + static_cast<std::size_t>(random.Int(20)));
    if (k % 3 == 1) damaged[at] = static_cast<char>(random.Int(256));
    if (k % 3 == 2) damaged.insert(at, 1, "{}=[]#\n"[random.Int(7)]);
    const auto read = ParseDialect(damaged);
    if (read.ok()) {
      (void)WriteProgram(RandomPath(1), BallTool(), ParamsFor(*read));
    } else {
      EXPECT_THAT(std::string(read.status().message()), ::testing::ContainsRegex("^(line [0-9]+: |\\[)"));
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Posts, EveryDialect,
                         ::testing::Combine(::testing::Values("fanuc", "grbl", "haas", "heidenhain",
                                                              "linuxcnc", "mach3", "siemens"),
                                            ::testing::Values(ProgramUnit::kMillimeter, ProgramUnit::kInch)),
                         [](const auto& of) {
                           return std::get<0>(of.param) +
                                  (std::get<1>(of.param) == ProgramUnit::kInch ? "_inch" : "_mm");
                         });

TEST(Dialects, AreAllTested) {
  EXPECT_EQ(DialectNames(), "fanuc, grbl, haas, heidenhain, linuxcnc, mach3, siemens");
}

constexpr const char* kShop = R"(# Our mill.
[control]
name = shop
decimals = 3
comment = ;
comment_length = 80
line_numbers = 10
line_end = crlf
feed_point = yes
[path]
follows = exactly
[coolant]
flood = M50
[words]
M50 = none
M51 = none
[begin]
{header}
G17 G21 G90 G94 G40 G49 G80 {work_offset}
G53 G0 Z0
T{tool} M6
{coolant}
S{speed} M3
G43 H{tool}
G0 X{x} Y{y}
Z{z}
[end]
M9
M51
M5
G53 G0 Z0
M30
)";

TEST(OwnPostFile, IsWhatTheFileSays) {
  const auto shop = ParseDialect(kShop);
  ASSERT_TRUE(shop.ok()) << shop.status();
  Toolpath path = RandomPath(4);
  path.moves.resize(3);
  const auto program = WriteProgram(path, BallTool(), ParamsFor(*shop));
  ASSERT_TRUE(program.ok());
  EXPECT_THAT(*program, HasSubstr(";Patchmill test\r\n"));
  EXPECT_THAT(*program,
              HasSubstr("N10 G17 G21 G90 G94 G40 G49 G80 G54\r\nN20 G53 G0 Z0\r\nN30 T3 M6\r\nN40 M50\r\n"));
  EXPECT_THAT(*program, HasSubstr(" F400.\r\n"));
  const auto motion = ReadProgram(*program, {.dialect = *shop});
  ASSERT_TRUE(motion.ok()) << motion.status();
  EXPECT_EQ(motion->controller_tolerance, 0.0);
}

// N words have at most five digits, and a search for one finds one line: the step is smaller in long
// programs.
TEST(OwnPostFile, LineNumbersHaveFiveDigitsAndDoNotRepeat) {
  std::string text = kShop;
  text.replace(text.find("line_numbers = 10"), 17, "line_numbers = 1000");
  Toolpath path = RandomPath(1);
  while (path.moves.size() < 400)
    path.moves.insert(path.moves.end(), path.moves.begin(), path.moves.begin() + 80);
  const auto program = WriteProgram(path, BallTool(), ParamsFor(*ParseDialect(text)));
  ASSERT_TRUE(program.ok());
  int before = 0;
  std::istringstream lines(*program);
  for (std::string line; std::getline(lines, line);) {
    if (line[0] != 'N') continue;
    const int number = std::stoi(line.substr(1));
    EXPECT_GT(number, before);
    EXPECT_LE(number, 99'999);
    before = number;
  }
  EXPECT_GT(before, 400);
}

// What the user says of a word is an assumption of the verdict; what Patchmill says of it is not.
TEST(OwnPostFile, ItsWordsAreAssumptions) {
  const std::string text = "G21 G90 G17 G94\nM50\nG53 G0 Z0\n";
  const auto motion = ReadProgram(text, {.dialect = *ParseDialect(kShop)});
  ASSERT_TRUE(motion.ok()) << motion.status();
  ASSERT_EQ(motion->assumptions.size(), 1u);
  EXPECT_EQ(motion->assumptions.front().code, "WORD_EXPLAINED");
  EXPECT_THAT(motion->assumptions.front().message, HasSubstr("line 2: "));
  const auto haas = ReadProgram("G21 G90\nG187 E0.01\nG53 G0 Z0\n", {.dialect = *FindDialect("haas")});
  ASSERT_TRUE(haas.ok());
  EXPECT_TRUE(haas->assumptions.empty());
}

// reads_as gives a file of one's own the words of a control. What its [words] says of M words counts first.
TEST(OwnPostFile, ReadsTheWordsOfTheControlThatItNames) {
  const std::string text = "G21 G90 G17 G94\nG69\nM88\nG53 G0 Z0\n";
  EXPECT_FALSE(ReadProgram(text, {.dialect = *ParseDialect(kShop)}).ok());
  std::string shop = kShop;
  shop.replace(shop.find("decimals = 3"), 0, "reads_as = fanuc\n");
  const auto codes = [&](const std::string& post) {
    const auto motion = ReadProgram(text, {.dialect = *ParseDialect(post)});
    EXPECT_TRUE(motion.ok()) << motion.status();
    std::vector<std::string> found;
    for (const Diagnostic& finding : motion->assumptions) found.push_back(finding.code);
    return found;
  };
  EXPECT_THAT(codes(shop), ::testing::ElementsAre("WORD_ASSUMED", "WORDS_WITHOUT_EFFECT"));
  shop.replace(shop.find("M51 = none"), 0, "M88 = none\n");
  EXPECT_THAT(codes(shop), ::testing::ElementsAre("WORD_EXPLAINED", "WORDS_WITHOUT_EFFECT"));
}

// After homing GRBL's axes stand below their switches.
TEST(DialectReader, AboveEverythingBeginsAtTheTopOfTheMachine) {
  EXPECT_TRUE(ReadProgram("G21 G90\nG53 G0 Z-2\n", {.dialect = *FindDialect("grbl")}).ok());
  EXPECT_TRUE(ReadProgram("G20 G90\nG53 G0 Z-0.07\n", {.dialect = *FindDialect("grbl")}).ok());
  EXPECT_FALSE(ReadProgram("G21 G90\nG53 G0 Z-2.1\n", {.dialect = *FindDialect("grbl")}).ok());
  EXPECT_FALSE(ReadProgram("G20 G90\nG53 G0 Z-0.1\n", {.dialect = *FindDialect("grbl")}).ok());
  EXPECT_FALSE(ReadProgram("G21 G90\nG53 G0 Z-2\n").ok());
}

TEST(OwnPostFile, FaultsHaveTheirLine) {
  const auto with = [](const std::string& from, const std::string& to) {
    std::string text = kShop;
    text.replace(text.find(from), from.size(), to);
    return std::string(ParseDialect(text).status().message());
  };
  EXPECT_EQ(with("decimals = 3", "decimals = 9"), "line 4: decimals: = \"9\"; must be a number from 2 to 6");
  EXPECT_EQ(with("decimals = 3", "decimals = 3.5"), "line 4: decimals: = \"3.5\"; must be a whole number");
  EXPECT_THAT(with("decimals = 3", "reads_as = okuma"),
              HasSubstr("line 4: reads_as: = \"okuma\"; must be fanuc, grbl, haas"));
  EXPECT_THAT(with("decimals", "decimal"),
              HasSubstr("line 4: [control] has no key \"decimal\"; it has arc_radius_slack"));
  EXPECT_THAT(with("T{tool}", "T{tol}"),
              HasSubstr("line 21: {tol} is not a placeholder; there are {header}"));
  EXPECT_EQ(with("T{tool}", "T{tool"), "line 21: a brace without its other one");
  EXPECT_EQ(with("{header}", "({header})"), "line 18: {header} must stand alone on its line");
  EXPECT_THAT(with("[end]", "[ende]"), HasSubstr("line 27: \"[ende]\": must be [control]"));
  EXPECT_EQ(with("follows = exactly", "exact = G61"),
            "[begin] nowhere has {path}, which the accuracy rests on");
  EXPECT_EQ(with("name = shop", ""), "[control] name is missing");
  EXPECT_EQ(with("Z{z}", "Z5"), "[begin] nowhere sends the tool to {z}");
  EXPECT_EQ(with("M51 = none", "M50 = none"), "line 16: M50 is given twice");
  EXPECT_EQ(with("M51 = none", "M51 = wait"),
            "line 16: M51 = \"wait\"; must be \"none\" or \"tolerance\" and a letter");
  EXPECT_EQ(with("M51 = none", "G91 = none"),
            "line 16: G91 has a meaning of its own, which cannot be changed");
  EXPECT_EQ(with("M51 = none", "M030 = none"),
            "line 16: M030 has a meaning of its own, which cannot be changed");
  for (const std::string word : {"G52", "G068", "M98", "G92", "G51.1", "G43.4", "G65", "G54.1", "G154",
                                 "G505", "G28.1", "G68.3", "M97.1"}) {
    EXPECT_THAT(with("M51 = none", word + " = none"),
                HasSubstr("line 16: " + word + " moves the tool, calls a program or changes coordinates"));
  }
  EXPECT_THAT(with("flood = M50", "flood = M9"),
              HasSubstr("line 13: flood: = \"M9\"; M9 switches the coolant off"));
  EXPECT_THAT(with("T{tool}", "/T{tool}"), HasSubstr("a line with / may be skipped"));
  EXPECT_EQ(with("[end]", "[begin]"), "line 27: [begin] is given twice");
  EXPECT_THAT(with("name = shop", "name =\tshop"), HasSubstr("byte 0x09: only printable ASCII"));
  EXPECT_EQ(with("[coolant]", "[arcs]\nhelices = yes\n[coolant]"),
            "[arcs] helices = yes, and planes is missing");
  EXPECT_EQ(with("M51 = none", "G1.2.3 = none"), "line 16: \"G1.2.3\" is not a G or M word");
  EXPECT_EQ(with("M51 = none", "M050 = none"), "line 16: M50 is given twice");
  EXPECT_EQ(with("# Our mill.", "our mill"), "line 1: text before the first section, [control]");
  EXPECT_EQ(with("comment = ;", "comment = !"), "line 5: comment: = \"!\"; must be \"( )\" or \";\"");
}

std::string ArcText(const std::string& arcs, const Toolpath& path) {
  std::string text = kShop;
  text.replace(text.find("[coolant]"), 0, arcs);
  const auto shop = ParseDialect(text);
  EXPECT_TRUE(shop.ok()) << shop.status();
  const auto program = WriteProgram(path, BallTool(), ParamsFor(*shop));
  EXPECT_TRUE(program.ok());
  return *program;
}

// A post file without [arcs] gets straight moves, as before there was such a section.
TEST(OwnPostFile, HasTheArcsThatItAsksFor) {
  const Toolpath path = PathWithArcs(3);
  const auto has = [](const std::string& text, const std::string& word) {
    return text.find(word) != std::string::npos;
  };
  const std::string none = ArcText("", path);
  EXPECT_FALSE(has(none, "G2 ") || has(none, "G3 ") || has(none, "G18"));
  const std::string level = ArcText("[arcs]\nplanes = G17\n", path);
  EXPECT_TRUE(has(level, "G2 ") && has(level, "G3 ") && has(level, " I") && has(level, " J"));
  EXPECT_FALSE(has(level, "G18") || has(level, "G19") || has(level, " K"));
  const std::string all = ArcText("[arcs]\nplanes = G17 G18 G19\nhelices = yes\n", path);
  EXPECT_TRUE(has(all, " G18 ") && has(all, " G19 ") && has(all, " K"));
  EXPECT_LT(all.size(), level.size());
  // A full circle in quarters has four times the blocks.
  Toolpath circle;
  circle.ball_radius = kRadius;
  circle.moves = {{.kind = MoveKind::kRapid, .to = Vec3(5, 0, 3)},
                  {.kind = MoveKind::kCut, .to = Vec3(5, 0, 3), .feed = 100.0}};
  circle.moves[1].arc = Arc{ArcPlane::kXy, Vec2::Zero(), false};
  const auto count = [&](const char* sweep) {
    const std::string text =
        ArcText(std::string("[arcs]\nplanes = G17\nlargest_sweep = ") + sweep + "\n", circle);
    int blocks = 0;
    for (std::size_t at = text.find(" I"); at != std::string::npos; at = text.find(" I", at + 1)) ++blocks;
    return blocks;
  };
  EXPECT_EQ(count("360"), 1);
  EXPECT_EQ(count("180"), 2);
  EXPECT_EQ(count("90"), 4);
  EXPECT_EQ(ArcText("[arcs]\nplanes = G17\nlargest_radius = 4\n", circle).find(" I"), std::string::npos);
}

TEST(OwnPostFile, FaultsOfArcsHaveTheirLine) {
  const auto with = [](const std::string& arcs) {
    std::string text = kShop;
    text.replace(text.find("[coolant]"), 0, arcs);
    return std::string(ParseDialect(text).status().message());
  };
  EXPECT_EQ(with("[arcs]\nplanes = G17 G16\n"),
            "line 13: planes: = \"G17 G16\"; must be one or more of G17, G18 and G19");
  EXPECT_EQ(with("[arcs]\nplanes = G17 G17\n"), "line 13: planes: G17 is given twice");
  EXPECT_EQ(with("[arcs]\nlargest_sweep = 45\n"),
            "line 13: largest_sweep: = \"45\"; must be a number from 90 to 360");
  EXPECT_EQ(with("[arcs]\ncentre = end\n"), "line 13: centre: = \"end\"; must be modal or start");
}

// A control whose I, J and K always count from the start has no word for it; the others must say so.
TEST(DialectReader, CentresCountFromTheStartWhereTheControlSaysSo) {
  const std::string text = "G17 G21 G90 G94 G61 G43 H1\nG0 X0 Y0 Z5\nG2 X2 Y0 I1 J0 F100\n";
  const std::string siemens = "G17 G710 G90 G94 G60 D1\nG0 X0 Y0 Z5\nG2 X2 Y0 I1 J0 F100\n";
  const auto assumed = [&](const std::string& name) {
    const auto motion = ReadProgram(name == "siemens" ? siemens : text, {.dialect = *FindDialect(name)});
    EXPECT_TRUE(motion.ok()) << motion.status();
    return std::any_of(motion->assumptions.begin(), motion->assumptions.end(),
                       [](const Diagnostic& d) { return d.code == "ARC_MODE_ASSUMED"; });
  };
  EXPECT_FALSE(assumed("haas") || assumed("fanuc") || assumed("siemens"));
  EXPECT_TRUE(assumed("linuxcnc") && assumed("mach3"));
}

TEST(Dialects, OfLinuxCncHasItsPlanner) {
  for (const Dialect& dialect : Dialects())
    EXPECT_EQ(dialect.linuxcnc_planner, dialect.name == "linuxcnc") << dialect.name;
}

TEST(ControlDeviation, IsTheUsersStatement) {
  for (const char* name : {"fanuc", "mach3"}) {
    PostParams params = ParamsFor(*FindDialect(name));
    params.controller_tolerance = 0.002;
    const auto program = WriteProgram(RandomPath(6), BallTool(), params);
    ASSERT_TRUE(program.ok());
    EXPECT_THAT(*program, HasSubstr("\nG64\n"));
    const auto stated = ReadProgram(*program, {.dialect = params.dialect, .control_deviation = 0.002});
    ASSERT_TRUE(stated.ok()) << stated.status();
    EXPECT_EQ(stated->controller_tolerance, 0.002);
    ASSERT_EQ(stated->assumptions.size(), 1u);
    EXPECT_EQ(stated->assumptions.front().code, "CONTROL_DEVIATION_ASSUMED");
    const auto open = ReadProgram(*program, {.dialect = params.dialect});
    ASSERT_TRUE(open.ok());
    EXPECT_EQ(open->controller_tolerance, kInfinity);
  }
}

// What each dialect's words mean to the reader.
TEST(DialectReader, FeedsAndTolerancesFollowTheControl) {
  const std::string start = "G90 G94 G17 G40 G49 G80 G21\nG53 G0 Z0\nG61\nS100 M3\nG43 H1\nG0 X0 Y0\nZ5\n";
  const std::string feed = start + "G20 G1 X1 F2\n";
  const auto feed_in = [&](const char* name) {
    return ReadProgram(feed, {.dialect = *FindDialect(name)})->moves.back().feed;
  };
  EXPECT_DOUBLE_EQ(feed_in("linuxcnc"), 2.0);  // mm: the unit before the line
  EXPECT_DOUBLE_EQ(feed_in("grbl"), 50.8);     // inches: the unit of the line
  const auto tolerance = [&](const char* name, const std::string& words) {
    const auto motion = ReadProgram(start + words + "\nG1 X5 F100\n", {.dialect = *FindDialect(name)});
    EXPECT_TRUE(motion.ok()) << motion.status();
    return motion.ok() ? motion->controller_tolerance : -1.0;
  };
  EXPECT_EQ(tolerance("grbl", "G64"), 0.0);
  EXPECT_EQ(tolerance("haas", "G64\nG187 P2 E0.02"), 0.02);
  EXPECT_EQ(tolerance("haas", "G64\nG187"), kInfinity);
  EXPECT_EQ(tolerance("haas", "G187 E0.02"), 0.0);  // exact stop holds on
  EXPECT_EQ(tolerance("fanuc", "G5.1 Q1"), 0.0);
  EXPECT_EQ(tolerance("fanuc", "G64"), kInfinity);
  EXPECT_FALSE(ReadProgram("G187 E0.1\n").ok());
  EXPECT_FALSE(ReadProgram("G5.1 Q1 X3\n", {.dialect = *FindDialect("fanuc")}).ok());
}

TEST(DialectReader, ReferenceReturnsGoThroughTheirPlaceFirst) {
  const std::string start = "G21 G90 G94 G17 G61\nG0 X0 Y0 Z5\n";
  const auto up = ReadProgram(start + "G91 G28 Z0\nG90\n");
  ASSERT_TRUE(up.ok()) << up.status();
  EXPECT_EQ(up->moves.size(), 2u);
  EXPECT_TRUE(up->moves.back().to_above);
  EXPECT_EQ(up->moves.back().from.z(), 5.0);
  const auto down = ReadProgram(start + "G28 Z0\n");
  ASSERT_TRUE(down.ok()) << down.status();
  ASSERT_EQ(down->moves.size(), 3u);
  EXPECT_EQ(down->moves[1].kind, ProgramMove::Kind::kRapid);
  EXPECT_EQ(down->moves[1].to, Vec3(0, 0, 0));  // through the part, if it is there
  EXPECT_TRUE(down->moves[2].to_above);
  EXPECT_TRUE(ReadProgram("G91 G28 Z0\nG90\n").ok());
  EXPECT_TRUE(ReadProgram("G91 G28 Z0\nG28 X0 Y0\nG90\n").ok());
}

TEST(DialectReader, ProgramNumbersStandAtTheStart) {
  EXPECT_TRUE(ReadProgram("%\nO0042\nG21 G90\n%\n").ok());
  EXPECT_TRUE(ReadProgram("O42 (bracket)\nG21 G90\n").ok());
  EXPECT_FALSE(ReadProgram("G21 G90\nO0042\n").ok());
  EXPECT_FALSE(ReadProgram("%\nO1\nO2\n%\n").ok());
  EXPECT_FALSE(ReadProgram("O1 G21\n").ok());
}

}  // namespace
}  // namespace patchmill
