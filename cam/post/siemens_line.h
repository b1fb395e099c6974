// Splits one line of a Siemens program into its items. What they mean is the concern of siemens_block.h.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <absl/status/statusor.h>

namespace patchmill {

// One item. Names are in capitals.
struct SiemensItem {
  enum class Kind {
    kWord,     // X10.5: name "X", number
    kAssign,   // X=10.5, CR=5, T="BALL_6", X=IC(5): name, text
    kKeyword,  // SUPA, TRANS: name
    kCall,     // MSG("..."): name, arguments
  };
  Kind kind = Kind::kKeyword;
  std::string_view name = {};
  double number = 0.0;         // of a word
  std::string_view text = {};  // right of the equals sign, without quotes; or between the brackets of a call
  bool quoted = false;         // the text was a string
  std::string_view enclosing = {};  // of kAssign: the function around the text, "IC" of X=IC(5)
};

struct SiemensLine {
  std::string code;  // the items point into it; a line must not be copied
  std::vector<SiemensItem> items;
  bool deletable = false;  // starts with / or /0 to /9
};

// Without comment, block number (N10 and :10) and label. INVALID_ARGUMENT (without the line number) for what
// is no item. `line` is overwritten; reuse it to save allocations.
absl::Status SplitSiemensLine(std::string_view text, SiemensLine& line);

// [+-] digits [. digits], all of the text.
std::optional<double> SiemensNumber(std::string_view text);

// The arguments of a call, without blanks and quotes: "0.01,_FINISH,1".
std::vector<std::string_view> SiemensArguments(std::string_view text);

}  // namespace patchmill
