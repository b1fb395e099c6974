// Applies the rule of a word (word_rules.h) to its block.
#pragma once

#include <string>

#include <absl/status/status.h>

#include "cam/post/gcode_modes.h"
#include "cam/post/word_rules.h"

namespace patchmill {

// `block` has all other words and values of the line. The values that the word takes are removed from it.
// INVALID_ARGUMENT (without the line number) where the word is refused.
absl::Status UseWord(const WordRule& rule, const std::string& spelling, BlockModes& block);

}  // namespace patchmill
