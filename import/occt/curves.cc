#include "import/occt/curves.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <utility>

#include <ElCLib.hxx>
#include <GeomConvert.hxx>
#include <GeomConvert_ApproxCurve.hxx>
#include <Geom_BSplineCurve.hxx>
#include <Geom_BezierCurve.hxx>
#include <Geom_Circle.hxx>
#include <Geom_Conic.hxx>
#include <Geom_Ellipse.hxx>
#include <Geom_Hyperbola.hxx>
#include <Geom_Line.hxx>
#include <Geom_Parabola.hxx>
#include <Geom_TrimmedCurve.hxx>
#include <absl/status/status.h>

#include "core/base/index.h"
#include "core/base/status.h"
#include "import/occt/convert.h"

namespace patchmill {
namespace {

constexpr double kShortestRange = 1e-14;  // of the size of the parameters

BrepCurve Straight(const Vec3& a, const Vec3& b, double first, double last) {
  return {1, {first, first, last, last}, {a, b}, {}};
}

// Arcs of a conic section in equal steps of its parameter. `at` gives points, `middle` the middle control
// point over the parameter half-way, `weight` its weight.
CurvePart Arcs(ParameterMap map, const std::function<Vec3(double)>& at,
               const std::function<Vec3(double)>& middle, double weight) {
  CurvePart part;
  part.map = map;
  BrepCurve& c = part.curve;
  c.degree = 2;
  const double step = (map.last - map.first) / map.spans;
  c.knots = {map.first, map.first, map.first};
  c.points = {at(map.first)};
  c.weights = {1.0};
  for (int k = 0; k < map.spans; ++k) {
    const double to = k + 1 == map.spans ? map.last : map.first + (k + 1) * step;
    c.points.push_back(middle(map.first + (k + 0.5) * step));
    c.points.push_back(at(to));
    c.weights.insert(c.weights.end(), {weight, 1.0});
    c.knots.insert(c.knots.end(), {to, to});
  }
  c.knots.push_back(map.last);
  return part;
}

// center + cos t x + sin t y, with x and y of the lengths of the radii.
CurvePart EllipseArcs(const Vec3& center, const Vec3& x, const Vec3& y, double first, double last) {
  const int spans = std::max(1, static_cast<int>(std::ceil((last - first) / (0.5 * kPi) - 1e-9)));
  const double weight = std::cos(0.5 * (last - first) / spans);
  const auto on = [&](double t, double scale) {
    return Vec3(center + scale * (std::cos(t) * x + std::sin(t) * y));
  };
  return Arcs(
      {ParameterMap::Kind::kCircular, first, last, spans, 0.0}, [&](double t) { return on(t, 1.0); },
      [&](double t) { return on(t, 1.0 / weight); }, weight);
}

CurvePart HyperbolaArcs(const Vec3& center, const Vec3& x, const Vec3& y, double first, double last) {
  const int spans = std::max(1, static_cast<int>(std::ceil(last - first)));
  const double weight = std::cosh(0.5 * (last - first) / spans);
  const auto on = [&](double t, double scale) {
    return Vec3(center + scale * (std::cosh(t) * x + std::sinh(t) * y));
  };
  return Arcs(
      {ParameterMap::Kind::kHyperbolic, first, last, spans, 0.0}, [&](double t) { return on(t, 1.0); },
      [&](double t) { return on(t, 1.0 / weight); }, weight);
}

// The polynomial quadratic between two parameters of the parabola: the middle control point lies where the
// end tangents meet.
CurvePart ParabolaArc(const gp_Parab& parabola, double first, double last) {
  const Vec3 a = ToVec3(ElCLib::Value(first, parabola)), b = ToVec3(ElCLib::Value(last, parabola));
  gp_Pnt p;
  gp_Vec d;
  ElCLib::D1(first, parabola, p, d);
  CurvePart part;
  part.map = {ParameterMap::Kind::kShift, first, last, 1, 0.0};
  const Vec3 middle = a + 0.5 * (last - first) * ToVec3(d.XYZ());
  part.curve = {2, {first, first, first, last, last, last}, {a, middle, b}, {}};
  return part;
}

absl::StatusOr<BrepCurve> Copied(const Geom_BSplineCurve& spline) {
  BrepCurve curve;
  curve.degree = spline.Degree();
  const TColStd_Array1OfReal& knots = spline.KnotSequence();
  curve.knots.assign(knots.begin(), knots.end());
  for (int k = 1; k <= spline.NbPoles(); ++k) {
    curve.points.push_back(ToVec3(spline.Pole(k)));
    if (spline.IsRational()) curve.weights.push_back(spline.Weight(k));
  }
  if (curve.knots.size() != curve.points.size() + At(curve.degree) + 1 || spline.IsPeriodic()) {
    return absl::InvalidArgumentError("a B-spline curve has knots that do not fit its points");
  }
  return curve;
}

// The part of a B-spline between two parameters. Its knots may be shifted by whole periods.
Handle(Geom_BSplineCurve) Cut(const Handle(Geom_BSplineCurve) & whole, double first, double last) {
  Handle(Geom_BSplineCurve) part = Handle(Geom_BSplineCurve)::DownCast(whole->Copy());
  part->Segment(first, last);
  const double size = 1.0 + part->Pole(1).XYZ().Modulus();
  if (part->IsPeriodic() || part->StartPoint().Distance(whole->Value(first)) > 1e-9 * size ||
      part->EndPoint().Distance(whole->Value(last)) > 1e-9 * size) {
    part = GeomConvert::CurveToBSplineCurve(new Geom_TrimmedCurve(whole, first, last));
    if (part->IsPeriodic()) part->SetNotPeriodic();
  }
  return part;
}

absl::StatusOr<CurvePart> SplineBetween(const Handle(Geom_BSplineCurve) & whole, double first, double last) {
  if (!whole->IsPeriodic()) {
    first = std::max(first, whole->FirstParameter());
    last = std::min(last, whole->LastParameter());
    if (!(first < last)) return absl::InvalidArgumentError("an edge lies outside of its curve");
  }
  const Handle(Geom_BSplineCurve) cut = Cut(whole, first, last);
  CurvePart part;
  part.map = {ParameterMap::Kind::kShift, first, last, 1, cut->FirstParameter() - first};
  PM_ASSIGN_OR_RETURN(part.curve, Copied(*cut));
  return part;
}

absl::StatusOr<CurvePart> Approximated(const Handle(Geom_Curve) & curve, double first, double last) {
  const Handle(Geom_TrimmedCurve) trimmed = new Geom_TrimmedCurve(curve, first, last);
  constexpr int kMostSegments = 400, kDegree = 7;
  const GeomConvert_ApproxCurve fit(trimmed, 0.1 * kApproximationError, GeomAbs_C1, kMostSegments, kDegree);
  if (!fit.HasResult()) return absl::InvalidArgumentError("a curve could not be approximated");
  PM_ASSIGN_OR_RETURN(CurvePart part, SplineBetween(fit.Curve(), fit.Curve()->FirstParameter(),
                                                    fit.Curve()->LastParameter()));
  part.map = {ParameterMap::Kind::kShift, first, last, 1, part.map.first + part.map.shift - first};
  // The fit's own figure may be far too small.
  constexpr int kPlaces = 1000;
  double most = 0.0;
  for (int k = 0; k <= kPlaces; ++k) {
    const double t = first + (last - first) * k / kPlaces,
                 own = std::clamp(part.map(t), fit.Curve()->FirstParameter(), fit.Curve()->LastParameter());
    most = std::max(most, fit.Curve()->Value(own).Distance(curve->Value(t)));
  }
  part.error = std::max(fit.MaxError(), 2.0 * most);
  return part;
}

template <class Kind>
Handle(Kind) As(const Handle(Geom_Curve) & curve) {
  return Handle(Kind)::DownCast(curve);
}

}  // namespace

absl::StatusOr<CurvePart> CurveBetween(const Handle(Geom_Curve) & given, double first, double last) {
  Handle(Geom_Curve) curve = given;
  while (const Handle(Geom_TrimmedCurve) trimmed = As<Geom_TrimmedCurve>(curve))
    curve = trimmed->BasisCurve();
  const double size = std::max({1.0, std::abs(first), std::abs(last)});
  if (!std::isfinite(first) || !std::isfinite(last) || !(last - first > kShortestRange * size)) {
    return absl::InvalidArgumentError("a curve has an empty or an infinite range");
  }
  // Conic sections become as many spans as they have quarter turns.
  constexpr double kLongestArc = 1000.0;
  const bool conic = curve->IsKind(STANDARD_TYPE(Geom_Conic)) && !curve->IsKind(STANDARD_TYPE(Geom_Parabola));
  if (conic && last - first > kLongestArc) return absl::InvalidArgumentError("an arc has hundreds of turns");
  if (const Handle(Geom_Line) line = As<Geom_Line>(curve)) {
    CurvePart part;
    part.map = {ParameterMap::Kind::kShift, first, last, 1, 0.0};
    part.curve = Straight(ToVec3(line->Value(first)), ToVec3(line->Value(last)), first, last);
    return part;
  }
  if (const Handle(Geom_Circle) circle = As<Geom_Circle>(curve)) {
    const gp_Ax2& a = circle->Position();
    return EllipseArcs(ToVec3(a.Location()), circle->Radius() * ToVec3(a.XDirection()),
                       circle->Radius() * ToVec3(a.YDirection()), first, last);
  }
  if (const Handle(Geom_Ellipse) ellipse = As<Geom_Ellipse>(curve)) {
    const gp_Ax2& a = ellipse->Position();
    return EllipseArcs(ToVec3(a.Location()), ellipse->MajorRadius() * ToVec3(a.XDirection()),
                       ellipse->MinorRadius() * ToVec3(a.YDirection()), first, last);
  }
  if (const Handle(Geom_Hyperbola) hyperbola = As<Geom_Hyperbola>(curve)) {
    const gp_Ax2& a = hyperbola->Position();
    return HyperbolaArcs(ToVec3(a.Location()), hyperbola->MajorRadius() * ToVec3(a.XDirection()),
                         hyperbola->MinorRadius() * ToVec3(a.YDirection()), first, last);
  }
  if (const Handle(Geom_Parabola) parabola = As<Geom_Parabola>(curve)) {
    return ParabolaArc(parabola->Parab(), first, last);
  }
  Handle(Geom_BSplineCurve) spline = As<Geom_BSplineCurve>(curve);
  if (const Handle(Geom_BezierCurve) bezier = As<Geom_BezierCurve>(curve)) {
    spline = GeomConvert::CurveToBSplineCurve(bezier);
  }
  if (!spline.IsNull() && spline->Degree() <= kMaxSplineDegree) return SplineBetween(spline, first, last);
  return Approximated(curve, first, last);
}

}  // namespace patchmill
