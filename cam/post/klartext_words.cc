#include "cam/post/klartext_words.h"

#include <charconv>
#include <cmath>

#include <absl/strings/ascii.h>

namespace patchmill {

std::vector<std::string> KlartextWords(std::string_view line) {
  std::vector<std::string> words;
  std::string word;
  const auto end = [&] {
    const bool feed = !words.empty() && words.back() == "F" && (word == "MAX" || word == "AUTO");
    if (feed) {
      words.back() += word;
    } else if (!word.empty()) {
      words.push_back(std::move(word));
    }
    word.clear();
  };
  bool quoted = false;
  for (const char c : line) {
    if (c == '"') quoted = !quoted;
    if (!quoted && (c == ';' || c == '~')) break;
    if (!quoted && (c == ' ' || c == '\t')) {
      end();
    } else {
      word += quoted ? c : absl::ascii_toupper(static_cast<unsigned char>(c));
    }
  }
  end();
  if (!words.empty() && words.front().find_first_not_of("0123456789") == std::string::npos)
    words.erase(words.begin());
  return words;
}

bool KlartextGoesOn(std::string_view line) {
  const std::size_t last = line.find_last_not_of(" \t");
  return last != line.npos && line[last] == '~';
}

std::optional<double> KlartextNumber(std::string_view text) {
  if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);
  double value = 0.0;
  const auto [end, error] =
      std::from_chars(text.data(), text.data() + text.size(), value, std::chars_format::fixed);
  if (error != std::errc() || end != text.data() + text.size() || text.empty() || !std::isfinite(value))
    return std::nullopt;
  return value;
}

std::string ShownWord(std::string_view word) {
  std::string shown;
  for (const char c : word.substr(0, 40)) shown += c > ' ' && c <= '~' ? c : '?';
  return shown;
}

}  // namespace patchmill
