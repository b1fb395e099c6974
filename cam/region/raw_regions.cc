#include "cam/region/raw_regions.h"

#include "cam/region/region_border.h"
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

void Connect(const std::vector<SplitMesh>& meshes, const std::vector<Adjacency>& adjacency, RawRegions& raw) {
  std::vector<std::size_t> first{0};  // triangles of all pieces numbered through
  for (const SplitMesh& mesh : meshes) first.push_back(first.back() + mesh.triangles.size());
  const auto number = [&](int piece, int triangle) {
    return first[static_cast<std::size_t>(piece)] + static_cast<std::size_t>(triangle);
  };
  UnionFind sets(first.back());
  for (const Adjacency& a : adjacency) {
    if (a.other_piece < 0) continue;
    const auto& own = Triangle(meshes, a.side.piece, a.side.triangle);
    if (own.label == Triangle(meshes, a.other_piece, a.other_triangle).label)
      sets.Join(number(a.side.piece, a.side.triangle), number(a.other_piece, a.other_triangle));
  }
  std::vector<int> index(first.back(), -1);
  for (std::size_t piece = 0; piece < meshes.size(); ++piece) {
    raw.of.emplace_back();
    for (const SplitTriangle& t : meshes[piece].triangles) {
      const int triangle = static_cast<int>(raw.of.back().size());
      int& region = index[sets.Find(number(static_cast<int>(piece), triangle))];
      if (region < 0) {
        region = static_cast<int>(raw.regions.size());
        raw.regions.push_back({t.label});
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
                       const std::vector<Adjacency>& adjacency, std::span<const ZeroField> fields,
                       double tolerance, const RunContext& run, RawRegions& raw) {
  constexpr std::size_t kPollEvery = 4096;
  for (std::size_t i = 0; i < adjacency.size(); ++i) {
    if (i % kPollEvery == 0) PM_RETURN_IF_ERROR(run.Check());
    const Adjacency& a = adjacency[i];
    if (a.other_piece != a.side.piece) continue;
    const int own = RawOf(raw, a.side.piece, a.side.triangle);
    const int other = RawOf(raw, a.other_piece, a.other_triangle);
    if (own >= other) continue;
    const double lens =
        LensArea(surface, meshes[static_cast<std::size_t>(a.side.piece)], a.side, fields, tolerance);
    raw.regions[static_cast<std::size_t>(own)].area += lens;
    raw.regions[static_cast<std::size_t>(other)].area -= lens;
  }
  return absl::OkStatus();
}

}  // namespace

absl::StatusOr<RawRegions> FindRawRegions(const Surface& surface, const std::vector<SplitMesh>& meshes,
                                          const std::vector<Adjacency>& adjacency,
                                          std::span<const ZeroField> fields, double tolerance,
                                          const RunContext& run) {
  RawRegions raw;
  Connect(meshes, adjacency, raw);
  PM_RETURN_IF_ERROR(AddLenses(surface, meshes, adjacency, fields, tolerance, run, raw));
  for (const Adjacency& a : adjacency) {
    if (a.other_piece < 0) continue;
    const int own = RawOf(raw, a.side.piece, a.side.triangle);
    const int other = RawOf(raw, a.other_piece, a.other_triangle);
    if (own != other) raw.contacts.push_back({own, other, 0.5 * a.length});
  }
  return raw;
}

}  // namespace patchmill
