// The table foreign_lines.txt: lines as posts of other systems write them, and what they must do.
#include <algorithm>
#include <fstream>
#include <random>
#include <set>
#include <sstream>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "cam/post/program_assumptions.h"
#include "cam/post/program_reader.h"

namespace patchmill {
namespace {

using ::testing::HasSubstr;

struct Row {
  int line = 0;  // of the table
  std::vector<std::string> dialects;
  bool at_start = false;  // its lines come before all others
  std::vector<std::string> lines;
  // What must happen, beside what happens without the row.
  std::string refused, refused_next;  // the message, at the last line of the row or at the move after it
  std::string moves;                  // "r3,4,5 f3,4,1"
  std::string then = "9,9,9";         // where the move after the row ends
  std::string tolerance;
  std::vector<std::string> ignored;
  std::string spindle = "on";  // at the move after the row
  std::set<std::string> assumes;
};

std::string Trimmed(const std::string& text) {
  const std::size_t begin = text.find_first_not_of(' '), end = text.find_last_not_of(' ');
  return begin == std::string::npos ? "" : text.substr(begin, end - begin + 1);
}

std::vector<std::string> Split(const std::string& text, const std::string& mark) {
  std::vector<std::string> parts;
  std::size_t begin = 0;
  for (std::size_t at = text.find(mark); at != std::string::npos; at = text.find(mark, begin)) {
    parts.push_back(Trimmed(text.substr(begin, at - begin)));
    begin = at + mark.size();
  }
  parts.push_back(Trimmed(text.substr(begin)));
  return parts;
}

void ReadExpectation(const std::string& text, Row& row) {
  for (const std::string& item : Split(text, ";")) {
    const std::string verb = item.substr(0, item.find(' '));
    const std::string rest = Trimmed(item.substr(verb.size()));
    if (verb == "refused")
      row.refused = rest;
    else if (verb == "next-refused")
      row.refused_next = rest;
    else if (verb == "moves")
      row.moves = rest;
    else if (verb == "then")
      row.then = rest;
    else if (verb == "tolerance")
      row.tolerance = rest;
    else if (verb == "ignored")
      row.ignored.push_back(rest);
    else if (verb == "spindle")
      row.spindle = rest;
    else if (verb == "assumes")
      row.assumes.insert(rest);
    else
      EXPECT_EQ(verb, "nothing") << "line " << row.line << " of the table";
  }
}

std::vector<Row> Table() {
  std::vector<Row> rows;
  std::ifstream in(std::string(PATCHMILL_SOURCE_DIR) + "/tests/cam/post/foreign_lines.txt");
  int number = 0;
  for (std::string text; std::getline(in, text);) {
    ++number;
    if (text.empty() || text[0] == '#') continue;
    const std::vector<std::string> fields = Split(text, " | ");
    EXPECT_EQ(fields.size(), 3u) << "line " << number << " of the table";
    if (fields.size() != 3) continue;
    Row row;
    row.line = number;
    row.dialects = Split(fields[0], " ");
    row.at_start = fields[1][0] == '^';
    row.lines = Split(fields[1].substr(row.at_start ? 1 : 0), " // ");
    ReadExpectation(fields[2], row);
    rows.push_back(std::move(row));
  }
  return rows;
}

// A start that states everything and leaves the tool at X1 Y2 Z5; and a feed to X9 Y9 Z9.
struct Frame {
  std::vector<std::string> start;
  std::string next;
};

Frame FrameOf(const std::string& dialect) {
  if (dialect == "heidenhain") {
    return {{"0 BEGIN PGM A MM", "1 TOOL CALL 1 Z S1000 F100", "2 CYCL DEF 32.0 TOLERANCE",
             "3 CYCL DEF 32.1 T0.01", "4 L X+1 Y+2 R0 FMAX M3", "5 L Z+5 FMAX"},
            "9 L X+9 Y+9 Z+9 R0 F100"};
  }
  if (dialect == "siemens") {
    return {{"G17 G710 G90 G94 G40 G54 G60 G601", "T1 M6", "D1", "S1000 M3", "G0 X1 Y2 Z5 F100"},
            "G1 X9 Y9 Z9"};
  }
  const bool centers = dialect == "fanuc" || dialect == "haas";
  const std::string modes = std::string("G21 G17 G90 G94 G40 G80 G98 G54 G61") + (centers ? "" : " G91.1");
  if (dialect == "grbl") return {{modes, "S1000 M3", "G0 X1 Y2 Z5 F100"}, "G1 X9 Y9 Z9"};
  return {{modes, "T1 M6", "G43 H1", "S1000 M3", "G0 X1. Y2. Z5. F100."}, "G1 X9. Y9. Z9."};
}

std::string Text(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += line + "\n";
  return text;
}

std::string Place(const ProgramMove& move) {
  return fmt::format("{:g},{:g},{}", move.to.x(), move.to.y(),
                     move.to_above ? "up" : fmt::format("{:g}", move.to.z()));
}

std::string Places(const ProgramMotion& motion, int first_line, int last_line) {
  std::string text;
  for (const ProgramMove& move : motion.moves) {
    if (move.line < first_line || move.line > last_line) continue;
    // Of an arc the end counts.
    if (move.chord_error > 0.0 && &move != &motion.moves.back() && (&move + 1)->line == move.line) continue;
    text += (text.empty() ? "" : " ") + std::string(move.kind == ProgramMove::Kind::kFeed ? "f" : "r") +
            Place(move);
  }
  return text;
}

std::string IgnoredWords(const ProgramMotion& motion) {
  for (const Diagnostic& finding : motion.assumptions) {
    if (finding.code == "WORDS_WITHOUT_EFFECT") return finding.message;
  }
  return "";
}

std::set<std::string> Codes(const ProgramMotion& motion) {
  const std::vector<std::string> codes = AssumptionCodes(motion.assumptions);
  return {codes.begin(), codes.end()};
}

std::string Tolerance(const ProgramMotion& motion) {
  const double value = motion.controller_tolerance;
  return value == kInfinity ? "unknown" : value == 0.0 ? "exact" : fmt::format("{:g}", value);
}

void CheckRefused(const Row& row, const std::string& dialect, const std::string& text, int line) {
  const auto motion = ReadProgram(text, {.dialect = *FindDialect(dialect)});
  ASSERT_FALSE(motion.ok()) << text;
  EXPECT_EQ(motion.status().code(), absl::StatusCode::kInvalidArgument);
  const std::string message(motion.status().message());
  EXPECT_THAT(message, ::testing::StartsWith(fmt::format("line {}: ", line))) << text;
  EXPECT_THAT(message, HasSubstr(row.refused.empty() ? row.refused_next : row.refused)) << text;
}

void CheckAccepted(const Row& row, const std::string& dialect, const std::string& text, int first) {
  const Frame frame = FrameOf(dialect);
  const auto motion = ReadProgram(text, {.dialect = *FindDialect(dialect)});
  ASSERT_TRUE(motion.ok()) << motion.status() << "\n" << text;
  std::vector<std::string> bare_lines = frame.start;
  bare_lines.push_back(frame.next);
  const auto bare = ReadProgram(Text(bare_lines), {.dialect = *FindDialect(dialect)});
  ASSERT_TRUE(bare.ok()) << bare.status();
  const int last = first + static_cast<int>(row.lines.size()) - 1;
  EXPECT_EQ(Places(*motion, first, last), row.moves) << text;
  const bool goes_on = row.then != "end";  // the row does not end the program
  if (goes_on) {
    EXPECT_EQ(Place(motion->moves.back()), row.then) << text;
    const std::string tolerance = row.tolerance.empty() ? Tolerance(*bare) : row.tolerance;
    EXPECT_EQ(Tolerance(*motion), tolerance) << text;
    EXPECT_EQ(motion->moves.back().spindle_speed > 0.0F ? "on" : "off", row.spindle) << text;
  }
  std::set<std::string> codes = Codes(*bare);
  codes.insert(row.assumes.begin(), row.assumes.end());
  EXPECT_EQ(Codes(*motion), codes) << text;
  if (row.ignored.empty()) {
    EXPECT_EQ(IgnoredWords(*motion), "") << text;
  }
  for (const std::string& word : row.ignored)
    EXPECT_THAT(IgnoredWords(*motion), HasSubstr(" " + word + " (line")) << text;
}

TEST(ForeignTable, EveryLineDoesWhatItsRowSays) {
  std::map<std::string, int> rows_of;
  for (const Row& row : Table()) {
    for (const std::string& dialect : row.dialects) {
      SCOPED_TRACE(fmt::format("line {} of foreign_lines.txt, {}", row.line, dialect));
      ASSERT_NE(FindDialect(dialect), nullptr);
      ++rows_of[dialect];
      const Frame frame = FrameOf(dialect);
      std::vector<std::string> lines = frame.start;
      const std::size_t at = row.at_start ? 0 : lines.size();
      lines.insert(lines.begin() + static_cast<std::ptrdiff_t>(at), row.lines.begin(), row.lines.end());
      lines.push_back(frame.next);
      const int first = static_cast<int>(at) + 1, last = first + static_cast<int>(row.lines.size()) - 1;
      if (!row.refused.empty()) {
        CheckRefused(row, dialect, Text(lines), last);
      } else if (!row.refused_next.empty()) {
        CheckRefused(row, dialect, Text(lines), last + 1);
      } else {
        CheckAccepted(row, dialect, Text(lines), first);
      }
    }
  }
  EXPECT_EQ(rows_of.size(), Dialects().size());
  for (const auto& [dialect, rows] : rows_of) EXPECT_GE(rows, 25) << dialect;
}

// Each line with one byte changed, taken out or put in: an error or a motion, in a moment.
TEST(ForeignTable, DamagedLinesAreReadOrRefused) {
  std::mt19937 random(20261130);
  constexpr std::string_view kBytes = "GXYZMNR0159.-+=()[]\";:~/%#$ \t\x01\xff";
  int read = 0, refused = 0;
  for (const Row& row : Table()) {
    for (const std::string& dialect : row.dialects) {
      std::vector<std::string> lines = FrameOf(dialect).start;
      lines.insert(lines.end(), row.lines.begin(), row.lines.end());
      std::string& damaged = lines.back();
      const std::size_t at = random() % (damaged.size() + 1);
      const char byte = kBytes[random() % kBytes.size()];
      const unsigned kind = random() % 3;
      if (kind == 0 || at == damaged.size()) {
        damaged.insert(at, 1, byte);
      } else if (kind == 1) {
        damaged[at] = byte;
      } else {
        damaged.erase(at, 1);
      }
      const auto motion = ReadProgram(Text(lines), {.max_moves = 100'000, .dialect = *FindDialect(dialect)});
      ++(motion.ok() ? read : refused);
      if (motion.ok()) continue;
      EXPECT_THAT(std::string(motion.status().message()),
                  ::testing::ContainsRegex("line [0-9]+: |^more than"))
          << Text(lines);
    }
  }
  EXPECT_GT(read, 100);
  EXPECT_GT(refused, 100);
}

// The table's own words would accept a reader that ignores everything; this one bites.
TEST(ForeignTable, StartsAreComplete) {
  for (const Dialect& dialect : Dialects()) {
    Frame frame = FrameOf(dialect.name);
    frame.start.push_back(frame.next);
    const auto motion = ReadProgram(Text(frame.start), {.dialect = dialect});
    ASSERT_TRUE(motion.ok()) << dialect.name << motion.status();
    EXPECT_EQ(Place(motion->moves.back()), "9,9,9") << dialect.name;
    const std::set<std::string> left =
        dialect.length_offset ? std::set<std::string>{} : std::set<std::string>{"LENGTH_OFFSET_ASSUMED"};
    EXPECT_EQ(Codes(*motion), left) << dialect.name;
    EXPECT_NE(Tolerance(*motion), "unknown") << dialect.name;
  }
}

}  // namespace
}  // namespace patchmill
