// Faces that are skipped: the tool keeps off their boxes, and every answer says that they are missing.
#include <algorithm>
#include <sstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <google/protobuf/util/json_util.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "core/base/vec.h"
#include "patchmill/v1/model_service.pb.h"
#include "server/importer.h"
#include "tests/service/patchmill.h"
#include "tests/service/process.h"

namespace patchmill {
namespace {

using ::testing::AllOf;
using testing::Finished;
using ::testing::HasSubstr;
using ::testing::Not;
using testing::Patchmill;
using testing::Slurp;
using testing::TempDir;

// A plate of 30 x 24 x 8 with a dome of radius 7 in its middle: f7 is a hemisphere.
const std::string kDome = PATCHMILL_SOURCE_DIR "/tests/models/cad/dome.step";
constexpr double kRadius = 7.0, kBall = 3.0, kTolerance = 0.05;
const Vec3 kCenter(15.0, 12.0, 8.0);

#define NEEDS_IMPORTER() \
  if (access(ImporterPath().c_str(), X_OK) != 0) GTEST_SKIP() << "built without Open CASCADE"

Finished Mill(const std::string& model, const std::string& program, const std::vector<std::string>& more) {
  std::vector<std::string> arguments = {"mill",
                                        model,
                                        "-o",
                                        program,
                                        "--tool-diameter",
                                        "6",
                                        "--scallop",
                                        "0.2",
                                        "--tolerance",
                                        "0.05",
                                        "--report",
                                        program + ".json",
                                        "--no-arcs"};  // TipsOf reads straight moves
  arguments.insert(arguments.end(), more.begin(), more.end());
  return Patchmill(arguments);
}

// Box of a face, as `faces` writes it.
Box3 BoxOf(const std::string& model, const std::string& id, const std::vector<std::string>& more) {
  const TempDir dir;
  std::vector<std::string> arguments = {"faces", model, "-o", dir / "faces.json"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  const Finished run = Patchmill(arguments);
  EXPECT_EQ(run.status, 0) << run.err;
  v1::CheckModelResponse response;
  EXPECT_TRUE(google::protobuf::util::JsonStringToMessage(Slurp(dir / "faces.json"), &response).ok());
  Box3 box;
  for (const v1::FaceInfo& info : response.faces()) {
    if (info.face().id() != id) continue;
    box.Add(Vec3(info.box().min().x_mm(), info.box().min().y_mm(), info.box().min().z_mm()));
    box.Add(Vec3(info.box().max().x_mm(), info.box().max().y_mm(), info.box().max().z_mm()));
  }
  return box;
}

// Tips of a program about every 0.02 mm of its way, read from its words.
std::vector<Vec3> TipsOf(const std::string& program) {
  std::vector<Vec3> tips;
  Vec3 at(0, 0, 100);
  bool begun = false;
  std::istringstream lines(program);
  for (std::string line; std::getline(lines, line);) {
    if (line.find('(') != std::string::npos || line.find("G53") != std::string::npos) continue;
    Vec3 to = at;
    bool moves = false;
    std::istringstream words(line);
    for (std::string word; words >> word;) {
      const std::size_t axis = std::string("XYZ").find(word[0]);
      if (axis == std::string::npos) continue;
      to[static_cast<int>(axis)] = std::stod(word.substr(1));
      moves = true;
    }
    if (!moves) continue;
    const int steps = begun ? 1 + static_cast<int>((to - at).norm() / 0.02) : 1;
    for (int k = 1; k <= steps; ++k) tips.push_back(at + (to - at) * k / steps);
    at = to;
    begun = true;
  }
  return tips;
}

double DistanceFrom(const Box3& box, const Vec3& p) {
  return (p - p.cwiseMax(box.min).cwiseMin(box.max)).norm();
}

struct Kept {
  double lowest = kInfinity;   // mm, tip over the outline of the box
  double nearest = kInfinity;  // mm, centre of the ball to the box
};
Kept KeptFrom(const std::string& program, const Box3& box) {
  Kept kept;
  for (const Vec3& tip : TipsOf(program)) {
    const bool within =
        tip.x() >= box.min.x() && tip.x() <= box.max.x() && tip.y() >= box.min.y() && tip.y() <= box.max.y();
    if (within) kept.lowest = std::min(kept.lowest, tip.z());
    kept.nearest = std::min(kept.nearest, DistanceFrom(box, tip + Vec3(0, 0, kBall)));
  }
  return kept;
}

// The tip stays above the box within its outline, and the ball off it everywhere.
void ExpectKeptOff(const std::string& program, const Box3& box) {
  const Kept kept = KeptFrom(program, box);
  EXPECT_GE(kept.lowest, box.max.z() - kTolerance);
  EXPECT_GE(kept.nearest, kBall - kTolerance);
  EXPECT_LE(kept.nearest, kBall + 5.0);  // it comes near
}

TEST(SkipFace, NoTipGoesIntoTheBoxOfAHemisphere) {
  NEEDS_IMPORTER();
  const TempDir dir;
  const Box3 box = BoxOf(kDome, "f7", {"--skip-face", "f7"});
  // It holds all of the hemisphere, and hardly more.
  const Vec3 low = kCenter - Vec3(kRadius, kRadius, 0.0), high = kCenter + Vec3::Constant(kRadius);
  EXPECT_TRUE((box.min.array() <= low.array()).all() && (box.max.array() >= high.array()).all());
  EXPECT_LT((box.max - high).maxCoeff(), 0.01);
  EXPECT_LT((low - box.min).maxCoeff(), 0.5);

  const Finished whole = Mill(kDome, dir / "whole.ngc", {});
  ASSERT_EQ(whole.status, 0) << whole.err;
  const Finished run = Mill(kDome, dir / "part.ngc", {"--skip-face", "f7"});
  ASSERT_EQ(run.status, 0) << run.err;
  const std::string program = Slurp(dir / "part.ngc");
  ExpectKeptOff(program, box);
  // The program that finishes the dome goes into the box.
  const Kept entered = KeptFrom(Slurp(dir / "whole.ngc"), box);
  EXPECT_LT(entered.lowest, box.max.z() - 1.0);
  EXPECT_LT(entered.nearest, kBall - 1.0);
  // The plate is finished, but for what lies beside the box.
  EXPECT_GT(TipsOf(program).size(), 1000u);
  EXPECT_THAT(program, HasSubstr("NOT_ALL_FACES: 1 of 7 faces skipped: f7"));
  EXPECT_THAT(Slurp(dir / "whole.ngc"), Not(HasSubstr("NOT_ALL_FACES")));
  EXPECT_THAT(run.err, AllOf(HasSubstr("WARNING NOT_ALL_FACES"), HasSubstr("WARNING SKIPPED_FACE face f7")));
  EXPECT_THAT(Slurp(dir / "part.ngc.json"), AllOf(HasSubstr("NOT_ALL_FACES"), HasSubstr("SKIPPED_FACE")));

  // The verifier agrees, and it refuses the program that finishes the dome.
  const auto verify = [&](const std::string& name) {
    return Patchmill({"verify", kDome, dir / name, "--skip-face", "f7", "--tool-diameter", "6", "--scallop",
                      "0.2", "--tolerance", "0.05"});
  };
  const Finished good = verify("part.ngc"), bad = verify("whole.ngc");
  EXPECT_EQ(good.status, 0) << good.err << good.out;
  EXPECT_THAT(good.out + good.err, HasSubstr("NOT_ALL_FACES"));
  EXPECT_EQ(bad.status, 1);
  EXPECT_THAT(bad.out + bad.err, HasSubstr("GOUGE"));
}

// The box has all six sides: it holds, whatever points up.
TEST(SkipFace, TheBoxIsKeptOffFromEverySide) {
  NEEDS_IMPORTER();
  const TempDir dir;
  for (const std::string up : {"x", "-y", "f2"}) {
    SCOPED_TRACE(up);
    const std::vector<std::string> options = {"--skip-face", "f7", "--up", up, "--zero", "origin"};
    const Finished run = Mill(kDome, dir / "part.ngc", options);
    ASSERT_EQ(run.status, 0) << run.err;
    ExpectKeptOff(Slurp(dir / "part.ngc"), BoxOf(kDome, "f7", options));
  }
}

TEST(SkipFace, CheckFacesAndAConvertedModelSayIt) {
  NEEDS_IMPORTER();
  const TempDir dir;
  const Finished check = Patchmill({"check", kDome, "--skip-face", "f7"});
  EXPECT_EQ(check.status, 0) << check.err;
  EXPECT_THAT(check.out, AllOf(HasSubstr("WARNING NOT_ALL_FACES"), HasSubstr("WARNING SKIPPED_FACE face f7"),
                               HasSubstr("keeps off the box X 7.9")));
  EXPECT_THAT(Patchmill({"faces", kDome, "--skip-face", "f7"}).out, HasSubstr("skipped"));
  ASSERT_EQ(Patchmill({"convert", kDome, dir / "dome.pb", "--skip-face", "f7"}).status, 0);
  const Finished converted = Patchmill({"check", dir / "dome.pb"});
  EXPECT_EQ(converted.out, check.out);
  ASSERT_EQ(Mill(dir / "dome.pb", dir / "part.ngc", {}).status, 0);
  EXPECT_THAT(Slurp(dir / "part.ngc"), HasSubstr("NOT_ALL_FACES"));
  ExpectKeptOff(Slurp(dir / "part.ngc"), BoxOf(dir / "dome.pb", "f7", {}));
}

// A sphere of another radius than its edge: the file is broken there.
TEST(SkipFace, AFaceThatStopsTheJobIsNamedAndCanBeSkipped) {
  NEEDS_IMPORTER();
  const TempDir dir;
  std::string step = Slurp(kDome);
  const std::size_t at = step.find(",7.);", step.find("SPHERICAL_SURFACE"));
  ASSERT_NE(at, std::string::npos);
  const std::string broken = dir.Write("broken.step", step.replace(at, 5, ",5.);"));
  const Finished stopped = Mill(broken, dir / "part.ngc", {});
  EXPECT_NE(stopped.status, 0);
  EXPECT_THAT(stopped.err, HasSubstr("f7"));
  const Finished run = Mill(broken, dir / "part.ngc", {"--skip-face", "f7"});
  ASSERT_EQ(run.status, 0) << run.err;
  const Box3 box = BoxOf(broken, "f7", {"--skip-face", "f7"});
  EXPECT_LE(box.min.x(), 8.0);  // of the edge, which is wider than the sphere
  EXPECT_GE(box.max.z(), 13.0);
  ExpectKeptOff(Slurp(dir / "part.ngc"), box);
}

TEST(SkipFace, SaysWhatItCannotDo) {
  NEEDS_IMPORTER();
  const TempDir dir;
  for (const char* id : {"f8", "f0", "f07", "lid", "f", "f7x", "f99999999999999999999"}) {
    const Finished run = Mill(kDome, dir / "part.ngc", {"--skip-face", id});
    EXPECT_EQ(run.status, 2) << run.err;
    EXPECT_THAT(run.err,
                HasSubstr("--skip-face: job.source.file.import_options.skip_faces = \"" + std::string(id) +
                          "\"; must be a face of the file, which has the faces f1 to f7"));
  }
  const Finished all =
      Mill(kDome, dir / "part.ngc", {"--skip-face", "f1,f2,f3,f4", "--skip-face", "f5,f6,f7"});
  EXPECT_EQ(all.status, 2);
  EXPECT_THAT(all.err, HasSubstr("skipped"));
  const Finished other =
      Patchmill({"check", PATCHMILL_SOURCE_DIR "/tests/models/teacup.bpt", "--skip-face", "f1"});
  EXPECT_EQ(other.status, 2);
  EXPECT_THAT(other.err, HasSubstr("--skip-face: source.file.import_options.skip_faces is set"));
  EXPECT_THAT(dir.Names(), ::testing::IsEmpty());
}

}  // namespace
}  // namespace patchmill
