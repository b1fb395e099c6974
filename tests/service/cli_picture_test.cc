// Pictures in 3-D (.png): what they show, read back by another reader of pictures.
#include <array>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <google/protobuf/util/json_util.h>
#include <gtest/gtest.h>

#include "tests/service/patchmill.h"
#include "tests/service/requests.h"
#include "tests/support/png.h"

namespace patchmill {
namespace {

using testing::DecodedPng;
using testing::DecodePng;
using testing::Finished;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::Patchmill;
using testing::Slurp;
using testing::TempDir;
using Color = std::array<std::uint8_t, 3>;

constexpr Color kPaper = {0xf3, 0xf5, 0xf7}, kZigzag = {0x1f, 0x5f, 0xbf}, kRapid = {0xd0, 0x3b, 0x4b};

class CliPicture : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string json;
    ASSERT_TRUE(google::protobuf::util::MessageToJsonString(testing::HillAndPit(), &json).ok());
    model_ = in_.Write("waves.json", json);
  }
  Finished Mill(const std::vector<std::string>& more) {
    std::vector<std::string> arguments = {"mill",      model_, "-o",          out_ / "part.ngc",
                                          "--scallop", "0.05", "--tolerance", "0.02",
                                          "--floor",   "-8",   "--preview",   out_ / "part.png"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return Patchmill(arguments);
  }
  DecodedPng Picture(const std::vector<std::string>& more) {
    const Finished run = Mill(more);
    EXPECT_EQ(run.status, 0) << run.err;
    return DecodePng(Slurp(out_ / "part.png"));
  }
  // Pixels of a colour above the axes and beside the legend.
  static int InDrawing(const DecodedPng& png, const Color& color) {
    int count = 0;
    for (int y = 0; y < png.height * 7 / 10; ++y)
      for (int x = 0; x < png.width * 7 / 10; ++x)
        count += png.pixels[static_cast<std::size_t>(y * png.width + x)] == color ? 1 : 0;
    return count;
  }
  TempDir in_, out_;
  std::string model_;
};

TEST_F(CliPicture, ShowsThePartAndItsPasses) {
  const DecodedPng png = Picture({"--picture-size", "800x600", "--picture-view", "top"});
  ASSERT_EQ(png.width, 800);
  ASSERT_EQ(png.height, 600);
  EXPECT_GT(InDrawing(png, kZigzag), 500);
  EXPECT_EQ(InDrawing(png, kRapid), 0);
  // The part covers nearly all of that field.
  EXPECT_LT(InDrawing(png, kPaper), 560 * 420 / 4);
}

TEST_F(CliPicture, HasTheBytesOfTheSameJob) {
  const std::vector<std::string> options = {"--picture-size", "640x480", "--picture-shading", "leftover"};
  ASSERT_EQ(Mill(options).status, 0);
  const std::string first = Slurp(out_ / "part.png");
  std::vector<std::string> one_thread = options;
  one_thread.insert(one_thread.end(), {"--threads", "1"});
  ASSERT_EQ(Mill(one_thread).status, 0);
  EXPECT_EQ(Slurp(out_ / "part.png"), first);
}

TEST_F(CliPicture, ShowsTheLayersThatAreAskedFor) {
  const auto with = [&](const std::string& layers) {
    return Picture({"--picture-size", "640x480", "--picture-layers", layers, "--high-rapids"});
  };
  const DecodedPng none = with("none"), passes = with("passes"), rapids = with("rapids"), tool = with("tool");
  EXPECT_EQ(InDrawing(none, kZigzag), 0);
  EXPECT_EQ(InDrawing(none, kRapid), 0);
  EXPECT_GT(InDrawing(passes, kZigzag), 300);
  EXPECT_GT(InDrawing(rapids, kRapid), 20);
  EXPECT_EQ(InDrawing(rapids, kZigzag), 0);
  EXPECT_NE(tool.pixels, none.pixels);
}

// Each shading colours the part in its own way.
TEST_F(CliPicture, ShadesThePart) {
  std::vector<DecodedPng> pictures;
  for (const char* shading : {"region", "slope", "curvature", "leftover", "gouge", "unreachable", "plain"}) {
    pictures.push_back(
        Picture({"--picture-size", "400x320", "--picture-layers", "none", "--picture-shading", shading}));
    for (std::size_t k = 0; k + 1 < pictures.size(); ++k)
      EXPECT_NE(pictures[k].pixels, pictures.back().pixels) << shading;
  }
}

TEST_F(CliPicture, OfRegionsAndOfAVerifiedProgram) {
  const Finished regions =
      Patchmill({"regions", model_, "-o", out_ / "regions.png", "--picture-shading", "slope"});
  ASSERT_EQ(regions.status, 0) << regions.err;
  EXPECT_EQ(DecodePng(Slurp(out_ / "regions.png")).width, 1600);
  ASSERT_EQ(Mill({}).status, 0);
  const Finished verify =
      Patchmill({"verify", model_, out_ / "part.ngc", "--tool-diameter", "6", "--scallop", "0.05",
                 "--tolerance", "0.02", "--floor", "-8", "--preview", out_ / "verify.png"});
  ASSERT_EQ(verify.status, 0) << verify.err;
  EXPECT_EQ(DecodePng(Slurp(out_ / "verify.png")).height, 1200);
}

TEST_F(CliPicture, WrongOptionsAreNamed) {
  const auto error = [&](const std::vector<std::string>& more) {
    const Finished run = Mill(more);
    EXPECT_EQ(run.status, 2) << run.err;
    EXPECT_THAT(out_.Names(), IsEmpty());
    return run.err;
  };
  EXPECT_THAT(error({"--picture-size", "100x100"}),
              HasSubstr("--picture-size 100x100: must be WIDTHxHEIGHT, each 320 to 4096 pixels"));
  EXPECT_THAT(error({"--picture-size", "1600"}), HasSubstr("--picture-size 1600: must be WIDTHxHEIGHT"));
  EXPECT_THAT(error({"--picture-layers", "passes,holder"}),
              HasSubstr("there is no layer 'holder'; there are passes"));
  EXPECT_THAT(error({"--preview", out_ / "other.png"}),
              HasSubstr("one .svg, one .png and one .html at most"));
  EXPECT_NE(Mill({"--picture-view", "below"}).status, 0);
  const Finished regions =
      Patchmill({"regions", model_, "-o", out_ / "r.png", "--picture-shading", "leftover"});
  EXPECT_NE(regions.status, 0);
}

}  // namespace
}  // namespace patchmill
