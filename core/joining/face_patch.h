// Makes the patch of one face from its edge curves and cross-boundary tangents [joining, section 7].
#pragma once

#include <array>
#include <optional>
#include <string>

#include "core/curve/bezier_chain.h"
#include "core/joining/curvature_joint.h"
#include "core/joining/curve_network.h"
#include "core/patch/patch.h"

namespace patchmill {

// Side k runs from corner k to corner k+1 of the face; its tangents point into the face.
struct FaceBoundary {
  int sides = 4;
  std::array<BezierChain, 4> curve;           // degree >= 3
  std::array<BezierChain, 4> tangent;         // degree <= that of the curve
  std::array<CrossRows, 4> rows;              // of a kG2Gregory face only; their ends are those of the curves
  std::array<std::vector<double>, 4> breaks;  // of a kHosaka face only: of its blending functions, f(v) = v
};

// What the edges of a face demand of its scheme.
struct EdgeDemand {
  int degree = 3;  // the highest, >= 3
  int spans = 1;   // the most
  int breaks = 0;  // the most vertices on one edge
};

// Why the face's scheme cannot make a patch from such edges; nullopt if it can.
std::optional<std::string> SchemeFault(const NetworkFace& face, const EdgeDemand& edges);

// SchemeFault must find nothing. Quads: u runs along side 0, v along side 3 reversed. Triangles: the corners
// are (0,0) (1,0) (0,1).
PatchShape MakeFacePatch(const FaceBoundary& face, PatchScheme scheme);

}  // namespace patchmill
