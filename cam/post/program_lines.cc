#include "cam/post/program_lines.h"

#include <algorithm>

#include "core/base/status.h"

namespace patchmill {

absl::StatusOr<std::optional<BlockModes>> ProgramLines::Read(std::string_view line) {
  switch (dialect_.syntax) {
    case Syntax::kRs274:
      return ReadGcode(line);
    case Syntax::kSiemens:
      return siemens_.Read(line);
    case Syntax::kKlartext:
      return klartext_.Read(line);
  }
  return std::nullopt;
}

absl::StatusOr<std::optional<BlockModes>> ProgramLines::ReadGcode(std::string_view line) {
  PM_RETURN_IF_ERROR(ParseGcodeLine(line, block_));
  if (block_.percent) {
    if (percent_opened_) {
      ended_ = true;
      return std::nullopt;
    }
    if (begun_) return absl::InvalidArgumentError("% within the program");
    percent_opened_ = begun_ = true;
    return std::nullopt;
  }
  if (block_.program_number) {
    const bool at_start = !begun_ || (percent_opened_ && !numbered_);
    if (!at_start) return absl::InvalidArgumentError("a program number within the program");
    begun_ = numbered_ = true;
    return std::nullopt;
  }
  if (block_.words.empty()) return std::nullopt;
  begun_ = numbered_ = true;
  return SortModes(block_, dialect_);
}

std::string_view TakeLine(std::string_view& text) {
  std::string_view line = text.substr(0, text.find('\n'));
  text.remove_prefix(std::min(line.size() + 1, text.size()));
  if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
  return line;
}

}  // namespace patchmill
