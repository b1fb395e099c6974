#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "core/base/digest.h"
#include "core/base/status.h"
#include "server/convert/fields.h"
#include "server/convert/report.h"
#include "server/errors.h"
#include "server/handlers/handlers.h"
#include "server/handlers/prepare.h"
#include "server/limits.h"

namespace patchmill {
namespace {

constexpr std::size_t kDigestBytes = 32;

absl::Status WrongField(std::string field, std::string text) {
  FieldErrors errors;
  errors.Add(std::move(field), std::move(text));
  return errors.ToStatus();
}

absl::Status CheckStart(const v1::UploadStart& start) {
  FieldErrors errors;
  if (start.size_bytes() <= 0)
    errors.Add("start.size_bytes", fmt::format("= {}; must be positive", start.size_bytes()));
  if (start.content_sha256().size() != kDigestBytes) {
    errors.Add("start.content_sha256",
               fmt::format("has {} bytes; must have {}", start.content_sha256().size(), kDigestBytes));
  }
  PM_RETURN_IF_ERROR(errors.ToStatus());
  if (static_cast<std::size_t>(start.size_bytes()) <= limits::kMaxUploadBytes) return absl::OkStatus();
  return LimitError("upload_bytes", static_cast<double>(limits::kMaxUploadBytes),
                    static_cast<double>(start.size_bytes()));
}

// The bytes of a file as they come. They are counted as they come, too: a client may state a size and send
// nothing. Room that nobody has written to takes no memory.
class Received {
 public:
  Received(InFlight& in_flight, std::size_t size) : in_flight_(in_flight) { bytes_.reserve(size); }

  absl::Status Add(std::string_view chunk) {
    PM_ASSIGN_OR_RETURN(InFlight::Hold hold, in_flight_.Take(chunk.size()));
    holds_.push_back(std::move(hold));
    bytes_ += chunk;
    return absl::OkStatus();
  }
  std::string& bytes() { return bytes_; }

 private:
  InFlight& in_flight_;
  std::vector<InFlight::Hold> holds_;
  std::string bytes_;
};

}  // namespace

absl::Status HandleUploadModel(const Call& call, const NextMessage<v1::UploadModelRequest>& next,
                               v1::UploadModelResponse* response) {
  v1::UploadModelRequest message;
  PM_ASSIGN_OR_RETURN(bool more, next(message));
  PM_RETURN_IF_ERROR(RefuseUnknownFields(message));
  if (!more || !message.has_start()) return WrongField("start", "is missing; it must be the first message");
  v1::UploadStart start = std::move(*message.mutable_start());
  PM_RETURN_IF_ERROR(CheckStart(start));
  const auto size = static_cast<std::size_t>(start.size_bytes());

  Received received(call.env->in_flight, size);
  const auto begin = RunContext::Clock::now();
  while (received.bytes().size() < size) {
    PM_ASSIGN_OR_RETURN(more, next(message));
    if (!more) {
      if (call.cancelled()) return absl::CancelledError("cancelled by the caller");
      return WrongField("chunk",
                        fmt::format("is missing: {} of {} bytes have come", received.bytes().size(), size));
    }
    PM_RETURN_IF_ERROR(RefuseUnknownFields(message));
    if (!message.has_chunk()) return WrongField("chunk", "is missing; it must follow the first message");
    if (message.chunk().size() > size - received.bytes().size()) {
      return WrongField("chunk", fmt::format("has {} bytes; must have at most the {} that are missing",
                                             message.chunk().size(), size - received.bytes().size()));
    }
    PM_RETURN_IF_ERROR(received.Add(message.chunk()));
    message.Clear();
    if (RunContext::Clock::now() - begin > std::chrono::seconds(limits::kUploadSeconds)) {
      return absl::DeadlineExceededError(
          fmt::format("the model has not come within {} s", limits::kUploadSeconds));
    }
  }
  PM_ASSIGN_OR_RETURN(more, next(message));
  if (more) return WrongField("chunk", "follows the last byte of the file; start.size_bytes states fewer");
  if (Sha256(received.bytes()) != start.content_sha256())
    return WrongField("start.content_sha256", "is not that of the bytes that have come; send them again");

  v1::ModelSource source;
  v1::ModelFile& file = *source.mutable_file();
  file.set_format(std::move(*start.mutable_format()));
  file.set_length_unit(start.length_unit());
  *file.mutable_import_options() = std::move(*start.mutable_import_options());
  file.set_content(std::move(received.bytes()));
  return RunQuickCall(call, {}, [&](const RunContext& run) -> absl::Status {
    const ModelAccess models = ModelsOf(call);
    PM_ASSIGN_OR_RETURN(const LoadedModel loaded, LoadModel(source, "start", run, models));
    response->set_patch_count(static_cast<int>(loaded.model.patches.size()));
    AddDiagnostics(loaded.faults, Vec3::Zero(), response->mutable_diagnostics());
    AddDiagnostics(loaded.remarks, Vec3::Zero(), response->mutable_diagnostics());
    if (!loaded.faults.empty()) return absl::OkStatus();
    PM_RETURN_IF_ERROR(KeepModel(loaded, source, run, models));
    response->set_model_sha256(loaded.digest);
    return absl::OkStatus();
  });
}

absl::Status HandleForgetModel(const Call& call, const v1::ForgetModelRequest& request,
                               v1::ForgetModelResponse* response) {
  PM_RETURN_IF_ERROR(RefuseUnknownFields(request));
  if (request.model_sha256().size() != kDigestBytes) {
    return WrongField("model_sha256",
                      fmt::format("has {} bytes; must have {}", request.model_sha256().size(), kDigestBytes));
  }
  response->set_was_there(call.env->answers.ForgetModel(call.caller, request.model_sha256()));
  return absl::OkStatus();
}

}  // namespace patchmill
