#include "cam/post/siemens_line.h"

#include <charconv>
#include <cmath>
#include <optional>

#include <absl/strings/ascii.h>
#include <fmt/format.h>

#include "core/base/status.h"

namespace patchmill {
namespace {

constexpr std::string_view kDigits = "0123456789";

absl::Status LineFault(const std::string& message) { return absl::InvalidArgumentError(message); }

bool IsNameByte(char c) { return absl::ascii_isalnum(static_cast<unsigned char>(c)) || c == '_' || c == '$'; }

bool IsLetter(char c) { return absl::ascii_isalpha(static_cast<unsigned char>(c)); }

// In capitals outside strings, without the comment.
absl::Status CodeOfLine(std::string_view text, std::string& code) {
  code.clear();
  bool quoted = false;
  for (const char c : text) {
    if (c == '"') quoted = !quoted;
    if (c == ';' && !quoted) break;
    const auto byte = static_cast<unsigned char>(c);
    if (!quoted && byte != '\t' && (byte < 0x20 || byte > 0x7e))
      return LineFault(fmt::format("unexpected byte 0x{:02X}", byte));
    code += quoted ? c : c == '\t' ? ' ' : absl::ascii_toupper(byte);
  }
  return quoted ? LineFault("a string without its closing quote") : absl::OkStatus();
}

class Splitter {
 public:
  explicit Splitter(SiemensLine& line) : line_(line), rest_(line.code) {}

  absl::Status Run() {
    Blanks();
    if (Take("/")) {
      line_.deletable = true;
      if (!rest_.empty() && absl::ascii_isdigit(static_cast<unsigned char>(rest_.front())))
        rest_.remove_prefix(1);
    }
    BlockNumber();
    for (Blanks(); !rest_.empty(); Blanks()) PM_RETURN_IF_ERROR(Item());
    return absl::OkStatus();
  }

 private:
  void Blanks() {
    while (!rest_.empty() && rest_.front() == ' ') rest_.remove_prefix(1);
  }
  bool Take(std::string_view mark) {
    if (rest_.substr(0, mark.size()) != mark) return false;
    rest_.remove_prefix(mark.size());
    return true;
  }
  std::string_view TakeWhile(bool (*fits)(char)) {
    std::size_t size = 0;
    while (size < rest_.size() && fits(rest_[size])) ++size;
    const std::string_view taken = rest_.substr(0, size);
    rest_.remove_prefix(size);
    return taken;
  }

  // N10 or :10.
  void BlockNumber() {
    Blanks();
    if (rest_.empty() || (rest_.front() != 'N' && rest_.front() != ':')) return;
    const std::size_t end = std::min(rest_.find_first_not_of(kDigits, 1), rest_.size());
    if (end > 1) rest_.remove_prefix(end);
  }

  absl::Status Item() {
    if (rest_.front() == '"') return LineFault("a string without a name before it");
    if (!IsNameByte(rest_.front()) || absl::ascii_isdigit(static_cast<unsigned char>(rest_.front())))
      return LineFault(fmt::format("unexpected '{}'", rest_.front()));
    const std::string_view at = rest_;
    const bool word = IsLetter(at[0]) && (at.size() == 1 || (!IsLetter(at[1]) && at[1] != '_'));
    return word ? Address() : Name();
  }

  // A letter, then its number: X10, or an extended address: X1=10.
  absl::Status Address() {
    const std::string_view at = rest_;
    rest_.remove_prefix(1);
    const std::string_view digits =
        TakeWhile([](char c) { return absl::ascii_isdigit(static_cast<unsigned char>(c)); });
    const std::string_view after_digits = rest_;
    Blanks();
    if (Take("=")) return Assign(at.substr(0, 1 + digits.size()));
    if (Take("["))
      return LineFault(fmt::format("{}[: variables are not supported", at.substr(0, 1 + digits.size())));
    rest_ = after_digits;
    if (digits.empty()) Blanks();
    const std::string_view number_at = digits.empty() ? rest_ : at.substr(1);
    double number = 0.0;
    const char* begin = number_at.data();
    const char* const end = begin + number_at.size();
    if (begin != end && *begin == '+' && begin + 1 != end && begin[1] != '-') ++begin;
    const auto [stop, error] = std::from_chars(begin, end, number, std::chars_format::fixed);
    if (error != std::errc() || !std::isfinite(number))
      return LineFault(fmt::format("{} without a number", at.substr(0, 1)));
    rest_ = std::string_view(stop, static_cast<std::size_t>(end - stop));
    line_.items.push_back({.kind = SiemensItem::Kind::kWord, .name = at.substr(0, 1), .number = number});
    return absl::OkStatus();
  }

  absl::Status Name() {
    const std::string_view name = TakeWhile(IsNameByte);
    Blanks();
    if (Take("=")) return Assign(name);
    if (Take("(")) return Call(name);
    if (Take("[")) return LineFault(fmt::format("{}[: variables are not supported", name));
    if (Take(":")) return absl::OkStatus();  // a label: jumps to it are refused
    line_.items.push_back({.kind = SiemensItem::Kind::kKeyword, .name = name});
    return absl::OkStatus();
  }

  absl::Status Assign(std::string_view name) {
    SiemensItem item{.kind = SiemensItem::Kind::kAssign, .name = name};
    Blanks();
    if (Take("\"")) {
      item.quoted = true;
      item.text = rest_.substr(0, rest_.find('"'));
      rest_.remove_prefix(item.text.size() + 1);
      line_.items.push_back(item);
      return absl::OkStatus();
    }
    item.text = TakeWhile([](char c) { return c != ' ' && c != '('; });
    if (Take("(")) {
      item.enclosing = item.text;
      item.text = rest_.substr(0, rest_.find(')'));
      if (item.text.size() == rest_.size())
        return LineFault(fmt::format("{}= without its closing bracket", name));
      rest_.remove_prefix(item.text.size() + 1);
    }
    if (item.text.empty()) return LineFault(fmt::format("{}= without a value", name));
    line_.items.push_back(item);
    return absl::OkStatus();
  }

  absl::Status Call(std::string_view name) {
    const std::string_view arguments = rest_;
    bool quoted = false;
    std::size_t end = 0;
    for (int depth = 1; end < arguments.size(); ++end) {
      if (arguments[end] == '"') quoted = !quoted;
      if (quoted) continue;
      if (arguments[end] == '(') ++depth;
      if (arguments[end] == ')' && --depth == 0) break;
    }
    if (end == arguments.size()) return LineFault(fmt::format("{} without its closing bracket", name));
    rest_.remove_prefix(end + 1);
    line_.items.push_back({.kind = SiemensItem::Kind::kCall, .name = name, .text = arguments.substr(0, end)});
    return absl::OkStatus();
  }

  SiemensLine& line_;
  std::string_view rest_;
};

}  // namespace

absl::Status SplitSiemensLine(std::string_view text, SiemensLine& line) {
  line.items.clear();
  line.deletable = false;
  PM_RETURN_IF_ERROR(CodeOfLine(text, line.code));
  return Splitter(line).Run();
}

std::optional<double> SiemensNumber(std::string_view text) {
  while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
  while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
  if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);
  double value = 0.0;
  const auto [end, error] =
      std::from_chars(text.data(), text.data() + text.size(), value, std::chars_format::fixed);
  if (error != std::errc() || end != text.data() + text.size() || text.empty() || !std::isfinite(value))
    return std::nullopt;
  return value;
}

std::vector<std::string_view> SiemensArguments(std::string_view text) {
  std::vector<std::string_view> arguments;
  const auto trim = [](std::string_view one) {
    while (!one.empty() && (one.front() == ' ' || one.front() == '"')) one.remove_prefix(1);
    while (!one.empty() && (one.back() == ' ' || one.back() == '"')) one.remove_suffix(1);
    return one;
  };
  bool quoted = false;
  std::size_t begin = 0;
  for (std::size_t k = 0; k < text.size(); ++k) {
    if (text[k] == '"') quoted = !quoted;
    if (text[k] != ',' || quoted) continue;
    arguments.push_back(trim(text.substr(begin, k - begin)));
    begin = k + 1;
  }
  arguments.push_back(trim(text.substr(begin)));
  if (arguments.size() == 1 && arguments.front().empty()) arguments.clear();
  return arguments;
}

}  // namespace patchmill
