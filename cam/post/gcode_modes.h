// Sorts the words of one block into modal groups (RS274/NGC tables 4 and 5).
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <absl/status/statusor.h>

#include "cam/post/dialect.h"
#include "cam/post/gcode_block.h"

namespace patchmill {

// Work offsets with a number of their own (G54.1 P3) have codes above this one.
inline constexpr int kNumberedOffsets = 1'000'000;

// Presets of a Heidenhain control (CYCL DEF 247) likewise.
inline constexpr int kPresets = 10 * kNumberedOffsets;

// "G54", "G54.1 P3", "preset 2".
std::string OffsetName(int work_offset);

// What one axis word counts from.
enum class AxisMode : unsigned char { kInForce, kAbsolute, kIncremental };

// What the reader assumes when it runs a block.
struct BlockNote {
  const char* code = "";
  std::string message;
};

// Codes are ten times their number: G90.1 is 901. 0 is a code (G0, M0); a missing code is std::nullopt.
struct BlockModes {
  using Code = std::optional<int>;
  bool deletable = false;               // the line starts with /
  Code motion;                          // G0 G1 G2 G3 G73 G80 G81 G82 G83
  bool ends_cycles = false;             // G80, also beside another motion
  Code plane;                           // G17 G18 G19
  Code units;                           // G20 G21
  Code distance;                        // G90 G91
  Code arc_distance;                    // G90.1 G91.1
  Code tool_length;                     // G43 G49
  Code work_offset;                     // G54 .. G59, and those of the dialect
  Code path;                            // G61 G61.1 G64
  Code once;                            // G4 G28 G30 G53
  Code compensation;                    // G40 G41 G42 G41.1 G42.1
  Code feed_mode;                       // G93 G94 G95
  Code cycle_end;                       // G98 G99
  Code stop;                            // M0 M1 M2 M30
  Code tool_change;                     // M6
  Code spindle;                         // M3 M4 M5
  Code coolant;                         // M7 M8 M9
  std::optional<DialectWord> word;      // a word of the dialect's own
  std::string_view own_word;            // its spelling in [words]; empty if it belongs to the syntax
  std::optional<bool> merges;           // whether the control smooths the path by what no word limits
  std::optional<bool> coarse_stop;      // whether exact stops go on before the axes have arrived
  std::optional<double> blending;       // beside G64: it leaves the path by at most this, unit of the program
  std::optional<double> turns;          // of an arc, full and partial
  bool no_offset = false;               // no work offset is in force any more
  bool rotary = false;                  // rotary axes are named, and all go to zero
  bool still = false;                   // X, Y and Z belonged to a word that moves nothing
  std::array<AxisMode, 3> axis_mode{};  // of X, Y, Z
  std::string tool_name;                // of a tool that has no number
  std::vector<std::string> without_effect;  // words that neither move nor change the path
  std::vector<BlockNote> notes;
  // A coordinate other than 0 without a decimal point, where that matters (Dialect::coordinate_point); or
  // '\0'.
  char without_point = '\0';
  std::array<std::optional<double>, 26> value;  // of the other letters, by letter - 'A'

  const std::optional<double>& operator[](char letter) const {
    return value[static_cast<std::size_t>(letter - 'A')];
  }
};

// INVALID_ARGUMENT (without the line number) for codes and letters that neither RS274 nor the dialect has,
// for two codes of one group, and for a letter that occurs twice.
absl::StatusOr<BlockModes> SortModes(const GcodeBlock& block, const Dialect& dialect);

}  // namespace patchmill
