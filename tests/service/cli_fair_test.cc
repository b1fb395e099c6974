// `patchmill fair` as a user meets it.
#include <gmock/gmock.h>
#include <google/protobuf/util/json_util.h>
#include <gtest/gtest.h>

#include "core/io/curve_points.h"
#include "patchmill/v1/fairing.pb.h"
#include "tests/service/process.h"

namespace patchmill {
namespace {

using ::testing::AllOf;
using testing::Finished;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::Slurp;
using testing::TempDir;
using ::testing::UnorderedElementsAre;

const std::string kFoil = PATCHMILL_SOURCE_DIR "/tests/models/curves/fx63143.dat";
const std::string kHull = PATCHMILL_SOURCE_DIR "/tests/models/curves/gunnerus_waterline.csv";

Finished Fair(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), {PATCHMILL_BIN "/patchmill", "fair"});
  return testing::Run(arguments);
}

std::vector<Vec3> Points(const std::string& format, const std::string& path) {
  const absl::StatusOr<CurvePoints> curve = ReadCurvePoints(format, Slurp(path));
  EXPECT_TRUE(curve.ok()) << curve.status();
  return curve.ok() ? curve->points : std::vector<Vec3>();
}

TEST(CliFair, WritesPointsPolylineAndPicture) {
  const TempDir out;
  const Finished run = Fair({kFoil, "-o", out / "foil.dat", "--polyline", out / "line.csv", "--tolerance",
                             "1e-5", "--preview", out / "foil.svg"});
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_THAT(out.Names(), UnorderedElementsAre("foil.dat", "line.csv", "foil.svg"));
  EXPECT_THAT(run.out, IsEmpty());
  EXPECT_THAT(run.err, AllOf(HasSubstr("97 points"), HasSubstr("energy"), HasSubstr("moved")));
  EXPECT_THAT(Slurp(out / "foil.svg"), AllOf(HasSubstr("<svg"), HasSubstr("fx63143.dat")));
  const std::vector<Vec3> given = Points("dat", kFoil), faired = Points("dat", out / "foil.dat"),
                          line = Points("csv", out / "line.csv");
  ASSERT_EQ(faired.size(), given.size());
  double farthest = 0.0;
  for (std::size_t i = 0; i < given.size(); ++i) {
    farthest = std::max(farthest, (faired[i] - given[i]).cwiseAbs().maxCoeff());
  }
  EXPECT_GT(farthest, 1e-5);
  EXPECT_LE(farthest, 0.002 * 1.02);  // the default band; the diagonal is about the chord
  EXPECT_GT(line.size(), faired.size());
  EXPECT_EQ(line.front(), faired.front());
  EXPECT_EQ(line.back(), faired.back());
  EXPECT_EQ(Slurp(out / "foil.dat").substr(0, 10), Slurp(kFoil).substr(0, 10));  // the title
}

TEST(CliFair, LocksBandsAndFitInJson) {
  const TempDir out;
  const auto faired = [&](std::vector<std::string> more) {
    more.insert(more.begin(), {kHull, "-o", out / "hull.json", "--quiet"});
    const Finished run = Fair(more);
    EXPECT_EQ(run.status, 0) << run.err;
    EXPECT_THAT(run.err, IsEmpty());
    v1::FairCurveResponse response;
    EXPECT_TRUE(google::protobuf::util::JsonStringToMessage(Slurp(out / "hull.json"), &response).ok());
    return response;
  };
  const std::vector<Vec3> given = Points("csv", kHull);
  const auto moved = [&](const v1::FairCurveResponse& r, int point, int axis) {
    return r.points_mm(3 * point + axis) - given[static_cast<std::size_t>(point)][axis];
  };
  const v1::FairCurveResponse locked =
      faired({"--lock", "4-6,20:y", "--band", "none", "--start-direction", "1,0,0"});
  EXPECT_GE(locked.iteration_count(), 1);
  for (const int point : {4, 5, 6}) {
    EXPECT_EQ(moved(locked, point, 0), 0.0);
    EXPECT_EQ(moved(locked, point, 1), 0.0);
  }
  EXPECT_EQ(moved(locked, 20, 1), 0.0);
  EXPECT_NE(moved(locked, 20, 0), 0.0);
  const v1::FairCurveResponse frozen = faired({"--axes", "y", "--band", "0.001", "--stop", "energy"});
  for (int point = 0; point < 31; ++point) {
    EXPECT_EQ(moved(frozen, point, 0), 0.0);
    EXPECT_LE(std::abs(moved(frozen, point, 1)), 0.001 * (1 + 1e-9));
  }
  const v1::FairCurveResponse fit = faired({"--fit"});
  EXPECT_EQ(fit.iteration_count(), 0);
  EXPECT_EQ(fit.max_moved_mm(), 0.0);
}

TEST(CliFair, WrongUsageAndUnreadableInput) {
  const TempDir out;
  const auto fails = [&](std::vector<std::string> arguments, const std::string& message) {
    const Finished run = Fair(arguments);
    EXPECT_EQ(run.status, 2) << run.err;
    EXPECT_THAT(run.err, HasSubstr(message));
  };
  fails({kHull, "-o", out / "a.txt"}, "must end in .csv or .dat or .json");
  fails({kHull, "-o", out / "a.csv", "--band", "much"}, "--band much; must be");
  fails({kHull, "-o", out / "a.csv", "--band", "-1"}, "--band: band.x_mm = -1; must be >= 0");
  fails({kHull, "-o", out / "a.csv", "--lock", "4:w"}, "--lock 4:w; must be");
  fails({kHull, "-o", out / "a.csv", "--lock", "31"}, "locks[0].point_index = 31; must be in [0, 30]");
  fails({kHull, "-o", out / "a.csv", "--axes", "xq"}, "--axes xq; must be");
  fails({kHull, "-o", out / "a.csv", "--polyline", out / "b.csv"}, "--tolerance");
  fails({kHull, "-o", out / "a.csv", "--end-direction", "0,0,0"}, "--end-direction");
  fails({out / "none.csv", "-o", out / "a.csv"}, "none.csv");
  const TempDir in;
  fails({in.Write("bad.csv", "x,y\n1,2\n3,?\n"), "-o", out / "a.csv"}, "line 3: \"?\" is not a number");
  fails({in.Write("bad.xyz", "1 2\n3 4\n"), "-o", out / "a.csv"}, "known are \"csv\" and \"dat\"");
  EXPECT_THAT(out.Names(), IsEmpty());
}

}  // namespace
}  // namespace patchmill
