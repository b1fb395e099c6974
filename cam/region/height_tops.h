// Summits that stand out, and the passes between what drains to them (ALGORITHMS 4: multiple peaks).
#pragma once

#include <vector>

#include <absl/status/statusor.h>

#include "cam/region/seams.h"
#include "core/base/run_context.h"

namespace patchmill {

struct MeshVertex {
  int piece = 0, vertex = 0;
};

struct HeightTops {
  std::vector<MeshVertex> tops;    // of every connected sheet with several that persist
  std::vector<MeshVertex> passes;  // where what climbs to one of them first meets what climbs to another
};

// The vertices of all meshes as a graph; those that face each other across a seam are joined.
class HeightGraph {
 public:
  // CANCELLED, DEADLINE_EXCEEDED from `run`, here and below.
  static absl::StatusOr<HeightGraph> Make(const std::vector<SplitMesh>& meshes,
                                          const std::vector<Adjacency>& adjacency, const RunContext& run);

  // Summits for `sign` +1, pits for -1. One persists when the way from it to a higher one (lower, for pits)
  // leads down (up) by at least `persistence` mm: vertices from the highest down, each joined with its higher
  // neighbours; where two summits meet the lower one is the younger (Edelsbrunner, Letscher and Zomorodian
  // 2002). Deterministic; cost n log n.
  // `most`: of those beside the highest of each sheet, as many that persist longest.
  absl::StatusOr<HeightTops> Find(double sign, double persistence, std::size_t most,
                                  const RunContext& run) const;

 private:
  HeightGraph(const std::vector<SplitMesh>& meshes, const std::vector<Adjacency>& adjacency,
              const RunContext& run);
  MeshVertex At(std::size_t i) const;
  template <class Visit>
  void Neighbours(std::size_t i, const Visit& visit) const {
    for (std::size_t k = first_neighbour_[i]; k < first_neighbour_[i + 1]; ++k) visit(neighbours_[k]);
  }

  std::vector<std::size_t> first_;  // vertices of all meshes numbered through
  std::vector<Vec3> points_;
  std::vector<std::size_t> first_neighbour_, neighbours_;
};

}  // namespace patchmill
