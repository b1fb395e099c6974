#include "cam/post/gcode_block.h"

#include <cctype>
#include <charconv>
#include <cmath>
#include <string>

#include <fmt/format.h>

#include "core/base/status.h"

namespace patchmill {

namespace {

absl::Status Bad(const std::string& message) { return absl::InvalidArgumentError(message); }

std::string Printable(char c) {
  const auto byte = static_cast<unsigned char>(c);
  return byte >= 0x20 && byte < 0x7f ? fmt::format("'{}'", c) : fmt::format("byte 0x{:02X}", byte);
}

// The code of a line: comments, spaces and tabs removed, letters in upper case.
absl::Status StripLine(std::string_view line, std::string& code) {
  code.clear();
  for (std::size_t i = 0; i < line.size(); ++i) {
    const char c = line[i];
    if (c == ' ' || c == '\t') continue;
    if (c == ';') break;
    if (c == '(') {
      const std::size_t end = line.find_first_of("()", i + 1);
      if (end == std::string_view::npos) return Bad("unclosed comment");
      if (line[end] == '(') return Bad("comment within a comment");
      i = end;
      continue;
    }
    code += static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  }
  return absl::OkStatus();
}

// Reads [+-] digits [. digits] with at least one digit. There is no exponent in RS274.
absl::StatusOr<double> ParseNumber(char letter, std::string_view code, std::size_t& at) {
  const std::size_t begin = at;
  if (at < code.size() && (code[at] == '+' || code[at] == '-')) ++at;
  bool digits = false, point = false;
  for (; at < code.size(); ++at) {
    if (std::isdigit(static_cast<unsigned char>(code[at]))) {
      digits = true;
    } else if (code[at] == '.' && !point) {
      point = true;
    } else {
      break;
    }
  }
  if (!digits) {
    if (at < code.size() && (code[at] == '[' || code[at] == '#')) {
      return Bad(fmt::format("{}: expressions and parameters are not supported", letter));
    }
    return Bad(fmt::format("{} without a number", letter));
  }
  std::string_view text = code.substr(begin, at - begin);
  if (text.front() == '+') text.remove_prefix(1);
  double value = 0.0;
  const auto [end, error] =
      std::from_chars(text.data(), text.data() + text.size(), value, std::chars_format::fixed);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) {
    return Bad(fmt::format("{}{}: not a number in range", letter, text.substr(0, 40)));
  }
  return value;
}

}  // namespace

absl::Status ParseGcodeLine(std::string_view line, GcodeBlock& block) {
  block.words.clear();
  block.percent = block.program_number = false;
  static thread_local std::string code;
  PM_RETURN_IF_ERROR(StripLine(line, code));
  if (code == "%") {
    block.percent = true;
    return absl::OkStatus();
  }
  if (code.size() >= 2 && code.size() <= 9 && code.front() == 'O' &&
      code.find_first_not_of("0123456789", 1) == std::string::npos) {
    block.program_number = true;
    return absl::OkStatus();
  }
  std::size_t at = 0;
  while (at < code.size()) {
    const char letter = code[at];
    if (letter == '/') return Bad("block delete is not supported: it cannot be known whether the line runs");
    if (letter == '#' || letter == '[' || letter == '=') {
      return Bad("expressions and parameters are not supported");
    }
    if (letter == 'O') return Bad("O-words (subroutines and program flow) are not supported");
    if (letter < 'A' || letter > 'Z') return Bad(fmt::format("unexpected {}", Printable(letter)));
    const bool first = at == 0;
    ++at;
    PM_ASSIGN_OR_RETURN(const double number, ParseNumber(letter, code, at));
    if (letter == 'N') {
      if (!first) return Bad("N within a line");
      continue;
    }
    block.words.push_back({letter, number});
  }
  return absl::OkStatus();
}

}  // namespace patchmill
