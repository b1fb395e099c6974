#include "cam/region/split/seams.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <span>
#include <utility>

#include "core/base/parallel.h"
#include "core/base/segment.h"
#include "core/base/status.h"
#include "core/spatial/box_grid.h"

namespace patchmill {
namespace {

struct BorderSide {
  TriangleSide side;
  Vec3 a, b, mid;  // ends, and the point of the surface in the middle of the parameters
  double sagitta = 0.0;

  double Length() const { return (b - a).norm(); }
};

// Fills `beside` with the neighbours of one piece's triangles within the piece. Returns the sides on the
// border of the piece that have no neighbour in it, because they may have one across a seam.
std::vector<BorderSide> FindInner(const Piece& piece, int index, const SplitMesh& mesh,
                                  std::span<std::array<int, 3>> beside) {
  const auto corner = [&](std::size_t t, std::size_t s) {
    return static_cast<std::size_t>(mesh.triangles[t].vertex[s % 3]);
  };
  // Directed sides, sorted by their first vertex: those of vertex i are [first[i], first[i + 1]).
  std::vector<std::uint32_t> first(mesh.vertices.size() + 2, 0);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (std::size_t s = 0; s < 3; ++s) ++first[corner(t, s) + 2];
  }
  std::partial_sum(first.begin(), first.end(), first.begin());
  struct Directed {
    std::uint32_t to;
    int triangle;
  };
  std::vector<Directed> directed(3 * mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (std::size_t s = 0; s < 3; ++s)
      directed[first[corner(t, s) + 1]++] = {static_cast<std::uint32_t>(corner(t, s + 1)),
                                             static_cast<int>(t)};
  }
  const auto facing = [&](std::size_t from, std::size_t to) {
    for (std::size_t i = first[from]; i < first[from + 1]; ++i) {
      if (directed[i].to == to) return directed[i].triangle;
    }
    return -1;
  };
  std::vector<BorderSide> border;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (std::size_t s = 0; s < 3; ++s) {
      const std::size_t from = corner(t, s), to = corner(t, s + 1);
      beside[t][s] = facing(to, from);
      const ZeroVertex &a = mesh.vertices[from], &b = mesh.vertices[to];
      if (beside[t][s] >= 0 || !AlongBorder(a, b)) continue;
      BorderSide side{{index, static_cast<int>(t), static_cast<int>(s)},
                      a.p,
                      b.p,
                      Position(piece, 0.5 * (a.u + b.u), 0.5 * (a.v + b.v))};
      side.sagitta = SegmentDistance(side.mid, side.a, side.b);
      border.push_back(side);
    }
  }
  return border;
}

constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();

// The side of `border` that border[k] faces across a seam, or kNone.
std::size_t SideFacing(const std::vector<BorderSide>& border, const BoxGrid& grid, std::size_t k,
                       double join) {
  const BorderSide& side = border[k];
  std::size_t found = kNone;
  double best = kInfinity;
  grid.Near(side.mid, join + 2.0 * side.sagitta, [&](std::size_t i) {
    const BorderSide& other = border[i];
    if (i == k) return;
    const double d = SegmentDistance(side.mid, other.a, other.b);
    if (d > join + 2.0 * (side.sagitta + other.sagitta) || d >= best) return;
    // A piece may meet itself (a closed surface of one patch), but a side is not matched with the next side
    // along the same border.
    if (other.side.piece == side.side.piece && (other.a - side.b).norm() < 1e-12) return;
    best = d;
    found = i;
  });
  return found;
}

absl::StatusOr<AdjacencyList> FindAdjacency(const Surface& surface, const std::vector<SplitMesh>& meshes,
                                            const RunContext& run) {
  AdjacencyList list;
  for (const SplitMesh& mesh : meshes) list.first.push_back(list.first.back() + mesh.triangles.size());
  list.beside.resize(list.first.back());
  std::vector<std::vector<BorderSide>> borders(meshes.size());
  PM_RETURN_IF_ERROR(ParallelFor(run, "regions: seams", meshes.size(), [&](std::size_t i) {
    borders[i] = FindInner(surface.pieces[i], static_cast<int>(i), meshes[i],
                           std::span(list.beside).subspan(list.first[i], meshes[i].triangles.size()));
  }));
  std::vector<BorderSide> border;
  for (const auto& part : borders) border.insert(border.end(), part.begin(), part.end());
  double longest = 0.0;
  for (const BorderSide& side : border) longest = std::max(longest, side.Length());
  const double join = std::max(surface.network.join_tolerance, 1e-9);
  std::vector<Box3> boxes(border.size());
  for (std::size_t k = 0; k < border.size(); ++k) {
    for (const Vec3& p : {border[k].a, border[k].b, border[k].mid}) boxes[k].Add(p);
  }
  const BoxGrid grid(boxes, std::max(0.25 * longest, 4.0 * join));
  constexpr std::size_t kAtOnce = 64;  // sides in one task
  std::vector<std::size_t> facing(border.size());
  PM_RETURN_IF_ERROR(
      ParallelFor(run, "regions: neighbours", (border.size() + kAtOnce - 1) / kAtOnce, [&](std::size_t part) {
        for (std::size_t k = part * kAtOnce; k < std::min(border.size(), (part + 1) * kAtOnce); ++k)
          facing[k] = SideFacing(border, grid, k, join);
      }));
  for (std::size_t k = 0; k < border.size(); ++k) {
    if (facing[k] == kNone) continue;
    const TriangleSide &side = border[k].side, &other = border[facing[k]].side;
    const std::size_t n = list.NumberOf(side.piece, side.triangle);
    list.beside[n][static_cast<std::size_t>(side.side)] = -2 - static_cast<int>(list.seams.size());
    list.seams.push_back({3 * n + static_cast<std::size_t>(side.side), other.piece, other.triangle});
  }
  list.into.resize(meshes.size());
  for (const AdjacencyList::Seam& seam : list.seams)
    list.into[static_cast<std::size_t>(seam.other_piece)].push_back(seam.side);
  return list;
}

}  // namespace

Adjacency AdjacencyList::operator[](std::size_t side) const {
  const std::size_t n = side / 3;
  const auto piece = std::upper_bound(first.begin(), first.end(), n) - first.begin() - 1;
  return Of(static_cast<std::size_t>(piece), n, static_cast<int>(side % 3));
}

absl::StatusOr<SplitSurface> JoinMeshes(const Surface& surface, std::vector<SplitMesh> meshes,
                                        const RunContext& run) {
  PM_ASSIGN_OR_RETURN(AdjacencyList adjacency, FindAdjacency(surface, meshes, run));
  return SplitSurface{&surface, std::move(meshes), std::move(adjacency)};
}

}  // namespace patchmill
