// TabulateReach through the wire.
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/service/embedded.h"
#include "tests/service/requests.h"
#include "tests/service/status_matchers.h"

namespace patchmill {
namespace {

using grpc::StatusCode;
using testing::Embedded;
using ::testing::HasSubstr;
using testing::RpcStatusIs;

class TabulateReach : public ::testing::Test {
 protected:
  TabulateReach() {
    *request_.mutable_job() = testing::BumpJob();
    for (const double diameter : {1.0, 4.0, 10.0}) request_.add_tool_diameters_mm(diameter);
  }
  grpc::Status Tabulate() {
    grpc::ClientContext context;
    response_.Clear();
    return embedded_.analysis->TabulateReach(&context, request_, &response_);
  }
  v1::Operation& operation() { return *request_.mutable_job()->mutable_operations(0); }
  Embedded embedded_;
  v1::TabulateReachRequest request_;
  v1::TabulateReachResponse response_;
};

TEST_F(TabulateReach, EveryBallReachesAPlateAndNoneReachesItBelowTheFloor) {
  *request_.mutable_job()->mutable_source()->mutable_model() = testing::Bump(12.0, 0.0);
  grpc::Status status = Tabulate();
  ASSERT_TRUE(status.ok()) << status.error_message();
  EXPECT_NEAR(response_.area_mm2(), 144.0, 1e-9);
  ASSERT_EQ(response_.entries_size(), 3);
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(response_.entries(i).tool_diameter_mm(), request_.tool_diameters_mm(i));
    EXPECT_EQ(response_.entries(i).unreachable_area_mm2(), 0.0);
    EXPECT_NEAR(response_.entries(i).largest_tool_area_mm2(), i == 2 ? 144.0 : 0.0, 1e-9);
  }
  operation().mutable_heights()->set_floor_z_mm(0.5);
  status = Tabulate();
  ASSERT_TRUE(status.ok()) << status.error_message();
  for (const v1::ReachEntry& entry : response_.entries())
    EXPECT_NEAR(entry.unreachable_area_mm2(), 144.0, 1e-9);
}

TEST_F(TabulateReach, WrongLists) {
  request_.set_tool_diameters_mm(2, 4.0);
  EXPECT_THAT(Tabulate(),
              RpcStatusIs(StatusCode::INVALID_ARGUMENT,
                          HasSubstr("tool_diameters_mm[2] = 4; must be above the one before, 4")));
  request_.clear_tool_diameters_mm();
  EXPECT_THAT(Tabulate(),
              RpcStatusIs(StatusCode::INVALID_ARGUMENT, HasSubstr("tool_diameters_mm is missing")));
  request_.add_tool_diameters_mm(0.0);
  request_.add_tool_diameters_mm(NAN);
  EXPECT_THAT(Tabulate(),
              RpcStatusIs(StatusCode::INVALID_ARGUMENT,
                          HasSubstr("tool_diameters_mm[0] = 0; must be in [0.02, 1000] (and 1 more)")));
  request_.set_tool_diameters_mm(0, 1.0);
  EXPECT_THAT(Tabulate(), RpcStatusIs(StatusCode::INVALID_ARGUMENT,
                                      HasSubstr("tool_diameters_mm[1] = nan; must be in [0.02, 1000]")));
  for (int i = 2; i < 65; ++i) request_.add_tool_diameters_mm(i);
  EXPECT_THAT(Tabulate(), RpcStatusIs(StatusCode::INVALID_ARGUMENT,
                                      HasSubstr("tool_diameters_mm has 65 elements; must have at most 64")));
}

}  // namespace
}  // namespace patchmill
