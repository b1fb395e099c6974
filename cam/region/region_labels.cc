#include "cam/region/region_labels.h"

#include <algorithm>
#include <cmath>

#include "core/base/parallel.h"

namespace patchmill {
namespace {

// Every cell whose centre lies in a triangle gets that triangle's region.
std::vector<int> PieceLabels(const SplitMesh& mesh, const std::vector<int>& region_of, int n) {
  std::vector<int> labels(static_cast<std::size_t>(n * n), -1);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    Vec2 q[3];
    Vec2 low(1, 1), high(0, 0);
    for (std::size_t k = 0; k < 3; ++k) {
      const ZeroVertex& vertex = mesh.vertices[static_cast<std::size_t>(mesh.triangles[t].vertex[k])];
      q[k] = {vertex.u, vertex.v};
      low = low.cwiseMin(q[k]);
      high = high.cwiseMax(q[k]);
    }
    const auto cell = [&](double x) { return std::clamp(static_cast<int>(x * n), 0, n - 1); };
    for (int i = cell(low.x()); i <= cell(high.x()); ++i) {
      for (int j = cell(low.y()); j <= cell(high.y()); ++j) {
        const Vec2 c((i + 0.5) / n, (j + 0.5) / n);
        bool inside = true;
        for (int k = 0; k < 3; ++k) inside = inside && Cross(q[(k + 1) % 3] - q[k], c - q[k]) >= -1e-12;
        if (inside) labels[static_cast<std::size_t>(i * n + j)] = region_of[t];
      }
    }
  }
  return labels;
}

}  // namespace

absl::Status FillLabels(const std::vector<SplitMesh>& meshes, const std::vector<std::vector<int>>& region_of,
                        const RunContext& run, RegionMap& map) {
  constexpr double kMaxLabels = 8e6;
  constexpr int kMaxCells = 256;
  const auto pieces = static_cast<double>(std::max<std::size_t>(1, meshes.size()));
  // A power of two: halves of pieces, halved again and again, end with whole cells.
  map.cells = 1;
  while (map.cells < kMaxCells && 4.0 * map.cells * map.cells * pieces <= kMaxLabels) map.cells *= 2;
  map.labels.resize(meshes.size());
  return ParallelFor(run, nullptr, meshes.size(), [&](std::size_t piece) {
    map.labels[piece] = PieceLabels(meshes[piece], region_of[piece], map.cells);
  });
}

}  // namespace patchmill
