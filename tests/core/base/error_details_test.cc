#include "core/base/error_details.h"

#include <gtest/gtest.h>

namespace patchmill {
namespace {

TEST(FieldError, CarriesItsPathAndReadsAsOneSentence) {
  const absl::Status status = FieldError("heights.floor_z_mm", "= 3; must be at least 5");
  EXPECT_EQ(status.code(), absl::StatusCode::kInvalidArgument);
  EXPECT_EQ(status.message(), "heights.floor_z_mm = 3; must be at least 5");
  EXPECT_EQ(FieldOf(status), "heights.floor_z_mm");
  EXPECT_EQ(FieldText(status), "= 3; must be at least 5");
}

TEST(FieldError, GetsAPrefixInPathAndText) {
  const absl::Status status = WithFieldPrefix("job.", FieldError("setup.scale", "= 0; must be in (0, 1e9]"));
  EXPECT_EQ(FieldOf(status), "job.setup.scale");
  EXPECT_EQ(status.message(), "job.setup.scale = 0; must be in (0, 1e9]");
}

TEST(FieldError, OtherErrorsHaveNoFieldAndStayAsTheyAre) {
  EXPECT_EQ(FieldOf(absl::OkStatus()), "");
  const absl::Status other = absl::InvalidArgumentError("x = 3");
  EXPECT_EQ(FieldOf(other), "");
  EXPECT_EQ(WithFieldPrefix("job.", other), other);
  EXPECT_TRUE(WithFieldPrefix("job.", absl::OkStatus()).ok());
  EXPECT_EQ(FieldOf(CodedError("ZERO_WEIGHT", "line 3")), "");
}

TEST(CodedError, CarriesItsCode) {
  const absl::Status status = CodedError("ZERO_WEIGHT", "line 3: ZERO_WEIGHT: weight = 0");
  EXPECT_EQ(status.code(), absl::StatusCode::kInvalidArgument);
  EXPECT_EQ(status.message(), "line 3: ZERO_WEIGHT: weight = 0");
  EXPECT_EQ(CodeOf(status), "ZERO_WEIGHT");
  EXPECT_EQ(CodeOf(absl::InvalidArgumentError("x")), "");
}

TEST(LimitPassedError, CarriesLimitAndValue) {
  const absl::Status status = LimitPassedError({"cut_length_mm", 5e6, 1234567890.1234567}, "take less");
  EXPECT_EQ(status.code(), absl::StatusCode::kResourceExhausted);
  EXPECT_EQ(status.message(), "cut_length_mm = 1234567890; the limit is 5000000: take less");
  const std::optional<PassedLimit> passed = LimitPassedOf(status);
  ASSERT_TRUE(passed.has_value());
  EXPECT_EQ(passed->name, "cut_length_mm");
  EXPECT_EQ(passed->limit, 5e6);
  EXPECT_EQ(passed->value, 1234567890.1234567);
  EXPECT_FALSE(LimitPassedOf(absl::ResourceExhaustedError("x = 3; the limit is 2")).has_value());
  EXPECT_FALSE(LimitPassedOf(FieldError("x", "= 3 4 5")).has_value());
}

}  // namespace
}  // namespace patchmill
