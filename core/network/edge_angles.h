// Measures by how much the tangent planes of two patches differ along their shared edge.
#pragma once

#include <optional>
#include <vector>

#include "core/base/run_context.h"
#include "core/network/edge_curves.h"

namespace patchmill {

// Unit u x v at native parameters. Where it vanishes, it is taken a little further inside the patch; nullopt
// if it vanishes there, too.
std::optional<Vec3> PatchNormal(const PatchShape& shape, const Vec2& uv);

// Whether an edge runs counter-clockwise around its patch, in the plane of u and v, as its parameter grows.
inline bool RunsAroundPatch(int edge) { return edge <= 1; }

// The largest angle between the normals of two patches along edge `e`, at its samples, both turned to one
// side of the sheet. Edge `f` of the other patch is the same, or longer. `reversed`: the parameters run in
// opposite directions.
double AngleAlong(const EdgeCurves& curves, int e, int f, bool reversed);

// Fills max_angle of every linked edge from the sampled points of its lower-numbered partner. Exact at those
// points. The error is 1e-3 rad or less where an edge ends in a pole.
void MeasureAngles(const EdgeCurves& curves, const RunContext& run, std::vector<EdgeLink>& links);

}  // namespace patchmill
