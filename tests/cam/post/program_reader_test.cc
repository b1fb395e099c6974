#include "cam/post/program_reader.h"

#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace patchmill {
namespace {

using ::testing::HasSubstr;
namespace fs = std::filesystem;

ProgramMotion Read(const std::string& text, double chord_error = 1e-4) {
  ReaderParams params;
  params.arc_chord_error = chord_error;
  auto motion = ReadProgram(text, params);
  EXPECT_TRUE(motion.ok()) << text << "\n" << motion.status();
  return motion.ok() ? *motion : ProgramMotion{};
}

std::string Refusal(const std::string& text) {
  const auto motion = ReadProgram(text);
  EXPECT_FALSE(motion.ok()) << text;
  EXPECT_EQ(motion.status().code(), absl::StatusCode::kInvalidArgument);
  return std::string(motion.status().message());
}

TEST(ProgramReader, StraightMovesAndModes) {
  const ProgramMotion m = Read(
      "%\n(header) ; more\nN10 g21 g90 T2 M6\nG53 G0 Z0\ns1000m3\ng0 x 1 0 y-2.5\nZ5.\nG1 Z-1 F100\nX20\n"
      "G91 X1 Y1\nG90 G0 Z50\nM5 M9\nG53 G0 Z0\nM30\nthis is not read\n%\n");
  ASSERT_EQ(m.moves.size(), 8u);
  EXPECT_TRUE(m.first_motion_is_up && m.last_motion_is_up);
  EXPECT_TRUE(m.ends_with_spindle_off && m.ends_with_coolant_off);
  EXPECT_EQ(m.tool_number, 2);
  EXPECT_EQ(m.moves[1].to.x(), 10.0);
  EXPECT_TRUE(m.moves[1].from_above && m.moves[1].to_above);
  EXPECT_EQ(m.moves[1].from.head<2>(), m.moves[1].to.head<2>()) << "its start is not known";
  EXPECT_TRUE(m.moves[2].from_above && !m.moves[2].to_above);
  EXPECT_EQ(m.moves[3].kind, ProgramMove::Kind::kFeed);
  EXPECT_EQ(m.moves[3].feed, 100.0);
  EXPECT_EQ(m.moves[4].line, 9);
  EXPECT_EQ(m.moves[5].to, Vec3(21, -1.5, -1));
  EXPECT_TRUE(m.moves[7].to_above);
}

TEST(ProgramReader, InchesAreConverted) {
  const ProgramMotion m = Read("G20 G61\nG0 Z1\nG0 X1 Y2\nG1 Z-.5 F10\nG64 P0.001 Q0\nX2\n");
  EXPECT_EQ(m.moves.back().to, Vec3(50.8, 50.8, -12.7));
  EXPECT_EQ(m.moves.back().feed, 254.0);
  EXPECT_DOUBLE_EQ(m.controller_tolerance, 0.0254);
}

// What is left to the state of the control is said, once, where it first counts.
TEST(ProgramReader, AssumptionsAreSaid) {
  const auto said = [](const std::string& text) {
    std::string codes;
    for (const Diagnostic& d : Read(text).assumptions) {
      EXPECT_EQ(d.severity, Severity::kWarning);
      codes += d.code + " " + std::to_string(d.where.line.value_or(0)) + " ";
    }
    return codes;
  };
  EXPECT_EQ(
      said("G21 G54 G90\nT3 M6\nG53 G0 Z0\nG43 H3\nG64 P0.01\nG0 X1 Y1\nZ5\nG1 Z0 F100\nX9\nG53 G0 Z0\n"),
      "");
  EXPECT_EQ(said("G53 G0 Z0\nM5\n"), "");  // nothing of it counts
  EXPECT_EQ(said("G53 G0 Z0\nG0 X1 Y1\nX2\nZ5\nG1 Z0 F100\n"),
            "UNITS_ASSUMED 2 DISTANCE_MODE_ASSUMED 2 WORK_OFFSET_ASSUMED 2 LENGTH_OFFSET_ASSUMED 4 "
            "PATH_MODE_ASSUMED 5 ");
  // An F without a unit counts where something is fed at it; its own line is named.
  const std::string head = "F300 G21 G54 G90 G61\nT3 M6\nG53 G0 Z0\nG43\nG0 X1 Y1\nZ5\n";
  EXPECT_EQ(said(head), "");
  EXPECT_EQ(said(head + "G1 Z0\n"), "UNITS_ASSUMED 1 ");
  EXPECT_EQ(said(head + "F200\nG1 Z0\n"), "");
  const std::string modes = "G21 G55 G90 G61\nT3 M6\nG53 G0 Z0\n";
  EXPECT_EQ(said(modes + "G43 H4\nG0 X1 Y1\nZ5\n"), "LENGTH_OFFSET_OF_OTHER_TOOL 6 ");
  EXPECT_EQ(said(modes + "G43\nG0 X1 Y1\nZ5\n"), "");  // the loaded tool's own
  EXPECT_EQ(said(modes + "G43 H3\nG49\nG0 X1 Y1\nZ5\n"), "LENGTH_OFFSET_ASSUMED 7 ");
  const std::string arc = "G90 G0 X0 Y0\nZ1\nG2 ";
  const std::string offset = "G54 G20 G43 ";
  EXPECT_EQ(said(offset + "G91\n" + arc + "I1 F9\n"),
            "PLANE_ASSUMED 4 ARC_MODE_ASSUMED 4 PATH_MODE_ASSUMED 4 ");
  EXPECT_EQ(said(offset + "G17 G61 G91.1\n" + arc + "I1 F9\n"), "");
  EXPECT_EQ(said(offset + "G17 G61 G90.1\n" + arc + "I1 J0 F9\n"), "");
  EXPECT_EQ(said(offset + "G17 G61\n" + arc + "X1 R1 F9\n"), "");  // no centre is given
}

// So does a control: F first, then G20 and G21, then coordinates.
TEST(ProgramReader, AFeedBesideAChangeOfUnitIsInTheUnitBefore) {
  const auto last = [](const std::string& text) { return Read("G20 G61 G91.1\nG0 X0 Y0\nZ1\n" + text); };
  for (const char* line : {"G21 G1 Z0 F300\n", "F300 Z0 G1 G21\n"}) {
    const ProgramMotion m = last(line);
    EXPECT_DOUBLE_EQ(m.moves.back().feed, 7620.0) << line;
    EXPECT_EQ(m.moves.back().to.z(), 0.0);
    ASSERT_FALSE(m.assumptions.empty());
    const bool said = std::any_of(m.assumptions.begin(), m.assumptions.end(), [](const Diagnostic& d) {
      return d.code == "FEED_IN_UNIT_BEFORE" && d.where.line == 4 &&
             d.message.find("7620 mm/min") != std::string::npos;
    });
    EXPECT_TRUE(said) << line;
  }
  EXPECT_DOUBLE_EQ(last("G21\nG1 Z5 F300\n").moves.back().feed, 300.0);
  EXPECT_EQ(last("G21 G1 X30 F10\n").moves.back().to.x(), 30.0) << "coordinates are in the new unit";
  EXPECT_DOUBLE_EQ(last("G20 G1 Z0 F30\n").moves.back().feed, 762.0) << "the unit in force is stated again";
  // Nothing is in force before the first line: taken as mm/min, as LinuxCNC starts.
  EXPECT_DOUBLE_EQ(Read("G21 F300\nG1 X1\n").moves.back().feed, 300.0);
  EXPECT_DOUBLE_EQ(Read("G20 F300\nG1 X1\n").moves.back().feed, 300.0);
}

TEST(ProgramReader, PathModes) {
  const std::string start = "G0 Z1\nG1 X0 Y0 F10\n";
  EXPECT_EQ(Read(start).controller_tolerance, kInfinity);  // no better than a G64 without P
  EXPECT_EQ(Read(start).rapid_tolerance, kInfinity);
  ReaderParams exact;
  exact.assume_exact_path = true;
  EXPECT_EQ(ReadProgram(start, exact)->controller_tolerance, 0.0);
  EXPECT_EQ(ReadProgram(start + "G64\nX1\n", exact)->controller_tolerance, kInfinity);  // stated
  EXPECT_EQ(Read("G61\n" + start + "X1\n").controller_tolerance, 0.0);
  EXPECT_EQ(Read(start + "G64\nX1\n").controller_tolerance, kInfinity);
  EXPECT_EQ(Read(start + "G64 P0\nX1\n").controller_tolerance, kInfinity);  // no tolerance, not none at all
  EXPECT_EQ(Read(start + "G64 P0 Q0\nX1\n").controller_tolerance, kInfinity);
  EXPECT_DOUBLE_EQ(Read("G61\n" + start + "G64 P.003 Q.001\nX1\nG61\nX2\n").controller_tolerance, 0.004);
  EXPECT_DOUBLE_EQ(Read("G61\n" + start + "G64 P.003\nX1\n").controller_tolerance, 0.006);  // Q = P
  EXPECT_EQ(Read("G61\n" + start + "X1\nG64 P.003\n").controller_tolerance, 0.0) << "nothing is fed under it";
}

// Every vertex lies on the circle, the chords are as close as asked, the way round is right.
void ExpectArc(const ProgramMotion& m, const Vec3& center, double radius, int u, int v, double sweep,
               double chord_error) {
  double total = 0.0;
  for (const ProgramMove& move : m.moves) {
    if (move.chord_error == 0.0) continue;
    const Vec3 a = move.from - center, b = move.to - center;
    EXPECT_NEAR(std::hypot(a[u], a[v]), radius, 1e-9);
    EXPECT_NEAR(std::hypot(b[u], b[v]), radius, 1e-9);
    const Vec3 middle = 0.5 * (a + b);
    EXPECT_LE(radius - std::hypot(middle[u], middle[v]), move.chord_error + 1e-12);
    EXPECT_LE(move.chord_error, chord_error * (1 + 1e-9));
    total += std::atan2(a[u] * b[v] - a[v] * b[u], a[u] * b[u] + a[v] * b[v]);
  }
  EXPECT_NEAR(total, sweep, 1e-9);
}

TEST(ProgramReader, ArcsInThreePlanes) {
  ExpectArc(Read("G17 G1 X0 Y20 F200\nG2 X20 Y0 I0 J-20\n"), Vec3::Zero(), 20, 0, 1, -kPi / 2, 1e-4);
  ExpectArc(Read("G17 G1 X20 Y0 F200\nG3 X0 Y20 I-20 J0\n"), Vec3::Zero(), 20, 0, 1, kPi / 2, 1e-4);
  ExpectArc(Read("G17 G1 X20 Y0 F200\nG3 X0 Y-20 R-20\n", 1e-3), Vec3::Zero(), 20, 0, 1, 1.5 * kPi, 1e-3);
  ExpectArc(Read("G17 G1 X20 Y0 F200\nG2 X0 Y-20 R20\n"), Vec3::Zero(), 20, 0, 1, -kPi / 2, 1e-4);
  // G18: the first axis is Z, the second X; G2 turns from X to Z.
  ExpectArc(Read("G18 G1 X0 Z20 F200\nG2 X20 Z0 I0 K-20\n"), Vec3::Zero(), 20, 2, 0, -1.5 * kPi, 1e-4);
  ExpectArc(Read("G18 G1 X0 Z20 F200\nG3 X20 Z0 I0 K-20\n"), Vec3::Zero(), 20, 2, 0, kPi / 2, 1e-4);
  ExpectArc(Read("G19 G1 Y0 Z20 F200\nG2 Y20 Z0 J0 K-20\n"), Vec3::Zero(), 20, 1, 2, -kPi / 2, 1e-4);
  ExpectArc(Read("G17 G90.1 G1 X30 Y5 Z0 F200\nG3 X10 Y25 I10 J5\n"), Vec3(10, 5, 0), 20, 0, 1, kPi / 2,
            1e-4);
  ExpectArc(Read("G17 G1 X5 Y0 Z0 F200\nG2 I-5\n"), Vec3::Zero(), 5, 0, 1, -2 * kPi, 1e-4);
}

TEST(ProgramReader, HelixRisesEvenly) {
  const ProgramMotion m = Read("G17 G1 X5 Y0 Z0 F200\nG3 X5 Y0 Z2 I-5 J0\n");
  for (const ProgramMove& move : m.moves) {
    if (move.chord_error == 0.0) continue;
    double angle = std::atan2(move.to.y(), move.to.x());
    if (angle <= 1e-9) angle += 2 * kPi;
    EXPECT_NEAR(move.to.z(), 2.0 * angle / (2 * kPi), 1e-9);
  }
  EXPECT_EQ(m.moves.back().to, Vec3(5, 0, 2));
}

TEST(ProgramReader, RefusesWithTheLine) {
  const std::string start = "G21 G90\nG0 X0 Y0 Z5\nG1 Z0 F100\n";
  for (const auto& [code, word] : std::vector<std::pair<std::string, std::string>>{
           {"X#1", "parameters"},
           {"#1=5", "parameters"},
           {"o100 sub", "O-words"},
           {"G41 D1", "G41"},
           {"G42.1 D2", "G42.1"},
           {"G92 X0", "G92"},
           {"G10 L2 P1 X0", "G10"},
           {"G5 X1 Y1", "G5"},
           {"G38.2 Z-5", "G38.2"},
           {"G33 Z-1 K1", "G33"},
           {"G2 X1 Y1", "centre"},
           {"G2 X9 Y9 I1 J0", "radii"},
           {"G2 X9 R1", "radius"},
           {"G3 R5", "equal"},
           {"G2 X1 K3", "plane"},
           {"A90", "A90"},
           {"U1", "U1"},
           {"B1", "B1"},
           {"E5", "E5"},
           {"L3", "L without"},
           {"M98 P1", "M98"},
           {"M21", "M21"},
           {"G53 G0 Z-10", "G53"},
           {"X1 X2", "twice"},
           {"G0 G1 X1", "modal group"},
           {"G17 G18", "modal group"},
           {"M3 M5", "modal group"},
           {"X", "without a number"},
           {"X--1", "without a number"},
           {"X1..2", "unexpected"},
           {"X1e3", "E3"},
           {"(open", "unclosed"},
           {"(a (b) c)", "comment"},
           {"X1 N5", "N within"},
           {"%", "%"},
           {"I5", "without G2"},
           {"P5", "without G4"},
           {"D1", "without G41"},
           {"X5 /", "/ within"},
           {"G55 X1", "work offset"},
           {"X2000000", "beyond"},
           {"H3", "without G43"},
           {"\x80", "0x80"},
           {"G43 H1\nX1", "tool length"},
           {"F-1", "negative"},
           {"G0.5", "G0.5"},
           {"G1.05", "G1.05"},
           {"G80\nX1", "no motion"},
           {"G61 P1", "without G4"},
           {"G4 X1", "G4"},
           {"T2 M6\nT3 M6", "tool 3"},
       }) {
    const std::string message = Refusal(start + code + "\n");
    EXPECT_THAT(message, HasSubstr(word)) << code;
    const int line = code.find('\n') == std::string::npos ? 4 : 5;
    EXPECT_THAT(message, HasSubstr("line " + std::to_string(line) + ": ")) << code;
  }
  // Another entry of the tool table shifts every Z that follows; the same one does not.
  const std::string offset = "G21 G90\nT1 M6\nG53 G0 Z0\nG43 H1\nG0 X0 Y0 Z5\n";
  EXPECT_THAT(Refusal(offset + "G43 H7\nX1\n"), HasSubstr("line 7: motion after a change"));
  EXPECT_EQ(Read(offset + "G43 H1\nX1\n").moves.back().to, Vec3(1, 0, 5));
  EXPECT_EQ(Read(offset + "G43\nX1\n").moves.back().to, Vec3(1, 0, 5));  // the loaded tool's: 1
  EXPECT_THAT(Refusal("G1 X1 Z1\n"), HasSubstr("line 1: feed move without a feed rate"));
  EXPECT_THAT(Refusal("G91\nG0 X1\n"), HasSubstr("line 2: X is incremental from an unknown place"));
  EXPECT_THAT(Refusal("X1\n"), HasSubstr("line 1: coordinates while no motion"));
  EXPECT_THAT(Refusal("G53 G0 Z0\nG18 G2 X1 Z1 I1 F10"), HasSubstr("line 2: arc"));
  EXPECT_THAT(Refusal(std::string(2000, 'G')), HasSubstr("line 1: longer"));
}

TEST(ProgramReader, AcceptsWhatMovesNothing) {
  Read("G43 H1\nG0 Z5\nG4 P1\nM0\nM7\nM4 S100\nG94 G40\nG61.1\n");
  Read("");
  Read("\n\n%\n%\n");
  Read("G43 H1 Z5 G0\n");
  EXPECT_TRUE(Read("M3 S5\nM8\n").moves.empty());
  EXPECT_FALSE(Read("M3 S5\nM8\n").ends_with_spindle_off);
  EXPECT_FALSE(Read("M3 S5\nM8\n").ends_with_coolant_off);
}

TEST(ProgramReader, UpAtBothEnds) {
  EXPECT_FALSE(Read("G0 Z5\nG53 G0 Z0\n").first_motion_is_up);
  EXPECT_TRUE(Read("G53 G0 Z0\nG0 X1\n").first_motion_is_up);
  EXPECT_FALSE(Read("G53 G0 Z0\nG0 X1\nZ5\n").last_motion_is_up);
  EXPECT_TRUE(Read("G53 G0 Z0\nG0 X1\nZ5\nZ9\n").last_motion_is_up);
  EXPECT_TRUE(Read("G53 G0 Z0\nG0 X1\nZ5\nG53 Z0\nX0 Y0\n").last_motion_is_up) << "parking at machine zero";
  EXPECT_FALSE(Read("G53 G0 Z0\nG0 X1\nZ5\nX5 Z9\n").last_motion_is_up);
}

TEST(ProgramReader, LimitsHold) {
  ReaderParams params;
  params.max_moves = 100;
  const auto many = ReadProgram("G0 Z5\nG1 X1 Y0 F5\nG2 I-1\nG2 I-1\n", params);
  EXPECT_EQ(many.status().code(), absl::StatusCode::kResourceExhausted);
  EXPECT_THAT(std::string(many.status().message()), HasSubstr("line 3"));
  params.max_moves = 2;
  EXPECT_EQ(ReadProgram("G0 Z5\nX1\nX2\n", params).status().code(), absl::StatusCode::kResourceExhausted);
}

// Any bytes: an answer, quickly.
TEST(ProgramReader, RandomBytesAndMutations) {
  const std::string seed =
      "%\nG21 G90 G17\nG53 G0 Z0\nT1 M6\nG43 H1\nG0 X1.5 Y-2\nZ5\nG1 Z-1 F100\nG2 X3.5 Y2 I1 J2\nG3 X1 "
      "R5\n(c)\n/G99 G83 X4 Y1 R2 Z-1 Q1\nX5\nG80\nG2 I2 P3\nG1 X[1+2*SQRT[4]]\nG91 G28 Z0\nG90\nG53 G0 "
      "X0\nM30\n";
  const std::string alphabet = "GXYZIJKRFMTSPQNDL0123456789.-+()%;#[]oO \n/*=";
  std::mt19937 random(5);
  ReaderParams params;
  params.max_moves = 10000;
  int accepted = 0;
  for (int i = 0; i < 20000; ++i) {
    std::string text = seed;
    for (unsigned k = 0, n = random() % 6; k < n; ++k) {
      const std::size_t at = random() % text.size();
      switch (random() % 4) {
        case 0:
          text[at] = static_cast<char>(random() % 256);
          break;
        case 1:
          text[at] = alphabet[random() % alphabet.size()];
          break;
        case 2:
          text.erase(at, random() % 5);
          break;
        default:
          text.insert(at, 1, alphabet[random() % alphabet.size()]);
      }
    }
    const auto motion = ReadProgram(text, params);
    if (!motion.ok()) {
      EXPECT_THAT(std::string(motion.status().message()), HasSubstr("line "));
      continue;
    }
    ++accepted;
    for (const ProgramMove& move : motion->moves) {
      EXPECT_TRUE(move.from.allFinite() && move.to.allFinite());
    }
  }
  EXPECT_GT(accepted, 1000);
}

// Programs of other people, when they are there.
TEST(ProgramReader, SharedPrograms) {
  const fs::path folder = fs::path(PATCHMILL_SOURCE_DIR) / "../shared/data/gcode";
  if (!fs::exists(folder)) GTEST_SKIP() << "../shared/data/gcode is not there";
  const auto load = [&](const std::string& name) {
    std::ifstream in(folder / name);
    std::stringstream text;
    text << in.rdbuf();
    return text.str();
  };
  for (const char* name : {"programs/arc-xy-plane.gcode", "programs/arc-xz-plane.gcode",
                           "programs/arc-yz-plane.gcode", "programs/arcspiral.ngc", "programs/flower_mold.nc",
                           "programs/scorpion.nc", "programs/slant_test.nc"}) {
    const auto motion = ReadProgram(load(name));
    EXPECT_TRUE(motion.ok()) << name << ": " << motion.status();
    EXPECT_GT(motion.ok() ? motion->moves.size() : 0u, 1u) << name;
  }
  for (const auto& [name, line] : std::vector<std::pair<std::string, std::string>>{
           {"programs/3D_Chips.ngc", "line 8: "},
           {"programs/helical-thread-milling.gcode", "line 4: "},
           {"rs274ngc_programs/inside-corners.ngc", "line 9: "},
           {"rs274ngc_programs/unit-conversion.ngc", "line 9: "},
           {"programs/full-circle-without-xyz.gcode", "line 11: "}}) {
    EXPECT_THAT(Refusal(load(name)), ::testing::StartsWith(line)) << name;
  }
}

// LinuxCNC's own interpreter wrote down the places to which these programs go.
TEST(ProgramReader, SharedProgramsGoWhereLinuxCncGoes) {
  const fs::path folder = fs::path(PATCHMILL_SOURCE_DIR) / "../shared/data/gcode/rs274ngc_good";
  if (!fs::exists(folder)) GTEST_SKIP() << "../shared/data/gcode is not there";
  int compared = 0;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.path().extension() != ".ngc") continue;
    std::ifstream in(entry.path()), expected_in(entry.path().string() + ".expected");
    std::stringstream text;
    text << in.rdbuf();
    const auto motion = ReadProgram(text.str());
    ASSERT_TRUE(motion.ok()) << entry.path() << motion.status();
    double unit = 1.0;  // mm
    for (std::string line; std::getline(expected_in, line);) {
      double x = 0, y = 0, cx = 0, cy = 0;
      int turns = 0;
      if (line.find("CANON_UNITS_INCHES") != std::string::npos) unit = 25.4;
      if (line.find("CANON_UNITS_MM") != std::string::npos) unit = 1.0;
      const std::size_t at = line.find("ARC_FEED(");
      if (at == std::string::npos) continue;
      ASSERT_EQ(std::sscanf(line.c_str() + at, "ARC_FEED(%lf, %lf, %lf, %lf, %d", &x, &y, &cx, &cy, &turns),
                5);
      EXPECT_LT((motion->moves.back().to - unit * Vec3(x, y, 0)).norm(), 1e-3 * unit) << entry.path();
      const Vec3 center = unit * Vec3(cx, cy, 0);
      const Vec3 start = motion->moves[0].to;
      double swept = 0.0;  // rad, counter-clockwise
      for (const ProgramMove& move : motion->moves) {
        if (move.chord_error == 0.0) continue;
        const Vec3 a = move.from - center, b = move.to - center;
        const double r0 = (start - center).norm(), r1 = (unit * Vec3(x, y, 0) - center).norm();
        EXPECT_GE(b.norm(), std::min(r0, r1) - 1e-3 * unit);
        EXPECT_LE(b.norm(), std::max(r0, r1) + 1e-3 * unit);
        swept += std::atan2(a.x() * b.y() - a.y() * b.x(), a.dot(b));
      }
      EXPECT_NEAR(swept, turns * kPi, 1e-6) << entry.path() << ": half a turn clockwise";
      ++compared;
    }
  }
  EXPECT_EQ(compared, 6);
}

}  // namespace
}  // namespace patchmill
