#include "import/occt/place_curve.h"

#include <algorithm>

#include <Geom2dAdaptor_Curve.hxx>
#include <GeomAdaptor_Curve.hxx>
#include <TColStd_Array1OfReal.hxx>

#include "import/occt/convert.h"

namespace patchmill {

PlaceCurve::PlaceCurve(const Handle(Geom2d_Curve) & curve, double curve_first, double curve_last,
                       double first, double last)
    : flat_(curve),
      first_(first),
      last_(last),
      curve_first_(curve_first),
      scale_((curve_last - curve_first) / (last - first)) {}

PlaceCurve::PlaceCurve(const Handle(Geom_Curve) & curve, const BrepFrame& plane, double first, double last)
    : space_(curve), plane_(plane), first_(first), last_(last) {}

PlaceJet PlaceCurve::At(double t) const {
  PlaceJet jet;
  if (!flat_.IsNull()) {
    gp_Pnt2d p;
    gp_Vec2d d;
    flat_->D1(curve_first_ + scale_ * (t - first_), p, d);
    jet.place = ToVec2(p) + shift_;
    jet.d = scale_ * Vec2(d.X(), d.Y());
  } else {
    gp_Pnt p;
    gp_Vec d;
    space_->D1(t, p, d);
    const Vec3 off = ToVec3(p) - plane_.origin, slope = ToVec3(d.XYZ());
    jet.place = {off.dot(plane_.x), off.dot(plane_.y)};
    jet.d = {slope.dot(plane_.x), slope.dot(plane_.y)};
  }
  return jet;
}

std::vector<double> PlaceCurve::Breaks() const {
  const auto intervals = [](const auto& adaptor) {
    TColStd_Array1OfReal at(1, adaptor.NbIntervals(GeomAbs_CN) + 1);
    adaptor.Intervals(at, GeomAbs_CN);
    return std::vector<double>(at.begin(), at.end());
  };
  std::vector<double> breaks;
  if (!flat_.IsNull()) {
    const double end = curve_first_ + scale_ * (last_ - first_);
    for (const double s : intervals(Geom2dAdaptor_Curve(flat_, curve_first_, end))) {
      breaks.push_back(first_ + (s - curve_first_) / scale_);
    }
  } else {
    breaks = intervals(GeomAdaptor_Curve(space_, first_, last_));
  }
  breaks.front() = first_;
  breaks.back() = last_;
  for (double& t : breaks) t = std::clamp(t, first_, last_);
  std::sort(breaks.begin(), breaks.end());
  return breaks;
}

}  // namespace patchmill
