// A curve network as given: vertices with normals, edge curves, faces of three or four edges [joining].
//
// The unit of length is that of the patches of a PatchModel. Indices are 0-based.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/curve/curve.h"
#include "core/curve/ended_spline.h"
#include "core/patch/patch.h"

namespace patchmill {

inline constexpr int kMaxNetworkFaces = 100'000;

// A place on the edge between two vertices. The one face that has the whole edge as a side leads. Faces along
// parts of the edge take the parts of its curve and, where it is smooth, follow its tangent plane [joining,
// section 6].
struct PlaceOnEdge {
  int start = 0, end = 0;  // vertices
  double parameter = 0.5;  // (0, 1), of the edge's curve from `start`
};

struct NetworkVertex {
  // A normal of the listed faces, or of all faces if none are listed. Its length is any but zero; its sense
  // does not matter.
  struct Normal {
    Vec3 direction = Vec3::Zero();
    std::vector<int> faces;
  };
  std::string id;
  Vec3 position = Vec3::Zero();  // not read where on_edge is given
  // There are several where creases part the faces around the vertex. Faces without a given normal get the
  // mean of the corner normals of their group: the faces joined by smooth edges around the vertex.
  std::vector<Normal> normals;
  std::optional<PlaceOnEdge> on_edge = {};  // a T-junction: no normal where the leading face gives it
};

// Tangents from the normals [curves (26), (27)], gamma |chord| long. At a crease between two normals the
// tangent lies in both planes. A face that meets the others there in creases only, and has no given normal,
// requires no plane. `length` says what gamma multiplies. kChord: the chord. kArc, kQuarterEllipse: the
// tangents of the cubic nearest to an arc or to a quarter ellipse with these end directions.
enum class TangentLength { kChord, kArc, kQuarterEllipse };
struct NormalsEdge {
  double gamma = 1.0;  // (0, 10]
  TangentLength length = TangentLength::kChord;
};
// Outgoing tangents at both ends [curves (3)]. They must lie in the tangent planes.
struct TangentsEdge {
  Vec3 start = Vec3::Zero(), end = Vec3::Zero();
};
// Hosaka's segment: its directions come from the normals, its lengths are such that it passes through a point
// in space [curves (18)].
struct ThroughPointEdge {
  Vec3 point = Vec3::Zero();
};
// Hosaka's segment whose largest distance from the plane of chord and start tangent is that of `peak` [curves
// (20)].
struct PeakEdge {
  Vec3 peak = Vec3::Zero();
};
// Hosaka's segment as a plane curve through `point` along `direction` [curves (21)]; without a direction,
// along the chord [curves (21)].
struct SlopeEdge {
  Vec3 point = Vec3::Zero();
  std::optional<Vec3> direction;
};
// A NormalsEdge led through `point` at `parameter` by the extra term [curves (10)]; end tangents stay. The
// degree is 4, with a derivative 5.
struct LedEdge {
  NormalsEdge ends;
  double parameter = 0.5;  // [0.05, 0.95]
  Vec3 point = Vec3::Zero();
  std::optional<Vec3> derivative;  // at `parameter`
};
// A curve from vertex `start` to vertex `end` of the edge, of degree up to kMaxBrownDegree. It may have
// several spans only beside Brown quads. Its first derivative must be continuous, on a smooth edge also its
// second.
struct CurveEdge {
  Curve curve;
};
using EdgeShape =
    std::variant<NormalsEdge, TangentsEdge, ThroughPointEdge, PeakEdge, SlopeEdge, LedEdge, CurveEdge>;

// Nearer to an end than this (of the parameter), the extra term has too little effect.
inline constexpr double kMinLedPlace = 0.05;

struct NetworkEdge {
  std::string id;
  int start = 0, end = 0;  // vertices
  EdgeShape shape;
  bool crease = false;           // the faces beside it need no common tangent plane
  std::optional<int> line = {};  // the entry of CurveNetwork::lines it was made from
};

// A smooth curve through three or more vertices, or two if it is not closed. It is the cubic spline in the
// chord parameter (core/curve/spline.h), cut into one cubic edge per pair of neighbours. An end without a
// direction or a curvature is natural. A closed line has no ends.
// Where two lines cross, G2-Gregory faces can share their curvature.
struct NetworkLine {
  std::vector<int> vertices;
  bool closed = false;
  bool crease = false;  // of all its edges
  SplineEnd start = {}, end = {};
};

enum class PatchScheme {
  kAuto,             // Gregory quad, Brown quad where an edge is no cubic of one span; loft triangle
  kGregory,          // quad: [shapes (7)], cubic edges only
  kBrown,            // quad: [shapes (8)]
  kLoftTriangle,     // triangle: [shapes (17), (18)], squared weights where an edge is no cubic
  kGregoryTriangle,  // triangle: [shapes (12)-(14)], cubic edges only
  kG2Gregory,  // quad: [shapes (20), (21)], cubic edges only; equal curvature across edges with its like
  // Quad: [shapes (23)-(27)]. Its tangents across an edge are those of the crossing edges, blended by a
  // smooth step, with breaks at vertices on the edge. Faces of other kinds follow them.
  kHosaka,
};

inline constexpr std::size_t kMaxFacePushes = 101;  // of one face: `push` on the wire and 100 more

// A bulge or dent at one place of a face [editing, section 1], made by the twists of its edges. Corners and
// edges stay; the faces across its smooth edges follow.
struct FacePush {
  // The place, inside the face: u along side 0 from the first vertex, v away from it. In a triangle they are
  // the shares of the second and third vertex.
  double u = 0.5, v = 0.5;
  // > 0: towards the side from which the vertices run anticlockwise. Unit 1/length: the place moves by a
  // small share of the product of amount and area of the face.
  double amount = 0.0;

  bool operator==(const FacePush&) const = default;
};

// Wished twists at the ends of one side of a face, as seen from that end: the derivative of the tangent
// across the side with respect to the side's parameter, which leaves that end ([joining (3)]: Wa0, Wa1).
// Where one is not given, [joining (8)] holds.
struct SideTwists {
  int start = 0, end = 0;  // the corners of the side
  std::optional<Vec3> at_start, at_end;
};

struct NetworkFace {
  std::string id;
  std::vector<int> vertices;  // around the face, three or four; more with cuts
  PatchScheme scheme = PatchScheme::kAuto;
  std::vector<FacePush> pushes = {};  // they add up
  // Of a quad: u along side 0, v away from it. They move neither the border nor the neighbours.
  std::vector<Bulge> bulges = {};
  std::vector<SideTwists> twists = {};
  // Inserted edges between two corners, which leave pieces of three or four sides [joining, section 2]. The
  // scheme applies to the pieces with its number of sides.
  std::vector<std::array<int, 2>> cuts = {};
  std::optional<int> of = {};  // for a piece: the face it was cut from (face_cuts.h)
};

// How a G2-Gregory face leaves an edge in its middle [joining, section 8]: first and second derivative of the
// face's surface across the edge, into it. The face across a smooth edge follows: its first derivative turns
// with this one and keeps its share of the length, and it takes over the normal curvatures of this face.
struct CrossControl {
  int start = 0, end = 0;             // the ends of the edge, in either order
  int face = 0;                       // at most one control for each edge of it
  std::optional<Vec3> first, second;  // one that is not given is the mean of the edge's ends

  bool operator==(const CrossControl&) const = default;
};

// An edge that no entry of `edges` or `lines` describes is a smooth NormalsEdge with gamma 1.
struct CurveNetwork {
  std::vector<NetworkVertex> vertices;
  std::vector<NetworkEdge> edges;
  std::vector<NetworkFace> faces;
  std::vector<NetworkLine> lines;
  std::vector<CrossControl> controls;
  std::optional<double> join_tolerance;  // as PatchModel's
};

}  // namespace patchmill
