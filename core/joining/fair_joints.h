// The joints of a G2 network at which the vectors across the edges can be estimated [joining, section 10].
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "core/joining/face_frame.h"

namespace patchmill {

// One end of an edge between two faces, with t along the edge away from this end. The first and the second
// face are those of the edge. The derivatives across the edge of their crossing curves meet as [joining
// (30)]:
//   S2_n = -ratio S1_n,   S2_nn = ratio^2 S1_nn + second,   S2_nnn = -ratio^3 S1_nnn + third.
struct JointEnd {
  double ratio = 1.0;
  Vec3 second = Vec3::Zero(), third = Vec3::Zero();
  // Their derivatives with respect to t: from the parabola through this vertex, the next one along the edge
  // and the one before, where the line of edges goes on, else the one after next, else from the straight
  // line.
  double ratio_slope = 0.0;
  Vec3 second_slope = Vec3::Zero(), third_slope = Vec3::Zero();
};

struct FairJoints {
  // For each edge the ends at its start and at its end, if it is a joint.
  std::vector<std::optional<std::array<JointEnd, 2>>> ends;
  // Faces with at least one joint whose other sides are joints, borders or creases.
  std::vector<bool> faces;
};

// A joint is a smooth edge between two faces of `faces`. The curves that cross it at its ends continue each
// other with one direction and one curvature.
FairJoints FindFairJoints(const CurvedNetwork& curved);

}  // namespace patchmill
