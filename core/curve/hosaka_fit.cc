#include "core/curve/hosaka_fit.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/base/status.h"

namespace patchmill {
namespace {

double F(double t) { return t * t * (3.0 - 2.0 * t); }
double G(double t) { return t * (t - 1.0) * (t - 1.0); }
double H(double t) { return t * t * (t - 1.0); }

double Cubic(const std::array<double, 4>& a, double t) { return ((a[0] * t + a[1]) * t + a[2]) * t + a[3]; }

absl::Status CheckLengths(const HosakaFit& fit) {
  if (fit.b > 0.0 && fit.c > 0.0 && std::isfinite(fit.b) && std::isfinite(fit.c)) return absl::OkStatus();
  return absl::InvalidArgumentError(
      fmt::format("needs end derivatives of length {:g} and {:g}; both must be > 0", fit.b, fit.c));
}

}  // namespace

absl::StatusOr<Eigen::Matrix3d> HosakaAxes(const HosakaSegment& s) {
  const Vec3 across = s.a.cross(s.b);
  if (!(across.norm() > 1e-12 * s.a.norm() * s.b.norm())) {
    return absl::InvalidArgumentError("the segment starts along its chord; its plane is undefined");
  }
  Eigen::Matrix3d axes;
  axes.row(0) = s.a.normalized();
  axes.row(2) = across.normalized();
  axes.row(1) = Vec3(axes.row(2)).cross(Vec3(axes.row(0)));
  return axes;
}

std::optional<double> ChordCrossing(double by, double cy) {
  if (!(by * cy > 0.0)) return std::nullopt;
  return by / (by + cy);
}

std::optional<std::pair<double, double>> FindLoop(double chord, const Vec2& b, const Vec2& c) {
  // p = -g1, q = -h1 in the paper's letters.
  const double det = (chord - b.x()) * c.y() - (chord - c.x()) * b.y();
  if (det == 0.0) return std::nullopt;
  const double g1 = chord * c.y() / det, h1 = -chord * b.y() / det;
  const double sum = 1.0 - g1 + h1, product = sum * sum - sum - h1;
  const double d = 0.25 * sum * sum - product;
  if (!(d >= 0.0)) return std::nullopt;
  const double far = 0.5 * sum + std::copysign(std::sqrt(d), sum);  // no cancellation
  const double near = far == 0.0 ? 0.0 : product / far;
  const auto [first, last] = std::minmax(near, far);
  if (!(first >= 0.0 && last <= 1.0)) return std::nullopt;
  return std::pair{first, last};
}

std::optional<std::pair<double, double>> FindLoop(const HermiteCurve& curve) {
  const Vec3 chord = curve.p1 - curve.p0;
  const double length = chord.norm();
  if (!(length > 0.0)) return std::nullopt;
  const Vec3 x = chord / length, by_first = x.cross(curve.d0), by_last = x.cross(curve.d1);
  const Vec3 z = by_first.norm() >= by_last.norm() ? by_first : by_last;
  if (!(z.norm() > 1e-9 * length)) return std::nullopt;
  const Vec3 y = z.normalized().cross(x);
  return FindLoop(length, {x.dot(curve.d0), y.dot(curve.d0)}, {x.dot(curve.d1), y.dot(curve.d1)});
}

absl::StatusOr<HosakaFit> FitThroughPoint(double chord, const Vec3& b, const Vec3& c, const Vec3& q) {
  if (c.z() == 0.0 || b.y() == 0.0 || q.z() == 0.0) {
    return absl::InvalidArgumentError(
        "needs a point off the start plane, an end direction out of it and a "
        "start direction off the chord");
  }
  // [curves (18)]: A f(t) = x - z cos(gx)/cos(gz) - (y - z cos(gy)/cos(gz)) cos(bx)/cos(by)
  const double f = (q.x() - q.z() * c.x() / c.z() - (q.y() - q.z() * c.y() / c.z()) * b.x() / b.y()) / chord;
  if (!(f > 0.0 && f < 1.0)) {
    return absl::InvalidArgumentError(fmt::format(
        "no segment with these directions passes through the point (f = {:g}; must be in (0, 1))", f));
  }
  HosakaFit fit;
  fit.t = 0.5 - std::sin(std::asin(1.0 - 2.0 * f) / 3.0);
  fit.c = q.z() / (c.z() * H(fit.t));
  fit.b = (q.y() - fit.c * c.y() * H(fit.t)) / (b.y() * G(fit.t));
  PM_RETURN_IF_ERROR(CheckLengths(fit));
  return fit;
}

absl::StatusOr<HosakaFit> FitPeak(double, const Vec3& b, const Vec3& c, double y, double z) {
  if (c.z() == 0.0 || b.y() == 0.0) {
    return absl::InvalidArgumentError(
        "needs an end direction out of the start plane and a start direction "
        "off the chord");
  }
  HosakaFit fit;
  fit.t = 2.0 / 3.0;
  fit.c = -27.0 * z / (4.0 * c.z());
  fit.b = 13.5 * (y + 4.0 / 27.0 * fit.c * c.y()) / b.y();
  PM_RETURN_IF_ERROR(CheckLengths(fit));
  return fit;
}

std::array<double, 4> SlopeCubic(double chord, double beta, double gamma, const Vec2& q, double theta) {
  const double sb = std::sin(beta), cb = std::cos(beta), sg = std::sin(gamma), cg = std::cos(gamma);
  const double st = std::sin(theta), ct = std::cos(theta);
  const double at_b = q.y() * cb - q.x() * sb, at_g = q.y() * cg - q.x() * sg;  // r sin(theta' - ..)
  const double b_t = std::sin(beta - theta), g_t = std::sin(gamma - theta);
  return {chord * (2.0 * sb * sg * ct - st * std::sin(beta + gamma)), 3.0 * chord * sg * (st * cb - sb * ct),
          3.0 * std::sin(gamma - beta) * (q.y() * ct - q.x() * st), at_g * b_t - 2.0 * at_b * g_t};
}

absl::StatusOr<std::vector<HosakaFit>> FitSlope(double chord, double beta, double gamma, const Vec2& q,
                                                double theta) {
  const double s = std::sin(gamma - beta);
  if (!(std::abs(s) > 1e-12)) {
    return absl::InvalidArgumentError("the end tangents are parallel; their lengths cannot be told apart");
  }
  std::vector<HosakaFit> fits;
  for (const double t : RootsInUnitInterval(SlopeCubic(chord, beta, gamma, q, theta))) {
    const double x = q.x() - chord * F(t);
    HosakaFit fit;
    fit.t = t;
    fit.b = (x * std::sin(gamma) - q.y() * std::cos(gamma)) / (s * G(t));
    fit.c = (q.y() * std::cos(beta) - x * std::sin(beta)) / (s * H(t));
    if (CheckLengths(fit).ok()) fits.push_back(fit);
  }
  return fits;
}

absl::StatusOr<std::vector<HosakaFit>> FitExtremum(double chord, double beta, double gamma, const Vec2& q) {
  return FitSlope(chord, beta, gamma, q, 0.0);
}

ExtraTerm FitExtraTerm(double t, double y, double dy, double y_without, double dy_without) {
  const double r = t * (t - 1.0), w = r * r, w1 = 2.0 * r * (2.0 * t - 1.0);
  const double value = (y - y_without) / w;                 // d0 + d1 t
  const double slope = (dy - dy_without - w1 * value) / w;  // d1
  return {value - slope * t, slope};
}

Vec3 FitExtraAtPeak(const HosakaSegment& segment, double y, double z) {
  constexpr double t = 2.0 / 3.0;
  HosakaSegment plain = segment;
  plain.extra.clear();
  const Vec3 at = Evaluate(plain, t).p - segment.origin;
  const double w = t * t * (t - 1.0) * (t - 1.0);
  return {0.0, (y - at.y()) / w, (z - at.z()) / w};
}

std::vector<double> RootsInUnitInterval(const std::array<double, 4>& a) {
  // The cubic is monotone between the zeros of its derivative.
  std::vector<double> stops = {0.0};
  const double p = 3.0 * a[0], h = a[1], r = a[2];  // p t^2 + 2 h t + r
  const double d = h * h - p * r;
  if (d > 0.0) {
    const double m = -(h + std::copysign(std::sqrt(d), h));
    for (const double t : {p != 0.0 ? m / p : -1.0, m != 0.0 ? r / m : -1.0}) {
      if (t > 0.0 && t < 1.0) stops.push_back(t);
    }
  }
  stops.push_back(1.0);
  std::sort(stops.begin(), stops.end());
  std::vector<double> roots;
  const auto add = [&](double t) {
    if (t > 0.0 && t < 1.0 && (roots.empty() || t > roots.back())) roots.push_back(t);
  };
  for (std::size_t k = 0; k + 1 < stops.size(); ++k) {
    double low = stops[k], high = stops[k + 1];
    const double at_low = Cubic(a, low), at_high = Cubic(a, high);
    if (at_low == 0.0) add(low);
    if (!(at_low * at_high < 0.0)) continue;  // a zero at_high is the next stretch's at_low
    for (;;) {
      const double middle = 0.5 * (low + high);
      if (middle <= low || middle >= high) break;
      ((Cubic(a, middle) > 0.0) == (at_low > 0.0) ? low : high) = middle;
    }
    add(std::abs(Cubic(a, low)) < std::abs(Cubic(a, high)) ? low : high);
  }
  return roots;
}

}  // namespace patchmill
