#include "core/network/corner_vertices.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <unordered_map>

namespace patchmill {
namespace {

// In tolerances. It is so wide that most points look into one or two cells, and so small that vertices, which
// are a tolerance apart, cannot crowd in one.
constexpr double kCellWidth = 8.0;

using Cell = std::array<std::int64_t, 3>;

struct CellHash {
  std::size_t operator()(const Cell& c) const {
    std::uint64_t h = 0;
    for (const std::int64_t k : c) {
      h ^= static_cast<std::uint64_t>(k) + 0x9e3779b97f4a7c15ull + (h << 6) + (h >> 2);
      h *= 0xff51afd7ed558ccdull;
      h ^= h >> 32;
    }
    return h;
  }
};

}  // namespace

CornerVertices MergeCorners(const std::vector<Vec3>& points, double tolerance) {
  Box3 box;
  for (const Vec3& p : points) box.Add(p);
  const double width = kCellWidth * tolerance;
  std::unordered_map<Cell, int, CellHash> newest;  // vertex made last in a cell
  newest.reserve(points.size() / 2);
  std::vector<int> previous;  // vertex made before it in the same cell, or -1
  CornerVertices merged;
  merged.vertex_of.reserve(points.size());
  const auto cell_of = [&](const Vec3& p) {
    const Vec3 c = (p - box.min) / width;
    return Cell{static_cast<std::int64_t>(std::floor(c.x())), static_cast<std::int64_t>(std::floor(c.y())),
                static_cast<std::int64_t>(std::floor(c.z()))};
  };
  for (const Vec3& p : points) {
    const Cell lo = cell_of(p - Vec3::Constant(tolerance)), hi = cell_of(p + Vec3::Constant(tolerance));
    int found = -1;
    Cell cell;
    for (cell[0] = lo[0]; cell[0] <= hi[0]; ++cell[0]) {
      for (cell[1] = lo[1]; cell[1] <= hi[1]; ++cell[1]) {
        for (cell[2] = lo[2]; cell[2] <= hi[2]; ++cell[2]) {
          const auto it = newest.find(cell);
          if (it == newest.end()) continue;
          for (int v = it->second; v >= 0; v = previous[static_cast<std::size_t>(v)]) {
            const bool near = (merged.position[static_cast<std::size_t>(v)] - p).norm() <= tolerance;
            if (near && (found < 0 || v < found)) found = v;
          }
        }
      }
    }
    if (found < 0) {
      found = static_cast<int>(merged.position.size());
      merged.position.push_back(p);
      const auto [it, fresh] = newest.emplace(cell_of(p), found);
      previous.push_back(fresh ? -1 : it->second);
      it->second = found;
    }
    merged.vertex_of.push_back(found);
  }
  return merged;
}

}  // namespace patchmill
