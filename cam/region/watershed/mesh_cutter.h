// Cuts the triangles of one piece along a curve, edge by edge.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "cam/region/split/split_mesh.h"
#include "cam/region/watershed/vertex_fans.h"

namespace patchmill {

class MeshCutter {
 public:
  // Keeps references. The curves are watershed lines between summits, or between pits if `summits` is false
  // (SplitMesh::Line). A vertex within `snap` mm of a curve becomes a point of the curve.
  MeshCutter(const Piece& piece, SplitMesh& mesh, bool summits, std::span<const ZeroField> fields,
             double snap);

  // The vertex at a point of the piece's border: one within `snap` of p, else a new one on the side that
  // passes nearest to p. nullopt if no side passes within `reach` mm.
  std::optional<int> OnBorder(const Vec3& p, double reach);

  struct Next {
    int vertex = 0;
    bool met = false;  // the vertex lay on a watershed line already, so the curve ends there
  };
  // Follows the curve from the vertex `at` to the place where it leaves the triangles around that vertex.
  // `places` are the next points of the curve in (u,v); of the first `known` of them it is known that they
  // lie in these triangles. Returns the vertex at which the curve leaves the triangles, which may be a new
  // one, and removes the places before it. The side between both vertices becomes a line (SplitMesh::lines)
  // with the removed places. nullopt if the curve has not left the triangles; append more places and call
  // again.
  std::optional<Next> Advance(int at, std::vector<Vec2>& places, std::size_t& known);

  // Makes the side from `at` to `to` a line with the places `between`.
  void Mark(int at, int to, std::vector<Vec2> between);
  // The vertices that are joined to `at` by a side.
  std::vector<int> Around(int at) const;
  bool OnLine(int vertex) const { return on_line_[static_cast<std::size_t>(vertex)]; }

  // Measures the triangles that were cut.
  void Finish(double steep_angle);

 private:
  Vec2 Place(int vertex) const;
  int Split(int a, int b, const Vec2& at);
  int VertexAt(int a, int b, const Vec2& at);

  const Piece& piece_;
  SplitMesh& mesh_;
  const bool summits_;
  std::span<const ZeroField> fields_;
  double snap_;
  VertexFans fans_;
  std::vector<bool> on_line_;  // [vertex]
  std::vector<bool> cut_;      // [triangle]
  std::vector<int> rim_;       // triangles that may have a side on the piece's border, rising
};

}  // namespace patchmill
