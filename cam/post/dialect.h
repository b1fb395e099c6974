// Dialects: the differences between controls, as data [machining, section 5]. A dialect is read from a
// text, a post file. docs/posts.md describes every key and placeholder of it.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <absl/status/statusor.h>

#include "cam/post/word_rules.h"
#include "cam/toolpath/arc.h"
#include "core/base/enum_array.h"

namespace patchmill {

// The grammar of the lines of a program.
enum class Syntax {
  kRs274,    // G1 X10 Y5
  kSiemens,  // the same, with Siemens' own words
  kKlartext  // L X+10 Y+5, Heidenhain conversational
};

// The effect of a word that RS274 does not have, as far as it matters to the reader of programs.
struct DialectWord {
  char tolerance_letter = '\0';  // its value (mm) limits how far the control leaves the path; 0: no effect
};

// Arcs that the control is given. The others are written as straight moves.
struct DialectArcs {
  EnumArray<ArcPlane, bool> planes{};
  bool helices = false;              // G2 and G3 may move along the third axis
  double largest_radius = 1000.0;    // mm
  double largest_sweep = 2.0 * kPi;  // rad, of one block
  // I, J and K always count from the start of the arc. Else G90.1 and G91.1 decide.
  bool center_from_start = false;
};

// The unit of a program's coordinates and feeds.
enum class ProgramUnit { kMillimeter, kInch };
constexpr ProgramUnit LastOf(ProgramUnit) { return ProgramUnit::kInch; }
inline constexpr EnumArray<ProgramUnit, double> kMillimetersPer{{{1.0, 25.4}}};

struct Dialect {
  std::string name, title;
  Syntax syntax = Syntax::kRs274;
  WordFamily family = WordFamily::kNone;           // whose words programs of others have, beside `words`
  EnumArray<ProgramUnit, int> decimals{{{4, 5}}};  // of X, Y, Z
  // The word that {unit} stands for. Empty: the dialect has no programs in that unit.
  EnumArray<ProgramUnit, std::string> unit_word;
  std::size_t max_comment_length = 0;  // characters in one comment line, including its marks
  std::string comment_open, comment_close;
  bool upper_case = false;  // of comments
  bool feed_point = false;  // F always has a decimal point
  // A coordinate without a decimal point counts in mm or in increments, as the control is set.
  bool coordinate_point = false;
  bool length_offset = true;  // the control has length offsets of tools (G43)
  int line_number_step = 0;   // 0: lines have no numbers
  std::string line_end = "\n";
  // On a line with G20 or G21, F counts in the new unit; else in the unit in force before the line.
  bool feed_in_new_unit = false;
  bool arc_turns = false;        // P of G2 and G3 counts full and partial turns
  bool d0_is_no_offset = false;  // D0 of G41 and G42 is an offset of zero, and D0 is in force at the start
  double arc_radius_slack =
      0.005;  // mm: by how much the radii at both ends of an arc may differ (arc_chords.h)
  double arc_radius_slack_in = 0.0;  // inch, the same while G20 is in force; 0: arc_radius_slack

  // mm, machine coordinates, at most 0: a Z of G53, M91 or SUPA at or above it counts as above everything.
  double machine_top = 0.0;

  // The control leaves the path by nothing, whatever the modes.
  bool follows_exactly = false;
  // {tolerance} (mm): limits how far the control leaves the path. It also switches off the merging of nearly
  // collinear moves. Empty: the control has no such word.
  std::string path_tolerance;
  double least_tolerance = 0.0;  // mm; below it exact_path is used
  std::string exact_path;        // of programs in mm
  std::string exact_path_inch;   // of those in inches; empty: the same
  // Used where path_tolerance is empty and the user states by how much the control leaves the path.
  std::string assumed_path;
  // The time on a machine is that of LinuxCNC's planner (cam/toolpath/linuxcnc_times.h). Else the junction
  // deviation of the machine says how fast corners are passed.
  bool linuxcnc_planner = false;

  DialectArcs arcs;

  std::string flood_on, mist_on, air_on;
  std::map<std::string, DialectWord> words;  // by their spelling: "G187"
  // Lines with placeholders {...}. A line whose placeholder stands for nothing is left out.
  std::vector<std::string> begin, end;
  // Written where the control may be started again; the same placeholders, and the lines send the tool up and
  // over {x} {y}, to {z}. Empty: the dialect has no restart points.
  std::vector<std::string> restart;

  std::string text;  // of the post file
};

// mm: the last decimal of a coordinate.
double TickOf(const Dialect& dialect, ProgramUnit unit);
// Whether Patchmill brings this very dialect along; else the user says what it says.
bool IsShipped(const Dialect& dialect);
// Whether the dialect has programs in that unit. Without {unit} in its lines, all its programs are in mm.
bool HasUnit(const Dialect& dialect, ProgramUnit unit);

inline constexpr int kMaxLineNumberStep = 1000;

// Reads a post file. INVALID_ARGUMENT for the first fault, with its line: "line 12: ...". Cost O(text).
absl::StatusOr<Dialect> ParseDialect(std::string_view text);

// The dialects that Patchmill brings along, by name.
const std::vector<Dialect>& Dialects();
const Dialect* FindDialect(std::string_view name);  // nullptr if unknown
const Dialect& LinuxCnc();                          // the default
std::string DialectNames();                         // "fanuc, grbl, ..."

}  // namespace patchmill
