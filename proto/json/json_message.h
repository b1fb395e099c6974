// Reads messages from JSON that people and scripts write.
#pragma once

#include <functional>
#include <string>
#include <string_view>

#include <absl/status/status.h>
#include <google/protobuf/message.h>

namespace patchmill {

// Reads canonical proto JSON into `message`, with or without a byte order mark. INVALID_ARGUMENT states the
// line. It also covers two faults that protobuf drops silently: a null in a list (scripts write NaN so) and a
// list in a list. After either, every number would be one place off. `check` (may be empty) receives the
// message in its binary form before it is parsed. Its error is returned unchanged. `stopped` (may be empty)
// is asked every kJsonPieceBytes; once it returns true, reading ends with CANCELLED.
using WireCheck = std::function<absl::Status(const std::string& wire)>;
inline constexpr int kJsonPieceBytes = 1 << 16;
absl::Status ReadJsonMessage(std::string_view text, google::protobuf::Message& message,
                             const WireCheck& check = {}, const std::function<bool()>& stopped = {});

}  // namespace patchmill
