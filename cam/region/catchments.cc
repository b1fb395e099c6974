#include "cam/region/catchments.h"

#include <algorithm>
#include <utility>

#include "cam/region/border_arcs.h"
#include "core/base/status.h"
#include "core/base/union_find.h"

namespace patchmill {
namespace {

// A line that divides summits (for sign 1), or pits; or either (0).
bool HasLine(const SplitMesh& mesh, int triangle, int side, double sign) {
  if (mesh.lines.empty()) return false;
  const auto& v = mesh.triangles[static_cast<std::size_t>(triangle)].vertex;
  const int a = v[static_cast<std::size_t>(side)], b = v[static_cast<std::size_t>((side + 1) % 3)];
  const auto line = mesh.lines.find(std::minmax(a, b));
  if (line == mesh.lines.end()) return false;
  return (sign >= 0.0 && line->second.summits) || (sign <= 0.0 && line->second.pits);
}

bool OnBorder(const ZeroVertex& a, const ZeroVertex& b) {
  return (a.u == b.u && (a.u == 0.0 || a.u == 1.0)) || (a.v == b.v && (a.v == 0.0 || a.v == 1.0));
}

}  // namespace

bool OnWatershed(const std::vector<SplitMesh>& meshes, const Adjacency& a, double sign) {
  if (HasLine(meshes[static_cast<std::size_t>(a.side.piece)], a.side.triangle, a.side.side, sign))
    return true;
  if (!a.across_seam) return false;
  const SplitMesh& other = meshes[static_cast<std::size_t>(a.other_piece)];
  for (int side = 0; side < 3; ++side) {
    const TriangleSide facing{a.other_piece, a.other_triangle, side};
    if (OnBorder(EndOf(other, facing, 0), EndOf(other, facing, 1)) &&
        HasLine(other, a.other_triangle, side, sign))
      return true;
  }
  return false;
}

absl::StatusOr<std::vector<std::vector<int>>> Catchments(const std::vector<SplitMesh>& meshes,
                                                         const std::vector<Adjacency>& adjacency,
                                                         const std::vector<MeshVertex>& tops, double sign,
                                                         const RunContext& run) {
  std::vector<std::vector<int>> found;
  std::vector<std::size_t> first{0};  // triangles of all pieces numbered through; each has three sides
  for (const SplitMesh& mesh : meshes) {
    found.emplace_back(mesh.triangles.size(), -1);
    first.push_back(first.back() + mesh.triangles.size());
  }
  if (tops.empty()) return found;
  const auto number = [&](int piece, int triangle) {
    return first[static_cast<std::size_t>(piece)] + static_cast<std::size_t>(triangle);
  };
  constexpr std::size_t kPoll = 1 << 15;  // sides between two looks at a cancelled run
  // A triangle, then what it grew into, belongs to a top as soon as it is joined with it.
  UnionFind sets(first.back());
  std::vector<int> top_of(first.back(), -1);  // by the set's smallest triangle
  for (std::size_t k = 0; k < tops.size(); ++k) {
    const SplitMesh& mesh = meshes[static_cast<std::size_t>(tops[k].piece)];
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      const auto& v = mesh.triangles[t].vertex;
      int& top = top_of[number(tops[k].piece, static_cast<int>(t))];
      if (top < 0 && std::find(v.begin(), v.end(), tops[k].vertex) != v.end()) top = static_cast<int>(k);
    }
  }
  // Sides by their higher ends: water that falls comes over the highest first.
  std::vector<std::pair<double, std::size_t>> sides, lines;
  for (std::size_t i = 0; i < adjacency.size(); ++i) {
    if (i % kPoll == 0) PM_RETURN_IF_ERROR(run.Check());
    const Adjacency& a = adjacency[i];
    if (a.other_piece < 0) continue;
    const std::size_t own = number(a.side.piece, a.side.triangle);
    if (!a.across_seam && own > number(a.other_piece, a.other_triangle)) continue;  // comes from the other
    const SplitMesh& mesh = meshes[static_cast<std::size_t>(a.side.piece)];
    const double level = std::max(sign * EndOf(mesh, a.side, 0).p.z(), sign * EndOf(mesh, a.side, 1).p.z());
    (OnWatershed(meshes, a, sign) ? lines : sides).emplace_back(-level, i);
  }
  for (auto* part : {&sides, &lines}) {  // pockets between lines that hold no top come last
    std::sort(part->begin(), part->end());
    PM_RETURN_IF_ERROR(run.Check());
    for (const auto& [below, i] : *part) {
      const Adjacency& a = adjacency[i];
      const std::size_t one = sets.Find(number(a.side.piece, a.side.triangle)),
                        other = sets.Find(number(a.other_piece, a.other_triangle));
      if (one == other || (top_of[one] >= 0 && top_of[other] >= 0 && top_of[one] != top_of[other])) continue;
      const int top = std::max(top_of[one], top_of[other]);
      sets.Join(one, other);
      top_of[sets.Find(one)] = top;
    }
  }
  for (std::size_t piece = 0; piece < found.size(); ++piece) {
    for (std::size_t t = 0; t < found[piece].size(); ++t)
      found[piece][t] = top_of[sets.Find(first[piece] + t)];
  }
  return found;
}

}  // namespace patchmill
