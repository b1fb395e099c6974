// The lines of a program as blocks, in the syntax of its dialect.
#pragma once

#include <optional>
#include <string_view>

#include <absl/status/statusor.h>

#include "cam/post/dialect.h"
#include "cam/post/gcode_modes.h"
#include "cam/post/klartext_block.h"
#include "cam/post/siemens_block.h"

namespace patchmill {

// Takes the first line off a text, and returns it without its end ("\n" or "\r\n").
std::string_view TakeLine(std::string_view& text);

class ProgramLines {
 public:
  // Keeps a reference.
  explicit ProgramLines(const Dialect& dialect) : dialect_(dialect), siemens_(dialect) {}

  // The block of the next line; absent for a line that does nothing. INVALID_ARGUMENT (without the line
  // number) for what the dialect does not have.
  absl::StatusOr<std::optional<BlockModes>> Read(std::string_view line);
  // The second % has ended the program: nothing after it counts.
  bool ended() const { return ended_; }

 private:
  absl::StatusOr<std::optional<BlockModes>> ReadGcode(std::string_view line);

  const Dialect& dialect_;
  SiemensReader siemens_;
  KlartextReader klartext_;
  GcodeBlock block_;  // reused from line to line
  bool percent_opened_ = false, begun_ = false, numbered_ = false, ended_ = false;
};

}  // namespace patchmill
