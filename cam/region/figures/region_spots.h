// Places spread over some triangles of a split, and close to one of them: where the figures of a region are
// looked for.
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

// Keeps references to all it is given. Deterministic: the places follow an additive recurrence (Roberts'
// R2), one after the other in the order they are asked for.
class RegionSamples {
 public:
  // `triangles`: at least one.
  RegionSamples(const Surface& surface, const std::vector<SplitMesh>& meshes,
                std::span<const TriangleRef> triangles);

  // About `count` places: three quarters in proportion to area, the others to number, as small triangles lie
  // along borders. At least one.
  std::vector<RegionSample> Spread(std::size_t count);

  // That place first, and up to `count` more within `reach` (mm) of it. Cost O(triangles).
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
