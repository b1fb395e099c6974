// Finds which triangles are neighbours, within a piece and across the common borders of pieces.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include <absl/status/statusor.h>

#include "cam/region/split/split_mesh.h"
#include "core/base/run_context.h"
#include "core/surface/surface.h"

namespace patchmill {

// A side of a triangle, from its vertex `side` (0, 1, 2) to the next one.
struct TriangleSide {
  int piece = 0;
  int triangle = 0;
  int side = 0;
};

// The first (which = 0) or second (1) vertex of a side.
inline int VertexOf(const SplitMesh& mesh, const TriangleSide& side, int which) {
  const auto& v = mesh.triangles[static_cast<std::size_t>(side.triangle)].vertex;
  return v[static_cast<std::size_t>((side.side + which) % 3)];
}
inline const ZeroVertex& EndOf(const SplitMesh& mesh, const TriangleSide& side, int which) {
  return mesh.vertices[static_cast<std::size_t>(VertexOf(mesh, side, which))];
}

// A side and the triangle beyond it.
struct Adjacency {
  TriangleSide side;
  int other_piece = -1;  // -1: there is none, the side is an open edge
  int other_triangle = -1;
  bool across_seam = false;  // the side lies on the border of its piece
};

// Every side of every triangle, in the order piece, triangle, side. Inner sides come twice, once from each
// triangle. Triangles of all pieces are numbered through; triangle n has the sides 3 n, 3 n + 1 and 3 n + 2.
struct AdjacencyList {
  struct Seam {
    std::size_t side = 0;
    int other_piece = 0, other_triangle = 0;
  };
  std::vector<std::size_t> first{0};  // [piece]: number of triangles before it; then the number of all
  // [triangle][side]: the neighbour in the same piece; -1 if there is none; -2 - k if it is across seams[k].
  std::vector<std::array<int, 3>> beside;
  std::vector<Seam> seams;                     // by rising sides
  std::vector<std::vector<std::size_t>> into;  // [piece]: sides of the seams that lead into it, rising

  std::size_t size() const { return 3 * beside.size(); }
  std::size_t NumberOf(int piece, int triangle) const {
    return first[static_cast<std::size_t>(piece)] + static_cast<std::size_t>(triangle);
  }
  Adjacency operator[](std::size_t side) const;  // cost: log(pieces)
  // Calls visit(i, side i) for the sides of one piece, rising.
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

// A surface split into triangles. It goes from stage to stage as a value: a stage that changes the meshes
// takes it and returns a new one.
struct SplitSurface {
  const Surface* surface = nullptr;  // must outlive this value; never null after JoinMeshes
  std::vector<SplitMesh> meshes;     // [piece]
  AdjacencyList adjacency;           // of the sides of the meshes
};

// Finds the neighbours of all triangles. meshes[piece] covers that piece of the surface.
//
// Sides on the border of a piece are matched by their places in space. The neighbour of such a side is the
// border side that passes nearest to its middle, at most at the network's join tolerance plus twice the
// sagittas of both sides. It may belong to the same piece if the piece is closed. CANCELLED and
// DEADLINE_EXCEEDED from `run`.
absl::StatusOr<SplitSurface> JoinMeshes(const Surface& surface, std::vector<SplitMesh> meshes,
                                        const RunContext& run);

// The sides of one piece that lie between triangles of different labels (regions or raw regions) or on an
// open edge, rising.
template <class Label>
std::vector<std::size_t> BorderSides(const AdjacencyList& adjacency, std::size_t piece,
                                     const PerTriangle<Label>& label_of) {
  const auto label = [&](int of, int triangle) {
    return label_of[static_cast<std::size_t>(of)][static_cast<std::size_t>(triangle)];
  };
  std::vector<std::size_t> sides;
  adjacency.VisitPiece(piece, [&](std::size_t i, const Adjacency& a) {
    if (a.other_piece < 0 || label(a.side.piece, a.side.triangle) != label(a.other_piece, a.other_triangle)) {
      sides.push_back(i);
    }
  });
  return sides;
}

}  // namespace patchmill
