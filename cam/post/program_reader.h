// Program text -> motion: the reading half of the verifier. Any LinuxCNC-like text, ours or another's.
#pragma once

#include <string_view>

#include <absl/status/statusor.h>

#include "cam/toolpath/toolpath.h"
#include "core/base/run_context.h"

namespace patchmill {

struct ReaderParams {
  double arc_chord_error = 1e-4;      // mm: arcs become chords this close
  std::size_t max_moves = 5'000'000;  // 400 MB
  std::size_t max_line_length = 1000;
  const RunContext* run = nullptr;  // polled when set: CANCELLED or DEADLINE_EXCEEDED
};

// Three million lines a second. Reads G0-G3, G17-G19, G20/G21, G40, G43/G49, G53 (Z only), G54-G59, G61/G64,
// G80, G90/G91, G90.1/G91.1, G94, F, S, T, M2 M3 M5 M6 M7-M9 M30, comments, N, %. Any other word that could
// move is INVALID_ARGUMENT with its line ("line 12: ..."), more than max_moves RESOURCE_EXHAUSTED. Positions
// are those of the program (tip, after G43), in mm. Words of a line count in LinuxCNC's order, whatever
// theirs is: F in the unit in force before the line, then G20/G21, coordinates and G64 P in the new one.
absl::StatusOr<ProgramMotion> ReadProgram(std::string_view text, const ReaderParams& params = {});

}  // namespace patchmill
