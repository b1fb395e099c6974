// The triangles of one piece, split along the zero curves of all fields (ALGORITHMS 12): topology from signs
// at vertices only, vertices on a border lie on the true curve.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "cam/region/reach.h"
#include "cam/region/surface_fields.h"

namespace patchmill {

struct SplitVertex {
  double u = 0.0, v = 0.0;
  Vec3 p = Vec3::Zero();
  std::array<std::int8_t, kFieldCount> sign{};  // -1, 0, +1; kReach: +1 reachable, -1 not
  std::uint8_t on = 0;                          // bit k: lies on the zero curve of field k
};

// What a triangle is. Triangles of equal labels that share an edge belong together.
struct SplitLabel {
  std::int8_t curvature = 0;  // -1 mountain, +1 basin, 0 flat along the contour (upward normal)
  bool steep = false;
  UnreachableReason reason = UnreachableReason::kNone;
  bool operator==(const SplitLabel&) const = default;
};

struct SplitTriangle {
  std::array<int, 3> vertex{};  // counter-clockwise in (u,v)
  SplitLabel label;
  double area = 0.0;       // mm^2 on the surface
  double curvature = 0.0;  // integral of kappa_c (upward normal) over it, mm
};

struct SplitMesh {
  std::vector<SplitVertex> vertices;
  std::vector<SplitTriangle> triangles;
};

struct SplitMeshParams {
  double cos_steep = 0.7;
  double border_tolerance = 0.01;  // mm, of bisected limits of reach
  double max_cell = 1.0;           // mm, largest side of a cell
  double min_cell = 0.1;           // mm: cells are not divided below about this side
};

// A quadtree over the piece, finer where a field changes sign, fanned into triangles, which are then cut
// field by field.
SplitMesh BuildSplitMesh(const Piece& piece, const ReachTest& reach, const SplitMeshParams& params);

// The zero curve of `field` between two vertices on it, as parameter points without the ends, so dense that
// chords keep to `tolerance` (mm). Where the perpendicular root is not found the chord stays.
std::vector<Vec2> RefineArc(const Piece& piece, Field field, const SplitVertex& a, const SplitVertex& b,
                            double cos_steep, double tolerance);

}  // namespace patchmill
