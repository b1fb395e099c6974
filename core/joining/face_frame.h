// A quad of four cubic edges, seen from one end of one of its sides [joining, section 10].
#pragma once

#include <array>
#include <vector>

#include "core/joining/edge_table.h"
#include "core/joining/join_network.h"

namespace patchmill {

// A network whose edges have their curves.
struct CurvedNetwork {
  const CurveNetwork& network;
  const EdgeTable& table;
  const std::vector<JoinedEdge>& edges;
};

// The side runs from the corner `a` with the parameter t, and n leads away from it, both in [0,1]. The
// corners a, b, c, d have (t, n) = (0,0), (1,0), (0,1), (1,1). They are numbers of corners of the face.
struct FaceFrame {
  using Cubic = std::array<Vec3, 4>;  // Bezier points
  int face = 0;
  int a = 0, b = 0, c = 0, d = 0;
  Cubic ab, ac, bd, cd;  // the edges from corner to corner
};

// All edges of the face must be cubics of one span. `from_first`: a is the first corner of the side.
FaceFrame FrameOf(const CurvedNetwork& curved, const FaceSide& side, bool from_first);
// The frames of both faces of an edge, from its start (end 0) or its end (end 1).
std::array<FaceFrame, 2> FramesAt(const CurvedNetwork& curved, const TableEdge& edge, int end);

FaceFrame FromOtherEnd(const FaceFrame& frame);   // t runs the other way
FaceFrame FromOtherSide(const FaceFrame& frame);  // n runs the other way

// Derivatives of a cubic at its start.
Vec3 FirstAtStart(const FaceFrame::Cubic& cubic);
Vec3 SecondAtStart(const FaceFrame::Cubic& cubic);
Vec3 ThirdAtStart(const FaceFrame::Cubic& cubic);

// A vector that depends linearly on the twists at the corners of a face: constant + sum of factor * twist.
// The twist at a corner is the mixed derivative along the two sides that leave it.
struct TwistForm {
  Vec3 constant = Vec3::Zero();
  std::array<double, 4> factor{};
};
TwistForm operator+(const TwistForm& x, const TwistForm& y);
TwistForm operator-(const TwistForm& x, const TwistForm& y);
TwistForm operator*(double s, const TwistForm& x);

// Derivatives at `a` of the bicubic surface with these edges and twists [joining (28)].
TwistForm Mixed11(const FaceFrame& frame);  // S_tn
TwistForm Mixed12(const FaceFrame& frame);  // S_tnn
TwistForm Mixed13(const FaceFrame& frame);  // S_tnnn
TwistForm Mixed22(const FaceFrame& frame);  // S_ttnn

}  // namespace patchmill
