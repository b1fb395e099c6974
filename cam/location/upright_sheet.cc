#include "cam/location/upright_sheet.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/surface/form_sign.h"

namespace patchmill::internal {
namespace {

constexpr int kMostParts = 400;
constexpr double kSameWeight = 4.0 * std::numeric_limits<double>::epsilon();

// Rows along z: `along` rows of `across` points each, `stride` and `step` apart in memory.
struct UprightRows {
  int along, stride, across, step;
};

std::optional<XyCurve> Swept(const Vec4* points, const UprightRows& rows, double rounding) {
  const auto& [along, stride, across, step] = rows;
  XyCurve curve;
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
  curve.spread = 2.0 * (curve.spread + rounding);  // for both coordinates; different weights matter less
  return curve;
}

// Whether z rises along all rows, or falls along all of them.
bool Monotone(const Vec4* points, const UprightRows& rows) {
  bool rises = true, falls = true;
  for (int i = 0; i < rows.along; ++i) {
    const Vec4* row = points + i * rows.stride;
    for (int j = 1; j < rows.across; ++j) {
      const Vec4 &p = row[(j - 1) * rows.step], &q = row[j * rows.step];
      const double step = q.z() / q.w() - p.z() / p.w();
      rises = rises && step >= 0.0;
      falls = falls && step <= 0.0;
    }
  }
  return rises || falls;
}

}  // namespace

// The weights of a row are equal, so the derivative of z along it is a sum of the steps with positive
// factors.
Upright UprightLinesOf(NetShape shape, const Vec4* points, double rounding) {
  const int rows = shape.degree_u + 1, columns = shape.degree_v + 1;
  const UprightRows along_v{rows, columns, columns, 1}, along_u{columns, 1, rows, columns};
  if (Swept(points, along_v, rounding) && Monotone(points, along_v)) return Upright::kAlongV;
  if (Swept(points, along_u, rounding) && Monotone(points, along_u)) return Upright::kAlongU;
  return Upright::kNo;
}

std::optional<XyCurve> XyCurveOf(NetShape shape, const Vec4* points, double rounding) {
  const int rows = shape.degree_u + 1, columns = shape.degree_v + 1;
  if (auto curve = Swept(points, {rows, columns, columns, 1}, rounding)) return curve;
  return Swept(points, {columns, 1, rows, columns}, rounding);
}

bool OutsideInXy(const XyCurve& curve, const Vec2& q, double radius) {
  std::array<Vec4, kMaxDegree + 1> local = curve.points;
  for (Vec4& p : local) p.head<2>() -= p.w() * q;
  DistanceForm form;
  MakeDistanceForm({curve.degree, 0}, local.data(), true, true, radius, form);
  return NowhereNegative(form, kMostParts);
}

}  // namespace patchmill::internal
