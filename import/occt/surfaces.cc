#include "import/occt/surfaces.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <GeomConvert.hxx>
#include <Geom_BSplineSurface.hxx>
#include <Geom_BezierSurface.hxx>
#include <Geom_ConicalSurface.hxx>
#include <Geom_CylindricalSurface.hxx>
#include <Geom_OffsetSurface.hxx>
#include <Geom_Plane.hxx>
#include <Geom_RectangularTrimmedSurface.hxx>
#include <Geom_SphericalSurface.hxx>
#include <Geom_SurfaceOfLinearExtrusion.hxx>
#include <Geom_SurfaceOfRevolution.hxx>
#include <Geom_ToroidalSurface.hxx>
#include <absl/status/status.h>
#include <absl/strings/str_format.h>

#include "core/base/status.h"
#include "core/patch/patch.h"
#include "import/occt/convert.h"
#include "import/occt/curves.h"
#include "import/occt/fit_surface.h"
#include "import/occt/spline_surfaces.h"

namespace patchmill {
namespace {

template <class Kind>
Handle(Kind) As(const Handle(Geom_Surface) & surface) {
  return Handle(Kind)::DownCast(surface);
}

BrepSurface Elementary(const Handle(Geom_Surface) & bare) {
  if (const auto cylinder = As<Geom_CylindricalSurface>(bare)) {
    return BrepCylinder{ToFrame(cylinder->Position()), cylinder->Radius()};
  }
  if (const auto cone = As<Geom_ConicalSurface>(bare)) {
    return BrepCone{ToFrame(cone->Position()), cone->RefRadius(), cone->SemiAngle()};
  }
  if (const auto sphere = As<Geom_SphericalSurface>(bare)) {
    return BrepSphere{ToFrame(sphere->Position()), sphere->Radius()};
  }
  if (const auto torus = As<Geom_ToroidalSurface>(bare)) {
    return BrepTorus{ToFrame(torus->Position()), torus->MajorRadius(), torus->MinorRadius()};
  }
  return BrepPlane{ToFrame(Handle(Geom_ElementarySurface)::DownCast(bare)->Position())};
}

// One direction of a surface: where it ends by itself, or after how much it repeats.
struct NaturalRange {
  double low = 0.0, high = 0.0, period = 0.0;  // period 0: none
};

// The needed range, widened where the face does not end along it, and never beyond the surface's own ends.
struct CutRange {
  double low = 0.0, high = 0.0;
};
CutRange CutTo(const NeededParameters::Range& needed, const NaturalRange& natural) {
  // Borders bend between the places at which they were sampled.
  constexpr double kMargin = 0.01;
  // A part this short beside an end of the surface is not cut off.
  constexpr double kSliver = 1e-6;
  const double length = needed.high - needed.low;
  CutRange cut = {needed.low - (needed.low_exact ? 0.0 : kMargin * length),
                  needed.high + (needed.high_exact ? 0.0 : kMargin * length)};
  if (natural.period > 0.0) {
    if (cut.high - cut.low < natural.period * (1.0 - kSliver)) return cut;
    if (!needed.low_exact && !needed.high_exact) cut.low = 0.5 * (needed.low + needed.high - natural.period);
    cut.low = needed.low_exact ? needed.low : (needed.high_exact ? needed.high - natural.period : cut.low);
    // A whole period that begins beside the origin begins there.
    const double turns = std::round((cut.low - natural.low) / natural.period);
    const double origin = natural.low + turns * natural.period;
    if (std::abs(cut.low - origin) < kSliver * natural.period) cut.low = origin;
    cut.high = cut.low + natural.period;
    return cut;
  }
  const double sliver = kSliver * length;
  if (cut.low < natural.low + sliver) cut.low = natural.low;
  if (cut.high > natural.high - sliver) cut.high = natural.high;
  return cut;
}

struct NaturalBox {
  NaturalRange u, v;
};
NaturalBox NaturalOf(const Geom_Surface& s) {
  NaturalBox box;
  s.Bounds(box.u.low, box.u.high, box.v.low, box.v.high);
  if (s.IsUPeriodic()) box.u.period = s.UPeriod();
  if (s.IsVPeriodic()) box.v.period = s.VPeriod();
  return box;
}

// An offset turns over where it lies beyond the centres of curvature.
bool Folds(const Geom_OffsetSurface& offset, const CutRange& u, const CutRange& v) {
  constexpr int kPlaces = 24;
  const Handle(Geom_Surface) basis = offset.BasisSurface();
  for (int i = 0; i <= kPlaces; ++i) {
    for (int j = 0; j <= kPlaces; ++j) {
      const double a = u.low + (u.high - u.low) * i / kPlaces, b = v.low + (v.high - v.low) * j / kPlaces;
      gp_Pnt p;
      gp_Vec du, dv, base_du, base_dv;
      offset.D1(a, b, p, du, dv);
      basis->D1(a, b, p, base_du, base_dv);
      if (du.Crossed(dv).Dot(base_du.Crossed(base_dv)) < 0.0) return true;
    }
  }
  return false;
}

absl::StatusOr<FittedSurface> Approximated(const Handle(Geom_Surface) & bare, const CutRange& u,
                                           const CutRange& v) {
  if (const auto offset = As<Geom_OffsetSurface>(bare)) {
    if (Folds(*offset, u, v)) {
      return absl::InvalidArgumentError(
          absl::StrFormat("OFFSET_FOLDS an offset by %g mm turns over on its surface", offset->Offset()));
    }
  }
  return FitSurface(bare, {u.low, u.high}, {v.low, v.high}, kApproximationError);
}

// Compares the spline with the surface as given, at places of the range.
absl::Status CheckSame(const Geom_Surface& bare, const SurfacePart& part, const CutRange& u,
                       const CutRange& v) {
  const BsplinePatch& patch = std::get<BrepSpline>(part.surface).patch;
  if (!std::all_of(patch.weights.begin(), patch.weights.end(), [](double w) { return w > 0.0; })) {
    return absl::InvalidArgumentError("NEGATIVE_WEIGHT a surface has weights that are not positive");
  }
  const PatchShape shape = patch;
  const double first_u = patch.knots_u[static_cast<std::size_t>(patch.degree_u)],
               last_u = *(patch.knots_u.end() - 1 - patch.degree_u),
               first_v = patch.knots_v[static_cast<std::size_t>(patch.degree_v)],
               last_v = *(patch.knots_v.end() - 1 - patch.degree_v);
  double size = 1.0;
  for (const Vec3& p : patch.points) size = std::max(size, p.norm());
  constexpr int kPlaces = 37;  // no number of knots
  for (int i = 0; i <= kPlaces; ++i) {
    for (int j = 0; j <= kPlaces; ++j) {
      const double a = u.low + (u.high - u.low) * i / kPlaces, b = v.low + (v.high - v.low) * j / kPlaces;
      const Vec2 own = part.Map({a, b});
      const Vec3 p = Position(shape, std::clamp((own.x() - first_u) / (last_u - first_u), 0.0, 1.0),
                              std::clamp((own.y() - first_v) / (last_v - first_v), 0.0, 1.0));
      const double off = (p - ToVec3(bare.Value(a, b))).norm();
      if (!(off <= 1e-8 * size + 2.0 * part.error)) {
        return absl::InvalidArgumentError(absl::StrFormat("a surface differs from its spline by %g mm", off));
      }
    }
  }
  return absl::OkStatus();
}

}  // namespace

Handle(Geom_Surface) BareSurface(const Handle(Geom_Surface) & surface) {
  Handle(Geom_Surface) bare = surface;
  while (const auto trimmed = As<Geom_RectangularTrimmedSurface>(bare)) bare = trimmed->BasisSurface();
  if (const auto offset = As<Geom_OffsetSurface>(bare)) {
    const Handle(Geom_Surface) basis = BareSurface(offset->BasisSurface());
    if (IsElementary(*basis)) {
      const Handle(Geom_OffsetSurface) plain = new Geom_OffsetSurface(basis, offset->Offset(), true);
      const Handle(Geom_Surface) equal = plain->Surface();
      if (!equal.IsNull() && IsElementary(*equal) &&
          equal->Value(0.3, 0.2).Distance(offset->Value(0.3, 0.2)) < 1e-7 &&
          equal->Value(1.7, -0.4).Distance(offset->Value(1.7, -0.4)) < 1e-7) {
        return equal;
      }
    }
  }
  return bare;
}

bool IsElementary(const Geom_Surface& bare) { return bare.IsKind(STANDARD_TYPE(Geom_ElementarySurface)); }

absl::StatusOr<SurfacePart> SurfaceOver(const Handle(Geom_Surface) & bare, const NeededParameters& needed) {
  SurfacePart part;
  if (IsElementary(*bare)) {
    part.surface = Elementary(bare);
    return part;
  }
  const NaturalBox natural = NaturalOf(*bare);
  const CutRange u = CutTo(needed.u, natural.u), v = CutTo(needed.v, natural.v);
  if (!(u.low < u.high && v.low < v.high) || !std::isfinite(u.high - u.low) ||
      !std::isfinite(v.high - v.low)) {
    return absl::InvalidArgumentError("the face has no extent on its surface");
  }
  part.same_parameters = false;
  part.u = {ParameterMap::Kind::kShift, u.low, u.high, 1, 0.0};
  part.v = {ParameterMap::Kind::kShift, v.low, v.high, 1, 0.0};
  BsplinePatch patch;
  if (const auto extrusion = As<Geom_SurfaceOfLinearExtrusion>(bare)) {
    PM_ASSIGN_OR_RETURN(const CurvePart basis, CurveBetween(extrusion->BasisCurve(), u.low, u.high));
    patch = Extruded(basis.curve, ToVec3(extrusion->Direction()), v.low, v.high);
    part.u = basis.map;
    part.error = basis.error;
  } else if (const auto revolution = As<Geom_SurfaceOfRevolution>(bare)) {
    PM_ASSIGN_OR_RETURN(const CurvePart meridian, CurveBetween(revolution->BasisCurve(), v.low, v.high));
    const gp_Ax1 axis = revolution->Axis();
    RevolvedSpline turned =
        Revolved(meridian.curve, ToVec3(axis.Location()), ToVec3(axis.Direction()), u.low, u.high);
    patch = std::move(turned.patch);
    part.u = turned.u;
    part.v = meridian.map;
    part.error = meridian.error;
  } else {
    Handle(Geom_BSplineSurface) spline = As<Geom_BSplineSurface>(bare);
    if (const auto bezier = As<Geom_BezierSurface>(bare))
      spline = GeomConvert::SurfaceToBSplineSurface(bezier);
    if (spline.IsNull() || spline->UDegree() > kMaxSplineDegree || spline->VDegree() > kMaxSplineDegree) {
      PM_ASSIGN_OR_RETURN(FittedSurface fitted, Approximated(bare, u, v));
      patch = std::move(fitted.patch);
      part.error = fitted.error;
    } else {
      spline = Cut(spline, u.low, u.high, v.low, v.high);
      PM_ASSIGN_OR_RETURN(patch, Copied(*spline));
      double first_u = 0.0, last_u = 0.0, first_v = 0.0, last_v = 0.0;
      spline->Bounds(first_u, last_u, first_v, last_v);
      part.u.shift = first_u - u.low;
      part.v.shift = first_v - v.low;
    }
  }
  part.surface = BrepSpline{std::move(patch)};
  PM_RETURN_IF_ERROR(CheckSame(*bare, part, u, v));
  return part;
}

}  // namespace patchmill
