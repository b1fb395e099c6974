// Summits that stand out, and the passes between what drains to them ([regions (3)]).
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <absl/status/statusor.h>

#include "cam/region/split/seams.h"
#include "core/base/run_context.h"

namespace patchmill {

struct MeshVertex {
  int piece = 0, vertex = 0;
};

struct HeightExtrema {
  std::vector<MeshVertex> tops;    // of every connected sheet with several that persist
  std::vector<MeshVertex> passes;  // where what climbs to one of them first meets what climbs to another
};

// The vertices of all meshes as a graph; those that face each other across a seam are joined.
class HeightGraph {
 public:
  // CANCELLED, DEADLINE_EXCEEDED from `run`, here and below.
  static absl::StatusOr<HeightGraph> Make(const std::vector<SplitMesh>& meshes,
                                          const AdjacencyList& adjacency, const RunContext& run);

  // Summits for `sign` +1, pits for -1. One persists when the way from it to a higher one (lower, for pits)
  // leads down (up) by at least `persistence` mm [references: edelsbrunner2002]: every vertex
  // climbs the steepest way; where several summits are climbed to from one vertex, highest such vertices
  // first, they are joined, and all but the highest of those joined so far are the younger ones.
  // Deterministic; cost n, and m log m of the m vertices where summits meet.
  // `most`: of those beside the highest of each sheet, as many that persist longest.
  absl::StatusOr<HeightExtrema> Find(double sign, double persistence, std::size_t most,
                                     const RunContext& run) const;

 private:
  using Index = std::uint32_t;
  static constexpr Index kNone = UINT32_MAX;

  MeshVertex At(Index i) const;
  // Which of two comes first from the top down: for pits from the bottom up.
  bool Above(Index a, Index b, double sign) const {
    const double za = sign * points_[a].z(), zb = sign * points_[b].z();
    return za > zb || (za == zb && a < b);
  }
  template <class Visit>
  void Neighbours(Index i, const Visit& visit) const {
    for (std::size_t k = first_neighbour_[i]; k < first_neighbour_[i + 1]; ++k) visit(neighbours_[k]);
  }
  Index Steepest(Index i, double sign) const;

  std::vector<std::size_t> first_{0};  // vertices of all meshes numbered through
  std::vector<Vec3> points_;
  std::vector<std::size_t> first_neighbour_;
  std::vector<Index> neighbours_;
  // Where the steepest way leads, up [0] and down [1]; to itself from a summit, kNone without neighbours.
  std::array<std::vector<Index>, 2> steepest_;
};

}  // namespace patchmill
