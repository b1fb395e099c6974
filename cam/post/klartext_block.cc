#include "cam/post/klartext_block.h"

#include <cmath>

#include <fmt/format.h>

#include "cam/post/klartext_setup.h"
#include "cam/post/klartext_words.h"
#include "cam/post/word_use.h"
#include "core/base/status.h"

namespace patchmill {
namespace {

absl::Status Fault(const std::string& message) { return absl::InvalidArgumentError(message); }

// First words of lines that are refused, and why.
struct RefusedLine {
  std::string_view first, why;
};
constexpr std::string_view kPolar = "polar coordinates are not read; post the program with X, Y and Z";
constexpr std::string_view kCorner = "the control makes contours by itself; post the moves";
constexpr std::string_view kProgram =
    "subprograms and repeats are not supported; post the program without them";
constexpr std::string_view kParameter = "Q parameters are not supported; post the program with numbers";
constexpr RefusedLine kRefusedLines[] = {
    {"LP", kPolar},
    {"CP", kPolar},
    {"CTP", kPolar},
    {"FPOL", kCorner},
    {"RND", kCorner},
    {"CHF", kCorner},
    {"APPR", kCorner},
    {"DEP", kCorner},
    {"FL", kCorner},
    {"FC", kCorner},
    {"FLT", kCorner},
    {"FCT", kCorner},
    {"FSELECT", kCorner},
    {"CT", "its centre depends on the move before it; post arcs with C or CR"},
    {"LN", "vectors of surfaces are not read; post a program of three axes"},
    {"SPL", "splines are not read; post the program with straight moves and arcs"},
    {"LBL", kProgram},
    {"CALL", kProgram},
    {"SEL", kProgram},
    {"CYCL", kProgram},
    {"FN", kParameter},
    {"Q", kParameter},
    {"QL", kParameter},
    {"QR", kParameter},
    {"QS", kParameter},
};

bool IsCoordinate(const std::string& word) { return word[0] == 'X' || word[0] == 'Y' || word[0] == 'Z'; }
bool IsIncremental(const std::string& word) {
  return word.size() > 2 && word[0] == 'I' && word[1] >= 'X' && word[1] <= 'Z';
}
bool IsRotary(const std::string& word) {
  const std::size_t at = word[0] == 'I' ? 1 : 0;
  return word.size() > at + 1 && word[at] >= 'A' && word[at] <= 'C' && word[at + 1] < 'A';
}
bool IsFunction(const std::string& word) {
  return word[0] == 'M' && KlartextNumber(std::string_view(word).substr(1)).has_value();
}

// Collects what the words of one line set. Each may be set once.
class BlockBuilder {
 public:
  explicit BlockBuilder(std::optional<double> tool_feed) : tool_feed_(tool_feed) {}

  BlockModes modes;
  bool machine_place = false;  // M91, M92
  bool rapid = false;          // FMAX
  bool retracts = false;       // M140

  absl::Status Set(char letter, double number) {
    auto& value = modes.value[static_cast<std::size_t>(letter - 'A')];
    if (value) return Fault(fmt::format("{} is given twice", letter));
    value = number;
    return absl::OkStatus();
  }
  absl::Status Set(BlockModes::Code& group, int code, const std::string& word) {
    if (group) return Fault(ShownWord(word) + ": another word of its kind is in the same line");
    group = code;
    return absl::OkStatus();
  }

  // Words of any line of motion: coordinates, R0, F, FMAX, M.
  absl::Status Read(const std::string& word) {
    if (IsCoordinate(word) || IsIncremental(word)) return Coordinate(word);
    if (IsRotary(word)) return Rotary(word);
    if (word == "R0") return absl::OkStatus();
    if (word == "RL" || word == "RR" || word == "R+" || word == "R-")
      return Fault(word + ": radius compensation is not supported");
    if (word == "FMAX") {
      rapid = true;
      return absl::OkStatus();
    }
    if (word == "FAUTO") {
      if (!tool_feed_) return Fault("FAUTO without an F in TOOL CALL before it");
      return Set('F', *tool_feed_);
    }
    const auto number = KlartextNumber(std::string_view(word).substr(1));
    if (word[0] == 'F' && number) return Set('F', *number);
    if (word[0] == 'M' && number) return Function(word, *number);
    if (word.compare(0, 2, "MB") == 0) return Retract(word.substr(2));
    if (retracts && word == "MAX") return Retract(word);
    return Fault(ShownWord(word) + " is not supported");
  }

  absl::Status Finish() {
    if (rapid && modes['F']) return Fault("F and FMAX in one line");
    if (retracts && !modes['Z']) return Fault("M140 without MB MAX or MB and a length");
    return absl::OkStatus();
  }

 private:
  absl::Status Function(const std::string& word, double number) {
    const int code = number == std::floor(number) && number <= 999.0 ? static_cast<int>(number) * 10 : -1;
    switch (code) {
      case 0:
      case 10:
      case 20:
      case 300:
        return Set(modes.stop, code, word);
      case 30:
      case 40:
      case 50:
        return Set(modes.spindle, code, word);
      case 70:
      case 80:
      case 90:
        return Set(modes.coolant, code, word);
      case 130:
      case 140:
        PM_RETURN_IF_ERROR(Set(modes.spindle, code == 130 ? 30 : 40, word));
        return Set(modes.coolant, 80, word);
      case 920:
        modes.notes.push_back(
            {"MACHINE_Z_ASSUMED", "the datum of M92 is taken to be no lower than that of M91"});
        machine_place = true;
        return absl::OkStatus();
      case 910:
        machine_place = true;
        return absl::OkStatus();
      case 1400:
        retracts = true;
        return absl::OkStatus();
      default:
        break;
    }
    const WordRule* const rule = FindWordRule(WordFamily::kHeidenhain, 'M', code);
    if (rule == nullptr) return Fault(ShownWord(word) + " is not supported");
    return UseWord(*rule, ShownWord(word), modes);
  }

  // What follows M140: MB MAX goes up to the top of the machine, MB+50 by 50 mm.
  absl::Status Retract(const std::string& value) {
    if (!retracts) return Fault("MB without M140");
    if (value.empty()) return absl::OkStatus();  // its value is the next word
    if (value == "MAX") {
      modes.once = 530;
      return Set('Z', 0.0);
    }
    const auto number = KlartextNumber(value);
    if (!number || !(*number >= 0.0))
      return Fault(fmt::format("M140 MB{}: it must be MAX, or 0 or more", ShownWord(value)));
    modes.axis_mode[2] = AxisMode::kIncremental;
    return Set('Z', *number);
  }

  absl::Status Coordinate(const std::string& word) {
    const bool incremental = word[0] == 'I';
    const auto number = KlartextNumber(std::string_view(word).substr(incremental ? 2 : 1));
    if (!number)
      return Fault(ShownWord(word) + ": not a number; Q parameters and expressions are not supported");
    const char letter = word[incremental ? 1 : 0];
    if (incremental) modes.axis_mode[static_cast<std::size_t>(letter - 'X')] = AxisMode::kIncremental;
    return Set(letter, *number);
  }

  absl::Status Rotary(const std::string& word) {
    const auto number = KlartextNumber(std::string_view(word).substr(word[0] == 'I' ? 2 : 1));
    if (number != 0.0) {
      return Fault(ShownWord(word) +
                   " turns a rotary axis; programs of three axes are judged, with rotary axes at 0");
    }
    modes.rotary = true;
    return absl::OkStatus();
  }

  std::optional<double> tool_feed_;
};

absl::StatusOr<BlockModes> MoveLine(const std::vector<std::string>& words, std::optional<double> tool_feed) {
  BlockBuilder b(tool_feed);
  for (std::size_t k = words[0] == "L" ? 1 : 0; k < words.size(); ++k) PM_RETURN_IF_ERROR(b.Read(words[k]));
  PM_RETURN_IF_ERROR(b.Finish());
  if (b.retracts && (b.modes['X'] || b.modes['Y'] || b.machine_place))
    return Fault("M140 beside coordinates; give it a line of its own");
  // Without F a retraction is a rapid.
  b.modes.motion = b.rapid || (b.retracts && !b.modes['F']) ? 0 : 10;
  if (b.machine_place) b.modes.once = 530;
  return b.modes;
}

// STOP and M words.
absl::StatusOr<BlockModes> FunctionLine(const std::vector<std::string>& words) {
  BlockBuilder b(std::nullopt);
  for (const std::string& word : words) {
    if (word == "STOP") {
      PM_RETURN_IF_ERROR(b.Set(b.modes.stop, 0, word));
    } else {
      PM_RETURN_IF_ERROR(b.Read(word));
    }
  }
  if (b.retracts) return MoveLine(words, std::nullopt);
  if (b.machine_place || b.rapid || b.modes['X'] || b.modes['Y'] || b.modes['Z'])
    return Fault("M91, M92, FMAX or coordinates without a move");
  return b.modes;
}

}  // namespace

absl::StatusOr<BlockModes> KlartextReader::ArcLine(const std::vector<std::string>& words) const {
  BlockBuilder b(tool_feed_);
  const bool by_radius = words[0] == "CR";
  for (std::size_t k = 1; k < words.size(); ++k) {
    const std::string& word = words[k];
    const auto radius = KlartextNumber(std::string_view(word).substr(1));
    if (word == "DR+" || word == "DR-") {
      PM_RETURN_IF_ERROR(b.Set(b.modes.motion, word == "DR-" ? 20 : 30, word));
    } else if (by_radius && word[0] == 'R' && word != "R0" && radius) {
      PM_RETURN_IF_ERROR(b.Set('R', *radius));
    } else {
      PM_RETURN_IF_ERROR(b.Read(word));
    }
  }
  PM_RETURN_IF_ERROR(b.Finish());
  if (!b.modes.motion) return Fault(words[0] + " without DR+ or DR-");
  if (b.rapid || b.machine_place || b.retracts) return Fault(words[0] + " with FMAX, M91, M92 or M140");
  if (by_radius) {
    if (!b.modes['R']) return Fault("CR without R");
    return b.modes;
  }
  if (!pole_x_ || !pole_y_) return Fault("C without CC before it");
  b.modes.arc_distance = 901;
  PM_RETURN_IF_ERROR(b.Set('I', *pole_x_));
  PM_RETURN_IF_ERROR(b.Set('J', *pole_y_));
  return b.modes;
}

absl::StatusOr<std::optional<BlockModes>> KlartextReader::Read(std::string_view line) {
  constexpr std::size_t kMostWords = 500;
  std::vector<std::string> words = KlartextWords(line);
  if (!open_.empty()) words.insert(words.begin(), open_.begin(), open_.end());
  open_.clear();
  if (words.empty()) return std::nullopt;
  if (words.size() > kMostWords) return Fault(fmt::format("more than {} words in one line", kMostWords));
  if (KlartextGoesOn(line)) {
    open_ = std::move(words);
    return std::nullopt;
  }
  auto block = ReadBlock(words);
  if (!block.ok() || !*block || !inch_) return block;
  if (auto& feed = (*block)->value['F' - 'A']) *feed *= 0.1;
  return block;
}

absl::StatusOr<std::optional<BlockModes>> KlartextReader::Begin(const std::vector<std::string>& words) {
  if (words[0] != "BEGIN" || words.size() < 2 || words[1] != "PGM")
    return Fault("a program begins with BEGIN PGM");
  const std::string& unit = words.back();
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

absl::Status KlartextReader::SetPole(const std::vector<std::string>& words) {
  pole_x_ = pole_y_ = std::nullopt;
  for (std::size_t k = 1; k < words.size(); ++k) {
    const auto number = KlartextNumber(std::string_view(words[k]).substr(1));
    if (!number || (words[k][0] != 'X' && words[k][0] != 'Y'))
      return Fault("CC: " + ShownWord(words[k]) + " is not supported");
    (words[k][0] == 'X' ? pole_x_ : pole_y_) = *number;
  }
  if (!pole_x_ || !pole_y_) return Fault("CC needs X and Y");
  return absl::OkStatus();
}

absl::StatusOr<std::optional<BlockModes>> KlartextReader::ReadBlock(const std::vector<std::string>& words) {
  if (ended_) return Fault("text after END PGM");
  const std::string& first = words[0];
  const std::string second = words.size() > 1 ? words[1] : "";
  if (!begun_) return Begin(words);
  if (first == "END" && second == "PGM") {
    ended_ = true;
    return std::nullopt;
  }
  if (first == "BLK" || first == "*") return std::nullopt;
  if (first == "TOOL" && second == "DEF") return ReadToolDef(words);
  if (first == "TOOL" && second == "CALL") {
    auto modes = ReadToolCall(words);
    if (modes.ok() && (*modes)['F']) tool_feed_ = (*modes)['F'];
    return modes;
  }
  if (first == "CYCL" && second == "DEF" && words.size() > 2) return ReadCycleDef(words);
  if (first == "PLANE" || first == "TRANS" || first == "FUNCTION") return ReadFrame(words);
  if (first == "L") return MoveLine(words, tool_feed_);
  if (first == "C" || first == "CR") return ArcLine(words);
  if (first == "CC") {
    PM_RETURN_IF_ERROR(SetPole(words));
    return std::nullopt;
  }
  if (first == "STOP" || IsFunction(first)) return FunctionLine(words);
  // A parameter has its number and = in the same word: Q1=5.
  const std::string_view name =
      std::string_view(first).substr(0, first[0] == 'Q' ? first.find_first_of("0123456789=") : first.npos);
  for (const RefusedLine& refused : kRefusedLines) {
    if (refused.first == name)
      return Fault(fmt::format("{} is not supported: {}", ShownWord(first), refused.why));
  }
  return Fault(ShownWord(first) + " is not supported");
}

}  // namespace patchmill
