// Finds the summits (or pits) that persist, and the passes between them [regions (3)].
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
  std::vector<MeshVertex> tops;    // persisting summits of each connected sheet that has several of them
  std::vector<MeshVertex> passes;  // highest vertices at which the ways up to two of them meet
};

// The vertices of all meshes as a graph. Vertices that face each other across a seam are neighbours.
class HeightGraph {
 public:
  // CANCELLED and DEADLINE_EXCEEDED from `run`, here and below.
  static absl::StatusOr<HeightGraph> Make(const SplitSurface& split, const RunContext& run);

  // Finds summits for `sign` +1, pits for -1. A summit persists if every way from it to a higher one leads
  // down by at least `persistence` mm [references: edelsbrunner2002]; for pits up and down are exchanged.
  // Each vertex climbs the steepest way to a summit. Vertices from which several summits are climbed to are
  // taken from the highest down. Each joins its summits; all but the highest summit joined so far are the
  // younger ones, and the height above this vertex is their persistence. The highest summit of each sheet
  // always counts. Of the others at most `most` count, those with the largest persistence. Deterministic.
  // Cost: n + m log m for n vertices, m of which join summits.
  absl::StatusOr<HeightExtrema> Find(double sign, double persistence, std::size_t most,
                                     const RunContext& run) const;

 private:
  using Index = std::uint32_t;
  static constexpr Index kNone = UINT32_MAX;

  MeshVertex At(Index i) const;
  // True if a comes before b from the top down; for pits from the bottom up.
  bool Above(Index a, Index b, double sign) const {
    const double za = sign * points_[a].z(), zb = sign * points_[b].z();
    return za > zb || (za == zb && a < b);
  }
  template <class Visit>
  void Neighbours(Index i, const Visit& visit) const {
    for (std::size_t k = first_neighbour_[i]; k < first_neighbour_[i + 1]; ++k) visit(neighbours_[k]);
  }
  Index Steepest(Index i, double sign) const;

  std::vector<std::size_t> first_{0};  // [piece]: number of vertices before it; vertices are numbered through
  std::vector<Vec3> points_;           // [vertex]
  std::vector<std::size_t> first_neighbour_;  // [vertex]: index of its first one in neighbours_; then the end
  std::vector<Index> neighbours_;
  // [vertex]: the neighbour to which the steepest way leads, up [0] and down [1]. The vertex itself if it is
  // a summit (pit), kNone if it has no neighbours.
  std::array<std::vector<Index>, 2> steepest_;
};

}  // namespace patchmill
