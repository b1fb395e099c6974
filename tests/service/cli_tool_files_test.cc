// --tool: tools from the files of Fusion, FreeCAD and LinuxCNC, and of our own, as the program states them.
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <google/protobuf/util/json_util.h>
#include <gtest/gtest.h>

#include "patchmill/v1/report.pb.h"
#include "tests/service/process.h"
#include "tests/service/requests.h"

namespace patchmill {
namespace {

using ::testing::AllOf;
using testing::Finished;
using ::testing::HasSubstr;
using ::testing::Not;
using testing::Slurp;
using testing::TempDir;

constexpr char kLibrary[] = R"({"version": 33, "data": [
  {"type": "holder", "unit": "millimeters", "description": "loose", "segments": []},
  {"type": "flat end mill", "unit": "millimeters", "description": "flat 8", "geometry": {"DC": 8, "LB": 20},
   "post-process": {"number": 1}},
  {"type": "ball end mill", "unit": "inches", "description": "ball 1/4",
   "geometry": {"DC": 0.25, "LCF": 0.5, "LB": 1.5, "SFDM": 0.25, "OAL": 2.5},
   "holder": {"unit": "millimeters", "segments": [
     {"height": 20, "lower-diameter": 28, "upper-diameter": 30},
     {"height": 25, "lower-diameter": 40, "upper-diameter": 40}]},
   "post-process": {"number": 12},
   "start-values": {"presets": [{"name": "steel", "n": 9000, "v_f": 40, "v_f_plunge": 12.5}]}},
  {"type": "ball end mill", "unit": "millimeters", "description": "ball 3", "geometry": {"DC": 3},
   "post-process": {"number": 7}}]})";

constexpr char kToolBit[] = R"({"version": 2, "name": "6mm Ball End", "shape": "ballend.fcstd",
  "parameter": {"CuttingEdgeHeight": "40.0000 mm", "Diameter": "6.0000 mm", "Length": "50.0000 mm",
                "ShankDiameter": "3.0000 mm"}, "attribute": {}})";

constexpr char kTable[] = "T1 P1 Z0.511 D3 ;3mm ball\n; a comment\n\nt4 p2 z10 d16.5 ;big one\nT5 P5 Z25\n";

constexpr char kOwn[] = R"({"number": 3, "name": "long", "ball_end": {"diameter_mm": 4},
  "stickout_mm": 32, "holder": [{"length_mm": 20, "lower_diameter_mm": 28, "upper_diameter_mm": 28}],
  "spindle_rpm": 8000, "feed_mm_per_min": 900, "plunge_feed_mm_per_min": 300})";

class ToolFiles : public ::testing::Test {
 protected:
  Finished Mill(const std::string& tool, std::vector<std::string> more = {}) {
    std::vector<std::string> words = {PATCHMILL_BIN "/patchmill",
                                      "mill",
                                      bump_,
                                      "-o",
                                      out_ / "part.ngc",
                                      "--scallop",
                                      "0.05",
                                      "--tolerance",
                                      "0.02",
                                      "--floor",
                                      "-1",
                                      "--tool",
                                      tool};
    words.insert(words.end(), more.begin(), more.end());
    return testing::Run(words);
  }
  std::string Program(const std::string& tool, std::vector<std::string> more = {}) {
    const Finished mill = Mill(tool, std::move(more));
    EXPECT_EQ(mill.status, 0) << mill.err;
    return Slurp(out_ / "part.ngc");
  }
  static std::string BumpJson() {
    std::string json;
    EXPECT_TRUE(google::protobuf::util::MessageToJsonString(testing::Bump(), &json).ok());
    return json;
  }
  TempDir in_, out_;
  std::string bump_ = in_.Write("bump.json", BumpJson());
};

TEST_F(ToolFiles, FusionsLibrary) {
  const std::string file = in_.Write("lib.json", kLibrary);
  const std::string text = Program(file + ":12");
  EXPECT_THAT(text,
              AllOf(HasSubstr("(tool T12: ball D 6.35, ball 1/4, flute 12.7, shank D 6.35, stick-out 38.1)"),
                    HasSubstr("T12 M6"), HasSubstr("S9000 M3"), HasSubstr("F1016"),
                    Not(HasSubstr("DEFAULT_CUTTING_DATA")), Not(HasSubstr("HOLDER_NOT_CHECKED"))));
  // Options go before the file.
  EXPECT_THAT(Program(file + ":12", {"--feed", "700", "--tool-number", "2", "--spindle", "5000"}),
              AllOf(HasSubstr("T2 M6"), HasSubstr("S5000 M3"), HasSubstr("F700"), Not(HasSubstr("F1016"))));
  const std::string plain = Program(file + ":7");
  EXPECT_THAT(plain, AllOf(HasSubstr("tool T7: ball D 3, ball 3)"), HasSubstr("DEFAULT_CUTTING_DATA")));
  const Finished several = Mill(file);
  EXPECT_EQ(several.status, 2);
  EXPECT_THAT(several.err, AllOf(HasSubstr("FILE:NUMBER"), HasSubstr("T12 ball 1/4 D 6.35"),
                                 HasSubstr("T1 flat 8 (flat end mill)"), Not(HasSubstr("loose"))));
  EXPECT_THAT(Mill(file + ":1").err,
              HasSubstr("tool 1 is flat end mill; Patchmill cuts with ball end mills"));
  EXPECT_THAT(Mill(file + ":5").err, HasSubstr("has no tool 5"));
}

TEST_F(ToolFiles, AHolderThatCannotBeReadIsNotLeftOut) {
  std::string library = kLibrary;
  const std::string height = "\"height\": 25";
  library.replace(library.find(height), height.size(), "\"height\": \"25\"");
  const Finished refused = Mill(in_.Write("bad.json", library) + ":12");
  EXPECT_EQ(refused.status, 2);
  EXPECT_THAT(refused.err, HasSubstr("segment 1 of its holder unreadable"));
  // Without a stick-out nobody knows where the holder begins; the option says it.
  std::string short_one = kLibrary;
  const std::string lb = "\"LB\": 1.5, ";
  short_one.erase(short_one.find(lb), lb.size());
  const std::string file = in_.Write("short.json", short_one);
  EXPECT_THAT(Program(file + ":12"), HasSubstr("HOLDER_NOT_CHECKED"));
  EXPECT_THAT(Program(file + ":12", {"--stickout", "40"}), Not(HasSubstr("HOLDER_NOT_CHECKED")));
}

TEST_F(ToolFiles, FreeCadsToolBit) {
  EXPECT_THAT(Program(in_.Write("b.fctb", kToolBit)),
              HasSubstr("(tool T1: ball D 6, 6mm Ball End, flute 40, shank D 3)"));
  std::string flat = kToolBit;
  flat.replace(flat.find("ballend"), 7, "endmill");
  const Finished refused = Mill(in_.Write("f.fctb", flat));
  EXPECT_EQ(refused.status, 2);
  EXPECT_THAT(refused.err, HasSubstr("has no ball end mill"));
  std::string inch = kToolBit;
  inch.replace(inch.find("6.0000 mm"), 9, "0.25 in");
  EXPECT_THAT(Program(in_.Write("i.fctb", inch)), HasSubstr("ball D 6.35,"));
}

TEST_F(ToolFiles, LinuxCncsTable) {
  const std::string file = in_.Write("tool.tbl", kTable);
  EXPECT_THAT(Program(file + ":1"), HasSubstr("(tool T1: ball D 3, 3mm ball)"));
  EXPECT_THAT(Program(file + ":4"), HasSubstr("(tool T4: ball D 16.5, big one)"));
  EXPECT_THAT(Mill(file + ":5").err, HasSubstr("tool 5 is without a diameter"));
  const Finished bad = Mill(in_.Write("bad.tbl", "T1 P1 D6\nT2 what D5\n"));
  EXPECT_EQ(bad.status, 2);
  EXPECT_THAT(bad.err, HasSubstr("line 2: \"what\" is no letter with a number"));
}

TEST_F(ToolFiles, OurOwn) {
  const std::string file = in_.Write("own.json", kOwn);
  const std::string text = Program(file);
  EXPECT_THAT(text, AllOf(HasSubstr("(tool T3: ball D 4, long, stick-out 32)"), HasSubstr("S8000 M3"),
                          Not(HasSubstr("HOLDER_NOT_CHECKED"))));
  const Finished verify =
      testing::Run({PATCHMILL_BIN "/patchmill", "verify", bump_, out_ / "part.ngc", "--tool", file,
                    "--tolerance", "0.02", "--floor", "-1", "--no-finish"});
  EXPECT_EQ(verify.status, 0) << verify.out << verify.err;
}

TEST_F(ToolFiles, FaultsAreNamed) {
  EXPECT_THAT(Mill(in_.Write("a.json", "{\"x\": 1}")).err, HasSubstr("is no tool"));
  EXPECT_THAT(Mill(in_.Write("b.json", "T1 D6")).err, HasSubstr("neither JSON nor a tool table"));
  EXPECT_THAT(Mill(in_.Write("c.json", "{\"data\": []}")).err,
              HasSubstr("has no ball end mill; it has none"));
  EXPECT_THAT(Mill(in_ / "absent.json").err, HasSubstr("absent.json"));
  for (const char* file : {"a.json", "b.json", "c.json", "absent.json"})
    EXPECT_EQ(Mill(in_ / file).status, 2);
  EXPECT_TRUE(Slurp(out_ / "part.ngc").empty());
}

}  // namespace
}  // namespace patchmill
