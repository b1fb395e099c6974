// Set-ups that name a face, or leave what points up to the service: the job is that of the axis.
#include <sstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/network/control_points.h"
#include "server/convert/model.h"
#include "tests/service/embedded.h"
#include "tests/service/patchmill.h"
#include "tests/service/process.h"
#include "tests/service/requests.h"
#include "tests/service/status_matchers.h"
#include "tests/support/faced_box.h"

namespace patchmill {
namespace {

using grpc::StatusCode;
using ::testing::AllOf;
using testing::Embedded;
using testing::Finished;
using ::testing::HasSubstr;
using testing::RpcStatusIs;
using testing::Slurp;
using testing::TempDir;

const Embedded& Server() {
  static Embedded embedded;
  return embedded;
}

// A box of 20 x 10 x 10 that lies along y.
PatchModel Bar(const Mat3& turn = Mat3::Identity()) {
  PatchModel model = testing::FacedBox(10.0, 2);
  for (Patch& patch : model.patches) {
    for (Vec3& p : ControlPoints(patch.shape)) p = turn * Vec3(p.x(), 2.0 * p.y(), p.z());
  }
  return model;
}

v1::GenerateProgramRequest Request(const PatchModel& model) {
  v1::GenerateProgramRequest request = testing::BumpRequest();
  *request.mutable_job()->mutable_source()->mutable_model() = ToProto(model);
  request.mutable_job()->mutable_operations(0)->mutable_heights()->clear_floor_z_mm();
  return request;
}

// The lines that are no comments.
std::string Moves(const std::string& program) {
  std::string kept;
  std::istringstream in(program);
  for (std::string line; std::getline(in, line);) {
    if (line.find('(') == std::string::npos) kept += line + "\n";
  }
  return kept;
}

bool Has(const v1::Report& report, const std::string& code) {
  for (const v1::Diagnostic& finding : report.diagnostics()) {
    if (finding.code() == code) return true;
  }
  return false;
}

TEST(Up, AutomaticAndAFaceGiveTheProgramOfTheirAxis) {
  // The long sides show as much as each other; the first of them is taken.
  v1::GenerateProgramRequest request = Request(Bar());
  request.mutable_job()->mutable_setup()->set_up(v1::UP_AXIS_X);
  const auto named = Server().Generate(request);
  ASSERT_TRUE(named.status.ok()) << named.status.error_message();
  ASSERT_NE(named.Report(), nullptr);
  EXPECT_FALSE(Has(*named.Report(), "UP_CHOSEN"));
  request.mutable_job()->mutable_setup()->clear_up();
  request.mutable_job()->mutable_setup()->set_up_face("f4");
  const auto by_face = Server().Generate(request);
  ASSERT_TRUE(by_face.status.ok()) << by_face.status.error_message();
  EXPECT_EQ(Moves(by_face.Program()), Moves(named.Program()));
  EXPECT_TRUE(Has(*by_face.Report(), "UP_CHOSEN"));
  EXPECT_THAT(by_face.Program(), HasSubstr("UP_CHOSEN: face f4"));
  EXPECT_EQ(by_face.events.front().accepted().resolved_job().setup().up_face(), "f4");
  EXPECT_NE(by_face.events.front().accepted().request_sha256(),
            named.events.front().accepted().request_sha256());

  request.mutable_job()->mutable_setup()->clear_up_face();
  request.mutable_job()->mutable_setup()->set_up(v1::UP_AXIS_AUTO);
  const auto chosen = Server().Generate(request);
  ASSERT_TRUE(chosen.status.ok()) << chosen.status.error_message();
  EXPECT_EQ(chosen.events.front().accepted().resolved_job().setup().up(), v1::UP_AXIS_Z);
  EXPECT_THAT(chosen.Program(), HasSubstr("UP_CHOSEN: z points up, of the six axes"));
  EXPECT_EQ(Server().Generate(request).Program(), chosen.Program());
}

TEST(Up, ASlantingFaceIsMilledLevelAndVerifiedWithTheSameSetup) {
  const Mat3 turn = Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()).matrix();
  v1::GenerateProgramRequest request = Request(Bar(turn));
  request.mutable_job()->mutable_setup()->set_up_face("f2");
  request.mutable_job()->mutable_setup()->set_zero_anchor(v1::ZERO_ANCHOR_TOP_CENTER);
  request.mutable_job()->mutable_operations(0)->mutable_selection()->add_patch_ids("f2");
  const auto made = Server().Generate(request);
  ASSERT_TRUE(made.status.ok()) << made.status.error_message();
  ASSERT_NE(made.Report(), nullptr);
  EXPECT_EQ(made.Report()->outcome(), v1::OUTCOME_COMPLETE);
  EXPECT_NEAR(made.Report()->tip_z_min_mm(), 0.0, 0.02);  // the lid, within the tolerance

  v1::VerifyProgramRequest verify;
  *verify.mutable_source() = request.job().source();
  *verify.mutable_setup() = request.job().setup();
  verify.set_program(made.Program());
  *verify.add_tools() = request.job().operations(0).tool();
  verify.set_tolerance_mm(0.02);
  verify.set_scallop_mm(0.05);
  *verify.mutable_selection() = request.job().operations(0).selection();
  grpc::ClientContext context;
  const auto reader = Server().toolpath->VerifyProgram(&context, verify);
  v1::VerifyProgramResponse response;
  v1::Report report;
  while (reader->Read(&response)) {
    if (response.has_report()) report = response.report();
  }
  ASSERT_TRUE(reader->Finish().ok());
  EXPECT_EQ(report.outcome(), v1::OUTCOME_COMPLETE);
  EXPECT_TRUE(Has(report, "UP_CHOSEN"));
}

TEST(Up, RefusesWithTheField) {
  v1::GenerateProgramRequest request = Request(Bar());
  v1::Setup& setup = *request.mutable_job()->mutable_setup();
  setup.set_up_face("f9");
  EXPECT_THAT(
      Server().Generate(request).status,
      RpcStatusIs(StatusCode::INVALID_ARGUMENT, HasSubstr("job.setup.up_face = \"f9\"; must be a plane")));
  setup.set_up(v1::UP_AXIS_AUTO);
  EXPECT_THAT(
      Server().Generate(request).status,
      RpcStatusIs(StatusCode::INVALID_ARGUMENT, HasSubstr("job.setup.up is set together with up_face")));
  setup.clear_up_face();
  *request.mutable_job()->mutable_source()->mutable_model() = testing::Bump();
  EXPECT_THAT(Server().Generate(request).status,
              RpcStatusIs(StatusCode::INVALID_ARGUMENT, HasSubstr("job.setup.up is automatic")));
  v1::CheckModelRequest check;
  *check.mutable_source() = request.job().source();
  check.mutable_setup()->set_up(v1::UP_AXIS_AUTO);
  v1::CheckModelResponse response;
  EXPECT_THAT(Server().Check(check, &response),
              RpcStatusIs(StatusCode::INVALID_ARGUMENT, HasSubstr("setup.up is automatic")));
}

TEST(Up, EveryCommandTakesIt) {
  const TempDir dir;
  const std::string bar = dir.Write("bar.pb", ToProto(Bar()).SerializeAsString());
  for (const std::string up : {"auto", "f4"}) {
    SCOPED_TRACE(up);
    for (std::vector<std::string> command : testing::CommandsOn(bar, dir, "0.02", "0.05")) {
      command.insert(command.end(), {"--up", up});
      const Finished done = testing::Patchmill(command);
      EXPECT_EQ(done.status, 0) << command.front() << ": " << done.err << done.out;
    }
  }
  EXPECT_THAT(testing::Patchmill({"check", bar, "--up", "f4"}).out,
              AllOf(HasSubstr("INFO UP_CHOSEN face f4: face f4 (wall) points up"),
                    HasSubstr("to X 0.000 Y 20.000 Z 10.000")));
  EXPECT_THAT(testing::Patchmill({"mill", bar, "-o", dir / "part.ngc", "--up", "auto"}).err,
              HasSubstr("UP_CHOSEN: z points up"));
  const Finished none = testing::Patchmill({"mill", bar, "-o", dir / "none.ngc", "--up", "q"});
  EXPECT_EQ(none.status, 2);
  EXPECT_THAT(none.err, HasSubstr("--up: job.setup.up_face = \"q\"; must be a plane face of the model"));
}

}  // namespace
}  // namespace patchmill
