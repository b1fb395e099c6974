// Rational B-splines over rectangles of other surfaces.
#pragma once

#include <Geom_BSplineSurface.hxx>
#include <Standard_Handle.hxx>
#include <absl/status/statusor.h>

#include "core/brep/brep_model.h"
#include "core/patch/patch.h"
#include "import/occt/parameter_map.h"

namespace patchmill {

// basis(u) + v direction, for v in [low, high].
BsplinePatch Extruded(const BrepCurve& basis, const Vec3& direction, double low, double high);

// meridian(v) turned about the axis by u in [low, high], at most one turn. Spans of u have at most 90
// degrees.
struct RevolvedSpline {
  BsplinePatch patch;
  ParameterMap u;
};
RevolvedSpline Revolved(const BrepCurve& meridian, const Vec3& origin, const Vec3& axis, double low,
                        double high);

// The rectangle of a spline, with clamped ends, not periodic. Knots may be shifted by whole periods.
Handle(Geom_BSplineSurface)
    Cut(const Handle(Geom_BSplineSurface) & whole, double u_low, double u_high, double v_low, double v_high);

// INVALID_ARGUMENT for knots that core/patch does not take.
absl::StatusOr<BsplinePatch> Copied(const Geom_BSplineSurface& spline);

}  // namespace patchmill
