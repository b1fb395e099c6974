#include "cam/region/seams.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <unordered_map>

namespace patchmill {
namespace {

struct BorderSide {
  std::size_t adjacency;  // index into the result
  Vec3 a, b, mid;         // ends, and the true middle of the arc
  double sagitta = 0.0;
};

bool OnBorder(const SplitVertex& a, const SplitVertex& b) {
  return (a.u == 0.0 && b.u == 0.0) || (a.u == 1.0 && b.u == 1.0) || (a.v == 0.0 && b.v == 0.0) ||
         (a.v == 1.0 && b.v == 1.0);
}

double DistanceToSegment(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 d = b - a;
  const double t = d.squaredNorm() > 0.0 ? std::clamp((p - a).dot(d) / d.squaredNorm(), 0.0, 1.0) : 0.0;
  return (a + t * d - p).norm();
}

// Hash grid over the border sides' boxes.
class SideGrid {
 public:
  SideGrid(const std::vector<BorderSide>& sides, double cell) : cell_(cell) {
    for (std::size_t i = 0; i < sides.size(); ++i) {
      Box3 box;
      box.Add(sides[i].a);
      box.Add(sides[i].b);
      box.Add(sides[i].mid);
      const auto low = Key(box.min), high = Key(box.max);
      for (auto x = low[0]; x <= high[0]; ++x) {
        for (auto y = low[1]; y <= high[1]; ++y) {
          for (auto z = low[2]; z <= high[2]; ++z) cells_[Hash({x, y, z})].push_back(i);
        }
      }
    }
  }
  template <class Visit>
  void Near(const Vec3& p, double reach, const Visit& visit) const {
    const auto low = Key(p - Vec3::Constant(reach)), high = Key(p + Vec3::Constant(reach));
    for (auto x = low[0]; x <= high[0]; ++x) {
      for (auto y = low[1]; y <= high[1]; ++y) {
        for (auto z = low[2]; z <= high[2]; ++z) {
          const auto it = cells_.find(Hash({x, y, z}));
          if (it == cells_.end()) continue;
          for (const std::size_t i : it->second) visit(i);
        }
      }
    }
  }

 private:
  using Index = std::array<std::int64_t, 3>;
  Index Key(const Vec3& p) const {
    return {static_cast<std::int64_t>(std::floor(p.x() / cell_)),
            static_cast<std::int64_t>(std::floor(p.y() / cell_)),
            static_cast<std::int64_t>(std::floor(p.z() / cell_))};
  }
  static std::uint64_t Hash(const Index& k) {
    std::uint64_t h = 1469598103934665603ull;
    for (const std::int64_t x : k) h = (h ^ static_cast<std::uint64_t>(x)) * 1099511628211ull;
    return h;
  }
  double cell_;
  std::unordered_map<std::uint64_t, std::vector<std::size_t>> cells_;  // looked up, never walked
};

}  // namespace

std::vector<Adjacency> FindAdjacency(const Surface& surface, const std::vector<SplitMesh>& meshes) {
  std::vector<Adjacency> result;
  std::vector<BorderSide> border;
  double longest = 0.0;
  for (std::size_t piece = 0; piece < meshes.size(); ++piece) {
    const SplitMesh& mesh = meshes[piece];
    std::map<std::pair<int, int>, int> facing;  // directed side -> triangle
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      const auto& v = mesh.triangles[t].vertex;
      for (int s = 0; s < 3; ++s)
        facing[{v[static_cast<std::size_t>(s)], v[static_cast<std::size_t>((s + 1) % 3)]}] =
            static_cast<int>(t);
    }
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      for (int s = 0; s < 3; ++s) {
        const int from = mesh.triangles[t].vertex[static_cast<std::size_t>(s)];
        const int to = mesh.triangles[t].vertex[static_cast<std::size_t>((s + 1) % 3)];
        const SplitVertex& a = mesh.vertices[static_cast<std::size_t>(from)];
        const SplitVertex& b = mesh.vertices[static_cast<std::size_t>(to)];
        Adjacency adjacency;
        adjacency.side = {static_cast<int>(piece), static_cast<int>(t), s};
        adjacency.length = (b.p - a.p).norm();
        const auto it = facing.find({to, from});
        if (it != facing.end()) {
          adjacency.other_piece = static_cast<int>(piece);
          adjacency.other_triangle = it->second;
        } else if (OnBorder(a, b)) {
          BorderSide side{result.size(), a.p, b.p,
                          Position(surface.pieces[piece], 0.5 * (a.u + b.u), 0.5 * (a.v + b.v)), 0.0};
          side.sagitta = DistanceToSegment(side.mid, side.a, side.b);
          longest = std::max(longest, adjacency.length);
          border.push_back(side);
        }
        result.push_back(adjacency);
      }
    }
  }
  const double join = std::max(surface.network.join_tolerance, 1e-9);
  const SideGrid grid(border, std::max(0.25 * longest, 4.0 * join));
  for (const BorderSide& side : border) {
    Adjacency& adjacency = result[side.adjacency];
    double best = kInfinity;
    grid.Near(side.mid, join + 2.0 * side.sagitta, [&](std::size_t i) {
      const BorderSide& other = border[i];
      const Adjacency& candidate = result[other.adjacency];
      if (other.adjacency == side.adjacency) return;
      // A piece may meet itself (a closed surface of one patch), but never its own neighbour triangle along
      // the same border.
      const double d = DistanceToSegment(side.mid, other.a, other.b);
      if (d > join + 2.0 * (side.sagitta + other.sagitta) || d >= best) return;
      const bool same_border =
          candidate.side.piece == adjacency.side.piece && (other.a - side.b).norm() < 1e-12;
      if (same_border) return;
      best = d;
      adjacency.other_piece = candidate.side.piece;
      adjacency.other_triangle = candidate.side.triangle;
      adjacency.across_seam = true;
    });
  }
  return result;
}

}  // namespace patchmill
