// `patchmill build` and `patchmill fair --net` as a user meets them.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <google/protobuf/util/json_util.h>
#include <gtest/gtest.h>

#include "patchmill/v1/model.pb.h"
#include "tests/service/patchmill.h"
#include "tests/service/process.h"

namespace patchmill {
namespace {

using ::testing::Contains;
using ::testing::ContainsRegex;
using testing::Finished;
using ::testing::HasSubstr;
using ::testing::Not;
using testing::Patchmill;
using testing::Slurp;
using testing::TempDir;
using ::testing::UnorderedElementsAre;

const char kOutline[] = R"({"length_unit": "LENGTH_UNIT_MILLIMETER", "sections": {"curves": [
  {"bezier": {"points": [0, 0, 0, 20, 0, 12, 40, 0, 0]}}, {"bezier": {"points": [0, 20, 2, 20, 20, 16, 40, 20, 2]}},
  {"bezier": {"points": [0, 40, 0, 20, 40, 12, 40, 40, 0]}}]},
  "network": {"vertices": [{"position": [5, 5, 3]}, {"position": [35, 5, 3]}, {"position": [35, 35, 3]},
                           {"position": [5, 35, 3]}], "faces": [{"vertices": [0, 1, 2, 3]}]}})";

TEST(CliBuild, MakesASurfaceThatChecksAndANetworkThatEdits) {
  const TempDir out;
  out.Write("outline.json", kOutline);
  const Finished run =
      Patchmill({"build", out / "outline.json", "-o", out / "surface.json", "--network", out / "net.json"});
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_THAT(out.Names(), UnorderedElementsAre("outline.json", "surface.json", "net.json"));
  EXPECT_THAT(run.err, HasSubstr("4 vertices"));
  const Finished check = Patchmill({"check", out / "surface.json"});
  EXPECT_EQ(check.status, 0) << check.err;
  EXPECT_THAT(check.out, HasSubstr("box          X 0.000 Y 0.000 Z 0.000 to X 40.000 Y 40.000"));
  const Finished edit =
      Patchmill({"edit", out / "net.json", "-o", out / "edited.json", "--push", "0,0.5,0.5,0.01"});
  EXPECT_EQ(edit.status, 0) << edit.err;
  EXPECT_THAT(edit.err, HasSubstr("1 of 1 faces changed"));
}

TEST(CliBuild, SaysWhatIsWrong) {
  const TempDir out;
  out.Write("outline.json", "{\"length_unit\": 1}");
  EXPECT_EQ(Patchmill({"build", out / "outline.json", "-o", out / "a.json"}).status, 2);
  EXPECT_THAT(
      Patchmill({"build", out / "outline.json", "-o", out / "a.json", "--network", out / "b.json"}).err,
      HasSubstr("has no network"));
  EXPECT_THAT(out.Names(), UnorderedElementsAre("outline.json"));
}

// Four lines of the plane z = 1, each 2 longer than the square that they close.
const char kStrokes[] =
    "v 2\n-2 0 1\n12 0 1\nv 2\n-2 10 1\n12 10 1\nv 2\n0 -2 1\n0 12 1\nv 2\n10 -2 1\n10 12 1\n";

TEST(CliBuild, MakesANetworkOfStrokesThatChecksAndEdits) {
  const TempDir out;
  out.Write("square.curves", kStrokes);
  const Finished run =
      Patchmill({"build", out / "square.curves", "-o", out / "net.json", "--tolerance", "0.01"});
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_THAT(run.err, HasSubstr("4 vertices, 4 edges, 1 faces"));
  EXPECT_THAT(run.err, HasSubstr("CURVE_END_TRIMMED"));
  const Finished check = Patchmill({"check", out / "net.json"});
  EXPECT_EQ(check.status, 0) << check.err;
  EXPECT_THAT(check.out, ContainsRegex("X -?0.000 Y -?0.000 Z 1.000 to X 10.000 Y 10.000"));
  EXPECT_EQ(
      Patchmill({"edit", out / "net.json", "-o", out / "edited.json", "--push", "0,0.5,0.5,0.01"}).status, 0);
  EXPECT_EQ(Patchmill({"build", out / "square.curves", "-o", out / "b.json", "--refuse-free-ends"}).status,
            1);
}

TEST(CliBuild, DividesASkinAndASplineAndTakesAMesh) {
  const TempDir out;
  std::string outline = kOutline;
  out.Write("outline.json", outline.substr(0, outline.find(",\n  \"network\"")) + "}");
  const Finished run = Patchmill({"build", out / "outline.json", "--divide", "-o", out / "net.json"});
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_THAT(run.err, HasSubstr("2 faces"));
  ASSERT_EQ(Patchmill({"build", out / "outline.json", "-o", out / "skin.json"}).status, 0);
  EXPECT_EQ(Patchmill({"build", out / "skin.json", "--parts", "2,2", "-o", out / "again.json"}).status, 0);
  out.Write("cage.obj", "v 0 0 0\nv 10 0 1\nv 10 10 0\nv 0 10 1\nf 1 2 3 4\n");
  EXPECT_EQ(Patchmill({"build", out / "cage.obj", "-o", out / "cage.json"}).status, 0);
  EXPECT_EQ(Patchmill({"check", out / "cage.json"}).status, 0);
}

TEST(CliBuild, FairedSectionsBecomeASkinByFile) {
  const TempDir out;
  std::vector<std::string> names;
  for (int k = 0; k < 3; ++k) {
    std::string points;
    for (int i = 0; i <= 8; ++i)
      points += fmt::format("{},{},{}\n", 5 * i, 20 * k, 0.1 * i * (8 - i) + 0.05 * (i % 2));
    names.push_back(out / fmt::format("s{}.csv", k));
    out.Write(fmt::format("s{}.csv", k), points);
  }
  const Finished fair = Patchmill({"fair", names[0], names[1], names[2], "-o", out / "sections.json"});
  ASSERT_EQ(fair.status, 0) << fair.err;
  const Finished build = Patchmill({"build", out / "sections.json", "--divide", "-o", out / "net.json"});
  ASSERT_EQ(build.status, 0) << build.err;
  ASSERT_EQ(Patchmill({"fair", names[1], "-o", out / "middle.json"}).status, 0);
  out.Write("files.json", R"({"length_unit": "LENGTH_UNIT_MILLIMETER", "sections": {"curves": [
    {"file": "s0.csv"}, {"file": "middle.json"}, {"file": "s2.csv"}]}})");
  EXPECT_EQ(Patchmill({"build", out / "files.json", "-o", out / "skin.json"}).status, 0);
}

TEST(CliFair, Nets) {
  const TempDir out;
  std::string points;
  for (int i = 0; i < 5; ++i) {
    for (int j = 0; j < 4; ++j) points += fmt::format("{},{},{}\n", i, j, i == 2 && j == 1 ? 0.2 : 0.0);
  }
  out.Write("net.csv", points);
  const Finished run =
      Patchmill({"fair", out / "net.csv", "--net", "5", "--band", "none", "-o", out / "fair.csv"});
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_THAT(run.err, HasSubstr("20 points"));
  EXPECT_NE(Slurp(out / "fair.csv").find("4,3,0"), std::string::npos);
  EXPECT_EQ(Patchmill({"fair", out / "net.csv", "--net", "3", "-o", out / "fair.csv"}).status, 2);
  EXPECT_THAT(
      Patchmill({"fair", out / "net.csv", "--net", "5", "-o", out / "fair.csv", "--preview", out / "a.svg"})
          .err,
      HasSubstr("--preview is for curves"));
}

TEST(CliBuild, EdgesTakeTheirCurvesFromFiles) {
  const TempDir out;
  // The first edge of a square is an arch of nine points; the file runs from its end to its start.
  std::string points;
  for (int i = 8; i >= 0; --i) points += fmt::format("{},0,{}\n", 5 * i, 0.25 * i * (8 - i));
  out.Write("arch.csv", points);
  const std::string net = R"({"network": {"vertices": [{"position": [0, 0, 0]}, {"position": [40, 0, 0]},
      {"position": [40, 40, 0]}, {"position": [0, 40, 0]}],
    "edges": [{"id": "arch", "start": 0, "end": 1, "file": "arch.csv"}],
    "faces": [{"vertices": [0, 1, 2, 3]}]}})";
  out.Write("net.json", "{\"length_unit\": \"LENGTH_UNIT_MILLIMETER\", " + net.substr(1));
  const Finished build = Patchmill({"build", out / "net.json", "-o", out / "made.json"});
  ASSERT_EQ(build.status, 0) << build.err;
  v1::PatchModel model;
  ASSERT_TRUE(google::protobuf::util::JsonStringToMessage(Slurp(out / "made.json"), &model).ok());
  const v1::NetworkEdge& edge = model.network().edges(0);
  ASSERT_TRUE(edge.has_bspline());
  const int last = edge.bspline().points_size() - 3;
  EXPECT_EQ(edge.bspline().points(0), 0.0);  // turned round
  EXPECT_EQ(edge.bspline().points(last), 40.0);
  // A spline through points has them among its Bezier points.
  bool passes = false;
  for (int i = 0; i <= last; i += 3) {
    passes |= std::abs(edge.bspline().points(i) - 20.0) < 1e-9 &&
              std::abs(edge.bspline().points(i + 2) - 4.0) < 1e-9;
  }
  EXPECT_TRUE(passes);
}

TEST(CliBuild, NamesTheFileThatAnEdgeLacks) {
  const TempDir out;
  for (const auto& [name, part] :
       {std::pair{"none.csv", "none.csv"}, {"curve.txt", "points end in .csv or .dat"}}) {
    if (std::string(name) == "curve.txt") out.Write(name, "0,0,0\n1,1,1\n");
    out.Write("files.json", fmt::format(R"({{"sections": {{"curves": [{{"file": "{}"}}]}}}})", name));
    const Finished run = Patchmill({"build", out / "files.json", "-o", out / "a.json"});
    EXPECT_NE(run.status, 0);
    EXPECT_THAT(run.err, HasSubstr(part));
    EXPECT_THAT(out.Names(), Not(Contains("a.json")));
  }
}

TEST(CliBuild, UnitsAreStatedOnceAndHoldForFairedCurvesToo) {
  const TempDir out;
  for (int k = 0; k < 3; ++k) {
    std::string points;
    for (int i = 0; i <= 6; ++i) points += fmt::format("{},{},{}\n", i, 2 * k, 0.1 * i * (6 - i));
    out.Write(fmt::format("s{}.csv", k), points);
    ASSERT_EQ(
        Patchmill({"fair", out / fmt::format("s{}.csv", k), "--fit", "-o", out / fmt::format("s{}.json", k)})
            .status,
        0);
  }
  const auto box = [&](std::vector<std::string> command) {
    command.insert(command.begin(), "build");
    command.insert(command.end(), {"-o", out / "skin.json"});
    const Finished run = Patchmill(command);
    EXPECT_EQ(run.status, 0) << run.err;
    return Patchmill({"check", out / "skin.json"}).out;
  };
  const std::string inches = "to X 152.400 Y 101.600";
  EXPECT_THAT(box({out / "s0.csv", out / "s1.csv", out / "s2.csv", "--length-unit", "inch"}),
              HasSubstr(inches));
  EXPECT_THAT(box({out / "s0.json", out / "s1.csv", out / "s2.json", "--length-unit", "inch"}),
              HasSubstr(inches));
  ASSERT_EQ(Patchmill({"fair", out / "s0.csv", out / "s1.csv", out / "s2.csv", "--fit", "--length-unit",
                       "inch", "-o", out / "outline.json"})
                .status,
            0);
  EXPECT_THAT(box({out / "outline.json"}), HasSubstr(inches));
  const Finished twice =
      Patchmill({"build", out / "outline.json", "--length-unit", "mm", "-o", out / "x.json"});
  EXPECT_EQ(twice.status, 2);
  EXPECT_THAT(twice.err, HasSubstr("states its own unit"));
}

TEST(CliBuild, NamesStrokesOfOnePointAndListsAllFindings) {
  const TempDir out;
  out.Write("square.curves", std::string(kStrokes) + "v 1\n3 4 5\n");
  const Finished run = Patchmill(
      {"build", out / "square.curves", "-o", out / "net.json", "--tolerance", "0.01", "--all-findings"});
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_THAT(run.err, HasSubstr("STROKE_OF_ONE_POINT: stroke 5"));
  EXPECT_THAT(run.err, Not(HasSubstr("more; --all-findings")));
  out.Write("point.curves", "v 1\n3 4 5\n");
  EXPECT_THAT(Patchmill({"build", out / "point.curves", "-o", out / "x.json"}).err,
              HasSubstr("have one point each"));
}

}  // namespace
}  // namespace patchmill
