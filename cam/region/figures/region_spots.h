// Samples a region, that is some triangles of a split: places spread over it, or close to one place. The
// figures of a region are measured there.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "cam/region/split/split_mesh.h"

namespace patchmill {

// A place inside a triangle.
struct RegionSample {
  TriangleRef triangle;
  Vec2 uv = Vec2::Zero();
};

// Keeps references to all arguments of its constructor. Deterministic: places follow an additive recurrence
// (Roberts' R2) in the order of the calls.
class RegionSamples {
 public:
  // `triangles` must not be empty.
  RegionSamples(const Surface& surface, const std::vector<SplitMesh>& meshes,
                std::span<const TriangleRef> triangles);

  // About `count` places, at least one. Three quarters of them are spread in proportion to the area of the
  // triangles. The others are spread in proportion to their number, because small triangles lie along
  // borders.
  std::vector<RegionSample> Spread(std::size_t count);

  // The place `from` itself first, then up to `count` more within `reach` (mm) of it. Cost: O(triangles).
  std::vector<RegionSample> Around(const RegionSample& from, double reach, std::size_t count);

 private:
  Vec3 At(const RegionSample& spot) const;
  Vec2 Inside(const TriangleRef& t);
  double Distance(const TriangleRef& t, const Vec3& p) const;

  const Surface& surface_;
  const std::vector<SplitMesh>& meshes_;
  const std::span<const TriangleRef> triangles_;
  double a_ = 0.5, b_ = 0.5;
};

}  // namespace patchmill
