// Finds groups of triangles that are connected across some of their sides.
#pragma once

#include <cstddef>
#include <utility>

#include <absl/status/statusor.h>

#include "cam/region/split/seams.h"
#include "core/base/parallel.h"
#include "core/base/status.h"
#include "core/base/union_find.h"

namespace patchmill {

// Joins the triangles of all pieces (by their numbers in the adjacency) across every side for which
// joins(adjacency) is true. Each inner side is asked once, from the triangle with the lower number; a seam is
// asked from both sides. `joins` is called by several threads. Each piece is joined by itself first, then all
// seams. CANCELLED and DEADLINE_EXCEEDED from `run`.
template <class Joins>
absl::StatusOr<UnionFind> JoinAcross(const AdjacencyList& adjacency, const RunContext& run,
                                     const Joins& joins) {
  UnionFind sets(adjacency.beside.size());
  PM_RETURN_IF_ERROR(ParallelFor(run, nullptr, adjacency.first.size() - 1, [&](std::size_t piece) {
    adjacency.VisitPiece(piece, [&](std::size_t, const Adjacency& a) {
      if (a.across_seam || a.other_triangle <= a.side.triangle || !joins(a)) return;
      sets.Join(adjacency.first[piece] + static_cast<std::size_t>(a.side.triangle),
                adjacency.first[piece] + static_cast<std::size_t>(a.other_triangle));
    });
  }));
  for (const AdjacencyList::Seam& seam : adjacency.seams) {
    if (joins(adjacency[seam.side]))
      sets.Join(seam.side / 3, adjacency.NumberOf(seam.other_piece, seam.other_triangle));
  }
  return sets;
}

}  // namespace patchmill
