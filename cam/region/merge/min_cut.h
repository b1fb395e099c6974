// Labels for the nodes of a graph that cost least: the data on the nodes against the borders between them.
#pragma once

#include <span>
#include <vector>

namespace patchmill {

struct LabelPair {
  int a = 0, b = 0;
  double weight = 0.0;  // >= 0, cost of different labels
};

// The set of nodes labelled 1 (the others 0) for which
//   sum of cost[i] over the set + sum of weight over the pairs it separates
// is least, and of all such sets the smallest: one and the same for any order of the pairs, ties and rounding
// apart. By a minimum cut [references: greig1989], [references: dinic1970]: about pairs^1.5 steps.
std::vector<bool> MinCut(std::span<const double> cost, std::span<const LabelPair> pairs);

}  // namespace patchmill
