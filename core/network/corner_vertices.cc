#include "core/network/corner_vertices.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <unordered_map>

namespace patchmill {
namespace {

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
  std::unordered_map<Cell, int, CellHash> newest;  // vertex made last in a cell
  std::vector<int> previous;                       // vertex made before it in the same cell, or -1
  CornerVertices merged;
  merged.vertex_of.reserve(points.size());
  for (const Vec3& p : points) {
    Cell cell;
    for (int k = 0; k < 3; ++k) {
      cell[static_cast<std::size_t>(k)] =
          static_cast<std::int64_t>(std::floor((p[k] - box.min[k]) / tolerance));
    }
    int found = -1;
    for (int n = 0; n < 27; ++n) {
      const auto it = newest.find({cell[0] + n / 9 - 1, cell[1] + n / 3 % 3 - 1, cell[2] + n % 3 - 1});
      if (it == newest.end()) continue;
      for (int v = it->second; v >= 0; v = previous[static_cast<std::size_t>(v)]) {
        const bool near = (merged.position[static_cast<std::size_t>(v)] - p).norm() <= tolerance;
        if (near && (found < 0 || v < found)) found = v;
      }
    }
    if (found < 0) {
      found = static_cast<int>(merged.position.size());
      merged.position.push_back(p);
      const auto [it, fresh] = newest.emplace(cell, found);
      previous.push_back(fresh ? -1 : it->second);
      it->second = found;
    }
    merged.vertex_of.push_back(found);
  }
  return merged;
}

}  // namespace patchmill
