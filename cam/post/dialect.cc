#include "cam/post/dialect.h"

namespace patchmill {

namespace {

// RS274/NGC as LinuxCNC reads it. A line may have 255 characters. G91.1 is stated because G90.1 is modal. Q0
// is stated because G64 without Q takes Q = P, which merges moves in addition to blending them.
Dialect LinuxCnc() {
  return {.name = "linuxcnc",
          .decimals = 4,
          .max_comment_length = 120,
          .comment_open = "(",
          .comment_close = ")",
          .comment_marks = "()",
          .safe_start = "G17 G21 G40 G49 {0} G80 G90 G91.1 G94",
          .home_z = "G53 G0 Z0",
          .tool_change = "T{0} M6",
          .spindle_on = "S{0} M3",
          .tool_length = "G43 H{0}",
          .path_tolerance = "G64 P{0} Q0",
          .exact_path = "G61",
          .flood_on = "M8",
          .mist_on = "M7",
          .air_on = "M7",
          .coolant_off = "M9",
          .spindle_off = "M5",
          .restore = "G17 G40 G49 G80 G90",
          .end = "M2"};
}

}  // namespace

const std::vector<Dialect>& Dialects() {
  static const auto* const dialects = new std::vector<Dialect>{LinuxCnc()};
  return *dialects;
}

const Dialect* FindDialect(std::string_view name) {
  for (const Dialect& dialect : Dialects()) {
    if (dialect.name == name) return &dialect;
  }
  return nullptr;
}

}  // namespace patchmill
