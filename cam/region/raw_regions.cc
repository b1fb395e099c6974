#include "cam/region/raw_regions.h"

#include "core/base/parallel.h"
#include "core/base/status.h"
#include "core/base/union_find.h"

namespace patchmill {
namespace {

const SplitTriangle& Triangle(const std::vector<SplitMesh>& meshes, int piece, int triangle) {
  return meshes[static_cast<std::size_t>(piece)].triangles[static_cast<std::size_t>(triangle)];
}

int RawOf(const RawRegions& raw, int piece, int triangle) {
  return raw.of[static_cast<std::size_t>(piece)][static_cast<std::size_t>(triangle)];
}

void Connect(const std::vector<SplitMesh>& meshes, const std::vector<Adjacency>& adjacency,
             const Watersheds& watersheds, RawRegions& raw) {
  std::vector<std::size_t> first{0};  // triangles of all pieces numbered through
  for (const SplitMesh& mesh : meshes) first.push_back(first.back() + mesh.triangles.size());
  const auto number = [&](int piece, int triangle) {
    return first[static_cast<std::size_t>(piece)] + static_cast<std::size_t>(triangle);
  };
  // Summits and pits divide what is reached.
  const auto same = [](const std::vector<std::vector<int>>& top, const Adjacency& a) {
    return top[static_cast<std::size_t>(a.side.piece)][static_cast<std::size_t>(a.side.triangle)] ==
           top[static_cast<std::size_t>(a.other_piece)][static_cast<std::size_t>(a.other_triangle)];
  };
  UnionFind wholes(first.back()), parts(first.back());
  for (const Adjacency& a : adjacency) {
    if (a.other_piece < 0) continue;
    const SplitLabel& own = Triangle(meshes, a.side.piece, a.side.triangle).label;
    if (!(own == Triangle(meshes, a.other_piece, a.other_triangle).label)) continue;
    const std::size_t here = number(a.side.piece, a.side.triangle),
                      there = number(a.other_piece, a.other_triangle);
    wholes.Join(here, there);
    if (own.reason != UnreachableReason::kNone || (same(watersheds.summit, a) && same(watersheds.pit, a)))
      parts.Join(here, there);
  }
  std::vector<int> index(first.back(), -1), whole(first.back(), -1);
  for (std::size_t piece = 0; piece < meshes.size(); ++piece) {
    raw.of.emplace_back();
    for (const SplitTriangle& t : meshes[piece].triangles) {
      const std::size_t triangle = raw.of.back().size();
      const std::size_t at = number(static_cast<int>(piece), static_cast<int>(triangle));
      int& region = index[parts.Find(at)];
      if (region < 0) {
        region = static_cast<int>(raw.regions.size());
        int& of = whole[wholes.Find(at)];
        if (of < 0) of = region;
        raw.regions.push_back({.label = t.label,
                               .whole = of,
                               .summit = watersheds.summit[piece][triangle],
                               .pit = watersheds.pit[piece][triangle]});
      }
      RawRegion& r = raw.regions[static_cast<std::size_t>(region)];
      r.area += t.area;
      r.curvature += t.curvature;
      r.steepness += t.steepness;
      raw.of.back().push_back(region);
    }
  }
}

// Moves the area between each border's chord and its true curve to the side it belongs to.
absl::Status AddLenses(const Surface& surface, const std::vector<SplitMesh>& meshes,
                       const std::vector<Adjacency>& adjacency, const RunContext& run, RawRegions& raw) {
  std::vector<std::size_t> bent;
  for (std::size_t i = 0; i < adjacency.size(); ++i) {
    const Adjacency& a = adjacency[i];
    if (raw.arcs[i].empty() || a.other_piece != a.side.piece) continue;
    if (RawOf(raw, a.side.piece, a.side.triangle) < RawOf(raw, a.other_piece, a.other_triangle))
      bent.push_back(i);
  }
  std::vector<double> lens(bent.size());
  PM_RETURN_IF_ERROR(ParallelFor(run, nullptr, bent.size(), [&](std::size_t k) {
    const TriangleSide& side = adjacency[bent[k]].side;
    lens[k] = LensArea(surface, meshes[static_cast<std::size_t>(side.piece)], side, raw.arcs[bent[k]]);
  }));
  for (std::size_t k = 0; k < bent.size(); ++k) {
    const Adjacency& a = adjacency[bent[k]];
    raw.regions[static_cast<std::size_t>(RawOf(raw, a.side.piece, a.side.triangle))].area += lens[k];
    raw.regions[static_cast<std::size_t>(RawOf(raw, a.other_piece, a.other_triangle))].area -= lens[k];
  }
  return absl::OkStatus();
}

}  // namespace

absl::StatusOr<RawRegions> FindRawRegions(const Surface& surface, const std::vector<SplitMesh>& meshes,
                                          const std::vector<Adjacency>& adjacency,
                                          const Watersheds& watersheds, std::span<const ZeroField> fields,
                                          double tolerance, const RunContext& run) {
  RawRegions raw;
  Connect(meshes, adjacency, watersheds, raw);
  PM_ASSIGN_OR_RETURN(raw.arcs, FindBorderArcs(surface, meshes, adjacency, raw.of, fields, tolerance, run));
  PM_RETURN_IF_ERROR(AddLenses(surface, meshes, adjacency, run, raw));
  for (const Adjacency& a : adjacency) {
    const int own = RawOf(raw, a.side.piece, a.side.triangle);
    if (a.other_piece < 0) {
      raw.regions[static_cast<std::size_t>(own)].open_border += a.length;
      continue;
    }
    const int other = RawOf(raw, a.other_piece, a.other_triangle);
    if (own != other) raw.contacts.push_back({own, other, 0.5 * a.length});
  }
  return raw;
}

}  // namespace patchmill
