#include "core/joining/edge_checks.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace patchmill {
namespace {

struct Checker {
  const NetworkWriter& findings;
  int edge;

  void Error(std::string_view code, std::string_view text) const {
    findings.Error(code, findings.AtEdge(edge), text);
  }
  bool Degree(int degree) const {
    if (degree >= 1 && degree <= kMaxBrownDegree) return true;
    Error("UNSUPPORTED_CURVE",
          fmt::format("has a curve of degree {}; must be in [1, {}]", degree, kMaxBrownDegree));
    return false;
  }
  void Finite(bool finite) const {
    if (!finite) Error("NOT_FINITE", "has a number that is not finite");
  }
  void Points(const std::vector<Vec3>& points) const {
    Finite(std::ranges::all_of(points, [](const Vec3& p) { return p.allFinite(); }));
  }

  void Check(const NormalsEdge& e) const {
    if (!(e.gamma > 0.0 && e.gamma <= 10.0)) {
      Error("INVALID_GAMMA", fmt::format("has gamma = {:g}; must be in (0, 10]", e.gamma));
    }
  }
  void Check(const TangentsEdge& e) const {
    Finite(e.start.allFinite() && e.end.allFinite());
    if (e.start == Vec3::Zero() || e.end == Vec3::Zero()) {
      Error("ZERO_TANGENT", "has a tangent of length zero");
    }
  }
  void Check(const ThroughPointEdge& e) const { Finite(e.point.allFinite()); }
  void Check(const PeakEdge& e) const { Finite(e.peak.allFinite()); }
  void Check(const SlopeEdge& e) const {
    Finite(e.point.allFinite() && (!e.direction || e.direction->allFinite()));
    if (e.direction && *e.direction == Vec3::Zero()) Error("ZERO_TANGENT", "has a slope without direction");
  }
  void Check(const LedEdge& e) const {
    Check(e.ends);
    Finite(e.point.allFinite() && (!e.derivative || e.derivative->allFinite()));
    if (!(e.parameter >= kMinLedPlace && e.parameter <= 1.0 - kMinLedPlace)) {
      Error("INVALID_PARAMETER", fmt::format("is led through a point at {:g}; must be in [{:g}, {:g}]",
                                             e.parameter, kMinLedPlace, 1.0 - kMinLedPlace));
    }
  }
  void Check(const CurveEdge& e) const {
    std::visit([this](const auto& curve) { Check(curve); }, e.curve);
  }
  void Check(const HermiteCurve& c) const { Points({c.p0, c.d0, c.p1, c.d1}); }
  void Check(const BezierCurve& c) const {
    if (Degree(c.degree())) Points(c.points);
  }
  void Check(const BsplineCurve& c) const {
    if (!Degree(c.degree)) return;
    const auto p = static_cast<std::size_t>(c.degree);
    if (c.points.size() <= p || c.knots.size() != c.points.size() + p + 1) {
      Error("UNSUPPORTED_CURVE",
            fmt::format(
                "has a curve of degree {} with {} points and {} knots; must have at least {} points and "
                "{} more knots",
                p, c.points.size(), c.knots.size(), p + 1, p + 1));
      return;
    }
    const bool rising = std::ranges::all_of(c.knots, [](double k) { return std::isfinite(k); }) &&
                        std::ranges::is_sorted(c.knots);
    if (!rising || !(c.knots[p] < c.knots[c.points.size()])) {
      Error("UNSUPPORTED_CURVE", "has knots that are not finite, decrease, or span nothing");
      return;
    }
    Points(c.points);
  }
  void Check(const HosakaSegment& s) const {
    if (s.extra.empty() || Degree(3 + static_cast<int>(s.extra.size()))) {
      Points({s.origin, s.a, s.b, s.c});
      Points(s.extra);
    }
  }
};

}  // namespace

void CheckEdgeShapes(const CurveNetwork& network, const NetworkWriter& findings) {
  for (int e = 0; e < static_cast<int>(network.edges.size()); ++e) {
    const Checker checker{findings, e};
    std::visit([&](const auto& shape) { checker.Check(shape); },
               network.edges[static_cast<std::size_t>(e)].shape);
  }
}

}  // namespace patchmill
