// Curve points from text: what is read, what is refused and where, and bytes gone wrong.
#include "core/io/curve_points.h"

#include <filesystem>
#include <fstream>
#include <iterator>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/fuzz/curve_points_contract.h"
#include "tests/support/random.h"

namespace patchmill {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

CurvePoints Read(std::string_view format, std::string_view text) {
  absl::StatusOr<CurvePoints> curve = ReadCurvePoints(format, text);
  EXPECT_TRUE(curve.ok()) << curve.status();
  return curve.ok() ? *curve : CurvePoints();
}

std::string Fault(std::string_view format, std::string_view text) {
  const absl::Status status = ReadCurvePoints(format, text).status();
  EXPECT_EQ(status.code(), absl::StatusCode::kInvalidArgument);
  return std::string(status.message());
}

TEST(CurvePoints, DatWithAndWithoutTitle) {
  const CurvePoints foil = Read("dat", "NACA 4412\n 1.0 0.0013\n  0.5\t-.25 \n\n# end\n");
  EXPECT_EQ(foil.title, "NACA 4412");
  EXPECT_TRUE(foil.planar);
  EXPECT_THAT(foil.points, ElementsAre(Vec3(1, 0.0013, 0), Vec3(0.5, -0.25, 0)));
  EXPECT_EQ(Read("dat", "23012\n1 0\n").title, "23012");  // one number is no point
  const CurvePoints bare = Read("dat", "1 2 3\r\n4 5 6\r\n");
  EXPECT_EQ(bare.title, "");
  EXPECT_FALSE(bare.planar);
  EXPECT_THAT(bare.points, ElementsAre(Vec3(1, 2, 3), Vec3(4, 5, 6)));
}

TEST(CurvePoints, Csv) {
  const CurvePoints curve =
      Read("csv", "\xef\xbb\xbf\"Points:0\",\"Points:1\",\"Points:2\"\n-22.9, 22.989 ,2.84\n1e1,+2,3");
  EXPECT_EQ(curve.title, "\"Points:0\",\"Points:1\",\"Points:2\"");
  EXPECT_THAT(curve.points, ElementsAre(Vec3(-22.9, 22.989, 2.84), Vec3(10, 2, 3)));
  EXPECT_EQ(Read("csv", "H\xc3\xb6he,x\n1,2\n").title, "H??he,x");
}

TEST(CurvePoints, FaultsCarryTheirLine) {
  EXPECT_EQ(Fault("csv", "x,y\n1,2\n3,four\n"), "line 3: \"four\" is not a number; y of a point is expected");
  EXPECT_EQ(Fault("csv", "1,2\n3,4\n\n5,6,7\n"), "line 4: 3 numbers; the points before have 2");
  EXPECT_EQ(Fault("csv", "1,2\n3,4,5,6\n"), "line 2: a point has two or three numbers");
  EXPECT_EQ(Fault("csv", "1,2\n3\n"), "line 2: a point has two or three numbers");
  EXPECT_EQ(Fault("csv", "1,2\n3,\n"), "line 2: \"\" is not a number; y of a point is expected");
  EXPECT_THAT(Fault("csv", "1,x\n2,3\n"), HasSubstr("line 1: \"x\""));  // half a point is no title
  EXPECT_EQ(Fault("csv", "x,y\nstation,height\n1,2\n"),
            "line 2: \"station\" is not a number; x of a point is expected");
  EXPECT_THAT(Fault("dat", "foil\n1,5 2,5\n"), HasSubstr("line 2: \"1,5\" is not a number"));
  EXPECT_THAT(Fault("dat", "foil\n1 nan\n"), HasSubstr("line 2: \"nan\""));
  EXPECT_THAT(Fault("dat", "foil\n1 1e400\n"), HasSubstr("out of the range"));
  EXPECT_THAT(Fault("dat", "foil\n1 1e30\n"), HasSubstr("must be in"));
  EXPECT_EQ(Fault("dat", "only a title\n\n"), "line 2: the text holds no point");
  EXPECT_EQ(Fault("dat", ""), "line 1: the text holds no point");
  EXPECT_EQ(Fault("xyz", "1 2\n"), "unknown format \"xyz\" of a curve; known are \"csv\" and \"dat\"");
}

// Both sides from the nose to the tail become one run from tail to tail, with the nose once.
TEST(CurvePoints, LednicersFormBecomesOneRun) {
  const auto expected = ElementsAre(Vec3(1, 0.01, 0), Vec3(0.4, 0.1, 0), Vec3(0, 0, 0), Vec3(0.5, -0.1, 0),
                                    Vec3(0.8, -0.05, 0), Vec3(1, -0.01, 0));
  // The nose twice; once, above; once, below.
  EXPECT_THAT(Read("dat", "foil\n 3. 4.\n\n0 0\n.4 .1\n1 .01\n\n0 0\n.5 -.1\n.8 -.05\n1 -.01\n").points,
              expected);
  EXPECT_THAT(Read("dat", "foil\n3 4\n0 0\n.4 .1\n1 .01\n.5 -.1\n.8 -.05\n1 -.01\n").points, expected);
  EXPECT_THAT(Read("dat", "foil\n3 4\n\n.4 .1\n1 .01\n\n0 0\n.5 -.1\n.8 -.05\n1 -.01\n").points, expected);
  // A blunt nose that reaches forward by less than 0.5 % of the chord.
  EXPECT_EQ(Read("dat", "foil\n3 2\n0 0\n-.004 .01\n1 0\n0 0\n1 0\n").points.size(), 4u);
  const CurvePoints shared =
      Read("dat",
           "NACA 0012 in two runs\n 4. 4.\n\n0.0000 0.0000\n0.1000 0.0468\n0.5000 0.0529\n"
           "1.0000 0.0013\n\n0.1000 -0.0468\n0.5000 -0.0529\n1.0000 -0.0013\n");
  EXPECT_EQ(shared.title, "NACA 0012 in two runs");
  EXPECT_THAT(shared.points,
              ElementsAre(Vec3(1, 0.0013, 0), Vec3(0.5, 0.0529, 0), Vec3(0.1, 0.0468, 0), Vec3(0, 0, 0),
                          Vec3(0.1, -0.0468, 0), Vec3(0.5, -0.0529, 0), Vec3(1, -0.0013, 0)));
}

TEST(CurvePoints, CountsThatDoNotFitAreRefused) {
  // An empty line parts the counts from too few points.
  EXPECT_THAT(
      Fault("dat", "foil\n 4. 4.\n\n0 0\n.5 .1\n1 0\n\n0 0\n.5 -.1\n1 0\n"),
      HasSubstr(
          "line 2: these look like the counts of Lednicer's form, but 4 and 4 points are announced and 6 "
          "follow"));
  // The counts fit, the order does not: x falls from the tail.
  EXPECT_THAT(Fault("dat", "foil\n2 3\n1 0\n0 0\n0 0\n.5 -.1\n1 0\n"), HasSubstr("line 2: these look"));
  EXPECT_THAT(Fault("dat", "foil\n2 3\n0 0\n1 0\n.1 0\n.5 -.1\n1 0\n"), HasSubstr("the same first point"));
  EXPECT_THAT(Fault("dat", "foil\n3 3\n0 0\n1 .1\n0.5 0\n1 -.1\n0 0\n"), HasSubstr("one row for the nose"));
  // Both sides could have the nose: the rows are in line.
  EXPECT_THAT(Fault("dat", "foil\n3 3\n0 0\n0 .1\n0 .2\n0 .3\n0 .4\n"), HasSubstr("one row for the nose"));
  // Plain points.
  EXPECT_EQ(Read("dat", "foil\n2 3\n0 0\n1 0\n").points.size(), 3u);
  EXPECT_EQ(Read("dat", "foil\n2.5 3\n0 0\n1 0\n2 0\n2 1\n").points.size(), 5u);
}

TEST(CurvePoints, NoMoreThanTheLimit) {
  std::string text;
  for (int i = 0; i < kMaxCurvePoints; ++i) text += "1 0\n";
  EXPECT_EQ(Read("dat", text).points.size(), static_cast<std::size_t>(kMaxCurvePoints));
  EXPECT_EQ(Fault("dat", text + "1 0\n"), "line 100001: more than 100000 points");
}

// The shipped files, and each of them damaged at random.
TEST(CurvePoints, ShippedFilesAndDamagedOnes) {
  testing::Random random(1);
  int seen = 0, refused = 0;
  const auto damage = [&](const std::string& format, const std::string& text) {
    for (int round = 0; round < 300; ++round) {
      std::string damaged = text;
      for (int k = random.Int(4); k >= 0; --k) {
        const auto at = static_cast<std::size_t>(random.Int(static_cast<int>(damaged.size())));
        switch (random.Int(3)) {
          case 0:
            damaged[at] = static_cast<char>(random.Int(256));
            break;
          case 1:
            damaged.erase(at, 1 + static_cast<std::size_t>(random.Int(20)));
            break;
          default:
            damaged.insert(at, damaged.substr(static_cast<std::size_t>(random.Int(100)), 10));
        }
      }
      const absl::StatusOr<CurvePoints> read = ReadCurvePoints(format, damaged);
      EXPECT_TRUE(KeepsCurvePointsContract(damaged, read)) << read.status();
      if (!read.ok()) ++refused;
    }
  };
  for (const auto& entry : std::filesystem::directory_iterator(PATCHMILL_SOURCE_DIR "/tests/models/curves")) {
    ++seen;
    std::ifstream in(entry.path(), std::ios::binary);
    const std::string text{std::istreambuf_iterator<char>(in), {}};
    const std::string format = entry.path().extension().string().substr(1);
    const CurvePoints curve = Read(format, text);
    EXPECT_GE(curve.points.size(), 30u) << entry.path();
    EXPECT_FALSE(curve.title.empty());
    EXPECT_TRUE(curve.planar);
    damage(format, text);
  }
  damage("dat",
         "NACA 0012 in two runs\n 4. 4.\n\n0.0000 0.0000\n0.1000 0.0468\n0.5000 0.0529\n1.0000 0.0013\n\n"
         "0.1000 -0.0468\n0.5000 -0.0529\n1.0000 -0.0013\n");
  EXPECT_GE(seen, 4);
  EXPECT_GT(refused, 300);
}

}  // namespace
}  // namespace patchmill
