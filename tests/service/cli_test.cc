// The programs as a user meets them: exit statuses, messages, and what lies on disk afterwards.
#include <algorithm>
#include <cstdio>
#include <regex>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <google/protobuf/util/json_util.h>
#include <gtest/gtest.h>

#include "patchmill/v1/analysis_service.pb.h"
#include "server/convert/model.h"
#include "tests/service/daemon.h"
#include "tests/service/process.h"
#include "tests/service/requests.h"
#include "tests/support/faced_box.h"
#include "tests/support/faced_turning.h"

namespace patchmill {
namespace {

using namespace std::chrono_literals;
using ::testing::AllOf;
using testing::Daemon;
using ::testing::ElementsAre;
using testing::Finished;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using testing::Process;
using testing::Slurp;
using testing::TempDir;
using ::testing::UnorderedElementsAre;

const std::string kPatchmill = PATCHMILL_BIN "/patchmill";
const std::string kDaemon = PATCHMILL_BIN "/patchmilld";

std::string Json(const v1::PatchModel& model) {
  std::string json;
  EXPECT_TRUE(google::protobuf::util::MessageToJsonString(model, &json).ok());
  return json;
}

Finished Patchmill(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), kPatchmill);
  return testing::Run(arguments);
}

class Cli : public ::testing::Test {
 protected:
  // `patchmill mill MODEL -o OUT/part.ngc ...` with coarse settings.
  Finished Mill(const std::string& model, const std::vector<std::string>& more = {}) {
    std::vector<std::string> arguments = {"mill", model, "-o", out_ / "part.ngc"};
    // Coarse, and with a floor low enough that nothing is out of reach.
    const std::pair<const char*, const char*> defaults[] = {
        {"--scallop", "0.05"}, {"--tolerance", "0.02"}, {"--floor", "-1"}};
    for (const auto& [option, value] : defaults) {
      if (std::find(more.begin(), more.end(), option) == more.end()) {
        arguments.insert(arguments.end(), {option, value});
      }
    }
    arguments.insert(arguments.end(), more.begin(), more.end());
    return Patchmill(arguments);
  }
  TempDir in_, out_;
  std::string bump_ = in_.Write("bump.json", Json(testing::Bump()));
  std::string waves_ = in_.Write("waves.json", Json(testing::HillAndPit()));
  // Minutes of work.
  std::string long_ = in_.Write("long.pb", testing::Bump(380.0).SerializeAsString());
  std::vector<std::string> fine_ = {"--scallop", "0.002", "--tolerance", "0.01", "--tool-diameter", "2"};
};

TEST_F(Cli, MillWritesProgramReportAndPicture) {
  const Finished run = Mill(bump_, {"--report", out_ / "part.json", "--preview", out_ / "part.svg"});
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_THAT(out_.Names(), UnorderedElementsAre("part.ngc", "part.json", "part.svg"));
  const std::string program = Slurp(out_ / "part.ngc");
  EXPECT_THAT(program, AllOf(HasSubstr("G53 G0 Z0"), HasSubstr("G21"), HasSubstr("bump.json")));
  v1::Report report;
  ASSERT_TRUE(google::protobuf::util::JsonStringToMessage(Slurp(out_ / "part.json"), &report).ok());
  EXPECT_EQ(report.outcome(), v1::OUTCOME_COMPLETE);
  EXPECT_EQ(report.program_size_bytes(), static_cast<int>(program.size()));
  EXPECT_THAT(Slurp(out_ / "part.json"), HasSubstr("\"unreachable_area_mm2\": 0"));
  EXPECT_THAT(Slurp(out_ / "part.svg"), HasSubstr("<svg"));
  EXPECT_THAT(run.out, IsEmpty());
  EXPECT_THAT(run.err, AllOf(HasSubstr("COMPLETE, verified"), HasSubstr("assumed: check before start"),
                             HasSubstr("DEFAULT_CUTTING_DATA"), HasSubstr("TOOL_NUMBER_ASSUMED"),
                             HasSubstr("ZERO_ASSUMED"), HasSubstr("STOCK_ASSUMED")));
  EXPECT_THAT(run.err, Not(HasSubstr("\r"))) << "a progress bar in a pipe";
}

// Before the job costs anything, and nothing is written.
TEST_F(Cli, APreviewOfAnotherKindIsRefused) {
  const Finished run = Mill(bump_, {"--preview", out_ / "part.gif"});
  EXPECT_EQ(run.status, 2);
  EXPECT_THAT(run.err, HasSubstr(".svg"));
  EXPECT_THAT(out_.Names(), IsEmpty());
}

TEST_F(Cli, TheShankIsJudgedAndTheStickoutWarnedOf) {
  const Finished slim = Mill(bump_, {"--flute-length", "30", "--shank-diameter", "10", "--stickout", "0.1"});
  EXPECT_EQ(slim.status, 0) << slim.err;
  EXPECT_THAT(slim.err, HasSubstr("STICKOUT_TOO_SHORT"));
  // Half a millimetre above the tip it is wider than the hill is steep.
  const std::vector<std::string> wide = {"--flute-length", "0.5", "--shank-diameter", "30"};
  std::vector<std::string> verify = {
      "verify",  bump_, out_ / "part.ngc", "--tool-diameter", "6", "--tolerance", "0.02",
      "--floor", "-1",  "--no-finish"};
  EXPECT_EQ(Patchmill(verify).status, 0);
  verify.insert(verify.end(), wide.begin(), wide.end());
  const Finished judged = Patchmill(verify);
  EXPECT_EQ(judged.status, 1);
  EXPECT_THAT(judged.out + judged.err, HasSubstr("SHANK_GOUGE"));
}

// An area that only the shank blocks is reported with the flute length that would finish it.
TEST_F(Cli, AWideShankIsPlannedAround) {
  const Finished blunt =
      Mill(bump_, {"--flute-length", "0.5", "--shank-diameter", "30", "--max-unreached", "100"});
  ASSERT_EQ(blunt.status, 0) << blunt.err;
  std::smatch named;
  ASSERT_TRUE(std::regex_search(blunt.err, named, std::regex("SHANK .*--flute-length ([0-9.]+) finishes it")))
      << blunt.err;
  const Finished longer = Mill(bump_, {"--flute-length", named[1], "--shank-diameter", "30"});
  EXPECT_EQ(longer.status, 0);
  EXPECT_THAT(longer.err, AllOf(HasSubstr("verified"), Not(HasSubstr("SHANK"))));
}

// The name of a file may be no valid text. It is cut between characters, and other bytes are replaced.
TEST_F(Cli, ModelsMayHaveAnyName) {
  std::string umlauts;
  for (int i = 0; i < 60; ++i) umlauts += "\u00fc";
  for (const std::string& name :
       {std::string("b\xff\xc3.json"), umlauts + ".json", "x" + umlauts + ".json"}) {
    const std::string model = in_.Write(name, Json(testing::Bump()));
    const Finished run = Mill(model);
    EXPECT_EQ(run.status, 0) << run.err;
    EXPECT_THAT(run.err, Not(HasSubstr("libprotobuf")));
    EXPECT_EQ(Patchmill({"regions", model, "-o", out_ / "map.json"}).status, 0);
  }
  const Finished post = Mill(bump_, {"--post", "\xff"});
  EXPECT_EQ(post.status, 2);
  EXPECT_THAT(post.err, HasSubstr("post.dialect"));
}

TEST_F(Cli, EndlessFilesAreNotReadToTheEnd) {
  const Finished run = Mill("/dev/zero");
  EXPECT_EQ(run.status, 2);
  EXPECT_THAT(run.err, HasSubstr("more than 256 MiB"));
  EXPECT_THAT(out_.Names(), IsEmpty());
}

TEST_F(Cli, QuietSaysNothingOfASuccess) {
  const Finished run = Mill(bump_, {"--quiet"});
  EXPECT_EQ(run.status, 0);
  EXPECT_THAT(run.err + run.out, IsEmpty());
}

// Warnings that hold for every job are left out. Of warnings about patches the first is shown, with printable
// names.
TEST_F(Cli, QuietSaysWarnings) {
  v1::PatchModel twice = testing::Bump();
  for (int i = 0; i < 3; ++i) *twice.add_patches() = twice.patches(0);
  for (int i = 0; i < twice.patches_size(); ++i)
    twice.mutable_patches(i)->set_id("a\x1b[31m\n" + std::to_string(i));
  const std::string model = in_.Write("twice.json", Json(twice));
  for (const std::vector<std::string>& more : {std::vector<std::string>{"--quiet"}, {}}) {
    const Finished run = Mill(model, more);
    EXPECT_EQ(run.status, 0) << run.err;
    EXPECT_THAT(run.err, AllOf(HasSubstr("DUPLICATE_PATCH patch a\\x1b[31m\\x0a"), HasSubstr(", and "),
                               Not(HasSubstr("\x1b"))));
    EXPECT_EQ(run.err.find("STOCK_ASSUMED") == std::string::npos, !more.empty()) << run.err;
  }
}

TEST_F(Cli, VerifyAcceptsWhatMillMadeAndRefusesWhatWasTamperedWith) {
  ASSERT_EQ(Mill(bump_, {"--no-arcs"}).status, 0);  // any line may follow a G1
  const std::vector<std::string> verify = {
      "verify",  bump_, out_ / "part.ngc", "--tool-diameter", "6", "--tolerance", "0.02", "--scallop", "0.05",
      "--floor", "-1",  "--report",        out_ / "v.json"};
  const Finished good = Patchmill(verify);
  EXPECT_EQ(good.status, 0) << good.out << good.err;
  EXPECT_THAT(good.out, HasSubstr("outcome   COMPLETE"));
  EXPECT_THAT(Slurp(out_ / "v.json"), HasSubstr("OUTCOME_COMPLETE"));
  EXPECT_THAT(good.out, Not(HasSubstr("FINISH_NOT_CHECKED")));
  // One cutting move two millimetres lower.
  std::string program = Slurp(out_ / "part.ngc");
  const std::size_t middle = program.find('\n', program.size() / 2) + 1;
  program.insert(middle, "G91\nG1 Z-2\nG90\n");
  in_.Write("bad.ngc", program);
  const Finished bad =
      Patchmill({"verify", bump_, in_ / "bad.ngc", "--tool-diameter", "6", "--tolerance", "0.02"});
  EXPECT_EQ(bad.status, 1);
  EXPECT_THAT(bad.out, AllOf(HasSubstr("VERIFICATION_FAILED"), HasSubstr("gouge     FAILED")));
  EXPECT_THAT(bad.err, HasSubstr("VERIFICATION_FAILED"));
  EXPECT_THAT(bad.out, HasSubstr("FINISH_NOT_CHECKED"));
}

// COMPLETE means that the finish was checked. A program that cuts air passes every other check.
TEST_F(Cli, VerifySaysCompleteOnlyOfAFinishItHasJudged) {
  const std::string air = in_.Write("air.ngc",
                                    "G21 G17 G40 G49 G54 G80 G90 G91.1 G94\nG61\nG53 G0 Z0\nT1 M6\nS9000 M3\n"
                                    "G43 H1\nG0 X0 Y6\nZ9\nG1 Z7 F300\nX12 F900\nG0 Z9\nM5\nG53 G0 Z0\nM2\n");
  const auto verify = [&](const std::vector<std::string>& more) {
    std::vector<std::string> words = {"verify", bump_, air, "--tool-diameter", "6", "--floor", "-1"};
    words.insert(words.end(), more.begin(), more.end());
    return Patchmill(words);
  };
  const Finished open = verify({});
  EXPECT_EQ(open.status, 1);
  EXPECT_THAT(open.out, AllOf(HasSubstr("outcome   NO_GOUGE_FOUND"), HasSubstr("finish    NOT_CHECKED"),
                              HasSubstr("FINISH_NOT_CHECKED"), Not(HasSubstr("COMPLETE"))));
  EXPECT_THAT(open.err, AllOf(HasSubstr("NO_GOUGE_FOUND"), HasSubstr("--scallop"), HasSubstr("--no-finish")));
  const Finished wanted = verify({"--no-finish"});
  EXPECT_EQ(wanted.status, 0) << wanted.err;
  EXPECT_THAT(wanted.out, HasSubstr("outcome   NO_GOUGE_FOUND"));
  const Finished judged = verify({"--scallop", "0.05"});
  EXPECT_EQ(judged.status, 1);
  EXPECT_THAT(judged.out, AllOf(HasSubstr("outcome   VERIFICATION_FAILED"), HasSubstr("ERROR LEFTOVER"),
                                HasSubstr("gouge     PASSED")));
  EXPECT_EQ(verify({"--scallop", "0.05", "--no-finish"}).status, 2);
}

// An F beside G20 or G21 is in the unit that was in force before. Settings that no word has stated are named.
TEST_F(Cli, UnitsAndArcsAreReadAsAControlReadsThem) {
  const std::string folder = std::string(PATCHMILL_SOURCE_DIR) + "/tests/models/gcode/";
  const auto verify = [&](const std::string& name) {
    return Patchmill({"verify", folder + "plate.json", folder + name + ".ngc", "--tool-diameter", "6",
                      "--plunge-feed", "400", "--no-finish"});
  };
  const Finished same = verify("a_same_line");
  EXPECT_EQ(same.status, 1);
  EXPECT_THAT(same.out, AllOf(HasSubstr("VERIFICATION_FAILED"), HasSubstr("STEEP_DESCENT"),
                              HasSubstr("7620 mm/min"), HasSubstr("FEED_IN_UNIT_BEFORE")));
  const Finished own = verify("b_own_line");
  EXPECT_EQ(own.status, 0) << own.out << own.err;
  EXPECT_THAT(own.out, Not(HasSubstr("FEED_IN_UNIT_BEFORE")));
  EXPECT_THAT(own.out, Not(HasSubstr("ASSUMED")));
  const Finished first = verify("c_first_line");
  EXPECT_EQ(first.status, 0) << first.out << first.err;
  EXPECT_THAT(first.out, AllOf(HasSubstr("WARNING UNITS_ASSUMED: line 1: "), HasSubstr("mm/min")));
  const Finished arc = verify("no_arc_mode");
  EXPECT_EQ(arc.status, 0) << arc.out << arc.err;
  EXPECT_THAT(arc.out, AllOf(HasSubstr("WARNING ARC_MODE_ASSUMED: line 10: "), HasSubstr("G91.1")));
}

// A verdict under assumptions says so.
TEST_F(Cli, VerifyNamesItsAssumptionsAndTakesThoseOfTheUser) {
  const std::string silent = in_.Write("silent.ngc",
                                       "G53 G0 Z-5\nT1 M6\nS9000 M3\nG0 X0 Y6\nZ9\nG1 Z7 F300\nX12 F900\n"
                                       "G0 Z9\nM5\nG91 G28 Z0\nM2\n");
  const auto verify = [&](const std::vector<std::string>& more) {
    std::vector<std::string> words = {"verify", bump_, silent, "--no-finish"};
    words.insert(words.end(), more.begin(), more.end());
    return Patchmill(words);
  };
  const std::vector<std::string> tool = {"--tool-diameter", "6"};
  const Finished open = verify(tool);
  EXPECT_EQ(open.status, 1);
  EXPECT_THAT(open.out, AllOf(HasSubstr("CONTROL_SMOOTHING"), HasSubstr("PATH_MODE_ASSUMED: line 6")));
  const Finished exact =
      verify({"--tool", "1=6", "--assume", "path=exact", "--tolerance-map", out_ / "left.png"});
  EXPECT_THAT(Slurp(out_ / "left.csv"), HasSubstr("x_mm,y_mm,z_mm,leftover_mm,patch\n"));
  EXPECT_THAT(Slurp(out_ / "left.png"), HasSubstr("IHDR"));
  EXPECT_EQ(exact.status, 0) << exact.out << exact.err;
  EXPECT_THAT(exact.out, HasSubstr("only under MACHINE_Z_ASSUMED, UNITS_ASSUMED, DISTANCE_MODE_ASSUMED, "
                                   "WORK_OFFSET_ASSUMED, LENGTH_OFFSET_ASSUMED, PATH_MODE_ASSUMED, "
                                   "REFERENCE_ASSUMED"));
  const Finished low = verify({"--tool-diameter", "6", "--machine-z-safe", "-4"});
  EXPECT_EQ(low.status, 2);
  EXPECT_THAT(low.err, HasSubstr("line 1: G53 with Z below machine Z-4"));
  EXPECT_EQ(verify({"--assume", "path=smooth"}).status, 2);
  EXPECT_THAT(verify({}).err, HasSubstr("--tool-diameter is missing"));
  EXPECT_THAT(verify({"--tool", "6"}).err, HasSubstr("must be NUMBER=DIAMETER"));
  EXPECT_THAT(verify({"--tool", "1=6", "--tool", "1=4"}).err, HasSubstr("another tool has it"));
  EXPECT_THAT(verify({"--tool", "ball=6", "--tool", "Ball=4"}).err, HasSubstr("that of another tool"));
  EXPECT_THAT(verify({"--tool", "=6"}).err, HasSubstr("must be NUMBER=DIAMETER"));
}

// A program for Siemens that calls its tools by their names: the first cuts, the second stays above.
TEST_F(Cli, VerifyTakesToolsByName) {
  ASSERT_EQ(Mill(bump_, {"--post", "siemens"}).status, 0);
  std::string program = Slurp(out_ / "part.ngc");
  const std::size_t call = program.find("\nT1");
  ASSERT_NE(call, std::string::npos);
  program.replace(call, 3, "\nT=\"BALL_6\"");
  const std::string named = out_.Write("named.mpf", program);
  const auto verify = [&](const std::vector<std::string>& tools) {
    std::vector<std::string> words = {"verify", bump_,         named,  "--dialect", "siemens", "--scallop",
                                      "0.05",   "--tolerance", "0.02", "--floor",   "-1"};
    for (const std::string& tool : tools) words.insert(words.end(), {"--tool", tool});
    return Patchmill(words);
  };
  const Finished right = verify({"ball_6=6", "ball_3=3"});
  EXPECT_EQ(right.status, 0) << right.out << right.err;
  EXPECT_THAT(right.out, Not(HasSubstr("TOOL_NAME_ASSUMED")));
  // With the sizes exchanged the finish is too coarse.
  EXPECT_EQ(verify({"ball_6=3", "ball_3=6"}).status, 1);
  const Finished unknown = verify({"ball_8=8", "ball_3=3"});
  EXPECT_EQ(unknown.status, 2) << unknown.err;
  EXPECT_THAT(unknown.err, HasSubstr("\"BALL_6\" is none of the tools"));
}

// The share that is not reached is that of the report.
TEST_F(Cli, MillSaysHowMuchIsNotReached) {
  const Finished whole = Mill(bump_, {"--quiet"});
  ASSERT_EQ(whole.status, 0) << whole.err;
  EXPECT_THAT(whole.err, Not(HasSubstr("not reached")));
  const Finished run = Mill(bump_, {"--quiet", "--floor", "0", "--report", out_ / "part.json"});
  ASSERT_EQ(run.status, 0) << run.err;
  v1::Report report;
  ASSERT_TRUE(google::protobuf::util::JsonStringToMessage(Slurp(out_ / "part.json"), &report).ok());
  ASSERT_EQ(report.unreachable_size(), 1);
  const double share = 100.0 * report.unreachable_area_mm2() / report.total_area_mm2();
  ASSERT_GT(share, 0.1);
  char text[100];
  std::snprintf(text, sizeof(text), "not reached: %.1f %% of the area (FLOOR %.1f %%): FLOOR %.2f mm2", share,
                share, report.unreachable_area_mm2());
  EXPECT_THAT(run.err, HasSubstr(text));
  EXPECT_NEAR(report.unreachable_area_mm2() + report.reachable_area_mm2(), report.total_area_mm2(), 1e-6);
  const Finished none = Mill(bump_, {"--floor", "50"});
  EXPECT_EQ(none.status, 1);
  EXPECT_THAT(none.err, HasSubstr("not reached: 100.0 % of the area (FLOOR 100.0 %)"));
}

// A model in the wrong unit.
TEST_F(Cli, APartSmallerThanAStepIsNothingToCut) {
  const Finished run = Mill(bump_, {"--scale", "0.001"});
  EXPECT_EQ(run.status, 1);
  EXPECT_THAT(run.err,
              AllOf(HasSubstr("NOTHING_TO_CUT"), HasSubstr("--scale"), HasSubstr("no program was written")));
  EXPECT_THAT(out_.Names(), IsEmpty());
}

// Strange or unused cutting data are reported by the names of the options.
TEST_F(Cli, OddSettingsAreToldByTheirOptions) {
  const Finished run = Mill(bump_, {"--quiet", "--feed", "900", "--plunge-feed", "1000", "--flute-length",
                                    "10", "--strategy", "contour", "--bend", "0"});
  EXPECT_EQ(run.status, 0) << run.err;
  EXPECT_THAT(run.err, AllOf(HasSubstr("PLUNGE_FEED_ABOVE_FEED"), HasSubstr("--flute-length: "),
                             HasSubstr("--bend: ")));
  const Finished eye = Patchmill({"lines", bump_, "--kind", "eye", "-o", out_ / "l.json"});
  EXPECT_EQ(eye.status, 2);
  EXPECT_THAT(eye.err, HasSubstr("--eye: "));
}

TEST_F(Cli, EveryFormatOfTheReadmeIsReadByItsEnding) {
  const std::string models = PATCHMILL_SOURCE_DIR "/tests/models/";
  for (const char* name : {"bicubic.bez", "sphere.bv", "teacup.bpt", "toroidal_tet.patches"}) {
    const Finished run = Patchmill({"check", models + name});
    EXPECT_EQ(run.status, 0) << name << run.err;
    EXPECT_THAT(run.err + run.out, Not(HasSubstr("MODEL_UNREADABLE"))) << name;
  }
  EXPECT_EQ(Patchmill({"check", in_.Write("bump.pb", testing::Bump().SerializeAsString())}).status, 0);
  const Finished weight = Patchmill({"check", models + "malformed/zero_weight.bez"});
  EXPECT_EQ(weight.status, 2);
  EXPECT_THAT(weight.err, HasSubstr("ZERO_WEIGHT"));
}

// An area that only the floor blocks is reported with the floor that would finish it.
TEST_F(Cli, TheFloorThatIsNamedFinishes) {
  const Finished high = Mill(bump_, {"--floor", "0.3"});
  ASSERT_EQ(high.status, 0) << high.err;
  std::smatch named;
  ASSERT_TRUE(std::regex_search(high.err, named, std::regex("FLOOR .*--floor (-?[0-9.]+) finishes it")))
      << high.err;
  EXPECT_LT(std::stod(named[1]), 0.0);  // the border, finished from the side
  const Finished low = Mill(bump_, {"--floor", named[1]});
  EXPECT_EQ(low.status, 0);
  EXPECT_THAT(low.err, AllOf(HasSubstr("COMPLETE, verified"), Not(HasSubstr("FLOOR"))));
}

TEST_F(Cli, CheckPrintsTheModelAndFailsOnErrors) {
  const Finished good = Patchmill({"check", bump_});
  EXPECT_EQ(good.status, 0) << good.err;
  EXPECT_THAT(good.out,
              AllOf(HasSubstr("patches      1"), HasSubstr("4 open"), HasSubstr("OPEN_EDGE patch bump")));
  v1::PatchModel model = testing::Bump();
  model.mutable_patches(0)->mutable_bezier()->set_points(0, 1e300);
  const Finished bad = Patchmill({"check", in_.Write("bad.pb", model.SerializeAsString())});
  EXPECT_EQ(bad.status, 1);
  EXPECT_THAT(bad.out, HasSubstr("ERROR TOO_LARGE patch bump"));
}

// A box of faces with several patches each. Every command speaks of the faces.
TEST_F(Cli, FacesAreListedSelectedAndNamed) {
  const std::string box = in_.Write("box.json", Json(ToProto(testing::FacedBox(10.0, 2))));
  const Finished list = Patchmill({"faces", box, "-o", out_ / "faces.svg"});
  ASSERT_EQ(list.status, 0) << list.err;
  EXPECT_THAT(list.out, AllOf(HasSubstr("f1"), HasSubstr("plane"), HasSubstr("100.0000"), HasSubstr("180.0"),
                              HasSubstr("\"lid\", body BOX"), HasSubstr("#ff0000")));
  EXPECT_EQ(std::count(list.out.begin(), list.out.end(), '\n'), 7);
  EXPECT_THAT(Slurp(out_ / "faces.svg"), AllOf(HasSubstr("<svg"), HasSubstr(">f2<")));
  const Finished check = Patchmill({"check", box});
  EXPECT_EQ(check.status, 0) << check.err;
  EXPECT_THAT(
      check.out,
      AllOf(
          HasSubstr("faces        6"), HasSubstr("24 joined, 0 open"), HasSubstr("findings     12"),
          HasSubstr("120 mm stick out, 0 mm are inner corners"),
          HasSubstr("--up z            100.0 mm2 look up, 0.0 of them are hidden; 1 level face; shows most"),
          HasSubstr("--up -x "), HasSubstr("TANGENT_BREAK face f1: face f1 meets face f3 (wall)")));
  const Finished regions = Patchmill({"regions", box, "--only", "name=lid", "-o", out_ / "regions.json"});
  EXPECT_EQ(regions.status, 0) << regions.err;
  EXPECT_THAT(regions.out, HasSubstr("; on f2"));
  EXPECT_THAT(Slurp(out_ / "regions.json"), HasSubstr("face_ids"));
  const Finished mill = Mill(box, {"--only", "f2", "--report", out_ / "part.json"});
  EXPECT_EQ(mill.status, 0) << mill.err;
  EXPECT_THAT(Slurp(out_ / "part.json"), HasSubstr("\"face_id\": \"f2\""));
  const Finished wrong = Mill(box, {"--only", "kind=cone"});
  EXPECT_EQ(wrong.status, 2);
  EXPECT_THAT(wrong.err, HasSubstr("--only"));
  EXPECT_THAT(wrong.err, HasSubstr("kind is one of plane"));
  const Finished none = Patchmill({"faces", bump_});
  EXPECT_EQ(none.status, 1);
  EXPECT_THAT(none.err, HasSubstr("the model has patches, but no faces"));
}

// A disc with a counterbored hole, by name and in the figures of its closed form.
TEST_F(Cli, CheckListsConcaveFacesAndHoles) {
  using testing::Bore, testing::Pin, testing::Ring;
  const PatchModel disc = testing::TurnedPart(
      {Pin(20, 0, 10), Ring(20, 5, 10), Bore(5, 10, 6), Ring(5, 3, 6), Bore(3, 6, 0), Ring(3, 20, 0)});
  const Finished check = Patchmill({"check", in_.Write("disc.json", Json(ToProto(disc)))});
  EXPECT_EQ(check.status, 0) << check.err;
  EXPECT_THAT(check.out, AllOf(HasSubstr("cylinder R 3        ball D 6           1 face       113.1 mm2  f5"),
                               HasSubstr("cylinder R 5        ball D 10          1 face      125.66 mm2  f3"),
                               HasSubstr("smallest radius 3 mm, not tighter than the ball's 3 mm"),
                               HasSubstr("holes        2\n"),
                               HasSubstr("  1 x diameter 10, depth 4, down to a step, along -Z: f3\n"),
                               HasSubstr("  1 x diameter 6, depth 6, open at both ends, along -Z: f5\n")));
  const Finished plain = Patchmill({"check", bump_});
  EXPECT_THAT(plain.out, ::testing::Not(HasSubstr("holes")));
}

TEST_F(Cli, ANetworkIsCheckedJointByJointAndMilled) {
  const std::string mouse = PATCHMILL_SOURCE_DIR "/examples/mouse.json";
  const Finished check = Patchmill({"check", mouse, "--continuity", "100"});
  EXPECT_EQ(check.status, 0) << check.err;
  EXPECT_THAT(check.out, HasSubstr("patches      32"));
  int joints = 0;
  for (std::size_t at = 0; (at = check.out.find("joint  ", at)) != std::string::npos; ++at) ++joints;
  EXPECT_EQ(joints, 54);
  EXPECT_THAT(check.out, HasSubstr("and a part of edge"));
  const Finished mill = Mill(mouse, {"--tool-diameter", "10", "--scallop", "0.1", "--floor", "-20"});
  EXPECT_EQ(mill.status, 0) << mill.err;
  EXPECT_THAT(mill.err, HasSubstr("verified"));
}

TEST_F(Cli, RegionsWritesJsonOrPicture) {
  ASSERT_EQ(Patchmill({"regions", bump_, "-o", out_ / "r.json"}).status, 0);
  v1::SplitRegionsResponse response;
  ASSERT_TRUE(google::protobuf::util::JsonStringToMessage(Slurp(out_ / "r.json"), &response).ok());
  EXPECT_GE(response.regions().regions_size(), 1);
  ASSERT_EQ(Patchmill({"regions", bump_, "-o", out_ / "r.svg"}).status, 0);
  EXPECT_THAT(Slurp(out_ / "r.svg"), HasSubstr("<svg"));
  std::vector<int> counts;
  for (const char* detail : {"0", "1"}) {
    ASSERT_EQ(Patchmill({"regions", waves_, "-o", out_ / "detail.json", "--floor", "-5", "--detail", detail})
                  .status,
              0);
    ASSERT_TRUE(google::protobuf::util::JsonStringToMessage(Slurp(out_ / "detail.json"), &response).ok());
    counts.push_back(response.regions().regions_size());
  }
  EXPECT_GT(counts[1], counts[0]);
  const Finished other = Patchmill({"regions", bump_, "-o", out_ / "r.gif"});
  EXPECT_EQ(other.status, 2);
  EXPECT_THAT(other.err, HasSubstr("must end in .json or .svg"));
}

// A clamp is kept off by the shank where that is wider, on the map too.
TEST_F(Cli, RegionsKnowTheShank) {
  const std::vector<std::string> limits = {
      "--floor",        "-5", "--obstacle",       "clamp=30: -10,-10 2,-10 2,2 -10,2",
      "--flute-length", "25", "--shank-diameter", "12"};
  std::vector<std::string> list = {"regions", waves_, "-o", out_ / "r.json"};
  list.insert(list.end(), limits.begin(), limits.end());
  ASSERT_EQ(Patchmill(list).status, 0);
  std::vector<std::string> off = {"--region", "0:off", "--regions", out_ / "r.json"};
  off.insert(off.end(), limits.begin(), limits.end());
  const Finished mill = Mill(waves_, off);
  EXPECT_EQ(mill.status, 0) << mill.err;
  EXPECT_THAT(mill.err, AllOf(HasSubstr("skipped   regions 0 ("), HasSubstr("AVOIDED")));
}

TEST_F(Cli, RapidsAreLowWhereTheStockIsStated) {
  const std::vector<std::string> lines = {"--floor", "-5", "--one-way"};
  const auto with = [&](std::vector<std::string> more) {
    more.insert(more.end(), lines.begin(), lines.end());
    return more;
  };
  const auto rapid_length = [&](std::vector<std::string> more) {
    more.insert(more.end(), {"--report", out_ / "r.json"});
    const Finished mill = Mill(waves_, with(std::move(more)));
    EXPECT_EQ(mill.status, 0) << mill.err;
    v1::Report report;
    EXPECT_TRUE(google::protobuf::util::JsonStringToMessage(Slurp(out_ / "r.json"), &report).ok());
    return report.rapid_length_mm();
  };
  const double high = rapid_length({"--allowance", "0.3", "--high-rapids"});
  EXPECT_LT(rapid_length({"--allowance", "0.3"}), 0.8 * high);
  EXPECT_EQ(rapid_length({"--low-rapids"}), rapid_length({}));
}

// A whole block needs roughing, or its depth accepted, by mill and verify alike.
TEST_F(Cli, StockThatIsTooDeepEndsTheJob) {
  const std::vector<std::string> block = {"--stock", "block,4", "--stock-top", "12", "--floor", "-5"};
  const auto with = [&](std::vector<std::string> more) {
    more.insert(more.end(), block.begin(), block.end());
    return more;
  };
  const Finished whole = Mill(waves_, with({}));
  EXPECT_EQ(whole.status, 1);
  EXPECT_THAT(whole.err, AllOf(HasSubstr("NEEDS_ROUGHING"), HasSubstr("--accept-depth"),
                               HasSubstr("no program was written")));
  const Finished accepted = Mill(waves_, with({"--accept-depth", "40"}));
  ASSERT_EQ(accepted.status, 0) << accepted.err;
  EXPECT_THAT(Slurp(out_ / "part.ngc"), HasSubstr("DEPTH_ACCEPTED"));
  const auto verify = [&](const std::vector<std::string>& more) {
    std::vector<std::string> words = {"verify",      waves_, out_ / "part.ngc", "--tool-diameter", "6",
                                      "--tolerance", "0.02", "--no-finish"};
    words.insert(words.end(), more.begin(), more.end());
    return Patchmill(with(words));
  };
  EXPECT_EQ(verify({"--accept-depth", "40"}).status, 0);
  const Finished shallow = verify({});
  EXPECT_EQ(shallow.status, 1);
  EXPECT_THAT(shallow.out, HasSubstr("CUT_TOO_DEEP"));
  for (const char* wrong : {"foo", "cylinder", "cylinder,1,2", "block,x", "outline: 1,2 3,4"}) {
    const Finished refused = Mill(waves_, {"--stock", wrong});
    EXPECT_EQ(refused.status, 2) << wrong << refused.err;
    EXPECT_THAT(refused.err, HasSubstr("--stock")) << wrong;
  }
}

TEST_F(Cli, TheHolderIsJudged) {
  const std::vector<std::string> holder = {"--stickout", "1", "--holder", "10,40 20,40,60"};
  std::vector<std::string> whatever = holder;
  whatever.insert(whatever.end(), {"--max-unreached", "100"});
  const Finished mill = Mill(bump_, whatever);
  EXPECT_EQ(mill.status, 0) << mill.err;
  EXPECT_THAT(mill.err + mill.out, AllOf(HasSubstr("HOLDER"), HasSubstr("--stickout"),
                                         ::testing::Not(HasSubstr("HOLDER_NOT_CHECKED"))));
  ASSERT_EQ(Mill(bump_).status, 0);
  std::vector<std::string> verify = {
      "verify",  bump_, out_ / "part.ngc", "--tool-diameter", "6", "--tolerance", "0.02",
      "--floor", "-1",  "--no-finish"};
  EXPECT_EQ(Patchmill(verify).status, 0);
  verify.insert(verify.end(), holder.begin(), holder.end());
  const Finished judged = Patchmill(verify);
  EXPECT_EQ(judged.status, 1);
  EXPECT_THAT(judged.out + judged.err, HasSubstr("HOLDER_GOUGE"));
  for (const char* wrong : {"10", "10,40,50,60", "10,x", "10;40"}) {
    const Finished refused = Mill(bump_, {"--stickout", "30", "--holder", wrong});
    EXPECT_EQ(refused.status, 2) << wrong << refused.err;
    EXPECT_THAT(refused.err, HasSubstr("--holder")) << wrong;
  }
  EXPECT_THAT(Mill(bump_, {"--holder", "10,40"}).err, HasSubstr("--stickout"));
}

TEST_F(Cli, TheTextHelpsTheOperator) {
  const Finished mill = Mill(waves_, {"--floor", "-5", "--restart-points", "--line-numbers", "5"});
  ASSERT_EQ(mill.status, 0) << mill.err;
  const std::string text = Slurp(out_ / "part.ngc");
  EXPECT_THAT(text,
              AllOf(HasSubstr("(section 1, region "), HasSubstr("(restart point 1: "), HasSubstr("\nN5 ")));
  const Finished verify = Patchmill({"verify", waves_, out_ / "part.ngc", "--tool-diameter", "6", "--floor",
                                     "-5", "--scallop", "0.4", "--tolerance", "0.02"});
  EXPECT_EQ(verify.status, 0) << verify.out << verify.err;
  EXPECT_EQ(Mill(waves_, {"--line-numbers", "1001"}).status, 2);
}

TEST_F(Cli, TooMuchUnreachedEndsTheJob) {
  const Finished refused = Mill(waves_, {"--tool-diameter", "60", "--max-unreached", "1"});
  EXPECT_EQ(refused.status, 1);
  EXPECT_THAT(refused.err, AllOf(HasSubstr("TOO_MUCH_UNREACHED"), HasSubstr("no program was written")));
  EXPECT_EQ(Mill(waves_, {"--tool-diameter", "60", "--max-unreached", "100"}).status, 0);
  const Finished wrong = Mill(waves_, {"--max-unreached", "150"});
  EXPECT_EQ(wrong.status, 2);
  EXPECT_THAT(wrong.err, HasSubstr("--max-unreached"));
}

TEST_F(Cli, TheMachineLimitsTheProgramAndTimesIt) {
  const auto machine = [&](double half, double acceleration) {
    std::string axes;
    for (int k = 0; k < 3; ++k) {
      axes += fmt::format(
          "{}{{\"travel_min_mm\": {}, \"travel_max_mm\": {}, \"rapid_mm_per_min\": 8000, "
          "\"feed_mm_per_min\": 4000, \"acceleration_mm_per_s2\": {}}}",
          k == 0 ? "" : ", ", -half, half, acceleration);
    }
    return in_.Write("machine.json", "{\"name\": \"m\", \"axes\": [" + axes + "]}");
  };
  const auto seconds = [&](std::vector<std::string> more) {
    more.insert(more.end(), {"--report", out_ / "r.json"});
    const Finished mill = Mill(waves_, more);
    EXPECT_EQ(mill.status, 0) << mill.err;
    v1::Report report;
    EXPECT_TRUE(google::protobuf::util::JsonStringToMessage(Slurp(out_ / "r.json"), &report).ok());
    double sum = 0.0;
    for (const v1::TimeOfKind& part : report.times_of_kinds()) sum += part.time_s();
    if (report.times_of_kinds_size() > 0) {
      EXPECT_NEAR(sum, report.estimated_time_s(), 1e-6 * sum);
    }
    return report.estimated_time_s();
  };
  const double quick = seconds({"--machine", machine(500, 5000)});
  EXPECT_GT(seconds({"--machine", machine(500, 50)}), 1.2 * quick);
  const Finished small = Mill(waves_, {"--machine", machine(5, 500)});
  EXPECT_EQ(small.status, 1);
  EXPECT_THAT(small.err, HasSubstr("BEYOND_TRAVEL"));
  const Finished broken = Mill(waves_, {"--machine", in_.Write("machine.json", "{\"axes\": 3}")});
  EXPECT_EQ(broken.status, 2);
  EXPECT_THAT(broken.err, HasSubstr("--machine"));
  EXPECT_THAT(Mill(waves_, {"--machine", in_.Write("machine.json", "{}")}).err, HasSubstr("must have 3"));
}

// Regions are listed with ids, switched off by id or by point, and verified alike.
TEST_F(Cli, RegionsAreListedSwitchedOffAndJudged) {
  const std::vector<std::string> split = {"--floor", "-5", "--tolerance", "0.02"};
  const auto with = [&](std::vector<std::string> arguments, std::vector<std::string> more = {}) {
    arguments.insert(arguments.end(), split.begin(), split.end());
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
  };
  const Finished list = Patchmill(with({"regions", waves_, "-o", out_ / "r.json"}));
  ASSERT_EQ(list.status, 0) << list.err;
  EXPECT_THAT(list.out, AllOf(HasSubstr("regions sha256 "), HasSubstr("MOUNTAIN, GENTLE")));
  v1::SplitRegionsResponse response;
  ASSERT_TRUE(google::protobuf::util::JsonStringToMessage(Slurp(out_ / "r.json"), &response).ok());
  const auto& regions = response.regions().regions();
  ASSERT_GE(regions.size(), 2);

  const std::string map = out_ / "r.json";
  const Finished off = Mill(waves_, with({"--region", "0:off", "--regions", map}));
  ASSERT_EQ(off.status, 0) << off.err;
  EXPECT_THAT(off.err, HasSubstr("skipped   regions 0 ("));
  const std::vector<std::string> verify = {"verify",    waves_, out_ / "part.ngc", "--tool-diameter", "6",
                                           "--scallop", "0.05"};
  EXPECT_EQ(Patchmill(with(verify)).status, 1);
  const Finished judged = Patchmill(with(verify, {"--region", "0:off", "--regions", map}));
  EXPECT_EQ(judged.status, 0) << judged.out;

  // The point in the list names the same region. The digest can replace the file.
  const v1::Point3& p = regions[0].inside_point();
  const std::string at =
      std::to_string(p.x_mm()) + "," + std::to_string(p.y_mm()) + "," + std::to_string(p.z_mm());
  EXPECT_EQ(Patchmill(with(verify, {"--region", at + ":off"})).status, 0);
  const std::string sum = list.out.substr(15, 64);
  const Finished own =
      Patchmill(with({"regions", waves_}, {"--region", "1:zigzag:angle=30:scallop=0.02", "--regions", sum}));
  EXPECT_EQ(own.status, 0) << own.err;
  EXPECT_THAT(own.out, HasSubstr("ZIGZAG 30 deg, scallop 0.02"));

  const Finished open = Patchmill({"regions", bump_, "--zigzag-angle", "15", "--region", "6,6,1.125:oneway"});
  EXPECT_EQ(open.status, 0) << open.err;
  EXPECT_THAT(open.out, HasSubstr("ZIGZAG 15 deg one way"));

  const Finished stale =
      Patchmill({"regions", waves_, "--detail", "0", "--region", "0:off", "--regions", map});
  EXPECT_EQ(stale.status, 1);
  EXPECT_THAT(stale.err, AllOf(HasSubstr("--regions: regions_sha256"), HasSubstr("ask for them again")));
}

struct Wrong {
  const char* name;
  std::vector<std::string> options;
  const char* message;
};

class WrongUsage : public Cli, public ::testing::WithParamInterface<Wrong> {};

TEST_P(WrongUsage, IsStatusTwoWithAReasonAndNoFile) {
  const Finished run = Mill(bump_, GetParam().options);
  EXPECT_EQ(run.status, 2) << run.err;
  EXPECT_THAT(run.err, HasSubstr(GetParam().message));
  EXPECT_THAT(out_.Names(), IsEmpty());
}

INSTANTIATE_TEST_SUITE_P(
    All, WrongUsage,
    ::testing::Values(
        Wrong{"UnknownOption", {"--no-such-option", "3"}, "--no-such-option"},
        Wrong{"UnknownPost",
              {"--post", "klingon"},
              "--post: post.dialect = \"klingon\"; must be one of: fanuc, grbl,"},
        Wrong{"ToolZero",
              {"--tool-diameter", "0"},
              "--tool-diameter: job.operations[0].tool.ball_end.diameter_mm = 0"},
        Wrong{"ShankWithoutFlutes",
              {"--shank-diameter", "20"},
              "--flute-length: job.operations[0].tool.flute_length_mm is missing"},
        Wrong{
            "StickoutNegative", {"--stickout", "-1"}, "--stickout: job.operations[0].tool.stickout_mm = -1"},
        Wrong{"ToolAbsurd", {"--tool-diameter", "1e9"}, "must be in [0.02, 1000]"},
        Wrong{"ScallopAboveRadius",
              {"--tool-diameter", "1", "--scallop", "0.6"},
              "--scallop: job.operations[0].scallop_mm = 0.6; must be in (0, ball radius = 0.5)"},
        Wrong{"ScallopNan", {"--leave", "nan"}, "--leave: \"nan\" is not a finite number"},
        Wrong{"Infinite", {"--floor", "inf"}, "not a finite number"},
        Wrong{"NotANumber", {"--allowance", "abc"}, "--allowance"},
        Wrong{"LeaveNegative",
              {"--leave", "-0.1"},
              "--leave: job.operations[0].stock_to_leave_mm is not there yet"},
        Wrong{"Zero",
              {"--zero", "middle"},
              "--zero middle; must be X,Y,Z, origin, top-center or bottom-corner"},
        Wrong{"ZeroNan", {"--zero", "0,nan,0"}, "--zero"},
        Wrong{"Translate", {"--translate", "1,2"}, "--translate"}, Wrong{"Up", {"--up", "w"}, "--up"},
        Wrong{"Angle", {"--zigzag-angle", "automatic"}, "--zigzag-angle"},
        Wrong{"AngleHuge",
              {"--zigzag-angle", "400"},
              "--zigzag-angle: job.operations[0].zigzag_angle_deg = 400"},
        Wrong{"RegionWithoutMap", {"--region", "3:off"}, "--regions MAP.json"},
        Wrong{"RegionWord", {"--region", "0,0,0:of"}, "--region \"0,0,0:of\"; must be ID or X,Y,Z and then"},
        Wrong{"RegionAlone", {"--region", "0,0,0"}, "must be ID or X,Y,Z and then"},
        Wrong{"RegionNumber", {"--region", "0,0,0:scallop=much"}, "must be ID or X,Y,Z and then"},
        Wrong{"RegionInTheAir",
              {"--region", "0,0,50:off"},
              "--region: job.operations[0].region_overrides[0].at = 0.0"},
        Wrong{"RegionScallop",
              {"--region", "0,0,0:scallop=5"},
              "--region: job.operations[0].region_overrides[0].scallop_mm = 5"},
        Wrong{"RegionsFile", {"--region", "0:off", "--regions", "no/such"}, "cannot read no/such"},
        Wrong{"Detail", {"--detail", "2"}, "--detail"},
        Wrong{"Strategy", {"--strategy", "spiral"}, "--strategy"},
        Wrong{"Coolant", {"--coolant", "beer"}, "--coolant"},
        Wrong{"WorkOffset", {"--work-offset", "G99"}, "--work-offset: post.work_offset"},
        Wrong{"BoundaryPoint", {"--boundary", "0,0 1,0 1"}, "--boundary: \"1\"; must be points X,Y"},
        Wrong{"BoundaryShort", {"--boundary", "0,0 1,0"}, "--boundary has 2 points; must have at least 3"},
        Wrong{"BoundaryFile", {"--boundary", "@no/such/file"}, "cannot read no/such/file"},
        Wrong{"BoundaryMode", {"--boundary-mode", "edge"}, "--boundary-mode"},
        Wrong{"BoundaryFlat", {"--boundary", "0,0 1,1 2,2"}, "--boundary: job.operations[0].selection"},
        Wrong{"BoundaryOffset", {"--boundary-offset", "1"}, "--boundary-offset is given without --boundary"},
        Wrong{"BoundaryModeAlone", {"--boundary-mode", "inside"}, "--boundary-mode requires --boundary"},
        Wrong{"AvoidMargin", {"--avoid-margin", "1"}, "--avoid-margin is given without --avoid"},
        Wrong{"RegionTwice", {"--region", "0:contour:zigzag"}, "one of a kind"},
        Wrong{"Obstacle", {"--obstacle", "0,0 1,0 1,1"}, "must be [NAME=]TOP[,MARGIN]: X,Y X,Y X,Y"},
        Wrong{"ObstacleMargin",
              {"--obstacle", "vice=5,-1: 0,0 1,0 1,1"},
              "--obstacle: job.setup.obstacles[0].margin_mm = -1"},
        Wrong{"OnlyWhatIsThere",
              {"--only", "lid"},
              "--only: job.operations[0].selection.patch_ids[0] = \"lid\"; must be a patch id"},
        Wrong{"AvoidWhatIsThere",
              {"--avoid", "#-1"},
              "--avoid: job.operations[0].selection.avoid_patch_ids[0] = \"#-1\""},
        Wrong{"StockBelowModel", {"--stock-top", "-5"}, "stock.top_z_mm = -5"},
        Wrong{"Threads", {"--threads", "1000"}, "--threads"},
        Wrong{"Timeout", {"--timeout", "0"}, "--timeout"},
        Wrong{"HalfATlsPair",
              {"--server", "127.0.0.1:1", "--cert", "x.pem"},
              "--cert and --key belong together"},
        Wrong{"ScaleZero", {"--scale", "0"}, "--scale: job.setup.scale = 0"}),
    [](const auto& wrong) { return std::string(wrong.param.name); });

TEST_F(Cli, LinesAreWrittenAsDataOrAsAPicture) {
  const Finished json =
      Patchmill({"lines", bump_, "-o", out_ / "lines.json", "--kind", "contour", "--levels", "0.5"});
  EXPECT_EQ(json.status, 0) << json.err;
  EXPECT_THAT(json.out, HasSubstr("CONTOUR            level 0.5             1 lines,    1 of them closed"));
  EXPECT_THAT(Slurp(out_ / "lines.json"), HasSubstr("\"kind\": \"LINE_KIND_CONTOUR\""));
  const Finished svg = Patchmill(
      {"lines", bump_, "-o", out_ / "lines.svg", "--kind", "slope,silhouette", "--count", "4", "--quiet"});
  EXPECT_EQ(svg.status, 0) << svg.err;
  EXPECT_EQ(svg.out, "");
  EXPECT_THAT(Slurp(out_ / "lines.svg"), HasSubstr("<svg"));
  EXPECT_EQ(Patchmill({"lines", bump_, "-o", out_ / "lines.txt"}).status, 2);
  EXPECT_EQ(Patchmill({"lines", bump_, "-o", out_ / "l.svg", "--kind", "rainbow"}).status, 2);
  const Finished levels =
      Patchmill({"lines", bump_, "-o", out_ / "l.svg", "--kind", "slope,contour", "--levels", "5"});
  EXPECT_EQ(levels.status, 2);
  EXPECT_THAT(levels.err, HasSubstr("--levels belong to one --kind"));
  EXPECT_EQ(Patchmill({"lines", bump_, "-o", out_ / "l.svg", "--kind", "eye"}).status, 2);
}

// z = (x^2 + y^2) / 20 over [-10, 10]^2: curvatures 0.1 at the vertex.
TEST_F(Cli, EvaluateTellsPointsAndCurvatures) {
  out_.Write(
      "bowl.json",
      R"({"length_unit": "LENGTH_UNIT_MILLIMETER", "patches": [{"bezier": {"degree_u": 2, "degree_v": 2,
  "points": [-10,-10,10, -10,0,0, -10,10,10, 0,-10,0, 0,0,-10, 0,10,0, 10,-10,10, 10,0,0, 10,10,10]}}]})");
  const Finished run =
      Patchmill({"evaluate", out_ / "bowl.json", "--at", "0,0.5,0.5", "0,1,0.5", "-o", out_ / "values.json"});
  EXPECT_EQ(run.status, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("patch 0 at 0.5, 0.5\n  point        0 0 0 mm"));
  EXPECT_THAT(run.out, HasSubstr("curvatures   0.1 0.1 per mm; Gauss 0.01, mean 0.1"));
  EXPECT_THAT(run.out, HasSubstr("point        10 0 5 mm"));
  EXPECT_THAT(Slurp(out_ / "values.json"), HasSubstr("\"principal_curvatures_per_mm\""));
  EXPECT_EQ(Patchmill({"evaluate", out_ / "bowl.json", "--at", "0,0.5"}).status, 2);
  EXPECT_EQ(Patchmill({"evaluate", out_ / "bowl.json", "--at", "-1,0.5,0.5"}).status, 2);
  EXPECT_EQ(Patchmill({"evaluate", out_ / "bowl.json", "--at", "0,0.5,1.5"}).status, 2);
  EXPECT_EQ(Patchmill({"evaluate", out_ / "bowl.json", "--at", "0,0.5,0.5", "-o", out_ / "v.txt"}).status, 2);
}

TEST_F(Cli, ReachIsATableAndAFile) {
  const Finished table = Patchmill({"reach", bump_, "--tool-diameters", "1,2,400", "--floor", "-5"});
  EXPECT_EQ(table.status, 0) << table.err;
  EXPECT_THAT(table.out, HasSubstr("unreachable, mm2"));
  EXPECT_THAT(table.out, HasSubstr("           1                0.000    0.00%"));
  const Finished json =
      Patchmill({"reach", bump_, "--tool-diameters", "1,2", "-o", out_ / "reach.json", "--quiet"});
  EXPECT_EQ(json.status, 0) << json.err;
  EXPECT_EQ(json.out, "");
  EXPECT_THAT(Slurp(out_ / "reach.json"), HasSubstr("\"tool_diameter_mm\": 2"));
  const Finished wrong = Patchmill({"reach", bump_, "--tool-diameters", "2,1"});
  EXPECT_EQ(wrong.status, 2);
  EXPECT_THAT(wrong.err, HasSubstr("tool_diameters_mm[1] = 1; must be above the one before, 2"));
  EXPECT_EQ(Patchmill({"reach", bump_, "-o", out_ / "reach.svg"}).status, 2);
}

TEST_F(Cli, NoCommandOrAnUnknownOneIsWrongUsage) {
  EXPECT_EQ(Patchmill({}).status, 2);
  EXPECT_EQ(Patchmill({"lathe"}).status, 2);
  EXPECT_EQ(Patchmill({"mill"}).status, 2);
  EXPECT_EQ(Patchmill({"--help"}).status, 0);
  EXPECT_EQ(Patchmill({"mill", "--help"}).status, 0);
  EXPECT_TRUE(std::regex_search(Patchmill({"--version"}).out, std::regex("^patchmill [0-9]+\\.[0-9]+")));
  const std::string help = Patchmill({"--help"}).out;
  for (const char* name : {"mill", "check", "faces", "convert", "regions", "reach", "verify", "lines",
                           "evaluate", "build", "edit", "fair", "serve"}) {
    EXPECT_THAT(help, HasSubstr(std::string("  ") + name));
  }
}

TEST_F(Cli, UnreadableModelsAreStatusTwoWithAReason) {
  const std::string good = Json(testing::Bump());
  const struct {
    const char* name;
    std::string content;
    const char* message;
  } cases[] = {
      {"empty.bpt", "", "empty"},
      {"empty.json", "", "empty"},
      {"truncated.json", good.substr(0, good.size() / 2), "not a PatchModel in JSON"},
      {"null.json", "{\"patches\": [\n{\"bezier\": {\"degree_u\": 1, \"points\": [0, 0,\nnull, 1]}}]}",
       "line 3: null in a list"},
      {"nested.json", "{\"patches\": [{\"bezier\": {\"points\": [[0, 0, 0], [1, 0, 0]]}}]}",
       "line 1: a list in a list"},
      {"list.json", "[]", "not a PatchModel in JSON"},
      {"truncated.pb", testing::Bump().SerializeAsString().substr(0, 200), "PatchModel"},
      {"truncated.bpt", "1\n3 3\n0 0 0\n1 0 0\n", "line "},
      {"surplus.bpt", "1\n1 1\n0 0 0\n1 0 0\n0 1 0\n1 1 0\n7 7 7\n", "line "},
      {"nan.bpt", "1\n1 1\n0 0 0\nnan 0 0\n0 1 0\n1 1 0\n", "line 4"},
      {"huge.bpt", "1\n1 1\n0 0 0\n1e300 0 0\n0 1 0\n1 1 0\n", ""},
      {"count.bpt", "2000000000\n1 1\n0 0 0\n", "line "},
      {"kind.bv", "1\n4 1\n0 0 0\n1 0 0\n0 1 0\n1 1 0\n4 0 1 2 3\n", "line "},
      {"wrong.bv", good, "line 1"},
      {"wrong.stl", "solid x\nendsolid x\n", "by the file's ending"},
      {"nounit.json", "{\"patches\": [{}]}", "length_unit"},
  };
  for (const auto& c : cases) {
    const Finished run = Mill(in_.Write(c.name, c.content));
    EXPECT_EQ(run.status, 2) << c.name << ": " << run.err;
    EXPECT_THAT(run.err, HasSubstr(c.message)) << c.name;
    EXPECT_THAT(out_.Names(), IsEmpty()) << c.name;
  }
  EXPECT_THAT(Mill(in_ / "missing.bpt").err, HasSubstr("No such file"));
  EXPECT_EQ(Mill(in_ / "missing.bpt").status, 2);
}

TEST_F(Cli, AProgramThatCannotBeWrittenIsSaidBeforeTheJob) {
  const Finished run = Patchmill({"mill", bump_, "-o", out_ / "no/such/dir/part.ngc"});
  EXPECT_EQ(run.status, 1);
  EXPECT_THAT(run.err, HasSubstr("cannot write"));
}

TEST_F(Cli, NoResultReplacesWhatIsReadOrAnotherResult) {
  const std::string before = Slurp(bump_);
  const Finished model = Patchmill({"mill", bump_, "-o", bump_});
  EXPECT_EQ(model.status, 2);
  EXPECT_THAT(model.err, HasSubstr("is an input"));
  EXPECT_EQ(Slurp(bump_), before);
  const Finished twice = Mill(bump_, {"--report", out_ / "./part.ngc"});
  EXPECT_EQ(twice.status, 2);
  EXPECT_THAT(twice.err, HasSubstr("two results"));
  EXPECT_THAT(out_.Names(), IsEmpty());
}

// Outlines, maps, edits, measured points: whatever a command reads.
TEST_F(Cli, NoResultReplacesAnyFileThatIsRead) {
  const std::string outline = in_.Write("outline.txt", "-9,-9 9,-9 9,9 -9,9\n"),
                    edits = in_.Write("edits.json", "{\"edits\": []}"),
                    points = in_.Write("points.csv", "0,0,0\n1,0.1,0\n2,0,0\n3,0.1,0\n4,0,0\n"),
                    network = in_.Write("network.json", Slurp(PATCHMILL_SOURCE_DIR "/examples/bonnet.json")),
                    map = out_ / "map.json";
  ASSERT_EQ(Patchmill({"regions", waves_, "-o", map}).status, 0);
  in_.Write("map.json", Slurp(map));
  const std::pair<std::string, std::vector<std::string>> commands[] = {
      {outline, {"mill", bump_, "-o", outline, "--boundary", "@" + outline}},
      {outline, {"mill", bump_, "-o", out_ / "a.ngc", "--report", outline, "--obstacle", "12: @" + outline}},
      {in_ / "map.json",
       {"regions", waves_, "-o", in_ / "map.json", "--regions", in_ / "map.json", "--region", "1:off"}},
      {edits, {"edit", network, "--edits", edits, "-o", edits}},
      {edits, {"edit", network, "--edits", edits, "-o", out_ / "a.json", "--patches", edits}},
      {network, {"edit", network, "-o", network}},
      {points, {"fair", points, "-o", points}},
      {points, {"fair", points, "-o", out_ / "a.csv", "--polyline", points, "--tolerance", "0.01"}},
  };
  for (const auto& [file, command] : commands) {
    const std::string before = Slurp(file);
    const Finished run = Patchmill(command);
    EXPECT_EQ(run.status, 2) << command[0] << " " << file;
    EXPECT_THAT(run.err, HasSubstr(file + " is an input")) << command[0];
    EXPECT_EQ(Slurp(file), before) << command[0];
  }
  EXPECT_THAT(out_.Names(), UnorderedElementsAre("map.json"));
}

TEST_F(Cli, WhenNothingCanBeReachedTheReportIsWrittenAndNoProgram) {
  const Finished run = Mill(bump_, {"--floor", "50", "--report", out_ / "part.json"});
  EXPECT_EQ(run.status, 1);
  EXPECT_THAT(run.err,
              AllOf(HasSubstr("NOTHING_TO_CUT"), HasSubstr("--scale"), HasSubstr("no program was written")));
  EXPECT_THAT(out_.Names(), ElementsAre("part.json"));
}

TEST_F(Cli, ATimeoutLeavesNothingBehind) {
  std::vector<std::string> options = fine_;
  for (const char* word : {"--timeout", "0.7", "--report"}) options.emplace_back(word);
  options.push_back(out_ / "part.json");
  const Finished run = Mill(long_, options);
  EXPECT_EQ(run.status, 1);
  EXPECT_THAT(run.err, HasSubstr("--timeout 0.7 s"));
  EXPECT_THAT(out_.Names(), IsEmpty());
}

TEST_F(Cli, AnInterruptLeavesNothingBehind) {
  for (const int number : {SIGINT, SIGTERM}) {
    std::vector<std::string> command = {kPatchmill, "mill", long_, "-o", out_ / "part.ngc"};
    command.insert(command.end(), fine_.begin(), fine_.end());
    Process process(command);
    std::this_thread::sleep_for(700ms);
    process.Signal(number);
    EXPECT_EQ(process.Wait(), 1);
    EXPECT_THAT(process.Err(), HasSubstr("interrupted"));
    EXPECT_THAT(out_.Names(), IsEmpty());
  }
}

TEST_F(Cli, TheDaemonMakesTheSameBytesAnswersHealthAndDrains) {
  ASSERT_EQ(Mill(bump_).status, 0);
  const std::string embedded = Slurp(out_ / "part.ngc");
  Daemon daemon(kDaemon);
  const Finished run = Mill(bump_, {"--server", daemon.target(), "--threads", "1"});
  EXPECT_EQ(run.status, 0) << run.err;
  EXPECT_EQ(Slurp(out_ / "part.ngc"), embedded);
  EXPECT_EQ(testing::Run({kDaemon, "--check-health", daemon.target()}).status, 0);
  const Finished taken = testing::Run({kDaemon, "--listen", daemon.target()});
  EXPECT_EQ(taken.status, 2);
  EXPECT_THAT(taken.err, HasSubstr("cannot listen"));
  for (const char* place : {"127.0.0.1:99999", "127.0.0.1:65536", "127.0.0.1", "127.0.0.1:", "here:http"}) {
    const Finished wrong = testing::Run({kDaemon, "--listen", place});
    EXPECT_EQ(wrong.status, 2) << place;
    EXPECT_THAT(wrong.err, HasSubstr("a port of 0 to 65535")) << place;
  }
  daemon.process().Signal(SIGTERM);
  EXPECT_EQ(daemon.process().Wait(), 0);
  EXPECT_EQ(testing::Run({kDaemon, "--check-health", daemon.target()}).status, 1);
  const Finished gone = Mill(bump_, {"--server", daemon.target()});
  EXPECT_EQ(gone.status, 1);
  EXPECT_THAT(gone.err, HasSubstr("no server answers at " + daemon.target() + ": "));
}

TEST_F(Cli, AKilledServerLeavesNoNewProgram) {
  Daemon daemon(kDaemon);
  std::vector<std::string> command = {kPatchmill,        "mill",     long_,          "-o",
                                      out_ / "part.ngc", "--server", daemon.target()};
  command.insert(command.end(), fine_.begin(), fine_.end());
  Process client(command);
  std::this_thread::sleep_for(700ms);
  daemon.process().Signal(SIGKILL);
  EXPECT_EQ(client.Wait(), 1);
  EXPECT_THAT(client.Err(),
              HasSubstr("the connection to " + daemon.target() + " broke while the call ran: "));
  EXPECT_THAT(out_.Names(), IsEmpty());
}

TEST_F(Cli, AServerThatIsBusyOrShutsDownSaysSo) {
  Daemon daemon(kDaemon, {"--max-jobs", "1", "--max-queue", "0"});
  std::vector<std::string> command = {kPatchmill,        "mill",     long_,          "-o",
                                      out_ / "long.ngc", "--server", daemon.target()};
  command.insert(command.end(), fine_.begin(), fine_.end());
  Process job(command);
  for (int i = 0; i < 200 && daemon.CpuSeconds() < 0.5; ++i)  // until the job has its place
    std::this_thread::sleep_for(25ms);
  Finished second;
  for (int i = 0; i < 100; ++i) {
    second = Patchmill({"reach", bump_, "--server", daemon.target()});
    if (second.status != 0) break;
  }
  EXPECT_EQ(second.status, 1);
  EXPECT_THAT(second.err, HasSubstr("patchmill: " + daemon.target() +
                                    ": the server runs 1 jobs and 0 wait, as many as may; try again"));
  daemon.process().Signal(SIGTERM);
  for (int i = 0; i < 100; ++i) {
    second = Patchmill({"reach", bump_, "--server", daemon.target()});
    if (second.err.find("the server runs 1 jobs") == std::string::npos) break;
  }
  EXPECT_EQ(second.status, 1);
  EXPECT_THAT(second.err,
              ::testing::AnyOf(HasSubstr(daemon.target() + ": the server is shutting down; try another one"),
                               HasSubstr("no server answers at " + daemon.target())));
  job.Signal(SIGTERM);
  EXPECT_EQ(job.Wait(), 1);
  EXPECT_THAT(out_.Names(), IsEmpty());
}

}  // namespace
}  // namespace patchmill
