// The pictures of control points in core/patch/patch.h, read from the header's text.
//
// A picture stands in the comment above `struct NAME`. Its lowest row has the label v=0 (triangles: t=0), its
// highest v=1 (t=1), and the line below names the ends u=0 and u=1 (s=0 and s=1), below the border.
#pragma once

#include <string>
#include <vector>

namespace patchmill::testing {

// A place of the picture with the number of its point. Two numbers, "7,36", are two points at one place: the
// first belongs to lines up and down, the second to lines left and right.
struct NetPlace {
  int vertical = 0, horizontal = 0;  // the same where one number stands
};

// A line between two places that are neighbours.
struct NetLine {
  int from = 0, to = 0;  // points; `from` is the left or the lower one
  bool is_vertical = false;
};

struct NetPicture {
  bool is_triangle = false;
  std::vector<std::vector<NetPlace>> rows;  // from the lowest up, each from left to right
  std::vector<NetLine> lines;
  // The points on the frame. Quads: v=0, u=1, v=1, u=0; triangles: t=0, s+t=1, s=0. In the order of u or v
  // that grows (t along s+t=1).
  std::vector<std::vector<int>> sides;
};

// A fault of the picture fails the test with its text.
NetPicture ReadNetPicture(const std::string& header, const std::string& kind);

}  // namespace patchmill::testing
