#include "cam/region/merge/merge_regions.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <set>
#include <tuple>
#include <utility>

#include "cam/region/merge/min_cut.h"

namespace patchmill {
namespace {

constexpr double kIslands = 0.1;  // in min_area: area from which islands of one label form a region
constexpr double kEqual = 1.1;    // ratio of areas up to which regions count as equally large

bool Reached(const SplitLabel& label) { return label.reason == UnreachableReason::kNone; }

std::size_t WholeOf(const std::vector<RawRegion>& regions, int i) {
  const int whole = regions[static_cast<std::size_t>(i)].whole;
  return static_cast<std::size_t>(whole < 0 ? i : whole);
}

// Sets the labels of least energy, the same for all parts of a whole.
void Relabel(const std::vector<RawContact>& contacts, const MergeParams& params,
             std::vector<RawRegion>& regions) {
  std::vector<RawRegion> wholes(regions.size());
  for (std::size_t i = 0; i < regions.size(); ++i) {
    RawRegion& whole = wholes[WholeOf(regions, static_cast<int>(i))];
    whole.label = regions[i].label;
    whole.area += regions[i].area;
    whole.curvature += regions[i].curvature;
    whole.steepness += regions[i].steepness;
  }
  std::vector<double> basin(regions.size(), 0.0), no_mountain = basin, steep = basin;
  for (std::size_t i = 0; i < regions.size(); ++i) {
    const RawRegion& r = wholes[i];
    if (!Reached(r.label) || WholeOf(regions, static_cast<int>(i)) != i) continue;
    const double bend = std::abs(r.curvature);
    const bool flat = r.label.curvature == 0 || bend < params.flat * r.area;
    // Costs of +1 against 0 and of 0 against -1. The loss of a label is |label - own label| times the bend.
    const double side = r.label.curvature > 0 ? -1.0 : 1.0;
    basin[i] = flat ? params.flat_cost * r.area : side * bend;
    no_mountain[i] = flat ? -params.flat_cost * r.area : side * bend;
    steep[i] = -r.steepness;
  }
  const auto pairs = [&](double cost) {
    std::vector<LabelPair> list;
    for (const RawContact& c : contacts) {
      const std::size_t a = WholeOf(regions, c.a), b = WholeOf(regions, c.b);
      if (a == b || !Reached(regions[a].label) || !Reached(regions[b].label)) continue;
      list.push_back({static_cast<int>(a), static_cast<int>(b), cost * c.length});
    }
    return list;
  };
  const std::vector<LabelPair> turn = pairs(params.border_turn);
  const std::vector<bool> is_basin = MinCut(basin, turn), is_no_mountain = MinCut(no_mountain, turn);
  const std::vector<bool> is_steep = MinCut(steep, pairs(params.border_slope));
  for (std::size_t i = 0; i < regions.size(); ++i) {
    SplitLabel& label = regions[i].label;
    if (!Reached(label)) continue;
    const std::size_t whole = WholeOf(regions, static_cast<int>(i));
    label.curvature = static_cast<std::int8_t>(is_basin[whole] ? 1 : is_no_mountain[whole] ? 0 : -1);
    label.steep = is_steep[whole];
  }
}

struct Node {
  SplitLabel label;
  double area = 0.0;
  double curvature = 0.0;
  int summit = 0, pit = 0;
  double open_border = 0.0;
  std::map<int, double> border = {};  // neighbour -> common length
  bool alive = true;
  bool large = false;  // it was neither too small nor too narrow when it was queued

  // True if the two nodes form one region when they are neighbours.
  bool Like(const Node& other) const {
    return label == other.label && (!(label.curvature < 0) || summit == other.summit) &&
           (!(label.curvature > 0) || pit == other.pit);
  }
  double Width() const {
    double length = open_border;
    for (const auto& [other, common] : border) length += common;
    return length > 0.0 ? 2.0 * area / length : kInfinity;
  }
};

class Merger {
 public:
  Merger(const std::vector<RawRegion>& raw, const std::vector<RawContact>& contacts,
         const MergeParams& params)
      : params_(params), parent_(raw.size()) {
    for (std::size_t i = 0; i < raw.size(); ++i) {
      parent_[i] = static_cast<int>(i);
      nodes_.push_back(
          {raw[i].label, raw[i].area, raw[i].curvature, raw[i].summit, raw[i].pit, raw[i].open_border});
      if (Reached(raw[i].label)) ++reached_;
    }
    for (const RawContact& c : contacts) {
      if (c.a == c.b) continue;
      nodes_[static_cast<std::size_t>(c.a)].border[c.b] += c.length;
      nodes_[static_cast<std::size_t>(c.b)].border[c.a] += c.length;
    }
  }

  MergedRegions Run() {
    for (std::size_t i = 0; i < nodes_.size(); ++i) FuseEqual(static_cast<int>(i));
    AbsorbSlivers();
    for (Node& node : nodes_) Neutralise(node);
    for (std::size_t i = 0; i < nodes_.size(); ++i) FuseEqual(static_cast<int>(i));
    // Regions that are too small or too narrow come first in the queue, by area. A region is queued anew
    // whenever it grows.
    std::set<Place> queue;
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
      if (nodes_[i].alive && Reached(nodes_[i].label)) Queue(static_cast<int>(i), queue);
    }
    while (!queue.empty() && !std::get<0>(*queue.begin())) {
      const int small = std::get<2>(*queue.begin());
      queue.erase(queue.begin());
      const int into = BestNeighbour(small);
      if (into < 0) continue;
      queue.erase(PlaceOf(into));
      Join(into, small);
      FuseEqual(into, &queue);
      Queue(into, queue);
    }
    LumpIslands();
    LimitCount();
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
  using Place = std::tuple<bool, double, int>;  // large enough, area, index
  Place PlaceOf(int i) const {
    const Node& node = nodes_[static_cast<std::size_t>(i)];
    return {node.large, node.area, i};
  }
  void Queue(int i, std::set<Place>& queue) {
    Node& node = nodes_[static_cast<std::size_t>(i)];
    node.large = node.area >= params_.min_area && node.Width() >= params_.min_width;
    queue.insert(PlaceOf(i));
  }

  int Root(int i) {
    while (parent_[static_cast<std::size_t>(i)] != i) i = parent_[static_cast<std::size_t>(i)];
    return i;
  }

  // Joins islands: small reachable regions without reachable neighbours, such as islands in unreachable areas
  // and small sheets. Islands of one label join the largest other region of that label. If there is none they
  // form one region if it is large enough (kIslands). The rest joins the largest region of its slope class,
  // or the largest of all.
  void LumpIslands() {
    const auto is_island = [&](const Node& n) { return n.area < params_.min_area; };
    const auto largest = [&](const auto& fits) {
      int best = -1;
      for (std::size_t i = 0; i < nodes_.size(); ++i) {
        const Node& n = nodes_[i];
        if (!n.alive || !Reached(n.label) || !fits(n)) continue;
        if (best < 0 || n.area > nodes_[static_cast<std::size_t>(best)].area) best = static_cast<int>(i);
      }
      return best;
    };
    std::vector<int> lumps;
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
      const Node& node = nodes_[i];
      if (!node.alive || !Reached(node.label) || !is_island(node)) continue;
      int into = largest([&](const Node& n) { return n.label == node.label && !is_island(n); });
      for (const int lump : lumps) {
        if (into < 0 && nodes_[static_cast<std::size_t>(lump)].label == node.label) into = lump;
      }
      if (into >= 0) {
        Join(into, static_cast<int>(i));
      } else {
        lumps.push_back(static_cast<int>(i));
      }
    }
    for (const int lump : lumps) {
      const Node& node = nodes_[static_cast<std::size_t>(lump)];
      if (node.area >= kIslands * params_.min_area && reached_ <= params_.max_regions) continue;
      int into = largest([&](const Node& n) { return n.label.steep == node.label.steep && !is_island(n); });
      if (into < 0) into = largest([&](const Node& n) { return &n != &node; });
      if (into >= 0) Join(into, lump);
    }
  }

  using Group = std::pair<int, bool>;  // curvature, steep
  Group GroupOf(int i) const { return {At(i).label.curvature, At(i).label.steep}; }
  using ByArea = std::set<std::pair<double, int>>;
  // True if the region has not changed since the entry was made. Other entries are skipped.
  bool Stands(const ByArea::value_type& entry, const Group& group) const {
    return At(entry.second).alive && At(entry.second).area == entry.first && GroupOf(entry.second) == group;
  }

  // While there are too many regions, the smallest joins a neighbour of its slope class. If it has none, it
  // and all regions of its label that are hardly larger (kEqual) join the largest of that label, wherever it
  // is: equal features are one region. Steep regions never join gentle ones, because the passes of the one
  // do not cut the other as well. Cost: O(log n) for each region that is joined.
  void LimitCount() {
    std::map<Group, ByArea> left;
    const auto put = [&](int i) { left[GroupOf(i)].insert({At(i).area, i}); };
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
      if (nodes_[i].alive && Reached(nodes_[i].label)) put(static_cast<int>(i));
    }
    while (reached_ > params_.max_regions) {
      ByArea* alike = nullptr;  // the regions with the label of the smallest one
      for (auto& [group, regions] : left) {
        while (!regions.empty() && !Stands(*regions.begin(), group)) regions.erase(regions.begin());
        while (!regions.empty() && !Stands(*regions.rbegin(), group)) regions.erase(std::prev(regions.end()));
        if (!regions.empty() && (alike == nullptr || *regions.begin() < *alike->begin())) alike = &regions;
      }
      if (alike == nullptr) return;
      const int small = alike->begin()->second;
      alike->erase(alike->begin());  // it is joined below, or nothing can be joined to it
      const Group group = GroupOf(small);
      int into = LongestNeighbour(
          small, [&](const Node& n) { return Reached(n.label) && n.label.steep == group.second; });
      if (into < 0) {
        if (alike->empty()) continue;
        into = alike->rbegin()->second;
        const double equal = kEqual * At(small).area;
        while (!alike->empty() && alike->begin()->first <= equal) {
          const ByArea::value_type entry = *alike->begin();
          alike->erase(alike->begin());
          if (entry.second != into && Stands(entry, group)) Join(into, entry.second);
        }
      }
      Join(into, small);
      FuseEqual(into);
      put(into);
    }
  }

  // Joins all small unreachable regions of one reason, wherever they are.
  void LumpUnreachable() {
    std::map<UnreachableReason, int> first;
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
      const Node& node = nodes_[i];
      if (!node.alive || Reached(node.label) || node.area >= params_.min_area) continue;
      const auto [it, fresh] = first.try_emplace(node.label.reason, static_cast<int>(i));
      if (!fresh) Join(it->second, static_cast<int>(i));
    }
  }

  void Neutralise(Node& node) const {
    if (Reached(node.label) && std::abs(node.curvature) < params_.min_curvature) node.label.curvature = 0;
  }

  // Joins unreachable slivers to an unreachable neighbour. Slivers arise where the limits of two reasons
  // coincide within the tolerance of their lines.
  void AbsorbSlivers() {
    std::set<std::pair<double, int>> slivers;
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
      const Node& node = nodes_[i];
      if (node.alive && !Reached(node.label) && node.Width() < params_.sliver)
        slivers.insert({node.area, static_cast<int>(i)});
    }
    for (const auto& [area, sliver] : slivers) {
      if (!At(sliver).alive) continue;
      const int into = LongestNeighbour(sliver, [](const Node& n) { return !Reached(n.label); });
      if (into < 0) continue;
      Join(into, sliver);
      FuseEqual(into);
    }
  }

  const Node& At(int i) const { return nodes_[static_cast<std::size_t>(i)]; }

  // The neighbour with the longest common border among those that fit; -1 if none fits.
  template <class Fits>
  int LongestNeighbour(int i, const Fits& fits) const {
    int best = -1;
    double longest = 0.0;
    for (const auto& [other, length] : At(i).border) {
      if (length <= longest || !fits(At(other))) continue;
      longest = length;
      best = other;
    }
    return best;
  }

  int BestNeighbour(int i) const {
    if (!Reached(At(i).label)) return -1;  // unreachable regions are joined elsewhere, by reason
    return LongestNeighbour(i, [](const Node& n) { return Reached(n.label); });
  }

  // Makes `gone` a part of `into`, which takes the label of the larger part.
  void Join(int into, int gone) {
    Node& a = nodes_[static_cast<std::size_t>(into)];
    Node& b = nodes_[static_cast<std::size_t>(gone)];
    if (b.area > a.area) {
      a.label = b.label;
      a.summit = b.summit;
      a.pit = b.pit;
    }
    a.area += b.area;
    a.curvature += b.curvature;
    a.open_border += b.open_border;
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
    if (Reached(b.label)) --reached_;
    parent_[static_cast<std::size_t>(gone)] = into;
  }

  void FuseEqual(int i, std::set<Place>* queue = nullptr) {
    if (!nodes_[static_cast<std::size_t>(i)].alive) return;
    for (bool again = true; again;) {
      again = false;
      for (const auto& [other, length] : nodes_[static_cast<std::size_t>(i)].border) {
        if (nodes_[static_cast<std::size_t>(other)].Like(nodes_[static_cast<std::size_t>(i)])) {
          if (queue != nullptr) queue->erase(PlaceOf(other));
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
  int reached_ = 0;  // number of reachable nodes that are alive
};

}  // namespace

MergedRegions MergeRegions(const std::vector<RawRegion>& raw, const std::vector<RawContact>& contacts,
                           const MergeParams& params) {
  std::vector<RawRegion> labelled = raw;
  Relabel(contacts, params, labelled);
  return Merger(labelled, contacts, params).Run();
}

}  // namespace patchmill
