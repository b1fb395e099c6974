// Patches as given: a closed set of parametric shapes, in model units until they are placed, then in mm.
//
// Parameters: (u,v) in [0,1]^2; for triangles the area coordinates (s,t) with s,t >= 0 and s+t <= 1.
//
// Above each kind its points are drawn by their index, in the parameter plane: u (s) to the right, v (t) up.
// The frame is the border of the patch. A line from a point of the frame to a point inside joins the two
// whose difference is the tangent across the border there, in the line's direction (LoftTriangle: towards the
// opposite vertex). control_net_pictures_test reads these pictures and checks them against Evaluate.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/base/typed_id.h"
#include "core/base/vec.h"

namespace patchmill {

inline constexpr int kMaxDegree = 15;

// A bulge or a dent of a quad: the place (u, v) moves by the vector `by`, every other place by less, along
// the same line [shapes (40)]. The border stays, with the first and second derivatives there. So neighbours
// keep their tangent planes and curvatures. Bulges of one patch add up.
struct Bulge {
  double u = 0.5, v = 0.5;  // [kMinBulgePlace, 1 - kMinBulgePlace]
  Vec3 by = Vec3::Zero();

  bool operator==(const Bulge&) const = default;
};
inline constexpr double kMinBulgePlace = 0.01;
inline constexpr std::size_t kMaxBulges = 20;  // of one patch, because each cuts it into more pieces

// Tensor Bezier patch, degree 1..15 each way, rational with positive weights.
//   points[i * (degree_v + 1) + j]: i along u (slowest), j along v. Cartesian, NOT multiplied by the weight.
//   weights: empty (polynomial) or one per point, > 0.
//
//   v=1    3 --- 7 -- 11      degree_u = 2, degree_v = 3
//          |     |     |
//          2 --- 6 -- 10
//          |     |     |
//          1 --- 5 --- 9
//          |     |     |
//   v=0    0 --- 4 --- 8
//         u=0         u=1
struct BezierPatch {
  int degree_u = 0;
  int degree_v = 0;
  std::vector<Vec3> points;
  std::vector<double> weights;
};

// Untrimmed B-spline or NURBS patch. It has n_u = knots_u.size() - degree_u - 1 points along u. The layout is
// that of BezierPatch. Knots do not decrease; the domain [knots[p], knots[n]] is mapped to [0,1]. An inner
// knot has at most the multiplicity `degree`.
//
//   v=1    2 --- 5 --- 8 -- 11      degree 2 each way; knots_u 0 0 0 1 2 2 2, knots_v 0 0 0 1 1 1
//          |     |     |     |
//          1 --- 4 --- 7 -- 10
//          |     |     |     |
//   v=0    0 --- 3 --- 6 --- 9
//         u=0               u=1
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
//   v=1   15 ------ 17 ---- 11 ------ 10
//          |         |       |         |
//          |        19      13         |
//         16 --- 18             14 -- 12
//          |                           |
//          |                           |
//          2 ---- 4              8 --- 6
//          |         3       9         |
//          |         |       |         |
//   v=0    0 ------- 1 ----- 7 ------- 5
//         u=0                         u=1
//
// Each corner has a pair of inner points, F+ and F- (3 and 4 at (0,0)), which are blended.
// kCorner: near (0,0) the inner point is (u p3 + v p4) / (u + v), near (1,0) (v p8 + (1-u) p9) / ((1-u) + v),
// near (1,1) ((1-u) p13 + (1-v) p14) / ((1-u) + (1-v)), near (0,1) ((1-v) p18 + u p19) / (u + (1-v)).
// kEdge: [shapes (7)], two bicubics blended by p = u(1-u) and q = v(1-v). The one with weight p / (p + q)
// lofts the edges v=0 and v=1 and takes p3, p9, p13, p19; the other one lofts u=0 and u=1 and takes p4, p8,
// p14, p18.
// Both blends have the same tangents across the edges.
struct GregoryPatch {
  enum class Blend { kCorner, kEdge };
  std::array<Vec3, 20> points;
  Blend blend = Blend::kCorner;
  std::vector<Bulge> bulges = {};
};

// Triangular Bezier patch of degree n (1..15) with (n+1)(n+2)/2 points, row after row: n+1 along the edge t=0
// from (s,t) = (0,0) to (1,0), then n, ... , 1 at (0,1). Point k of row r belongs to s^k t^r (1-s-t)^(n-k-r).
// Weights are those of BezierPatch.
//
//   t=1    9                    degree 3
//          | \.
//          7 -- 8
//          |    | \.
//          4 -- 5 -- 6
//          |    |    | \.
//   t=0    0 -- 1 -- 2 -- 3
//         s=0            s=1
struct BezierTriangle {
  int degree = 0;
  std::vector<Vec3> points;
  std::vector<double> weights;
};

// Quad on four general boundary curves with given cross-boundary tangents ([shapes (4), (5), (8)]: "Brown
// quad"). Each edge has its Bezier curve C and beside it a rail C + b/3, where b is the tangent across the
// edge into the patch. A rail has the degree of its edge. Its ends follow from the two curves that cross
// there and are not given, so the data always meet at the corners.
//   points, with n = degree_u, m = degree_v; all rows along u, all columns along v:
//     edge v=0 (n+1), edge v=1 (n+1), inner points of edge u=0 (m-1) and of edge u=1 (m-1),
//     inner points of the rails of v=0 (n-1), v=1 (n-1), u=0 (m-1), u=1 (m-1): 4 (n + m) - 4 in all.
// Edges and rails along u may be chains of curves of degree degree_u that meet at breaks_u; the same holds
// along v. Then n = degree_u (breaks_u.size() + 1), and neighbours share a point. The surface is as smooth
// across a break as the four chains are, up to one derivative. If all are cubic, the patch blends two bicubic
// nets that differ in their inner points, as GregoryPatch::kEdge, but with the weights u^2 (1-u)^2 and v^2
// (1-v)^2.
//
//   v=1    4 --- 5 --------- 6 --- 7      degree_u = 3, degree_v = 4
//          |     |           |     |
//          |    16          17     |
//         10 --- 20      23 ----- 13
//          9 --- 19      22 ----- 12
//          8 --- 18      21 ----- 11
//          |    14          15     |
//          |     |           |     |
//   v=0    0 --- 1 --------- 2 --- 3
//         u=0                     u=1
struct BrownPatch {
  int degree_u = 3;  // 3..kMaxBrownDegree
  int degree_v = 3;
  std::vector<Vec3> points;
  std::vector<double> breaks_u = {}, breaks_v = {};  // in (0, 1), increasing; at most kMaxBrownBreaks
  std::vector<Bulge> bulges = {};
};
inline constexpr int kMaxBrownDegree = 11;  // its net has four degrees more
inline constexpr int kMaxBrownBreaks = 1000;

// Quartic Gregory triangle [shapes (12)-(15)], 18 points: five at each corner (0,0) (1,0) (0,1) as
// in GregoryPatch, P E+ E- F+ F-, then the middle points of the edges 0-1, 1-2, 2-0.
//
//   t=1   10                               rows of the quartic, from t=0 up:
//          | \.                             0 1 15 7 5 / 2 x y 6 / 17 z 16 / 11 12 / 10
//         11  12                             with r = 1-s-t
//          |     \.
//         17-13 14-16
//          |         \.
//          2--4   8---6
//          |  3   9    \.
//          |  |   |     \.
//   t=0    0--1--15--7---5
//         s=0           s=1
//
// kCorner: x = (s p3 + t p4)/(s+t), y = (t p8 + r p9)/(t+r), z = (r p13 + s p14)/(r+s).
// kEdge: three quartics blended by u_j u_k / (u2 u3 + u1 u3 + u1 u2). The quartic of an edge takes the
// two inner points next to it from that edge (F+ of the corner it leaves, F- of the one it reaches) and the
// mean of the third pair.
struct GregoryTriangle {
  std::array<Vec3, 18> points;
  GregoryPatch::Blend blend = GregoryPatch::Blend::kEdge;
};

// Triangle blended from three quads with one edge shrunk to the opposite vertex [shapes (17), (18)].
//   points, with n = degree: the boundary anti-clockwise from (0,0), 3 n points (edge 0 from (0,0) to (1,0),
//   edge 1 to (0,1), edge 2 back); then the n - 1 inner points of the rail of each edge, rail = curve + b/3,
//   b the tangent across the edge into the triangle (barycentric direction, straight to the opposite vertex).
//   6 n - 3 in all. The ends of the rails follow from the neighbouring edges.
// Plain weights [shapes (12)] need cubic edges; squared ones serve degree 4 too.
//
//   t=1    6                                degree 3
//          | \.
//          7 --- 13  12 --- 5
//          |                 \.
//          8 --- 14      11 --- 4
//          |     9    10          \.
//          |     |     |            \.
//   t=0    0 --- 1 --- 2 ---------- 3
//         s=0                      s=1
struct LoftTriangle {
  int degree = 3;        // 3, or 4 with squared weights
  bool squared = false;  // u_i u_j of (18) replaced by its square
  std::vector<Vec3> points;
};

// G2-Gregory patch [shapes (20)] of degree n = 5..7 each way. First come (n+1)^2 points, [i (n+1) + j], i
// along u, whose block entries (i and j both in {1, 2, n-2, n-1}) serve the edges v=0 and v=1. Then come 16
// points, the block entries in the same order that serve u=0 and u=1.
//
//   v=1    5 ----- 11 ------ 17 ------ 23 ------ 29 ----- 35      degree 5; of a pair the first serves
//          |        |         |         |         |        |      v=0 and v=1, the second u=0 and u=1
//          4 --- 10,39 --- 16,43 --- 22,47 --- 28,51 ---- 34
//          |        |         |         |         |        |
//          3 ---- 9,38 --- 15,42 --- 21,46 --- 27,50 ---- 33
//          |        |         |         |         |        |
//          2 ---- 8,37 --- 14,41 --- 20,45 --- 26,49 ---- 32
//          |        |         |         |         |        |
//          1 ---- 7,36 --- 13,40 --- 19,44 --- 25,48 ---- 31
//          |        |         |         |         |        |
//   v=0    0 ------ 6 ------ 12 ------ 18 ------ 24 ----- 30
//         u=0                                             u=1
struct G2GregoryPatch {
  int degree = 6;
  std::vector<Vec3> points;
  std::vector<Bulge> bulges = {};
};

// Hosaka's blended boundary patch [shapes, section 6].
//   points, with n = degree 1..11: edge v=0 (n+1), edge v=1 (n+1), inner points of edge u=0 (n-1) and of
//   u=1 (n-1): Bezier points, 4 n in all; then corner (0,0) + s_ij, i slow, for the inner term [shapes (28)].
//
//   v=1    4 --- 5 --- 6 --- 7      degree 3, inner_u = 1, inner_v = 2;
//          |                 |      inside the coefficients s_ij, i to the right, j up
//          9    14    17    11
//          |    13    16     |
//          8    12    15    10
//          |                 |
//   v=0    0 --- 1 --- 2 --- 3
//         u=0               u=1
struct HosakaPatch {
  enum class Blend { kSmooth, kLinear };  // [shapes (25)], or f(t) = t
  struct Break {
    double at = 0.0, value = 0.0;  // f(at) = value; at in (0, 1), increasing; value in [0, 1], not decreasing
  };
  int degree = 3;
  Blend blend = Blend::kSmooth;
  // The break parameters of the blending functions f1..f4 of the edges v=0, u=0, v=1, u=1, for other patches
  // that end on a part of an edge [shapes (27)]. Only with kSmooth; at most kMaxHosakaBreaks each.
  std::array<std::vector<Break>, 4> breaks;
  // The inner term has (inner_u + 1)(inner_v + 1) coefficients, both 0..4; -1 means none. inner_order 1 is
  // [shapes (28)] with k = 1; 2 multiplies it by another u v (1-u)(1-v), so that edge normals stay.
  int inner_u = -1, inner_v = -1, inner_order = 1;
  std::vector<Vec3> points;
  std::vector<Bulge> bulges = {};
};
inline constexpr int kMaxHosakaBreaks = 16;

using PatchShape = std::variant<BezierPatch, BsplinePatch, GregoryPatch, BezierTriangle, BrownPatch,
                                GregoryTriangle, LoftTriangle, G2GregoryPatch, HosakaPatch>;

struct Patch {
  std::string id;  // the client's own id, unique or empty
  PatchShape shape;
  std::optional<FaceId> face = {};  // of PatchModel::faces, that the patch is a part of
};

// Largest |e_z| of the unit normal of a vertical face. Neither of its sides is the upper one.
inline constexpr double kUprightFace = 1e-6;
// Largest |e_z| of walls. They may lean by 6 degrees, also inwards.
inline constexpr double kMostWallSlope = 0.1;

// What is known of the two sides of a face (core/surface/air_sides.h).
struct FaceSides {
  // The side of a vertical or an overhanging face that is air: 1 the side of du x dv, -1 the other side, 0
  // unknown.
  int air_side = 0;
  // The side of a face of a closed body that is outside, as above; 0 for other faces, and if it is unknown.
  int outer_side = 0;
  // Largest |e_z| with which a place of the face counts as vertical. It is larger than kUprightFace on a wall
  // that leans a little (UprightOf).
  double upright = kUprightFace;
  // The face overhangs: `air_side` holds at every place of it, also where that side looks down, although the
  // back of the face can be seen from above there.
  bool overhangs = false;

  // Whether `air_side` says where the tool stands, at a place whose unit normal has this z component.
  bool Decides(double e_z) const {
    return air_side != 0 && (overhangs || (e_z <= upright && -e_z <= upright));
  }
  // Whether the place belongs to the underside of a closed body: its outer side looks down, and it is no wall
  // that leans in. `e_z`: the z component of its unit normal du x dv.
  bool IsUnderside(double e_z) const { return outer_side * e_z < -kMostWallSlope; }
  // Whether no tool stands on a side of an area: the side looks down, or it is the back of the face.
  // `side`: 1 the side of du x dv, -1 the other. `highest`: the unit normals of that side have at most this
  // z component.
  bool RulesOut(double side, double highest) const {
    if (overhangs) return side * air_side < 0.0;
    return highest < -upright || (highest <= upright && side * air_side < 0.0);
  }
};

// Position and derivatives with respect to the two parameters.
struct SurfaceJet {
  Vec3 p = Vec3::Zero();
  Vec3 du = Vec3::Zero(), dv = Vec3::Zero();
  Vec3 duu = Vec3::Zero(), duv = Vec3::Zero(), dvv = Vec3::Zero();
  FaceSides sides;  // of the face of this place
};

// Analytic evaluation in the native form of each kind. Error about 1e-15 of the patch's size. Corners of
// blended kinds (Gregory, Brown, LoftTriangle, G2Gregory): value and first derivatives are exact. Second
// derivatives have no limit there; within 1e-6 of a corner the values of [shapes, section 7] are returned
// (boundary curves, mean twist).
SurfaceJet Evaluate(const PatchShape& shape, double u, double v);
Vec3 Position(const PatchShape& shape, double u, double v);

bool IsTriangle(const PatchShape& shape);

}  // namespace patchmill
