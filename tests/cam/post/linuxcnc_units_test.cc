// Our reading of units and feeds against LinuxCNC's own interpreter (rs274, scripts/setup.sh installs it).
#include <cstdio>
#include <random>
#include <sstream>

#include <gtest/gtest.h>

#include "cam/post/program_reader.h"
#include "tests/support/rs274.h"

namespace patchmill {
namespace {

struct Feed {
  Vec3 to = Vec3::Zero();  // mm
  double feed = 0.0;       // mm/min
};

// The feed moves that the interpreter makes of a program. Its calls are in the unit in force at each.
std::vector<Feed> InterpretedFeeds(const std::string& text) {
  const testing::Rs274Answer answer =
      testing::RunRs274(text, {.tool_table = "T1 P1 D0.2 Z0.0\n",
                               .variables = "5161\t0.0\n5220\t1.0\n5221\t0.0\n5222\t0.0\n5223\t0.0\n"});
  EXPECT_EQ(answer.status, 0) << text << answer.calls;
  std::vector<Feed> feeds;
  double unit = 1.0, feed = 0.0;
  std::istringstream calls(answer.calls);
  for (std::string line; std::getline(calls, line);) {
    Vec3 to;
    double rate = 0.0;
    const auto call = [&](const char* name) {
      const std::size_t at = line.find(name);
      return at == std::string::npos ? nullptr : line.c_str() + at;
    };
    if (call("USE_LENGTH_UNITS(CANON_UNITS_INCHES)")) unit = 25.4;
    if (call("USE_LENGTH_UNITS(CANON_UNITS_MM)")) unit = 1.0;
    if (const char* at = call("SET_FEED_RATE"); at && std::sscanf(at, "SET_FEED_RATE(%lf", &rate) == 1)
      feed = rate * unit;
    if (const char* at = call("STRAIGHT_FEED");
        at && std::sscanf(at, "STRAIGHT_FEED(%lf, %lf, %lf", &to[0], &to[1], &to[2]) == 3)
      feeds.push_back({unit * to, feed});
  }
  return feeds;
}

void ExpectTheSame(const std::string& text) {
  const std::vector<Feed> theirs = InterpretedFeeds(text);
  const auto ours = ReadProgram(text);
  ASSERT_TRUE(ours.ok()) << ours.status() << "\n" << text;
  std::vector<Feed> feeds;
  for (const ProgramMove& move : ours->moves) {
    if (move.kind == ProgramMove::Kind::kFeed) feeds.push_back({move.to, move.feed});
  }
  ASSERT_EQ(feeds.size(), theirs.size()) << text;
  ASSERT_FALSE(feeds.empty());
  for (std::size_t i = 0; i < feeds.size(); ++i) {
    EXPECT_NEAR(feeds[i].feed, theirs[i].feed, 2e-3) << "feed move " << i << " of\n" << text;
    EXPECT_LT((feeds[i].to - theirs[i].to).norm(), 0.02) << "feed move " << i << " of\n" << text;
  }
}

// Words of a line in any order, units changed on lines of their own and on lines with feeds and moves.
TEST(LinuxCnc, FeedsAndPlacesAreTheSame) {
  if (!testing::HasRs274()) GTEST_SKIP() << "rs274 is not installed";
  std::mt19937 random(20261128);
  const auto one_in = [&](unsigned n) { return random() % n == 0; };
  for (int program = 0; program < 20; ++program) {
    std::ostringstream text;
    text << "G17 G40 G49 G54 G80 G90 G94 F" << 100 + random() % 900;
    if (one_in(2)) text << (one_in(2) ? " G20" : " G21");
    text << "\nG0 X0 Y0\nZ1\nG1 Z0\n";
    for (int line = 0; line < 12; ++line) {
      std::vector<std::string> words;
      if (one_in(3)) words.push_back(one_in(2) ? "G20" : "G21");
      if (one_in(3)) words.push_back("F" + std::to_string(1 + random() % 999));
      if (!one_in(4)) {
        words.push_back("G1");
        for (const char* axis : {"X", "Y", "Z"}) {
          if (one_in(2)) words.push_back(axis + std::to_string(random() % 40));
        }
        if (words.back() == "G1") words.push_back("X" + std::to_string(line));
      }
      std::shuffle(words.begin(), words.end(), random);
      for (const std::string& word : words) text << word << " ";
      text << "\n";
    }
    text << "M2\n";
    ExpectTheSame(text.str());
  }
}

}  // namespace
}  // namespace patchmill
