// Points spread over the regions of a map, and how passes run there.
#pragma once

#include <algorithm>
#include <cmath>

#include "cam/plan/job.h"
#include "core/diffgeo/forms.h"
#include "core/surface/surface.h"

namespace patchmill {

inline constexpr double kMostRegionPoints = 200'000;

inline bool ByContours(const RegionChoice& choice, const Region& region) {
  return choice.strategy == Strategy::kContour ||
         (choice.strategy == Strategy::kAuto && region.slope == SlopeClass::kSteep);
}

// In which direction in plan lines run; unit vectors.
inline Vec2 StraightLine(double angle) { return {std::cos(angle), std::sin(angle)}; }
inline Vec2 CircleTangentAt(const CircularLines& around, const Vec2& p) {
  const Vec2 out = p - around.center;
  return Vec2(-out.y(), out.x()).normalized();
}

// At p of a component of the region.
inline Vec2 LineAt(const RegionChoice& choice, ComponentId component, const Vec3& p) {
  const auto circles =
      std::lower_bound(choice.around.begin(), choice.around.end(), component,
                       [](const CircularComponent& round, ComponentId of) { return round.component < of; });
  if (circles == choice.around.end() || circles->component != component)
    return StraightLine(choice.zigzag_angle);
  return CircleTangentAt(circles->lines, Xy(p));
}

// Every how many cells of the map a point is taken, each way.
inline int StrideOf(const RegionMap& map) {
  const double points = static_cast<double>(map.cells) * map.cells * static_cast<double>(map.labels.size());
  return std::clamp(static_cast<int>(std::ceil(std::sqrt(points / kMostRegionPoints))), 1,
                    std::max(1, map.cells));
}

// Strides need not divide the cells: every point stands for an equal share of its piece.
inline double ShareOfPoint(const RegionMap& map, int stride) {
  const int points = (map.cells - stride / 2 + stride - 1) / stride;
  return 1.0 / (static_cast<double>(points) * points);
}

// Calls visit(region id, cell, jet, upward unit normal) at the points of a piece that `wanted(region id)`.
template <class Wanted, class Visit>
void VisitPiece(const Surface& surface, std::size_t piece, const RegionMap& map, int stride,
                const Wanted& wanted, const Visit& visit) {
  for (int i = stride / 2; i < map.cells; i += stride) {
    for (int j = stride / 2; j < map.cells; j += stride) {
      const auto cell = static_cast<std::size_t>(i * map.cells + j);
      const RegionId id = map.labels[piece][cell];
      if (id == kNoRegion || !wanted(id)) continue;
      const SurfaceJet jet = Evaluate(surface.pieces[piece], (i + 0.5) / map.cells, (j + 0.5) / map.cells);
      if (const auto e = UpwardNormal(jet)) visit(id, cell, jet, *e);
    }
  }
}

}  // namespace patchmill
