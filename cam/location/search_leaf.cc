#include "cam/location/search_leaf.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>

namespace patchmill::internal {
namespace {

// The code 2^level + index of a dyadic interval.
std::uint32_t CodeOf(double low, double high) {
  const int level = -std::ilogb(high - low);
  return (std::uint32_t{1} << level) + static_cast<std::uint32_t>(std::ldexp(low, level));
}

// A frame gives four frames if two of its axes are turned about (quaternions q, q i, q j, q k). Takes the one
// with the smallest rotation. Returns its vector part divided by its scalar part, all within [-1, 1].
Vec3 TurnOf(const Eigen::Matrix3d& axis) {
  const Eigen::Quaterniond q(axis);
  const double w = q.w(), x = q.x(), y = q.y(), z = q.z();
  const double most = std::max({std::abs(w), std::abs(x), std::abs(y), std::abs(z)});
  if (std::abs(w) == most) return Vec3(x, y, z) / w;
  if (std::abs(x) == most) return Vec3(w, z, -y) / -x;
  if (std::abs(y) == most) return Vec3(-z, w, x) / -y;
  return Vec3(y, -x, w) / -z;
}

}  // namespace

UpperBound::UpperBound(double x) {
  const float up = std::max(RoundUp(x), std::numeric_limits<float>::min());
  bits_ = static_cast<std::uint16_t>((std::bit_cast<std::uint32_t>(up) + 0x7FFFU) >> 15);
}

UpperBound UpperBound::Next() const {
  UpperBound next = *this;
  if (bits_ < 0xFF00U) ++next.bits_;
  return next;
}

LeafGrid::LeafGrid(const Box3& box) : origin(box.Center()) {
  step = std::max((box.max - box.min).maxCoeff(), std::numeric_limits<double>::min()) / 4294967000.0;
}

SearchLeaf::SearchLeaf(const LeafGrid& grid, std::int32_t piece, const Rect& rect, const LeafModel& model,
                       const FramedHull& hull)
    : piece_(piece), u_(CodeOf(rect.u0, rect.u1)), v_(CodeOf(rect.v0, rect.v1)) {
  RoundModel(grid, model);
  RoundBox(grid, hull);
}

// Let s', a', ... be the stored values, ds, da, ... their distances from s, a, ..., and S the surface. Then
//   |S - s'| <= reach + ds,   |S_u - a'| <= drift_a + da,   |S_uu - uu'| <= drift_uu + d_uu, and so on;
//   (S_u - a').a' = (S_u - a).a + (S_u - a).(a' - a) + (a - a').a', so twice drift_a da + da |a'| more;
//   (S - s').uu' = (S - s).uu + (S - s).(uu' - uu) + (s - s').uu', so reach d_uu + ds |uu'| more;
//   the mixed entry (S_u - a').b' + (S_v - b').a' + (S_u - a').(S_v - b') is alike.
// The bounds of the Hessian hold for any constants s', a', ... (leaf_model.cc). Value and slopes at the
// middle are those of s, a, b. At the distance D from s' the lower model is off, on |x|, |y| <= 1/2, by at
// most
//   ds (D + ds/2) + (ds (|a| + |b|) + D (da + db)) / 2  <=  rest (D + reach).
void SearchLeaf::RoundModel(const LeafGrid& grid, const LeafModel& m) {
  for (int k = 0; k < 3; ++k) {
    constexpr double kLimit = std::numeric_limits<std::int32_t>::max();
    place_[k] = static_cast<std::int32_t>(
        std::clamp(std::round((m.s[k] - grid.origin[k]) / grid.step), -kLimit, kLimit));
    first_[k] = static_cast<float>(m.a[k]);
    first_[3 + k] = static_cast<float>(m.b[k]);
  }
  const Vec3* second[3] = {&m.uu, &m.uv, &m.vv};
  double largest = std::numeric_limits<float>::min();
  for (const Vec3* x : second) largest = std::max(largest, x->cwiseAbs().maxCoeff());
  second_unit_ = RoundUp(largest / 32767.0);
  for (int i = 0; i < 9; ++i) {
    second_[i] =
        static_cast<std::int16_t>(std::round((*second[i / 3])[i % 3] / static_cast<double>(second_unit_)));
  }

  const LeafModel to = Model(grid);
  // The differences themselves are rounded: ds with numbers as large as the coordinates, the others with
  // nearly equal numbers.
  const double rounding =
      4.0 * std::numeric_limits<double>::epsilon() * (m.s.cwiseAbs().maxCoeff() + grid.origin.norm());
  const double ds = (m.s - to.s).norm() + rounding, da = (m.a - to.a).norm(), db = (m.b - to.b).norm();
  const double d_uu = (m.uu - to.uu).norm(), d_uv = (m.uv - to.uv).norm(), d_vv = (m.vv - to.vv).norm();
  const double a = to.a.norm(), b = to.b.norm(), drift_a = m.drift_a, drift_b = m.drift_b;
  constexpr double kUp = 1.0 + 1e-12;  // covers the rounding of these sums
  const auto up = [&](double x) { return UpperBound(kUp * x); };
  gram_uu_ = up(m.gram_uu + 2.0 * da * (drift_a + a) + m.reach * d_uu + ds * to.uu.norm());
  gram_vv_ = up(m.gram_vv + 2.0 * db * (drift_b + b) + m.reach * d_vv + ds * to.vv.norm());
  gram_uv_ = up(m.gram_uv + da * (b + drift_b) + db * (a + drift_a) + drift_a * db + drift_b * da + da * db +
                m.reach * d_uv + ds * to.uv.norm());
  drift_uu_ = up(m.drift_uu + d_uu);
  drift_uv_ = up(m.drift_uv + d_uv);
  drift_vv_ = up(m.drift_vv + d_vv);
  drift_a_ = up(drift_a + da);
  drift_b_ = up(drift_b + db);
  const double reach = m.reach + ds;
  reach_ = up(reach);
  rise_ = up(std::max(0.0, m.z_max - to.s.z() + rounding));
  const double at_middle = 0.5 * ds * (ds + m.a.norm() + m.b.norm());
  rest_ = up(std::max(ds + 0.5 * (da + db), at_middle / reach));
}

// The axes are stored first. Then the hull is measured along the stored axes.
void SearchLeaf::RoundBox(const LeafGrid& grid, const FramedHull& hull) {
  const Vec3 turn = TurnOf(hull.axis);
  for (int k = 0; k < 3; ++k) turn_[k] = static_cast<float>(turn[k]);
  const Eigen::Matrix3d to = Axis();
  const Vec3 s = Place(grid);
  Vec3 low = Vec3::Constant(kInfinity), high = Vec3::Constant(-kInfinity);
  double coordinate = s.cwiseAbs().maxCoeff();
  for (const Vec3& p : hull.points) {
    const Vec3 y = to.transpose() * (p - s);
    low = low.cwiseMin(y);
    high = high.cwiseMax(y);
    coordinate = std::max(coordinate, p.cwiseAbs().maxCoeff());
  }
  const double rounding = 16.0 * std::numeric_limits<double>::epsilon() * coordinate;
  for (int k = 0; k < 3; ++k) {
    const double middle = 0.5 * (low[k] + high[k]), half = 0.5 * (high[k] - low[k]) + rounding;
    for (UpperBound bound(half * (1.0 + 2.0 * SearchLeaf::kShiftUnit));; bound = bound.Next()) {
      const double unit = SearchLeaf::kShiftUnit * static_cast<double>(bound.value());
      const double shift = std::clamp(std::round(middle / unit), -32767.0, 32767.0);
      half_[k] = bound;
      shift_[k] = static_cast<std::int16_t>(shift);
      if (std::abs(middle - shift * unit) + half <= static_cast<double>(bound.value())) break;
    }
  }
}

}  // namespace patchmill::internal
