// Described in: ArtSoft "Using Mach3Mill", chapter 10 (Mach 3 G- and M-code language reference);
// NewFangled Solutions "Mach4 Mill G-Code Reference".
#include "cam/post/word_rules.h"

namespace patchmill {

std::span<const WordRule> Mach3Words() {
  using enum WordUse;
  constexpr std::string_view kShift = "a shift of the coordinates by other values than zero is not read";
  constexpr std::string_view kRepeat = "it runs the program again from its first line";
  static constexpr WordRule kWords[] = {
      {.first = 80, .use = kIgnored},
      {.first = 90, .use = kIgnored},
      {.first = 150, .use = kIgnored},
      {.first = 500, .use = kIgnored},
      {.first = 520, .use = kZeroOnly, .takes = "XYZ", .note = kShift},
      {.first = 541, .use = kOffsetByNumber, .takes = "P", .limit = 248.0},
      // Exact stop is G61 alone.
      {.first = 611, .use = kBlends},
      {.first = 690, .use = kIgnored},
      {.first = 921, .use = kIgnored, .last = 922},
      {.first = 970, .use = kIgnored},
      {.letter = 'M', .first = 190, .use = kStopsSpindle},
      {.letter = 'M', .first = 470, .use = kRefused, .note = kRepeat},
      {.letter = 'M', .first = 480, .use = kIgnored, .last = 490},
  };
  return kWords;
}

}  // namespace patchmill
