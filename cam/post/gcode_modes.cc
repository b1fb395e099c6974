#include "cam/post/gcode_modes.h"

#include <cmath>
#include <string>

#include <fmt/format.h>

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

std::string Unsupported(const GcodeWord& word) {
  const std::string spelling = Spell(word);
  if (spelling == "M97" || spelling == "M98" || spelling == "M99" || spelling == "G65" || spelling == "G66")
    return spelling + ": subprograms are not supported; post the program without them";
  return spelling + " is not supported";
}

}  // namespace

absl::StatusOr<BlockModes> SortModes(const GcodeBlock& block, const Dialect& dialect) {
  BlockModes modes;
  modes.deletable = block.deletable;
  for (const GcodeWord& word : block.words) {
    if (word.letter == 'G' || word.letter == 'M') {
      if (const auto own = dialect.words.find(Spell(word)); own != dialect.words.end()) {
        if (modes.word)
          return absl::InvalidArgumentError(Spell(word) + ": another such word is in the same line");
        modes.word = own->second;
        modes.own_word = own->first;
        continue;
      }
      const double tenfold = word.number * 10.0;
      BlockModes::Code* group = nullptr;
      int code = -1;
      if (tenfold >= 0.0 && tenfold < 1e5 && std::abs(tenfold - std::round(tenfold)) < 1e-6) {
        code = static_cast<int>(std::lround(tenfold));
        group = word.letter == 'G' ? GroupOfG(modes, code) : GroupOfM(modes, code);
      }
      if (group == nullptr) return absl::InvalidArgumentError(Unsupported(word));
      // Many controls have G80 in a group of its own; beside another motion it only ends cycles.
      if (group == &modes.motion && code == 800) modes.ends_cycles = true;
      if (group == &modes.motion && (code == 800 || modes.motion == 800)) {
        if (!modes.motion || code != 800) modes.motion = code;
        continue;
      }
      if (group->has_value()) {
        return absl::InvalidArgumentError(Spell(word) +
                                          ": another word of its modal group is in the same line");
      }
      *group = code;
      continue;
    }
    constexpr std::string_view kKnown = "DFHIJKLPQRSTXYZ";
    const bool of_own = modes.word && word.letter == modes.word->tolerance_letter;
    if (kKnown.find(word.letter) == std::string_view::npos && !of_own) {
      return absl::InvalidArgumentError(Spell(word) + " is not supported");
    }
    auto& value = modes.value[static_cast<std::size_t>(word.letter - 'A')];
    if (value) return absl::InvalidArgumentError(fmt::format("{} is given twice", word.letter));
    value = word.number;
    constexpr std::string_view kCoordinates = "XYZIJKRQ";
    if (dialect.coordinate_point && !word.has_point && word.number != 0.0 && modes.without_point == '\0' &&
        kCoordinates.find(word.letter) != std::string_view::npos)
      modes.without_point = word.letter;
  }
  return modes;
}

}  // namespace patchmill
