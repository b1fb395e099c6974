// Closed outlines in the plan: whether a point lies inside, and its distance from the outline.
#pragma once

#include <string>
#include <vector>

#include "core/base/vec.h"

namespace patchmill {

using Ring = std::vector<Vec2>;  // closed: the last point joins the first, which is not repeated

// Says why `rings` are no outline; empty if they are one. There must be a ring, and each ring needs three or
// more finite points that do not all lie within 1e-6 mm of one line.
std::string OutlineFault(const std::vector<Ring>& rings);

// The points with an odd number of rings around them (even-odd rule). Rings may lie in each other, cross
// themselves and run either way. Immutable after construction.
class Outline {
 public:
  Outline() = default;                               // nothing is inside
  explicit Outline(const std::vector<Ring>& rings);  // OutlineFault(rings) must be empty

  // Distance (mm) of q to the nearest ring, positive inside, negative outside; -infinity without rings. Its
  // slope is at most 1, its error some ulps of the coordinates. Cost O(log n) near a usual outline.
  double SignedDistance(const Vec2& q) const;

  const std::vector<Ring>& rings() const { return rings_; }

 private:
  struct Edge {
    Vec2 a, b;
  };
  // Edges [first, first + count) and their box. The left child of an inner node is the next node; the right
  // child is `right`.
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
