#include "cam/post/gcode_block.h"

#include <cctype>
#include <string>

#include <fmt/format.h>

#include "cam/post/gcode_expression.h"
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

// Names of programs: O1000, :1000 on controls that read ISO code, <PART_1>.
bool IsProgramName(std::string_view code) {
  constexpr std::size_t kLongestNumber = 9, kLongestName = 40;  // characters
  if (code.size() < 2) return false;
  if (code.front() == '<') return code.back() == '>' && code.size() <= kLongestName;
  return (code.front() == 'O' || code.front() == ':') && code.size() <= kLongestNumber &&
         code.find_first_not_of("0123456789", 1) == std::string_view::npos;
}

// Why a line is refused that is more than a misspelt word; empty if it is not.
std::string_view ForeignGrammar(std::string_view code) {
  constexpr std::string_view kFlow =
      "program flow and variables are not supported; post the program without them";
  for (const std::string_view word :
       {"GOTO", "IF[", "WHILE[", "THEN", "DO1", "DO2", "END1", "END2", "POPEN", "DPRNT"}) {
    if (code.find(word) != std::string_view::npos) return kFlow;
  }
  if (!code.empty() &&
      (code.front() == '$' || code.front() == '?' || code.front() == '!' || code.front() == '~'))
    return "a command to the controller, such as $H, is no line of a program; send it apart";
  return "";
}

absl::Status ReadWords(std::string_view code, GcodeBlock& block);

}  // namespace

absl::Status ParseGcodeLine(std::string_view line, GcodeBlock& block) {
  block.words.clear();
  block.percent = block.program_number = block.deletable = false;
  static thread_local std::string code;
  PM_RETURN_IF_ERROR(StripLine(line, code));
  if (code == "%") {
    block.percent = true;
    return absl::OkStatus();
  }
  if (IsProgramName(code)) {
    block.program_number = true;
    return absl::OkStatus();
  }
  const absl::Status read = ReadWords(code, block);
  if (read.ok()) return read;
  const std::string_view foreign = ForeignGrammar(code);
  return foreign.empty() ? read : Bad(std::string(foreign));
}

namespace {

absl::Status ReadWords(std::string_view code, GcodeBlock& block) {
  std::size_t at = 0;
  if (!code.empty() && code.front() == '/') {
    block.deletable = true;
    at = code.size() > 1 && code[1] >= '1' && code[1] <= '9' ? 2 : 1;
  }
  const std::size_t begin = at;
  while (at < code.size()) {
    const char letter = code[at];
    if (letter == '/') return Bad("/ within a line");
    if (letter == '#' || letter == '[' || letter == '=') {
      return Bad("assignments and parameters are not supported");
    }
    if (letter == 'O') return Bad("O-words (subroutines and program flow) are not supported");
    if (letter < 'A' || letter > 'Z') return Bad(fmt::format("unexpected {}", Printable(letter)));
    const bool first = at == begin;
    ++at;
    const std::size_t value_at = at;
    const absl::StatusOr<double> value = ReadGcodeValue(code, at);
    if (!value.ok()) return Bad(fmt::format("{}: {}", letter, std::string(value.status().message())));
    const double number = *value;
    if (letter == 'N') {
      if (!first) return Bad("N within a line");
      continue;
    }
    const std::string_view digits = code.substr(value_at, at - value_at);
    block.words.push_back({letter, number, digits.find_first_of(".[") != digits.npos});
  }
  return absl::OkStatus();
}

}  // namespace

}  // namespace patchmill
