// Errors of the wire: every one carries a reason a program can switch on, and where it is a field, its path.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <absl/status/status.h>
#include <grpcpp/support/status.h>

#include "core/base/diagnostic.h"

namespace patchmill {

// Collects all wrong fields of a request. Fields that only have their place reserved are UNIMPLEMENTED, wrong
// ones INVALID_ARGUMENT; a request with both is INVALID_ARGUMENT.
class FieldErrors {
 public:
  // Reads "<field> <text>": Add("job.scallop_mm", "= -1; must be in (0, 3)").
  void Add(std::string field, std::string text);
  void Missing(std::string field) { Add(std::move(field), "is missing; required"); }
  void NotYet(std::string field, std::string what);

  bool empty() const { return faults_.empty(); }
  absl::Status ToStatus() const;  // OK when empty

 private:
  struct Fault {
    std::string field, text;
    bool not_yet = false;
  };
  std::vector<Fault> faults_;
};

// One factory per kind of error.
// `note` follows the message where the value alone would puzzle.
absl::Status LimitError(std::string_view limit, double limit_value, double actual_value,
                        std::string_view note = {});
absl::Status TooManyJobsError(int limit);
// `actual`: with what was asked for; `name`: of the limit.
absl::Status TooManyBytesError(double limit, double actual,
                               std::string_view name = "request_bytes_in_flight");
absl::Status DrainingError();
// The bytes of the request are no message of its type.
absl::Status RequestUnreadableError(std::string_view why);
absl::Status ModelNotCachedError();
absl::Status ModelUnreadableError(std::string_view why, std::string_view code = {});
absl::Status CurveUnreadableError(std::string_view why);
absl::Status ProgramUnreadableError(std::string_view why);
// At least one; `at`: where the request has the model.
absl::Status ModelInvalidError(const Diagnostics& faults, std::string_view at);

// An error of the domain about a field of a job's set-up, operation or post, as a request with a `job` and a
// `post` has it: "heights.floor_z_mm" becomes "job.operations[0].heights.floor_z_mm". Any other status as it
// is.
absl::Status InJob(const absl::Status& status);

// The status as gRPC sends it: message at most 1,000 bytes, details (v1.Status with one v1.ErrorInfo) under 4
// KiB.
grpc::Status ToGrpcStatus(const absl::Status& status);

// Text that may come from a file, made valid UTF-8 for the wire: other bytes become '?'.
std::string Utf8(std::string_view text);

}  // namespace patchmill
