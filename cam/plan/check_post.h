// What is wrong with a post file, without a part: its own faults, and those of a small program.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "cam/post/post_faults.h"

namespace patchmill {

struct PostCheck {
  std::vector<PostFault> faults;  // empty: programs can be written with it
  std::string name;               // of the dialect
  // The dialect of Patchmill's own with which the file shares most lines. Comments and empty lines do not
  // count. Empty if they share none.
  std::string base;
  struct OwnLine {
    int line = 0;  // of the file, from 1
    std::string text;
  };
  std::vector<OwnLine> own_lines;          // that `base` does not have
  std::vector<std::string> missing_lines;  // that only `base` has
  // What the file leaves to the control, or says of it without a word of the program, as sentences.
  std::vector<std::string> left_to_control;
};

// Cost O(text), and the reading of one program.
PostCheck CheckPostFile(std::string_view text);

}  // namespace patchmill
