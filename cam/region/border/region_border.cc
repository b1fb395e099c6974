#include "cam/region/border/region_border.h"

#include <algorithm>

#include "core/base/parallel.h"
#include "core/base/status.h"
#include "core/surface/closest.h"

namespace patchmill {
namespace {

constexpr int kMostHalvings = 8;  // of one gap

// Adds points of the surface between a and b, so dense that chords deviate by at most `tolerance` (mm). Adds
// none where the surface has a gap between a and b.
void AddBetween(const Surface& surface, const Vec3& a, const Vec3& b, double tolerance, int halvings,
                std::vector<Vec3>& out) {
  const double length = (b - a).norm();
  if (halvings == 0 || length <= tolerance) return;
  const auto mid = ClosestToPoint(surface, 0.5 * (a + b), 0.4 * length, 0.1 * tolerance);
  if (!mid || mid->distance <= tolerance) return;
  const Vec3 p = mid->at.p;
  AddBetween(surface, a, p, tolerance, halvings - 1, out);
  out.push_back(p);
  AddBetween(surface, p, b, tolerance, halvings - 1, out);
}

// Joins the directed strands of one region's outline to closed loops. First an end is matched with a start
// within `weld`. Then the open ends that remain are joined to the nearest start, along the surface: where a
// seam is cut differently on its two sides, a side may be missing.
std::vector<std::vector<Vec3>> Chain(const Surface& surface, std::vector<std::vector<Vec3>> strands,
                                     double weld, double tolerance) {
  std::vector<std::vector<Vec3>> loops;
  // Starts are sorted by x, so that an end finds the starts near it fast.
  std::vector<std::size_t> by_x(strands.size());
  for (std::size_t i = 0; i < by_x.size(); ++i) by_x[i] = i;
  std::sort(by_x.begin(), by_x.end(), [&](std::size_t i, std::size_t j) {
    return std::make_pair(strands[i].front().x(), i) < std::make_pair(strands[j].front().x(), j);
  });
  std::vector<bool> used(strands.size(), false);
  const auto follow = [&](const Vec3& end) {
    const auto first = std::lower_bound(by_x.begin(), by_x.end(), end.x() - weld,
                                        [&](std::size_t i, double x) { return strands[i].front().x() < x; });
    std::size_t best = strands.size();
    double nearest = weld;
    for (auto it = first; it != by_x.end() && strands[*it].front().x() <= end.x() + weld; ++it) {
      const double d = (strands[*it].front() - end).norm();
      if (!used[*it] && d <= nearest) {
        nearest = d;
        best = *it;
      }
    }
    return best;
  };
  std::vector<std::vector<Vec3>> open;
  for (std::size_t i = 0; i < strands.size(); ++i) {
    if (used[i]) continue;
    used[i] = true;
    std::vector<Vec3> loop = strands[i];
    for (std::size_t next = follow(loop.back()); next != strands.size(); next = follow(loop.back())) {
      used[next] = true;
      loop.insert(loop.end(), strands[next].begin() + 1, strands[next].end());
      if ((loop.back() - loop.front()).norm() <= weld) break;
    }
    if ((loop.back() - loop.front()).norm() <= weld) {
      loop.pop_back();
      if (loop.size() > 2) loops.push_back(std::move(loop));
    } else {
      open.push_back(std::move(loop));
    }
  }
  // Joins each open end to the nearest open start until the loop's own start is nearest.
  std::vector<bool> taken(open.size(), false);
  for (std::size_t i = 0; i < open.size(); ++i) {
    if (taken[i]) continue;
    taken[i] = true;
    std::vector<Vec3> loop = open[i];
    while (true) {
      double nearest = (loop.front() - loop.back()).norm();
      std::size_t best = open.size();
      for (std::size_t j = i + 1; j < open.size(); ++j) {
        const double d = (open[j].front() - loop.back()).norm();
        if (!taken[j] && d < nearest) {
          nearest = d;
          best = j;
        }
      }
      if (best == open.size()) break;
      taken[best] = true;
      const Vec3 end = loop.back();
      AddBetween(surface, end, open[best].front(), tolerance, kMostHalvings, loop);
      loop.insert(loop.end(), open[best].begin(), open[best].end());
    }
    const Vec3 start = loop.front(), end = loop.back();
    AddBetween(surface, end, start, tolerance, kMostHalvings, loop);
    if (loop.size() > 2) loops.push_back(std::move(loop));
  }
  return loops;
}

}  // namespace

absl::StatusOr<std::vector<std::vector<std::vector<Vec3>>>> RegionBorders(
    const Surface& surface, const AdjacencyList& adjacency, const BorderArcs& arcs,
    const BorderPoints& points, const std::vector<std::vector<RegionId>>& region_of, std::size_t region_count,
    double tolerance, const RunContext& run) {
  std::vector<std::vector<std::vector<Vec3>>> strands(region_count);
  for (std::size_t k = 0; k < arcs.sides.size(); ++k) {
    const Adjacency a = adjacency[arcs.sides[k]];
    const RegionId own =
        region_of[static_cast<std::size_t>(a.side.piece)][static_cast<std::size_t>(a.side.triangle)];
    if (points[k].size() > 2 || points[k].front() != points[k].back())
      strands[own.index()].push_back(points[k]);
  }
  const double weld = std::max(2.0 * surface.network.join_tolerance, 1e-7);
  std::vector<std::vector<std::vector<Vec3>>> borders(region_count);
  PM_RETURN_IF_ERROR(ParallelFor(run, nullptr, region_count, [&](std::size_t i) {
    borders[i] = Chain(surface, std::move(strands[i]), weld, tolerance);
  }));
  return borders;
}

}  // namespace patchmill
