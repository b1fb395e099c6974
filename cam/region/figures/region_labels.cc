#include "cam/region/figures/region_labels.h"

#include <algorithm>
#include <cmath>

#include "core/base/parallel.h"
#include "core/base/status.h"

namespace patchmill {
namespace {

// Each cell whose centre lies in a triangle gets that triangle's label: a region or a component. Other cells
// get `none`. Triangles tile the piece. n is a power of two, so that products with 1 / n are exact.
template <class Id>
std::vector<Id> PieceLabels(const SplitMesh& mesh, const std::vector<Id>& label_of, int n, Id none) {
  const auto size = static_cast<std::size_t>(n * n);
  if (!label_of.empty() &&
      std::all_of(label_of.begin(), label_of.end(), [&](Id id) { return id == label_of.front(); }))
    return std::vector<Id>(size, label_of.front());
  std::vector<Id> labels(size, none);
  const double cell = 1.0 / n;
  const auto cell_at = [&](double x) { return std::clamp(static_cast<int>(x * n), 0, n - 1); };
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    Vec2 q[3], side[3];
    Vec2 low(1, 1), high(0, 0);
    for (std::size_t k = 0; k < 3; ++k) {
      const ZeroVertex& vertex = mesh.vertices[static_cast<std::size_t>(mesh.triangles[t].vertex[k])];
      q[k] = {vertex.u, vertex.v};
      low = low.cwiseMin(q[k]);
      high = high.cwiseMax(q[k]);
    }
    for (int k = 0; k < 3; ++k) side[k] = q[(k + 1) % 3] - q[k];
    const int first = cell_at(low.y()), last = cell_at(high.y());
    for (int i = cell_at(low.x()); i <= cell_at(high.x()); ++i) {
      double across[3];  // the part with u of the cross product of a side and the way to a cell's centre
      for (int k = 0; k < 3; ++k) across[k] = side[k].y() * ((i + 0.5) * cell - q[k].x());
      for (int j = first; j <= last; ++j) {
        const double v = (j + 0.5) * cell;
        const auto left = [&](int k) { return side[k].x() * (v - q[k].y()) - across[k] >= -1e-12; };
        if (left(0) && left(1) && left(2)) labels[static_cast<std::size_t>(i * n + j)] = label_of[t];
      }
    }
  }
  return labels;
}

// Takes a cell for each region that has none.
void GiveCells(const std::vector<SplitMesh>& meshes, const TriangleRegions& triangles, RegionLabels& grid) {
  std::vector<std::size_t> cells_of(triangles.region_count, 0);
  for (const std::vector<RegionId>& labels : grid.labels)
    for (const RegionId id : labels)
      if (id != kNoRegion) ++cells_of[id.index()];
  if (std::none_of(cells_of.begin(), cells_of.end(), [](std::size_t count) { return count == 0; })) return;
  for (std::size_t piece = 0; piece < meshes.size(); ++piece) {
    const std::vector<RegionId>& region_of = triangles.region_of[piece];
    for (std::size_t t = 0; t < region_of.size(); ++t) {
      const RegionId id = region_of[t];
      if (cells_of[id.index()] > 0) continue;
      const Vec2 at = grid.cells * MiddleOf(meshes[piece], t);
      const auto i = std::min(static_cast<int>(at.x()), grid.cells - 1);
      const auto j = std::min(static_cast<int>(at.y()), grid.cells - 1);
      RegionId& label = grid.labels[piece][static_cast<std::size_t>(i * grid.cells + j)];
      if (label != kNoRegion && cells_of[label.index()] == 1) continue;
      if (label != kNoRegion) --cells_of[label.index()];
      label = id;
      cells_of[id.index()] = 1;
    }
  }
}

}  // namespace

absl::StatusOr<RegionLabels> LabelCells(const std::vector<SplitMesh>& meshes,
                                        const TriangleRegions& triangles, const RunContext& run) {
  constexpr double kMaxLabels = 8e6;  // of all pieces together
  constexpr int kMaxCells = 256;      // along each side of a piece
  const auto pieces = static_cast<double>(std::max<std::size_t>(1, meshes.size()));
  RegionLabels grid;
  // A power of two, so that pieces that are halved again and again still end at borders of cells.
  grid.cells = 1;
  while (grid.cells < kMaxCells && 4.0 * grid.cells * grid.cells * pieces <= kMaxLabels) grid.cells *= 2;
  grid.labels.resize(meshes.size());
  const std::vector<RegionId>& region_of_component = triangles.component_region;
  const bool fall_apart = region_of_component.size() > triangles.region_count;
  if (fall_apart) grid.components.resize(meshes.size());
  PM_RETURN_IF_ERROR(ParallelFor(run, nullptr, meshes.size(), [&](std::size_t piece) {
    const SplitMesh& mesh = meshes[piece];
    grid.labels[piece] = PieceLabels(mesh, triangles.region_of[piece], grid.cells, kNoRegion);
    if (fall_apart)
      grid.components[piece] = PieceLabels(mesh, triangles.component_of[piece], grid.cells, kNoComponent);
  }));
  GiveCells(meshes, triangles, grid);
  for (std::size_t piece = 0; piece < grid.components.size(); ++piece) {
    for (std::size_t cell = 0; cell < grid.labels[piece].size(); ++cell) {
      ComponentId& component = grid.components[piece][cell];
      const RegionId label = grid.labels[piece][cell];
      if (component != kNoComponent && region_of_component[component.index()] == label) continue;
      // A cell that a region took counts for the first component of that region.
      const auto first = std::lower_bound(region_of_component.begin(), region_of_component.end(), label);
      component = label == kNoRegion
                      ? kNoComponent
                      : ComponentId(static_cast<std::size_t>(first - region_of_component.begin()));
    }
  }
  return grid;
}

}  // namespace patchmill
