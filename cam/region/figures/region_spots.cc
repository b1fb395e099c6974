#include "cam/region/figures/region_spots.h"

#include <algorithm>
#include <cmath>

#include "core/base/status.h"

namespace patchmill {

RegionSamples::RegionSamples(const Surface& surface, const std::vector<SplitMesh>& meshes,
                             std::span<const TriangleRef> triangles)
    : surface_(surface), meshes_(meshes), triangles_(triangles) {
  PM_CHECK(!triangles.empty());
}

Vec3 RegionSamples::At(const RegionSample& spot) const {
  return Position(surface_.pieces[spot.triangle.piece], spot.uv.x(), spot.uv.y());
}

std::vector<RegionSample> RegionSamples::Spread(std::size_t count) {
  constexpr double kByNumber = 0.25;  // share of the places that is spread by the number of triangles
  double all = 0.0;
  for (const TriangleRef& t : triangles_) all += meshes_[t.piece].triangles[t.triangle].area;
  const double by_number = all > 0.0 ? kByNumber : 1.0;
  std::vector<RegionSample> spots;
  double share = 0.0;  // of the places, up to the current triangle
  for (const TriangleRef& t : triangles_) {
    const double area = meshes_[t.piece].triangles[t.triangle].area;
    if (all > 0.0) share += (1.0 - by_number) * area / all;
    share += by_number / static_cast<double>(triangles_.size());
    while (static_cast<double>(spots.size()) + 0.5 < share * static_cast<double>(count)) {
      spots.push_back({t, Inside(t)});
    }
  }
  return spots;
}

std::vector<RegionSample> RegionSamples::Around(const RegionSample& from, double reach, std::size_t count) {
  const Vec3 middle = At(from);
  std::vector<TriangleRef> near;
  for (const TriangleRef& t : triangles_) {
    if (t == from.triangle || Distance(t, middle) < reach) near.push_back(t);
  }
  std::vector<RegionSample> spots{from};
  for (std::size_t k = 0; k < count; ++k) {
    // Many triangles are sampled evenly, few are sampled several times.
    const TriangleRef& t = near.size() > count ? near[k * near.size() / count] : near[k % near.size()];
    RegionSample spot{t, Inside(t)};
    const double way = (At(spot) - middle).norm();
    if (way > reach) {
      // In the triangle of `from` the place moves nearer. A place in another triangle is dropped.
      if (t != from.triangle) continue;
      spot.uv = from.uv + reach / way * (spot.uv - from.uv);
    }
    spots.push_back(spot);
  }
  return spots;
}

Vec2 RegionSamples::Inside(const TriangleRef& t) {
  // Steps of Roberts' R2 sequence: 1 / x and 1 / x^2 for the plastic number x.
  constexpr double kFirst = 0.7548776662466927, kSecond = 0.5698402909980532;
  a_ = std::fmod(a_ + kFirst, 1.0);
  b_ = std::fmod(b_ + kSecond, 1.0);
  const bool over = a_ + b_ > 1.0;
  const double a = over ? 1.0 - a_ : a_, b = over ? 1.0 - b_ : b_;
  const SplitMesh& mesh = meshes_[t.piece];
  const Vec2 from = CornerOf(mesh, t.triangle, 0);
  return from + a * (CornerOf(mesh, t.triangle, 1) - from) + b * (CornerOf(mesh, t.triangle, 2) - from);
}

double RegionSamples::Distance(const TriangleRef& t, const Vec3& p) const {
  const SplitMesh& mesh = meshes_[t.piece];
  double nearest = kInfinity;
  for (const int vertex : mesh.triangles[t.triangle].vertex) {
    nearest = std::min(nearest, (mesh.vertices[static_cast<std::size_t>(vertex)].p - p).norm());
  }
  return nearest;
}

}  // namespace patchmill
