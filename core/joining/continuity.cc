#include "core/joining/continuity.h"

#include <algorithm>
#include <cmath>

#include "core/base/parallel.h"
#include "core/base/status.h"
#include "core/diffgeo/forms.h"
#include "core/network/edge_angles.h"
#include "core/network/edge_curves.h"

namespace patchmill {
namespace {

constexpr double kSameParameter = 1e-9;  // of the edge's reach: parameters correspond

bool Forward(int edge) { return edge <= 1; }  // the parameter runs counter-clockwise around the patch

// Normal curvature as a symmetric form of unit tangents x cos + y sin.
struct CurvatureForm {
  double xx = 0.0, xy = 0.0, yy = 0.0;
  double Largest() const { return std::abs(0.5 * (xx + yy)) + std::hypot(0.5 * (xx - yy), xy); }
};

CurvatureForm FormAt(const SurfaceJet& jet, const Vec3& normal, const Vec3& x, const Vec3& y) {
  const FundamentalForms forms = Forms(jet, normal);
  CurvatureForm form{NormalCurvature(forms, jet, x), 0.0, NormalCurvature(forms, jet, y)};
  form.xy = NormalCurvature(forms, jet, x + y) - 0.5 * (form.xx + form.yy);
  return form;
}

// Two edges on the same curve. Edge `e` runs over [from, to] of the parameter of `f`.
struct Pair {
  int e = 0, f = 0;
  double from = 0.0, to = 1.0;
  bool part = false;
};

EdgeContinuity Measure(const EdgeCurves& curves, const Pair& pair, int steps) {
  const auto& [e, f, from, to, part] = pair;
  EdgeContinuity joint{curves.edge(e), curves.edge(f), part};
  // If both patches run counter-clockwise with the same orientation, they pass a shared edge in opposite
  // directions. A triangle's edge 1 runs counter-clockwise, its edge 2 does not, as a quad's edges 1 and 3.
  const double sign = (Forward(joint.a.edge) == Forward(joint.b.edge)) != (to < from) ? -1.0 : 1.0;
  for (int k = 0; k <= steps; ++k) {
    const double t = static_cast<double>(k) / steps;
    double s = (1.0 - t) * from + t * to;
    const Vec3 p = curves.Point(e, t);
    double gap = (curves.Point(f, s) - p).norm();
    if (gap > kSameParameter * curves.reach(e)) {
      const EdgeFoot foot = ClosestOnEdge(curves, f, p);
      s = foot.t;
      gap = foot.distance;
    }
    if (gap > joint.max_gap) joint.max_gap = gap, joint.gap_at = t;
    const Vec2 at_a = EdgeParameters(curves.shape(e), joint.a.edge, t),
               at_b = EdgeParameters(curves.shape(f), joint.b.edge, s);
    const auto a = PatchNormal(curves.shape(e), at_a), b = PatchNormal(curves.shape(f), at_b);
    if (!a || !b) continue;
    const double angle = std::atan2(a->cross(*b).norm(), sign * a->dot(*b));
    if (angle > joint.max_angle) joint.max_angle = angle, joint.angle_at = t;
    if (k == 0 || k == steps || angle > kTangentBreak) continue;
    const SurfaceJet jet_a = Evaluate(curves.shape(e), at_a.x(), at_a.y()),
                     jet_b = Evaluate(curves.shape(f), at_b.x(), at_b.y());
    const auto regular_a = UnitNormal(jet_a), regular_b = UnitNormal(jet_b);
    if (!regular_a || !regular_b) continue;
    const Vec3 x = a->unitOrthogonal(), y = a->cross(x);
    const CurvatureForm form_a = FormAt(jet_a, *regular_a, x, y),
                        form_b = FormAt(jet_b, sign * *regular_b, x, y);
    const CurvatureForm gap_form{form_a.xx - form_b.xx, form_a.xy - form_b.xy, form_a.yy - form_b.yy};
    if (const double difference = gap_form.Largest(); difference > joint.max_curvature_gap) {
      joint.max_curvature_gap = difference, joint.curvature_gap_at = t;
    }
    joint.max_curvature = std::max({joint.max_curvature, form_a.Largest(), form_b.Largest()});
  }
  return joint;
}

}  // namespace

absl::StatusOr<ContinuityReport> MeasureContinuity(const PatchNetwork& network, int steps,
                                                   const RunContext& run) {
  const EdgeCurves curves(network.model, run);
  const auto index = [&network](const PatchEdge& edge) {
    return network.first_edge[edge.patch.index()] + edge.edge;
  };
  std::vector<Pair> pairs;
  for (std::size_t k = 0; k < network.edges.size(); ++k) {
    const EdgeLink& link = network.edges[k];
    if (!link.neighbor || link.collapsed) continue;
    const int other = index(*link.neighbor);
    const auto& back = network.edges[static_cast<std::size_t>(other)].neighbor;
    const bool mutual = back && *back == link.self;
    if (mutual && other < static_cast<int>(k)) continue;
    pairs.push_back({static_cast<int>(k), other, link.reversed ? 1.0 : 0.0, link.reversed ? 0.0 : 1.0});
  }
  for (const PartLink& link : network.part_links) {
    pairs.push_back({index(link.part), index(link.whole), link.from, link.to, true});
  }
  ContinuityReport report;
  report.samples = steps + 1;
  report.edges.resize(pairs.size());
  PM_RETURN_IF_ERROR(ParallelFor(run, nullptr, pairs.size(),
                                 [&](std::size_t k) { report.edges[k] = Measure(curves, pairs[k], steps); }));
  return report;
}

}  // namespace patchmill
