// Edits of a curve network, one after the other [editing]. What no edit touches stays as it is, to
// the bit, and so do the patches made from it.
#pragma once

#include <array>
#include <optional>
#include <variant>
#include <vector>

#include <absl/status/statusor.h>

#include "core/base/run_context.h"
#include "core/joining/curve_network.h"

namespace patchmill {

// Pushes a face in or out at a place, on top of what it is pushed already.
struct PushEdit {
  int face = 0;
  FacePush push;
};

// Turns a vertex normal: the one of `face` and of the faces that meet it smoothly there; of all faces when
// none is named and the vertex has no more than one.
struct NormalEdit {
  int vertex = 0;
  std::optional<int> face;
  Vec3 direction = Vec3::Zero();  // any length but zero
};

// First- and second-order control vectors [editing, section 3]; what is not given stays. The same vectors of
// the face across are dropped: it follows.
struct ControlEdit {
  CrossControl control;
};

// A face's side at an edge, the edge by its two vertices in either order.
struct EdgeOfFace {
  int start = 0, end = 0, face = 0;
};

// Moves the user's control point Q1 (the tangent plane at Q0 turns, Q2 follows from the edge's ends) or Q2
// (Q0 and Q1 stay) of an edge [editing, section 3].
struct ControlPointEdit {
  EdgeOfFace at;
  int point = 1;  // 1 or 2
  Vec3 position = Vec3::Zero();
};

// Curvature of the section across the middle of the edge, 1/mm, > 0 the way it bends now when that is towards
// the face's S_u x S_v [editing, section 4]. Q0, Q1 and the direction of the second derivative stay.
struct CurvatureEdit {
  EdgeOfFace at;
  double curvature = 0.0;
};

// Corrects a row of faces at once [editing, section 5]: a cubic spline through the middles of the edges
// between them, in the chord parameter, gives all their control vectors across the row. Each edge and the
// next are opposite sides of one G2-Gregory face; closed: the last and the first, too.
struct GuideEdit {
  std::vector<std::array<int, 2>> edges;  // two or more (closed: three), by their vertices
  bool closed = false;
  std::optional<Vec3> start, end;  // directions there, any length but zero; natural where not given
};

using NetworkEdit =
    std::variant<PushEdit, NormalEdit, ControlEdit, ControlPointEdit, CurvatureEdit, GuideEdit>;

inline constexpr int kMaxEdits = 1000;

// Errors: INVALID_ARGUMENT with the path of the edit ("edits[2].face = 9; must be in [0, 5]"), also where the
// network cannot be joined before an edit that asks for its surface; those of `run`, asked before each edit.
// Cost: O(1) for an edit; ControlPointEdit, CurvatureEdit, GuideEdit and a NormalEdit of a face join the
// network first when another edit went before.
absl::StatusOr<CurveNetwork> EditNetwork(CurveNetwork network, const std::vector<NetworkEdit>& edits,
                                         const RunContext& run = {});

}  // namespace patchmill
