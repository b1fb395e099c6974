#include "cam/region/describe_regions.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "core/diffgeo/forms.h"

namespace patchmill {
namespace {

Vec2 Corner(const SplitMesh& mesh, std::size_t triangle, std::size_t k) {
  const ZeroVertex& vertex = mesh.vertices[static_cast<std::size_t>(mesh.triangles[triangle].vertex[k])];
  return {vertex.u, vertex.v};
}

Vec2 Centroid(const SplitMesh& mesh, std::size_t triangle) {
  return (Corner(mesh, triangle, 0) + Corner(mesh, triangle, 1) + Corner(mesh, triangle, 2)) / 3.0;
}

}  // namespace

// The middle of the largest triangle of each is the point inside, of those that its labels tell of.
void PlaceRegions(const Surface& surface, const std::vector<SplitMesh>& meshes,
                  const std::vector<std::vector<int>>& region_of, const RegionMap& map,
                  std::vector<Region>& regions) {
  struct Inside {
    TriangleRef triangle;
    bool told = false;
    double area = -1.0;
  };
  std::vector<Inside> inside(regions.size());
  for (Region& region : regions) {
    region.z_min = kInfinity;
    region.z_max = -kInfinity;
  }
  for (std::size_t piece = 0; piece < meshes.size(); ++piece) {
    const SplitMesh& mesh = meshes[piece];
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      const auto id = static_cast<std::size_t>(region_of[piece][t]);
      for (const int vertex : mesh.triangles[t].vertex) {
        const double z = mesh.vertices[static_cast<std::size_t>(vertex)].p.z();
        regions[id].z_min = std::min(regions[id].z_min, z);
        regions[id].z_max = std::max(regions[id].z_max, z);
      }
      Inside& best = inside[id];
      const double area = mesh.triangles[t].area;
      if (best.told && area <= best.area) continue;
      const Vec2 q = Centroid(mesh, t);
      const bool told = map.At({PieceId(piece), q.x(), q.y(), Vec3::Zero()}) == static_cast<int>(id);
      if (told > best.told || (told == best.told && area > best.area)) best = {{piece, t}, told, area};
    }
  }
  for (std::size_t id = 0; id < regions.size(); ++id) {
    const TriangleRef& t = inside[id].triangle;
    const Vec2 q = Centroid(meshes[t.piece], t.triangle);
    regions[id].inside = Position(surface.pieces[t.piece], q.x(), q.y());
  }
}

namespace {

// A place inside a region.
struct Spot {
  TriangleRef triangle;
  Vec2 uv;
};

// Places spread over the triangles: by area, and some by number, for small triangles lie at borders.
class Spread {
 public:
  Spread(const std::vector<SplitMesh>& meshes, const std::vector<TriangleRef>& triangles)
      : meshes_(meshes), triangles_(triangles) {
    for (const TriangleRef& t : triangles) area_ += Triangle(t).area;
  }

  std::vector<Spot> Draw(std::size_t count) {
    constexpr double kByNumber = 0.25;
    std::vector<Spot> places;
    double share = 0.0;  // of what came before
    for (const TriangleRef& t : triangles_) {
      share += (1.0 - kByNumber) * (area_ > 0.0 ? Triangle(t).area / area_ : 0.0) +
               kByNumber / static_cast<double>(triangles_.size());
      while (places.size() < count &&
             static_cast<double>(places.size()) + 0.5 < share * static_cast<double>(count)) {
        places.push_back({t, Inside(t)});
      }
    }
    return places;
  }

  // Another place of the triangle: an additive recurrence over all that were drawn.
  Vec2 Inside(const TriangleRef& t) {
    constexpr double kFirst = 0.7548776662466927, kSecond = 0.5698402909980532;
    a_ = std::fmod(a_ + kFirst, 1.0);
    b_ = std::fmod(b_ + kSecond, 1.0);
    const bool over = a_ + b_ > 1.0;
    const double a = over ? 1.0 - a_ : a_, b = over ? 1.0 - b_ : b_;
    const SplitMesh& mesh = meshes_[t.piece];
    const Vec2 from = Corner(mesh, t.triangle, 0);
    return from + a * (Corner(mesh, t.triangle, 1) - from) + b * (Corner(mesh, t.triangle, 2) - from);
  }

 private:
  const SplitTriangle& Triangle(const TriangleRef& t) const { return meshes_[t.piece].triangles[t.triangle]; }

  const std::vector<SplitMesh>& meshes_;
  const std::vector<TriangleRef>& triangles_;
  double area_ = 0.0;
  double a_ = 0.5, b_ = 0.5;
};

// The ball that reaches every place it is shown, from the largest that is of interest down.
class SmallestBall {
 public:
  SmallestBall(const Surface& surface, double largest, double tolerance)
      : surface_(surface), radius_(largest), tolerance_(tolerance) {}

  double radius() const { return radius_; }
  // Whether it became smaller.
  bool Show(const SurfaceJet& jet) {
    const auto normal = UpwardNormal(jet);
    if (!normal) return false;
    const double before = radius_;
    radius_ = LargestFreeRadius(surface_, jet.p, *normal, radius_, tolerance_);
    return radius_ < before;
  }

 private:
  const Surface& surface_;
  double radius_, tolerance_;
};

// Draws places close to one: what a search for the worst goes on with.
class Closing {
 public:
  Closing(const Surface& surface, const std::vector<SplitMesh>& meshes,
          const std::vector<TriangleRef>& triangles, Spread& spread)
      : surface_(surface), meshes_(meshes), triangles_(triangles), spread_(spread) {}

  Vec3 At(const Spot& spot) const {
    return Position(surface_.pieces[spot.triangle.piece], spot.uv.x(), spot.uv.y());
  }

  // That place and up to so many more within `reach` (mm) of it.
  std::vector<Spot> Around(const Spot& from, double reach, std::size_t count) {
    const Vec3 middle = At(from);
    std::vector<TriangleRef> near;
    for (const TriangleRef& t : triangles_) {
      if (Same(t, from.triangle) || Distance(t, middle) < reach) near.push_back(t);
    }
    std::vector<Spot> spots{from};
    const double stride = static_cast<double>(near.size()) / static_cast<double>(count);
    for (std::size_t k = 0; k < count; ++k) {
      const auto which = static_cast<std::size_t>(std::floor(static_cast<double>(k) * stride));
      Spot spot{near[which % near.size()], {}};
      spot.uv = spread_.Inside(spot.triangle);
      const double way = (At(spot) - middle).norm();
      if (way > reach) {
        // Of a triangle that holds the place too, what is near; of another it is not known.
        if (!Same(spot.triangle, from.triangle)) continue;
        spot.uv = from.uv + reach / way * (spot.uv - from.uv);
      }
      spots.push_back(spot);
    }
    return spots;
  }

 private:
  static bool Same(const TriangleRef& a, const TriangleRef& b) {
    return a.piece == b.piece && a.triangle == b.triangle;
  }
  double Distance(const TriangleRef& t, const Vec3& p) const {
    const SplitMesh& mesh = meshes_[t.piece];
    double nearest = kInfinity;
    for (const int vertex : mesh.triangles[t.triangle].vertex) {
      nearest = std::min(nearest, (mesh.vertices[static_cast<std::size_t>(vertex)].p - p).norm());
    }
    return nearest;
  }

  const Surface& surface_;
  const std::vector<SplitMesh>& meshes_;
  const std::vector<TriangleRef>& triangles_;
  Spread& spread_;
};

// Radius of the largest ball that reaches all of a region, at most params.radius; 0 where it would be so
// small that the tolerance decides. First the places given, then ever closer around the worst.
double BallForAll(const Surface& surface, const std::vector<Spot>& spots, const RegionParams& params,
                  const RunContext& run, Closing& closing) {
  constexpr double kLeast = 10.0;    // tolerances
  constexpr double kClosest = 0.01;  // of the radius: the search ends there
  constexpr std::size_t kAround = 16;
  SmallestBall ball(surface, params.radius, params.tolerance);
  std::optional<Spot> worst;
  const auto show = [&](const std::vector<Spot>& to) {
    for (const Spot& spot : to) {
      if (run.Cancelled() || ball.radius() <= kLeast * params.tolerance) return;
      const Piece& piece = surface.pieces[spot.triangle.piece];
      if (ball.Show(Evaluate(piece, spot.uv.x(), spot.uv.y()))) worst = spot;
    }
  };
  show(spots);
  for (double reach = params.radius; worst && reach > kClosest * params.radius; reach *= 0.4) {
    show(closing.Around(*worst, reach, kAround));
  }
  return ball.radius() <= kLeast * params.tolerance ? 0.0 : ball.radius();
}

}  // namespace

void ProbeRegion(const Surface& surface, const std::vector<SplitMesh>& meshes, const ReachTest& reach,
                 const RegionParams& params, const std::vector<TriangleRef>& triangles, const RunContext& run,
                 Region& region) {
  constexpr std::size_t kLooked = 200, kAround = 12;
  constexpr double kNear = 0.5;  // of the radius
  Spread spread(meshes, triangles);
  Closing closing(surface, meshes, triangles, spread);
  const std::vector<Spot> spots = spread.Draw(kLooked);
  const auto deepest = [&](const std::vector<Spot>& of) {
    std::vector<Vec3> places;
    for (const Spot& spot : of) places.push_back(closing.At(spot));
    const Deepest found = reach.DeepestLeftover(places, run);
    region.deepest_leftover = std::max(region.deepest_leftover, found.leftover);
    return of[found.place];
  };
  const Spot worst = deepest(spots);
  if (run.Cancelled()) return;
  deepest(closing.Around(worst, kNear * params.radius, kAround));
  if (region.reason != UnreachableReason::kConcave) return;
  // Where it bends most first: what is found there leaves the others one look each.
  std::vector<std::pair<double, Spot>> bends;
  for (const Spot& spot : spots) {
    const SurfaceJet jet = Evaluate(surface.pieces[spot.triangle.piece], spot.uv.x(), spot.uv.y());
    const auto normal = UpwardNormal(jet);
    bends.emplace_back(normal ? Principal(Forms(jet, *normal)).k_max : 0.0, spot);
  }
  std::stable_sort(bends.begin(), bends.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
  std::vector<Spot> sorted;
  for (const auto& [bend, spot] : bends) sorted.push_back(spot);
  region.largest_tool_diameter = 2.0 * BallForAll(surface, sorted, params, run, closing);
}

std::vector<std::vector<TriangleRef>> UnreachableTriangles(const std::vector<SplitMesh>& meshes,
                                                           const std::vector<std::vector<int>>& region_of,
                                                           const std::vector<Region>& regions) {
  std::vector<std::vector<TriangleRef>> unreachable(regions.size());
  for (std::size_t piece = 0; piece < meshes.size(); ++piece) {
    for (std::size_t t = 0; t < meshes[piece].triangles.size(); ++t) {
      const auto id = static_cast<std::size_t>(region_of[piece][t]);
      if (regions[id].kind == RegionKind::kUnreachable) unreachable[id].push_back({piece, t});
    }
  }
  return unreachable;
}

}  // namespace patchmill
