// Which triangles lie beside each other: within a piece, and across the common borders of pieces.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include <absl/status/statusor.h>

#include "cam/region/split/split_mesh.h"
#include "core/base/run_context.h"
#include "core/surface/surface.h"

namespace patchmill {

// A triangle side: triangle `triangle` of piece `piece`, from its vertex `side` to the next one.
struct TriangleSide {
  int piece = 0;
  int triangle = 0;
  int side = 0;
};

// A vertex of a side: its first (0) or its second (1).
inline int VertexOf(const SplitMesh& mesh, const TriangleSide& side, int which) {
  const auto& v = mesh.triangles[static_cast<std::size_t>(side.triangle)].vertex;
  return v[static_cast<std::size_t>((side.side + which) % 3)];
}
inline const ZeroVertex& EndOf(const SplitMesh& mesh, const TriangleSide& side, int which) {
  return mesh.vertices[static_cast<std::size_t>(VertexOf(mesh, side, which))];
}

// A side and what lies beyond it.
struct Adjacency {
  TriangleSide side;
  int other_piece = -1;  // -1: nothing there (open border)
  int other_triangle = -1;
  bool across_seam = false;  // across a piece's border
};

// Every side of every triangle (inner sides twice, once from each triangle), in the order piece, triangle,
// side. Triangles of all pieces are numbered through; those of number n are 3 n, 3 n + 1 and 3 n + 2.
struct AdjacencyList {
  struct Seam {
    std::size_t side = 0;
    int other_piece = 0, other_triangle = 0;
  };
  std::vector<std::size_t> first{0};  // [piece]: triangles before it; and how many there are
  // [triangle][side]: the triangle of the same piece; -1 nothing; -2 - k: across seams[k].
  std::vector<std::array<int, 3>> beside;
  std::vector<Seam> seams;                     // sides rise
  std::vector<std::vector<std::size_t>> into;  // [piece]: sides of the seams that lead into it, rising

  std::size_t size() const { return 3 * beside.size(); }
  std::size_t NumberOf(int piece, int triangle) const {
    return first[static_cast<std::size_t>(piece)] + static_cast<std::size_t>(triangle);
  }
  Adjacency operator[](std::size_t side) const;  // log(pieces)
  // visit(i, side i) for the sides of one piece, rising.
  template <class Visit>
  void VisitPiece(std::size_t piece, const Visit& visit) const {
    for (std::size_t n = first[piece]; n < first[piece + 1]; ++n) {
      for (int s = 0; s < 3; ++s) visit(3 * n + static_cast<std::size_t>(s), Of(piece, n, s));
    }
  }

 private:
  Adjacency Of(std::size_t piece, std::size_t n, int side) const {
    const auto own = static_cast<int>(piece);
    Adjacency a{.side = {own, static_cast<int>(n - first[piece]), side}};
    const int other = beside[n][static_cast<std::size_t>(side)];
    if (other >= 0) {
      a.other_piece = own;
      a.other_triangle = other;
    } else if (other < -1) {
      const Seam& seam = seams[static_cast<std::size_t>(-2 - other)];
      a.other_piece = seam.other_piece;
      a.other_triangle = seam.other_triangle;
      a.across_seam = true;
    }
    return a;
  }
};

// Sides on a piece's border are matched by place: the neighbour is the border side of another piece that
// passes nearest to the middle of this one, within the network's join tolerance plus both sagittas.
// CANCELLED, DEADLINE_EXCEEDED from `run`.
absl::StatusOr<AdjacencyList> FindAdjacency(const Surface& surface, const std::vector<SplitMesh>& meshes,
                                            const RunContext& run);

// The sides of one piece with different regions on them (`region_of[piece][triangle]`), or with nothing
// beyond, rising.
std::vector<std::size_t> BorderSides(const AdjacencyList& adjacency, std::size_t piece,
                                     const std::vector<std::vector<int>>& region_of);

// The sides of the adjacency with different regions on them (`region_of[piece][triangle]`), or with nothing
// beyond, rising. CANCELLED, DEADLINE_EXCEEDED from `run`.
absl::StatusOr<std::vector<std::size_t>> BorderSides(const AdjacencyList& adjacency,
                                                     const std::vector<std::vector<int>>& region_of,
                                                     const RunContext& run);

}  // namespace patchmill
