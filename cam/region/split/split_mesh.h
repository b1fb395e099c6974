// Splits one piece into triangles along the zero curves and limits of all region fields, and measures them.
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
  // > 0 if the normal of the parametrisation looks up, < 0 if it looks down; 0 if unreachable.
  std::int8_t turn = 0;
  double area = 0.0;  // mm^2 on the surface, of the triangle with straight sides in (u,v)
  // Integrals over the triangle if it is reachable, else 0. The integrand is evaluated in the middle of each
  // part from which the area is computed; it is 0 there at a summit or pit.
  double curvature = 0.0;  // mm, integral of kappa_c for the upward normal
  double steepness = 0.0;  // rad mm^2, integral of slope - steep angle
};

struct SplitMesh {
  std::vector<ZeroVertex> vertices;
  std::vector<SplitTriangle> triangles;
  // A side along a watershed (watershed_lines.h).
  struct Line {
    std::vector<Vec2> places = {};       // on the true line between the vertices, first to second
    bool summits = false, pits = false;  // what the line divides
  };
  // By the two vertices of the side, the lower number first.
  std::map<std::pair<int, int>, Line> lines;
};

// A triangle of the meshes of all pieces.
struct TriangleRef {
  std::size_t piece = 0, triangle = 0;
  bool operator==(const TriangleRef&) const = default;
};

// A value for each triangle of the meshes of all pieces: [piece][triangle].
template <class T>
using PerTriangle = std::vector<std::vector<T>>;

// Parameters of corner k (0, 1, 2) of a triangle, and of its middle.
inline Vec2 CornerOf(const SplitMesh& mesh, std::size_t triangle, std::size_t k) {
  const ZeroVertex& vertex = mesh.vertices[static_cast<std::size_t>(mesh.triangles[triangle].vertex[k])];
  return {vertex.u, vertex.v};
}
inline Vec2 MiddleOf(const SplitMesh& mesh, std::size_t triangle) {
  return (CornerOf(mesh, triangle, 0) + CornerOf(mesh, triangle, 1) + CornerOf(mesh, triangle, 2)) / 3.0;
}

// True if both vertices lie on the same border of the piece.
inline bool AlongBorder(const ZeroVertex& a, const ZeroVertex& b) {
  return (a.u == b.u && (a.u == 0.0 || a.u == 1.0)) || (a.v == b.v && (a.v == 0.0 || a.v == 1.0));
}

// `fields` are those of RegionFields, `steep_angle` is in rad. The relative error of areas is 1e-7. They are
// integrated by a quadrature rule of degree 5 on parts whose normals turn by less than 0.35 rad and on which
// the area element |S_u x S_v| is nearly quadratic, or by a rule of degree 2 where it is nearly linear.
SplitMesh BuildSplitMesh(const Piece& piece, std::span<const ZeroField> fields, double steep_angle,
                         const ZeroMeshParams& params);

// Sets area, curvature and steepness of a triangle with these vertices, as BuildSplitMesh does.
void MeasureTriangle(const Piece& piece, const std::vector<ZeroVertex>& vertices, double steep_angle,
                     SplitTriangle& triangle);

// Area on the surface over a triangle of parameters, mm^2. Positive if a, b, c run counter-clockwise.
double SurfaceArea(const Piece& piece, const Vec2& a, const Vec2& b, const Vec2& c);

}  // namespace patchmill
