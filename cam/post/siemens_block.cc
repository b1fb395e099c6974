#include "cam/post/siemens_block.h"

#include <charconv>
#include <string>

#include <absl/strings/ascii.h>
#include <fmt/format.h>

#include "core/base/status.h"

namespace patchmill {
namespace {

absl::Status Refuse(const std::string& message) { return absl::InvalidArgumentError(message); }

// Without comment, spaces and line number, in capitals.
std::string CodeOf(std::string_view line) {
  std::string code;
  for (const char c : line.substr(0, line.find(';'))) {
    if (c != ' ' && c != '\t') code += absl::ascii_toupper(static_cast<unsigned char>(c));
  }
  if (!code.empty() && code.front() == 'N') {
    const std::size_t end = code.find_first_not_of("0123456789", 1);
    if (end != 1) code.erase(0, end == std::string::npos ? code.size() : end);
  }
  return code;
}

// CYCLE832(tolerance, kind, version). A tolerance or a kind of 0 leaves the deviation to the machine.
absl::StatusOr<std::optional<BlockModes>> Tolerance(std::string_view arguments) {
  if (arguments.empty() || arguments.back() != ')') return Refuse("CYCLE832 without its closing bracket");
  arguments.remove_suffix(1);
  BlockModes modes;
  modes.word = DialectWord{.tolerance_letter = 'E'};
  if (arguments.empty()) return modes;
  const std::string_view text = arguments.substr(0, arguments.find(','));
  double tolerance = 0.0;
  const auto [end, error] =
      std::from_chars(text.data(), text.data() + text.size(), tolerance, std::chars_format::fixed);
  if (error != std::errc() || end != text.data() + text.size() || !(tolerance >= 0.0))
    return Refuse("CYCLE832: the tolerance is not a number");
  const bool off = arguments.substr(text.size(), 3) == ",0," || arguments.substr(text.size()) == ",0";
  if (tolerance > 0.0 && !off) modes.value['E' - 'A'] = tolerance;
  return modes;
}

}  // namespace

absl::StatusOr<std::optional<BlockModes>> ReadSiemensLine(std::string_view line, const Dialect& dialect) {
  std::string code = CodeOf(line);
  if (code.empty() || code.compare(0, 4, "%_N_") == 0) return std::nullopt;  // the name of the program
  constexpr std::string_view kCycle = "CYCLE832(";
  if (code.compare(0, kCycle.size(), kCycle) == 0)
    return Tolerance(std::string_view(code).substr(kCycle.size()));
  bool machine_place = false;
  if (const std::size_t at = code.find("SUPA"); at != std::string::npos) {
    machine_place = true;
    code.erase(at, 4);
  }
  if (code.find('(') != std::string::npos) return Refuse("calls are not supported");
  GcodeBlock block;
  PM_RETURN_IF_ERROR(ParseGcodeLine(code, block));
  if (block.percent || block.program_number) return Refuse("% or O within a Siemens program");
  std::optional<int> offset;
  std::erase_if(block.words, [&offset](const GcodeWord& word) {
    if (word.letter == 'D' && (word.number == 0.0 || word.number == 1.0))
      offset = static_cast<int>(word.number);
    return word.letter == 'D' && offset;
  });
  for (GcodeWord& word : block.words) {
    if (word.letter != 'G') continue;
    if (word.number == 710.0) word.number = 21.0;
    if (word.number == 700.0) word.number = 20.0;
    if (word.number == 60.0) word.number = 61.0;
  }
  PM_ASSIGN_OR_RETURN(BlockModes modes, SortModes(block, dialect));
  if (machine_place) {
    if (modes.once) return Refuse("SUPA beside G4, G28 or G53");
    modes.once = 530;
  }
  if (offset) modes.tool_length = *offset == 0 ? 490 : 430;
  if (modes.once == 40 && modes['F'] && !modes['P'])
    std::swap(modes.value['F' - 'A'], modes.value['P' - 'A']);
  return modes;
}

}  // namespace patchmill
