#include "cam/region/map/pass_regions.h"

#include <cstddef>
#include <optional>

namespace patchmill {
namespace {

// A move along one piece is looked up at this many places, because it may cross borders and be long.
constexpr int kStretches = 8;
constexpr double kPoint = 1e-9;  // mm; length that the first point of a pass counts as

// id_at(p) is the id of the region or component at the surface point p.
template <class Id, class IdAt>
std::map<Id, double> LengthIn(const CutterPath& pass, const IdAt& id_at) {
  std::map<Id, double> lengths;
  if (pass.points.empty()) return lengths;
  const auto add = [&](const std::optional<SurfacePoint>& at, double length) {
    if (at) lengths[id_at(*at)] += length;
  };
  add(pass.points.front().contact, kPoint);
  for (std::size_t i = 1; i < pass.points.size(); ++i) {
    const CutterPoint &a = pass.points[i - 1], &b = pass.points[i];
    const std::optional<SurfacePoint>&from = a.other_contact ? a.other_contact : a.contact, &to = b.contact;
    const double length = (b.center - a.center).norm();
    if (!from || !to || from->piece.value != to->piece.value) {
      add(from, 0.5 * length);
      add(to, 0.5 * length);
      continue;
    }
    for (int k = 0; k < kStretches; ++k) {
      const double s = (k + 0.5) / kStretches;
      const SurfacePoint at{from->piece, from->u + s * (to->u - from->u), from->v + s * (to->v - from->v),
                            Vec3::Zero()};
      add(at, length / kStretches);
    }
  }
  return lengths;
}

}  // namespace

std::map<RegionId, double> LengthInRegions(const CutterPath& pass, const RegionMap& map) {
  if (map.regions.empty()) return {};
  return LengthIn<RegionId>(pass, [&](const SurfacePoint& at) { return map.At(at); });
}

std::map<ComponentId, double> LengthInComponents(const CutterPath& pass, const RegionMap& map) {
  if (map.regions.empty()) return {};
  return LengthIn<ComponentId>(pass, [&](const SurfacePoint& at) { return map.ComponentAt(at); });
}

}  // namespace patchmill
