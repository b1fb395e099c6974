#include "cam/post/word_use.h"

#include <cmath>

#include <fmt/format.h>

#include "core/base/status.h"

namespace patchmill {
namespace {

absl::Status WordFault(const std::string& message) { return absl::InvalidArgumentError(message); }

bool HasCoordinates(const BlockModes& block) {
  for (const char letter : {'X', 'Y', 'Z', 'I', 'J', 'K', 'R'}) {
    if (block[letter]) return true;
  }
  return false;
}

absl::Status SetOffsetByNumber(const WordRule& rule, const std::string& spelling,
                               std::optional<double> number, BlockModes& block) {
  if (!number || !(*number >= 1.0 && *number <= rule.limit) || *number != std::floor(*number)) {
    return WordFault(fmt::format("{} needs P, a whole number from 1 to {:g}: the number of the work offset",
                                 spelling, rule.limit));
  }
  if (block.work_offset) return WordFault(spelling + ": another work offset is in the same line");
  block.work_offset = kNumberedOffsets + rule.first * 1000 + static_cast<int>(*number);
  return absl::OkStatus();
}

// Removes the values that the word takes, and returns the first.
absl::StatusOr<std::optional<double>> TakeValues(const WordRule& rule, const std::string& spelling,
                                                 BlockModes& block) {
  std::optional<double> first;
  for (const char letter : rule.takes) {
    std::optional<double>& value = block.value[static_cast<std::size_t>(letter - 'A')];
    if (rule.use == WordUse::kZeroOnly && value.value_or(0.0) != 0.0)
      return WordFault(fmt::format("{} with {}{:g}: {}", spelling, letter, *value, rule.note));
    if (letter == rule.takes.front()) first = value;
    block.still = block.still || (value && (letter == 'X' || letter == 'Y' || letter == 'Z'));
    if (value && block.without_point == letter) block.without_point = '\0';  // it is no coordinate
    value = std::nullopt;
  }
  return first;
}

}  // namespace

absl::Status UseWord(const WordRule& rule, const std::string& spelling, BlockModes& block) {
  using enum WordUse;
  if (rule.use == kRefused) return WordFault(fmt::format("{}: {}", spelling, rule.note));
  PM_ASSIGN_OR_RETURN(const std::optional<double> value, TakeValues(rule, spelling, block));
  if (!rule.takes.empty() && HasCoordinates(block))
    return WordFault(fmt::format("coordinates beside {}; give it a line of its own", spelling));
  switch (rule.use) {
    case kIgnored:
    case kZeroOnly:
      block.without_effect.push_back(spelling);
      return absl::OkStatus();
    case kOfBuilder:
      block.notes.push_back({"WORD_ASSUMED", spelling +
                                                 " is a word of the machine's builder; it is taken as one "
                                                 "that moves nothing"});
      return absl::OkStatus();
    case kStopsSpindle:
      if (!block.spindle) block.spindle = 50;
      return absl::OkStatus();
    case kBlends:
      if (block.path) return WordFault(spelling + ": another word of its modal group is in the same line");
      block.path = 640;
      return absl::OkStatus();
    case kMerges:
      block.merges = value.value_or(0.0) > rule.limit;
      return absl::OkStatus();
    case kFineStop:
    case kCoarseStop:
      block.coarse_stop = rule.use == kCoarseStop;
      return absl::OkStatus();
    case kTolerance:
      block.word = DialectWord{.tolerance_letter = rule.takes.front()};
      block.value[static_cast<std::size_t>(rule.takes.front() - 'A')] = value;
      return absl::OkStatus();
    case kOffsetByNumber:
      return SetOffsetByNumber(rule, spelling, value, block);
    case kNoOffset:
      block.no_offset = true;
      return absl::OkStatus();
    case kToolPoint:
      if (block.tool_length)
        return WordFault(spelling + ": another word of its modal group is in the same line");
      block.tool_length = 430;
      block.notes.push_back(
          {"ROTARY_ASSUMED",
           fmt::format("{} follows rotary axes; they are taken to stand at zero", spelling)});
      return absl::OkStatus();
    case kOffset:
    case kAs:
    case kRefused:
      break;  // they are codes of the modal groups, or have been refused
  }
  return absl::OkStatus();
}

}  // namespace patchmill
