// The fields of line_fields.h as polynomials over a piece [lines, section 3]: products of its Bernstein net
// and its derivatives, for the axis z; other axes by turning the net first.
#pragma once

#include <optional>

#include "core/lines/bernstein_form.h"
#include "core/patch/piece.h"

namespace patchmill {

// Each has the sign of its field where the piece has a normal (SlopeForm that of |n_z| - |cosine|);
// coefficients that are rounding, some 1e-14 of what they could be times distance from the origin over
// extent, count as such. Degrees for a piece of bidegree n, polynomial and rational: turn 2n-1, 3n-1; slope
// 4n-2, 6n-2; eye 3n-1, 3n-1; contour curvature 5n-3, 8n-3; slope extremum 7n-4, 11n-4; level n. Nothing
// where the degree would be above 30. Cost: fourth power of the degree; about 10 us for the curvature of a
// bicubic, 100 us rational.
std::optional<BernsteinForm> TurnForm(const BernsteinNet& net);
std::optional<BernsteinForm> SlopeForm(const BernsteinNet& net, double cosine);
std::optional<BernsteinForm> EyeForm(const BernsteinNet& net, const Vec3& eye);
std::optional<BernsteinForm> ContourCurvatureForm(const BernsteinNet& net);
std::optional<BernsteinForm> SlopeExtremumForm(const BernsteinNet& net);
std::optional<BernsteinForm> LevelForm(const BernsteinNet& net, const Vec3& axis, double level);

}  // namespace patchmill
