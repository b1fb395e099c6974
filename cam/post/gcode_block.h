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
};

struct GcodeBlock {
  std::vector<GcodeWord> words;  // in their order, without N
  bool percent = false;          // the line is a single %
  bool program_number = false;   // the line is a single O word: "O0001"
};

// Accepts comments "( )" and ";", spaces anywhere, lower case, N at the start, and O with a number alone.
// INVALID_ARGUMENT (without
// the line number) for expressions, parameters, O-words, block delete, unclosed or nested comments, and any
// other byte. `block` is overwritten; reuse it to save allocations.
absl::Status ParseGcodeLine(std::string_view line, GcodeBlock& block);

}  // namespace patchmill
