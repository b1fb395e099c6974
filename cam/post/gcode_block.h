// Splits one line of RS274-like text into words. Anything that it does not understand is an error; nothing is
// skipped.
#pragma once

#include <string_view>
#include <vector>

#include <absl/status/statusor.h>

namespace patchmill {

struct GcodeWord {
  char letter = 'G';  // upper case
  double number = 0.0;
  bool has_point = true;  // a decimal point, or an expression
};

struct GcodeBlock {
  std::vector<GcodeWord> words;  // in their order, without N
  bool percent = false;          // the line is a single %
  bool program_number = false;   // the line is the name of a program: "O0001", ":1", "<PART>"
  bool deletable = false;        // the line starts with / (block delete)
};

// Accepts comments "( )" and ";", spaces anywhere, lower case, / or /1 to /9 and then N at the start, the
// name of a program alone, and expressions (gcode_expression.h). INVALID_ARGUMENT (without the line number)
// for parameters, O-words, unclosed or nested comments, and any other byte. `block` is overwritten; reuse it
// to save allocations.
absl::Status ParseGcodeLine(std::string_view line, GcodeBlock& block);

}  // namespace patchmill
