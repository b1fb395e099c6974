#include "core/network/open_edges.h"

#include <algorithm>
#include <cstdint>

#include "core/base/index.h"
#include "core/spatial/box_tree.h"

namespace patchmill {
namespace {

// Number of candidates that may be examined. Finding a foot costs as much as examining twenty. Hostile models
// reach this limit after seconds; real ones never come near it.
constexpr std::int64_t kSearchBudget = 20'000'000;
constexpr std::int64_t kFootCost = 20;

// Holds the open edges in a tree and the rest of the budget. Slots are indices into `open_`.
class Search {
 public:
  Search(const EdgeCurves& curves, const std::vector<EdgeEnds>& ends, const std::vector<int>& open,
         double tolerance, const RunContext& run)
      : curves_(curves),
        ends_(ends),
        open_(open),
        tolerance_(tolerance),
        run_(run),
        tree_(Boxes(curves, open)) {}

  void FindTJunctions(OpenEdgeReport& report);
  void FindGaps(double gap_limit, OpenEdgeReport& report);
  bool exhausted() const { return budget_ <= 0; }

 private:
  bool Stop() const { return exhausted() || run_.Cancelled(); }
  static std::vector<Box3> Boxes(const EdgeCurves& curves, const std::vector<int>& open) {
    std::vector<Box3> boxes;
    boxes.reserve(open.size());
    for (const int e : open) boxes.push_back(curves.box(e));
    return boxes;
  }
  // Calls visit(edge) for the open edges near p until it returns false or the search must end.
  template <class Visit>
  void Near(const Vec3& p, double reach, const Visit& visit) {
    tree_.Near(p, reach, [&](int slot) { return --budget_ > 0 && visit(open_[At(slot)]); });
  }
  bool LiesOn(const Vec3& p, int e) {
    budget_ -= kFootCost;
    return ClosestOnEdge(curves_, e, p).distance <= tolerance_;
  }
  bool HasEnd(int e, int vertex) const { return ends_[At(e)].start == vertex || ends_[At(e)].end == vertex; }
  void MarkVertex(int vertex, const Vec3& p, std::vector<bool>& touched, std::vector<bool>& suspects);
  void Cover(int e, OpenEdgeReport& report, std::vector<std::vector<int>>& along);

  const EdgeCurves& curves_;
  const std::vector<EdgeEnds>& ends_;
  const std::vector<int>& open_;
  double tolerance_;
  const RunContext& run_;
  BoxTree tree_;
  std::int64_t budget_ = kSearchBudget;
};

// Marks the open edges whose inside `vertex` touches as suspects, and the vertex as touched.
void Search::MarkVertex(int vertex, const Vec3& p, std::vector<bool>& touched, std::vector<bool>& suspects) {
  Near(p, tolerance_, [&](int f) {
    if (HasEnd(f, vertex) || !LiesOn(p, f)) return true;
    touched[At(vertex)] = true;
    suspects[At(f)] = true;
    return true;
  });
}

// Finds out whether every point of edge e lies on some other open edge. If one edge alone covers e, e lies
// along it.
void Search::Cover(int e, OpenEdgeReport& report, std::vector<std::vector<int>>& along) {
  const std::span<const Vec3> samples = curves_.samples(e);
  const double steps = static_cast<double>(samples.size() - 1);
  int single = -1;  // covers all points so far
  bool several = false;
  for (std::size_t i = 0; i < 2 * samples.size() - 1; ++i) {
    const Vec3 p = i % 2 == 0 ? samples[i / 2] : curves_.Point(e, 0.5 * static_cast<double>(i) / steps);
    if (single >= 0 && LiesOn(p, single)) continue;
    // At an end any edge through the corner would do. Inner points show which edge runs along e.
    const bool at_end = i == 0 || i + 1 == 2 * samples.size() - 1;
    int found = -1;
    Near(p, tolerance_, [&](int f) {
      if (f == e || !LiesOn(p, f)) return true;
      found = f;
      return false;
    });
    if (found < 0) return;
    if (at_end) continue;
    several = several || single >= 0;
    single = found;
  }
  report.covered[At(e)] = true;
  // The corners may lie beyond the end of `single`, by less than the distance of two points.
  if (!several && single >= 0 && LiesOn(samples.front(), single) && LiesOn(samples.back(), single))
    along[At(single)].push_back(e);
}

void Search::FindTJunctions(OpenEdgeReport& report) {
  std::size_t vertices = 0;
  for (const int e : open_) {
    vertices = std::max({vertices, At(ends_[At(e)].start) + 1, At(ends_[At(e)].end) + 1});
  }
  std::vector<bool> seen(vertices), touched(vertices), suspects(At(curves_.count()));
  for (const int e : open_) {
    for (const bool start : {true, false}) {
      const int vertex = start ? ends_[At(e)].start : ends_[At(e)].end;
      if (seen[At(vertex)] || Stop()) continue;
      seen[At(vertex)] = true;
      MarkVertex(vertex, start ? curves_.start(e) : curves_.end(e), touched, suspects);
    }
  }
  std::vector<std::vector<int>> along(At(curves_.count()));
  for (const int e : open_) {
    const bool suspect = suspects[At(e)] || touched[At(ends_[At(e)].start)] || touched[At(ends_[At(e)].end)];
    if (suspect && !Stop()) Cover(e, report, along);
  }
  std::vector<bool> reported(At(curves_.count()));  // a junction with short edges reports this edge
  for (const int e : open_) {
    for (const int f : along[At(e)]) reported[At(f)] = true;
    if (!along[At(e)].empty()) reported[At(e)] = true;
  }
  for (const int e : open_) {
    if (along[At(e)].empty() && (reported[At(e)] || !report.covered[At(e)])) continue;
    report.t_junctions.push_back({e, std::move(along[At(e)])});
  }
}

void Search::FindGaps(double gap_limit, OpenEdgeReport& report) {
  std::vector<bool> used(At(curves_.count()));
  for (const int e : open_) {
    if (used[At(e)] || report.covered[At(e)] || Stop()) continue;
    EdgeGap best{e, -1, false, kInfinity};
    const double reach = std::min(gap_limit, 0.1 * curves_.length(e));
    Near(curves_.start(e), reach, [&](int f) {
      if (f <= e || used[At(f)] || report.covered[At(f)]) return true;
      const double limit = std::min({reach, 0.1 * curves_.length(f), best.distance});
      for (const bool reversed : {false, true}) {
        const Vec3& f_start = reversed ? curves_.end(f) : curves_.start(f);
        const Vec3& f_end = reversed ? curves_.start(f) : curves_.end(f);
        if ((curves_.start(e) - f_start).norm() > limit || (curves_.end(e) - f_end).norm() > limit) continue;
        budget_ -= kFootCost * static_cast<std::int64_t>(curves_.samples(e).size());
        const double distance = EdgeDistance(curves_, e, f, reversed, limit);
        if (distance <= limit && distance < best.distance) best = {e, f, reversed, distance};
      }
      return true;
    });
    if (best.other < 0) continue;
    used[At(e)] = used[At(best.other)] = true;
    report.gaps.push_back(best);
  }
}

}  // namespace

OpenEdgeReport InspectOpenEdges(const EdgeCurves& curves, const std::vector<EdgeEnds>& ends,
                                const std::vector<int>& open, const MeetingLimits& limits,
                                const RunContext& run) {
  OpenEdgeReport report;
  report.covered.assign(At(curves.count()), false);
  Search search(curves, ends, open, limits.tolerance, run);
  search.FindTJunctions(report);
  search.FindGaps(limits.gap, report);
  report.limited = search.exhausted();
  return report;
}

}  // namespace patchmill
