// Errors of the service. Each has a reason that a program can switch on; an error of a field has its path,
// too.
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <absl/status/status.h>
#include <grpcpp/support/status.h>

#include "core/base/diagnostic.h"

namespace patchmill {

// Collects all wrong fields of a request. A field that is reserved for later is UNIMPLEMENTED, a wrong one
// is INVALID_ARGUMENT, and a request with both is INVALID_ARGUMENT.
class FieldErrors {
 public:
  // The message reads "<field> <text>": Add("job.scallop_mm", "= -1; must be in (0, 3)").
  void Add(std::string field, std::string text);
  void Missing(std::string field) { Add(std::move(field), "is missing; required"); }
  void NotYet(std::string field, std::string what);

  bool empty() const { return faults_.empty(); }
  absl::Status ToStatus() const;  // OK if empty

 private:
  struct Fault {
    std::string field, text;
    bool not_yet = false;
  };
  std::vector<Fault> faults_;
};

// One factory for each kind of error.
// `note` is added to the message where the value alone would not explain the error.
absl::Status LimitError(std::string_view limit, double limit_value, double actual_value,
                        std::string_view note = {});
// `jobs` run and `waiting` wait, as many as may.
absl::Status TooManyJobsError(int jobs, int waiting);
// `actual` includes the requested bytes. `name` is that of the limit.
absl::Status TooManyBytesError(double limit, double actual,
                               std::string_view name = "request_bytes_in_flight");
// A job for which there is no memory while others have it. All in bytes.
absl::Status TooMuchMemoryError(double limit, double taken, double wanted);
absl::Status DrainingError();
// A job that has taken more memory than it could be granted.
absl::Status JobMemoryError(double granted, double needed);
// The bytes of the request do not form a message of its type.
absl::Status RequestUnreadableError(std::string_view why);
absl::Status ModelNotCachedError();
absl::Status ModelUnreadableError(std::string_view why, std::string_view code = {});
absl::Status CurveUnreadableError(std::string_view why);
absl::Status ProgramUnreadableError(std::string_view why);
// At least one fault is required. `at` is the path of the model in the request.
absl::Status ModelInvalidError(const Diagnostics& faults, std::string_view at);

// Gives an error of the domain about a field of set-up, operation or post the path of that field in a
// request with a `job` and a `post`: "heights.floor_z_mm" becomes "job.operations[0].heights.floor_z_mm".
// Any other status is returned unchanged.
absl::Status InJob(const absl::Status& status);

// The status as gRPC sends it. The message has at most 1,000 bytes; the details (v1.Status with one
// v1.ErrorInfo, and a RetryInfo where RetryDelay is known) are smaller than 4 KiB.
grpc::Status ToGrpcStatus(const absl::Status& status);

// The time after which the same call may succeed; nothing where nobody knows.
std::optional<std::chrono::milliseconds> RetryDelay(const absl::Status& status);

// Makes text that may come from a file valid UTF-8 for the wire: all other bytes become '?'.
std::string Utf8(std::string_view text);

}  // namespace patchmill
