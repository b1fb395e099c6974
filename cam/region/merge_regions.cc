#include "cam/region/merge_regions.h"

#include <algorithm>
#include <map>
#include <set>

namespace patchmill {
namespace {

struct Node {
  SplitLabel label;
  double area = 0.0;
  double curvature = 0.0;
  std::map<int, double> border;  // neighbour -> common length
  bool alive = true;
};

class Merger {
 public:
  Merger(const std::vector<RawRegion>& raw, const std::vector<RawContact>& contacts,
         const MergeParams& params)
      : params_(params), parent_(raw.size()) {
    for (std::size_t i = 0; i < raw.size(); ++i) {
      parent_[i] = static_cast<int>(i);
      nodes_.push_back({raw[i].label, raw[i].area, raw[i].curvature, {}, true});
    }
    for (const RawContact& c : contacts) {
      if (c.a == c.b) continue;
      nodes_[static_cast<std::size_t>(c.a)].border[c.b] += c.length;
      nodes_[static_cast<std::size_t>(c.b)].border[c.a] += c.length;
    }
  }

  MergedRegions Run() {
    for (Node& node : nodes_) Neutralise(node);
    for (std::size_t i = 0; i < nodes_.size(); ++i) FuseEqual(static_cast<int>(i));
    // Regions queued by area; a region's place is renewed whenever it grows.
    std::set<std::pair<double, int>> queue;
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
      if (nodes_[i].alive) queue.insert({nodes_[i].area, static_cast<int>(i)});
    }
    while (!queue.empty() && queue.begin()->first < params_.min_area) {
      const int small = queue.begin()->second;
      queue.erase(queue.begin());
      const int into = BestNeighbour(small);
      if (into < 0) continue;
      queue.erase({nodes_[static_cast<std::size_t>(into)].area, into});
      Join(into, small);
      FuseEqual(into, &queue);
      queue.insert({nodes_[static_cast<std::size_t>(into)].area, into});
    }
    LumpIslands();
    LumpUnreachable();
    MergedRegions merged;
    std::map<int, int> index;
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
      const int root = Root(static_cast<int>(i));
      const auto [it, fresh] = index.try_emplace(root, static_cast<int>(index.size()));
      if (fresh) merged.label.push_back(nodes_[static_cast<std::size_t>(root)].label);
      merged.group.push_back(it->second);
    }
    return merged;
  }

 private:
  int Root(int i) {
    while (parent_[static_cast<std::size_t>(i)] != i) i = parent_[static_cast<std::size_t>(i)];
    return i;
  }

  // Small reachable islands in unreachable ground have nothing to merge with: they go with the largest region
  // of their own label, or the largest of all.
  void LumpIslands() {
    const auto largest = [&](const SplitLabel* label) {
      int best = -1;
      for (std::size_t i = 0; i < nodes_.size(); ++i) {
        const Node& n = nodes_[i];
        if (!n.alive || n.label.reason != UnreachableReason::kNone ||
            (label != nullptr && !(n.label == *label)))
          continue;
        if (best < 0 || n.area > nodes_[static_cast<std::size_t>(best)].area) best = static_cast<int>(i);
      }
      return best;
    };
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
      const Node& node = nodes_[i];
      if (!node.alive || node.label.reason != UnreachableReason::kNone || node.area >= params_.min_area)
        continue;
      int into = largest(&node.label);
      if (into == static_cast<int>(i)) into = largest(nullptr);
      if (into >= 0 && into != static_cast<int>(i)) Join(into, static_cast<int>(i));
    }
  }

  // Small unreachable spots, wherever they are, count as one region per reason.
  void LumpUnreachable() {
    std::map<UnreachableReason, int> first;
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
      const Node& node = nodes_[i];
      if (!node.alive || node.label.reason == UnreachableReason::kNone || node.area >= params_.min_area)
        continue;
      const auto [it, fresh] = first.try_emplace(node.label.reason, static_cast<int>(i));
      if (!fresh) Join(it->second, static_cast<int>(i));
    }
  }

  void Neutralise(Node& node) const {
    if (node.label.reason == UnreachableReason::kNone && std::abs(node.curvature) < params_.min_curvature)
      node.label.curvature = 0;
    if (node.label.reason != UnreachableReason::kNone) node.label = {0, false, node.label.reason};
  }

  int BestNeighbour(int i) const {
    const Node& node = nodes_[static_cast<std::size_t>(i)];
    if (node.label.reason != UnreachableReason::kNone) return -1;  // reasons are never mixed
    int best = -1;
    double longest = 0.0;
    for (const auto& [other, length] : node.border) {
      if (nodes_[static_cast<std::size_t>(other)].label.reason != UnreachableReason::kNone) continue;
      if (length > longest) {
        longest = length;
        best = other;
      }
    }
    return best;
  }

  // `gone` becomes part of `into`, whose label follows the larger part.
  void Join(int into, int gone) {
    Node& a = nodes_[static_cast<std::size_t>(into)];
    Node& b = nodes_[static_cast<std::size_t>(gone)];
    if (b.area > a.area) a.label = b.label;
    a.area += b.area;
    a.curvature += b.curvature;
    for (const auto& [other, length] : b.border) {
      Node& o = nodes_[static_cast<std::size_t>(other)];
      o.border.erase(gone);
      if (other == into) continue;
      a.border[other] += length;
      o.border[into] += length;
    }
    a.border.erase(gone);
    b.border.clear();
    b.alive = false;
    parent_[static_cast<std::size_t>(gone)] = into;
  }

  void FuseEqual(int i, std::set<std::pair<double, int>>* queue = nullptr) {
    if (!nodes_[static_cast<std::size_t>(i)].alive) return;
    for (bool again = true; again;) {
      again = false;
      for (const auto& [other, length] : nodes_[static_cast<std::size_t>(i)].border) {
        if (nodes_[static_cast<std::size_t>(other)].label == nodes_[static_cast<std::size_t>(i)].label) {
          if (queue != nullptr) queue->erase({nodes_[static_cast<std::size_t>(other)].area, other});
          Join(i, other);
          again = true;
          break;
        }
      }
    }
  }

  const MergeParams& params_;
  std::vector<Node> nodes_;
  std::vector<int> parent_;
};

}  // namespace

MergedRegions MergeRegions(const std::vector<RawRegion>& raw, const std::vector<RawContact>& contacts,
                           const MergeParams& params) {
  return Merger(raw, contacts, params).Run();
}

}  // namespace patchmill
