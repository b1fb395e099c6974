#include "server/errors.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "core/base/error_details.h"
#include "server/digest.h"
#include "server/limits.h"
#include "tests/service/status_matchers.h"

namespace patchmill {
namespace {

using ::testing::AllOf;
using ::testing::Ge;
using ::testing::HasSubstr;
using ::testing::Le;

TEST(FieldErrors, NamesTheFirstAndCountsTheRest) {
  FieldErrors errors;
  errors.Add("job.scallop_mm", "= -1; must be in (0, 3)");
  errors.Missing("job.source");
  const grpc::Status status = ToGrpcStatus(errors.ToStatus());
  EXPECT_EQ(status.error_code(), grpc::StatusCode::INVALID_ARGUMENT);
  EXPECT_EQ(status.error_message(), "job.scallop_mm = -1; must be in (0, 3) (and 1 more)");
  const v1::ErrorInfo info = testing::InfoOf(status);
  EXPECT_EQ(info.reason(), "INVALID_FIELDS");
  ASSERT_EQ(info.field_violations_size(), 2);
  EXPECT_EQ(info.field_violations(1).field(), "job.source");
  EXPECT_EQ(info.violation_count(), 2);
}

TEST(FieldErrors, ReservedPlacesAreUnimplementedUnlessSomethingIsWrongToo) {
  FieldErrors errors;
  errors.NotYet("job.setup.obstacles", "leave it empty");
  EXPECT_EQ(errors.ToStatus().code(), absl::StatusCode::kUnimplemented);
  errors.Missing("job.source");
  EXPECT_EQ(errors.ToStatus().code(), absl::StatusCode::kInvalidArgument);
}

TEST(FieldErrors, NoErrorIsOk) { EXPECT_TRUE(FieldErrors().ToStatus().ok()); }

TEST(InJob, DomainErrorsAreTheFieldsOfTheRequest) {
  const auto info = [](const absl::Status& status) { return testing::InfoOf(ToGrpcStatus(status)); };
  const auto of = [&](std::string_view field) { return info(InJob(FieldError(field, "= 3; must be 5"))); };
  ASSERT_EQ(of("heights.top_z_mm").field_violations_size(), 1);
  EXPECT_EQ(of("heights.top_z_mm").reason(), "INVALID_FIELDS");
  EXPECT_EQ(of("heights.top_z_mm").violation_count(), 1);
  EXPECT_EQ(of("heights.top_z_mm").field_violations(0).field(), "job.operations[0].heights.top_z_mm");
  EXPECT_EQ(of("heights.top_z_mm").field_violations(0).description(), "= 3; must be 5");
  EXPECT_EQ(of("setup.scale").field_violations(0).field(), "job.setup.scale");
  EXPECT_EQ(of("post.dialect").field_violations(0).field(), "post.dialect");
  // Requests without a job have these fields of their own.
  EXPECT_EQ(info(FieldError("setup.scale", "= 0")).field_violations(0).field(), "setup.scale");
  const absl::Status limit = LimitError("a_mm", 1, 2);
  EXPECT_EQ(InJob(limit), limit);
}

TEST(ModelInvalid, HasThePathFromTheRequest) {
  Diagnostic fault;
  fault.message = "patches[3].bezier.points has a number that is not finite";
  fault.where.field = "patches[3].bezier.points";
  const auto info = [](const Diagnostics& faults) {
    return testing::InfoOf(ToGrpcStatus(ModelInvalidError(faults, "job.source.model")));
  };
  ASSERT_EQ(info({fault}).field_violations_size(), 1);
  EXPECT_EQ(info({fault}).field_violations(0).field(), "job.source.model.patches[3].bezier.points");
  fault.where.field.clear();
  EXPECT_EQ(info({fault}).field_violations(0).field(), "job.source.model");
}

TEST(ModelUnreadable, SaysWhatIsWrongWhereThatHasACode) {
  const v1::ErrorInfo info =
      testing::InfoOf(ToGrpcStatus(ModelUnreadableError("line 3: ...", "ZERO_WEIGHT")));
  EXPECT_EQ(info.reason(), "MODEL_UNREADABLE");
  EXPECT_EQ(info.code(), "ZERO_WEIGHT");
  EXPECT_EQ(testing::InfoOf(ToGrpcStatus(ModelUnreadableError("line 3: ..."))).code(), "");
}

// Trailers stop at 8 KiB; details beyond are lost with the status they explain.
TEST(ToGrpcStatus, StaysUnderFourKibibytesWhateverIsWrong) {
  for (const int count : {1, 20, 21, 5000}) {
    FieldErrors errors;
    for (int i = 0; i < count; ++i) errors.Add(std::string(2000, 'f'), std::string(2000, 'x'));
    const grpc::Status status = ToGrpcStatus(errors.ToStatus());
    EXPECT_LE(status.error_details().size(), limits::kMaxStatusBytes);
    EXPECT_LE(status.error_message().size(), limits::kMaxStatusMessageBytes);
    const v1::ErrorInfo info = testing::InfoOf(status);
    EXPECT_EQ(info.violation_count(), count);
    EXPECT_THAT(info.field_violations_size(), AllOf(Ge(1), Le(limits::kMaxViolations)));
  }
}

TEST(ToGrpcStatus, MessagesAreCutByTheirSizeOnTheWire) {
  const auto sent = [](const std::string& text) {
    return ToGrpcStatus(absl::InternalError(text)).error_message();
  };
  const auto umlauts = [](std::size_t count) {  // two bytes each, six as sent
    std::string text;
    for (std::size_t i = 0; i < count; ++i) text += "\u00fc";
    return text;
  };
  EXPECT_EQ(sent(umlauts(700)), umlauts((limits::kMaxStatusMessageBytes - 3) / 6).append("..."));
  const std::string most(limits::kMaxStatusMessageBytes, 'a');
  EXPECT_EQ(sent(most), most);
  EXPECT_EQ(sent(std::string(most).append("a")), most.substr(3).append("..."));
}

TEST(ToGrpcStatus, LimitsCarryNameAndNumbers) {
  const v1::ErrorInfo info = testing::InfoOf(ToGrpcStatus(LimitError("model.patch_count", 100000, 100001)));
  EXPECT_EQ(info.reason(), "LIMIT_EXCEEDED");
  EXPECT_EQ(info.limit(), "model.patch_count");
  EXPECT_EQ(info.limit_value(), 100000);
  EXPECT_EQ(info.actual_value(), 100001);
}

TEST(ToGrpcStatus, GivesAReasonToStatusesOfTheDomainToo) {
  EXPECT_EQ(testing::InfoOf(ToGrpcStatus(absl::InternalError("oops"))).reason(), "INTERNAL");
  EXPECT_EQ(testing::InfoOf(ToGrpcStatus(absl::CancelledError("gone"))).reason(), "CANCELLED");
}

TEST(Utf8, KeepsGoodTextAndReplacesTheRest) {
  const std::string good =
      "Gr\xC3\xB6\xC3\x9F"
      "e \xE2\x82\xAC \xF0\x9D\x84\x9E";
  EXPECT_EQ(Utf8(good), good);
  EXPECT_EQ(Utf8("\xC3\x28"), "?(");            // broken pair
  EXPECT_EQ(Utf8("\xC0\xAF"), "??");            // overlong
  EXPECT_EQ(Utf8("\xED\xA0\x80"), "???");       // surrogate
  EXPECT_EQ(Utf8("\xF4\x90\x80\x80"), "????");  // beyond U+10FFFF
  EXPECT_EQ(Utf8("end\xE2\x82"), "end??");      // cut off
}

// FIPS 180-4 examples.
TEST(Sha256, KnownAnswers) {
  EXPECT_EQ(Hex(Sha256("")), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(Hex(Sha256("abc")), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(Hex(Sha256(std::string(1000000, 'a'))),
            "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

TEST(Canonical, SeparatesFieldsAndUnifiesZeros) {
  EXPECT_NE(Canonical().Add("ab").Add("c").Digest(), Canonical().Add("a").Add("bc").Digest());
  EXPECT_EQ(Canonical().Add(0.0).Digest(), Canonical().Add(-0.0).Digest());
}

}  // namespace
}  // namespace patchmill
