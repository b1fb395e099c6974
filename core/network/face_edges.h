// The edges of faces: the edges of their patches without those inside a face, summed by face.
#pragma once

#include <vector>

#include "core/network/edge_curves.h"

namespace patchmill {

// The edges of one face that have no neighbour.
struct OpenFaceEdges {
  FaceId face;
  int longest = 0;  // edge, as EdgeCurves counts
  int count = 0;
  double length = 0.0;  // mm, of all
};

// Two faces meet at an angle.
struct FaceCrease {
  FaceId face, other;    // face < other
  int sharpest = 0;      // edge with the largest angle
  double length = 0.0;   // mm, of all edges along which they meet so
  double max_angle = 0;  // rad
  // mm of these edges that stick out and that are inner corners, as the normals u x v of both faces say.
  // Edges along which these normals look to different sides of the sheet are neither.
  double convex_length = 0.0, concave_length = 0.0;
};

struct FaceEdges {
  std::vector<OpenFaceEdges> open;  // by face
  std::vector<FaceCrease> creases;  // by face, then by other
};

// Whether a link belongs to faces alone: its patch is a part of a face, and so is its neighbour, if it has
// one.
bool IsOfFaces(const PatchModel& model, const EdgeLink& link);
// Whether a link lies inside a face: both patches are parts of it.
bool IsInsideFace(const PatchModel& model, const EdgeLink& link);

// Joints as PatchNetwork has them.
struct FaceJoints {
  const std::vector<EdgeLink>& edges;
  const std::vector<PartLink>& parts;
};
// Lengths are those of the sampled edges, at most some thousandths short. An edge is not counted if it is a
// point, in `left_out`, or of patches without a face.
FaceEdges EdgesOfFaces(const PatchModel& model, const EdgeCurves& curves, const FaceJoints& joints,
                       const std::vector<bool>& left_out);

}  // namespace patchmill
