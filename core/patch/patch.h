// Patches as given: a closed set of parametric shapes. Frames and units: model units until placed, then mm.
//
// Parameters: (u,v) in [0,1]^2; for triangles area coordinates (s,t), s,t >= 0, s+t <= 1.
#pragma once

#include <array>
#include <string>
#include <variant>
#include <vector>

#include "core/base/vec.h"

namespace patchmill {

inline constexpr int kMaxDegree = 15;

// Tensor Bezier patch, degree 1..15 each way, rational with positive weights.
//   points[i * (degree_v + 1) + j]: i along u (slowest), j along v. Cartesian, NOT multiplied by the weight.
//   weights: empty (polynomial) or one per point, > 0.
struct BezierPatch {
  int degree_u = 0;
  int degree_v = 0;
  std::vector<Vec3> points;
  std::vector<double> weights;
};

// Untrimmed B-spline or NURBS patch. n_u = knots_u.size() - degree_u - 1 points along u; layout as
// BezierPatch. Knots do not decrease; the domain [knots[p], knots[n]] is mapped to [0,1]. Multiplicity of an
// inner knot <= degree.
struct BsplinePatch {
  int degree_u = 0;
  int degree_v = 0;
  std::vector<double> knots_u;
  std::vector<double> knots_v;
  std::vector<Vec3> points;
  std::vector<double> weights;
};

// Bicubic Gregory quad, 20 points: five at each corner (0,0) (1,0) (1,1) (0,1): P, E+, E-, F+, F-
// (E+ along the edge that leaves the corner counter-clockwise, E- along the one that arrives).
//
//   v=1   15 --- 17 --- 11 --- 10       edges:  v=0:  0  1  7  5     u=1:  5  6 12 10
//         |   18,19  14,13     |                v=1: 15 17 11 10     u=0:  0  2 16 15
//         16                   12
//         |                    |       kCorner: inner point of corner (0,0) = (u F+ + v F-)/(u+v), and so on
//         by symmetry 2                    6       kEdge:   METHODS (13): inner points blended by u(1-u),
//         v(1-v), as two bicubics |    3,4    9,8      |
//   v=0   0 ---- 1 ---- 7 ---- 5
//        u=0                  u=1
// kCorner inner points, as in the data's README: b11 = (u p3 + v p4)/(u+v), b21 = (v p8 + (1-u)
// p9)/((1-u)+v), b22 = ((1-u) p13 + (1-v) p14)/((1-u)+(1-v)), b12 = ((1-v) p18 + u p19)/(u+(1-v)). kEdge:
// which point of each pair belongs to the loft across v (net 1: edges v=0, v=1) and which to the loft across
// u (net 2) is fixed so that both blends agree along the edges: near edge v=0 kCorner's inner point tends to
// the one multiplied by u, so net 1 takes p3, p9, p13, p19 and net 2 takes p4, p8, p14, p18.
struct GregoryPatch {
  enum class Blend { kCorner, kEdge };
  std::array<Vec3, 20> points;
  Blend blend = Blend::kCorner;
};

// Triangular Bezier patch of degree n (1..15), (n+1)(n+2)/2 points row after row: n+1 along the edge t=0 from
// (s,t) = (0,0) to (1,0), then n, ... , 1 at (0,1). Point k of row r belongs to s^k t^r (1-s-t)^(n-k-r).
// Weights as BezierPatch.
struct BezierTriangle {
  int degree = 0;
  std::vector<Vec3> points;
  std::vector<double> weights;
};

using PatchShape = std::variant<BezierPatch, BsplinePatch, GregoryPatch, BezierTriangle>;

struct Patch {
  std::string id;  // the client's face id, unique or empty
  PatchShape shape;
};

// Position and derivatives with respect to the two parameters.
struct SurfaceJet {
  Vec3 p = Vec3::Zero();
  Vec3 du = Vec3::Zero(), dv = Vec3::Zero();
  Vec3 duu = Vec3::Zero(), duv = Vec3::Zero(), dvv = Vec3::Zero();
};

// Analytic evaluation in the native form of each kind. Error about 1e-15 of the patch's size.
// Gregory corners: value and first derivatives are exact; second derivatives have no limit there,
// METHODS 1.6's values (boundary curves, mean twist) are returned within 1e-6 of a corner.
SurfaceJet Evaluate(const PatchShape& shape, double u, double v);
Vec3 Position(const PatchShape& shape, double u, double v);

bool IsTriangle(const PatchShape& shape);

}  // namespace patchmill
