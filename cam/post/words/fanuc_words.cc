// Described in: FANUC Series 30i/31i/32i-MODEL B, operator's manuals B-64484EN (common) and B-64484EN-2
// (machining centers), chapter "Preparatory function"; AI contour control: the same, "High-speed cutting
// functions".
#include "cam/post/word_rules.h"

namespace patchmill {

std::span<const WordRule> FanucWords() {
  using enum WordUse;
  constexpr std::string_view kShift = "a shift of the coordinates by other values than zero is not read";
  constexpr std::string_view kCenter =
      "it is no word of Fanuc, whose I, J and K always count from the start of the arc; post for fanuc";
  constexpr std::string_view kDirection = "normal direction control turns a rotary axis";
  constexpr std::string_view kMoves = "it moves by a way that the program does not say";
  constexpr std::string_view kCylinder = "cylindrical and polar coordinate interpolation are not read";
  constexpr std::string_view kCompensation = "compensation of the tool's position is not read";
  constexpr std::string_view kHaas =
      "it is a word of Haas; Fanuc has no word that limits how far it leaves the path";
  constexpr std::string_view kPlane = "it works in a tilted plane, or turns rotary axes into it";
  constexpr std::string_view kFixture = "compensation of the workpiece's place other than P0 is not read";
  constexpr std::string_view kTap = "tapping is not read";
  constexpr std::string_view kPallet = "it changes the pallet: another part may lie there";
  static constexpr WordRule kWords[] = {
      {.first = 50, .use = kMerges, .takes = "P"},
      // AI contour control Q1 looks ahead; Q2 and Q3 smooth the path.
      {.first = 51, .use = kMerges, .takes = "QPR", .limit = 1.0},
      {.first = 54, .use = kIgnored, .takes = "Q"},
      {.first = 71, .use = kRefused, .note = kCylinder},
      {.first = 80, .use = kIgnored, .takes = "P"},
      {.first = 90, .use = kIgnored},
      {.first = 110, .use = kIgnored},
      {.first = 121, .use = kRefused, .note = kCylinder},
      {.first = 131, .use = kIgnored},
      {.first = 150, .use = kIgnored},
      {.first = 230, .use = kIgnored},
      {.first = 250, .use = kIgnored},
      {.first = 270, .use = kRefused, .note = kMoves},
      {.first = 290, .use = kRefused, .note = kMoves},
      {.first = 401, .use = kIgnored},
      {.first = 411, .use = kRefused, .note = kDirection},
      {.first = 421, .use = kRefused, .note = kDirection},
      {.first = 434, .use = kToolPoint, .last = 435},
      {.first = 450, .use = kRefused, .note = kCompensation, .last = 480},
      {.first = 491, .use = kIgnored},
      {.first = 500, .use = kIgnored},
      {.first = 501, .use = kIgnored, .takes = "XYZ"},
      {.first = 520, .use = kZeroOnly, .takes = "XYZ", .note = kShift},
      {.first = 531, .use = kRefused, .note = kPlane},
      {.first = 541, .use = kOffsetByNumber, .takes = "P", .limit = 300.0},
      {.first = 542, .use = kZeroOnly, .takes = "P", .note = kFixture},
      {.first = 544, .use = kZeroOnly, .takes = "P", .note = kFixture},
      {.first = 600, .use = kRefused, .note = kMoves},
      // Exact stop is G61. G61.1 is a path mode of other makers, and of machines that copy them.
      {.first = 611, .use = kBlends},
      {.first = 620, .use = kBlends},
      {.first = 630, .use = kRefused, .note = kTap},
      {.first = 670, .use = kIgnored},
      {.first = 690, .use = kIgnored, .last = 691},
      {.first = 901, .use = kRefused, .note = kCenter},
      {.first = 911, .use = kIgnored},
      {.first = 921, .use = kZeroOnly, .takes = "XYZ", .note = kShift},
      {.first = 970, .use = kIgnored},
      {.first = 1870, .use = kRefused, .note = kHaas},
      {.letter = 'M', .first = 100, .use = kOfBuilder, .last = 110},
      {.letter = 'M', .first = 190, .use = kStopsSpindle},
      {.letter = 'M', .first = 290, .use = kRefused, .note = kTap},
      {.letter = 'M', .first = 480, .use = kIgnored, .last = 490},
      {.letter = 'M', .first = 500, .use = kOfBuilder, .last = 510},
      {.letter = 'M', .first = 600, .use = kRefused, .note = kPallet},
      {.letter = 'M', .first = 680, .use = kOfBuilder, .last = 690},
      {.letter = 'M', .first = 780, .use = kOfBuilder, .last = 790},
      {.letter = 'M', .first = 880, .use = kOfBuilder, .last = 890},
  };
  return kWords;
}

}  // namespace patchmill
