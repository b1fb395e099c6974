// The 3-D pages as files: what their scene says is what the report, the regions and the program say.
#include <cmath>
#include <cstring>
#include <string>
#include <vector>

#include <absl/strings/escaping.h>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <google/protobuf/io/gzip_stream.h>
#include <google/protobuf/io/zero_copy_stream_impl_lite.h>
#include <google/protobuf/util/json_util.h>
#include <gtest/gtest.h>

#include "patchmill/v1/report.pb.h"
#include "tests/service/patchmill.h"
#include "tests/service/requests.h"
#include "tests/support/json.h"

namespace patchmill {
namespace {

using testing::Finished;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using testing::Patchmill;
using testing::Slurp;
using testing::TempDir;
using ::testing::UnorderedElementsAre;

struct Page {
  testing::Json scene;
  std::string data;

  template <class T>
  std::vector<T> Buffer(const std::string& name) const {
    const testing::Json& entry = scene["buffers"][name];
    const auto offset = static_cast<std::size_t>(entry["offset"].Number());
    std::vector<T> values(static_cast<std::size_t>(entry["count"].Number()));
    EXPECT_EQ(offset % 4, 0u) << name;
    EXPECT_LE(offset + values.size() * sizeof(T), data.size()) << name;
    if (offset + values.size() * sizeof(T) <= data.size() && !values.empty())
      std::memcpy(values.data(), data.data() + offset, values.size() * sizeof(T));
    return values;
  }
};

std::string Between(const std::string& text, const std::string& begin, const std::string& end) {
  const std::size_t from = text.find(begin);
  EXPECT_NE(from, std::string::npos) << begin;
  if (from == std::string::npos) return "";
  return text.substr(from + begin.size(), text.find(end, from) - from - begin.size());
}

std::string Inflated(const std::string& packed) {
  google::protobuf::io::ArrayInputStream stream(packed.data(), static_cast<int>(packed.size()));
  google::protobuf::io::GzipInputStream gzip(&stream);
  std::string bytes;
  const void* data = nullptr;
  for (int size = 0; gzip.Next(&data, &size);)
    bytes.append(static_cast<const char*>(data), static_cast<std::size_t>(size));
  EXPECT_EQ(gzip.ZlibErrorCode(), 1) << "the end of the stream";
  return bytes;
}

Page ReadPage(const std::string& path) {
  const std::string html = Slurp(path);
  Page page;
  page.scene = testing::ParseJson(
      Between(html, "<script type=\"application/json\" id=\"patchmill-scene\">", "</script>"));
  const std::string data =
      Between(html, "<script type=\"application/octet-stream\" id=\"patchmill-data\">", "</script>");
  std::string packed;
  EXPECT_TRUE(absl::Base64Unescape(data, &packed));
  EXPECT_EQ(page.scene["data_encoding"].String(), "gzip");
  page.data = Inflated(packed);
  return page;
}

class CliPage : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string json;
    ASSERT_TRUE(google::protobuf::util::MessageToJsonString(testing::HillAndPit(), &json).ok());
    model_ = in_.Write("waves.json", json);
  }
  Finished Mill(const std::vector<std::string>& more, const std::string& model) {
    std::vector<std::string> arguments = {"mill", model,         "-o",   out_ / "part.ngc", "--scallop",
                                          "0.05", "--tolerance", "0.02", "--floor",         "-8"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return Patchmill(arguments);
  }
  TempDir in_, out_;
  std::string model_;
};

TEST_F(CliPage, SaysWhatReportRegionsAndProgramSay) {
  const std::vector<std::string> more = {"--report",       out_ / "part.report.json",
                                         "--preview",      out_ / "part.html",
                                         "--preview",      out_ / "part.svg",
                                         "--stock",        "block,5",
                                         "--allowance",    "0.5",
                                         "--accept-depth", "9",
                                         "--no-arcs"};
  const Finished run = Mill(more, model_);
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_THAT(out_.Names(), UnorderedElementsAre("part.ngc", "part.report.json", "part.html", "part.svg"));
  v1::Report report;
  ASSERT_TRUE(google::protobuf::util::JsonStringToMessage(Slurp(out_ / "part.report.json"), &report).ok());
  const Page page = ReadPage(out_ / "part.html");
  const testing::Json& scene = page.scene;
  EXPECT_EQ(scene["title"].String(), "waves.json");
  EXPECT_EQ(scene["outcome"].String(), "COMPLETE");
  EXPECT_EQ(scene["figures"][0][1].String(), fmt::format("{:.4f} mm", report.max_gouge_mm()));
  EXPECT_EQ(scene["figures"][1][1].String(), fmt::format("{:.4f} mm", report.max_leftover_mm()));
  EXPECT_EQ(scene["tool"]["ball_diameter"].Number(), 6.0);
  EXPECT_EQ(scene["regions"].Items().size(), static_cast<std::size_t>(report.regions_size()));
  // A block of 5 mm around the part.
  for (const int axis : {0, 1}) {
    double least = 1e9;
    for (const testing::Json& corner : scene["stock"]["outline"].Items())
      least = std::min(least, corner[axis].Number());
    EXPECT_NEAR(least, -5.0, 1e-5);
  }
  EXPECT_EQ(scene["stock"]["top"].Number(), report.setup_sheet().stock_top_z_mm());

  EXPECT_EQ(
      [&] {
        const auto bytes = page.Buffer<char>("program.text");
        return std::string(bytes.begin(), bytes.end());
      }(),
      Slurp(out_ / "part.ngc"));
  const auto tip = page.Buffer<float>("path.tip");
  const auto kind = page.Buffer<std::uint8_t>("path.kind");
  ASSERT_EQ(tip.size(), 3 * kind.size());
  EXPECT_EQ(kind.size(), static_cast<std::size_t>(report.point_count()));
  float lowest = 1e9f;
  double seconds = 0.0;
  for (std::size_t i = 2; i < tip.size(); i += 3) lowest = std::min(lowest, tip[i]);
  for (const float s : page.Buffer<float>("path.seconds")) seconds += s;
  EXPECT_NEAR(lowest, report.tip_z_min_mm(), 1e-4);
  EXPECT_NEAR(seconds, report.estimated_time_s(), 1e-3 * seconds);

  // Where the surface is reached, no more stays than the report says; regions say what is not.
  const auto index = page.Buffer<std::uint32_t>("mesh.index");
  const auto region = page.Buffer<std::int32_t>("mesh.region");
  const auto leftover = page.Buffer<float>("mesh.leftover");
  ASSERT_EQ(index.size(), 3 * region.size());
  float most = 0.0f;
  for (std::size_t t = 0; t < region.size(); ++t) {
    ASSERT_LT(region[t], report.regions_size());
    if (region[t] < 0 || !scene["regions"][region[t]]["unreachable"].String().empty()) continue;
    for (std::size_t k = 0; k < 3; ++k) most = std::max(most, leftover.at(index[3 * t + k]));
  }
  EXPECT_GT(most, 0.5 * report.max_leftover_mm());
  EXPECT_LT(most, 2.0 * report.max_leftover_mm());  // triangles at a border of reach overlap it
}

TEST_F(CliPage, HasTheSameBytesEachTime) {
  ASSERT_EQ(Mill({"--preview", out_ / "a.html", "--threads", "1"}, model_).status, 0);
  ASSERT_EQ(Mill({"--preview", out_ / "b.html", "--threads", "2"}, model_).status, 0);
  EXPECT_EQ(Slurp(out_ / "a.html"), Slurp(out_ / "b.html"));
}

// A stock with a model of its own: pages have the box of that, up to its top. Its surface rises to (3/4)^2
// of the height of its inner control points.
TEST_F(CliPage, ShowsTheBoxOfAStockModel) {
  std::string json;
  ASSERT_TRUE(google::protobuf::util::MessageToJsonString(testing::Bump(50.0, 64.0), &json).ok());
  const std::string stock = in_.Write("stock.json", json);
  const Finished run = Mill({"--stock", "model:" + stock, "--accept-depth", "90", "--report",
                             out_ / "part.report.json", "--preview", out_ / "part.html"},
                            model_);
  ASSERT_EQ(run.status, 0) << run.err;
  v1::Report report;
  ASSERT_TRUE(google::protobuf::util::JsonStringToMessage(Slurp(out_ / "part.report.json"), &report).ok());
  const testing::Json scene = ReadPage(out_ / "part.html").scene;
  ASSERT_EQ(scene["stock"]["outline"].Items().size(), 4u);
  for (const int axis : {0, 1}) {
    double low = 1e9, high = -1e9;
    for (const testing::Json& corner : scene["stock"]["outline"].Items()) {
      low = std::min(low, corner[axis].Number());
      high = std::max(high, corner[axis].Number());
    }
    EXPECT_NEAR(low, 0.0, 1e-6);
    EXPECT_NEAR(high, 50.0, 1e-6);
  }
  EXPECT_NEAR(report.setup_sheet().stock_model_box().max().z_mm(), 64.0 * 9.0 / 16.0, 1e-3);
  EXPECT_EQ(scene["stock"]["top"].Number(), report.setup_sheet().stock_top_z_mm());
}

// The scene of a page is JSON inside a script: a name must not end it, whatever it is.
TEST_F(CliPage, NamesAreTextAndNeverMarkup) {
  const std::string evil = in_.Write("x<script>alert(1)<!--.json", Slurp(model_));
  ASSERT_EQ(Mill({"--preview", out_ / "part.html"}, evil).status, 0);
  const std::string html = Slurp(out_ / "part.html");
  EXPECT_THAT(html, Not(HasSubstr("<script>alert")));
  EXPECT_EQ(ReadPage(out_ / "part.html").scene["title"].String(), "x<script>alert(1)<!--.json");
}

TEST_F(CliPage, ShowsAFailedJobWithoutAProgram) {
  // The whole block still stands: the job needs roughing.
  const Finished run = Mill({"--stock", "block,5", "--preview", out_ / "part.html"}, model_);
  EXPECT_EQ(run.status, 1) << run.err;
  EXPECT_THAT(out_.Names(), UnorderedElementsAre("part.html"));
  const Page page = ReadPage(out_ / "part.html");
  EXPECT_EQ(page.scene["outcome"].String(), "NEEDS_ROUGHING");
  EXPECT_FALSE(page.scene["buffers"].Has("path.tip"));
  EXPECT_FALSE(page.scene["buffers"].Has("mesh.leftover"));
  EXPECT_TRUE(page.scene["buffers"].Has("mesh.position"));
}

TEST_F(CliPage, RegionsAndVerifyWriteThemToo) {
  ASSERT_EQ(Mill({}, model_).status, 0);
  const Finished regions = Patchmill({"regions", model_, "-o", out_ / "regions.html", "--floor", "-8"});
  ASSERT_EQ(regions.status, 0) << regions.err;
  const Page map = ReadPage(out_ / "regions.html");
  EXPECT_FALSE(map.scene["buffers"].Has("path.tip"));
  EXPECT_FALSE(map.scene["borders"].Items().empty());
  const Finished verify =
      Patchmill({"verify", model_, out_ / "part.ngc", "--tool-diameter", "6", "--scallop", "0.05",
                 "--tolerance", "0.02", "--floor", "-8", "--preview", out_ / "judged.html"});
  ASSERT_EQ(verify.status, 0) << verify.err;
  const Page judged = ReadPage(out_ / "judged.html");
  EXPECT_EQ(judged.scene["title"].String(), "part.ngc on waves.json");
  EXPECT_TRUE(judged.scene["buffers"].Has("mesh.leftover"));
  const auto line = judged.Buffer<std::uint32_t>("path.line");
  const auto tip = judged.Buffer<float>("path.tip");
  EXPECT_EQ(tip.size(), 3 * line.size());
  EXPECT_GT(line.size(), 100u);
}

TEST_F(CliPage, OtherEndingsAndTwoPagesAreRefused) {
  EXPECT_EQ(Mill({"--preview", out_ / "part.gif"}, model_).status, 2);
  const Finished two = Mill({"--preview", out_ / "a.html", "--preview", out_ / "b.html"}, model_);
  EXPECT_EQ(two.status, 2);
  EXPECT_THAT(two.err, HasSubstr("one .svg, one .png and one .html at most"));
  EXPECT_THAT(out_.Names(), IsEmpty());
}

}  // namespace
}  // namespace patchmill
