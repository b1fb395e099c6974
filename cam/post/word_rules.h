// What G and M words beyond those of RS274 (gcode_modes.h) mean to the reader of programs: a table for each
// control, as data. Other CAM systems write these words; posts of Patchmill need few of them.
//
// Each table names the manual that describes its words. The tables were written without these manuals at
// hand, from general knowledge of the controls. No row has been compared with its page yet.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace patchmill {

// The control whose words a dialect has, beside those of its own.
enum class WordFamily { kNone, kLinuxCnc, kGrbl, kFanuc, kHaas, kMach3, kSiemens, kHeidenhain };

enum class WordUse {
  kIgnored,       // moves nothing, and the path stays as it is
  kOfBuilder,     // the same, as builders of machines commonly use it: an assumption
  kStopsSpindle,  // stops or turns the spindle to an angle, and moves nothing else
  kZeroOnly,      // does nothing while all values that it takes are zero; else it is refused
  kBlends,        // a path mode: no word says how far the control leaves the path
  kMerges,        // the same beside any path mode, where its first value is above `limit`; else it ends that
  kFineStop,      // exact stops wait until the axes have arrived
  kCoarseStop,    // exact stops do not wait that long: no word says how far the control leaves the path
  kTolerance,     // its first value limits how far the control leaves the path
  kOffset,        // a work offset
  kOffsetByNumber,  // a work offset that P numbers, 1 to `limit`
  kNoOffset,        // no work offset is in force
  kToolPoint,       // a length offset as G43, with rotary axes that are not judged
  kAs,              // the word of RS274 whose code is `as`
  kRefused  // shifts, turns or scales the program, moves by itself, calls, or is no word of the control
};

struct WordRule {
  char letter = 'G';
  int first = 0;  // ten times the number: G5.1 is 51
  WordUse use = WordUse::kIgnored;
  std::string_view takes = {};  // letters of the same line that belong to the word
  std::string_view note = {};   // of kRefused and kZeroOnly: why it is refused, a sentence without its end
  double limit = 0.0;
  int as = 0;
  int last = 0;  // the rule is for all codes from first to last; 0: for `first` alone
};

// The rule for a word, or nullptr. Words that are refused on all controls have rules in each family.
const WordRule* FindWordRule(WordFamily family, char letter, int code);

std::optional<WordFamily> FamilyOf(std::string_view name);  // "fanuc"

// One table for each family, and one for all of them, which counts after it. Any order.
std::span<const WordRule> WordsOf(WordFamily family);
std::span<const WordRule> CommonWords();
std::span<const WordRule> LinuxCncWords();
std::span<const WordRule> GrblWords();
std::span<const WordRule> FanucWords();
std::span<const WordRule> HaasWords();
std::span<const WordRule> Mach3Words();
std::span<const WordRule> SiemensWords();
std::span<const WordRule> HeidenhainWords();

}  // namespace patchmill
