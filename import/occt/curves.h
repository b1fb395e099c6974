// Curves of Open CASCADE as rational B-splines.
#pragma once

#include <Geom_Curve.hxx>
#include <Standard_Handle.hxx>
#include <absl/status/statusor.h>

#include "core/brep/brep_model.h"
#include "import/occt/parameter_map.h"

namespace patchmill {

struct CurvePart {
  BrepCurve curve;
  ParameterMap map;    // from the parameters of the curve as given
  double error = 0.0;  // mm, by how much it differs at most from the curve as given; 0 where it is exact
};

// Largest degree of a curve or surface that is kept; those above are approximated.
inline constexpr int kMaxSplineDegree = 15;
// Accuracy of an approximation, mm.
inline constexpr double kApproximationError = 1e-5;

// The part of the curve between two of its parameters. Lines, conic sections, Bezier curves and B-splines are
// exact; conics have spans of equal angle, at most 90 degrees, and hyperbolas spans of at most 1. Others, and
// degrees above 15, are approximated. Periodic curves may be cut beyond their origin. A range that leaves a
// curve with ends is cut there. INVALID_ARGUMENT for an empty range and for what cannot be converted. May
// throw Standard_Failure.
absl::StatusOr<CurvePart> CurveBetween(const Handle(Geom_Curve) & curve, double first, double last);

}  // namespace patchmill
