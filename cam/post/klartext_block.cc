#include "cam/post/klartext_block.h"

#include <charconv>
#include <cmath>
#include <string>
#include <vector>

#include <absl/strings/ascii.h>
#include <fmt/format.h>

#include "core/base/status.h"

namespace patchmill {
namespace {

absl::Status Fault(const std::string& message) { return absl::InvalidArgumentError(message); }

// The words of a line without its number and its comment, in capitals.
std::vector<std::string> WordsOf(std::string_view line) {
  std::vector<std::string> words;
  std::string word;
  const auto end = [&] {
    if (!word.empty()) words.push_back(std::move(word));
    word.clear();
  };
  for (const char c : line.substr(0, line.find(';'))) {
    if (c == ' ' || c == '\t') {
      end();
    } else {
      word += absl::ascii_toupper(static_cast<unsigned char>(c));
    }
  }
  end();
  if (!words.empty() && words.front().find_first_not_of("0123456789") == std::string::npos)
    words.erase(words.begin());
  return words;
}

// [+-] digits [. digits], all of the text.
std::optional<double> NumberOf(std::string_view text) {
  if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);
  double value = 0.0;
  const auto [end, error] =
      std::from_chars(text.data(), text.data() + text.size(), value, std::chars_format::fixed);
  if (error != std::errc() || end != text.data() + text.size() || text.empty() || !std::isfinite(value))
    return std::nullopt;
  return value;
}

std::string Shown(const std::string& word) {
  std::string shown;
  for (const char c : word.substr(0, 40)) shown += c > ' ' && c <= '~' ? c : '?';
  return shown;
}

// Collects what the words of one line set. Each may be set once.
class BlockBuilder {
 public:
  BlockModes modes;
  bool machine_place = false;  // M91
  bool rapid = false;          // FMAX

  absl::Status Set(char letter, double number) {
    auto& value = modes.value[static_cast<std::size_t>(letter - 'A')];
    if (value) return Fault(fmt::format("{} is given twice", letter));
    value = number;
    return absl::OkStatus();
  }
  absl::Status Set(BlockModes::Code& group, int code, const std::string& word) {
    if (group) return Fault(Shown(word) + ": another word of its kind is in the same line");
    group = code;
    return absl::OkStatus();
  }

  // Words that end any line of motion: R0, F, FMAX, M.
  absl::Status Common(const std::string& word) {
    if (word == "R0") return absl::OkStatus();
    if (word == "RL" || word == "RR" || word == "R+" || word == "R-")
      return Fault(word + ": radius compensation is not supported");
    if (word == "FMAX") {
      rapid = true;
      return absl::OkStatus();
    }
    const auto number = NumberOf(std::string_view(word).substr(1));
    if (word[0] == 'F' && number) return Set('F', *number);
    if (word[0] == 'M' && number) return Function(word, *number);
    return Fault(Shown(word) + " is not supported");
  }

  absl::Status Function(const std::string& word, double number) {
    switch (number == std::floor(number) && number <= 999.0 ? static_cast<int>(number) : -1) {
      case 0:
      case 1:
      case 2:
      case 30:
        return Set(modes.stop, static_cast<int>(number) * 10, word);
      case 3:
      case 4:
      case 5:
        return Set(modes.spindle, static_cast<int>(number) * 10, word);
      case 7:
      case 8:
      case 9:
        return Set(modes.coolant, static_cast<int>(number) * 10, word);
      case 13:
      case 14:
        PM_RETURN_IF_ERROR(Set(modes.spindle, number == 13.0 ? 30 : 40, word));
        return Set(modes.coolant, 80, word);
      case 91:
        machine_place = true;
        return absl::OkStatus();
      default:
        return Fault(Shown(word) + " is not supported");
    }
  }

  absl::Status Coordinate(const std::string& word) {
    if (const auto number = NumberOf(std::string_view(word).substr(1))) return Set(word[0], *number);
    return Fault(Shown(word) + ": not a number; Q parameters and expressions are not supported");
  }
};

bool IsCoordinate(const std::string& word) { return word[0] == 'X' || word[0] == 'Y' || word[0] == 'Z'; }

absl::StatusOr<BlockModes> Line(const std::vector<std::string>& words) {
  BlockBuilder b;
  for (std::size_t k = 1; k < words.size(); ++k)
    PM_RETURN_IF_ERROR(IsCoordinate(words[k]) ? b.Coordinate(words[k]) : b.Common(words[k]));
  if (b.rapid && b.modes['F']) return Fault("F and FMAX in one line");
  b.modes.motion = b.rapid ? 0 : 10;
  if (b.machine_place) b.modes.once = 530;
  return b.modes;
}

// C around the pole, or CR with a radius.
absl::StatusOr<BlockModes> ArcLine(const std::vector<std::string>& words, const std::optional<double>& pole_x,
                                   const std::optional<double>& pole_y) {
  BlockBuilder b;
  const bool by_radius = words[0] == "CR";
  for (std::size_t k = 1; k < words.size(); ++k) {
    const std::string& word = words[k];
    if (word == "DR+" || word == "DR-") {
      PM_RETURN_IF_ERROR(b.Set(b.modes.motion, word == "DR-" ? 20 : 30, word));
    } else if (IsCoordinate(word) ||
               (by_radius && word[0] == 'R' && word != "R0" && word != "RL" && word != "RR")) {
      PM_RETURN_IF_ERROR(b.Coordinate(word));
    } else {
      PM_RETURN_IF_ERROR(b.Common(word));
    }
  }
  if (!b.modes.motion) return Fault(words[0] + " without DR+ or DR-");
  if (b.rapid || b.machine_place) return Fault(words[0] + " with FMAX or M91");
  if (by_radius) {
    if (!b.modes['R']) return Fault("CR without R");
    return b.modes;
  }
  if (!pole_x || !pole_y) return Fault("C without CC before it");
  b.modes.arc_distance = 901;
  PM_RETURN_IF_ERROR(b.Set('I', *pole_x));
  PM_RETURN_IF_ERROR(b.Set('J', *pole_y));
  return b.modes;
}

absl::StatusOr<BlockModes> ToolCall(const std::vector<std::string>& words) {
  BlockBuilder b;
  bool axis = false;
  for (std::size_t k = 2; k < words.size(); ++k) {
    const std::string& word = words[k];
    const auto number = NumberOf(word), value = NumberOf(std::string_view(word).substr(1));
    if (k == 2 && number) {
      PM_RETURN_IF_ERROR(b.Set('T', *number));
    } else if (word == "Z") {
      axis = true;
    } else if ((word[0] == 'S' || word[0] == 'F') && value) {
      PM_RETURN_IF_ERROR(b.Set(word[0], *value));
    } else if (word.size() > 2 && word[0] == 'D' && (word[1] == 'L' || word[1] == 'R') &&
               NumberOf(std::string_view(word).substr(2)) == 0.0) {
      continue;  // no oversize
    } else {
      return Fault("TOOL CALL: " + Shown(word) + " is not supported");
    }
  }
  if (!b.modes['T']) {
    if (!b.modes['S']) return Fault("TOOL CALL without a number or S");
    return b.modes;  // only the speed changes
  }
  if (!axis) return Fault("TOOL CALL without the tool axis Z");
  b.modes.tool_change = 60;
  b.modes.tool_length = 430;
  PM_RETURN_IF_ERROR(b.Set('H', *b.modes['T']));
  return b.modes;
}

// Lines of the cycles 32 (tolerance) and 9 (dwell). Those without an effect of their own give no block.
absl::StatusOr<std::optional<BlockModes>> Cycle(const std::vector<std::string>& words) {
  const std::string& part = words[2];
  BlockBuilder b;
  if (part == "32.0" || part == "9.0" || part == "32.2") return std::nullopt;
  if (part == "32.1") {
    b.modes.word = DialectWord{.tolerance_letter = 'E'};
    for (std::size_t k = 3; k < words.size(); ++k) {
      const auto number = NumberOf(std::string_view(words[k]).substr(1));
      if (words[k][0] != 'T' || !number || !(*number >= 0.0))
        return Fault("CYCL DEF 32.1: " + Shown(words[k]));
      // T0 leaves the tolerance to the machine, as no T does.
      if (*number > 0.0) PM_RETURN_IF_ERROR(b.Set('E', *number));
    }
    return b.modes;
  }
  if (part == "9.1" && words.size() == 5 && (words[3] == "DWELL" || words[3] == "V.ZEIT")) {
    const auto number = NumberOf(words[4]);
    if (!number) return Fault("CYCL DEF 9.1: " + Shown(words[4]));
    b.modes.once = 40;
    PM_RETURN_IF_ERROR(b.Set('P', *number));
    return b.modes;
  }
  return Fault("CYCL DEF " + Shown(part) + " is not supported");
}

}  // namespace

absl::StatusOr<std::optional<BlockModes>> KlartextReader::Read(std::string_view line) {
  auto block = ReadBlock(line);
  if (!block.ok() || !*block || !inch_) return block;
  if (auto& feed = (*block)->value['F' - 'A']) *feed *= 0.1;
  return block;
}

absl::StatusOr<std::optional<BlockModes>> KlartextReader::ReadBlock(std::string_view line) {
  const std::vector<std::string> words = WordsOf(line);
  if (words.empty()) return std::nullopt;
  if (ended_) return Fault("text after END PGM");
  const std::string& first = words[0];
  const std::string second = words.size() > 1 ? words[1] : "";
  if (!begun_) {
    if (first != "BEGIN" || second != "PGM") return Fault("a program begins with BEGIN PGM");
    const std::string unit = words.back();
    if (words.size() < 4 || (unit != "MM" && unit != "INCH"))
      return Fault("BEGIN PGM without a name, and MM or INCH");
    begun_ = true;
    inch_ = unit == "INCH";
    BlockModes modes;
    modes.units = unit == "MM" ? 210 : 200;
    modes.distance = 900;
    modes.plane = 170;
    modes.feed_mode = 940;
    return modes;
  }
  if (first == "END" && second == "PGM") {
    ended_ = true;
    return std::nullopt;
  }
  if (first == "BLK" || (first == "TOOL" && second == "DEF")) return std::nullopt;
  if (first == "TOOL" && second == "CALL") return ToolCall(words);
  if (first == "CYCL" && second == "DEF" && words.size() > 2) return Cycle(words);
  if (first == "L") return Line(words);
  if (first == "C" || first == "CR") return ArcLine(words, pole_x_, pole_y_);
  if (first == "CC") {
    pole_x_ = pole_y_ = std::nullopt;
    for (std::size_t k = 1; k < words.size(); ++k) {
      const auto number = NumberOf(std::string_view(words[k]).substr(1));
      if (!number || (words[k][0] != 'X' && words[k][0] != 'Y'))
        return Fault("CC: " + Shown(words[k]) + " is not supported");
      (words[k][0] == 'X' ? pole_x_ : pole_y_) = *number;
    }
    if (!pole_x_ || !pole_y_) return Fault("CC needs X and Y");
    return std::nullopt;
  }
  if (first == "STOP" || (first[0] == 'M' && NumberOf(std::string_view(first).substr(1)))) {
    BlockBuilder b;
    for (const std::string& word : words) {
      if (word == "STOP") {
        PM_RETURN_IF_ERROR(b.Set(b.modes.stop, 0, word));
      } else {
        PM_RETURN_IF_ERROR(b.Common(word));
      }
    }
    if (b.machine_place || b.rapid) return Fault("M91 or FMAX without a move");
    return b.modes;
  }
  return Fault(Shown(first) + " is not supported");
}

}  // namespace patchmill
