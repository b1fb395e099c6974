#include "cam/region/merge/min_cut.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "core/base/status.h"

namespace patchmill {
namespace {

// A flow network. Nodes that gain by the label 1 hang on the source, nodes that lose by it on the sink.
class Network {
 public:
  explicit Network(std::size_t nodes) : arcs_of_(nodes), level_(nodes), next_(nodes) {}

  void Connect(std::size_t from, std::size_t to, double forth, double back) {
    arcs_of_[from].push_back(arcs_.size());
    arcs_.push_back({to, forth});
    arcs_of_[to].push_back(arcs_.size());
    arcs_.push_back({from, back});
  }

  void Fill(std::size_t source, std::size_t sink) {
    while (Levels(source)[sink] >= 0) {
      std::fill(next_.begin(), next_.end(), std::size_t{0});
      while (Push(source, sink)) {
      }
    }
  }

  // Number of steps from `source` to each node along arcs with room; -1 if there is no such way. After Fill
  // the nodes with a level >= 0 are the source's side of the cut.
  const std::vector<int>& Levels(std::size_t source) {
    std::fill(level_.begin(), level_.end(), -1);
    level_[source] = 0;
    std::vector<std::size_t> queue{source};
    for (std::size_t i = 0; i < queue.size(); ++i) {
      for (const std::size_t arc : arcs_of_[queue[i]]) {
        const Arc& a = arcs_[arc];
        if (!(a.room > 0.0) || level_[a.to] >= 0) continue;
        level_[a.to] = level_[queue[i]] + 1;
        queue.push_back(a.to);
      }
    }
    return level_;
  }

 private:
  struct Arc {
    std::size_t to;
    double room;
  };

  // Finds one path through the levels and fills it: its narrowest arc has exactly no room left. False if
  // there is no path.
  bool Push(std::size_t source, std::size_t sink) {
    std::vector<std::size_t> path;
    for (std::size_t at = source; at != sink;) {
      std::size_t& k = next_[at];
      const auto usable = [&](std::size_t arc) {
        return arcs_[arc].room > 0.0 && level_[arcs_[arc].to] == level_[at] + 1;
      };
      while (k < arcs_of_[at].size() && !usable(arcs_of_[at][k])) ++k;
      if (k < arcs_of_[at].size()) {
        path.push_back(arcs_of_[at][k]);
        at = arcs_[path.back()].to;
        continue;
      }
      if (path.empty()) return false;
      at = arcs_[path.back() ^ 1u].to;
      path.pop_back();
      ++next_[at];
    }
    double least = std::numeric_limits<double>::infinity();
    for (const std::size_t arc : path) least = std::min(least, arcs_[arc].room);
    for (const std::size_t arc : path) {
      arcs_[arc].room -= least;
      arcs_[arc ^ 1u].room += least;
    }
    return true;
  }

  std::vector<Arc> arcs_;  // arcs 2 k and 2 k + 1 are one pair, forth and back
  std::vector<std::vector<std::size_t>> arcs_of_;
  std::vector<int> level_;
  std::vector<std::size_t> next_;
};

}  // namespace

std::vector<bool> MinCut(std::span<const double> cost, std::span<const LabelPair> pairs) {
  const std::size_t source = cost.size(), sink = source + 1;
  for (const double c : cost) PM_CHECK(std::isfinite(c));
  for (const LabelPair& p : pairs) PM_CHECK(p.weight >= 0.0 && std::isfinite(p.weight));
  Network network(cost.size() + 2);
  for (std::size_t i = 0; i < cost.size(); ++i) {
    if (cost[i] < 0.0) network.Connect(source, i, -cost[i], 0.0);
    if (cost[i] > 0.0) network.Connect(i, sink, cost[i], 0.0);
  }
  for (const LabelPair& p : pairs)
    network.Connect(static_cast<std::size_t>(p.a), static_cast<std::size_t>(p.b), p.weight, p.weight);
  network.Fill(source, sink);
  const std::vector<int>& side = network.Levels(source);
  std::vector<bool> ones(cost.size());
  for (std::size_t i = 0; i < cost.size(); ++i) ones[i] = side[i] >= 0;
  return ones;
}

}  // namespace patchmill
