#include "core/joining/curvature_joint.h"

#include <algorithm>
#include <cmath>

namespace patchmill {
namespace {

constexpr double kFirst = 1.0 / kG2Degree, kSecond = 1.0 / (kG2Degree * (kG2Degree - 1));
using Kind = CurvatureFault::Kind;

ControlVectors VectorsOf(const CrossEnd& end) { return {kFirst * end.d, kSecond * end.dd}; }

ControlVectors Mean(const CrossSide& side) {
  if (side.fair) return VectorsOf(*side.fair);
  return {0.5 * kFirst * (side.start.d + side.end.d), 0.5 * kSecond * (side.start.dd + side.end.dd)};
}

double Angle(const Vec3& a, const Vec3& b) { return std::atan2(a.cross(b).norm(), a.dot(b)); }

// Difference of two bends, as a share of the largest of both and of the reciprocal length of the vectors.
double BendMisfit(const Vec3& x, const Vec3& y, const ControlVectors& a, const ControlVectors& b) {
  const double length = std::max(a.first.norm(), b.first.norm());
  return (x - y).norm() / std::max({x.norm(), y.norm(), kFirst / length});
}

// The strip at an end, from the curves of a and b that cross the edge there. It points from a to b.
std::variant<StripPlace, CurvatureFault> CrossingAt(const CrossEnd& a, const CrossEnd& b, bool at_end) {
  const ControlVectors va = VectorsOf(a), vb = VectorsOf(b);
  if (const double angle = Angle(-a.d, b.d); !(angle <= kMaxCurveMisfit)) {
    return CurvatureFault{Kind::kDirection, angle, at_end};
  }
  const Vec3 bend_a = BendOf(va), bend_b = BendOf(vb);
  if (const double misfit = BendMisfit(bend_a, bend_b, va, vb); !(misfit <= kMaxCurveMisfit)) {
    return CurvatureFault{Kind::kCurvature, misfit, at_end};
  }
  return StripPlace{(vb.first - va.first).normalized(), 0.5 * (bend_a + bend_b)};
}

// Control vectors at the middle: `along` as the first; the wished second one, else the mean of the ends.
ControlVectors Middle(const CrossSide& side, const Vec3& along) {
  const ControlVectors mean = Mean(side);
  const Vec3 second = side.second ? Vec3(kSecond * *side.second) : mean.second;
  return {along, second};
}

// Replaces the part of the second vector across the first.
ControlVectors WithBend(const ControlVectors& vectors, const Vec3& bend) {
  const double square = vectors.first.squaredNorm();
  return {vectors.first, vectors.first * (vectors.first.dot(vectors.second) / square) + bend * square};
}

}  // namespace

std::optional<CurvatureFault> CrossingFault(const CrossEnd& a, const CrossEnd& b, bool at_end) {
  const auto crossing = CrossingAt(a, b, at_end);
  const auto* fault = std::get_if<CurvatureFault>(&crossing);
  return fault != nullptr ? std::optional(*fault) : std::nullopt;
}

std::variant<std::array<CrossRows, 2>, CurvatureFault> JoinCurvature(const CrossSide& a, const CrossSide& b) {
  StripPlace ends[2];
  for (const bool at_end : {false, true}) {
    const auto crossing = CrossingAt(at_end ? a.end : a.start, at_end ? b.end : b.start, at_end);
    if (const auto* fault = std::get_if<CurvatureFault>(&crossing)) return *fault;
    ends[at_end] = std::get<StripPlace>(crossing);
  }
  const double mean_a = Mean(a).first.norm(), mean_b = Mean(b).first.norm();
  if (!(mean_a > 0.0 && mean_b > 0.0)) return CurvatureFault{Kind::kTurn};
  Vec3 first_a, first_b;
  if (a.first && b.first) {
    first_a = kFirst * *a.first, first_b = kFirst * *b.first;
    if (const double angle = Angle(-first_a, first_b); !(angle <= kMaxCurveMisfit)) {
      return CurvatureFault{Kind::kControlsDiffer, angle};
    }
  } else if (a.first) {  // the other side keeps its share [joining, section 8]
    first_a = kFirst * *a.first, first_b = -mean_b / mean_a * first_a;
  } else if (b.first) {
    first_b = kFirst * *b.first, first_a = -mean_a / mean_b * first_b;
  } else {
    const Vec3 sum = Mean(b).first - Mean(a).first;
    if (!(sum.norm() > 0.0)) return CurvatureFault{Kind::kTurn};
    first_a = -mean_a * sum.normalized(), first_b = mean_b * sum.normalized();
  }
  ControlVectors middle_a = Middle(a, first_a), middle_b = Middle(b, first_b);
  const Vec3 bend_a = BendOf(middle_a), bend_b = BendOf(middle_b);
  Vec3 bend = 0.5 * (bend_a + bend_b);
  if (a.second && b.second) {
    if (const double misfit = BendMisfit(bend_a, bend_b, middle_a, middle_b); !(misfit <= kMaxCurveMisfit)) {
      return CurvatureFault{Kind::kControlsDiffer, misfit};
    }
  } else if (a.second) {
    bend = bend_a;
  } else if (b.second) {
    bend = bend_b;
  }
  middle_a = WithBend(middle_a, bend), middle_b = WithBend(middle_b, bend);
  const BasisStrip strip =
      MakeBasisStrip(ends[0], {(first_b.normalized() - first_a.normalized()).normalized(), bend}, ends[1]);
  const auto factors_a = FactorsFor(strip, VectorsOf(a.start), middle_a, VectorsOf(a.end));
  const auto factors_b = FactorsFor(strip, VectorsOf(b.start), middle_b, VectorsOf(b.end));
  if (!factors_a || !factors_b) return CurvatureFault{Kind::kTurn};
  return std::array{Connect(strip, *factors_a), Connect(strip, *factors_b)};
}

std::variant<CrossRows, CurvatureFault> RowsAlone(const CrossSide& side) {
  const Vec3 first = side.first ? Vec3(kFirst * *side.first) : Mean(side).first;
  if (!(first.norm() > 0.0)) return CurvatureFault{Kind::kTurn};
  const ControlVectors start = VectorsOf(side.start), middle = Middle(side, first), end = VectorsOf(side.end);
  const auto place = [](const ControlVectors& v) { return StripPlace{v.first.normalized(), BendOf(v)}; };
  const BasisStrip strip = MakeBasisStrip(place(start), place(middle), place(end));
  const auto factors = FactorsFor(strip, start, middle, end);
  if (!factors) return CurvatureFault{Kind::kTurn};
  return Connect(strip, *factors);
}

CrossRows RowsWithTangent(const BezierCurve& tangent, const CrossSide& side) {
  const BezierCurve raised = Elevated(tangent, kG2Degree);
  CrossRows rows;
  for (std::size_t i = 0; i <= kG2Degree; ++i) {
    const double t = static_cast<double>(i) / kG2Degree;
    rows.first[i] = kFirst * raised.points[i];
    rows.second[i] = kSecond * ((1.0 - t) * side.start.dd + t * side.end.dd);
  }
  return rows;
}

CrossRows Reversed(CrossRows rows) {
  std::ranges::reverse(rows.first);
  std::ranges::reverse(rows.second);
  return rows;
}

}  // namespace patchmill
