// Words and numbers of a text, with the line they stand on. Shared by all readers of model text.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include <absl/status/status.h>
#include <absl/status/statusor.h>

#include "core/base/vec.h"

namespace patchmill {

// Words are separated by blanks, tabs and line ends (LF, CRLF and CR LF mixed). A byte order mark at the
// start is skipped. Numbers are decimal in the C form, strict and independent of any locale: 1e400, nan, inf,
// hexadecimal numbers and a decimal comma are refused. If `comment` is not 0, this character and the rest of
// its line count as blank. Every error is INVALID_ARGUMENT "line 12: reason".
class TextScanner {
 public:
  explicit TextScanner(std::string_view text, char comment = 0);

  // True if no word is left.
  bool AtEnd();
  // Returns the next word without taking it. Empty at the end.
  std::string_view Peek();
  absl::StatusOr<std::string_view> Word(std::string_view what);
  // A finite number with |x| <= kMaxCoordinate.
  absl::StatusOr<double> Number(std::string_view what);
  absl::StatusOr<int> Integer(std::string_view what, int min, int max);
  absl::StatusOr<Vec3> Point();
  // Skips the rest of the line of the word that was taken last.
  void SkipLine();
  // OK if only white space and comments are left.
  absl::Status ExpectEnd();

  // Bytes that are not yet read. At most remaining() / 2 more numbers can follow, whatever a count in the
  // text says.
  std::size_t remaining() const { return text_.size() - at_; }
  // The line, 1-based: that of the next word after Peek or AtEnd, else that of the word that was taken last.
  int line() const { return line_; }
  // "line <line>: <reason>".
  absl::Status Fail(std::string_view reason) const;
  // "line <line>: <code>: <reason>", a CodedError.
  absl::Status Fail(std::string_view code, std::string_view reason) const;

 private:
  void SkipSpace();
  bool EndsWord(char c) const;

  std::string_view text_;
  std::size_t at_ = 0;
  int line_ = 1;
  char comment_ = 0;
};

// Reads one word as TextScanner::Number does. The message names `what`, but no line.
absl::StatusOr<double> ParseNumber(std::string_view word, std::string_view what);

// Returns `word` in a form fit for a message: quoted, control bytes as \xNN, cut after 24 bytes.
std::string Quoted(std::string_view word);

}  // namespace patchmill
