// Words and numbers of a text, with the line they stand on. Shared by all readers of model text.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include <absl/status/status.h>
#include <absl/status/statusor.h>

#include "core/base/vec.h"

namespace patchmill {

// Words are separated by blanks, tabs and line ends (LF, CRLF, CR LF mixed); a byte order mark at the start
// is skipped. Numbers are decimal in the C form, strict and independent of any locale: 1e400, nan, inf,
// hexadecimal and a decimal comma are refused. `comment`, when not 0, starts text that counts as blank up to
// the line's end. Every error is INVALID_ARGUMENT "line 12: reason".
class TextScanner {
 public:
  explicit TextScanner(std::string_view text, char comment = 0);

  // No word is left.
  bool AtEnd();
  // The next word without taking it; empty at the end.
  std::string_view Peek();
  absl::StatusOr<std::string_view> Word(std::string_view what);
  // Finite and |x| <= kMaxCoordinate.
  absl::StatusOr<double> Number(std::string_view what);
  absl::StatusOr<int> Integer(std::string_view what, int min, int max);
  absl::StatusOr<Vec3> Point();
  // Skips what is left of the line of the word taken last.
  void SkipLine();
  // OK when nothing but white space is left.
  absl::Status ExpectEnd();

  // Bytes not read yet. Whatever a count in the text claims, no more than remaining() / 2 numbers can follow.
  std::size_t remaining() const { return text_.size() - at_; }
  // 1-based: the line of the next word after Peek or AtEnd, else of the word taken last.
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

// One word as such a number; the message names `what`, but no line.
absl::StatusOr<double> ParseNumber(std::string_view word, std::string_view what);

// `word` fit for a message: quoted, control bytes as \xNN, cut after 24 bytes.
std::string Quoted(std::string_view word);

}  // namespace patchmill
