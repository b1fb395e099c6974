// The data that the steps of joining share: the network, its topology, the corner normals, the findings.
#pragma once

#include <array>
#include <vector>

#include "core/joining/corner_normals.h"
#include "core/joining/join_network.h"
#include "core/joining/network_findings.h"

namespace patchmill {

struct JoinFrame {
  CurveNetwork& network;  // vertices on edges get their places while edges are made
  const EdgeTable& table;
  std::vector<std::array<CornerNormal, 4>> normals;  // of each face corner
  const NetworkWriter& findings;

  // The corner of the side's face at the start (end) of the side's edge.
  int CornerAt(const FaceSide& s, bool start) const;
  const CornerNormal& CornerNormalAt(const FaceSide& s, bool start) const;
  Vec3 NormalAt(const FaceSide& s, bool start) const { return CornerNormalAt(s, start).unit; }

  // Outgoing tangent of a face's side at its first (last) corner.
  Vec3 Outgoing(const std::vector<JoinedEdge>& edges, const FaceSide& s, bool first) const;
  // Outgoing tangent of the face's other edge at the start (end) of the edge of side `s`.
  Vec3 Beside(const std::vector<JoinedEdge>& edges, const FaceSide& s, bool start) const;

  Where Place(const JoinedEdge& edge) const;
};

}  // namespace patchmill
