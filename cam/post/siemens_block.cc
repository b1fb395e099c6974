#include "cam/post/siemens_block.h"

#include <cmath>
#include <string>

#include <fmt/format.h>

#include "cam/post/siemens_calls.h"
#include "cam/post/siemens_names.h"
#include "core/base/status.h"

namespace patchmill {
namespace {

absl::Status Refuse(const std::string& message) { return absl::InvalidArgumentError(message); }

bool IsAxis(std::string_view name) { return name == "X" || name == "Y" || name == "Z"; }
bool IsCenter(std::string_view name) { return name == "I" || name == "J" || name == "K"; }

// Collects what the items of one line say.
class LineReader {
 public:
  explicit LineReader(const Dialect& dialect) : dialect_(dialect) {}

  absl::StatusOr<std::optional<BlockModes>> Run(const SiemensLine& line) {
    if (line.items.empty()) return std::nullopt;
    const SiemensItem& first = line.items.front();
    if (first.kind == SiemensItem::Kind::kKeyword) {
      const SiemensName* const known = FindKeyword(first.name);
      if (known != nullptr && known->use == NameUse::kFrame) return Frame(line);
    }
    if (first.kind == SiemensItem::Kind::kCall && (first.name == "CYCLE832" || first.name == "CYCLE800")) {
      if (line.items.size() > 1)
        return Refuse(fmt::format("text beside {}; give it a line of its own", first.name));
      PM_ASSIGN_OR_RETURN(BlockModes modes,
                          first.name == "CYCLE832" ? ReadCycle832(first.text) : ReadCycle800(first.text));
      modes.deletable = line.deletable;
      return modes;
    }
    for (const SiemensItem& item : line.items) PM_RETURN_IF_ERROR(Item(item));
    if (modal_call_ && line.items.size() > 1) return Refuse("MCALL calls a subprogram at every place");
    words_.deletable = line.deletable;
    return Finish();
  }

 private:
  absl::Status Item(const SiemensItem& item) {
    switch (item.kind) {
      case SiemensItem::Kind::kWord:
        return Word(item);
      case SiemensItem::Kind::kAssign:
        return Assign(item);
      case SiemensItem::Kind::kKeyword:
        return Named(item.name, FindKeyword(item.name));
      case SiemensItem::Kind::kCall:
        return Call(item);
    }
    return absl::OkStatus();
  }

  absl::Status Word(const SiemensItem& item) {
    const char letter = item.name.front();
    if (letter == 'R') return Refuse("R is a parameter of calculations; the radius of an arc is CR=");
    if (letter == 'L' || letter == 'P')
      return Refuse(fmt::format("{}{:g}: subprograms are not supported; post the program without them",
                                letter, item.number));
    if (letter == 'H') return Refuse("H is not supported; the tool's length comes from D");
    if (letter == 'D') return Edge(item.number);
    if (letter == 'G') return GWord(item.number);
    if (IsCenter(item.name)) ++relative_centers_;
    Push(letter, item.number);
    return absl::OkStatus();
  }

  absl::Status Edge(double number) {
    if (number != 0.0 && number != 1.0)
      return Refuse(fmt::format("D{:g}: the first cutting edge alone is judged; use D1", number));
    if (edge_) return Refuse("D is given twice");
    edge_ = static_cast<int>(number);
    return absl::OkStatus();
  }

  absl::Status GWord(double number) {
    if (number == 153.0) {
      machine_ = true;
    } else if (number == 74.0 || number == 75.0) {
      reference_ = true;
    } else {
      if (number == 70.0 || number == 71.0) basic_unit_ = static_cast<int>(number);
      limits_ = limits_ || number == 25.0 || number == 26.0;
      Push('G', number);
    }
    return absl::OkStatus();
  }

  absl::Status Call(const SiemensItem& item) {
    const SiemensName* const known = FindCall(item.name);
    if (known == nullptr) {
      return Refuse(fmt::format("{}(): calls are not supported; post the program with the moves of the call",
                                item.name.substr(0, 40)));
    }
    return Named(item.name, known);
  }

  absl::Status Named(std::string_view name, const SiemensName* known) {
    if (known == nullptr) {
      return Refuse(fmt::format("{} is not supported: it is no word that is known to move nothing",
                                name.substr(0, 40)));
    }
    if (name == "MCALL") modal_call_ = true;
    switch (known->use) {
      case NameUse::kRefused:
        return Refuse(fmt::format("{}: {}", name, known->note));
      case NameUse::kMachine:
        machine_ = true;
        return absl::OkStatus();
      case NameUse::kMerges:
      case NameUse::kEndsMerging:
        merges_ = known->use == NameUse::kMerges;
        return absl::OkStatus();
      case NameUse::kTool:
        notes_.push_back(
            {"ROTARY_ASSUMED", fmt::format("{} follows rotary axes; they are taken to stand at zero", name)});
        return absl::OkStatus();
      case NameUse::kSpindle:
        stops_spindle_ = true;
        return absl::OkStatus();
      case NameUse::kFrame:
        return Refuse(fmt::format("{} beside other words; give it a line of its own", name));
      case NameUse::kIgnored:
      case NameUse::kZeroOnly:
        without_effect_.emplace_back(name);
        return absl::OkStatus();
    }
    return absl::OkStatus();
  }

  absl::Status Assign(const SiemensItem& item) {
    if (item.name == "T") return Tool(item);
    const std::optional<double> number = item.quoted ? std::nullopt : SiemensNumber(item.text);
    const SiemensName* const known = FindAddress(item.name);
    if (known != nullptr && known->use == NameUse::kRefused)
      return Refuse(fmt::format("{}=: {}", item.name, known->note));
    if (known != nullptr && known->use != NameUse::kZeroOnly) return Named(item.name, known);
    if (!number) {
      return Refuse(fmt::format("{}={}: not a number; assignments and parameters are not supported",
                                item.name, item.text.substr(0, 40)));
    }
    if (known != nullptr) {
      if (*number != 0.0) return Refuse(fmt::format("{}={:g}: {}", item.name, *number, known->note));
      if (item.name.size() == 1) rotary_ = true;
      return Named(item.name, known);
    }
    if (IsAxis(item.name) || IsCenter(item.name)) return Coordinate(item, *number);
    if (!item.enclosing.empty())
      return Refuse(fmt::format("{}={}(): functions are not supported", item.name, item.enclosing));
    return Address(item.name, *number);
  }

  absl::Status Coordinate(const SiemensItem& item, double number) {
    const char letter = item.name.front();
    const bool absolute = item.enclosing == "AC", incremental = item.enclosing == "IC";
    if (!item.enclosing.empty() && !absolute && !incremental)
      return Refuse(fmt::format("{}={}(): AC and IC are read", letter, item.enclosing));
    if (IsAxis(item.name)) {
      if (absolute || incremental)
        axis_mode_[static_cast<std::size_t>(letter - 'X')] =
            absolute ? AxisMode::kAbsolute : AxisMode::kIncremental;
    } else {
      ++(absolute ? absolute_centers_ : relative_centers_);
    }
    Push(letter, number);
    return absl::OkStatus();
  }

  absl::Status Address(std::string_view name, double number) {
    if (name == "CR") {
      Push('R', number);
    } else if (name == "TURN") {
      if (!(number >= 0.0 && number <= 999.0) || number != std::floor(number))
        return Refuse(fmt::format("TURN={:g}; it must be a whole number from 0 to 999", number));
      turns_ = number + 1.0;
    } else if (name == "ADIS" || name == "ADISPOS") {
      if (!(number >= 0.0)) return Refuse(fmt::format("{}={:g} is negative", name, number));
      blending_ = std::max(blending_.value_or(0.0), number);
    } else if (name == "D") {
      return Edge(number);
    } else if (name == "S" || name == "S1" || name == "F" || name == "M" || name == "M1") {
      Push(name.front(), number);
    } else if (name == "X1" || name == "Y1" || name == "Z1") {
      Push(name.front(), number);
      machine_axes_ = true;
    } else if (name == "FP") {
      fixed_point_ = true;
    } else {
      return Refuse(
          fmt::format("{}= is not supported: assignments and parameters are not read", name.substr(0, 40)));
    }
    return absl::OkStatus();
  }

  absl::Status Tool(const SiemensItem& item) {
    const std::optional<double> number = item.quoted ? std::nullopt : SiemensNumber(item.text);
    if (number) {
      Push('T', *number);
      return absl::OkStatus();
    }
    if (!item.quoted)
      return Refuse(fmt::format("T={}: a name of a tool stands in quotes", item.text.substr(0, 40)));
    tool_name_ = item.text.substr(0, 40);
    return absl::OkStatus();
  }

  // TRANS, ROT, SCALE and MIRROR: alone they reset.
  absl::StatusOr<std::optional<BlockModes>> Frame(const SiemensLine& line) {
    const std::string_view name = line.items.front().name;
    const bool sizes = name == "SCALE" || name == "ASCALE", mirrors = name == "MIRROR" || name == "AMIRROR";
    for (std::size_t k = 1; k < line.items.size(); ++k) {
      const SiemensItem& item = line.items[k];
      const bool value = item.kind == SiemensItem::Kind::kWord || item.kind == SiemensItem::Kind::kAssign;
      const std::optional<double> number =
          item.kind == SiemensItem::Kind::kWord ? item.number : SiemensNumber(item.text);
      if (value && !mirrors && number == (sizes ? 1.0 : 0.0)) continue;
      return Refuse(
          fmt::format("{} with {}: it shifts, turns, scales or mirrors the program; post the program in "
                      "the frame of the part",
                      name, item.name.substr(0, 40)));
    }
    BlockModes modes;
    modes.deletable = line.deletable;
    modes.without_effect = {std::string(name)};
    return modes;
  }

  absl::StatusOr<std::optional<BlockModes>> Finish() {
    if (limits_) return Limits();
    if (reference_) std::erase_if(words_.words, [](const GcodeWord& word) { return word.letter == 'F'; });
    PM_ASSIGN_OR_RETURN(BlockModes modes, SortModes(words_, dialect_));
    if (machine_ && reference_) return Refuse("SUPA beside G74 or G75");
    if (machine_axes_ && !reference_ && !machine_) return Refuse("X1=, Y1= or Z1= without G74 or G75");
    if (fixed_point_ && !reference_) return Refuse("FP= without G75");
    if (machine_ || reference_) {
      if (modes.once) return Refuse("SUPA, G74 or G75 beside G4 or G53");
      modes.once = machine_ ? 530 : 280;
    }
    if (reference_) {
      if (!modes['X'] && !modes['Y'] && !modes['Z']) return Refuse("G74 or G75 without X1=, Y1= or Z1=");
      for (const char axis : {'X', 'Y', 'Z'}) {
        auto& value = modes.value[static_cast<std::size_t>(axis - 'A')];
        if (value) value = 0.0;  // whatever it is, the axis goes to its reference point
      }
      modes.axis_mode.fill(AxisMode::kIncremental);
    } else {
      modes.axis_mode = axis_mode_;
    }
    if (absolute_centers_ > 0 && relative_centers_ > 0)
      return Refuse("centre words with AC() beside others without it");
    if (modes['I'] || modes['J'] || modes['K']) modes.arc_distance = absolute_centers_ > 0 ? 901 : 911;
    if (edge_) modes.tool_length = *edge_ == 0 ? 490 : 430;
    if (modes.once == 40) PM_RETURN_IF_ERROR(Dwell(modes));
    if (basic_unit_ != 0) {
      modes.notes.push_back(
          {"UNITS_ASSUMED", fmt::format("under G{} F counts in the basic unit of the control; it is "
                                        "taken as the unit of the coordinates",
                                        basic_unit_)});
    }
    return Extras(std::move(modes));
  }

  absl::StatusOr<std::optional<BlockModes>> Extras(BlockModes modes) {
    modes.rotary = modes.rotary || rotary_;
    modes.merges = merges_;
    if (stops_spindle_ && !modes.spindle) modes.spindle = 50;
    modes.turns = turns_;
    if (blending_ && !rounds_by_distance_) return Refuse("ADIS= or ADISPOS= without G641 in the same line");
    if (blending_.value_or(0.0) > 0.0) modes.blending = blending_;
    modes.tool_name = std::string(tool_name_);
    modes.without_effect.insert(modes.without_effect.end(), without_effect_.begin(), without_effect_.end());
    modes.notes.insert(modes.notes.end(), notes_.begin(), notes_.end());
    return modes;
  }

  // G25 and G26: limits of the work area and of the spindle.
  absl::StatusOr<std::optional<BlockModes>> Limits() const {
    BlockModes modes;
    modes.deletable = words_.deletable;
    modes.without_effect = {"G25 or G26"};
    return modes;
  }

  // G4 F counts seconds, G4 S turns of the spindle.
  static absl::Status Dwell(BlockModes& modes) {
    auto& seconds = modes.value['F' - 'A'];
    auto& turns = modes.value['S' - 'A'];
    if (!seconds && !turns) return Refuse("G4 needs F or S");
    modes.value['P' - 'A'] = seconds ? seconds : turns;
    seconds = turns = std::nullopt;
    return absl::OkStatus();
  }

  void Push(char letter, double number) {
    rounds_by_distance_ = rounds_by_distance_ || (letter == 'G' && number == 641.0);
    words_.words.push_back({letter, number});
  }

  const Dialect& dialect_;
  GcodeBlock words_;
  std::optional<int> edge_;
  bool machine_ = false, reference_ = false, limits_ = false, modal_call_ = false, machine_axes_ = false;
  bool fixed_point_ = false, rotary_ = false, rounds_by_distance_ = false, stops_spindle_ = false;
  int basic_unit_ = 0;  // 70 or 71
  int absolute_centers_ = 0, relative_centers_ = 0;
  std::array<AxisMode, 3> axis_mode_{};
  std::optional<bool> merges_;
  std::optional<double> turns_, blending_;
  std::string_view tool_name_;
  std::vector<std::string> without_effect_;
  std::vector<BlockNote> notes_;
};

}  // namespace

absl::StatusOr<std::optional<BlockModes>> SiemensReader::Read(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(" \t");
  // The name of the program.
  for (const std::string_view name : {"%_N", "%MPF", "%SPF"}) {
    if (begin != text.npos && text.substr(begin, name.size()) == name) return std::nullopt;
  }
  if (const absl::Status split = SplitSiemensLine(text, line_); !split.ok()) {
    // A word before the fault may say more about the line.
    for (const SiemensItem& item : line_.items) {
      const SiemensName* const known =
          item.kind == SiemensItem::Kind::kKeyword ? FindKeyword(item.name) : nullptr;
      if (known != nullptr && known->use == NameUse::kRefused)
        return Refuse(fmt::format("{}: {}", item.name, known->note));
    }
    return split;
  }
  return LineReader(dialect_).Run(line_);
}

}  // namespace patchmill
