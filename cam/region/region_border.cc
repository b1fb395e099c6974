#include "cam/region/region_border.h"

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
const ZeroVertex& End(const SplitMesh& mesh, const TriangleSide& side, int which) {
  return mesh.vertices[static_cast<std::size_t>(VertexOf(mesh, side, which))];
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

std::vector<Vec2> ArcOf(const Piece& piece, const ZeroField* field, const ZeroVertex& a, const ZeroVertex& b,
                        double tolerance) {
  if (field == nullptr) return {};
  return RefineZeroArc(piece, *field, {a.u, a.v}, {b.u, b.v}, tolerance);
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

// Where the sides of each piece begin among `sides`, and their end.
std::vector<std::size_t> PieceRuns(const std::vector<Adjacency>& adjacency,
                                   const std::vector<std::size_t>& sides) {
  std::vector<std::size_t> runs;
  for (std::size_t k = 0; k < sides.size(); ++k) {
    if (k == 0 || adjacency[sides[k]].side.piece != adjacency[sides[k - 1]].side.piece) runs.push_back(k);
  }
  runs.push_back(sides.size());
  return runs;
}

// The sides `own` of one piece as polylines, arcs of one field all at once.
void MakeStrands(const Surface& surface, const std::vector<SplitMesh>& meshes,
                 const std::vector<Adjacency>& adjacency, const std::vector<std::size_t>& on_border,
                 const std::vector<std::size_t>& own, std::span<const ZeroField> fields, double tolerance,
                 std::vector<std::vector<Vec3>>& strand) {
  if (own.empty()) return;
  const auto index = static_cast<std::size_t>(adjacency[on_border[own.front()]].side.piece);
  const SplitMesh& mesh = meshes[index];
  const Piece& piece = surface.pieces[index];
  std::vector<std::vector<std::size_t>> along(fields.size());  // their field
  for (const std::size_t k : own) {
    const ZeroVertex &a = End(mesh, adjacency[on_border[k]].side, 0),
                     &b = End(mesh, adjacency[on_border[k]].side, 1);
    strand[k] = {a.p, b.p};
    if (const ZeroField* field = CommonField(a, b, fields))
      along[static_cast<std::size_t>(field - fields.data())].push_back(k);
  }
  for (std::size_t f = 0; f < fields.size(); ++f) {
    std::vector<ZeroSegment> chords;
    for (const std::size_t k : along[f]) {
      const ZeroVertex &a = End(mesh, adjacency[on_border[k]].side, 0),
                       &b = End(mesh, adjacency[on_border[k]].side, 1);
      chords.push_back({{a.u, a.v}, {b.u, b.v}});
    }
    const std::vector<std::vector<Vec2>> arcs = RefineZeroArcs(piece, fields[f], chords, tolerance);
    for (std::size_t i = 0; i < arcs.size(); ++i) {
      std::vector<Vec3> points;
      for (const Vec2& q : arcs[i]) points.push_back(Position(piece, q.x(), q.y()));
      std::vector<Vec3>& line = strand[along[f][i]];
      line.insert(line.end() - 1, points.begin(), points.end());
    }
  }
}

// Directed strands of one region's outline -> closed loops. Strands are matched end to start exactly first,
// then to the nearest.
std::vector<std::vector<Vec3>> Chain(std::vector<std::vector<Vec3>> strands, double weld) {
  std::vector<std::vector<Vec3>> loops;
  // Starts sorted by x, so that an end finds the starts near it without looking at all.
  std::vector<std::size_t> by_x(strands.size());
  for (std::size_t i = 0; i < by_x.size(); ++i) by_x[i] = i;
  std::sort(by_x.begin(), by_x.end(), [&](std::size_t i, std::size_t j) {
    return std::make_pair(strands[i].front().x(), i) < std::make_pair(strands[j].front().x(), j);
  });
  std::vector<bool> used(strands.size(), false);
  const auto follow = [&](const Vec3& end) {
    const auto first = std::lower_bound(by_x.begin(), by_x.end(), end.x() - weld,
                                        [&](std::size_t i, double x) { return strands[i].front().x() < x; });
    std::size_t best = strands.size();
    double nearest = weld;
    for (auto it = first; it != by_x.end() && strands[*it].front().x() <= end.x() + weld; ++it) {
      const double d = (strands[*it].front() - end).norm();
      if (!used[*it] && d <= nearest) {
        nearest = d;
        best = *it;
      }
    }
    return best;
  };
  std::vector<std::vector<Vec3>> open;
  for (std::size_t i = 0; i < strands.size(); ++i) {
    if (used[i]) continue;
    used[i] = true;
    std::vector<Vec3> loop = strands[i];
    for (std::size_t next = follow(loop.back()); next != strands.size(); next = follow(loop.back())) {
      used[next] = true;
      loop.insert(loop.end(), strands[next].begin() + 1, strands[next].end());
      if ((loop.back() - loop.front()).norm() <= weld) break;
    }
    if ((loop.back() - loop.front()).norm() <= weld) {
      loop.pop_back();
      if (loop.size() > 2) loops.push_back(std::move(loop));
    } else {
      open.push_back(std::move(loop));
    }
  }
  // What is left open: join each end to the nearest open start until the loop's own start is nearest.
  std::vector<bool> taken(open.size(), false);
  for (std::size_t i = 0; i < open.size(); ++i) {
    if (taken[i]) continue;
    taken[i] = true;
    std::vector<Vec3> loop = open[i];
    while (true) {
      double nearest = (loop.front() - loop.back()).norm();
      std::size_t best = open.size();
      for (std::size_t j = i + 1; j < open.size(); ++j) {
        const double d = (open[j].front() - loop.back()).norm();
        if (!taken[j] && d < nearest) {
          nearest = d;
          best = j;
        }
      }
      if (best == open.size()) break;
      taken[best] = true;
      loop.insert(loop.end(), open[best].begin(), open[best].end());
    }
    if (loop.size() > 2) loops.push_back(std::move(loop));
  }
  return loops;
}

}  // namespace

absl::StatusOr<std::vector<std::vector<std::vector<Vec3>>>> RegionBorders(
    const Surface& surface, const std::vector<SplitMesh>& meshes, const std::vector<Adjacency>& adjacency,
    const std::vector<std::vector<int>>& region_of, std::size_t region_count,
    std::span<const ZeroField> fields, double tolerance, const RunContext& run) {
  const auto region = [&](int piece, int triangle) {
    return piece < 0 ? -1 : region_of[static_cast<std::size_t>(piece)][static_cast<std::size_t>(triangle)];
  };
  std::vector<std::size_t> on_border;
  for (std::size_t i = 0; i < adjacency.size(); ++i) {
    const Adjacency& a = adjacency[i];
    const int own = region(a.side.piece, a.side.triangle);
    if (own >= 0 && own != region(a.other_piece, a.other_triangle)) on_border.push_back(i);
  }
  const std::vector<std::size_t> first = FirstAlongEdge(meshes, adjacency, on_border);
  std::vector<std::vector<Vec3>> strand(on_border.size());
  const std::vector<std::size_t> runs = PieceRuns(adjacency, on_border);
  PM_RETURN_IF_ERROR(ParallelFor(run, "regions: borders", runs.size() - 1, [&](std::size_t r) {
    std::vector<std::size_t> own;
    for (std::size_t k = runs[r]; k < runs[r + 1]; ++k) {
      if (first[k] == k) own.push_back(k);
    }
    MakeStrands(surface, meshes, adjacency, on_border, own, fields, tolerance, strand);
  }));
  for (std::size_t k = 0; k < on_border.size(); ++k) {
    if (first[k] != k) strand[k].assign(strand[first[k]].rbegin(), strand[first[k]].rend());
  }
  std::vector<std::vector<std::vector<Vec3>>> strands(region_count);
  for (std::size_t k = 0; k < on_border.size(); ++k) {
    const Adjacency& a = adjacency[on_border[k]];
    if ((strand[k].back() - strand[k].front()).norm() > 0.0 || strand[k].size() > 2)
      strands[static_cast<std::size_t>(region(a.side.piece, a.side.triangle))].push_back(
          std::move(strand[k]));
  }
  const double weld = std::max(2.0 * surface.network.join_tolerance, 1e-7);
  std::vector<std::vector<std::vector<Vec3>>> borders(region_count);
  PM_RETURN_IF_ERROR(ParallelFor(run, nullptr, region_count,
                                 [&](std::size_t i) { borders[i] = Chain(std::move(strands[i]), weld); }));
  return borders;
}

double LensArea(const Surface& surface, const SplitMesh& mesh, const TriangleSide& side,
                std::span<const ZeroField> fields, double tolerance) {
  const ZeroVertex &a = End(mesh, side, 0), &b = End(mesh, side, 1);
  const ZeroField* field = CommonField(a, b, fields);
  if (field == nullptr || !field->smooth) return 0.0;
  const Piece& piece = surface.pieces[static_cast<std::size_t>(side.piece)];
  const Vec2 from(a.u, a.v), to(b.u, b.v);
  std::vector<Vec2> arc = ArcOf(piece, field, a, b, tolerance);
  if (arc.empty()) return 0.0;
  arc.push_back(to);
  // The triangle lies on the left of its side (counter-clockwise): an arc to the right adds to it, and turns
  // counter-clockwise around the side's start.
  double area = 0.0;
  for (std::size_t i = 0; i + 1 < arc.size(); ++i) area += SurfaceArea(piece, from, arc[i], arc[i + 1]);
  return area;
}

}  // namespace patchmill
