#include "core/io/text_scanner.h"

#include <charconv>
#include <cmath>
#include <system_error>

#include <fmt/format.h>

#include "core/base/error_details.h"
#include "core/base/status.h"
#include "core/network/patch_model.h"

namespace patchmill {
namespace {

bool IsSpace(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r' || c == '\f' || c == '\v'; }

// from_chars accepts no leading plus, but accepts "inf" and "nan". Numbers here start with a digit or a
// point.
std::string_view WithoutPlus(std::string_view word) {
  if (word.size() > 1 && word[0] == '+' && word[1] != '-') word.remove_prefix(1);
  return word;
}
bool StartsLikeANumber(std::string_view word) {
  if (!word.empty() && word[0] == '-') word.remove_prefix(1);
  return !word.empty() && ((word[0] >= '0' && word[0] <= '9') || word[0] == '.');
}

}  // namespace

std::string Quoted(std::string_view word) {
  constexpr std::size_t kLongest = 24;
  std::string out = "\"";
  for (const char c : word.substr(0, kLongest)) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte >= 0x20 && byte < 0x7f) {
      out += c;
    } else {
      out += fmt::format("\\x{:02x}", byte);
    }
  }
  out += word.size() > kLongest ? "...\"" : "\"";
  return out;
}

TextScanner::TextScanner(std::string_view text, char comment) : text_(text), comment_(comment) {
  if (text_.substr(0, 3) == "\xef\xbb\xbf") text_.remove_prefix(3);
}

absl::Status TextScanner::Fail(std::string_view reason) const {
  return absl::InvalidArgumentError(fmt::format("line {}: {}", line_, reason));
}

absl::Status TextScanner::Fail(std::string_view code, std::string_view reason) const {
  return CodedError(code, fmt::format("line {}: {}: {}", line_, code, reason));
}

bool TextScanner::EndsWord(char c) const { return IsSpace(c) || (comment_ != 0 && c == comment_); }

void TextScanner::SkipSpace() {
  while (at_ < text_.size() && EndsWord(text_[at_])) {
    if (!IsSpace(text_[at_])) {
      SkipLine();
      continue;
    }
    if (text_[at_] == '\n') ++line_;
    ++at_;
  }
}

bool TextScanner::AtEnd() {
  SkipSpace();
  return at_ == text_.size();
}

std::string_view TextScanner::Peek() {
  SkipSpace();
  std::size_t end = at_;
  while (end < text_.size() && !EndsWord(text_[end])) ++end;
  return text_.substr(at_, end - at_);
}

void TextScanner::SkipLine() {
  while (at_ < text_.size() && text_[at_] != '\n') ++at_;
}

absl::StatusOr<std::string_view> TextScanner::Word(std::string_view what) {
  const std::string_view word = Peek();
  if (word.empty()) return Fail(fmt::format("the text ends where {} is expected", what));
  at_ += word.size();
  return word;
}

absl::StatusOr<double> ParseNumber(std::string_view word, std::string_view what) {
  const std::string_view digits = WithoutPlus(word);
  double value = 0.0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  const bool whole = end == digits.data() + digits.size();
  const auto fail = [](const std::string& reason) { return absl::InvalidArgumentError(reason); };
  if (error == std::errc::result_out_of_range && whole && StartsLikeANumber(digits)) {
    return fail(fmt::format("{} for {} is out of the range of doubles", Quoted(word), what));
  }
  if (error != std::errc() || !whole || !StartsLikeANumber(digits)) {
    return fail(fmt::format("{} is not a number; {} is expected", Quoted(word), what));
  }
  if (!(std::abs(value) <= kMaxCoordinate)) {
    return fail(
        fmt::format("{} = {:g}; must be in [{:g}, {:g}]", what, value, -kMaxCoordinate, kMaxCoordinate));
  }
  return value;
}

absl::StatusOr<double> TextScanner::Number(std::string_view what) {
  PM_ASSIGN_OR_RETURN(const std::string_view word, Word(what));
  const absl::StatusOr<double> value = ParseNumber(word, what);
  if (!value.ok()) return Fail(std::string(value.status().message()));
  return *value;
}

absl::StatusOr<int> TextScanner::Integer(std::string_view what, int min, int max) {
  PM_ASSIGN_OR_RETURN(const std::string_view word, Word(what));
  const std::string_view digits = WithoutPlus(word);
  long long value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  const bool whole = end == digits.data() + digits.size();
  if (!whole || (error != std::errc() && error != std::errc::result_out_of_range)) {
    return Fail(fmt::format("{} is not a whole number; {} is expected", Quoted(word), what));
  }
  if (error == std::errc::result_out_of_range || value < min || value > max) {
    return Fail(fmt::format("{} = {}; must be in [{}, {}]", what, Quoted(word), min, max));
  }
  return static_cast<int>(value);
}

absl::StatusOr<Vec3> TextScanner::Point() {
  PM_ASSIGN_OR_RETURN(const double x, Number("x of a point"));
  PM_ASSIGN_OR_RETURN(const double y, Number("y of a point"));
  PM_ASSIGN_OR_RETURN(const double z, Number("z of a point"));
  return Vec3(x, y, z);
}

absl::Status TextScanner::ExpectEnd() {
  if (AtEnd()) return absl::OkStatus();
  return Fail(fmt::format("surplus text {} after the last patch", Quoted(Peek())));
}

}  // namespace patchmill
