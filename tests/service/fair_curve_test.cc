// FairCurve through the wire: points and files, every field, limits, the picture.
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "server/limits.h"
#include "tests/service/embedded.h"
#include "tests/service/status_matchers.h"
#include "tests/support/random.h"

namespace patchmill {
namespace {

using grpc::StatusCode;
using testing::Embedded;
using ::testing::HasSubstr;
using testing::InfoOf;
using testing::RpcStatusIs;

grpc::Status Fair(const v1::FairCurveRequest& request, v1::FairCurveResponse* response) {
  static Embedded embedded;
  grpc::ClientContext context;
  return embedded.model->FairCurve(&context, request, response);
}

v1::FairCurveRequest Noisy(int n) {
  v1::FairCurveRequest request;
  testing::Random random(1);
  for (int i = 0; i < n; ++i) {
    const double x = 100.0 * i / (n - 1);
    for (const double number : {x, 20 * std::sin(x / 20), 5 * std::cos(x / 30)}) {
      request.mutable_points()->add_points_mm(number + random.Uniform(-0.1, 0.1));
    }
  }
  return request;
}

double Moved(const v1::FairCurveRequest& request, const v1::FairCurveResponse& response, int i) {
  return response.points_mm(i) - request.points().points_mm(i);
}

TEST(FairCurve, PointsGoInAndComeOutFairer) {
  const v1::FairCurveRequest request = Noisy(60);
  v1::FairCurveResponse response;
  ASSERT_TRUE(Fair(request, &response).ok());
  EXPECT_TRUE(response.settled());
  ASSERT_EQ(response.points_mm_size(), 180);
  ASSERT_EQ(response.energies_size(), response.iteration_count() + 1);
  for (int k = 1; k < response.energies_size(); ++k)
    EXPECT_LT(response.energies(k), response.energies(k - 1));
  EXPECT_LT(response.energies(response.energies_size() - 1), 0.5 * response.energies(0));
  EXPECT_EQ(response.curvatures_before_size(), 180);
  EXPECT_EQ(response.curvatures_after_size(), 180);
  EXPECT_EQ(response.polyline_mm_size(), 0);
  EXPECT_FALSE(response.has_picture());
  double farthest = 0;
  for (int p = 0; p < 60; ++p) {
    double square = 0;
    for (int a = 0; a < 3; ++a) square += std::pow(Moved(request, response, 3 * p + a), 2);
    farthest = std::max(farthest, std::sqrt(square));
  }
  EXPECT_NEAR(response.max_moved_mm(), farthest, 1e-12);
}

TEST(FairCurve, EveryFieldCounts) {
  v1::FairCurveRequest request = Noisy(60);
  request.add_axes(v1::AXIS_Y);
  request.add_axes(v1::AXIS_Z);
  request.mutable_band()->set_y_mm(0.05);
  request.mutable_band()->set_fraction(0.0001);
  request.add_locks()->set_point_index(20);
  request.add_locks()->set_point_index(30);
  request.mutable_locks(1)->add_axes(v1::AXIS_Z);
  for (const double d : {0.0, 3.0, 0.0}) request.add_start_direction(d);
  for (const double d : {1.0, 0.0, 0.0}) request.add_end_direction(d);
  request.set_max_iterations(7);
  request.set_stop(v1::FAIRING_STOP_ITERATIONS);
  request.set_band_rule(v1::BAND_RULE_LEAST_ENERGY);
  request.set_polyline_tolerance_mm(0.001);
  request.set_picture(true);
  request.set_name("a line");
  v1::FairCurveResponse response;
  ASSERT_TRUE(Fair(request, &response).ok());
  EXPECT_EQ(response.iteration_count(), 7);
  EXPECT_FALSE(response.settled());
  double most_y = 0, most_z = 0;
  for (int p = 0; p < 60; ++p) {
    EXPECT_EQ(Moved(request, response, 3 * p), 0.0);
    most_y = std::max(most_y, std::abs(Moved(request, response, 3 * p + 1)));
    most_z = std::max(most_z, std::abs(Moved(request, response, 3 * p + 2)));
  }
  EXPECT_NEAR(most_y, 0.05, 1e-12);
  EXPECT_GT(most_z, 0.009);  // 1/10000 of the diagonal of about 108
  EXPECT_LT(most_z, 0.012);
  EXPECT_EQ(Moved(request, response, 61), 0.0);
  EXPECT_EQ(Moved(request, response, 92), 0.0);
  EXPECT_NE(Moved(request, response, 91), 0.0);
  ASSERT_GT(response.polyline_mm_size(), 3 * 60);
  EXPECT_NEAR(response.polyline_mm(3), response.polyline_mm(0),
              0.1 * (response.polyline_mm(4) - response.polyline_mm(1)));
  EXPECT_EQ(response.picture().media_type(), "image/svg+xml");
  EXPECT_THAT(response.picture().data(), HasSubstr("a line"));
}

TEST(FairCurve, AFileIsReadByTheServer) {
  v1::FairCurveRequest request;
  request.mutable_file()->set_format("dat");
  request.mutable_file()->set_content("A foil\n0 0\n1 0.2\n2 0.1\n3 0\n");
  request.set_max_iterations(0);
  v1::FairCurveResponse response;
  ASSERT_TRUE(Fair(request, &response).ok());
  EXPECT_EQ(response.title(), "A foil");
  EXPECT_TRUE(response.planar());
  ASSERT_EQ(response.points_mm_size(), 12);
  EXPECT_EQ(response.points_mm(4), 0.2);
  EXPECT_EQ(response.iteration_count(), 0);
  request.mutable_file()->set_content("A foil\n0 0\n1 x\n");
  EXPECT_THAT(Fair(request, &response),
              RpcStatusIs(StatusCode::INVALID_ARGUMENT, HasSubstr("line 3: \"x\"")));
}

TEST(FairCurve, WrongFieldsAreAllNamed) {
  v1::FairCurveRequest request = Noisy(10);
  request.add_axes(v1::AXIS_UNSPECIFIED);
  request.mutable_band()->set_x_mm(-1);
  request.add_locks()->set_point_index(10);
  request.add_start_direction(1);
  for (int k = 0; k < 3; ++k) request.add_end_direction(0);
  request.set_max_iterations(-1);
  request.set_polyline_tolerance_mm(0);
  request.set_stop(static_cast<v1::FairingStop>(99));
  request.set_band_rule(static_cast<v1::BandRule>(99));
  request.set_name(std::string(101, 'n'));
  v1::FairCurveResponse response;
  const grpc::Status status = Fair(request, &response);
  EXPECT_EQ(status.error_code(), StatusCode::INVALID_ARGUMENT);
  EXPECT_EQ(InfoOf(status).violation_count(), 10) << InfoOf(status).DebugString();
}

TEST(FairCurve, LimitsAndMissingThings) {
  v1::FairCurveResponse response;
  v1::FairCurveRequest none;
  EXPECT_THAT(Fair(none, &response),
              RpcStatusIs(StatusCode::INVALID_ARGUMENT, HasSubstr("curve is missing")));
  v1::FairCurveRequest odd = Noisy(5);
  odd.mutable_points()->add_points_mm(1);
  EXPECT_THAT(Fair(odd, &response), RpcStatusIs(StatusCode::INVALID_ARGUMENT, HasSubstr("16 numbers")));
  v1::FairCurveRequest nan = Noisy(5);
  nan.mutable_points()->set_points_mm(4, std::nan(""));
  EXPECT_THAT(Fair(nan, &response), RpcStatusIs(StatusCode::INVALID_ARGUMENT, HasSubstr("points_mm[4]")));
  v1::FairCurveRequest one;
  for (int k = 0; k < 3; ++k) one.mutable_points()->add_points_mm(1);
  EXPECT_THAT(Fair(one, &response), RpcStatusIs(StatusCode::INVALID_ARGUMENT, HasSubstr("at least 2")));
  v1::FairCurveRequest same;
  for (int k = 0; k < 9; ++k) same.mutable_points()->add_points_mm(1);
  const grpc::Status coincide = Fair(same, &response);
  EXPECT_THAT(coincide, RpcStatusIs(StatusCode::INVALID_ARGUMENT, HasSubstr("points all coincide")));
  ASSERT_EQ(InfoOf(coincide).field_violations_size(), 1);
  EXPECT_EQ(InfoOf(coincide).field_violations(0).field(), "points");
  v1::FairCurveRequest fine = Noisy(50);
  fine.set_polyline_tolerance_mm(1e-14);
  EXPECT_THAT(Fair(fine, &response),
              RpcStatusIs(StatusCode::RESOURCE_EXHAUSTED, HasSubstr("polyline points")));
  EXPECT_THAT(Fair(Noisy(100'001), &response),
              RpcStatusIs(StatusCode::RESOURCE_EXHAUSTED, HasSubstr("points")));
  ASSERT_TRUE(Fair(Noisy(100'000), &response).ok());
  EXPECT_EQ(response.points_mm_size(), 300'000);
}

}  // namespace
}  // namespace patchmill
