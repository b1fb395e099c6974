// Described in: HEIDENHAIN TNC 640 and iTNC 530, user's manuals for conversational programming, chapter
// "Miscellaneous functions".
#include "cam/post/word_rules.h"

namespace patchmill {

std::span<const WordRule> HeidenhainWords() {
  using enum WordUse;
  constexpr std::string_view kCall =
      "it calls a cycle at every place; post the program with the moves of the cycle";
  constexpr std::string_view kContour = "it changes the contour by radius compensation, which is not read";
  constexpr std::string_view kFeed =
      "feeds of this kind are not read; state F in every move that needs another";
  constexpr std::string_view kRound = "it rounds the contour by itself";
  constexpr std::string_view kTilt = "it turns the coordinates or corrects them for rotary axes";
  constexpr std::string_view kSpare = "it may change to a spare tool within the program";
  constexpr std::string_view kOff = "it switches off a protection of the machine";
  static constexpr WordRule kWords[] = {
      {.letter = 'M', .first = 190, .use = kStopsSpindle},
      {.letter = 'M', .first = 890, .use = kRefused, .note = kCall},
      {.letter = 'M', .first = 900, .use = kMerges, .limit = -1.0},
      {.letter = 'M', .first = 940, .use = kIgnored},
      {.letter = 'M', .first = 970, .use = kRefused, .note = kContour, .last = 980},
      {.letter = 'M', .first = 990, .use = kRefused, .note = kCall},
      {.letter = 'M', .first = 1010, .use = kRefused, .note = kSpare},
      {.letter = 'M', .first = 1020, .use = kIgnored},
      {.letter = 'M', .first = 1030, .use = kRefused, .note = kFeed},
      {.letter = 'M', .first = 1070, .use = kIgnored, .last = 1080},
      {.letter = 'M', .first = 1090, .use = kIgnored, .last = 1110},
      {.letter = 'M', .first = 1120, .use = kRefused, .note = kRound},
      {.letter = 'M', .first = 1130, .use = kIgnored},
      {.letter = 'M', .first = 1140, .use = kRefused, .note = kTilt},
      {.letter = 'M', .first = 1150, .use = kIgnored},
      {.letter = 'M', .first = 1170, .use = kIgnored},
      {.letter = 'M', .first = 1200, .use = kRefused, .note = kContour},
      {.letter = 'M', .first = 1240, .use = kRefused, .note = kRound},
      {.letter = 'M', .first = 1260, .use = kIgnored, .last = 1270},
      {.letter = 'M', .first = 1280, .use = kToolPoint},
      {.letter = 'M', .first = 1290, .use = kIgnored},
      {.letter = 'M', .first = 1300, .use = kRefused, .note = kTilt},
      {.letter = 'M', .first = 1340, .use = kIgnored, .last = 1350},
      {.letter = 'M', .first = 1360, .use = kRefused, .note = kFeed},
      {.letter = 'M', .first = 1370, .use = kIgnored},
      {.letter = 'M', .first = 1410, .use = kRefused, .note = kOff},
      {.letter = 'M', .first = 1430, .use = kRefused, .note = kTilt, .last = 1440},
      {.letter = 'M', .first = 1450, .use = kIgnored},
      {.letter = 'M', .first = 1480, .use = kIgnored, .last = 1500},
  };
  return kWords;
}

}  // namespace patchmill
