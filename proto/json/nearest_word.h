// Finds what somebody may have meant by a word that is not known.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace patchmill {

// The word of the list that takes the fewest changes (a letter more, less, or another one, or two neighbours
// swapped), the first one of equals; empty if each takes more than one change and more than a third of the
// letters of `word`.
std::string NearestWord(std::string_view word, const std::vector<std::string>& known);

}  // namespace patchmill
