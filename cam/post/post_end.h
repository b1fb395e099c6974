// The modes in which the lines of a post file leave the control, before the moves of the path.
#pragma once

#include <string>
#include <vector>

#include "cam/post/dialect.h"

namespace patchmill {

// A mode that the moves of the path do not expect: they begin with a rapid without G0, and are absolute.
struct UnexpectedMode {
  std::size_t index = 0;  // of the line that sets it
  std::string message;
};

// Of `lines`, those of [begin] or [restart]; empty if the control is left in G0 and G90. Lines that cannot be
// read are passed over: the reader of programs names them.
std::vector<UnexpectedMode> UnexpectedModes(const Dialect& dialect, const std::vector<std::string>& lines);

}  // namespace patchmill
