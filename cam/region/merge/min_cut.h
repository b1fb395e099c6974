// Labels the nodes of a graph with 0 or 1 at least cost, which comes from the nodes and from the borders
// between different labels.
#pragma once

#include <span>
#include <vector>

namespace patchmill {

struct LabelPair {
  int a = 0, b = 0;
  double weight = 0.0;  // >= 0, cost if a and b have different labels
};

// Returns the set of nodes labelled 1 (the others are 0) for which
//   sum of cost[i] over the set + sum of weight over the pairs it separates
// is least. Of several such sets it returns the smallest one. So the result does not depend on the order of
// the pairs, except where rounding decides. It is a minimum cut [references: greig1989],
// [references: dinic1970]. Cost: about pairs^1.5 steps.
std::vector<bool> MinCut(std::span<const double> cost, std::span<const LabelPair> pairs);

}  // namespace patchmill
