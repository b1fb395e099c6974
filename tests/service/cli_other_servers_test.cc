// Servers that are no Patchmill, or send what no Patchmill sends.
#include <string>
#include <utility>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <grpcpp/security/server_credentials.h>
#include <grpcpp/server.h>
#include <grpcpp/server_builder.h>
#include <gtest/gtest.h>

#include "patchmill/v1/toolpath_service.grpc.pb.h"
#include "tests/service/patchmill.h"
#include "tests/service/requests.h"

namespace patchmill {
namespace {

using testing::Finished;
using ::testing::HasSubstr;
using testing::Patchmill;
using testing::Slurp;
using testing::TempDir;
using ::testing::UnorderedElementsAre;

// Answers every job with this triangle and a program of one line.
class OneTriangle final : public v1::ToolpathService::Service {
 public:
  explicit OneTriangle(int third_corner) : third_corner_(third_corner) {}

 private:
  grpc::Status GenerateProgram(grpc::ServerContext*, const v1::GenerateProgramRequest*,
                               grpc::ServerWriter<v1::GenerateProgramResponse>* writer) override {
    const std::string program = "G21\n";
    v1::GenerateProgramResponse mesh, chunk, report;
    v1::MeshBlock& block = *mesh.mutable_mesh();
    for (const float x : {0.F, 0.F, 0.F, 9.F, 0.F, 0.F, 0.F, 9.F, 0.F}) block.add_position_mm(x);
    for (int vertex = 0; vertex < 3; ++vertex) {
      for (const float x : {0.F, 0.F, 1.F}) block.add_normal(x);
      block.add_slope_deg(0.F);
      block.add_contour_curvature_per_mm(0.F);
      block.add_leftover_mm(0.F);
      block.add_gouge_mm(0.F);
    }
    for (const int corner : {0, 1, third_corner_}) block.add_corners(corner);
    block.add_patch_index(0);
    block.add_region_id(-1);
    chunk.mutable_program()->set_data(program);
    report.mutable_report()->set_outcome(v1::OUTCOME_COMPLETE);
    report.mutable_report()->set_program_size_bytes(static_cast<int>(program.size()));
    for (const v1::GenerateProgramResponse* response : {&mesh, &chunk, &report}) writer->Write(*response);
    return grpc::Status::OK;
  }

  int third_corner_;
};

class OtherServer {
 public:
  explicit OtherServer(int third_corner) : service_(third_corner) {
    grpc::ServerBuilder builder;
    builder.AddListeningPort("127.0.0.1:0", grpc::InsecureServerCredentials(), &port_);
    builder.RegisterService(&service_);
    server_ = builder.BuildAndStart();
  }
  std::string target() const { return fmt::format("127.0.0.1:{}", port_); }

 private:
  OneTriangle service_;
  int port_ = 0;
  std::unique_ptr<grpc::Server> server_;
};

TEST(CliOtherServers, ACallThatIsNotThereIsSaidSo) {
  const TempDir dir;
  const OtherServer server(2);
  const std::string model = dir.Write("bump.pb", testing::Bump().SerializeAsString());
  const Finished run = Patchmill({"check", model, "--server", server.target()});
  EXPECT_EQ(run.status, 2);
  EXPECT_THAT(run.err,
              HasSubstr(server.target() + " has no such call: it is no server of Patchmill, or one of "
                                          "another version"));
}

// The program and the report are whole and are written; what would be drawn from damaged data is not.
TEST(CliOtherServers, DamagedTrianglesMakeNoPageAndNoPicture) {
  const TempDir in;
  const std::string model = in.Write("bump.pb", testing::Bump().SerializeAsString());
  for (const int corner : {2, 3, 2'000'000'000, -1}) {
    const OtherServer server(corner);
    for (const char* preview : {"part.html", "part.png"}) {
      const TempDir out;
      const Finished run = Patchmill({"mill", model, "-o", out / "part.ngc", "--report", out / "part.json",
                                      "--preview", out / preview, "--server", server.target()});
      if (corner == 2) {
        EXPECT_EQ(run.status, 0) << run.err;
        EXPECT_THAT(out.Names(), UnorderedElementsAre("part.ngc", "part.json", preview));
        continue;
      }
      EXPECT_EQ(run.status, 1) << run.err;
      EXPECT_THAT(run.err, HasSubstr("the answer of the server is damaged: mesh.corners[2] = "));
      EXPECT_THAT(out.Names(), UnorderedElementsAre("part.ngc", "part.json"));
      EXPECT_EQ(Slurp(out / "part.ngc"), "G21\n");
    }
  }
}

}  // namespace
}  // namespace patchmill
