#include "cam/region/seams.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <unordered_map>

#include "core/base/parallel.h"
#include "core/base/segment.h"
#include "core/base/status.h"

namespace patchmill {
namespace {

struct BorderSide {
  std::size_t adjacency;  // index into the result
  Vec3 a, b, mid;         // ends, and the true middle of the arc
  double sagitta = 0.0;
};

bool OnBorder(const ZeroVertex& a, const ZeroVertex& b) {
  return (a.u == 0.0 && b.u == 0.0) || (a.u == 1.0 && b.u == 1.0) || (a.v == 0.0 && b.v == 0.0) ||
         (a.v == 1.0 && b.v == 1.0);
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

// Sides of one piece: neighbours within it, and those on its border that may have one elsewhere.
struct PieceSides {
  std::vector<Adjacency> all;
  std::vector<BorderSide> border;  // .adjacency counts within `all`
};

PieceSides InnerSides(const Piece& piece, int index, const SplitMesh& mesh) {
  PieceSides sides;
  const auto corner = [&](std::size_t t, int s) {
    return static_cast<std::size_t>(mesh.triangles[t].vertex[static_cast<std::size_t>(s % 3)]);
  };
  // Directed sides by their first vertex: those of vertex i are [first[i], first[i + 1]).
  std::vector<std::size_t> first(mesh.vertices.size() + 2, 0);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (int s = 0; s < 3; ++s) ++first[corner(t, s) + 2];
  }
  std::partial_sum(first.begin(), first.end(), first.begin());
  struct Directed {
    std::size_t to;
    int triangle;
  };
  std::vector<Directed> directed(3 * mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (int s = 0; s < 3; ++s) directed[first[corner(t, s) + 1]++] = {corner(t, s + 1), static_cast<int>(t)};
  }
  const auto facing = [&](std::size_t from, std::size_t to) {
    for (std::size_t i = first[from]; i < first[from + 1]; ++i) {
      if (directed[i].to == to) return directed[i].triangle;
    }
    return -1;
  };
  sides.all.reserve(3 * mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (int s = 0; s < 3; ++s) {
      const ZeroVertex& a = mesh.vertices[corner(t, s)];
      const ZeroVertex& b = mesh.vertices[corner(t, s + 1)];
      Adjacency adjacency;
      adjacency.side = {index, static_cast<int>(t), s};
      adjacency.length = (b.p - a.p).norm();
      const int other = facing(corner(t, s + 1), corner(t, s));
      if (other >= 0) {
        adjacency.other_piece = index;
        adjacency.other_triangle = other;
      } else if (OnBorder(a, b)) {
        BorderSide side{sides.all.size(), a.p, b.p, Position(piece, 0.5 * (a.u + b.u), 0.5 * (a.v + b.v)),
                        0.0};
        side.sagitta = SegmentDistance(side.mid, side.a, side.b);
        sides.border.push_back(side);
      }
      sides.all.push_back(adjacency);
    }
  }
  return sides;
}

}  // namespace

absl::StatusOr<std::vector<Adjacency>> FindAdjacency(const Surface& surface,
                                                     const std::vector<SplitMesh>& meshes,
                                                     const RunContext& run) {
  std::vector<PieceSides> sides(meshes.size());
  PM_RETURN_IF_ERROR(ParallelFor(run, nullptr, meshes.size(), [&](std::size_t i) {
    sides[i] = InnerSides(surface.pieces[i], static_cast<int>(i), meshes[i]);
  }));
  std::vector<Adjacency> result;
  std::vector<BorderSide> border;
  double longest = 0.0;
  for (PieceSides& s : sides) {
    for (BorderSide& side : s.border) {
      longest = std::max(longest, s.all[side.adjacency].length);
      side.adjacency += result.size();
      border.push_back(side);
    }
    result.insert(result.end(), s.all.begin(), s.all.end());
    s = {};
  }
  const double join = std::max(surface.network.join_tolerance, 1e-9);
  const SideGrid grid(border, std::max(0.25 * longest, 4.0 * join));
  // Each writes its own side's neighbour and reads of the others only what is never written here.
  PM_RETURN_IF_ERROR(ParallelFor(run, "regions: neighbours", border.size(), [&](std::size_t k) {
    const BorderSide& side = border[k];
    Adjacency& adjacency = result[side.adjacency];
    double best = kInfinity;
    grid.Near(side.mid, join + 2.0 * side.sagitta, [&](std::size_t i) {
      const BorderSide& other = border[i];
      const TriangleSide& candidate = result[other.adjacency].side;
      if (other.adjacency == side.adjacency) return;
      const double d = SegmentDistance(side.mid, other.a, other.b);
      if (d > join + 2.0 * (side.sagitta + other.sagitta) || d >= best) return;
      // A piece may meet itself (a closed surface of one patch), but never its own neighbour triangle along
      // the same border.
      if (candidate.piece == adjacency.side.piece && (other.a - side.b).norm() < 1e-12) return;
      best = d;
      adjacency.other_piece = candidate.piece;
      adjacency.other_triangle = candidate.triangle;
      adjacency.across_seam = true;
    });
  }));
  return result;
}

}  // namespace patchmill
