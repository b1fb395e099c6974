// A part as CAD files give it: faces on surfaces, bounded by loops of edges. Plain values in millimetres,
// made by a reader of foreign files and read by core/trim.
//
//   Face    a part of one surface, inside its loops
//   Edge    a curve in space, shared by the faces that meet along it
//   EdgeUse one side of an edge: the edge as a part of a loop of one face
//
// Loops are closed curves in the parameter plane (u, v) of the face's surface and bound the face there
// completely: a closed surface is cut open along its seam, and the seam is used twice; a pole is a degenerate
// edge along a whole border line of the parameters. The curve in space says where an edge is. The parameter
// curve only says near which parameters it runs.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/base/vec.h"
#include "core/patch/patch.h"

namespace patchmill {

// Three orthonormal directions at a place. They are left-handed where an assembly mirrors the part.
struct BrepFrame {
  Vec3 origin = Vec3::Zero();
  Vec3 x = Vec3::UnitX(), y = Vec3::UnitY(), z = Vec3::UnitZ();
};

// Surfaces and their parameters (u, v). Angles are radians; u is the angle about z, from x towards y.
struct BrepPlane {  // origin + u x + v y
  BrepFrame frame;
};
struct BrepCylinder {  // origin + radius (cos u x + sin u y) + v z
  BrepFrame frame;
  double radius = 0.0;  // > 0
};
struct BrepCone {  // origin + (radius + v sin a) (cos u x + sin u y) + v cos a z
  BrepFrame frame;
  double radius = 0.0;      // >= 0, at v = 0
  double half_angle = 0.0;  // a, in (-pi/2, pi/2), not 0
};
struct BrepSphere {  // origin + radius (cos v (cos u x + sin u y) + sin v z), v in [-pi/2, pi/2]
  BrepFrame frame;
  double radius = 0.0;  // > 0
};
struct BrepTorus {  // origin + (major + minor cos v) (cos u x + sin u y) + minor sin v z
  BrepFrame frame;
  double major = 0.0, minor = 0.0;  // minor > 0, major >= 0
};
// A rational B-spline. u and v are values of its knots (not mapped to [0,1]).
struct BrepSpline {
  BsplinePatch patch;
};
using BrepSurface = std::variant<BrepPlane, BrepCylinder, BrepCone, BrepSphere, BrepTorus, BrepSpline>;

// Rational B-spline curve with clamped ends. Its parameter runs over [knots[degree], knots[n]]. A straight
// line has degree 1 and two points; conic sections have degree 2 and at most 90 degrees a span.
struct BrepCurve {
  int degree = 1;
  std::vector<double> knots;
  std::vector<Vec3> points;
  std::vector<double> weights;  // empty, or one per point, > 0
};

struct BrepEdge {
  BrepCurve curve;           // without points for a degenerate edge, which is one point of space
  bool degenerate = false;   // a pole of its surface
  double curve_error = 0.0;  // mm, by how much the curve differs at most from the file's
};

struct BrepEdgeUse {
  int edge = 0;
  bool forward = true;  // the loop runs along the edge's curve, not against it
  bool seam = false;    // the edge is used twice by this face: the surface closes here
  // Parameters of the surface near the edge, from the begin of its curve to the end: hint[i] belongs to
  // hint_at[i], a parameter of the edge's curve. hint_at increases from the first parameter to the last. For
  // a degenerate edge hint_at is 0 and 1. At least two.
  std::vector<double> hint_at;
  std::vector<Vec2> hint;
};

// A closed chain: each use ends where the next one begins, the last one where the first one begins. The face
// lies to the left, seen with u to the right and v up.
using BrepLoop = std::vector<BrepEdgeUse>;

struct BrepFace {
  BrepSurface surface;
  bool reversed = false;  // the outer side of the body is that of -(S_u x S_v)
  std::vector<BrepLoop> loops;
  int body = 0;
  // Name, layer, colour and number of the face in the file.
  std::string name, layer;
  std::optional<std::uint32_t> rgb;  // 0xRRGGBB
  std::int64_t entity = 0;           // 0 unknown
  // By how much the surface above differs at most from the file's, mm; 0 where it is the file's own.
  double surface_error = 0.0;
  // Area by the reader's own means, mm^2, for comparison; absent where unknown.
  std::optional<double> area;
  std::optional<Box3> box = {};  // that holds the face, by the reader's own means; where it could not be read
};

struct BrepBody {
  std::string name;
  bool solid = false;            // closed by its faces
  std::optional<double> volume;  // by the reader's own means, mm^3
};

struct BrepModel {
  std::vector<BrepEdge> edges;
  std::vector<BrepFace> faces;  // in the order of the file
  std::vector<BrepBody> bodies;
};

}  // namespace patchmill
