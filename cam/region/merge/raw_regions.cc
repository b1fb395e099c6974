#include "cam/region/merge/raw_regions.h"

#include <algorithm>
#include <cstdint>
#include <unordered_map>

#include "cam/region/split/side_groups.h"
#include "core/base/status.h"

namespace patchmill {
namespace {

const SplitTriangle& Triangle(const std::vector<SplitMesh>& meshes, int piece, int triangle) {
  return meshes[static_cast<std::size_t>(piece)].triangles[static_cast<std::size_t>(triangle)];
}

int RawOf(const RawRegions& raw, int piece, int triangle) {
  return raw.of[static_cast<std::size_t>(piece)][static_cast<std::size_t>(triangle)];
}

absl::Status Connect(const SplitSurface& split, const Watersheds& watersheds, const RunContext& run,
                     RawRegions& raw) {
  const std::vector<SplitMesh>& meshes = split.meshes;
  const AdjacencyList& adjacency = split.adjacency;
  const auto alike = [&](const Adjacency& a) {
    return Triangle(meshes, a.side.piece, a.side.triangle).label ==
           Triangle(meshes, a.other_piece, a.other_triangle).label;
  };
  // Both triangles belong to the same summit or pit. Only reachable areas are divided by them.
  const auto same = [](const PerTriangle<int>& top, const Adjacency& a) {
    return top[static_cast<std::size_t>(a.side.piece)][static_cast<std::size_t>(a.side.triangle)] ==
           top[static_cast<std::size_t>(a.other_piece)][static_cast<std::size_t>(a.other_triangle)];
  };
  PM_ASSIGN_OR_RETURN(UnionFind wholes, JoinAcross(adjacency, run, alike));
  PM_ASSIGN_OR_RETURN(UnionFind parts, JoinAcross(adjacency, run, [&](const Adjacency& a) {
                        return alike(a) && (Triangle(meshes, a.side.piece, a.side.triangle).label.reason !=
                                                UnreachableReason::kNone ||
                                            (same(watersheds.summit, a) && same(watersheds.pit, a)));
                      }));
  std::vector<int> index(adjacency.beside.size(), -1), whole(adjacency.beside.size(), -1);
  for (std::size_t piece = 0; piece < meshes.size(); ++piece) {
    raw.of.emplace_back();
    for (const SplitTriangle& t : meshes[piece].triangles) {
      const std::size_t triangle = raw.of.back().size();
      const std::size_t at = adjacency.first[piece] + triangle;
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
  return absl::OkStatus();
}

// Measures the borders between regions (each side of a border adds half of its length) and open borders.
absl::Status MeasureBorders(const SplitSurface& split, const RunContext& run, RawRegions& raw) {
  std::vector<std::vector<std::size_t>> pieces(raw.of.size());
  PM_RETURN_IF_ERROR(ParallelFor(run, nullptr, pieces.size(), [&](std::size_t piece) {
    pieces[piece] = BorderSides(split.adjacency, piece, raw.of);
  }));
  std::vector<std::size_t> sides;
  for (const std::vector<std::size_t>& own : pieces) sides.insert(sides.end(), own.begin(), own.end());
  std::unordered_map<std::uint64_t, std::size_t> contact_of;  // for lookup only: its order is not fixed
  for (const std::size_t i : sides) {
    const Adjacency a = split.adjacency[i];
    const SplitMesh& mesh = split.meshes[static_cast<std::size_t>(a.side.piece)];
    const double length = (EndOf(mesh, a.side, 1).p - EndOf(mesh, a.side, 0).p).norm();
    const int own = RawOf(raw, a.side.piece, a.side.triangle);
    if (a.other_piece < 0) {
      raw.regions[static_cast<std::size_t>(own)].open_border += length;
      continue;
    }
    const auto [low, high] = std::minmax({own, RawOf(raw, a.other_piece, a.other_triangle)});
    const std::uint64_t pair = (static_cast<std::uint64_t>(low) << 32) | static_cast<std::uint64_t>(high);
    const auto [at, fresh] = contact_of.try_emplace(pair, raw.contacts.size());
    if (fresh) raw.contacts.push_back({low, high, 0.0});
    raw.contacts[at->second].length += 0.5 * length;
  }
  return absl::OkStatus();
}

}  // namespace

absl::StatusOr<RawRegions> FindRawRegions(const SplitSurface& split, const Watersheds& watersheds,
                                          const RunContext& run) {
  RawRegions raw;
  PM_RETURN_IF_ERROR(Connect(split, watersheds, run, raw));
  PM_RETURN_IF_ERROR(MeasureBorders(split, run, raw));
  return raw;
}

}  // namespace patchmill
