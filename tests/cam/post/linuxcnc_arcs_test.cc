// Our arcs as LinuxCNC's own interpreter understands them (rs274, scripts/setup.sh installs it).
#include <cmath>
#include <cstdio>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "cam/post/program_writer.h"
#include "tests/support/random.h"
#include "tests/support/rs274.h"

namespace patchmill {
namespace {

using testing::Random;

constexpr double kRadius = 3.0;

// Arcs one after the other: of every plane, clockwise and not, helices and full circles among them.
Toolpath RandomArcs(std::uint64_t seed) {
  Random random(seed);
  Toolpath path;
  path.ball_radius = kRadius;
  path.moves.push_back({.kind = MoveKind::kRapid, .to = Vec3(0, 0, 50)});
  for (int k = 0; k < 40; ++k) {
    const Vec3 from = path.moves.back().to;
    const auto plane = static_cast<ArcPlane>(random.Int(3));
    const bool clockwise = random.Int(2) == 1, full = random.Int(5) == 0;
    const double radius = std::pow(10.0, random.Uniform(-0.3, 1.3)), begin = random.Uniform(-kPi, kPi);
    const double turn = full ? 2.0 * kPi : random.Uniform(0.2, kPi), end = begin + (clockwise ? -turn : turn);
    const Vec3 start = ToPlane(plane, from);
    const Vec2 center = Xy(start) - radius * Vec2(std::cos(begin), std::sin(begin));
    Move move = {.kind = MoveKind::kCut, .to = from, .feed = 1000.0};
    if (!full) {
      const Vec2 at = center + radius * Vec2(std::cos(end), std::sin(end));
      move.to = FromPlane(plane, Lift(at, start.z() + random.Uniform(-1.0, 1.0)));
    }
    move.arc = Arc{plane, center, clockwise};
    path.moves.push_back(move);
  }
  return path;
}

// The numbers in the brackets of each ARC_FEED: ends along the first and second axis, centre likewise, turns
// (counter-clockwise above 0), end along the third axis.
// Lengths are in mm.
std::vector<std::vector<double>> ArcFeeds(const std::string& calls) {
  std::vector<std::vector<double>> arcs;
  std::istringstream lines(calls);
  double unit = 1.0;
  for (std::string line; std::getline(lines, line);) {
    if (line.find("USE_LENGTH_UNITS(CANON_UNITS_INCHES)") != std::string::npos) unit = 25.4;
    if (line.find("USE_LENGTH_UNITS(CANON_UNITS_MM)") != std::string::npos) unit = 1.0;
    const std::size_t at = line.find("ARC_FEED(");
    if (at == std::string::npos) continue;
    std::vector<double>& arc = arcs.emplace_back(6);
    EXPECT_EQ(std::sscanf(line.c_str() + at, "ARC_FEED(%lf, %lf, %lf, %lf, %lf, %lf", &arc[0], &arc[1],
                          &arc[2], &arc[3], &arc[4], &arc[5]),
              6);
    for (const std::size_t k : {0u, 1u, 2u, 3u, 5u}) arc[k] *= unit;
  }
  return arcs;
}

class LinuxCncArcs : public ::testing::TestWithParam<ProgramUnit> {};

TEST_P(LinuxCncArcs, AreWhatWasSent) {
  if (!testing::HasRs274()) GTEST_SKIP() << "rs274 is not installed";
  // rs274 prints four decimals, of inches too.
  const double printed = GetParam() == ProgramUnit::kInch ? 25.4e-4 : 1e-4;
  Tool tool;
  tool.cutter = BallEnd{kRadius};
  tool.spindle_rpm = 12000;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const Toolpath path = RandomArcs(seed);
    PostParams params;
    params.clearance_z = 100.0;
    params.unit = GetParam();
    const auto program = WriteProgram(path, tool, params);
    ASSERT_TRUE(program.ok()) << program.status();
    const testing::Rs274Answer answer =
        testing::RunRs274(*program, {.tool_table = "T1 P1 D6 Z0.0\n", .variables = "5161\t0.0\n5220\t1.0\n"});
    ASSERT_EQ(answer.status, 0) << answer.calls << *program;
    const auto arcs = ArcFeeds(answer.calls);
    // An arc that rounding would spoil is two; a short one may be chords where decimals are coarse.
    std::size_t next = 0, chords = 0;
    for (std::size_t k = 1; k < path.moves.size(); ++k) {
      const Move& sent = path.moves[k];
      const Vec3 tip(0, 0, -kRadius), to = ToPlane(sent.arc->plane, sent.to + tip);
      const Vec2 center = sent.arc->center + Xy(ToPlane(sent.arc->plane, tip));
      bool ended = false;
      for (int part = 0; part < 2 && !ended && next < arcs.size(); ++part, ++next) {
        const std::vector<double>& arc = arcs[next];
        if ((Vec2(arc[2], arc[3]) - center).norm() > 0.03) break;
        EXPECT_EQ(arc[4], sent.arc->clockwise ? -1.0 : 1.0) << k;
        ended = (Vec3(arc[0], arc[1], arc[5]) - to).norm() < printed;
      }
      if (!ended) ++chords;
    }
    EXPECT_LE(chords, GetParam() == ProgramUnit::kInch ? 4u : 0u) << seed;
    EXPECT_EQ(next, arcs.size());
    EXPECT_LT(arcs.size(), 1.3 * static_cast<double>(path.moves.size()));
  }
}

INSTANTIATE_TEST_SUITE_P(Units, LinuxCncArcs, ::testing::Values(ProgramUnit::kMillimeter, ProgramUnit::kInch),
                         [](const auto& of) { return of.param == ProgramUnit::kInch ? "inch" : "mm"; });

}  // namespace
}  // namespace patchmill
