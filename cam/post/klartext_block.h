// Reads lines of Heidenhain's conversational programs (Klartext) as blocks of the same modal groups as
// RS274. Source: the user's manuals for conversational programming of iTNC 530 and TNC 640.
#pragma once

#include <optional>
#include <string_view>

#include <absl/status/statusor.h>

#include "cam/post/gcode_modes.h"

namespace patchmill {

// Reads: BEGIN PGM and END PGM, BLK FORM, TOOL CALL and TOOL DEF, L, CC, C and CR with X, Y, Z, R0, F, FMAX
// and M words, CYCL DEF 32 (tolerance) and 9 (dwell), STOP, lines of M words, comments. M91 is a move to
// machine coordinates.
class KlartextReader {
 public:
  // The block of the next line; absent for a line that does nothing. INVALID_ARGUMENT (without the line
  // number) for anything else: radius compensation, incremental and polar coordinates, Q parameters, labels,
  // calls, other cycles.
  // In a program in inches, F counts tenths of an inch per minute; the block has it in inches.
  absl::StatusOr<std::optional<BlockModes>> Read(std::string_view line);

 private:
  absl::StatusOr<std::optional<BlockModes>> ReadBlock(std::string_view line);

  bool begun_ = false, ended_ = false, inch_ = false;
  std::optional<double> pole_x_, pole_y_;  // of CC, in the program's unit
};

}  // namespace patchmill
