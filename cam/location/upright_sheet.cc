#include "cam/location/upright_sheet.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/surface/distance_form.h"

namespace patchmill::internal {
namespace {

constexpr int kMostParts = 400;
constexpr int kMostHalvings = 40;
// Of the largest coefficient: sums of a few dozen products.
constexpr double kRounding = 64.0 * std::numeric_limits<double>::epsilon();
constexpr double kSameWeight = 4.0 * std::numeric_limits<double>::epsilon();

// Of a polynomial of degree 2 kMaxDegree at most, the first ones.
using Coefficients = std::array<double, kMaxFormDegree + 1>;

struct Positive {
  const std::size_t last;
  const double rounding;
  int parts = kMostParts;

  // Is the polynomial nowhere negative on [0, 1]?
  bool Prove(const Coefficients& c, int halvings) {
    const auto least = *std::min_element(c.begin(), c.begin() + static_cast<std::ptrdiff_t>(last) + 1);
    if (least >= rounding) return true;
    // The ends are values.
    if (c[0] < rounding || c[last] < rounding || --parts < 0 || halvings >= kMostHalvings) return false;
    Coefficients low{}, high = c;
    for (std::size_t k = 0; k <= last; ++k) {
      low[k] = high[0];
      for (std::size_t i = 0; i + k < last; ++i) high[i] = 0.5 * (high[i] + high[i + 1]);
    }
    return Prove(low, halvings + 1) && Prove(high, halvings + 1);
  }
};

// Rows along z: `along` points of `across` each, `stride` and `step` apart.
std::optional<PlanCurve> Swept(const Vec4* points, int along, int stride, int across, int step,
                               double rounding) {
  PlanCurve curve;
  curve.degree = along - 1;
  for (int i = 0; i < along; ++i) {
    const Vec4& first = points[i * stride];
    if (!(first.w() > 0.0)) return std::nullopt;
    const Vec2 plan = first.head<2>() / first.w();
    for (int j = 1; j < across; ++j) {
      const Vec4& p = points[i * stride + j * step];
      if (!(p.w() > 0.0) || std::abs(p.w() - first.w()) > kSameWeight * first.w()) return std::nullopt;
      curve.spread = std::max(curve.spread, (Vec2(p.head<2>() / p.w()) - plan).cwiseAbs().maxCoeff());
      if (curve.spread > rounding) return std::nullopt;
    }
    curve.points[static_cast<std::size_t>(i)] = Vec4(first.x(), first.y(), 0.0, first.w());
  }
  curve.spread = 2.0 * (curve.spread + rounding);  // of both coordinates; weights differ by less
  return curve;
}

}  // namespace

std::optional<PlanCurve> PlanCurveOf(NetShape shape, const Vec4* points, double rounding) {
  const int rows = shape.degree_u + 1, columns = shape.degree_v + 1;
  if (auto curve = Swept(points, rows, columns, columns, 1, rounding)) return curve;
  return Swept(points, columns, 1, rows, columns, rounding);
}

bool OutsideInPlan(const PlanCurve& curve, const Vec2& q, double radius) {
  std::array<Vec4, kMaxDegree + 1> local = curve.points;
  for (Vec4& p : local) p.head<2>() -= p.w() * q;
  DistanceForm form;
  MakeDistanceForm({curve.degree, 0}, local.data(), true, true, radius, form);
  const auto last = static_cast<std::size_t>(form.degree_u);
  Coefficients c{};
  double largest = 0.0;
  for (std::size_t k = 0; k <= last; ++k) {
    c[k] = form.c[k];
    largest = std::max(largest, std::abs(c[k]));
  }
  if (!(largest > 0.0 && largest < std::numeric_limits<double>::infinity())) return false;
  return Positive{last, kRounding * largest}.Prove(c, 0);
}

}  // namespace patchmill::internal
