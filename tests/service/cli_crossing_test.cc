// Patches that cross each other, as a user meets them: findings of `check`, curves of `lines`.
#include <cstdlib>

#include <absl/strings/str_split.h>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/service/patchmill.h"
#include "tests/service/process.h"

namespace patchmill {
namespace {

using testing::Finished;
using ::testing::HasSubstr;
using ::testing::Not;
using testing::Patchmill;
using testing::Slurp;
using testing::TempDir;

// The square z = 0 of side 10, and an upright square in the plane x = 4 that stands `above` it.
std::string Squares(double above) {
  const double low = above - 5.0, high = above + 5.0;
  return fmt::format(R"({{"length_unit": "LENGTH_UNIT_MILLIMETER", "patches": [
    {{"id": "floor", "bezier": {{"degree_u": 1, "degree_v": 1, "points": [0, 0, 0, 0, 10, 0, 10, 0, 0, 10, 10, 0]}}}},
    {{"id": "wall", "bezier": {{"degree_u": 1, "degree_v": 1,
      "points": [4, 2, {0}, 4, 2, {1}, 4, 8, {0}, 4, 8, {1}]}}}}]}})",
                     low, high);
}

TEST(CliCrossing, CheckNamesPatchesThatCross) {
  const TempDir out;
  out.Write("crossing.json", Squares(0.0));
  out.Write("apart.json", Squares(5.5));
  const Finished crossing = Patchmill({"check", out / "crossing.json"});
  EXPECT_EQ(crossing.status, 0) << crossing.err;
  EXPECT_THAT(crossing.out + crossing.err, HasSubstr("PATCHES_CROSS"));
  const Finished without = Patchmill({"check", out / "crossing.json", "--no-crossings"});
  EXPECT_THAT(without.out + without.err, Not(HasSubstr("PATCHES_CROSS")));
  const Finished apart = Patchmill({"check", out / "apart.json"});
  EXPECT_THAT(apart.out + apart.err, Not(HasSubstr("PATCHES_CROSS")));
}

TEST(CliCrossing, LinesTraceTheCurveOfTheCrossing) {
  const TempDir out;
  out.Write("crossing.json", Squares(0.0));
  const Finished run =
      Patchmill({"lines", out / "crossing.json", "--kind", "intersection", "-o", out / "lines.csv"});
  ASSERT_EQ(run.status, 0) << run.err;
  const std::vector<std::string> rows = absl::StrSplit(Slurp(out / "lines.csv"), '\n', absl::SkipEmpty());
  ASSERT_GT(rows.size(), 2u);
  EXPECT_EQ(rows[0], "kind,level,line,closed,x,y,z");
  double least = 1e9, most = -1e9;
  for (std::size_t k = 1; k < rows.size(); ++k) {
    const std::vector<std::string> cells = absl::StrSplit(rows[k], ',');
    ASSERT_EQ(cells.size(), 7u) << rows[k];
    EXPECT_EQ(cells[0], "intersection");
    EXPECT_EQ(cells[2], "1");  // one line
    EXPECT_NEAR(std::strtod(cells[4].c_str(), nullptr), 4.0, 1e-6);
    EXPECT_NEAR(std::strtod(cells[6].c_str(), nullptr), 0.0, 1e-6);
    const double y = std::strtod(cells[5].c_str(), nullptr);
    least = std::min(least, y), most = std::max(most, y);
  }
  EXPECT_NEAR(least, 2.0, 1e-6);
  EXPECT_NEAR(most, 8.0, 1e-6);
}

}  // namespace
}  // namespace patchmill
