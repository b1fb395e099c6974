#include "cam/post/gcode_modes.h"

#include <cmath>
#include <string>

#include <fmt/format.h>

#include "cam/post/word_rules.h"
#include "cam/post/word_use.h"
#include "core/base/status.h"

namespace patchmill {

namespace {

BlockModes::Code* GroupOfG(BlockModes& modes, int code) {
  switch (code) {
    case 0:
    case 10:
    case 20:
    case 30:
    case 730:
    case 800:
    case 810:
    case 820:
    case 830:
      return &modes.motion;
    case 40:
    case 280:
    case 300:
    case 530:
      return &modes.once;
    case 170:
    case 180:
    case 190:
      return &modes.plane;
    case 200:
    case 210:
      return &modes.units;
    case 400:
    case 410:
    case 411:
    case 420:
    case 421:
      return &modes.compensation;
    case 430:
    case 490:
      return &modes.tool_length;
    case 540:
    case 550:
    case 560:
    case 570:
    case 580:
    case 590:
      return &modes.work_offset;
    case 610:
    case 611:
    case 640:
      return &modes.path;
    case 900:
    case 910:
      return &modes.distance;
    case 901:
    case 911:
      return &modes.arc_distance;
    case 930:
    case 940:
    case 950:
      return &modes.feed_mode;
    case 980:
    case 990:
      return &modes.cycle_end;
    default:
      return nullptr;
  }
}

BlockModes::Code* GroupOfM(BlockModes& modes, int code) {
  switch (code) {
    case 0:
    case 10:
    case 20:
    case 300:
      return &modes.stop;
    case 60:
      return &modes.tool_change;
    case 30:
    case 40:
    case 50:
      return &modes.spindle;
    case 70:
    case 80:
    case 90:
      return &modes.coolant;
    default:
      return nullptr;
  }
}

std::string Spell(const GcodeWord& word) { return fmt::format("{}{:.10g}", word.letter, word.number); }

absl::Status ModesFault(const std::string& message) { return absl::InvalidArgumentError(message); }

std::string Unsupported(const GcodeWord& word, int code) {
  const WordRule* const common = FindWordRule(WordFamily::kNone, word.letter, code);
  if (common != nullptr) return fmt::format("{}: {}", Spell(word), common->note);
  if (word.letter == 'M')
    return Spell(word) + " is not supported; [words] of a post file says what a word of the machine does";
  return Spell(word) + " is not supported";
}

// Ten times the number of a word; -1 if that is no code.
int CodeOf(const GcodeWord& word) {
  const double tenfold = word.number * 10.0;
  const bool code = tenfold >= 0.0 && tenfold < 1e5 && std::abs(tenfold - std::round(tenfold)) < 1e-6;
  return code ? static_cast<int>(std::lround(tenfold)) : -1;
}

// Reads the words of one line, one after the other.
class Sorter {
 public:
  Sorter(const Dialect& dialect, BlockModes& modes) : dialect_(dialect), modes_(modes) {}

  absl::Status Read(const GcodeWord& word) {
    if (word.letter == 'G' || word.letter == 'M') return ReadCode(word);
    if (word.letter >= 'A' && word.letter <= 'C') return ReadRotary(word);
    return ReadValue(word);
  }

  // The rules come last: they take values of the line.
  absl::Status UseRules() {
    for (std::size_t k = 0; k < rules_.size(); ++k) {
      const WordRule& rule = *rules_[k].first;
      for (std::size_t other = 0; other < k && !rule.takes.empty(); ++other) {
        if (!rules_[other].first->takes.empty())
          return ModesFault(rules_[k].second + ": another such word is in the same line");
      }
      PM_RETURN_IF_ERROR(UseWord(rule, rules_[k].second, modes_));
    }
    for (const char letter : unknown_) {
      const bool of_word = modes_.word && letter == modes_.word->tolerance_letter;
      if (modes_[letter] && !of_word)
        return ModesFault(fmt::format("{}{:.10g} is not supported", letter, *modes_[letter]));
    }
    return absl::OkStatus();
  }

 private:
  absl::Status ReadCode(const GcodeWord& word) {
    int code = CodeOf(word);
    const WordRule* rule = code < 0 || dialect_.family == WordFamily::kNone
                               ? nullptr
                               : FindWordRule(dialect_.family, word.letter, code);
    // Of M words the owner of the machine knows best.
    const bool file_first = rule == nullptr || word.letter == 'M';
    if (!dialect_.words.empty() && file_first) {
      if (const auto own = dialect_.words.find(Spell(word)); own != dialect_.words.end()) {
        if (modes_.word) return ModesFault(Spell(word) + ": another such word is in the same line");
        modes_.word = own->second;
        modes_.own_word = own->first;
        return absl::OkStatus();
      }
    }
    if (rule != nullptr && rule->use != WordUse::kAs && rule->use != WordUse::kOffset) {
      rules_.emplace_back(rule, Spell(word));
      return absl::OkStatus();
    }
    BlockModes::Code* group = nullptr;
    if (rule != nullptr && rule->use == WordUse::kOffset) group = &modes_.work_offset;
    if (rule != nullptr && rule->use == WordUse::kAs) code = rule->as;
    if (group == nullptr) group = word.letter == 'G' ? GroupOfG(modes_, code) : GroupOfM(modes_, code);
    if (group == nullptr) return ModesFault(Unsupported(word, code));
    return SetGroup(word, code, *group);
  }

  absl::Status SetGroup(const GcodeWord& word, int code, BlockModes::Code& group) {
    // Many controls have G80 in a group of its own; beside another motion it only ends cycles.
    if (&group == &modes_.motion && code == 800) modes_.ends_cycles = true;
    if (&group == &modes_.motion && (code == 800 || modes_.motion == 800)) {
      if (!modes_.motion || code != 800) modes_.motion = code;
      return absl::OkStatus();
    }
    if (group.has_value()) {
      return ModesFault(Spell(word) + ": another word of its modal group is in the same line");
    }
    group = code;
    return absl::OkStatus();
  }

  absl::Status ReadRotary(const GcodeWord& word) {
    if (word.number != 0.0) {
      return ModesFault(fmt::format(
          "{} turns a rotary axis; programs of three axes are judged, with rotary axes at 0", Spell(word)));
    }
    modes_.rotary = true;
    return absl::OkStatus();
  }

  absl::Status ReadValue(const GcodeWord& word) {
    constexpr std::string_view kKnown = "DFHIJKLPQRSTXYZ";
    const bool of_own = modes_.word && word.letter == modes_.word->tolerance_letter;
    if (kKnown.find(word.letter) == std::string_view::npos && !of_own) unknown_ += word.letter;
    auto& value = modes_.value[static_cast<std::size_t>(word.letter - 'A')];
    if (value) return ModesFault(fmt::format("{} is given twice", word.letter));
    value = word.number;
    constexpr std::string_view kCoordinates = "XYZIJKRQ";
    if (dialect_.coordinate_point && !word.has_point && word.number != 0.0 && modes_.without_point == '\0' &&
        kCoordinates.find(word.letter) != std::string_view::npos)
      modes_.without_point = word.letter;
    return absl::OkStatus();
  }

  const Dialect& dialect_;
  BlockModes& modes_;
  std::vector<std::pair<const WordRule*, std::string>> rules_;
  std::string unknown_;  // letters that only some words take
};

}  // namespace

std::string OffsetName(int work_offset) {
  if (work_offset <= kNumberedOffsets) return fmt::format("G{:g}", work_offset / 10.0);
  if (work_offset >= kPresets) return fmt::format("preset {}", work_offset - kPresets);
  const int numbered = work_offset - kNumberedOffsets;
  return fmt::format("G{:g} P{}", numbered / 1000 / 10.0, numbered % 1000);
}

absl::StatusOr<BlockModes> SortModes(const GcodeBlock& block, const Dialect& dialect) {
  BlockModes modes;
  modes.deletable = block.deletable;
  Sorter sorter(dialect, modes);
  for (const GcodeWord& word : block.words) PM_RETURN_IF_ERROR(sorter.Read(word));
  PM_RETURN_IF_ERROR(sorter.UseRules());
  return modes;
}

}  // namespace patchmill
