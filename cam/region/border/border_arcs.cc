#include "cam/region/border/border_arcs.h"

#include <algorithm>
#include <compare>
#include <utility>

#include "core/base/parallel.h"
#include "core/base/segment.h"
#include "core/base/status.h"

namespace patchmill {
namespace {

// The field on whose zero curve or limit both ends lie; a smooth one is preferred.
const ZeroField* CommonField(const ZeroVertex& a, const ZeroVertex& b, std::span<const ZeroField> fields) {
  const ZeroField* limit = nullptr;
  for (std::size_t k = 0; k < fields.size(); ++k) {
    if ((((a.on & b.on) >> k) & 1u) == 0) continue;
    if (fields[k].smooth) return &fields[k];
    if (limit == nullptr) limit = &fields[k];
  }
  return limit;
}

// A smooth field that is 0 at both ends, because the grid met its curve exactly.
const ZeroField* FieldWithoutSign(const ZeroVertex& a, const ZeroVertex& b,
                                  std::span<const ZeroField> fields) {
  for (std::size_t k = 0; k < fields.size(); ++k) {
    if (fields[k].smooth && a.sign[k] == 0 && b.sign[k] == 0) return &fields[k];
  }
  return nullptr;
}

// The places along a watershed if the side lies on one, else none.
std::vector<Vec2> LineAlong(const SplitMesh& mesh, const TriangleSide& side) {
  const int a = VertexOf(mesh, side, 0), b = VertexOf(mesh, side, 1);
  const auto line = mesh.lines.find(std::minmax(a, b));
  if (line == mesh.lines.end()) return {};
  const std::vector<Vec2>& places = line->second.places;
  return a < b ? places : std::vector<Vec2>(places.rbegin(), places.rend());
}

RegionId RegionOf(const PerTriangle<RegionId>& region_of, int piece, int triangle) {
  return region_of[static_cast<std::size_t>(piece)][static_cast<std::size_t>(triangle)];
}

// The border sides of one piece. `first` is, for each of them, the place of the first border side along the
// same edge: both triangles at an edge share one arc.
struct PieceBorders {
  std::vector<std::size_t> sides, first;
};
PieceBorders BordersOf(const SplitMesh& mesh, const AdjacencyList& adjacency, std::size_t piece,
                       const PerTriangle<RegionId>& region_of) {
  struct Edge {
    int low, high;
    std::size_t place;
    auto operator<=>(const Edge&) const = default;
  };
  PieceBorders borders{BorderSides(adjacency, piece, region_of), {}};
  std::vector<Edge> edges;
  for (const std::size_t i : borders.sides) {
    const TriangleSide side = adjacency[i].side;
    const auto [low, high] = std::minmax({VertexOf(mesh, side, 0), VertexOf(mesh, side, 1)});
    edges.push_back({low, high, edges.size()});
  }
  std::sort(edges.begin(), edges.end());
  borders.first.resize(edges.size());
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const Edge &edge = edges[i], &before = edges[i > 0 ? i - 1 : 0];
    const bool again = i > 0 && edge.low == before.low && edge.high == before.high;
    borders.first[edge.place] = again ? borders.first[before.place] : edge.place;
  }
  return borders;
}

// Finds the arcs of some sides of one piece, in the order of the sides. Sides of one field are refined
// together. The arc of a straight side has no places.
std::vector<std::vector<Vec2>> ArcsAlong(const SplitSurface& split, std::span<const TriangleSide> sides,
                                         std::span<const ZeroField> fields, double tolerance) {
  std::vector<std::vector<Vec2>> arcs(sides.size());
  if (sides.empty()) return arcs;
  const auto index = static_cast<std::size_t>(sides.front().piece);
  const SplitMesh& mesh = split.meshes[index];
  std::vector<std::vector<std::size_t>> along(fields.size());  // [field]: sides along it
  std::vector<std::vector<ZeroSegment>> chords(fields.size());
  for (std::size_t i = 0; i < sides.size(); ++i) {
    const ZeroVertex &a = EndOf(mesh, sides[i], 0), &b = EndOf(mesh, sides[i], 1);
    const ZeroField* field = CommonField(a, b, fields);
    if (field == nullptr) {
      arcs[i] = LineAlong(mesh, sides[i]);
      if (arcs[i].empty()) field = FieldWithoutSign(a, b, fields);
    }
    if (field == nullptr) continue;
    const auto f = static_cast<std::size_t>(field - fields.data());
    along[f].push_back(i);
    chords[f].push_back({{a.u, a.v}, {b.u, b.v}});
  }
  for (std::size_t f = 0; f < fields.size(); ++f) {
    auto refined = RefineZeroArcs(split.surface->pieces[index], fields[f], chords[f], tolerance);
    for (std::size_t k = 0; k < refined.size(); ++k) arcs[along[f][k]] = std::move(refined[k]);
  }
  return arcs;
}

constexpr int kMostHalvings = 12;  // of one line that is straight in the parameters

// A point of the surface with its parameters.
struct BorderPlace {
  Vec2 uv;
  Vec3 p;
};

// Adds points of the surface along a line that is straight in the parameters, between a and b. Chords deviate
// by at most `tolerance` (mm).
class PointsBetween {
 public:
  PointsBetween(const Piece& piece, double tolerance) : piece_(piece), tolerance_(tolerance) {}

  void Add(const BorderPlace& a, const BorderPlace& b, int halvings, std::vector<Vec3>& out) const {
    if (halvings == 0 || (b.p - a.p).norm() <= tolerance_) return;
    const auto at = [&](double t) {
      const Vec2 q = (1.0 - t) * a.uv + t * b.uv;
      return Position(piece_, q.x(), q.y());
    };
    const BorderPlace middle{0.5 * (a.uv + b.uv), at(0.5)};
    const auto near = [&](const Vec3& p) { return SegmentDistance(p, a.p, b.p) <= tolerance_; };
    // The first chord is checked at three places, because a line with two bends may cross it in the middle.
    const bool first = halvings == kMostHalvings;
    if (near(middle.p) && (!first || (near(at(0.25)) && near(at(0.75))))) return;
    Add(a, middle, halvings - 1, out);
    out.push_back(middle.p);
    Add(middle, b, halvings - 1, out);
  }

 private:
  const Piece& piece_;
  const double tolerance_;
};

// Area between the chord of a side and its arc, mm^2. It is positive if the arc bulges out of the side's own
// triangle.
double LensArea(const Surface& surface, const SplitMesh& mesh, const TriangleSide& side,
                const std::vector<Vec2>& arc) {
  if (arc.empty()) return 0.0;
  const Piece& piece = surface.pieces[static_cast<std::size_t>(side.piece)];
  const ZeroVertex &a = EndOf(mesh, side, 0), &b = EndOf(mesh, side, 1);
  const Vec2 from(a.u, a.v), to(b.u, b.v);
  // The triangle lies on the left of its side (counter-clockwise). An arc to the right adds to it and runs
  // counter-clockwise around the start of the side.
  double area = 0.0;
  for (std::size_t i = 0; i < arc.size(); ++i)
    area += SurfaceArea(piece, from, arc[i], i + 1 < arc.size() ? arc[i + 1] : to);
  return area;
}

}  // namespace

absl::StatusOr<BorderArcs> FindBorderArcs(const SplitSurface& split, const PerTriangle<RegionId>& region_of,
                                          std::span<const ZeroField> fields, double tolerance,
                                          const RunContext& run) {
  const std::vector<SplitMesh>& meshes = split.meshes;
  std::vector<PieceBorders> pieces(meshes.size());
  PM_RETURN_IF_ERROR(ParallelFor(run, nullptr, meshes.size(), [&](std::size_t piece) {
    pieces[piece] = BordersOf(meshes[piece], split.adjacency, piece, region_of);
  }));
  // A stretch of the borders of one piece. A cancel is looked at between two of them.
  struct Stretch {
    std::size_t begin, end;
  };
  constexpr std::size_t kLongest = 256;  // borders in one stretch
  std::vector<Stretch> stretches;
  BorderArcs arcs;
  std::vector<std::size_t> first;
  for (std::size_t piece = 0; piece < meshes.size(); ++piece) {
    const std::size_t begin = arcs.sides.size(), end = begin + pieces[piece].sides.size();
    arcs.sides.insert(arcs.sides.end(), pieces[piece].sides.begin(), pieces[piece].sides.end());
    for (const std::size_t k : pieces[piece].first) first.push_back(begin + k);
    for (std::size_t k = begin; k < end; k += kLongest) stretches.push_back({k, std::min(end, k + kLongest)});
  }
  arcs.places.resize(arcs.sides.size());
  PM_RETURN_IF_ERROR(ParallelFor(run, "regions: borders", stretches.size(), [&](std::size_t r) {
    std::vector<std::size_t> own;
    std::vector<TriangleSide> sides;
    for (std::size_t k = stretches[r].begin; k < stretches[r].end; ++k) {
      if (first[k] != k) continue;
      own.push_back(k);
      sides.push_back(split.adjacency[arcs.sides[k]].side);
    }
    std::vector<std::vector<Vec2>> found = ArcsAlong(split, sides, fields, tolerance);
    for (std::size_t i = 0; i < own.size(); ++i) arcs.places[own[i]] = std::move(found[i]);
  }));
  for (std::size_t k = 0; k < arcs.sides.size(); ++k) {
    const std::vector<Vec2>& arc = arcs.places[first[k]];
    if (first[k] != k) arcs.places[k].assign(arc.rbegin(), arc.rend());
  }
  return arcs;
}

absl::StatusOr<BentBorders> BendAreas(const SplitSurface& split, const PerTriangle<RegionId>& region_of,
                                      const std::vector<double>& flat, BorderArcs arcs,
                                      const RunContext& run) {
  constexpr double kLeast = 0.01;  // of the area of the triangles; if less is left, the arcs cross each other
  struct Lens {
    TriangleSide side;
    std::size_t own = 0, other = 0;  // regions
    std::size_t arc = 0;
    double area = 0.0;
  };
  std::vector<Lens> lenses;  // each twice, once from either side
  for (std::size_t k = 0; k < arcs.sides.size(); ++k) {
    if (arcs.places[k].empty()) continue;
    const Adjacency a = split.adjacency[arcs.sides[k]];
    if (a.other_piece != a.side.piece) continue;
    lenses.push_back({a.side, RegionOf(region_of, a.side.piece, a.side.triangle).index(),
                      RegionOf(region_of, a.other_piece, a.other_triangle).index(), k});
  }
  PM_RETURN_IF_ERROR(ParallelFor(run, "regions: areas", lenses.size(), [&](std::size_t k) {
    Lens& lens = lenses[k];
    if (lens.own > lens.other) return;
    lens.area = LensArea(*split.surface, split.meshes[static_cast<std::size_t>(lens.side.piece)], lens.side,
                         arcs.places[lens.arc]);
  }));
  std::vector<double> gained;
  std::vector<bool> straight(flat.size(), false);
  for (bool again = true; again;) {  // a border that becomes straight may take area from the neighbour
    PM_RETURN_IF_ERROR(run.Check());
    gained.assign(flat.size(), 0.0);
    for (const Lens& lens : lenses) {
      if (straight[lens.own] || straight[lens.other]) continue;
      gained[lens.own] += lens.area;
      gained[lens.other] -= lens.area;
    }
    again = false;
    for (std::size_t r = 0; r < flat.size(); ++r) {
      if (straight[r] || flat[r] + gained[r] >= kLeast * flat[r]) continue;
      straight[r] = again = true;
    }
  }
  for (const Lens& lens : lenses) {
    if (straight[lens.own] || straight[lens.other]) arcs.places[lens.arc].clear();
  }
  return BentBorders{std::move(arcs), std::move(gained)};
}

absl::StatusOr<BorderPoints> FindBorderPoints(const SplitSurface& split, const BorderArcs& arcs,
                                              double tolerance, const RunContext& run) {
  BorderPoints border{arcs.sides, std::vector<std::vector<Vec3>>(arcs.sides.size())};
  PM_RETURN_IF_ERROR(ParallelFor(run, "regions: border points", arcs.sides.size(), [&](std::size_t k) {
    const TriangleSide side = split.adjacency[arcs.sides[k]].side;
    const auto index = static_cast<std::size_t>(side.piece);
    const Piece& piece = split.surface->pieces[index];
    const ZeroVertex &from = EndOf(split.meshes[index], side, 0), &to = EndOf(split.meshes[index], side, 1);
    const std::vector<Vec2>& arc = arcs.places[k];
    const PointsBetween between(piece, tolerance);
    std::vector<Vec3>& points = border.points[k];
    BorderPlace last{{from.u, from.v}, from.p};
    points.push_back(from.p);
    // If no curve was found, the line that is straight in the parameters follows the surface at least.
    const int halvings = arc.empty() ? kMostHalvings : kMostHalvings - 1;
    const auto go_on = [&](const BorderPlace& next) {
      between.Add(last, next, halvings, points);
      points.push_back(next.p);
      last = next;
    };
    for (const Vec2& q : arc) go_on({q, Position(piece, q.x(), q.y())});
    go_on({{to.u, to.v}, to.p});
  }));
  return border;
}

}  // namespace patchmill
