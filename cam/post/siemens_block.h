// Reads lines of Siemens programs (DIN/ISO with Siemens' own words) as blocks of the same modal groups as
// RS274. Source: SINUMERIK 840D sl / 828D, programming manuals "Fundamentals" and "Job planning".
#pragma once

#include <optional>
#include <string_view>

#include <absl/status/statusor.h>

#include "cam/post/gcode_modes.h"
#include "cam/post/siemens_line.h"

namespace patchmill {

// Beside the words of RS274 that Siemens has: X=, CR=, TURN=, I=AC(), X=IC(), T="name", S1=, M1=, ADIS=; SUPA
// and G153 (as G53), D0 and D1 (tool offset), G60 (exact stop), G70, G71, G700 and G710 (units), G74 and G75
// (reference points), G4 F (dwell, s), CYCLE800, CYCLE832 (tolerance), frames that are reset, and the names
// of siemens_names.h.
class SiemensReader {
 public:
  // Keeps a reference.
  explicit SiemensReader(const Dialect& dialect) : dialect_(dialect) {}

  // The block of a line; absent for one that does nothing. INVALID_ARGUMENT (without the line number) for
  // anything else: assignments, variables, calls, frames.
  absl::StatusOr<std::optional<BlockModes>> Read(std::string_view line);

 private:
  const Dialect& dialect_;
  SiemensLine line_;  // reused from line to line
};

}  // namespace patchmill
