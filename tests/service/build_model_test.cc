// BuildModel through the wire: skins, boundary surfaces, normals of a network, units, refusals. FairNet, too.
#include <cmath>

#include <gmock/gmock.h>
#include <google/protobuf/util/json_util.h>
#include <gtest/gtest.h>

#include "server/convert/model.h"
#include "tests/service/embedded.h"
#include "tests/service/status_matchers.h"
#include "tests/support/random.h"

namespace patchmill {
namespace {

using grpc::StatusCode;
using testing::Embedded;
using ::testing::HasSubstr;
using testing::RpcStatusIs;
using ::testing::StartsWith;

const Embedded& Server() {
  static Embedded embedded;
  return embedded;
}

v1::BuildModelRequest FromJson(const std::string& text) {
  v1::BuildModelRequest request;
  const auto status = google::protobuf::util::JsonStringToMessage(text, &request);
  EXPECT_TRUE(status.ok()) << std::string(status.message());
  return request;
}
grpc::Status Build(const v1::BuildModelRequest& request, v1::BuildModelResponse* response) {
  grpc::ClientContext context;
  return Server().model->BuildModel(&context, request, response);
}

const char kSections[] = R"({"length_unit": "LENGTH_UNIT_INCH",
  "sections": {"curves": [{"bezier": {"points": [0, 0, 0, 1, 0, 1, 2, 0, 0]}},
                          {"bezier": {"points": [0, 1, 0, 1, 1, 2, 2, 1, 0]}},
                          {"bspline": {"degree": 1, "knots": [0, 0, 0.5, 1, 1], "points": [0, 2, 0, 1, 2, 1, 2, 2, 0]}}]},
  "network": {"vertices": [{"position": [0.5, 0.5, 0.5]}, {"position": [1.5, 0.5, 0.5]}, {"position": [1.5, 1.5, 0.5]},
                           {"position": [0.5, 1.5, 0.5], "normals": [{"direction": [0, 0, 2]}]}],
              "faces": [{"vertices": [0, 1, 2, 3]}]}})";

TEST(BuildModel, SkinAndNormalsOfItsNetwork) {
  v1::BuildModelResponse response;
  const grpc::Status status = Build(FromJson(kSections), &response);
  ASSERT_TRUE(status.ok()) << status.error_message();
  EXPECT_EQ(response.diagnostics_size(), 0);
  const auto model = FromProto(response.model(), "m");
  ASSERT_TRUE(model.ok() && model->faults.empty());
  ASSERT_EQ(model->model.patches.size(), 1u);
  EXPECT_EQ(model->model.patches[0].id, "outline");
  // The middle of the first section, in mm.
  EXPECT_LE((Position(model->model.patches[0].shape, 0.5, 0) - 25.4 * Vec3(1, 0, 0.5)).norm(), 1e-12);
  const v1::PatchModel& network = response.network_model();
  EXPECT_EQ(network.length_unit(), v1::LENGTH_UNIT_INCH);
  ASSERT_EQ(network.network().vertices_size(), 4);
  for (const v1::NetworkVertex& vertex : network.network().vertices()) ASSERT_EQ(vertex.normals_size(), 1);
  EXPECT_EQ(network.network().vertices(3).normals(0).direction(2), 2.0);  // given, kept
  // The skin is the same mirrored in x = 1: so are the normals.
  for (int k = 0; k < 3; ++k) {
    EXPECT_NEAR(network.network().vertices(0).normals(0).direction(k),
                (k == 0 ? -1 : 1) * network.network().vertices(1).normals(0).direction(k), 1e-6);
  }
  EXPECT_GT(response.max_distance_mm(), 0.0);
  EXPECT_GE(response.farthest_vertex(), 0);
}

const char kBoundary[] = R"({"length_unit": "LENGTH_UNIT_MILLIMETER", "boundary": {"curves": [
    {"bezier": {"points": [0, 0, 0, 5, 0, 3, 10, 0, 0]}}, {"bezier": {"points": [10, 0, 0, 10, 10, 2]}},
    {"bezier": {"points": [0, 10, 0, 5, 10, 1, 10, 10, 2]}}, {"bezier": {"points": [0, 0, 0, 0, 10, 0]}}]}})";

TEST(BuildModel, BoundariesAsCoonsAndHosaka) {
  v1::BuildModelRequest request = FromJson(kBoundary);
  v1::BuildModelResponse coons, hosaka;
  ASSERT_TRUE(Build(request, &coons).ok());
  EXPECT_TRUE(coons.model().patches(0).has_bspline());
  EXPECT_FALSE(coons.has_network_model());
  request.mutable_boundary()->set_span(v1::BOUNDARY_SPAN_HOSAKA);
  ASSERT_TRUE(Build(request, &hosaka).ok());
  EXPECT_TRUE(hosaka.model().patches(0).has_hosaka());
  const PatchModel a = FromProto(coons.model(), "m")->model, b = FromProto(hosaka.model(), "m")->model;
  for (const double t : {0.0, 0.3, 1.0}) {  // the same boundary
    for (const Vec2& q : {Vec2(t, 0), Vec2(1, t), Vec2(t, 1), Vec2(0, t)}) {
      EXPECT_LE(
          (Position(a.patches[0].shape, q.x(), q.y()) - Position(b.patches[0].shape, q.x(), q.y())).norm(),
          1e-13);
    }
  }
}

TEST(BuildModel, RefusesWithTheField) {
  const auto refused = [](const v1::BuildModelRequest& request, const std::string& text) {
    v1::BuildModelResponse response;
    const grpc::Status status = Build(request, &response);
    EXPECT_THAT(status, RpcStatusIs(StatusCode::INVALID_ARGUMENT, HasSubstr(text)));
    ASSERT_EQ(testing::InfoOf(status).field_violations_size(), 1);
    EXPECT_THAT(text, StartsWith(testing::InfoOf(status).field_violations(0).field()));
  };
  v1::BuildModelRequest request = FromJson(kBoundary);
  request.clear_length_unit();
  refused(request, "length_unit is missing; add");
  request = FromJson(kBoundary);
  request.mutable_boundary()->mutable_curves()->RemoveLast();
  refused(request, "boundary.curves are 3; must be 4");
  request = FromJson(kBoundary);
  request.mutable_boundary()->mutable_curves(2)->mutable_bezier()->set_points(0, 1);
  refused(request, "boundary.curves end");
  request = FromJson(kBoundary);
  request.mutable_boundary()->set_span(static_cast<v1::BoundarySpan>(9));
  refused(request, "boundary.span = 9");
  request = FromJson(kSections);
  request.mutable_sections()->mutable_curves(1)->mutable_bezier()->add_points(1);
  refused(request, "sections.curves[1].bezier.points has 10 numbers");
  request = FromJson(kSections);
  request.mutable_sections()->mutable_curves(2)->mutable_bspline()->set_degree(7);
  refused(request, "sections.curves[2] is none: a curve of degree 7");
  request = FromJson(kSections);
  request.clear_outline();
  request.clear_network();
  refused(request, "outline");
}

TEST(BuildModel, ANetworkThatCannotBeJoinedSaysWhy) {
  v1::BuildModelRequest request = FromJson(kSections);
  request.mutable_network()->mutable_faces(0)->set_vertices(0, 7);
  v1::BuildModelResponse response;
  ASSERT_TRUE(Build(request, &response).ok());
  ASSERT_EQ(response.diagnostics_size(), 1);
  EXPECT_EQ(response.diagnostics(0).code(), "INVALID_REFERENCE");
  EXPECT_TRUE(response.has_model());
}

// A noisy net: the border stays, the energy falls strictly, locked points and components stay.
TEST(FairNet, FairsWithinItsTerms) {
  testing::Random random(2);
  v1::FairNetRequest request;
  request.set_line_count(8);
  for (int i = 0; i < 8; ++i) {
    for (int j = 0; j < 6; ++j) {
      for (const double number : {10.0 * i, 10.0 * j, 0.02 * i * i + random.Uniform(-0.3, 0.3)}) {
        request.mutable_points()->add_points_mm(number);
      }
    }
  }
  request.add_axes(v1::AXIS_Z);
  request.mutable_band()->set_z_mm(0.25);
  request.add_locks()->set_point_index(15);
  v1::FairNetResponse response;
  const auto fair = [](const v1::FairNetRequest& r, v1::FairNetResponse* to) {
    grpc::ClientContext context;
    return Server().model->FairNet(&context, r, to);
  };
  const grpc::Status status = fair(request, &response);
  ASSERT_TRUE(status.ok()) << status.error_message();
  ASSERT_EQ(response.points_mm_size(), 144);
  ASSERT_EQ(response.energies_size(), response.iteration_count() + 1);
  ASSERT_GT(response.iteration_count(), 0);
  for (int k = 1; k < response.energies_size(); ++k)
    EXPECT_LT(response.energies(k), response.energies(k - 1));
  double farthest = 0.0;
  for (int p = 0; p < 48; ++p) {
    const int i = p / 6, j = p % 6;
    const double moved = response.points_mm(3 * p + 2) - request.points().points_mm(3 * p + 2);
    EXPECT_EQ(response.points_mm(3 * p), request.points().points_mm(3 * p));
    if (i == 0 || j == 0 || i == 7 || j == 5 || p == 15) {
      EXPECT_EQ(moved, 0.0) << p;
    }
    EXPECT_LE(std::abs(moved), 0.25 + 1e-12);
    farthest = std::max(farthest, std::abs(moved));
  }
  EXPECT_NEAR(response.max_moved_mm(), farthest, 1e-12);
  request.set_line_count(7);
  EXPECT_THAT(fair(request, &response),
              RpcStatusIs(StatusCode::INVALID_ARGUMENT, HasSubstr("line_count = 7 of 48 points")));
  request.clear_net();
  EXPECT_THAT(fair(request, &response), RpcStatusIs(StatusCode::INVALID_ARGUMENT, HasSubstr("net")));
}

}  // namespace
}  // namespace patchmill
