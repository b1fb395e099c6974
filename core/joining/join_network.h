// Makes patches from a CurveNetwork [joining]: joined with equal tangent planes, and with equal curvatures
// between G2-Gregory faces.
#pragma once

#include <vector>

#include <absl/status/statusor.h>

#include "core/base/diagnostic.h"
#include "core/base/run_context.h"
#include "core/curve/bezier_chain.h"
#include "core/joining/curvature_joint.h"
#include "core/joining/edge_table.h"
#include "core/joining/tangent_plane.h"
#include "core/network/patch_model.h"

namespace patchmill {

enum class EdgeKind {
  kSmooth,     // the two faces share their tangent plane all along
  kCrease,     // two faces, a divided edge, or a part of one, and listed as a crease
  kFree,       // one face
  kLeading,    // one face along the whole of it; others along parts follow its tangent plane
  kFollowing,  // one face along a part of a leading edge
};

struct JoinedEdge {
  TableEdge topology;
  EdgeKind kind = EdgeKind::kFree;
  BezierChain curve;  // from vertex start to end, degree >= 3; several spans if such a spline was given
  // Cross-boundary tangents along the curve, into the face topology.faces[k]. Their degree is that of the
  // curve.
  std::vector<BezierChain> tangents;
  // The rows of the G2-Gregory faces beside it, along the curve, in the order of topology.faces. These faces
  // use them in place of `tangents`. Empty if there is no such face.
  std::vector<CrossRows> rows;
  bool equal_curvature = false;  // smooth, and equal normal curvatures in every direction, to about 1e-13
};

struct JoinedNetwork {
  // One patch per face, in order, with the faces' ids; then the further pieces of faces with cuts
  // (face_cuts.h). Empty if a finding is an error.
  PatchModel model;
  std::vector<int> face_of;       // the face that each patch is or is a piece of; empty on an error
  std::vector<JoinedEdge> edges;  // empty on an error
  // Edges made from lines have a `given` beyond CurveNetwork::edges, in the order of WithLinesAsEdges.
  // Errors: those of BuildEdgeTable, WithLinesAsEdges, WithCutFaces, AddCurvatureRows and PlaceTVertex, and
  //   CHORD_ALONG_NORMAL    a tangent from a normal that has no direction: give the tangent
  //   NO_FIT                no Hosaka segment, arc or ellipse has these end directions and the shape that is
  //   NO_FIT                no Hosaka segment, arc or ellipse has these end directions and the requested
  //                         shape
  //   UNSUPPORTED_CURVE     several spans with a corner between them, or on a smooth edge a jump of the
  //                         second derivative
  //   HOSAKA_RATIO          Hosaka faces on both sides of a smooth edge, or one along a part of it, whose end
  //                         tangents give no common tangent plane between the ends
  //   INVALID_TWIST         twists where another face leads: along a part of an edge, beside a Hosaka face
  //   UNSUPPORTED_SCHEME    a scheme for the other number of sides, or an edge of a degree it cannot take
  //   INCONSISTENT_NORMALS  the faces beside a smooth edge have different normals at an end, or a tangent or
  //                         curve given there leaves the tangent plane
  //   PARALLEL_TANGENTS     two edges leave a corner of a face in line
  //   FOLDED_EDGE           both faces leave a smooth edge to the same side (h, k of opposite sign)
  // Warnings: TANGENT_PLANE_ONLY (curvature_rows.h), LOOPED_EDGE (joint_checks.h).
  Diagnostics findings;
};

// The largest angle (rad) by which a given tangent may leave the tangent plane of a smooth joint.
inline constexpr double kMaxTangentTilt = 1e-7;

// Cost O(n log n). CANCELLED and DEADLINE_EXCEEDED from `run`, which is polled at every edge and face.
// Adjacent patches share their edge curves bit for bit up to the direction. Their tangent planes agree to
// about 1e-14.
absl::StatusOr<JoinedNetwork> JoinNetwork(const CurveNetwork& network, const RunContext& run);
JoinedNetwork JoinNetwork(const CurveNetwork& network);

}  // namespace patchmill
