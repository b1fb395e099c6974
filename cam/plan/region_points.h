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

// A point of a region.
struct RegionPoint {
  RegionId region;
  std::size_t cell = 0;  // of the map, in its piece
  SurfaceJet jet;
  Vec3 normal = Vec3::UnitZ();  // unit, upward
};

// The points in the middle of every so many cells of a map, each way. Keeps references to surface and map.
class RegionPoints {
 public:
  RegionPoints(const Surface& surface, const RegionMap& map) : RegionPoints(surface, map, StrideOf(map)) {}
  // `stride` is a number of cells, at least 1.
  RegionPoints(const Surface& surface, const RegionMap& map, int stride)
      : surface_(surface), map_(map), stride_(stride) {}

  const Surface& surface() const { return surface_; }
  const RegionMap& map() const { return map_; }
  int stride() const { return stride_; }

  // The share of its piece's parameters that a point stands for. Strides need not divide the cells: every
  // point stands for an equal share.
  double Share() const {
    const int points = (map_.cells - stride_ / 2 + stride_ - 1) / stride_;
    return 1.0 / (static_cast<double>(points) * points);
  }

  // Calls visit(point) at the points of a piece in regions for which wanted(region id) is true. Points
  // without a normal are left out.
  template <class Wanted, class Visit>
  void VisitPiece(std::size_t piece, const Wanted& wanted, const Visit& visit) const {
    const int n = map_.cells;
    for (int i = stride_ / 2; i < n; i += stride_) {
      for (int j = stride_ / 2; j < n; j += stride_) {
        const auto cell = static_cast<std::size_t>(i * n + j);
        const RegionId id = map_.labels[piece][cell];
        if (id == kNoRegion || !wanted(id)) continue;
        const SurfaceJet jet = Evaluate(surface_.pieces[piece], (i + 0.5) / n, (j + 0.5) / n);
        if (const auto e = UpwardNormal(jet)) visit(RegionPoint{id, cell, jet, *e});
      }
    }
  }

 private:
  const Surface& surface_;
  const RegionMap& map_;
  const int stride_;
};

}  // namespace patchmill
