#include "server/errors.h"

#include <algorithm>
#include <optional>

#include <absl/strings/cord.h>
#include <fmt/format.h>

#include "core/base/error_details.h"
#include "patchmill/v1/status.pb.h"
#include "server/limits.h"

namespace patchmill {
namespace {

constexpr char kInfoUrl[] = "type.googleapis.com/patchmill.v1.ErrorInfo";
constexpr char kRetryUrl[] = "type.googleapis.com/google.rpc.RetryInfo";
constexpr std::size_t kMaxViolationBytes = 300;

std::string Cut(std::string text, std::size_t bytes) {
  if (text.size() > bytes) text = text.substr(0, bytes - 3) + "...";
  return Utf8(text);
}

// The trailer that holds the message is percent-encoded: a byte that is not printable ASCII takes three
// bytes.
std::string CutMessage(std::string_view text) {
  std::size_t size = 0, end = 0, room = 0;  // room: end of the text before which three dots still fit
  for (; end < text.size() && size <= limits::kMaxStatusMessageBytes; ++end) {
    const char c = text[end];
    size += c >= ' ' && c <= '~' && c != '%' ? 1 : 3;
    if (size + 3 <= limits::kMaxStatusMessageBytes) room = end + 1;
  }
  if (size <= limits::kMaxStatusMessageBytes) return Utf8(text);
  while (room > 0 && (static_cast<unsigned char>(text[room]) & 0xC0) == 0x80)
    --room;  // to the start of a character
  return Utf8(text.substr(0, room)) + "...";
}

absl::Status WithInfo(absl::StatusCode code, std::string_view message, const v1::ErrorInfo& info) {
  absl::Status status(code, CutMessage(message));
  status.SetPayload(kInfoUrl, absl::Cord(info.SerializeAsString()));
  return status;
}

absl::Status WithReason(absl::StatusCode code, std::string_view reason, std::string_view message) {
  v1::ErrorInfo info;
  info.set_reason(std::string(reason));
  return WithInfo(code, message, info);
}

const char* DefaultReason(absl::StatusCode code) {
  switch (code) {
    case absl::StatusCode::kInvalidArgument:
      return "INVALID_FIELDS";
    case absl::StatusCode::kUnimplemented:
      return "NOT_IMPLEMENTED";
    case absl::StatusCode::kFailedPrecondition:
      return "REGIONS_STALE";  // in the domain only ChooseRegions returns this code
    case absl::StatusCode::kResourceExhausted:
      return "LIMIT_EXCEEDED";
    case absl::StatusCode::kCancelled:
      return "CANCELLED";
    case absl::StatusCode::kDeadlineExceeded:
      return "DEADLINE_EXCEEDED";
    default:
      return "INTERNAL";
  }
}

absl::Status LimitError(const PassedLimit& passed, std::string_view message) {
  v1::ErrorInfo info;
  info.set_reason("LIMIT_EXCEEDED");
  info.set_limit(passed.name);
  info.set_limit_value(passed.limit);
  info.set_actual_value(passed.value);
  return WithInfo(absl::StatusCode::kResourceExhausted, message, info);
}

std::string More(std::size_t count) {
  return count > 1 ? fmt::format(" (and {} more)", count - 1) : std::string();
}

}  // namespace

void FieldErrors::Add(std::string field, std::string text) {
  faults_.push_back({std::move(field), std::move(text), false});
}

void FieldErrors::NotYet(std::string field, std::string what) {
  faults_.push_back({std::move(field), "is not there yet: " + std::move(what), true});
}

absl::Status FieldErrors::ToStatus() const {
  if (faults_.empty()) return absl::OkStatus();
  const bool all_not_yet =
      std::all_of(faults_.begin(), faults_.end(), [](const Fault& f) { return f.not_yet; });
  v1::ErrorInfo info;
  info.set_reason(all_not_yet ? "NOT_IMPLEMENTED" : "INVALID_FIELDS");
  info.set_violation_count(static_cast<int>(faults_.size()));
  for (const Fault& fault : faults_) {
    if (info.field_violations_size() == limits::kMaxViolations) break;
    v1::FieldViolation& violation = *info.add_field_violations();
    violation.set_field(Cut(fault.field, kMaxViolationBytes));
    violation.set_description(Cut(fault.text, kMaxViolationBytes));
  }
  const Fault& first = faults_.front();
  return WithInfo(all_not_yet ? absl::StatusCode::kUnimplemented : absl::StatusCode::kInvalidArgument,
                  first.field + " " + first.text + More(faults_.size()), info);
}

absl::Status LimitError(std::string_view limit, double limit_value, double actual_value,
                        std::string_view note) {
  return LimitError({std::string(limit), limit_value, actual_value},
                    fmt::format("{} = {:.10g}; the limit is {:.10g}{}{}", limit, actual_value, limit_value,
                                note.empty() ? "" : "; ", note));
}

absl::Status TooManyJobsError(int jobs, int waiting) {
  v1::ErrorInfo info;
  info.set_reason("TOO_MANY_JOBS");
  info.set_limit("waiting_jobs");
  info.set_limit_value(waiting);
  info.set_actual_value(waiting + 1);
  return WithInfo(
      absl::StatusCode::kResourceExhausted,
      fmt::format("the server runs {} jobs and {} wait, as many as may; try again later", jobs, waiting),
      info);
}

absl::Status TooMuchMemoryError(double limit, double taken, double wanted) {
  v1::ErrorInfo info;
  info.set_reason("TOO_MUCH_MEMORY");
  info.set_limit("memory_of_all_jobs_bytes");
  info.set_limit_value(limit);
  info.set_actual_value(taken + wanted);
  return WithInfo(
      absl::StatusCode::kResourceExhausted,
      fmt::format("the job needs about {:.0f} MiB; the jobs that run have {:.0f} of {:.0f} MiB; try again "
                  "later",
                  wanted / 1048576.0, taken / 1048576.0, limit / 1048576.0),
      info);
}

absl::Status JobMemoryError(double granted, double needed) {
  return LimitError("job_memory_bytes", granted, needed,
                    "the job was ended because it needs more memory than the server has for it");
}

absl::Status TooManyBytesError(double limit, double actual, std::string_view name) {
  v1::ErrorInfo info;
  info.set_reason("TOO_MANY_BYTES");
  info.set_limit(std::string(name));
  info.set_limit_value(limit);
  info.set_actual_value(actual);
  return WithInfo(
      absl::StatusCode::kResourceExhausted,
      fmt::format("{} = {:.10g} with this one; the limit is {:.10g}; try again later", name, actual, limit),
      info);
}

absl::Status RequestUnreadableError(std::string_view why) {
  return WithReason(absl::StatusCode::kInvalidArgument, "REQUEST_UNREADABLE", why);
}

absl::Status DrainingError() {
  return WithReason(absl::StatusCode::kUnavailable, "DRAINING",
                    "the server is shutting down; try another one");
}

absl::Status ModelNotCachedError() {
  return WithReason(
      absl::StatusCode::kNotFound, "MODEL_NOT_CACHED",
      "source.model_sha256 names a model that this server does not hold; upload it, or send it inline");
}

absl::Status ModelUnreadableError(std::string_view why, std::string_view code) {
  v1::ErrorInfo info;
  info.set_reason("MODEL_UNREADABLE");
  info.set_code(std::string(code));
  return WithInfo(absl::StatusCode::kInvalidArgument, why, info);
}

absl::Status CurveUnreadableError(std::string_view why) {
  return WithReason(absl::StatusCode::kInvalidArgument, "CURVE_UNREADABLE", why);
}

absl::Status ProgramUnreadableError(std::string_view why) {
  return WithReason(absl::StatusCode::kInvalidArgument, "PROGRAM_UNREADABLE", why);
}

absl::Status ModelInvalidError(const Diagnostics& faults, std::string_view at) {
  v1::ErrorInfo info;
  info.set_reason("MODEL_INVALID");
  info.set_violation_count(static_cast<int>(faults.size()));
  for (const Diagnostic& fault : faults) {
    if (info.field_violations_size() == limits::kMaxViolations) break;
    v1::FieldViolation& violation = *info.add_field_violations();
    const std::string& field = fault.where.field;
    violation.set_field(
        Cut(field.empty() ? std::string(at) : fmt::format("{}.{}", at, field), kMaxViolationBytes));
    violation.set_description(Cut(fault.message, kMaxViolationBytes));
  }
  return WithInfo(absl::StatusCode::kInvalidArgument,
                  "model: " + faults.front().message + More(faults.size()), info);
}

absl::Status InJob(const absl::Status& status) {
  const std::string field = FieldOf(status);
  if (field.starts_with("post.")) return status;
  return WithFieldPrefix(field.starts_with("setup.") ? "job." : "job.operations[0].", status);
}

grpc::Status ToGrpcStatus(const absl::Status& status) {
  if (status.ok()) return grpc::Status::OK;
  if (const std::string field = FieldOf(status); !field.empty()) {
    FieldErrors errors;
    errors.Add(field, FieldText(status));
    return ToGrpcStatus(errors.ToStatus());
  }
  v1::ErrorInfo info;
  if (const auto payload = status.GetPayload(kInfoUrl)) {
    info.ParseFromString(std::string(*payload));
  } else if (const std::optional<PassedLimit> passed = LimitPassedOf(status)) {
    return ToGrpcStatus(LimitError(*passed, std::string(status.message())));
  } else {
    info.set_reason(DefaultReason(status.code()));
  }
  v1::Status wire;
  wire.set_code(static_cast<int>(status.code()));
  wire.set_message(CutMessage(std::string(status.message())));
  wire.add_details()->PackFrom(info);
  if (const auto delay = RetryDelay(status)) {
    v1::RetryInfo retry;
    retry.mutable_retry_delay()->set_seconds(delay->count() / 1000);
    retry.mutable_retry_delay()->set_nanos(static_cast<int>(delay->count() % 1000) * 1'000'000);
    google::protobuf::Any& any = *wire.add_details();
    any.set_type_url(kRetryUrl);
    any.set_value(retry.SerializeAsString());
  }
  while (wire.ByteSizeLong() > limits::kMaxStatusBytes && info.field_violations_size() > 0) {
    info.mutable_field_violations()->RemoveLast();
    wire.mutable_details(0)->PackFrom(info);
  }
  return {static_cast<grpc::StatusCode>(status.code()), wire.message(), wire.SerializeAsString()};
}

std::optional<std::chrono::milliseconds> RetryDelay(const absl::Status& status) {
  if (const auto own = status.GetPayload(kRetryUrl)) {
    v1::RetryInfo retry;
    retry.ParseFromString(std::string(*own));
    return std::chrono::milliseconds(1000 * retry.retry_delay().seconds() +
                                     retry.retry_delay().nanos() / 1'000'000);
  }
  const auto payload = status.GetPayload(kInfoUrl);
  v1::ErrorInfo info;
  if (!payload || !info.ParseFromString(std::string(*payload))) return std::nullopt;
  constexpr std::pair<std::string_view, int> kDelays[] = {{"TOO_MANY_JOBS", 2000},
                                                          {"TOO_MANY_BYTES", 1000},
                                                          {"TOO_MUCH_MEMORY", 2000},
                                                          {"DRAINING", 1000}};  // ms
  for (const auto& [reason, delay] : kDelays) {
    if (info.reason() == reason) return std::chrono::milliseconds(delay);
  }
  return std::nullopt;
}

std::string Utf8(std::string_view text) {
  std::string out;
  out.reserve(text.size());
  for (std::size_t i = 0; i < text.size();) {
    const auto byte = [&](std::size_t k) { return static_cast<unsigned char>(text[k]); };
    const unsigned char lead = byte(i);
    std::size_t more = lead < 0x80                   ? 0
                       : lead >= 0xC2 && lead < 0xE0 ? 1
                       : lead >= 0xE0 && lead < 0xF0 ? 2
                       : lead >= 0xF0 && lead < 0xF5 ? 3
                                                     : 9;
    bool good = more < 9 && i + more < text.size();
    for (std::size_t k = 1; good && k <= more; ++k) good = (byte(i + k) & 0xC0) == 0x80;
    // Not valid: overlong forms, surrogates and values above U+10FFFF.
    if (good && more == 2)
      good = !(lead == 0xE0 && byte(i + 1) < 0xA0) && !(lead == 0xED && byte(i + 1) > 0x9F);
    if (good && more == 3)
      good = !(lead == 0xF0 && byte(i + 1) < 0x90) && !(lead == 0xF4 && byte(i + 1) > 0x8F);
    if (good) {
      out += text.substr(i, more + 1);
      i += more + 1;
    } else {
      out += '?';
      ++i;
    }
  }
  return out;
}

}  // namespace patchmill
