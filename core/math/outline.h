// Closed outlines in the plan: inside, outside, and how far from the line.
#pragma once

#include <string>
#include <vector>

#include "core/base/vec.h"

namespace patchmill {

using Ring = std::vector<Vec2>;  // closed: the last point joins the first, which is not repeated

// What keeps rings from being an outline; empty when nothing does. Each needs three points or more, finite
// ones, not all within 1e-6 mm of one line.
std::string OutlineFault(const std::vector<Ring>& rings);

// The points with an odd number of rings around them (even-odd rule): rings may lie in each other, cross
// themselves and run either way. Immutable after construction.
class Outline {
 public:
  Outline() = default;                               // nothing is inside
  explicit Outline(const std::vector<Ring>& rings);  // sound ones: OutlineFault

  // Distance (mm) of q to the nearest ring, positive inside, negative outside; -infinity without rings.
  // Slope at most 1; error some ulps of the coordinates. Cost O(log n) near the outline for the usual ones.
  double SignedDistance(const Vec2& q) const;

  const std::vector<Ring>& rings() const { return rings_; }

 private:
  struct Edge {
    Vec2 a, b;
  };
  // Edges [first, first + count) and their box; inner nodes have their left child next, the right one at
  // `right`.
  struct Node {
    Vec2 min, max;
    int first = 0, count = 0, right = -1;
  };
  int Build(int first, int count);
  double Distance2(int node, const Vec2& q, double best) const;
  bool Odd(int node, const Vec2& q) const;

  std::vector<Ring> rings_;
  std::vector<Edge> edges_;
  std::vector<Node> nodes_;
};

}  // namespace patchmill
