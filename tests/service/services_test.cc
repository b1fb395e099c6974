// CheckModel, SplitRegions, VerifyProgram, health, limits and draining, through the wire.
#include <cmath>
#include <cstdio>
#include <future>
#include <set>
#include <sstream>
#include <thread>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <grpcpp/generic/generic_stub.h>
#include <gtest/gtest.h>

#include "patchmill/v1/status.pb.h"
#include "server/limits.h"
#include "tests/service/embedded.h"
#include "tests/service/requests.h"
#include "tests/service/status_matchers.h"
#include "tests/support/files.h"
#include "tests/support/sanitized.h"

namespace patchmill {
namespace {

using namespace std::chrono_literals;
using grpc::StatusCode;
using testing::BumpJob;
using ::testing::ElementsAre;
using testing::Embedded;
using ::testing::HasSubstr;
using testing::InfoOf;
using testing::RpcStatusIs;

v1::CheckModelRequest CheckBump() {
  v1::CheckModelRequest request;
  *request.mutable_source()->mutable_model() = testing::Bump();
  return request;
}

TEST(CheckModel, ASoundModelHasABoxAndItsEdges) {
  Embedded embedded;
  v1::CheckModelRequest request = CheckBump();
  request.mutable_setup()->mutable_program_zero()->set_x_mm(2.0);
  request.mutable_tool()->mutable_ball_end()->set_diameter_mm(6);
  v1::CheckModelResponse response;
  ASSERT_TRUE(embedded.Check(request, &response).ok());
  EXPECT_EQ(response.patch_count(), 1);
  EXPECT_EQ(response.open_edge_count(), 4);
  EXPECT_EQ(response.joined_edge_count(), 0);
  EXPECT_EQ(response.model_sha256().size(), 32u);
  // The program frame: the model's [0, 12] shifted by program zero. The bump's top is at (27/64 + ...) =
  // 9/16 height.
  EXPECT_NEAR(response.box().min().x_mm(), -2.0, 1e-6);
  EXPECT_NEAR(response.box().max().x_mm(), 10.0, 1e-6);
  EXPECT_NEAR(response.box().max().z_mm(), 2.0 * 9.0 / 16.0, 1e-6);
}

TEST(CheckModel, FindingsAreDataNeverAStatus) {
  Embedded embedded;
  v1::CheckModelRequest request = CheckBump();
  request.mutable_source()->mutable_model()->mutable_patches(0)->mutable_bezier()->set_degree_u(99);
  v1::CheckModelResponse response;
  ASSERT_TRUE(embedded.Check(request, &response).ok());
  ASSERT_GE(response.diagnostics_size(), 1);
  EXPECT_EQ(response.diagnostics(0).code(), "INVALID_DEGREE");
  EXPECT_EQ(response.diagnostics(0).severity(), v1::SEVERITY_ERROR);
  EXPECT_EQ(response.diagnostics(0).where().patch_index(), 0);
  EXPECT_EQ(response.diagnostics(0).where().patch_id(), "bump");
  EXPECT_FALSE(response.has_box());
}

// Two quads and a triangle around a vertex, no normals given.
v1::PatchModel ThreeFaces() {
  v1::PatchModel model;
  model.set_length_unit(v1::LENGTH_UNIT_MILLIMETER);
  v1::CurveNetwork& network = *model.mutable_network();
  const double places[][3] = {{0, 0, 2}, {10, 0, 1}, {10, 10, 0}, {0, 10, 1}, {-10, 10, 0}, {-10, 0, 1}};
  for (const auto& p : places) network.add_vertices()->mutable_position()->Add(p, p + 3);
  for (const auto& loop : {std::vector<int>{0, 1, 2, 3}, {0, 3, 4, 5}, {0, 1, 5}}) {
    network.add_faces()->mutable_vertices()->Add(loop.begin(), loop.end());
  }
  network.mutable_vertices(1)->mutable_position()->Set(1, -4);
  network.mutable_vertices(5)->mutable_position()->Set(1, -4);
  return model;
}

TEST(CheckModel, MeasuresEveryJointOfACurveNetwork) {
  Embedded embedded;
  v1::CheckModelRequest request;
  *request.mutable_source()->mutable_model() = ThreeFaces();
  v1::CheckModelResponse response;
  ASSERT_TRUE(embedded.Check(request, &response).ok());
  EXPECT_EQ(response.joints_size(), 0);  // not requested
  request.set_continuity_steps(200);
  ASSERT_TRUE(embedded.Check(request, &response).ok());
  EXPECT_EQ(response.patch_count(), 3);
  ASSERT_EQ(response.joints_size(), 3);
  for (const v1::EdgeContinuity& joint : response.joints()) {
    EXPECT_LE(joint.max_gap_mm(), 1e-12);
    EXPECT_LE(joint.max_angle_deg(), 1e-9);
    EXPECT_LT(joint.patch_index(), joint.other_patch_index());
  }
  request.set_continuity_steps(10'001);
  EXPECT_THAT(embedded.Check(request, &response),
              RpcStatusIs(StatusCode::INVALID_ARGUMENT, HasSubstr("continuity_steps = 10001")));
}

// An unused vertex and a dangling edge: findings in one answer.
TEST(CheckModel, FaultsOfANetworkComeTogether) {
  Embedded embedded;
  v1::CheckModelRequest request;
  v1::PatchModel& model = *request.mutable_source()->mutable_model() = ThreeFaces();
  model.mutable_network()->add_vertices()->mutable_position()->Resize(3, 50.0);
  v1::NetworkEdge& edge = *model.mutable_network()->add_edges();
  edge.set_id("stray");
  edge.set_start(2);
  edge.set_end(5);
  v1::CheckModelResponse response;
  ASSERT_TRUE(embedded.Check(request, &response).ok());
  std::multiset<std::string> codes;
  for (const v1::Diagnostic& d : response.diagnostics()) codes.insert(d.code());
  EXPECT_THAT(codes, ElementsAre("DANGLING_EDGE", "UNUSED_VERTEX"));
  EXPECT_FALSE(response.has_box());
}

TEST(CheckModel, AThousandFaultsFitAnAnswer) {
  Embedded embedded;
  v1::CheckModelRequest request;
  v1::PatchModel& model = *request.mutable_source()->mutable_model();
  model.set_length_unit(v1::LENGTH_UNIT_MILLIMETER);
  for (int i = 0; i < 3000; ++i) model.add_patches();
  v1::CheckModelResponse response;
  ASSERT_TRUE(embedded.Check(request, &response).ok());
  EXPECT_EQ(response.diagnostics_size(), static_cast<int>(limits::kMaxDiagnostics) + 1);
  EXPECT_THAT(response.diagnostics().rbegin()->message(), HasSubstr("1000 more"));
}

TEST(CheckModel, AFileWithoutAUnitIsSaidToBeMillimeters) {
  Embedded embedded;
  v1::CheckModelRequest request;
  request.mutable_source()->mutable_file()->set_format("bpt");
  request.mutable_source()->mutable_file()->set_content(testing::ReadRepositoryFile("examples/teapot.bpt"));
  const auto code = [&](double scale) {
    request.mutable_setup()->set_scale(scale);
    request.mutable_tool()->mutable_ball_end()->set_diameter_mm(6);
    v1::CheckModelResponse response;
    EXPECT_TRUE(embedded.Check(request, &response).ok());
    return response.diagnostics_size() == 0 ? "" : response.diagnostics().rbegin()->code();
  };
  EXPECT_EQ(code(1.0), "SUSPICIOUS_SIZE");
  EXPECT_EQ(code(50.0), "UNIT_ASSUMED");
}

TEST(CheckModel, AHugeModelIsRemarkedOnWhateverItsUnit) {
  Embedded embedded;
  const auto has_warning = [&](double scale) {
    v1::CheckModelRequest request = CheckBump();
    request.mutable_setup()->set_scale(scale);
    v1::CheckModelResponse response;
    EXPECT_TRUE(embedded.Check(request, &response).ok());
    return std::any_of(response.diagnostics().begin(), response.diagnostics().end(),
                       [](const v1::Diagnostic& d) { return d.code() == "SUSPICIOUS_SIZE"; });
  };
  EXPECT_FALSE(has_warning(1.0));
  EXPECT_TRUE(has_warning(3000.0));
}

TEST(CheckModel, WrongRequestsAreAStatusWithDetails) {
  Embedded embedded;
  v1::CheckModelResponse response;
  v1::CheckModelRequest request = CheckBump();
  request.mutable_setup()->set_scale(-1);
  request.mutable_tool();
  const grpc::Status status = embedded.Check(request, &response);
  EXPECT_THAT(status, RpcStatusIs(StatusCode::INVALID_ARGUMENT, HasSubstr("setup.scale = -1")));
  EXPECT_EQ(InfoOf(status).reason(), "INVALID_FIELDS");
  EXPECT_EQ(InfoOf(status).violation_count(), 2);

  request = CheckBump();
  request.mutable_source()->set_model_sha256("x");
  EXPECT_EQ(InfoOf(embedded.Check(request, &response)).reason(), "MODEL_NOT_CACHED");
  request.mutable_source()->mutable_file()->set_format("bpt");
  request.mutable_source()->mutable_file()->set_content("1\n3 3\n0 0 0\n");
  EXPECT_EQ(InfoOf(embedded.Check(request, &response)).reason(), "MODEL_UNREADABLE");
  request = CheckBump();
  request.set_max_threads(65);
  EXPECT_THAT(embedded.Check(request, &response),
              RpcStatusIs(StatusCode::INVALID_ARGUMENT, HasSubstr("max_threads = 65")));
}

TEST(CheckModel, AFieldOfANewerContractIsRefused) {
  Embedded embedded;
  v1::CheckModelRequest request = CheckBump();
  v1::Setup& setup = *request.mutable_setup();
  setup.GetReflection()->MutableUnknownFields(&setup)->AddVarint(77, 1);
  v1::CheckModelResponse response;
  EXPECT_THAT(
      embedded.Check(request, &response),
      RpcStatusIs(StatusCode::INVALID_ARGUMENT, HasSubstr("setup.#77 is a field that server version")));
}

class SplitRegions : public ::testing::Test {
 protected:
  grpc::Status Split(const v1::SplitRegionsRequest& request) {
    grpc::ClientContext context;
    return embedded_.analysis->SplitRegions(&context, request, &response_);
  }
  Embedded embedded_;
  v1::SplitRegionsResponse response_;
};

TEST_F(SplitRegions, CoversTheSurface) {
  v1::SplitRegionsRequest request;
  *request.mutable_job() = BumpJob();
  ASSERT_TRUE(Split(request).ok());
  double area = 0.0;
  for (const v1::Region& region : response_.regions().regions()) {
    area += region.area_mm2();
    EXPECT_NE(region.kind(), v1::REGION_KIND_UNSPECIFIED);
    EXPECT_GE(region.border_size(), 1);
  }
  EXPECT_GT(area, 144.0);  // more than its plan
  EXPECT_LT(area, 1.2 * 144.0);
  EXPECT_EQ(response_.regions().regions_sha256().size(), 32u);
  EXPECT_FALSE(response_.has_picture());
  EXPECT_THAT(response_.patch_ids(), ElementsAre("bump"));
  for (const v1::Region& region : response_.regions().regions()) {
    EXPECT_THAT(region.patch_index(), ElementsAre(0));
  }
}

// Grouping and order only: the finest split has more regions over the same surface.
TEST_F(SplitRegions, DetailGroupsTheSameSurface) {
  v1::SplitRegionsRequest request;
  *request.mutable_job() = BumpJob();
  *request.mutable_job()->mutable_source()->mutable_model() = testing::HillAndPit();
  std::vector<int> counts;
  std::vector<double> areas;
  for (const double detail : {0.0, 1.0}) {
    request.mutable_job()->mutable_operations(0)->set_detail(detail);
    ASSERT_TRUE(Split(request).ok());
    counts.push_back(response_.regions().regions_size());
    areas.push_back(0.0);
    for (const v1::Region& region : response_.regions().regions()) areas.back() += region.area_mm2();
  }
  EXPECT_EQ(counts[0], 1);
  EXPECT_GT(counts[1], 1);
  EXPECT_NEAR(areas[0], areas[1], 1e-6 * areas[0]);
}

TEST_F(SplitRegions, DrawsWhenAsked) {
  v1::SplitRegionsRequest request;
  *request.mutable_job() = BumpJob();
  request.add_outputs(v1::OUTPUT_PICTURE);
  ASSERT_TRUE(Split(request).ok());
  EXPECT_THAT(response_.picture().data(), HasSubstr("<svg"));
  EXPECT_FALSE(response_.has_regions());
}

TEST_F(SplitRegions, HasNoProgram) {
  v1::SplitRegionsRequest request;
  *request.mutable_job() = BumpJob();
  request.add_outputs(v1::OUTPUT_PROGRAM);
  EXPECT_THAT(Split(request), RpcStatusIs(StatusCode::INVALID_ARGUMENT, HasSubstr("outputs[0] = 4")));
}

class VerifyProgram : public ::testing::Test {
 protected:
  VerifyProgram() {
    *request_.mutable_source()->mutable_model() = testing::Bump();
    *request_.add_tools() = testing::BallTool();
    request_.set_tolerance_mm(0.02);
    request_.set_program(
        "G21 G90 G17 G54\nG53 G0 Z0\nT1 M6\nG43 H1\nG64 P0.001\nS9000 M3\nG0 X-1 Y6\nG0 Z9\n"
        "G1 Z7 F400\nG1 X13 F900\nG0 Z9\nG53 G0 Z0\nM5\nM9\nM2\n");
  }
  grpc::Status Verify() {
    grpc::ClientContext context;
    const auto reader = embedded_.toolpath->VerifyProgram(&context, request_);
    v1::VerifyProgramResponse response;
    while (reader->Read(&response)) last_ = response;
    return reader->Finish();
  }
  Embedded embedded_;
  v1::VerifyProgramRequest request_;
  v1::VerifyProgramResponse last_;
};

TEST_F(VerifyProgram, AFeedHighAboveThePartIsSafeButFinishesNothing) {
  request_.set_scallop_mm(0.05);
  const grpc::Status status = Verify();
  ASSERT_TRUE(status.ok()) << status.error_message();
  const v1::Report& report = last_.report();
  EXPECT_EQ(report.outcome(), v1::OUTCOME_VERIFICATION_FAILED);
  EXPECT_EQ(report.gouge_check(), v1::CHECK_STATE_PASSED);
  EXPECT_EQ(report.finish_check(), v1::CHECK_STATE_FAILED);
  EXPECT_DOUBLE_EQ(report.max_gouge_mm(), 0.0);
  EXPECT_NEAR(report.tip_z_min_mm(), 7.0, 1e-9);
}

TEST_F(VerifyProgram, WithoutAScallopLeftoverIsMeasuredNotJudged) {
  ASSERT_TRUE(Verify().ok());
  EXPECT_EQ(last_.report().finish_check(), v1::CHECK_STATE_NOT_CHECKED);
  EXPECT_GT(last_.report().max_leftover_mm(), 1.0);
  EXPECT_EQ(last_.report().outcome(), v1::OUTCOME_NO_GOUGE_FOUND);
}

// Nothing is wrong with such a program, and nothing is finished by it.
TEST_F(VerifyProgram, WhereNothingCanBeReachedThereIsNothingToCut) {
  request_.set_floor_z_mm(6.5);
  ASSERT_TRUE(Verify().ok());
  EXPECT_EQ(last_.report().outcome(), v1::OUTCOME_NO_GOUGE_FOUND);
  request_.set_scallop_mm(0.05);
  ASSERT_TRUE(Verify().ok());
  EXPECT_EQ(last_.report().outcome(), v1::OUTCOME_NOTHING_TO_CUT);
  EXPECT_EQ(last_.report().finish_check(), v1::CHECK_STATE_PASSED);
  EXPECT_EQ(last_.report().reachable_area_mm2(), 0.0);
  EXPECT_EQ(last_.report().unreachable_area_mm2(), last_.report().total_area_mm2());
}

TEST_F(VerifyProgram, AGougeIsFoundWithItsLine) {
  std::string program = request_.program();
  program.replace(program.find("G1 Z7"), 5, "G1 Z0");  // 1.125 mm below the bump's top
  request_.set_program(program);
  ASSERT_TRUE(Verify().ok());
  const v1::Report& report = last_.report();
  EXPECT_EQ(report.outcome(), v1::OUTCOME_VERIFICATION_FAILED);
  EXPECT_EQ(report.gouge_check(), v1::CHECK_STATE_FAILED);
  EXPECT_NEAR(report.max_gouge_mm(), 1.125, 0.1);
  EXPECT_EQ(report.max_gouge_at().line(), 10);
  EXPECT_EQ(report.max_gouge_at().patch_id(), "bump");
}

// Without a scallop; with one it is judged.
TEST_F(VerifyProgram, ThatTheFinishIsNotJudgedIsSaid) {
  const auto logged = [&] {
    const auto& all = last_.report().diagnostics();
    return std::any_of(all.begin(), all.end(),
                       [](const v1::Diagnostic& d) { return d.code() == "FINISH_NOT_CHECKED"; });
  };
  ASSERT_TRUE(Verify().ok());
  EXPECT_TRUE(logged());
  EXPECT_EQ(last_.report().finish_check(), v1::CHECK_STATE_NOT_CHECKED);
  request_.set_scallop_mm(0.05);
  ASSERT_TRUE(Verify().ok());
  EXPECT_FALSE(logged());
  EXPECT_NE(last_.report().finish_check(), v1::CHECK_STATE_NOT_CHECKED);
}

TEST_F(VerifyProgram, MovesBeyondTheLimitsAreFoundWithTheirLines) {
  const auto codes = [&] {
    std::string found;
    for (const v1::Diagnostic& d : last_.report().diagnostics()) {
      if (d.code() == "FINISH_NOT_CHECKED") continue;  // of no move
      found += d.code() + fmt::format(" {} ", d.where().line());
    }
    return found;
  };
  for (const double x : {-1.0, -1.0, 13.0, -1.0, 13.0, 13.0, -1.0, 13.0}) {
    request_.mutable_selection()->add_boundary_xy_mm(x);
  }
  ASSERT_TRUE(Verify().ok());
  EXPECT_EQ(codes(), "");
  request_.mutable_selection()->set_boundary_mode(v1::BOUNDARY_MODE_INSIDE);
  ASSERT_TRUE(Verify().ok());
  EXPECT_EQ(last_.report().outcome(), v1::OUTCOME_VERIFICATION_FAILED);
  EXPECT_EQ(last_.report().motion_check(), v1::CHECK_STATE_FAILED);
  EXPECT_THAT(codes(), HasSubstr("OUTSIDE_BOUNDARY 10"));
  request_.clear_selection();
  v1::Obstacle& pin = *request_.mutable_setup()->add_obstacles();
  pin.set_top_z_mm(7.5);
  for (const double x : {5.0, 0.0, 6.0, 0.0, 6.0, 2.9, 5.0, 2.9}) pin.add_outline_xy_mm(x);
  ASSERT_TRUE(Verify().ok());  // the line runs 3.1 mm beside it, the ball has 3
  EXPECT_EQ(codes(), "");
  pin.set_margin_mm(0.2);
  ASSERT_TRUE(Verify().ok());
  EXPECT_EQ(codes(), "OBSTACLE_HIT 10 ");
  // What is not wanted is not counted.
  request_.mutable_setup()->clear_obstacles();
  request_.mutable_selection()->add_avoid_patch_ids("bump");
  ASSERT_TRUE(Verify().ok());
  EXPECT_EQ(last_.report().reachable_area_mm2() + last_.report().unreachable_area_mm2(), 0.0);
}

std::vector<std::string> AssumptionsOf(const v1::Report& report) {
  return {report.assumption_codes().begin(), report.assumption_codes().end()};
}

TEST_F(VerifyProgram, TheVerdictNamesWhatItAssumes) {
  ASSERT_TRUE(Verify().ok());
  EXPECT_THAT(AssumptionsOf(last_.report()), ::testing::IsEmpty());
  const std::string stated = request_.program();
  const auto outcome_of = [&](const std::string& path) {
    std::string program = stated;
    program.replace(program.find("G64 P0.001\n"), 11, path);
    request_.set_program(program);
    EXPECT_TRUE(Verify().ok());
    return last_.report().outcome();
  };
  EXPECT_EQ(outcome_of("G61\n"), v1::OUTCOME_NO_GOUGE_FOUND);
  EXPECT_EQ(outcome_of("G64\n"), v1::OUTCOME_VERIFICATION_FAILED);
  EXPECT_EQ(outcome_of(""), v1::OUTCOME_VERIFICATION_FAILED) << "no better than a bare G64";
  EXPECT_THAT(AssumptionsOf(last_.report()), ::testing::ElementsAre("PATH_MODE_ASSUMED"));
  request_.set_assume_exact_path(true);
  EXPECT_EQ(outcome_of(""), v1::OUTCOME_NO_GOUGE_FOUND);
  EXPECT_THAT(AssumptionsOf(last_.report()), ::testing::ElementsAre("PATH_MODE_ASSUMED"));
  EXPECT_EQ(outcome_of("G64\n"), v1::OUTCOME_VERIFICATION_FAILED) << "it is stated";
}

TEST_F(VerifyProgram, ReferenceReturnsAreJudgedInTheModeInForce) {
  const std::string start = request_.program();
  const auto outcome_of = [&](const std::string& end) {
    std::string program = start;
    program.replace(program.rfind("G53 G0 Z0"), 9, end);
    request_.set_program(program);
    EXPECT_TRUE(Verify().ok()) << end;
    return last_.report().outcome();
  };
  EXPECT_EQ(outcome_of("G91 G28 Z0"), v1::OUTCOME_NO_GOUGE_FOUND);
  EXPECT_THAT(AssumptionsOf(last_.report()), ::testing::ElementsAre("REFERENCE_ASSUMED"));
  EXPECT_EQ(outcome_of("G90 G28 Z0"), v1::OUTCOME_VERIFICATION_FAILED) << "through the part";
  EXPECT_EQ(outcome_of("G53 G0 Z-5"), v1::OUTCOME_NO_GOUGE_FOUND);
  EXPECT_THAT(AssumptionsOf(last_.report()), ::testing::ElementsAre("MACHINE_Z_ASSUMED"));
  request_.set_machine_z_safe_mm(-2);
  EXPECT_THAT(Verify(), RpcStatusIs(StatusCode::INVALID_ARGUMENT, HasSubstr("line 12: G53 with Z below")));
  EXPECT_EQ(outcome_of("G53 G0 Z-2"), v1::OUTCOME_NO_GOUGE_FOUND);
}

// Either way of running the lines of / must be good.
TEST_F(VerifyProgram, DeletableLinesAreJudgedRunAndSkipped) {
  const std::string plain = request_.program();
  const auto findings_of = [&](const std::string& from, const std::string& to) {
    std::string program = plain;
    program.replace(program.find(from), from.size(), to);
    request_.set_program(program);
    EXPECT_TRUE(Verify().ok()) << to;
    std::string text;
    for (const v1::Diagnostic& d : last_.report().diagnostics()) {
      if (d.severity() == v1::SEVERITY_ERROR || d.code() == "DELETABLE_LINES")
        text += d.code() + " " + d.message() + "\n";
    }
    return text;
  };
  EXPECT_EQ(findings_of("M9\n", "M9\n"), "");
  EXPECT_THAT(findings_of("M9\n", "/M9\n"), ::testing::StartsWith("DELETABLE_LINES"));
  EXPECT_EQ(last_.report().outcome(), v1::OUTCOME_NO_GOUGE_FOUND);
  const std::string run = findings_of("G1 X13", "/G1 Z0\nG1 X13");
  EXPECT_THAT(run, AllOf(HasSubstr("GOUGE line 11"), HasSubstr(" (with the lines of / run)")));
  EXPECT_EQ(last_.report().outcome(), v1::OUTCOME_VERIFICATION_FAILED);
  const std::string skipped = findings_of("G1 X13", "G1 Z0\n/G1 Z9\nG1 X13");
  EXPECT_THAT(skipped, HasSubstr(" (with the lines of / skipped)"));
  EXPECT_EQ(last_.report().outcome(), v1::OUTCOME_VERIFICATION_FAILED);
}

TEST_F(VerifyProgram, EachToolIsJudgedByItsOwnMoves) {
  request_.set_program(
      "G21 G90 G17 G54 G61\nG53 G0 Z0\nT1 M6\nG43 H1\nS9000 M3\nG0 X-1 Y6\nG0 Z9\nG1 Z7 F400\nG1 X13 F900\n"
      "G0 Z9\nG53 G0 Z0\nT2 M6\nG43 H2\nS9000 M3\nG0 X-1 Y6\nG0 Z9\nG1 Z4 F400\nG1 X13 F900\nG0 Z9\n"
      "G53 G0 Z0\nM5\nM9\nM2\n");
  EXPECT_THAT(Verify(),
              RpcStatusIs(StatusCode::INVALID_ARGUMENT, HasSubstr("line 12: M6: tool 2 after tool 1")));
  v1::Tool second = request_.tools(0);
  second.set_number(3);
  second.mutable_ball_end()->set_diameter_mm(2);
  *request_.add_tools() = second;
  EXPECT_THAT(Verify(), RpcStatusIs(StatusCode::INVALID_ARGUMENT, HasSubstr("line 15: tool 2 moves")));
  request_.mutable_tools(1)->set_number(2);
  ASSERT_TRUE(Verify().ok());
  const auto text = [&] {
    std::string all;
    for (const v1::Diagnostic& d : last_.report().diagnostics()) all += d.code() + " " + d.message() + "\n";
    return all;
  };
  EXPECT_EQ(last_.report().outcome(), v1::OUTCOME_NO_GOUGE_FOUND) << text();
  EXPECT_THAT(text(), HasSubstr("FINISH_OF_TOOL the finish is that of tool 2"));
  EXPECT_NEAR(last_.report().cut_length_mm(), 2 * (14.0 + 2.0) + 3.0, 1e-6);
  // A tip at Z3 is deep in the bump; the finding names the tool.
  std::string program = request_.program();
  program.replace(program.find("G1 Z4"), 5, "G1 Z0");
  request_.set_program(program);
  ASSERT_TRUE(Verify().ok());
  EXPECT_EQ(last_.report().outcome(), v1::OUTCOME_VERIFICATION_FAILED);
  EXPECT_THAT(text(), AllOf(HasSubstr("GOUGE line 18"), HasSubstr("(tool 2)")));
  EXPECT_THAT(text(), ::testing::Not(HasSubstr("(tool 1)")));
}

TEST_F(VerifyProgram, TheLeftoverMapCoversThePart) {
  request_.set_leftover_map(true);
  request_.set_scallop_mm(0.05);
  request_.set_floor_z_mm(-1);  // then the ball reaches every place
  grpc::ClientContext context;
  const auto reader = embedded_.toolpath->VerifyProgram(&context, request_);
  v1::VerifyProgramResponse response;
  std::string csv, png;
  while (reader->Read(&response)) {
    if (!response.has_artifact()) continue;
    (response.artifact().name() == "leftover.csv" ? csv : png) += response.artifact().data();
  }
  ASSERT_TRUE(reader->Finish().ok());
  ASSERT_TRUE(response.has_report()) << "the report is the last event";
  EXPECT_EQ(png.substr(1, 3), "PNG");
  std::istringstream lines(csv);
  std::string line;
  std::getline(lines, line);
  EXPECT_EQ(line, "x_mm,y_mm,z_mm,leftover_mm,patch");
  double most = 0.0;
  int count = 0;
  while (std::getline(lines, line)) {
    double x = 0, y = 0, z = 0, left = 0;
    int patch = -1;
    ASSERT_EQ(std::sscanf(line.c_str(), "%lf,%lf,%lf,%lf,%d", &x, &y, &z, &left, &patch), 5) << line;
    EXPECT_EQ(patch, 0);
    // The only cut is the line from X-1 to X13 at Y6; its ball's centre is at Z10.
    const double to_line = std::hypot(std::max({-1.0 - x, 0.0, x - 13.0}), y - 6.0, z - 10.0);
    EXPECT_NEAR(left, to_line - 3.0, 1e-3) << line;
    most = std::max(most, left);
    ++count;
  }
  EXPECT_GT(count, 1000);
  EXPECT_NEAR(most, response.report().max_leftover_mm(), 0.3);
}

TEST_F(VerifyProgram, AWordThatCouldMoveIsAnErrorWithItsLine) {
  request_.set_program("G21\nG90\nG5.1 X1 Y1\n");
  const grpc::Status status = Verify();
  EXPECT_THAT(status, RpcStatusIs(StatusCode::INVALID_ARGUMENT, HasSubstr("line 3")));
  EXPECT_EQ(InfoOf(status).reason(), "PROGRAM_UNREADABLE");
}

TEST_F(VerifyProgram, WrongFields) {
  const v1::VerifyProgramRequest good = request_;
  const auto message = [&](auto spoil) {
    request_ = good;
    spoil(request_);
    const grpc::Status status = Verify();
    EXPECT_NE(status.error_code(), StatusCode::OK);
    return status.error_message();
  };
  EXPECT_THAT(message([](auto& r) { r.clear_tools(); }), HasSubstr("tools is missing"));
  EXPECT_THAT(message([](auto& r) { *r.add_tools() = r.tools(0); }),
              HasSubstr("tools[1].number = 1; another tool has it"));
  EXPECT_THAT(message([](auto& r) {
                for (int i = 0; i < 20; ++i) *r.add_tools() = r.tools(0);
              }),
              HasSubstr("tools has 21; at most 20"));
  EXPECT_THAT(message([](auto& r) { r.set_machine_z_safe_mm(1); }),
              HasSubstr("machine_z_safe_mm = 1; must be in [-100000, 0]"));
  EXPECT_THAT(message([](auto& r) { r.clear_program(); }), HasSubstr("program is missing"));
  EXPECT_THAT(message([](auto& r) { r.clear_tolerance_mm(); }), HasSubstr("tolerance_mm = 0"));
  EXPECT_THAT(message([](auto& r) { r.set_scallop_mm(4); }),
              HasSubstr("scallop_mm = 4; must be in (0, ball radius = 3)"));
  EXPECT_THAT(message([](auto& r) { r.set_stock_to_leave_mm(-1); }), HasSubstr("stock_to_leave_mm = -1"));
  EXPECT_THAT(message([](auto& r) { r.set_floor_z_mm(1e9); }), HasSubstr("floor_z_mm = 1000000000"));
  EXPECT_THAT(message([](auto& r) { r.set_dialect("klingon"); }), HasSubstr("dialect = \"klingon\""));
  EXPECT_THAT(message([](auto& r) { r.clear_source(); }), HasSubstr("source is missing"));
  EXPECT_THAT(
      message([](auto& r) { r.mutable_source()->mutable_model()->mutable_patches(0)->clear_shape(); }),
      HasSubstr("patches[0].shape is missing"));
}

// grpc.health.v1 by hand: 0x0A len name; the answer of one that serves is 08 01.
grpc::Status AskHealth(const std::shared_ptr<grpc::Channel>& channel, const std::string& service,
                       std::string* answer) {
  grpc::TemplatedGenericStub<grpc::ByteBuffer, grpc::ByteBuffer> stub(channel);
  grpc::ClientContext context;
  std::string bytes;
  if (!service.empty()) bytes = std::string("\x0A") + static_cast<char>(service.size()) + service;
  grpc::Slice slice(bytes);
  const grpc::ByteBuffer request(&slice, 1);
  grpc::CompletionQueue queue;
  auto reader = stub.PrepareUnaryCall(&context, "/grpc.health.v1.Health/Check", request, &queue);
  reader->StartCall();
  grpc::ByteBuffer response;
  grpc::Status status;
  reader->Finish(&response, &status, nullptr);
  void* tag = nullptr;
  bool ok = false;
  queue.Next(&tag, &ok);
  std::vector<grpc::Slice> slices;
  answer->clear();
  if (status.ok() && response.Dump(&slices).ok()) {
    for (const grpc::Slice& s : slices) answer->append(reinterpret_cast<const char*>(s.begin()), s.size());
  }
  return status;
}

TEST(Health, AnswersForTheServerAndEachService) {
  Embedded embedded;
  std::string answer;
  for (const char* name :
       {"", "patchmill.v1.ModelService", "patchmill.v1.AnalysisService", "patchmill.v1.ToolpathService"}) {
    EXPECT_TRUE(AskHealth(embedded.channel, name, &answer).ok()) << name;
    EXPECT_EQ(answer, std::string("\x08\x01")) << name;
  }
  EXPECT_EQ(AskHealth(embedded.channel, "no.such.Service", &answer).error_code(), StatusCode::NOT_FOUND);
}

TEST(Limits, AMessageBeyond64MebibytesIsRefusedWithItsSize) {
  const Embedded embedded = testing::EmbeddedOnAPort();
  v1::CheckModelRequest request = CheckBump();
  request.mutable_source()->mutable_file()->set_content(std::string(limits::kMaxMessageBytes + 1, ' '));
  v1::CheckModelResponse response;
  const grpc::Status status = embedded.Check(request, &response);
  EXPECT_THAT(status, RpcStatusIs(StatusCode::RESOURCE_EXHAUSTED, HasSubstr("67108864")));
  EXPECT_EQ(InfoOf(status).limit(), "message_bytes");
}

// One job runs, none may wait: the next one is refused. Calls of milliseconds are not.
TEST(Limits, JobsAtOnceAreCountedAndOneEndedMakesRoom) {
  ServerOptions options;
  options.max_jobs = 1;
  options.max_queue = 0;
  Embedded embedded(options);
  grpc::ClientContext context;
  const auto reader = embedded.toolpath->GenerateProgram(&context, testing::LongRequest());
  v1::GenerateProgramResponse event;
  ASSERT_TRUE(reader->Read(&event));
  ASSERT_TRUE(reader->Read(&event));  // progress: it runs
  v1::SplitRegionsRequest request;
  *request.mutable_job() = BumpJob();
  v1::SplitRegionsResponse regions;
  const auto split = [&] {
    grpc::ClientContext other;
    return embedded.analysis->SplitRegions(&other, request, &regions);
  };
  const grpc::Status refused = split();
  EXPECT_EQ(refused.error_code(), StatusCode::RESOURCE_EXHAUSTED);
  EXPECT_EQ(InfoOf(refused).reason(), "TOO_MANY_JOBS");
  v1::CheckModelResponse response;
  EXPECT_TRUE(embedded.Check(CheckBump(), &response).ok());
  context.TryCancel();
  while (reader->Read(&event)) {
  }
  EXPECT_EQ(reader->Finish().error_code(), StatusCode::CANCELLED);
  grpc::Status status = split();
  for (int i = 0; i < 100 && !status.ok(); ++i) {
    std::this_thread::sleep_for(20ms);
    status = split();
  }
  EXPECT_TRUE(status.ok()) << status.error_message();
}

// A refusal says when to come again, in the details and to gRPC's own retries.
TEST(Limits, ARefusalHasRetryInfo) {
  ServerOptions options;
  options.max_jobs = 1;
  options.max_queue = 0;
  Embedded embedded(options);
  grpc::ClientContext running;
  const auto reader = embedded.toolpath->GenerateProgram(&running, testing::LongRequest());
  v1::GenerateProgramResponse event;
  ASSERT_TRUE(reader->Read(&event));
  ASSERT_TRUE(reader->Read(&event));
  v1::SplitRegionsRequest request;
  *request.mutable_job() = BumpJob();
  v1::SplitRegionsResponse regions;
  grpc::ClientContext context;
  const grpc::Status refused = embedded.analysis->SplitRegions(&context, request, &regions);
  v1::Status details;
  ASSERT_TRUE(details.ParseFromString(refused.error_details()));
  ASSERT_EQ(details.details_size(), 2);
  EXPECT_EQ(details.details(1).type_url(), "type.googleapis.com/google.rpc.RetryInfo");
  v1::RetryInfo retry;
  ASSERT_TRUE(retry.ParseFromString(details.details(1).value()));
  EXPECT_GT(retry.retry_delay().seconds(), 0);
  const auto& trailers = context.GetServerTrailingMetadata();
  const auto pushback = trailers.find("grpc-retry-pushback-ms");
  ASSERT_NE(pushback, trailers.end());
  EXPECT_EQ(std::string(pushback->second.data(), pushback->second.size()), "2000");
  running.TryCancel();
  while (reader->Read(&event)) {
  }
  (void)reader->Finish();
}

// Over a port: the in-process transport knows no gentle end.
TEST(Drain, LetsARunningCallEndAndRefusesNewOnes) {
  const Embedded embedded = testing::EmbeddedOnAPort();
  grpc::ClientContext context;
  const auto reader = embedded.toolpath->GenerateProgram(&context, testing::LongRequest());
  v1::GenerateProgramResponse event;
  ASSERT_TRUE(reader->Read(&event));
  std::future<void> drained = std::async(std::launch::async, [&] { embedded.server->Drain(0.7); });
  std::this_thread::sleep_for(200ms);
  EXPECT_NE(drained.wait_for(0s), std::future_status::ready);  // the job is still running
  // The port stays open, so that everybody learns why.
  v1::CheckModelResponse response;
  const grpc::Status refused = embedded.Check(CheckBump(), &response);
  EXPECT_EQ(refused.error_code(), StatusCode::UNAVAILABLE);
  EXPECT_EQ(InfoOf(refused).reason(), "DRAINING");
  std::string health;
  EXPECT_TRUE(AskHealth(embedded.channel, "", &health).ok());
  EXPECT_EQ(health, std::string("\x08\x02"));
  while (reader->Read(&event)) {
  }
  const grpc::Status ended = reader->Finish();  // cut off after its time
  EXPECT_EQ(ended.error_code(), StatusCode::UNAVAILABLE);
  EXPECT_EQ(InfoOf(ended).reason(), "DRAINING");
  EXPECT_EQ(drained.wait_for(testing::kSanitized ? 20s : 2s), std::future_status::ready);
}

}  // namespace
}  // namespace patchmill
