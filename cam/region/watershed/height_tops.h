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
  std::vector<MeshVertex> tops;  // persisting summits of each connected sheet that has several of them
  std::vector<MeshVertex>
      passes;  // for each pair that meets: the highest vertex at which ways up to both meet
};

// The vertices of all meshes as a graph. Vertices that face each other across a seam are neighbours.
class HeightGraph {
 public:
  // CANCELLED and DEADLINE_EXCEEDED from `run`, here and below.
  static absl::StatusOr<HeightGraph> Make(const SplitSurface& split, const RunContext& run);

  // Finds the summits that persist for `sign` +1, the pits for -1. A summit persists if every way from it to
  // a higher summit leads down by at least `persistence` mm [references: edelsbrunner2002]. For pits up and
  // down are exchanged.
  //
  // From each vertex the steepest way up leads to a summit. A vertex next to ways to several summits is a
  // pass between these. Passes are taken from the highest down. Each joins its summits to one set; of the
  // summits that it joins the highest lives on, and for each other one its height above the pass is its
  // persistence. The highest summit of each connected sheet always counts. Of the others the `most` with the
  // largest persistence count. Deterministic. Cost: n + m log m for n vertices with m passes.
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
