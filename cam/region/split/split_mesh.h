// The triangles of one piece, split along the zero curves and limits of all region fields, measured.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <span>
#include <utility>
#include <vector>

#include "cam/region/split/region_fields.h"

namespace patchmill {

struct SplitTriangle {
  std::array<int, 3> vertex{};  // counter-clockwise in (u,v)
  SplitLabel label;
  // > 0 where the normal of the parametrisation looks up, < 0 where it looks down; 0 out of reach.
  std::int8_t turn = 0;
  double area = 0.0;  // mm^2 on the surface, of the triangle with straight sides in (u,v)
  // Of what is reached; else 0. By the value in the middle of each part that the area is found from, where
  // there is one (none at a summit or a pit).
  double curvature = 0.0;  // integral of kappa_c (upward normal) over it, mm
  double steepness = 0.0;  // integral of slope - steep angle over it, rad mm^2
};

struct SplitMesh {
  std::vector<ZeroVertex> vertices;
  std::vector<SplitTriangle> triangles;
  // Sides along watersheds (watershed_lines.h), by their vertices, the lower number first.
  struct Line {
    std::vector<Vec2> places = {};       // on the true line between the two, from the first to the second
    bool summits = false, pits = false;  // what it divides
  };
  std::map<std::pair<int, int>, Line> lines;
};

// A triangle of the meshes of all pieces.
struct TriangleRef {
  std::size_t piece = 0, triangle = 0;
  bool operator==(const TriangleRef&) const = default;
};

// Parameters of a corner (0, 1, 2) of a triangle, and of its middle.
inline Vec2 CornerOf(const SplitMesh& mesh, std::size_t triangle, std::size_t k) {
  const ZeroVertex& vertex = mesh.vertices[static_cast<std::size_t>(mesh.triangles[triangle].vertex[k])];
  return {vertex.u, vertex.v};
}
inline Vec2 MiddleOf(const SplitMesh& mesh, std::size_t triangle) {
  return (CornerOf(mesh, triangle, 0) + CornerOf(mesh, triangle, 1) + CornerOf(mesh, triangle, 2)) / 3.0;
}

// Two places that lie on one border of the piece.
inline bool AlongBorder(const ZeroVertex& a, const ZeroVertex& b) {
  return (a.u == b.u && (a.u == 0.0 || a.u == 1.0)) || (a.v == b.v && (a.v == 0.0 || a.v == 1.0));
}

// `fields` as RegionFields gives them. `steep_angle` in rad. Areas by a rule of degree 5 on triangles
// whose normals turn by less than 0.35 rad and whose elements of area are close to quadratic, by one of
// degree 2 where they are close to linear: 1e-7 of them.
SplitMesh BuildSplitMesh(const Piece& piece, std::span<const ZeroField> fields, double steep_angle,
                         const ZeroMeshParams& params);

// Area, curvature and steepness of a triangle of these vertices, as BuildSplitMesh has them.
void MeasureTriangle(const Piece& piece, const std::vector<ZeroVertex>& vertices, double steep_angle,
                     SplitTriangle& triangle);

// Area on the surface (mm^2) over a triangle of parameters, positive when counter-clockwise.
double SurfaceArea(const Piece& piece, const Vec2& a, const Vec2& b, const Vec2& c);

}  // namespace patchmill
