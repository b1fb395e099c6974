// Described in: SINUMERIK 840D sl / 828D, programming manuals "Fundamentals" (G groups in its appendix)
// and "Job planning".
#include "cam/post/word_rules.h"

namespace patchmill {

std::span<const WordRule> SiemensWords() {
  using enum WordUse;
  constexpr std::string_view kIso =
      "it is a word of ISO dialects (G291), and no word of Siemens' own language";
  constexpr std::string_view kShift = "it shifts the program by an offset that the verdict would not know";
  constexpr std::string_view kPole = "polar coordinates are not read; post the program with X, Y and Z";
  constexpr std::string_view kTap = "tapping and thread cutting are not read";
  constexpr std::string_view kSoft =
      "soft approach and retraction move by a way that the program does not say";
  constexpr std::string_view kBuilder = "what it does is up to the builder of the machine";
  constexpr std::string_view kFeed = "feeds of this kind are not read; use G94";
  constexpr std::string_view kSpeed = "the speed of the spindle depends on the place; use G97 and S";
  constexpr std::string_view kCurve = "splines are not read; post the program with straight moves and arcs";
  static constexpr WordRule kWords[] = {
      {.first = 50, .use = kRefused, .note = kFeed},
      {.first = 70, .use = kRefused, .note = kFeed},
      {.first = 62, .use = kRefused, .note = kCurve},
      {.first = 90, .use = kIgnored},
      {.first = 200, .use = kRefused, .note = kIso, .last = 210},
      {.first = 280, .use = kRefused, .note = kIso},
      {.first = 300, .use = kRefused, .note = kIso},
      {.first = 330, .use = kRefused, .note = kTap, .last = 350},
      {.first = 411, .use = kRefused, .note = kIso},
      {.first = 421, .use = kRefused, .note = kIso},
      {.first = 430, .use = kRefused, .note = kIso},
      {.first = 490, .use = kRefused, .note = kIso},
      {.first = 580, .use = kRefused, .note = kShift, .last = 590},
      {.first = 600, .use = kAs, .as = 610},
      {.first = 610, .use = kRefused, .note = kIso, .last = 611},
      {.first = 620, .use = kBlends},
      {.first = 630, .use = kRefused, .note = kTap},
      {.first = 700, .use = kAs, .as = 200},
      {.first = 710, .use = kAs, .as = 210},
      {.first = 901, .use = kRefused, .note = kIso},
      {.first = 911, .use = kRefused, .note = kIso},
      {.first = 960, .use = kRefused, .note = kSpeed},
      {.first = 970, .use = kIgnored},
      {.first = 980, .use = kRefused, .note = kIso, .last = 990},
      {.first = 1100, .use = kRefused, .note = kPole, .last = 1120},
      {.first = 1400, .use = kRefused, .note = kSoft, .last = 1490},
      {.first = 2470, .use = kRefused, .note = kSoft, .last = 2480},
      {.first = 2900, .use = kIgnored},
      {.first = 2910, .use = kRefused, .note = kIso},
      {.first = 3310, .use = kRefused, .note = kTap, .last = 3350},
      {.first = 3400, .use = kRefused, .note = kSoft, .last = 3480},
      {.first = 4500, .use = kIgnored, .last = 4510},
      {.first = 4600, .use = kIgnored, .last = 4620},
      {.first = 5000, .use = kNoOffset},
      {.first = 5050, .use = kOffset, .last = 5990},
      {.first = 6010, .use = kFineStop},
      {.first = 6020, .use = kCoarseStop, .last = 6030},
      {.first = 6210, .use = kBlends},
      {.first = 6410, .use = kBlends, .last = 6450},
      {.first = 7000, .use = kAs, .as = 200},
      {.first = 7100, .use = kAs, .as = 210},
      {.first = 8100, .use = kRefused, .note = kBuilder, .last = 8290},
      {.first = 9310, .use = kRefused, .note = kFeed},
      {.first = 9420, .use = kRefused, .note = kFeed},
      {.first = 9520, .use = kRefused, .note = kFeed},
      {.first = 9610, .use = kRefused, .note = kSpeed, .last = 9620},
      {.first = 9710, .use = kIgnored, .last = 9730},
      {.letter = 'M', .first = 100, .use = kOfBuilder, .last = 110},
      {.letter = 'M', .first = 170, .use = kAs, .as = 20},
      {.letter = 'M', .first = 190, .use = kStopsSpindle},
      {.letter = 'M', .first = 400, .use = kIgnored, .last = 450},
      {.letter = 'M', .first = 500, .use = kOfBuilder, .last = 530},
      {.letter = 'M', .first = 700, .use = kStopsSpindle},
      {.letter = 'M', .first = 880, .use = kOfBuilder, .last = 890},
  };
  return kWords;
}

}  // namespace patchmill
