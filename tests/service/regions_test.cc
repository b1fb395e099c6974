// Regions listed, switched off and cut in a way of their own, through the wire: SplitRegions, then
// GenerateProgram with its map, then VerifyProgram of what came out.
#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>

#include <gmock/gmock.h>
#include <google/protobuf/util/json_util.h>
#include <gtest/gtest.h>

#include "server/convert/model.h"
#include "tests/service/embedded.h"
#include "tests/service/requests.h"
#include "tests/service/status_matchers.h"
#include "tests/support/model_table.h"
#include "tests/support/random.h"
#include "tests/support/shapes.h"

namespace patchmill {
namespace {

using grpc::StatusCode;
using testing::BumpJob;
using testing::Embedded;
using ::testing::HasSubstr;
using testing::InfoOf;
using testing::RpcStatusIs;
using ::testing::StartsWith;

class Regions : public ::testing::Test {
 protected:
  Regions() {
    *job_.mutable_source()->mutable_model() = testing::HillAndPit();
    Op().mutable_heights()->set_floor_z_mm(-5.0);
  }
  v1::Operation& Op() { return *job_.mutable_operations(0); }

  grpc::Status Split() {
    grpc::ClientContext context;
    v1::SplitRegionsRequest request;
    *request.mutable_job() = job_;
    v1::SplitRegionsResponse response;
    const grpc::Status status = embedded_.analysis->SplitRegions(&context, request, &response);
    map_ = response.regions();
    return status;
  }
  grpc::Status Generate() {
    grpc::ClientContext context;
    v1::GenerateProgramRequest request;
    *request.mutable_job() = job_;
    const auto reader = embedded_.toolpath->GenerateProgram(&context, request);
    program_.clear();
    v1::GenerateProgramResponse response;
    while (reader->Read(&response)) {
      if (response.has_program()) program_ += response.program().data();
      if (response.has_report()) report_ = response.report();
    }
    return reader->Finish();
  }
  // Of program_, by the regions of `op`.
  grpc::Status Verify(const v1::Operation& op) {
    grpc::ClientContext context;
    v1::VerifyProgramRequest request;
    *request.mutable_source() = job_.source();
    *request.mutable_setup() = job_.setup();
    *request.add_tools() = op.tool();
    request.set_program(program_);
    request.set_tolerance_mm(op.tolerance_mm());
    request.set_scallop_mm(op.scallop_mm());
    request.set_floor_z_mm(op.heights().floor_z_mm());
    if (op.has_detail()) request.set_detail(op.detail());
    request.set_regions_sha256(op.regions_sha256());
    *request.mutable_region_overrides() = op.region_overrides();
    const auto reader = embedded_.toolpath->VerifyProgram(&context, request);
    v1::VerifyProgramResponse response;
    while (reader->Read(&response)) {
      if (response.has_report()) judged_ = response.report();
    }
    const grpc::Status status = reader->Finish();
    if (status.ok()) {
      EXPECT_EQ(judged_.retract_count(), report_.retract_count());
      EXPECT_GT(judged_.retract_count(), 0);
    }
    return status;
  }
  // Skips region `id` of the map there is.
  void Skip(int id) {
    Op().set_regions_sha256(map_.regions_sha256());
    v1::RegionOverride& change = *Op().add_region_overrides();
    change.set_region_id(id);
    change.set_skip(true);
  }

  Embedded embedded_;
  v1::Job job_ = BumpJob();
  v1::RegionMap map_;
  v1::Report report_, judged_;
  std::string program_;
};

TEST_F(Regions, TheirBordersAreLinesFromNodeToNode) {
  ASSERT_TRUE(Split().ok());
  ASSERT_GT(map_.border_lines_size(), 0);
  for (const v1::BorderLine& line : map_.border_lines()) {
    EXPECT_NE(line.kind(), v1::BORDER_KIND_UNSPECIFIED);
    EXPECT_EQ(line.other_region_id() == -1, line.kind() == v1::BORDER_KIND_OPEN_EDGE);
    EXPECT_NE(line.region_id(), line.other_region_id());
    EXPECT_LT(std::max(line.region_id(), line.other_region_id()), map_.regions_size());
    EXPECT_EQ(line.points_mm_size() % 3, 0);
    EXPECT_EQ(line.has_from_node(), !line.closed());
    EXPECT_EQ(line.has_to_node(), !line.closed());
    if (line.closed()) continue;
    ASSERT_LT(std::max(line.from_node(), line.to_node()), map_.nodes_size());
    const v1::Point3& from = map_.nodes(line.from_node());
    EXPECT_NEAR(from.x_mm(), line.points_mm(0), 1e-4);
    EXPECT_NEAR(from.z_mm(), line.points_mm(2), 1e-4);
  }
}

TEST_F(Regions, ThePictureShowsBordersByKindSlopeAndCurvature) {
  grpc::ClientContext context;
  v1::SplitRegionsRequest request;
  *request.mutable_job() = job_;
  request.add_outputs(v1::OUTPUT_PICTURE);
  v1::SplitRegionsResponse response;
  ASSERT_TRUE(embedded_.analysis->SplitRegions(&context, request, &response).ok());
  for (const char* text :
       {"borders of regions", "contours turn: ", "slope, from above", "curvature of contours, 1/mm"})
    EXPECT_THAT(response.picture().data(), HasSubstr(text));
}

TEST_F(Regions, ASkippedOneIsLeftOutOfProgramReportAndVerdict) {
  ASSERT_TRUE(Split().ok());
  ASSERT_GE(map_.regions_size(), 2);
  const v1::Region& first = map_.regions(0);
  Skip(first.id());
  ASSERT_TRUE(Split().ok());
  EXPECT_EQ(map_.regions_sha256(), Op().regions_sha256()) << "an override changes the map it is made for";
  EXPECT_TRUE(map_.regions(0).skipped());
  EXPECT_EQ(map_.regions(0).strategy(), v1::STRATEGY_UNSPECIFIED);
  EXPECT_FALSE(map_.regions(1).skipped());
  EXPECT_DOUBLE_EQ(map_.regions(1).scallop_mm(), Op().scallop_mm());

  ASSERT_TRUE(Generate().ok());
  ASSERT_FALSE(program_.empty());
  EXPECT_TRUE(report_.regions(0).skipped());
  double area = 0.0;
  for (const v1::Region& region : map_.regions()) area += region.skipped() ? 0.0 : region.area_mm2();
  EXPECT_NEAR(report_.total_area_mm2(), area, 0.01 * area);

  const grpc::Status verified = Verify(Op());
  ASSERT_TRUE(verified.ok()) << verified.error_message();
  EXPECT_EQ(judged_.outcome(), report_.outcome());
  EXPECT_NEAR(judged_.total_area_mm2(), report_.total_area_mm2(), 1e-9 * area);
  v1::Operation all = Op();
  all.clear_region_overrides();
  all.clear_regions_sha256();
  ASSERT_TRUE(Verify(all).ok());
  EXPECT_EQ(judged_.finish_check(), v1::CHECK_STATE_FAILED);
  EXPECT_EQ(judged_.gouge_check(), v1::CHECK_STATE_PASSED);
}

TEST_F(Regions, OverridesOfAnotherMapAreStale) {
  ASSERT_TRUE(Split().ok());
  Skip(0);
  Op().set_detail(0.0);
  const auto stale = RpcStatusIs(StatusCode::FAILED_PRECONDITION, HasSubstr("regions_sha256 = "));
  const grpc::Status status = Generate();
  EXPECT_THAT(status, stale);
  EXPECT_EQ(InfoOf(status).reason(), "REGIONS_STALE");
  EXPECT_THAT(Split(), stale);
  program_ = "G21\nG0 Z50\nM2\n";
  EXPECT_THAT(Verify(Op()), stale);
}

TEST_F(Regions, APointOfItNamesARegion) {
  job_.mutable_setup()->mutable_program_zero()->set_x_mm(5.0);
  ASSERT_TRUE(Split().ok());
  v1::RegionOverride& change = *Op().add_region_overrides();
  *change.mutable_at() = map_.regions(1).inside_point();
  change.set_scallop_mm(0.02);
  change.set_zigzag_angle_deg(30.0);
  ASSERT_TRUE(Split().ok());
  EXPECT_DOUBLE_EQ(map_.regions(1).scallop_mm(), 0.02);
  EXPECT_NEAR(map_.regions(1).zigzag_angle_deg(), 30.0, 1e-9);
  EXPECT_DOUBLE_EQ(map_.regions(0).scallop_mm(), 0.05);
  change.mutable_at()->set_z_mm(40.0);
  const grpc::Status far = Split();
  const std::string field = "job.operations[0].region_overrides[0].at";
  EXPECT_THAT(far, RpcStatusIs(StatusCode::INVALID_ARGUMENT, StartsWith(field + " = ")));
  ASSERT_EQ(testing::InfoOf(far).field_violations_size(), 1);
  EXPECT_EQ(testing::InfoOf(far).field_violations(0).field(), field);
}

TEST_F(Regions, AVerdictOnTheirScallopsNeedsOneForTheRest) {
  ASSERT_TRUE(Split().ok());
  v1::RegionOverride& change = *Op().add_region_overrides();
  *change.mutable_at() = map_.regions(1).inside_point();
  change.set_scallop_mm(0.02);
  grpc::ClientContext context;
  v1::VerifyProgramRequest request;
  *request.mutable_source() = job_.source();
  *request.add_tools() = Op().tool();
  request.set_program("G21\nG0 Z50\nM2\n");
  request.set_tolerance_mm(0.02);
  *request.mutable_region_overrides() = Op().region_overrides();
  const auto reader = embedded_.toolpath->VerifyProgram(&context, request);
  v1::VerifyProgramResponse response;
  while (reader->Read(&response)) {
  }
  EXPECT_THAT(reader->Finish(),
              RpcStatusIs(StatusCode::INVALID_ARGUMENT,
                          HasSubstr("region_overrides[0].scallop_mm is set without scallop_mm")));
}

// The networks of tests/cam/region/split_regions_counts.txt, as they are and with each vertex moved a
// little.
TEST_F(Regions, OfNetworksAreAsManyAsTheTableSays) {
  int networks = 0;
  for (const testing::TableRow& row : testing::ModelTable()) {
    if (!testing::IsNetwork(row)) continue;
    SCOPED_TRACE(row.file + ": " + row.why);
    ++networks;
    v1::PatchModel& model = *job_.mutable_source()->mutable_model();
    ASSERT_TRUE(
        google::protobuf::util::JsonStringToMessage(testing::ReadRepositoryFile(row.file), &model).ok());
    const auto count = [&] {
      const grpc::Status status = Split();
      EXPECT_TRUE(status.ok()) << status.error_message();
      int reached = 0;
      for (const v1::Region& r : map_.regions()) reached += r.kind() != v1::REGION_KIND_UNREACHABLE;
      return reached;
    };
    EXPECT_EQ(count(), row.count);
    testing::Random random(7);
    for (v1::NetworkVertex& vertex : *model.mutable_network()->mutable_vertices()) {
      for (double& x : *vertex.mutable_position()) x += random.Uniform(-0.005, 0.005);
    }
    EXPECT_LE(std::abs(count() - row.count), 2) << "with noise";
  }
  EXPECT_EQ(networks, 2);
}

// The lid and the rim of the teapot lie around its axis. The axis is reported in the program frame.
TEST_F(Regions, SayWhatTheirLinesRunAround) {
  std::ifstream in(PATCHMILL_SOURCE_DIR "/examples/teapot.bpt");
  v1::ModelFile& file = *job_.mutable_source()->mutable_file();
  file.set_format("bpt");
  file.set_content(std::string(std::istreambuf_iterator<char>(in), {}));
  v1::Setup& setup = *job_.mutable_setup();
  setup.set_scale(54.8);
  setup.set_up(v1::UP_AXIS_Y);
  setup.mutable_program_zero()->set_x_mm(5.0);
  setup.mutable_program_zero()->set_y_mm(-2.0);
  Op().clear_heights();
  Op().mutable_tool()->mutable_ball_end()->set_diameter_mm(6.0);
  Op().set_scallop_mm(0.02);
  const auto around = [&] {
    int count = 0;
    for (const v1::Region& region : map_.regions()) {
      if (!region.has_lines_around()) continue;
      ++count;
      EXPECT_NEAR(region.lines_around().x_mm(), -5.0, 1e-3);
      EXPECT_NEAR(region.lines_around().y_mm(), 2.0, 1e-3);
      EXPECT_FALSE(region.has_zigzag_angle_deg());
    }
    return count;
  };
  ASSERT_TRUE(Split().ok());
  EXPECT_EQ(around(), 2);
  Op().set_round_lines(false);
  ASSERT_TRUE(Split().ok());
  EXPECT_EQ(around(), 0);
}

// More equal rims than there may be regions: each part of the region has a place of its own.
TEST_F(Regions, SayWhatTheLinesOfEachPartRunAround) {
  constexpr int kCount = 24;
  PatchModel rims;
  for (int k = 0; k < kCount; ++k)
    rims = testing::Join({rims, testing::Torus(Vec3(60.0 * k, 7, 0), 14, 5, testing::Half::kUpper)});
  *job_.mutable_source()->mutable_model() = ToProto(rims);
  job_.mutable_source()->mutable_model()->set_length_unit(v1::LENGTH_UNIT_MILLIMETER);
  ASSERT_TRUE(Split().ok());
  std::vector<int> found(kCount, 0);
  for (const v1::Region& region : map_.regions()) {
    std::vector<v1::Point2> places(region.more_lines_around().begin(), region.more_lines_around().end());
    if (region.has_lines_around()) places.push_back(region.lines_around());
    EXPECT_TRUE(region.has_lines_around() || places.empty());
    for (const v1::Point2& place : places) {
      EXPECT_NEAR(place.y_mm(), 7.0, 1e-6);
      const double k = std::round(place.x_mm() / 60.0);
      ASSERT_TRUE(k >= 0.0 && k < kCount);
      EXPECT_NEAR(place.x_mm(), 60.0 * k, 1e-6);
      ++found[static_cast<std::size_t>(k)];
    }
  }
  EXPECT_EQ(found, std::vector<int>(kCount, 1));
}

}  // namespace
}  // namespace patchmill
