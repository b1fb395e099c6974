// Words that no control may have in a program that is judged, with the reason that the error gives.
#include "cam/post/word_rules.h"

namespace patchmill {

std::span<const WordRule> CommonWords() {
  using enum WordUse;
  constexpr std::string_view kCall = "subprograms are not supported; post the program without them";
  constexpr std::string_view kCycle =
      "of the canned cycles G73, G81, G82 and G83 are read; post the program with the moves of this one";
  constexpr std::string_view kProbe =
      "a probing move ends where the probe touches, which the program does not say";
  constexpr std::string_view kTable =
      "it writes offsets or parameters of the control; set them at the control, and post the program without "
      "it";
  constexpr std::string_view kShift = "it shifts the program by an offset that the verdict would not know";
  constexpr std::string_view kTurn = "it turns the program; post the program in the frame of the part";
  constexpr std::string_view kScale = "it scales or mirrors the program; post the program at its true size";
  constexpr std::string_view kPolar = "polar coordinates are not read; post the program with X, Y and Z";
  constexpr std::string_view kCurve = "splines are not read; post the program with straight moves and arcs";
  constexpr std::string_view kThread = "a move that follows the spindle's angle is not read";
  constexpr std::string_view kLength = "the length offset is not that of the tool table; use G43 H";
  constexpr std::string_view kSpeed = "the speed of the spindle depends on the place; use G97 and S";
  constexpr std::string_view kPocket = "it mills by itself what the program does not say; post the moves";
  constexpr std::string_view kStore = "it changes the place to which G28 or G30 goes";
  static constexpr WordRule kWords[] = {
      {.first = 50, .use = kRefused, .note = kCurve, .last = 52},
      {.first = 62, .use = kRefused, .note = kCurve},
      {.first = 100, .use = kRefused, .note = kTable},
      {.first = 120, .use = kRefused, .note = kPocket},
      {.first = 130, .use = kRefused, .note = kPocket},
      {.first = 160, .use = kRefused, .note = kPolar},
      {.first = 281, .use = kRefused, .note = kStore},
      {.first = 301, .use = kRefused, .note = kStore},
      {.first = 310, .use = kRefused, .note = kProbe},
      {.first = 330, .use = kRefused, .note = kThread, .last = 331},
      {.first = 380, .use = kRefused, .note = kProbe, .last = 385},
      {.first = 431, .use = kRefused, .note = kLength, .last = 432},
      {.first = 440, .use = kRefused, .note = kLength},
      {.first = 510, .use = kRefused, .note = kScale, .last = 511},
      {.first = 520, .use = kRefused, .note = kShift},
      {.first = 650, .use = kRefused, .note = kCall, .last = 661},
      {.first = 680, .use = kRefused, .note = kTurn, .last = 684},
      {.first = 740, .use = kRefused, .note = kCycle},
      {.first = 760, .use = kRefused, .note = kCycle},
      {.first = 840, .use = kRefused, .note = kCycle, .last = 890},
      {.first = 920, .use = kRefused, .note = kShift},
      {.first = 923, .use = kRefused, .note = kShift},
      {.first = 960, .use = kRefused, .note = kSpeed},
      {.letter = 'M', .first = 970, .use = kRefused, .note = kCall, .last = 990},
      {.letter = 'M', .first = 1980, .use = kRefused, .note = kCall},
  };
  return kWords;
}

}  // namespace patchmill
