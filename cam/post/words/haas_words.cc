// Described in: Haas "Mill - Operator's Manual" (NGC), chapters "G-codes", "M-codes" and "Settings".
#include "cam/post/word_rules.h"

namespace patchmill {

std::span<const WordRule> HaasWords() {
  using enum WordUse;
  constexpr std::string_view kShift = "a shift of the coordinates by other values than zero is not read";
  constexpr std::string_view kCenter =
      "it is no word of Haas, whose I, J and K always count from the start of the arc; post for haas";
  constexpr std::string_view kPocket = "it mills by itself what the program does not say; post the moves";
  constexpr std::string_view kProbe =
      "a probing move ends where the probe touches, which the program does not say";
  constexpr std::string_view kMoves = "it moves by a way that the program does not say";
  constexpr std::string_view kHoles = "it places holes by itself; post the places of the holes";
  constexpr std::string_view kRotary = "it moves the program with rotary axes";
  constexpr std::string_view kMirror = "it scales or mirrors the program; post the program at its true size";
  constexpr std::string_view kTap = "tapping is not read";
  constexpr std::string_view kPallet = "it changes or tests the pallet: another part may lie there";
  constexpr std::string_view kHand = "it opens or closes the spindle's clamp";
  constexpr std::string_view kFlow = "the order of lines depends on signals; post the program without it";
  constexpr std::string_view kFanuc = "it is a word of Fanuc; Haas has G187 P E and G103 P";
  constexpr std::string_view kCompensation = "compensation in space and of five axes is not read";
  constexpr std::string_view kPath = "it is no word of Haas, whose exact stop is G61";
  static constexpr WordRule kWords[] = {
      {.first = 50, .use = kRefused, .note = kFanuc, .last = 51},
      {.first = 90, .use = kIgnored},
      {.first = 120, .use = kRefused, .note = kPocket, .last = 130},
      {.first = 290, .use = kRefused, .note = kMoves},
      {.first = 350, .use = kRefused, .note = kProbe, .last = 370},
      {.first = 411, .use = kRefused, .note = kCompensation},
      {.first = 421, .use = kRefused, .note = kCompensation},
      {.first = 470, .use = kRefused, .note = kPocket},
      {.first = 500, .use = kIgnored},
      {.first = 520, .use = kZeroOnly, .takes = "XYZ", .note = kShift},
      {.first = 600, .use = kRefused, .note = kMoves},
      {.first = 611, .use = kRefused, .note = kPath},
      {.first = 690, .use = kIgnored},
      {.first = 700, .use = kRefused, .note = kHoles, .last = 720},
      {.first = 770, .use = kRefused, .note = kPocket},
      {.first = 901, .use = kRefused, .note = kCenter},
      {.first = 911, .use = kIgnored},
      {.first = 970, .use = kIgnored},
      {.first = 1000, .use = kIgnored, .takes = "XYZ"},
      {.first = 1010, .use = kRefused, .note = kMirror},
      {.first = 1020, .use = kIgnored},
      {.first = 1030, .use = kIgnored, .takes = "P"},
      {.first = 1070, .use = kRefused, .note = kRotary},
      {.first = 1100, .use = kOffset, .last = 1290},
      {.first = 1360, .use = kRefused, .note = kProbe},
      {.first = 1410, .use = kRefused, .note = kCompensation},
      {.first = 1430, .use = kRefused, .note = kCompensation},
      {.first = 1500, .use = kRefused, .note = kPocket},
      {.first = 1540, .use = kOffsetByNumber, .takes = "P", .limit = 99.0},
      {.first = 1740, .use = kRefused, .note = kTap},
      {.first = 1840, .use = kRefused, .note = kTap},
      {.first = 1870, .use = kTolerance, .takes = "EP"},
      {.first = 1880, .use = kRefused, .note = kFlow},
      {.first = 2340, .use = kToolPoint},
      {.first = 2530, .use = kRefused, .note = kRotary, .last = 2540},
      {.first = 2550, .use = kIgnored},
      {.first = 2680, .use = kRefused, .note = kRotary},
      {.first = 2690, .use = kIgnored},
      {.letter = 'M', .first = 100, .use = kIgnored, .last = 130},
      {.letter = 'M', .first = 190, .use = kStopsSpindle, .takes = "PR"},
      {.letter = 'M', .first = 310, .use = kIgnored},
      {.letter = 'M', .first = 330, .use = kIgnored, .last = 350},
      {.letter = 'M', .first = 360, .use = kRefused, .note = kPallet},
      {.letter = 'M', .first = 410, .use = kIgnored, .last = 420},
      {.letter = 'M', .first = 460, .use = kRefused, .note = kPallet},
      {.letter = 'M', .first = 500, .use = kRefused, .note = kPallet},
      {.letter = 'M', .first = 730, .use = kIgnored, .last = 740},
      {.letter = 'M', .first = 750, .use = kRefused, .note = kProbe},
      {.letter = 'M', .first = 780, .use = kRefused, .note = kProbe, .last = 790},
      {.letter = 'M', .first = 800, .use = kIgnored, .last = 810},
      {.letter = 'M', .first = 820, .use = kRefused, .note = kHand},
      {.letter = 'M', .first = 830, .use = kIgnored, .last = 840},
      {.letter = 'M', .first = 860, .use = kRefused, .note = kHand},
      {.letter = 'M', .first = 880, .use = kIgnored, .last = 890},
      {.letter = 'M', .first = 960, .use = kRefused, .note = kFlow},
      {.letter = 'M', .first = 1300, .use = kIgnored, .last = 1310},
      {.letter = 'M', .first = 1380, .use = kIgnored, .last = 1390},
      {.letter = 'M', .first = 1580, .use = kIgnored, .last = 1590},
  };
  return kWords;
}

}  // namespace patchmill
