// One malformed file per fault: code, line and reason of the refusal.
#include <filesystem>
#include <map>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/io/model_text.h"
#include "tests/support/files.h"

namespace patchmill {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

const std::map<std::string, const char*> kReasons = {
    {"all_points_equal.bpt", "line 2: patches[0].bezier.points are all the same; the patch has no extent"},
    {"bez_colours.bez", "line 1: \"CBEZ113\" carries texture coordinates or colours, which are not read"},
    {"bez_comment_only.bez", "line 3: the text holds no patch"},
    {"bez_degree_0.bez", "line 1: \"BEZ033\" is no known first word; known are BBP and BEZabc"},
    {"bez_five_numbers.bez", "line 1: \"BEZ335\" is no known first word"},
    {"bez_negative_weight.bez", "line 3: weight of a point = -0.5; must be in [1e-09, 1e+09]"},
    {"bez_surplus.bez", "line 7: the text ends where z of a point is expected"},
    {"bez_truncated.bez", "line 4: the text ends where x of a point is expected"},
    {"bez_word.bez", "line 3: \"1.0e\" is not a number; y of a point is expected"},
    {"binary.bpt", "is not a whole number; number of patches is expected"},
    {"binary.bv", "is no known kind of patch"},
    {"count_above_limit.patches", "line 1: number of patches = \"100001\"; must be in [1, 100000]"},
    {"count_without_patches.bpt", "line 1: 100000 patches are announced; the text has room for 1 at most"},
    {"decimal_comma.bpt", "line 6: \"20,5\" is not a number; y of a point is expected"},
    {"degree_0.bpt", "line 2: degree in u = \"0\"; must be in [1, 15]"},
    {"degree_16.bpt", "line 2: degree in v = \"16\"; must be in [1, 15]"},
    {"empty.bez", "line 1: the text ends where \"BBP\" or \"BEZ\" is expected"},
    {"empty.bpt", "line 1: the text ends where number of patches is expected"},
    {"empty.bv", "line 3: the text holds no patch"},
    {"empty.patches", "line 1: the text ends where \"patches\" is expected"},
    {"fortran_exponent.bpt", "line 6: \"2D1\" is not a number"},
    {"fractional_count.bpt", "line 1: \"1.5\" is not a whole number; number of patches is expected"},
    {"gregory3.patches", "line 20: the text ends where x of a point is expected"},
    {"hexadecimal.bpt", "line 6: \"0x14\" is not a number"},
    {"huge_count.bpt", "line 1: number of patches = \"99999999999999999999\"; must be in [1, 100000]"},
    {"huge_degree.bv", "line 1: degree of the patch = \"2000000000\"; must be in [1, 15]"},
    {"inf.bpt", "line 6: \"-inf\" is not a number"},
    {"kind1.bv", "line 1: kind 1 is a polygon mesh, not a patch; kinds 3 (Bezier triangle), 4 and 5"},
    {"nan.bpt", "line 6: \"nan\" is not a number; y of a point is expected"},
    {"nan_weight.bv", "line 4: \"nan\" is not a number; weight of a point is expected"},
    {"negative_count.bpt", "line 1: number of patches = \"-1\"; must be in [1, 100000]"},
    {"negative_degree.bv", "line 1: degree of the triangle = \"-2\"; must be in [1, 15]"},
    {"negative_weight.bv", "line 4: weight of a point = -1; must be in [1e-09, 1e+09]"},
    {"nul_byte.bpt", "line 4: \"20\\x00\" is not a number"},
    {"overflow.bpt", "line 6: \"1e400\" for y of a point is out of the range of doubles"},
    {"quads_as_bv.bv", "line 1: kind 1 is a polygon mesh"},
    {"surplus.bpt", "line 7: surplus text \"7\" after the last patch"},
    {"surplus.bv", "line 6: \"0.5\" is no known kind of patch"},
    {"surplus.patches", "line 6: surplus text \"1\" after the last patch"},
    {"too_large.bpt", "line 6: y of a point = 2e+09; must be in [-1e+09, 1e+09]"},
    {"truncated.bpt", "line 11: the text ends where z of a point is expected"},
    {"truncated.patches", "line 6: the text ends where z of a point is expected"},
    {"truncated_in_number_list.bv", "line 4: the text ends where z of a point is expected"},
    {"unknown_key.patches",
     "line 2: \"nurbs\" is no known key of a patch; known are bezier, triangle, gregory4 and gregory3"},
    {"unknown_kind.bv", "line 1: \"7\" is no known kind of patch; kinds 3"},
    {"word.bpt", "line 6: \"twenty\" is not a number"},
    {"wrong_first_line.patches", "line 1: \"1\" stands where \"patches\" is expected"},
    {"zero_count.bpt", "line 1: number of patches = \"0\"; must be in [1, 100000]"},
    {"zero_weight.bez", "line 7: ZERO_WEIGHT: weight of a point = 0; must be in [1e-09, 1e+09]"},
    {"zero_weight.bv", "line 4: ZERO_WEIGHT: weight of a point = 0; must be in [1e-09, 1e+09]"},
};

TEST(MalformedModels, AreRefusedWithLineAndReason) {
  for (const auto& [name, reason] : kReasons) {
    const std::string text = testing::ReadRepositoryFile("tests/models/malformed/" + name);
    const auto model = ReadModelText(name.substr(name.rfind('.') + 1), text);
    EXPECT_EQ(model.status().code(), absl::StatusCode::kInvalidArgument) << name;
    EXPECT_THAT(std::string(model.status().message()), StartsWith("line ")) << name;
    EXPECT_THAT(std::string(model.status().message()), HasSubstr(reason)) << name;
  }
}

TEST(MalformedModels, EveryFileHasItsReason) {
  const std::filesystem::path folder = PATCHMILL_SOURCE_DIR "/tests/models/malformed";
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    EXPECT_EQ(kReasons.count(entry.path().filename().string()), 1u) << entry.path();
  }
}

TEST(MalformedModels, MeshFormatsByOtherNamesAreRefused) {
  for (const char* format : {"stl", "BPT", ".bpt", "", "step"}) {
    const auto model = ReadModelText(format, "1\n");
    EXPECT_EQ(model.status().code(), absl::StatusCode::kInvalidArgument);
    EXPECT_THAT(std::string(model.status().message()), HasSubstr("known are bpt, bv, bez and patches"));
  }
}

TEST(MalformedModels, ACountNeverReservesMemoryTheTextCannotFill) {
  // 64 bytes of text; were the announced patches reserved first, these would need gigabytes.
  for (const char* text : {"100000\n15 15\n", "99999\n1 1\n0 0 0\n"}) {
    EXPECT_EQ(ReadModelText("bpt", text).status().code(), absl::StatusCode::kInvalidArgument);
  }
}

}  // namespace
}  // namespace patchmill
