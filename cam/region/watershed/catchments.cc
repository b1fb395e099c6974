#include "cam/region/watershed/catchments.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "core/base/parallel.h"
#include "core/base/status.h"
#include "core/base/union_find.h"

namespace patchmill {
namespace {

// True if a line along the side divides summits (sign 1), pits (-1) or either (0).
bool HasLine(const SplitMesh& mesh, int triangle, int side, double sign) {
  if (mesh.lines.empty()) return false;
  const auto& v = mesh.triangles[static_cast<std::size_t>(triangle)].vertex;
  const int a = v[static_cast<std::size_t>(side)], b = v[static_cast<std::size_t>((side + 1) % 3)];
  const auto line = mesh.lines.find(std::minmax(a, b));
  if (line == mesh.lines.end()) return false;
  return (sign >= 0.0 && line->second.summits) || (sign <= 0.0 && line->second.pits);
}

constexpr std::size_t kOutside = std::numeric_limits<std::size_t>::max();

// A side over which the flood passes between two triangles (by their numbers). The highest sides come first.
struct Link {
  double below = 0.0;  // mm; how far its higher end lies below z = 0
  std::size_t side = 0;
  std::size_t a = 0, b = 0;  // b is kOutside if the other triangle is not part of the current step

  bool Before(const Link& other) const {
    return below < other.below || (below == other.below && side < other.side);
  }
};

// Joins triangles over sides until everything that is connected with a top belongs to one. The result is the
// forest that one gets by joining over all sides in their order, except where this would join two tops. For
// each set without a top this forest contains the first side that leads out of the set
// [references: boruvka1926]. So sets grow side by side, and nothing is sorted.
class Forest {
 public:
  // top_of[triangle] is the triangle's top, or -1.
  explicit Forest(std::vector<int> top_of)
      : sets_(top_of.size()), top_of_(std::move(top_of)), best_(top_of_.size(), kOutside) {}

  // Joins sets over these links as far as their order is known: a set whose first link leads outside waits.
  // Leaves in `links` those that may still join sets and do not lead outside. Several threads may call it at
  // the same time if their links have no triangle in common.
  void MergeAlong(std::vector<Link>& links) {
    for (bool grown = true; grown;) {
      std::size_t kept = 0;
      for (Link link : links) {
        link.a = sets_.Find(link.a);
        if (link.b != kOutside) link.b = sets_.Find(link.b);
        if (link.a == link.b || (HasTop(link.a) && (link.b == kOutside || HasTop(link.b)))) continue;
        links[kept] = link;
        Offer(link.a, links, kept);
        if (link.b != kOutside) Offer(link.b, links, kept);
        ++kept;
      }
      links.resize(kept);
      grown = false;
      for (std::size_t k = 0; k < kept; ++k) {
        const Link& link = links[k];
        if (link.b == kOutside || (best_[link.a] != k && best_[link.b] != k)) continue;
        const std::size_t a = sets_.Find(link.a), b = sets_.Find(link.b);
        const int top = std::max(top_of_[a], top_of_[b]);  // at least one of them is -1
        sets_.Join(a, b);
        top_of_[std::min(a, b)] = top;
        grown = true;
      }
      for (const Link& link : links) {
        best_[link.a] = kOutside;
        if (link.b != kOutside) best_[link.b] = kOutside;
      }
    }
    std::erase_if(links, [](const Link& link) { return link.b == kOutside; });
  }

  int TopOf(std::size_t triangle) { return top_of_[sets_.Find(triangle)]; }

 private:
  bool HasTop(std::size_t set) const { return top_of_[set] >= 0; }
  void Offer(std::size_t set, const std::vector<Link>& links, std::size_t k) {
    if (!HasTop(set) && (best_[set] == kOutside || links[k].Before(links[best_[set]]))) best_[set] = k;
  }

  UnionFind sets_;
  std::vector<int> top_of_;        // top of each set, at the index of its smallest triangle
  std::vector<std::size_t> best_;  // place of each set's first link, at the same index
};

}  // namespace

bool OnWatershed(const std::vector<SplitMesh>& meshes, const Adjacency& a, double sign) {
  if (HasLine(meshes[static_cast<std::size_t>(a.side.piece)], a.side.triangle, a.side.side, sign))
    return true;
  if (!a.across_seam) return false;
  const SplitMesh& other = meshes[static_cast<std::size_t>(a.other_piece)];
  for (int side = 0; side < 3; ++side) {
    const TriangleSide facing{a.other_piece, a.other_triangle, side};
    if (AlongBorder(EndOf(other, facing, 0), EndOf(other, facing, 1)) &&
        HasLine(other, a.other_triangle, side, sign))
      return true;
  }
  return false;
}

absl::StatusOr<PerTriangle<int>> Catchments(const SplitSurface& split, const std::vector<MeshVertex>& tops,
                                            double sign, const RunContext& run) {
  const std::vector<SplitMesh>& meshes = split.meshes;
  const AdjacencyList& adjacency = split.adjacency;
  PerTriangle<int> found;
  for (const SplitMesh& mesh : meshes) found.emplace_back(mesh.triangles.size(), -1);
  if (tops.empty()) return found;
  std::vector<int> top_of(adjacency.beside.size(), -1);
  for (std::size_t k = 0; k < tops.size(); ++k) {
    const SplitMesh& mesh = meshes[static_cast<std::size_t>(tops[k].piece)];
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      const auto& v = mesh.triangles[t].vertex;
      int& top = top_of[adjacency.NumberOf(tops[k].piece, static_cast<int>(t))];
      if (top < 0 && std::find(v.begin(), v.end(), tops[k].vertex) != v.end()) top = static_cast<int>(k);
    }
  }
  const auto divides = [&](const Adjacency& a) {
    return (!meshes[static_cast<std::size_t>(a.side.piece)].lines.empty() ||
            !meshes[static_cast<std::size_t>(a.other_piece)].lines.empty()) &&
           OnWatershed(meshes, a, sign);
  };
  const auto link = [&](std::size_t i, const Adjacency& a) {
    const SplitMesh& mesh = meshes[static_cast<std::size_t>(a.side.piece)];
    const double level = std::max(sign * EndOf(mesh, a.side, 0).p.z(), sign * EndOf(mesh, a.side, 1).p.z());
    return Link{-level, i, i / 3, adjacency.NumberOf(a.other_piece, a.other_triangle)};
  };
  // Floods each piece by itself as far as its seams allow, then all together, and across lines last.
  Forest forest(std::move(top_of));
  struct Rest {
    std::vector<Link> inner, seams, lines;
  };
  std::vector<Rest> rest(meshes.size());
  PM_RETURN_IF_ERROR(ParallelFor(run, "regions: catchments", meshes.size(), [&](std::size_t piece) {
    Rest& own = rest[piece];
    own.inner.reserve(2 * meshes[piece].triangles.size());
    adjacency.VisitPiece(piece, [&](std::size_t i, const Adjacency& a) {
      if (a.other_piece < 0 || (!a.across_seam && a.other_triangle < a.side.triangle)) return;
      const Link over = link(i, a);
      (divides(a) ? own.lines : a.across_seam ? own.seams : own.inner).push_back(over);
    });
    for (const Link& over : own.seams) own.inner.push_back({over.below, over.side, over.a, kOutside});
    for (const std::size_t i : adjacency.into[piece]) {
      const Adjacency a = adjacency[i];
      if (divides(a)) continue;
      const Link over = link(i, a);
      own.inner.push_back({over.below, over.side, over.b, kOutside});
    }
    forest.MergeAlong(own.inner);
  }));
  std::vector<Link> links, lines;
  for (Rest& of : rest) {
    links.insert(links.end(), of.inner.begin(), of.inner.end());
    links.insert(links.end(), of.seams.begin(), of.seams.end());
    lines.insert(lines.end(), of.lines.begin(), of.lines.end());
    of = {};
  }
  forest.MergeAlong(links);
  PM_RETURN_IF_ERROR(run.Check());
  forest.MergeAlong(lines);
  for (std::size_t piece = 0; piece < found.size(); ++piece) {
    for (std::size_t t = 0; t < found[piece].size(); ++t)
      found[piece][t] = forest.TopOf(adjacency.first[piece] + t);
  }
  return found;
}

}  // namespace patchmill
