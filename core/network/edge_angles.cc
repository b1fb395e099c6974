#include "core/network/edge_angles.h"

#include <algorithm>
#include <cmath>

#include "core/base/index.h"
#include "core/base/parallel.h"

namespace patchmill {
namespace {

std::optional<Vec3> RawNormal(const PatchShape& shape, const Vec2& uv) {
  const SurfaceJet jet = Evaluate(shape, uv.x(), uv.y());
  const Vec3 n = jet.du.cross(jet.dv);
  const double length = n.norm();
  // Relative to the larger derivative: near a pole one of them vanishes, and its direction is lost.
  const double size = std::max(jet.du.squaredNorm(), jet.dv.squaredNorm());
  if (!(length > 1e-7 * size)) return std::nullopt;
  return Vec3(n / length);
}

double Angle(const Vec3& a, const Vec3& b) { return std::atan2(a.cross(b).norm(), a.dot(b)); }

}  // namespace

double AngleAlong(const EdgeCurves& curves, int e, int f, bool reversed) {
  const int e_edge = curves.edge(e).edge, f_edge = curves.edge(f).edge;
  // If both patches run counter-clockwise with the same orientation, they pass a shared edge in opposite
  // directions.
  const double sign = (RunsAroundPatch(e_edge) == RunsAroundPatch(f_edge)) != reversed ? -1.0 : 1.0;
  const std::span<const Vec3> samples = curves.samples(e);
  const double last = static_cast<double>(samples.size() - 1);
  const bool aligned = samples.size() == curves.samples(f).size();
  const double negligible = 1e-6 * curves.reach(e);
  double largest = 0.0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const double t = static_cast<double>(i) / last;
    double s = reversed ? 1.0 - t : t;
    const std::size_t j = reversed ? samples.size() - 1 - i : i;
    if (!aligned || (curves.samples(f)[j] - samples[i]).norm() > negligible) {
      s = ClosestOnEdge(curves, f, samples[i]).t;
    }
    const auto a = PatchNormal(curves.shape(e), EdgeParameters(curves.shape(e), e_edge, t));
    const auto b = PatchNormal(curves.shape(f), EdgeParameters(curves.shape(f), f_edge, s));
    if (a && b) largest = std::max(largest, Angle(*a, sign * *b));
  }
  return largest;
}

std::optional<Vec3> PatchNormal(const PatchShape& shape, const Vec2& uv) {
  if (const auto n = RawNormal(shape, uv)) return n;
  const Vec2 middle = IsTriangle(shape) ? Vec2::Constant(1.0 / 3.0) : Vec2::Constant(0.5);
  return RawNormal(shape, uv + 1e-4 * (middle - uv));
}

void MeasureAngles(const EdgeCurves& curves, const RunContext& run, std::vector<EdgeLink>& links) {
  const auto index = [&](PatchEdge e) { return curves.first_edge()[e.patch.index()] + e.edge; };
  // Each pair is measured once, from its lower edge. Further members of a non-manifold edge are measured,
  // too.
  const auto measures = [&](int e) {
    const auto& neighbor = links[At(e)].neighbor;
    if (!neighbor) return false;
    const auto& back = links[At(index(*neighbor))].neighbor;
    return !(back && *back == links[At(e)].self && index(*neighbor) < e);
  };
  (void)ParallelFor(run, "joins: angles", links.size(), [&](std::size_t k) {
    const int e = static_cast<int>(k);
    if (!measures(e)) return;
    links[k].max_angle = AngleAlong(curves, e, index(*links[k].neighbor), links[k].reversed);
  });
  for (std::size_t k = 0; k < links.size(); ++k) {
    if (!links[k].neighbor || measures(static_cast<int>(k))) continue;
    links[k].max_angle = links[At(index(*links[k].neighbor))].max_angle;
  }
}

}  // namespace patchmill
