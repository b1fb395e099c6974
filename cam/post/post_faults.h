// All faults of a post file.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "cam/post/dialect.h"

namespace patchmill {

struct PostFault {
  int line = 0;  // from 1; 0: the file as a whole
  std::string message;
};

inline constexpr std::size_t kLongestPostFile = 100'000;  // characters

struct ReadPost {
  Dialect dialect;                // what could be read
  std::vector<PostFault> faults;  // those of lines in their order, then those of the whole file
};

// Reads on after a fault. What a faulty line would have said is not missed a second time. Cost O(text).
ReadPost ReadPostFile(std::string_view text);

}  // namespace patchmill
