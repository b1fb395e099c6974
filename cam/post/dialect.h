// Dialects: the differences between controls, as data [machining, section 5].
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace patchmill {

struct Dialect {
  std::string name;
  int decimals = 4;                    // of X, Y, Z in mm
  std::size_t max_comment_length = 0;  // characters in one comment line, including its marks
  std::string comment_open, comment_close;
  std::string comment_marks;  // inside a comment these characters become brackets
  std::string safe_start;     // before any motion; {0} is the work offset
  std::string home_z;         // straight up to machine zero, above everything
  std::string tool_change;    // {0} is the tool number
  std::string spindle_on;     // {0} is the speed, 1/min
  std::string tool_length;    // {0} is the tool number; must not move anything
  // {0} is the tolerance, mm. It switches off the merging of nearly collinear moves, so that the control
  // deviates by {0} at most.
  std::string path_tolerance;
  std::string exact_path;  // used instead if the tolerance rounds to 0
  std::string flood_on, mist_on, air_on, coolant_off, spindle_off;
  std::string restore;  // before the end; restores the modes that the next program may rely on
  std::string end;
};

const std::vector<Dialect>& Dialects();
const Dialect* FindDialect(std::string_view name);  // nullptr if unknown

}  // namespace patchmill
