#include "cam/post/number_format.h"

#include <cctype>
#include <cmath>

namespace patchmill {

namespace {

// A comment that starts with a bare word and a comma, or with one of LinuxCNC's lone words, is a command.
bool StartsLikeCommand(std::string_view text) {
  std::size_t i = 0;
  while (i < text.size() && text[i] == ' ') ++i;
  std::string word;
  while (i < text.size() && std::isalpha(static_cast<unsigned char>(text[i]))) {
    word += static_cast<char>(std::tolower(static_cast<unsigned char>(text[i])));
    ++i;
  }
  if (word.empty()) return false;
  if (i < text.size() && text[i] == ',') return true;
  return word == "logclose" || word == "probeclose" || word == "pyreload" || word == "logopen" ||
         word == "probeopen" || word == "logappend";
}

}  // namespace

std::int64_t ToTicks(double value, int decimals) { return std::llround(value * std::pow(10.0, decimals)); }

std::int64_t ToTicks(double mm, const Dialect& dialect, ProgramUnit unit) {
  return ToTicks(mm / kMillimetersPer[unit], dialect.decimals[unit]);
}

std::string FormatTicks(std::int64_t ticks, int decimals) {
  std::string digits = std::to_string(ticks < 0 ? -ticks : ticks);
  if (decimals > 0) {
    const auto places = static_cast<std::size_t>(decimals);
    if (digits.size() <= places) digits.insert(0, places + 1 - digits.size(), '0');
    digits.insert(digits.size() - places, 1, '.');
  }
  if (ticks < 0) digits.insert(0, 1, '-');
  return digits;
}

std::string FormatShort(double value, int decimals) {
  std::string text = FormatTicks(ToTicks(value, decimals), decimals);
  if (decimals > 0) {
    while (text.back() == '0') text.pop_back();
    if (text.back() == '.') text.pop_back();
  }
  return text;
}

std::vector<std::string> CommentLines(const Dialect& dialect, std::string_view text) {
  constexpr std::string_view kMarks = "()";  // inside any comment these become brackets
  std::string safe;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    const std::size_t mark = kMarks.find(c);
    if (byte >= 0x80 && byte < 0xC0) continue;  // a tail byte of UTF-8; each character becomes one '_'
    if (mark != std::string_view::npos) {
      safe += mark % 2 == 0 ? '[' : ']';
    } else if (byte == '\n' || byte == '\r' || byte == '\t') {
      safe += ' ';
    } else if (byte < 0x20 || byte > 0x7e) {
      safe += '_';
    } else if (c == '%') {  // ends the record on Fanuc and Haas, in a comment too
      safe += dialect.upper_case ? "PCT" : "pct";
    } else if (c == '?' || c == '!' || c == '~') {  // GRBL obeys them, wherever they stand
      safe += '.';
    } else {
      safe += dialect.upper_case ? static_cast<char>(std::toupper(byte)) : c;
    }
  }
  const std::size_t room =
      dialect.max_comment_length - dialect.comment_open.size() - dialect.comment_close.size() - 2;
  std::vector<std::string> lines;
  std::string_view rest = safe;
  do {
    std::size_t length = rest.size();
    if (length > room) {
      length = rest.rfind(' ', room);
      if (length == std::string_view::npos || length == 0) length = room;
    }
    const std::string_view part = rest.substr(0, length);
    rest.remove_prefix(length);
    while (!rest.empty() && rest.front() == ' ') rest.remove_prefix(1);
    lines.push_back(dialect.comment_open + (StartsLikeCommand(part) ? "- " : "") + std::string(part) +
                    dialect.comment_close);
  } while (!rest.empty());
  return lines;
}

}  // namespace patchmill
