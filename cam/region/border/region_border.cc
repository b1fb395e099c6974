#include "cam/region/border/region_border.h"

#include <algorithm>

#include "core/base/parallel.h"
#include "core/base/status.h"
#include "core/surface/closest.h"

namespace patchmill {
namespace {

constexpr int kMostHalvings = 8;  // of one gap

// Adds points of the surface between two points of it.
class GapPoints {
 public:
  // The points are so dense that chords deviate by at most `tolerance` (mm).
  GapPoints(const Surface& surface, double tolerance) : surface_(surface), tolerance_(tolerance) {}

  // Adds none where the surface has a gap between a and b.
  void Add(const Vec3& a, const Vec3& b, std::vector<Vec3>& out) const { Add(a, b, kMostHalvings, out); }

 private:
  void Add(const Vec3& a, const Vec3& b, int halvings, std::vector<Vec3>& out) const {
    const double length = (b - a).norm();
    if (halvings == 0 || length <= tolerance_) return;
    const auto mid = ClosestToPoint(surface_, 0.5 * (a + b), 0.4 * length, 0.1 * tolerance_);
    if (!mid || mid->distance <= tolerance_) return;
    const Vec3 p = mid->at.p;
    Add(a, p, halvings - 1, out);
    out.push_back(p);
    Add(p, b, halvings - 1, out);
  }

  const Surface& surface_;
  const double tolerance_;
};

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
  const GapPoints gap(surface, tolerance);
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
      gap.Add(end, open[best].front(), loop);
      loop.insert(loop.end(), open[best].begin(), open[best].end());
    }
    const Vec3 start = loop.front(), end = loop.back();
    gap.Add(end, start, loop);
    if (loop.size() > 2) loops.push_back(std::move(loop));
  }
  return loops;
}

}  // namespace

absl::StatusOr<std::vector<std::vector<std::vector<Vec3>>>> RegionBorders(const SplitSurface& split,
                                                                          const TriangleRegions& triangles,
                                                                          const BorderPoints& border,
                                                                          double tolerance,
                                                                          const RunContext& run) {
  std::vector<std::vector<std::vector<Vec3>>> strands(triangles.region_count);
  for (std::size_t k = 0; k < border.sides.size(); ++k) {
    const TriangleSide side = split.adjacency[border.sides[k]].side;
    const RegionId own =
        triangles.region_of[static_cast<std::size_t>(side.piece)][static_cast<std::size_t>(side.triangle)];
    const std::vector<Vec3>& points = border.points[k];
    if (points.size() > 2 || points.front() != points.back()) strands[own.index()].push_back(points);
  }
  const double weld = std::max(2.0 * split.surface->network.join_tolerance, 1e-7);
  std::vector<std::vector<std::vector<Vec3>>> borders(strands.size());
  PM_RETURN_IF_ERROR(ParallelFor(run, nullptr, borders.size(), [&](std::size_t i) {
    borders[i] = Chain(*split.surface, std::move(strands[i]), weld, tolerance);
  }));
  return borders;
}

}  // namespace patchmill
