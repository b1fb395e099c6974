#include "cam/region/region_map.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "cam/region/merge_regions.h"
#include "cam/region/region_border.h"
#include "core/base/parallel.h"
#include "core/base/status.h"
#include "core/diffgeo/forms.h"

namespace patchmill {
namespace {

// A region that bends less than this in all is neither mountain nor basin (ALGORITHMS 4, S0).
constexpr double kMinCurvature = 0.5;  // mm

// Shapes below this part of the ball's radius are too small for it to feel.
constexpr double kMinCell = 0.06;

int Find(std::vector<int>& parent, int i) {
  while (parent[static_cast<std::size_t>(i)] != i) {
    parent[static_cast<std::size_t>(i)] =
        parent[static_cast<std::size_t>(parent[static_cast<std::size_t>(i)])];
    i = parent[static_cast<std::size_t>(i)];
  }
  return i;
}

// Triangles of all pieces numbered through.
struct Numbering {
  explicit Numbering(const std::vector<SplitMesh>& meshes) {
    for (const SplitMesh& mesh : meshes) {
      first.push_back(count);
      count += static_cast<int>(mesh.triangles.size());
    }
  }
  int operator()(int piece, int triangle) const { return first[static_cast<std::size_t>(piece)] + triangle; }
  std::vector<int> first;
  int count = 0;
};

// Connected triangles of equal label; raw region of each triangle, numbered in order of their first triangle.
std::vector<int> RawRegions(const std::vector<SplitMesh>& meshes, const std::vector<Adjacency>& adjacency,
                            const Numbering& number, int& count) {
  std::vector<int> parent(static_cast<std::size_t>(number.count));
  std::iota(parent.begin(), parent.end(), 0);
  const auto label = [&](int piece, int triangle) -> const SplitLabel& {
    return meshes[static_cast<std::size_t>(piece)].triangles[static_cast<std::size_t>(triangle)].label;
  };
  for (const Adjacency& a : adjacency) {
    if (a.other_piece < 0 ||
        !(label(a.side.piece, a.side.triangle) == label(a.other_piece, a.other_triangle)))
      continue;
    const int x = Find(parent, number(a.side.piece, a.side.triangle)),
              y = Find(parent, number(a.other_piece, a.other_triangle));
    parent[static_cast<std::size_t>(std::max(x, y))] = std::min(x, y);
  }
  std::vector<int> raw(parent.size());
  std::map<int, int> index;
  for (std::size_t i = 0; i < parent.size(); ++i) {
    raw[i] =
        index.try_emplace(Find(parent, static_cast<int>(i)), static_cast<int>(index.size())).first->second;
  }
  count = static_cast<int>(index.size());
  return raw;
}

std::vector<RawRegion> MeasureRaw(const Surface& surface, const std::vector<SplitMesh>& meshes,
                                  const std::vector<Adjacency>& adjacency, const Numbering& number,
                                  const std::vector<int>& raw_of, int count, double cos_steep,
                                  double tolerance) {
  std::vector<RawRegion> raw(static_cast<std::size_t>(count));
  for (std::size_t piece = 0; piece < meshes.size(); ++piece) {
    const auto& triangles = meshes[piece].triangles;
    for (std::size_t t = 0; t < triangles.size(); ++t) {
      RawRegion& r = raw[static_cast<std::size_t>(
          raw_of[static_cast<std::size_t>(number(static_cast<int>(piece), static_cast<int>(t)))])];
      r.label = triangles[t].label;
      r.area += triangles[t].area;
      r.curvature += triangles[t].curvature;
    }
  }
  for (const Adjacency& a : adjacency) {
    if (a.other_piece != a.side.piece) continue;
    const int own = raw_of[static_cast<std::size_t>(number(a.side.piece, a.side.triangle))];
    const int other = raw_of[static_cast<std::size_t>(number(a.other_piece, a.other_triangle))];
    if (own < other) {
      const double lens =
          LensArea(surface, meshes[static_cast<std::size_t>(a.side.piece)], a.side, cos_steep, tolerance);
      raw[static_cast<std::size_t>(own)].area += lens;
      raw[static_cast<std::size_t>(other)].area -= lens;
    }
  }
  return raw;
}

RegionKind KindOf(const SplitLabel& label) {
  if (label.reason != UnreachableReason::kNone) return RegionKind::kUnreachable;
  return label.curvature < 0   ? RegionKind::kMountain
         : label.curvature > 0 ? RegionKind::kBasin
                               : RegionKind::kNeutral;
}

// Leaves, deepest leftover and largest tool of unreachable regions, from a few spread triangles of each.
struct Sample {
  int piece, triangle;
};
void DescribeUnreachable(const Surface& surface, const std::vector<SplitMesh>& meshes, const ReachTest& reach,
                         const RegionParams& params, const std::vector<Sample>& samples, Region& region) {
  constexpr std::size_t kLooked = 200, kProbed = 12;
  double largest = params.radius;
  for (std::size_t i = 0; i < samples.size(); i += std::max<std::size_t>(1, samples.size() / kLooked)) {
    const SplitMesh& mesh = meshes[static_cast<std::size_t>(samples[i].piece)];
    double u = 0, v = 0;
    for (const int id : mesh.triangles[static_cast<std::size_t>(samples[i].triangle)].vertex) {
      u += mesh.vertices[static_cast<std::size_t>(id)].u / 3.0;
      v += mesh.vertices[static_cast<std::size_t>(id)].v / 3.0;
    }
    const SurfaceJet jet = Evaluate(surface.pieces[static_cast<std::size_t>(samples[i].piece)], u, v);
    region.deepest_leftover = std::max(region.deepest_leftover, reach.LeftoverAbove(jet.p));
    const bool probe = i % std::max<std::size_t>(1, samples.size() / kProbed) == 0;
    const auto normal = UpwardNormal(jet);
    if (region.reason == UnreachableReason::kConcave && probe && normal) {
      largest =
          std::min(largest, LargestFreeRadius(surface, jet.p, *normal, params.radius, params.tolerance));
    }
  }
  if (region.reason == UnreachableReason::kConcave) region.largest_tool_diameter = 2.0 * largest;
}

// Label grids for RegionMap::At.
void FillLabels(const std::vector<SplitMesh>& meshes, const std::vector<std::vector<int>>& region_of,
                RegionMap& map) {
  constexpr double kMaxLabels = 8e6;
  map.cells = std::clamp(
      static_cast<int>(std::sqrt(kMaxLabels / static_cast<double>(std::max<std::size_t>(1, meshes.size())))),
      1, 64);
  const int n = map.cells;
  map.labels.assign(meshes.size(), std::vector<int>(static_cast<std::size_t>(n * n), -1));
  for (std::size_t piece = 0; piece < meshes.size(); ++piece) {
    const SplitMesh& mesh = meshes[piece];
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      Vec2 q[3];
      Vec2 low(1, 1), high(0, 0);
      for (std::size_t k = 0; k < 3; ++k) {
        const SplitVertex& vertex = mesh.vertices[static_cast<std::size_t>(mesh.triangles[t].vertex[k])];
        q[k] = {vertex.u, vertex.v};
        low = low.cwiseMin(q[k]);
        high = high.cwiseMax(q[k]);
      }
      const auto cell = [&](double x) { return std::clamp(static_cast<int>(x * n), 0, n - 1); };
      for (int i = cell(low.x()); i <= cell(high.x()); ++i) {
        for (int j = cell(low.y()); j <= cell(high.y()); ++j) {
          const Vec2 c((i + 0.5) / n, (j + 0.5) / n);
          bool inside = true;
          for (int k = 0; k < 3; ++k) inside = inside && Cross(q[(k + 1) % 3] - q[k], c - q[k]) >= -1e-12;
          if (inside) map.labels[piece][static_cast<std::size_t>(i * n + j)] = region_of[piece][t];
        }
      }
    }
  }
}

}  // namespace

const char* Name(RegionKind kind) {
  switch (kind) {
    case RegionKind::kMountain:
      return "mountain";
    case RegionKind::kBasin:
      return "basin";
    case RegionKind::kNeutral:
      return "neutral";
    case RegionKind::kUnreachable:
      return "unreachable";
  }
  return "";
}

const char* Name(SlopeClass slope) {
  switch (slope) {
    case SlopeClass::kUnspecified:
      return "unspecified";
    case SlopeClass::kSteep:
      return "steep";
    case SlopeClass::kGentle:
      return "gentle";
  }
  return "";
}

const char* Name(UnreachableReason reason) {
  switch (reason) {
    case UnreachableReason::kNone:
      return "NONE";
    case UnreachableReason::kUndercut:
      return "UNDERCUT";
    case UnreachableReason::kConcave:
      return "CONCAVE";
    case UnreachableReason::kFloor:
      return "FLOOR";
    case UnreachableReason::kAvoided:
      return "AVOIDED";
    case UnreachableReason::kStrategy:
      return "STRATEGY";
    case UnreachableReason::kHolder:
      return "HOLDER";
  }
  return "";
}

absl::StatusOr<RegionMap> SplitRegions(const Surface& surface, const RegionParams& params,
                                       const RunContext& run) {
  const Locator free_ball(surface, std::max(params.radius - params.tolerance, 0.5 * params.radius));
  const ReachTest reach(free_ball, params);
  SplitMeshParams mesh_params;
  mesh_params.cos_steep = std::cos(params.steep_angle);
  mesh_params.border_tolerance = params.border_tolerance;
  mesh_params.max_cell = std::max(0.6 * params.radius, 0.02 * surface.box.Diagonal());
  mesh_params.min_cell = kMinCell * params.radius;
  std::vector<SplitMesh> meshes(surface.pieces.size());
  PM_RETURN_IF_ERROR(ParallelFor(run, "regions", meshes.size(), [&](std::size_t i) {
    meshes[i] = BuildSplitMesh(surface.pieces[i], reach, mesh_params);
  }));

  const std::vector<Adjacency> adjacency = FindAdjacency(surface, meshes);
  PM_RETURN_IF_ERROR(run.Check());
  const Numbering number(meshes);
  int raw_count = 0;
  const std::vector<int> raw_of = RawRegions(meshes, adjacency, number, raw_count);
  const std::vector<RawRegion> raw = MeasureRaw(surface, meshes, adjacency, number, raw_of, raw_count,
                                                mesh_params.cos_steep, params.border_tolerance);
  std::vector<RawContact> contacts;
  for (const Adjacency& a : adjacency) {
    if (a.other_piece < 0) continue;
    const int own = raw_of[static_cast<std::size_t>(number(a.side.piece, a.side.triangle))];
    const int other = raw_of[static_cast<std::size_t>(number(a.other_piece, a.other_triangle))];
    if (own != other)
      contacts.push_back({own, other, 0.5 * a.length});  // every border is seen from both sides
  }
  MergeParams merge_params;
  merge_params.min_area = params.min_area > 0.0 ? params.min_area : 2.0 * kPi * params.radius * params.radius;
  merge_params.min_curvature = kMinCurvature;
  const MergedRegions merged = MergeRegions(raw, contacts, merge_params);

  // Regions in their final order: reachable by falling area, then unreachable by falling area.
  std::vector<Region> regions(merged.label.size());
  for (std::size_t g = 0; g < regions.size(); ++g) {
    regions[g].kind = KindOf(merged.label[g]);
    regions[g].reason = merged.label[g].reason;
    regions[g].slope = regions[g].kind == RegionKind::kUnreachable ? SlopeClass::kUnspecified
                       : merged.label[g].steep                     ? SlopeClass::kSteep
                                                                   : SlopeClass::kGentle;
  }
  for (std::size_t i = 0; i < raw.size(); ++i)
    regions[static_cast<std::size_t>(merged.group[i])].area += raw[i].area;
  std::vector<int> order(regions.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) {
    const Region &x = regions[static_cast<std::size_t>(a)], &y = regions[static_cast<std::size_t>(b)];
    const bool ux = x.kind == RegionKind::kUnreachable, uy = y.kind == RegionKind::kUnreachable;
    return ux != uy ? uy : x.area > y.area;
  });
  std::vector<int> final_id(regions.size());
  RegionMap map;
  for (std::size_t k = 0; k < order.size(); ++k) {
    final_id[static_cast<std::size_t>(order[k])] = static_cast<int>(k);
    map.regions.push_back(regions[static_cast<std::size_t>(order[k])]);
    map.regions.back().id = static_cast<int>(k);
    map.regions.back().z_min = kInfinity;
    map.regions.back().z_max = -kInfinity;
  }

  std::vector<std::vector<int>> region_of(meshes.size());
  std::vector<std::vector<Sample>> samples(map.regions.size());
  std::vector<double> largest_triangle(map.regions.size(), -1.0);
  for (std::size_t piece = 0; piece < meshes.size(); ++piece) {
    const SplitMesh& mesh = meshes[piece];
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      const int id = final_id[static_cast<std::size_t>(merged.group[static_cast<std::size_t>(
          raw_of[static_cast<std::size_t>(number(static_cast<int>(piece), static_cast<int>(t)))])])];
      region_of[piece].push_back(id);
      Region& region = map.regions[static_cast<std::size_t>(id)];
      double u = 0, v = 0;
      for (const int vertex : mesh.triangles[t].vertex) {
        const SplitVertex& corner = mesh.vertices[static_cast<std::size_t>(vertex)];
        region.z_min = std::min(region.z_min, corner.p.z());
        region.z_max = std::max(region.z_max, corner.p.z());
        u += corner.u / 3.0;
        v += corner.v / 3.0;
      }
      if (mesh.triangles[t].area > largest_triangle[static_cast<std::size_t>(id)]) {
        largest_triangle[static_cast<std::size_t>(id)] = mesh.triangles[t].area;
        region.inside = Position(surface.pieces[piece], u, v);
      }
      if (region.kind == RegionKind::kUnreachable)
        samples[static_cast<std::size_t>(id)].push_back({static_cast<int>(piece), static_cast<int>(t)});
    }
  }
  for (std::size_t i = 0; i < map.regions.size(); ++i) {
    PM_RETURN_IF_ERROR(run.Check());
    if (map.regions[i].kind == RegionKind::kUnreachable)
      DescribeUnreachable(surface, meshes, reach, params, samples[i], map.regions[i]);
  }
  auto borders = RegionBorders(surface, meshes, adjacency, region_of, static_cast<int>(map.regions.size()),
                               mesh_params.cos_steep, params.border_tolerance);
  for (std::size_t i = 0; i < map.regions.size(); ++i) map.regions[i].border = std::move(borders[i]);
  FillLabels(meshes, region_of, map);
  return map;
}

}  // namespace patchmill
