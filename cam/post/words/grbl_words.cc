// Described in: GRBL wiki, "Grbl v1.1 Commands" and the list of supported G-codes; the wiki of grblHAL,
// "Supported G-codes".
#include "cam/post/word_rules.h"

namespace patchmill {

std::span<const WordRule> GrblWords() {
  using enum WordUse;
  constexpr std::string_view kShift = "a shift of the coordinates by other values than zero is not read";
  constexpr std::string_view kCenter = "GRBL has G91.1 alone: I, J and K count from the start of the arc";
  constexpr std::string_view kPath = "GRBL has G61 alone";
  constexpr std::string_view kState = "it stores or restores modes; state them";
  static constexpr WordRule kWords[] = {
      {.first = 80, .use = kIgnored},
      {.first = 500, .use = kIgnored},
      {.first = 520, .use = kZeroOnly, .takes = "XYZ", .note = kShift},
      {.first = 591, .use = kOffset, .last = 593},
      {.first = 611, .use = kRefused, .note = kPath},
      {.first = 901, .use = kRefused, .note = kCenter},
      {.first = 921, .use = kIgnored, .last = 922},
      {.first = 970, .use = kIgnored},
      {.letter = 'M', .first = 480, .use = kIgnored, .last = 490},
      {.letter = 'M', .first = 500, .use = kIgnored, .takes = "P", .last = 510},
      {.letter = 'M', .first = 530, .use = kIgnored, .takes = "P"},
      {.letter = 'M', .first = 560, .use = kIgnored, .takes = "P"},
      {.letter = 'M', .first = 620, .use = kIgnored, .takes = "P", .last = 650},
      {.letter = 'M', .first = 700, .use = kRefused, .note = kState, .last = 730},
  };
  return kWords;
}

}  // namespace patchmill
