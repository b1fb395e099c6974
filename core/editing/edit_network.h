// Edits of a curve network, one after the other [editing]. All that no edit touches stays as it is, to the
// bit, and so do the patches made from it.
#pragma once

#include <array>
#include <optional>
#include <variant>
#include <vector>

#include <absl/status/statusor.h>

#include "core/base/diagnostic.h"
#include "core/base/run_context.h"
#include "core/editing/fit_points.h"
#include "core/editing/goals.h"
#include "core/editing/split_faces.h"
#include "core/joining/curve_network.h"
#include "core/joining/join_network.h"

namespace patchmill {

// Pushes a face in or out at a place. The push adds to the earlier pushes of the face.
struct PushEdit {
  int face = 0;
  FacePush push;
};

// Turns a vertex normal: the normal of `face` and of the faces that meet it smoothly there. Without `face`,
// the vertex must have at most one normal, and that one turns.
struct NormalEdit {
  int vertex = 0;
  std::optional<int> face;
  Vec3 direction = Vec3::Zero();  // any length but 0
};

// Sets the first- and second-order control vectors [editing, section 3]. A vector that is not given stays.
// The vectors of the same order of the face across are dropped, because that face follows.
struct ControlEdit {
  CrossControl control;
};

// The side of a face at an edge. The edge is given by its two vertices in either order.
struct EdgeOfFace {
  int start = 0, end = 0, face = 0;
};

// Moves a control point of an edge [editing, section 3]. If Q1 moves, the tangent plane at Q0 turns, and Q2
// follows from the edge's ends. If Q2 moves, Q0 and Q1 stay.
struct ControlPointEdit {
  EdgeOfFace at;
  int point = 1;  // 1 or 2
  Vec3 position = Vec3::Zero();
};

// Sets the curvature of the section across the middle of the edge, 1/mm [editing, section 4]. It is positive
// where the section bends towards the face's S_u x S_v. Q0, Q1 and the line of the second derivative stay.
struct CurvatureEdit {
  EdgeOfFace at;
  double curvature = 0.0;
};

// Corrects a row of faces at once [editing, section 5]. A cubic spline runs through the middles of the edges
// between the faces. It gives all their control vectors across the row. Each edge
// and the next one must be opposite sides of one G2-Gregory face; if closed, so must the last and the first.
struct GuideEdit {
  std::vector<std::array<int, 2>> edges;  // each by its two vertices; at least 2, closed: at least 3
  bool closed = false;
  std::optional<Vec3> start, end;  // directions at the ends, any length but 0; else the surface's own
};

// Changes the surface until it meets goals, all at once, by the smallest change [editing, section 7].
struct ReachEdit {
  Goals goals;
};

// Moves a vertex. Edges, faces and, if it is one of a line, the line follow. Normals stay.
struct VertexEdit {
  int vertex = 0;
  Vec3 position = Vec3::Zero();
  bool by = false;  // `position` is the way, not the place
};

// Makes an edge a crease, or smooth. An edge of a line becomes an edge of its own, and so do the other
// edges of the line; all keep their curves. If a crease becomes smooth, the normals of both faces at its
// ends become their mean.
struct CreaseEdit {
  int start = 0, end = 0;
  bool crease = true;
};

// Cuts a row of quads in two [editing, section 9]. The curves that are cut stay, and new vertices and faces
// come after the old ones. The finding FACES_SPLIT says by how much the surface has changed.
struct SplitEdit {
  FaceSplit split;
};

// Inserts an edge between two corners of a face, which must leave pieces of three or four sides. Joining says
// if it does not (INVALID_CUT). Or takes such an edge away, so that the two pieces become one.
struct CutEdit {
  int face = 0;
  std::array<int, 2> ends = {0, 0};
  bool remove = false;
};

// Moves vertices, normals and the middles of faces until measured points lie within a band of the surface
// [editing, section 10].
struct FitEdit {
  PointFit fit;
};

using NetworkEdit = std::variant<PushEdit, NormalEdit, ControlEdit, ControlPointEdit, CurvatureEdit,
                                 GuideEdit, ReachEdit, VertexEdit, CreaseEdit, SplitEdit, CutEdit, FitEdit>;

inline constexpr int kMaxEdits = 1000;

struct EditedNetwork {
  CurveNetwork network;
  std::vector<int> edge_of;          // of each edge its place before the edits, -1 for a new one
  std::vector<ReachedGoal> reached;  // of all goals, in order
  // FACES_SPLIT, an info. Warnings: GOAL_NOT_REACHED, one for each goal that was missed, goals that
  // contradict each other among them.
  Diagnostics findings;
};

// Errors: INVALID_ARGUMENT with the path of the edit ("edits[2].face = 9; must be in [0, 5]"). The same
// error is returned if an edit needs the surface before it and the network cannot be joined. Also the
// errors of `run`, which is checked before each edit. Cost: O(1) for an edit. ControlPointEdit,
// CurvatureEdit, GuideEdit, ReachEdit and a NormalEdit with a face join the network first if it was edited
// since it was last joined.
absl::StatusOr<EditedNetwork> EditNetwork(CurveNetwork network, const std::vector<NetworkEdit>& edits,
                                          const RunContext& run = {});
// Edits a network that is joined already: `joined` is the result of JoinNetwork(network).
absl::StatusOr<EditedNetwork> EditNetwork(CurveNetwork network, const JoinedNetwork& joined,
                                          const std::vector<NetworkEdit>& edits, const RunContext& run);

}  // namespace patchmill
