// Described in: LinuxCNC documentation, "G-Codes" and "M-Codes" (docs/src/gcode).
#include "cam/post/word_rules.h"

namespace patchmill {

std::span<const WordRule> LinuxCncWords() {
  using enum WordUse;
  constexpr std::string_view kShift = "a shift of the coordinates by other values than zero is not read";
  constexpr std::string_view kDiameter = "lathes have it: X counts diameters";
  constexpr std::string_view kState = "it stores or restores modes; state them";
  constexpr std::string_view kOwn = "what it does is up to a program of the machine";
  constexpr std::string_view kTool = "it changes the number of the tool without a tool change";
  constexpr std::string_view kPallet = "it changes the pallet: another part may lie there";
  static constexpr WordRule kWords[] = {
      {.first = 70, .use = kRefused, .note = kDiameter},
      {.first = 80, .use = kIgnored},
      {.first = 520, .use = kZeroOnly, .takes = "XYZ", .note = kShift},
      {.first = 591, .use = kOffset, .last = 593},
      {.first = 921, .use = kIgnored, .last = 922},
      {.first = 970, .use = kIgnored},
      {.letter = 'M', .first = 190, .use = kStopsSpindle, .takes = "RQP"},
      {.letter = 'M', .first = 480, .use = kIgnored, .last = 490},
      {.letter = 'M', .first = 500, .use = kIgnored, .takes = "P", .last = 530},
      {.letter = 'M', .first = 600, .use = kRefused, .note = kPallet},
      {.letter = 'M', .first = 610, .use = kRefused, .note = kTool},
      {.letter = 'M', .first = 620, .use = kIgnored, .takes = "P", .last = 650},
      {.letter = 'M', .first = 660, .use = kIgnored, .takes = "PELQ"},
      {.letter = 'M', .first = 670, .use = kIgnored, .takes = "EQ", .last = 680},
      {.letter = 'M', .first = 700, .use = kRefused, .note = kState, .last = 730},
      {.letter = 'M', .first = 1000, .use = kRefused, .note = kOwn, .last = 1990},
  };
  return kWords;
}

}  // namespace patchmill
