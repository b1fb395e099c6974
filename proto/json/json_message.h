// Messages from JSON that people and scripts write.
#pragma once

#include <functional>
#include <string>
#include <string_view>

#include <absl/status/status.h>
#include <google/protobuf/message.h>

namespace patchmill {

// Canonical proto JSON into `message`, with or without a byte order mark. INVALID_ARGUMENT, with the line,
// also for what protobuf drops without a word: a null in a list (how scripts write NaN) and a list in a list,
// after which every number would stand one place off.
// `check` (may be empty) sees the message in its binary form before it is parsed; an error of it is returned
// as it is.
// `stopped` (may be empty) is asked every kJsonPieceBytes; once it says so, the text is not read any further:
// CANCELLED.
using WireCheck = std::function<absl::Status(const std::string& wire)>;
inline constexpr int kJsonPieceBytes = 1 << 16;
absl::Status ReadJsonMessage(std::string_view text, google::protobuf::Message& message,
                             const WireCheck& check = {}, const std::function<bool()>& stopped = {});

}  // namespace patchmill
