// What differs between controls, as data ([machining, section 5]).
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace patchmill {

struct Dialect {
  std::string name;
  int decimals = 4;                    // of X, Y, Z, mm
  std::size_t max_comment_length = 0;  // characters of one comment line, its marks included
  std::string comment_open, comment_close;
  std::string comment_marks;  // these characters become brackets inside a comment
  std::string safe_start;     // before any motion; {0}: work offset
  std::string home_z;         // straight up to machine zero, above everything
  std::string tool_change;    // {0}: tool number
  std::string spindle_on;     // {0}: rpm
  std::string tool_length;    // {0}: tool number; must not move anything
  // {0}: tolerance, mm. Merging of nearly collinear moves is switched off, so that {0} is all the control
  // adds.
  std::string path_tolerance;
  std::string exact_path;  // instead, when the tolerance rounds to nothing
  std::string flood_on, mist_on, air_on, coolant_off, spindle_off;
  std::string restore;  // before the end: what the next program may rely on
  std::string end;
};

const std::vector<Dialect>& Dialects();
const Dialect* FindDialect(std::string_view name);  // nullptr: unknown

}  // namespace patchmill
