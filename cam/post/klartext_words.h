// Splits lines of Heidenhain's conversational programs into words.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace patchmill {

// The words of a line without its number and its comment, in capitals. Text in quotes is one word that keeps
// its quotes, its blanks and its letters. "F MAX" and "F AUTO" are one word.
std::vector<std::string> KlartextWords(std::string_view line);

// Whether the line goes on in the next one: it ends with ~.
bool KlartextGoesOn(std::string_view line);

// [+-] digits [. digits], all of the text.
std::optional<double> KlartextNumber(std::string_view text);

// The word as messages show it.
std::string ShownWord(std::string_view word);

}  // namespace patchmill
