#include "cam/post/klartext_setup.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "cam/post/klartext_words.h"
#include "core/base/status.h"

namespace patchmill {
namespace {

absl::Status SetupFault(const std::string& message) { return absl::InvalidArgumentError(message); }

constexpr std::string_view kFrameReason =
    "it shifts, turns, scales or mirrors the program; post the program in the frame of the part";

std::string Joined(const std::vector<std::string>& words, std::size_t count) {
  std::string text;
  for (std::size_t k = 0; k < std::min(count, words.size()); ++k) {
    if (k > 0) text += ' ';
    text += ShownWord(words[k]);
  }
  return text;
}

// The number after the letters of a word: 0.5 of "DR2:+0.5" with the letters "DR2:".
std::optional<double> After(const std::string& word, std::string_view letters) {
  if (word.compare(0, letters.size(), letters) != 0) return std::nullopt;
  return KlartextNumber(std::string_view(word).substr(letters.size()));
}

absl::Status SetValue(BlockModes& modes, char letter, double number) {
  auto& value = modes.value[static_cast<std::size_t>(letter - 'A')];
  if (value) return SetupFault(fmt::format("{} is given twice", letter));
  value = number;
  return absl::OkStatus();
}

// DL, DR and DR2 of a tool call.
absl::StatusOr<bool> IsOversize(const std::string& word) {
  for (const char* const letters : {"DR2:", "DR2", "DL", "DR"}) {
    const std::optional<double> oversize = After(word, letters);
    if (!oversize) continue;
    if (*oversize == 0.0) return true;
    return SetupFault(fmt::format(
        "TOOL CALL: {} is not supported: the tool cuts by its oversize beside its path", ShownWord(word)));
  }
  return false;
}

absl::StatusOr<std::optional<BlockModes>> Tolerance(const std::vector<std::string>& words) {
  BlockModes modes;
  modes.word = DialectWord{.tolerance_letter = 'E'};
  for (std::size_t k = 3; k < words.size(); ++k) {
    const std::optional<double> number = After(words[k], "T");
    if (!number || !(*number >= 0.0)) return SetupFault("CYCL DEF 32.1: " + ShownWord(words[k]));
    // T0 leaves the tolerance to the machine, as no T does.
    if (*number > 0.0) PM_RETURN_IF_ERROR(SetValue(modes, 'E', *number));
  }
  return modes;
}

absl::StatusOr<std::optional<BlockModes>> Dwell(const std::vector<std::string>& words) {
  const std::optional<double> number = words.size() == 5 ? KlartextNumber(words[4]) : std::nullopt;
  if (!number || (words[3] != "DWELL" && words[3] != "V.ZEIT"))
    return SetupFault("CYCL DEF 9.1: it must be \"DWELL\" and seconds");
  BlockModes modes;
  modes.once = 40;
  PM_RETURN_IF_ERROR(SetValue(modes, 'P', *number));
  return modes;
}

// CYCL DEF 247: a preset of the table.
absl::StatusOr<std::optional<BlockModes>> Preset(const std::vector<std::string>& words) {
  constexpr double kMost = 999.0;
  for (const std::string& word : words) {
    const std::optional<double> number = After(word, "Q339=");
    if (!number) continue;
    if (!(*number >= 0.0 && *number <= kMost) || *number != std::floor(*number))
      return SetupFault(
          fmt::format("CYCL DEF 247: {} must be a whole number from 0 to {:g}", ShownWord(word), kMost));
    BlockModes modes;
    modes.work_offset = kPresets + static_cast<int>(*number);
    return modes;
  }
  return SetupFault("CYCL DEF 247 without Q339=, the number of the preset");
}

// A frame of the cycles 7, 8, 10, 11, 19 and 26 that changes nothing: values of zero, and a scale of 1.
absl::StatusOr<std::optional<BlockModes>> Neutral(const std::vector<std::string>& words) {
  const std::string& part = words[2];
  const bool first = part.size() > 2 && part.compare(part.size() - 2, 2, ".0") == 0;
  if (first) return std::nullopt;  // its name
  for (std::size_t k = 3; k < words.size(); ++k) {
    const std::string& word = words[k];
    const std::size_t letters = std::min(word.find_first_of("+-.0123456789"), word.size());
    const std::optional<double> number = KlartextNumber(std::string_view(word).substr(letters));
    const bool scale = part.compare(0, 3, "11.") == 0 || part.compare(0, 3, "26.") == 0;
    if (letters > 0 && number == (scale ? 1.0 : 0.0)) continue;
    return SetupFault(fmt::format("CYCL DEF {} with {}: {}", ShownWord(part), ShownWord(word), kFrameReason));
  }
  BlockModes modes;
  modes.without_effect = {fmt::format("CYCL DEF {}", part.substr(0, part.find('.')))};
  return modes;
}

// Values of PLANE and TRANS that turn and shift nothing, and words about how rotary axes get there.
bool IsNeutral(const std::string& word) {
  for (const char* const way :
       {"STAY", "TURN", "MOVE", "FMAX", "FAUTO", "SEQ+", "SEQ-", "SYM+", "SYM-", "COORD", "TABLE", "ROT"}) {
    if (word == way) return true;
  }
  for (const char* const way : {"F", "DIST", "ABST", "MB"}) {
    if (After(word, way)) return true;
  }
  for (const char* const angle : {"SPA", "SPB", "SPC", "A", "B", "C", "X", "Y", "Z"}) {
    if (After(word, angle) == 0.0) return true;
  }
  return false;
}

}  // namespace

absl::StatusOr<BlockModes> ReadToolCall(const std::vector<std::string>& words) {
  BlockModes modes;
  bool axis = false;
  for (std::size_t k = 2; k < words.size(); ++k) {
    const std::string& word = words[k];
    const auto number = KlartextNumber(word), value = KlartextNumber(std::string_view(word).substr(1));
    PM_ASSIGN_OR_RETURN(const bool oversize, IsOversize(word));
    if (k == 2 && number) {
      PM_RETURN_IF_ERROR(SetValue(modes, 'T', *number));
    } else if (k == 2 && word.size() > 2 && word.front() == '"' && word.back() == '"') {
      modes.tool_name = ShownWord(std::string_view(word).substr(1, word.size() - 2));
    } else if (word == "Z") {
      axis = true;
    } else if ((word[0] == 'S' || word[0] == 'F') && value) {
      PM_RETURN_IF_ERROR(SetValue(modes, word[0], *value));
    } else if (!oversize) {
      return SetupFault("TOOL CALL: " + ShownWord(word) + " is not supported");
    }
  }
  if (!modes['T'] && modes.tool_name.empty()) {
    if (!modes['S'] && !modes['F']) return SetupFault("TOOL CALL without a number, a name, S or F");
    return modes;  // only the speed or the feed changes
  }
  if (!axis) return SetupFault("TOOL CALL without the tool axis Z");
  modes.tool_change = 60;
  modes.tool_length = 430;
  if (modes['T']) modes.value['H' - 'A'] = modes['T'];
  return modes;
}

absl::StatusOr<std::optional<BlockModes>> ReadToolDef(const std::vector<std::string>& words) {
  for (std::size_t k = 2; k < words.size(); ++k) {
    if (!After(words[k], "L")) continue;
    BlockModes modes;
    modes.notes.push_back({"LENGTH_OFFSET_ASSUMED",
                           fmt::format("TOOL DEF states the length {}; it is taken as that of the right tool",
                                       ShownWord(words[k]))});
    return modes;
  }
  return std::nullopt;
}

absl::StatusOr<std::optional<BlockModes>> ReadCycleDef(const std::vector<std::string>& words) {
  const std::string& part = words[2];
  const std::string number = part.substr(0, part.find('.'));
  if (part == "32.0" || part == "9.0" || part == "32.2") return std::nullopt;
  if (part == "32.1") return Tolerance(words);
  if (part == "9.1") return Dwell(words);
  if (part == "247") return Preset(words);
  for (const char* const frame : {"7", "8", "10", "11", "19", "26"}) {
    if (number == frame && part.size() > number.size()) return Neutral(words);
  }
  return SetupFault(fmt::format("CYCL DEF {} is not supported: post the program with the moves of the cycle",
                                ShownWord(part)));
}

absl::StatusOr<BlockModes> ReadFrame(const std::vector<std::string>& words) {
  BlockModes modes;
  const std::string& first = words[0];
  const std::string second = words.size() > 1 ? words[1] : "", third = words.size() > 2 ? words[2] : "";
  modes.without_effect = {Joined(words, 2)};
  const auto refused = [&] {
    return SetupFault(fmt::format("{} is not supported in {}: {}", first, Joined(words, 4), kFrameReason));
  };
  if (first == "FUNCTION") {
    if (second == "TCPM") {
      modes.without_effect.clear();
      modes.notes.push_back(
          {"ROTARY_ASSUMED", "FUNCTION TCPM follows rotary axes; they are taken to stand at zero"});
      return modes;
    }
    if ((second == "RESET" && third == "TCPM") || (second == "MODE" && third == "MILL")) return modes;
    return SetupFault(Joined(words, 3) + " is not supported");
  }
  if (first == "TRANS") {
    const bool values = second == "DATUM" && third == "AXIS";
    if (third == "RESET") return modes;
    if (!values || !std::all_of(words.begin() + 3, words.end(), IsNeutral)) return refused();
    return modes;
  }
  const bool angles = second == "SPATIAL" || second == "AXIAL" || second == "RELATIV" || second == "RESET";
  if (!angles || !std::all_of(words.begin() + 2, words.end(), IsNeutral)) return refused();
  modes.rotary = std::find(words.begin(), words.end(), "STAY") == words.end();
  return modes;
}

}  // namespace patchmill
