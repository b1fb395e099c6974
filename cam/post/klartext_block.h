// Reads lines of Heidenhain's conversational programs (Klartext) as blocks of the same modal groups as
// RS274. Source: the user's manuals for conversational programming of iTNC 530 and TNC 640.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <absl/status/statusor.h>

#include "cam/post/gcode_modes.h"

namespace patchmill {

// Reads: BEGIN PGM and END PGM, BLK FORM, L, CC, C and CR with X, Y, Z, IX, IY, IZ, R0, F, FMAX, FAUTO and M
// words, rotary axes at zero, STOP, lines of M words, comments, and the lines of klartext_setup.h. M91 and
// M92 are moves to machine coordinates, M140 MB MAX is one up. A line that ends with ~ goes on in the next
// one.
class KlartextReader {
 public:
  // The block of the next line; absent for a line that does nothing. INVALID_ARGUMENT (without the line
  // number) for anything else: radius compensation, polar coordinates, Q parameters, labels, calls, other
  // cycles.
  // In a program in inches, F counts tenths of an inch per minute; the block has it in inches.
  absl::StatusOr<std::optional<BlockModes>> Read(std::string_view line);

 private:
  absl::StatusOr<std::optional<BlockModes>> ReadBlock(const std::vector<std::string>& words);
  absl::StatusOr<std::optional<BlockModes>> Begin(const std::vector<std::string>& words);
  absl::Status SetPole(const std::vector<std::string>& words);
  // C around the pole, or CR with a radius.
  absl::StatusOr<BlockModes> ArcLine(const std::vector<std::string>& words) const;

  bool begun_ = false, ended_ = false, inch_ = false;
  std::optional<double> pole_x_, pole_y_;  // of CC, in the program's unit
  std::optional<double> tool_feed_;        // F of the last TOOL CALL
  std::vector<std::string> open_;          // the words of a line that goes on
};

}  // namespace patchmill
