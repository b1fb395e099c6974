// One line of RS274-like text as words. Strict: what is not understood is an error, never skipped.
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
  std::vector<GcodeWord> words;  // in order, N left out
  bool percent = false;          // the line is a lone %
};

// Comments "( )" and ";", spaces anywhere, lower case, N at the start. INVALID_ARGUMENT (without the line
// number) for expressions, parameters, O-words, block delete, unclosed or nested comments, any other byte.
// `block` is reused between calls.
absl::Status ParseGcodeLine(std::string_view line, GcodeBlock& block);

}  // namespace patchmill
