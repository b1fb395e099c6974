// The fields of line_fields.h as polynomials over a piece [lines, section 3]: products of its Bernstein net
// and its derivatives. They are for the axis z; for other axes the net is turned first.
#pragma once

#include <optional>

#include "core/lines/bernstein_form.h"
#include "core/patch/piece.h"

namespace patchmill {

// Each form has the sign of its field where the piece has a normal; SlopeForm has the sign of |n_z| -
// |cosine|. Coefficients that are rounding count as zero: some 1e-14 of their largest possible value, times
// the distance from the origin divided by the extent. Degrees for a piece of bidegree n, polynomial and
// rational: turn 2n-1, 3n-1; slope 4n-2, 6n-2; eye 3n-1, 3n-1; contour curvature 5n-3, 8n-3; slope extremum
// 7n-4, 11n-4; level n. nullopt where the degree would be above 30. Cost: the fourth power of the degree;
// about 10 us for the curvature form of a bicubic, 100 us for a rational one.
std::optional<BernsteinForm> TurnForm(const BernsteinNet& net);
std::optional<BernsteinForm> SlopeForm(const BernsteinNet& net, double cosine);
std::optional<BernsteinForm> EyeForm(const BernsteinNet& net, const Vec3& eye);
std::optional<BernsteinForm> ContourCurvatureForm(const BernsteinNet& net);
std::optional<BernsteinForm> SlopeExtremumForm(const BernsteinNet& net);
std::optional<BernsteinForm> LevelForm(const BernsteinNet& net, const Vec3& axis, double level);

}  // namespace patchmill
