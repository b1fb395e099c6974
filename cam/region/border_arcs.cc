#include "cam/region/border_arcs.h"

#include <algorithm>
#include <compare>

#include "core/base/parallel.h"
#include "core/base/status.h"

namespace patchmill {
namespace {

int VertexOf(const SplitMesh& mesh, const TriangleSide& side, int which) {
  const auto& v = mesh.triangles[static_cast<std::size_t>(side.triangle)].vertex;
  return v[static_cast<std::size_t>((side.side + which) % 3)];
}

// The field on whose zero curve both ends lie, a smooth one first.
const ZeroField* CommonField(const ZeroVertex& a, const ZeroVertex& b, std::span<const ZeroField> fields) {
  const ZeroField* limit = nullptr;
  for (std::size_t k = 0; k < fields.size(); ++k) {
    if ((((a.on & b.on) >> k) & 1u) == 0) continue;
    if (fields[k].smooth) return &fields[k];
    if (limit == nullptr) limit = &fields[k];
  }
  return limit;
}

// The places along a watershed, if the side lies on one.
std::vector<Vec2> LineAlong(const SplitMesh& mesh, const TriangleSide& side) {
  const int a = VertexOf(mesh, side, 0), b = VertexOf(mesh, side, 1);
  const auto line = mesh.lines.find(std::minmax(a, b));
  if (line == mesh.lines.end()) return {};
  const std::vector<Vec2>& places = line->second.places;
  return a < b ? places : std::vector<Vec2>(places.rbegin(), places.rend());
}

// Of each of these sides the first one along the same edge of a piece: both see one arc.
std::vector<std::size_t> FirstAlongEdge(const std::vector<SplitMesh>& meshes,
                                        const std::vector<Adjacency>& adjacency,
                                        const std::vector<std::size_t>& sides) {
  struct Edge {
    int piece, low, high;
    std::size_t place;
    auto operator<=>(const Edge&) const = default;
  };
  std::vector<Edge> edges;
  for (std::size_t k = 0; k < sides.size(); ++k) {
    const TriangleSide& side = adjacency[sides[k]].side;
    const SplitMesh& mesh = meshes[static_cast<std::size_t>(side.piece)];
    const int a = VertexOf(mesh, side, 0), b = VertexOf(mesh, side, 1);
    edges.push_back({side.piece, std::min(a, b), std::max(a, b), k});
  }
  std::sort(edges.begin(), edges.end());
  std::vector<std::size_t> first(sides.size());
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const Edge &edge = edges[i], &before = edges[i > 0 ? i - 1 : 0];
    const bool again =
        i > 0 && edge.piece == before.piece && edge.low == before.low && edge.high == before.high;
    first[edge.place] = again ? first[before.place] : edge.place;
  }
  return first;
}

// Runs of sides of one piece, each from where it begins among `sides`, and their end; no longer than is
// refined between two looks at a cancelled run.
std::vector<std::size_t> PieceRuns(const std::vector<Adjacency>& adjacency,
                                   const std::vector<std::size_t>& sides) {
  constexpr std::size_t kLongest = 256;
  std::vector<std::size_t> runs;
  for (std::size_t k = 0; k < sides.size(); ++k) {
    const bool fresh = k == 0 || adjacency[sides[k]].side.piece != adjacency[sides[k - 1]].side.piece;
    if (fresh || k - runs.back() == kLongest) runs.push_back(k);
  }
  runs.push_back(sides.size());
  return runs;
}

// The arcs of these sides of one piece, those of one field all at once.
void RefineSides(const Surface& surface, const std::vector<SplitMesh>& meshes,
                 const std::vector<Adjacency>& adjacency, const std::vector<std::size_t>& sides,
                 std::span<const ZeroField> fields, double tolerance, BorderArcs& arcs) {
  if (sides.empty()) return;
  const auto index = static_cast<std::size_t>(adjacency[sides.front()].side.piece);
  std::vector<std::vector<std::size_t>> along(fields.size());  // their field
  std::vector<std::vector<ZeroSegment>> chords(fields.size());
  for (const std::size_t i : sides) {
    const ZeroVertex &a = EndOf(meshes[index], adjacency[i].side, 0),
                     &b = EndOf(meshes[index], adjacency[i].side, 1);
    const ZeroField* field = CommonField(a, b, fields);
    if (field == nullptr) {
      arcs[i] = LineAlong(meshes[index], adjacency[i].side);
      continue;
    }
    const auto f = static_cast<std::size_t>(field - fields.data());
    along[f].push_back(i);
    chords[f].push_back({{a.u, a.v}, {b.u, b.v}});
  }
  for (std::size_t f = 0; f < fields.size(); ++f) {
    auto refined = RefineZeroArcs(surface.pieces[index], fields[f], chords[f], tolerance);
    for (std::size_t k = 0; k < refined.size(); ++k) arcs[along[f][k]] = std::move(refined[k]);
  }
}

}  // namespace

const ZeroVertex& EndOf(const SplitMesh& mesh, const TriangleSide& side, int which) {
  return mesh.vertices[static_cast<std::size_t>(VertexOf(mesh, side, which))];
}

absl::StatusOr<BorderArcs> FindBorderArcs(const Surface& surface, const std::vector<SplitMesh>& meshes,
                                          const std::vector<Adjacency>& adjacency,
                                          const std::vector<std::vector<int>>& region_of,
                                          std::span<const ZeroField> fields, double tolerance,
                                          const RunContext& run) {
  const auto region = [&](int piece, int triangle) {
    return piece < 0 ? -1 : region_of[static_cast<std::size_t>(piece)][static_cast<std::size_t>(triangle)];
  };
  std::vector<std::size_t> sides;
  for (std::size_t i = 0; i < adjacency.size(); ++i) {
    const Adjacency& a = adjacency[i];
    if (region(a.side.piece, a.side.triangle) != region(a.other_piece, a.other_triangle)) sides.push_back(i);
  }
  const std::vector<std::size_t> first = FirstAlongEdge(meshes, adjacency, sides);
  const std::vector<std::size_t> runs = PieceRuns(adjacency, sides);
  BorderArcs arcs(adjacency.size());
  PM_RETURN_IF_ERROR(ParallelFor(run, "regions: borders", runs.size() - 1, [&](std::size_t r) {
    std::vector<std::size_t> own;
    for (std::size_t k = runs[r]; k < runs[r + 1]; ++k) {
      if (first[k] == k) own.push_back(sides[k]);
    }
    RefineSides(surface, meshes, adjacency, own, fields, tolerance, arcs);
  }));
  for (std::size_t k = 0; k < sides.size(); ++k) {
    const std::vector<Vec2>& arc = arcs[sides[first[k]]];
    if (first[k] != k) arcs[sides[k]].assign(arc.rbegin(), arc.rend());
  }
  return arcs;
}

double LensArea(const Surface& surface, const SplitMesh& mesh, const TriangleSide& side,
                const std::vector<Vec2>& arc) {
  if (arc.empty()) return 0.0;
  const Piece& piece = surface.pieces[static_cast<std::size_t>(side.piece)];
  const ZeroVertex &a = EndOf(mesh, side, 0), &b = EndOf(mesh, side, 1);
  const Vec2 from(a.u, a.v), to(b.u, b.v);
  // The triangle lies on the left of its side (counter-clockwise): an arc to the right adds to it, and turns
  // counter-clockwise around the side's start.
  double area = 0.0;
  for (std::size_t i = 0; i < arc.size(); ++i)
    area += SurfaceArea(piece, from, arc[i], i + 1 < arc.size() ? arc[i + 1] : to);
  return area;
}

}  // namespace patchmill
