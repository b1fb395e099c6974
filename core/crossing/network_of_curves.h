// A curve network, with its faces, from curves that cross [crossing].
#pragma once

#include <optional>
#include <vector>

#include <absl/status/statusor.h>

#include "core/crossing/curve_graph.h"
#include "core/joining/join_network.h"

namespace patchmill {

struct CrossingOptions {
  double tolerance = 0.0;  // mm, > 0: curves nearer to each other than this meet
  FreeEnds free_ends = FreeEnds::kTrim;
  std::optional<Vec3> direction = {};  // of the projection that orders edges around vertices (embed_faces.h)
  double crease_angle = Radians(40);   // faces that meet at more than this have a crease between them
};

struct NetworkOfCurves {
  CurveNetwork network;
  JoinedNetwork joined;  // of the network, without its findings
  // CURVES_APART, FACE_LEFT_OUT, EDGE_MOVED and the codes of MakeCurveGraph; NO_FACE (an error) if no face is
  // left. Findings of joining that leave faces whole are warnings of `joined`.
  Diagnostics findings;
  double max_moved = 0.0;  // mm, largest distance of an edge from its curve
};

// Edges that are one cubic, and splines beside quads, are parts of their curves to the bit, unless their ends
// have to meet others. Vertices get the normals of the planes of their tangents. A face that cannot be joined
// is left out by name; all others stay. Errors: those of FindCrossings and of `run`.
absl::StatusOr<NetworkOfCurves> MakeNetworkOfCurves(const std::vector<DrawnCurve>& curves,
                                                    const CrossingOptions& options, const RunContext& run);

}  // namespace patchmill
