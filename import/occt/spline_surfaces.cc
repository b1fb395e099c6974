#include "import/occt/spline_surfaces.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include <absl/status/status.h>

#include "core/base/index.h"
#include "import/occt/convert.h"

namespace patchmill {
namespace {

std::vector<double> WeightsOf(const BrepCurve& curve) {
  return curve.weights.empty() ? std::vector<double>(curve.points.size(), 1.0) : curve.weights;
}

// Clamped, as many knots as it needs, and no inner knot more often than the degree.
bool FitsCore(const std::vector<double>& knots, int degree, int points) {
  if (knots.size() != At(points + degree + 1) || !std::is_sorted(knots.begin(), knots.end())) return false;
  if (knots.front() != knots[At(degree)] || knots.back() != knots[At(points)]) return false;
  for (int k = 1; k < points; ++k) {
    if (knots[At(k)] == knots[At(k + degree)]) return false;
  }
  return true;
}

}  // namespace

BsplinePatch Extruded(const BrepCurve& basis, const Vec3& direction, double low, double high) {
  BsplinePatch patch;
  patch.degree_u = basis.degree;
  patch.degree_v = 1;
  patch.knots_u = basis.knots;
  patch.knots_v = {low, low, high, high};
  for (std::size_t i = 0; i < basis.points.size(); ++i) {
    patch.points.push_back(basis.points[i] + low * direction);
    patch.points.push_back(basis.points[i] + high * direction);
    if (!basis.weights.empty()) patch.weights.insert(patch.weights.end(), 2, basis.weights[i]);
  }
  return patch;
}

RevolvedSpline Revolved(const BrepCurve& meridian, const Vec3& origin, const Vec3& axis, double low,
                        double high) {
  const int spans = std::max(1, static_cast<int>(std::ceil((high - low) / (0.5 * kPi) - 1e-9)));
  const double step = (high - low) / spans, weight = std::cos(0.5 * step);
  const std::vector<double> weights = WeightsOf(meridian);
  RevolvedSpline turned;
  turned.u = {ParameterMap::Kind::kCircular, low, high, spans, 0.0};
  BsplinePatch& patch = turned.patch;
  patch.degree_u = 2;
  patch.degree_v = meridian.degree;
  patch.knots_v = meridian.knots;
  patch.knots_u = {low, low, low};
  for (int k = 1; k < spans; ++k) patch.knots_u.insert(patch.knots_u.end(), 2, low + k * step);
  patch.knots_u.insert(patch.knots_u.end(), 3, high);
  for (int i = 0; i <= 2 * spans; ++i) {
    const double angle = low + 0.5 * i * step, c = std::cos(angle), s = std::sin(angle);
    const double out = i % 2 == 0 ? 1.0 : 1.0 / weight;
    for (std::size_t j = 0; j < meridian.points.size(); ++j) {
      const Vec3 foot = origin + axis.dot(meridian.points[j] - origin) * axis;
      const Vec3 x = meridian.points[j] - foot, y = axis.cross(x);
      patch.points.push_back(foot + out * (c * x + s * y));
      patch.weights.push_back(weights[j] * (i % 2 == 0 ? 1.0 : weight));
    }
  }
  return turned;
}

Handle(Geom_BSplineSurface)
    Cut(const Handle(Geom_BSplineSurface) & whole, double u_low, double u_high, double v_low, double v_high) {
  Handle(Geom_BSplineSurface) part = Handle(Geom_BSplineSurface)::DownCast(whole->Copy());
  part->Segment(u_low, u_high, v_low, v_high);
  if (part->IsUPeriodic()) part->SetUNotPeriodic();
  if (part->IsVPeriodic()) part->SetVNotPeriodic();
  return part;
}

absl::StatusOr<BsplinePatch> Copied(const Geom_BSplineSurface& spline) {
  BsplinePatch patch;
  patch.degree_u = spline.UDegree();
  patch.degree_v = spline.VDegree();
  const TColStd_Array1OfReal &u = spline.UKnotSequence(), &v = spline.VKnotSequence();
  patch.knots_u.assign(u.begin(), u.end());
  patch.knots_v.assign(v.begin(), v.end());
  const bool rational = spline.IsURational() || spline.IsVRational();
  for (int i = 1; i <= spline.NbUPoles(); ++i) {
    for (int j = 1; j <= spline.NbVPoles(); ++j) {
      patch.points.push_back(ToVec3(spline.Pole(i, j)));
      if (rational) patch.weights.push_back(spline.Weight(i, j));
    }
  }
  if (!FitsCore(patch.knots_u, patch.degree_u, spline.NbUPoles()) ||
      !FitsCore(patch.knots_v, patch.degree_v, spline.NbVPoles())) {
    return absl::InvalidArgumentError("a B-spline surface has knots that do not fit its points, or a tear");
  }
  return patch;
}

}  // namespace patchmill
