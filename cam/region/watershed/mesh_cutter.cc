#include "cam/region/watershed/mesh_cutter.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/segment.h"
#include "core/base/status.h"

namespace patchmill {
namespace {

// Where the segment p q crosses a b, as a share of p q and of a b.
struct Crossing {
  double along = 0.0, on_edge = 0.0;
};
std::optional<Crossing> Cross(const Vec2& p, const Vec2& q, const Vec2& a, const Vec2& b) {
  constexpr double kSlack = 1e-9;  // share by which a crossing may lie beyond an end
  const Vec2 d = q - p, e = b - a;
  const double w = patchmill::Cross(d, e);
  if (w == 0.0) return std::nullopt;
  const Crossing c{patchmill::Cross(a - p, e) / w, patchmill::Cross(a - p, d) / w};
  if (c.along < -kSlack || c.along > 1.0 + kSlack || c.on_edge < -kSlack || c.on_edge > 1.0 + kSlack)
    return std::nullopt;
  return c;
}

double Foot(const Vec2& p, const Vec2& a, const Vec2& b) {
  return SegmentFoot({p.x(), p.y(), 0}, {a.x(), a.y(), 0}, {b.x(), b.y(), 0});
}

// The point of a polyline nearest to p (all in parameters), and the index of the vertex before it.
std::pair<Vec2, std::size_t> NearestOn(const std::vector<Vec2>& line, const Vec2& p) {
  std::pair<Vec2, std::size_t> best{line.front(), 0};
  for (std::size_t k = 0; k + 1 < line.size(); ++k) {
    const Vec2 q = line[k] + Foot(p, line[k], line[k + 1]) * (line[k + 1] - line[k]);
    if ((q - p).squaredNorm() < (best.first - p).squaredNorm()) best = {q, k};
  }
  return best;
}

}  // namespace

MeshCutter::MeshCutter(const Piece& piece, SplitMesh& mesh, bool summits, std::span<const ZeroField> fields,
                       double snap)
    : piece_(piece),
      mesh_(mesh),
      summits_(summits),
      fields_(fields),
      snap_(snap),
      fans_(mesh.triangles, mesh.vertices.size()),
      on_line_(mesh.vertices.size(), false),
      cut_(mesh.triangles.size(), false) {
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& v = mesh.triangles[t].vertex;
    const auto at = [&](std::size_t k) -> const ZeroVertex& {
      return mesh.vertices[static_cast<std::size_t>(v[k % 3])];
    };
    if (AlongBorder(at(0), at(1)) || AlongBorder(at(1), at(2)) || AlongBorder(at(2), at(0)))
      rim_.push_back(static_cast<int>(t));
  }
}

Vec2 MeshCutter::Place(int vertex) const {
  const ZeroVertex& v = mesh_.vertices[static_cast<std::size_t>(vertex)];
  return {v.u, v.v};
}

std::vector<int> MeshCutter::Around(int at) const {
  std::vector<int> found;
  fans_.ForEach(at, [&](int t) {
    for (const int vertex : mesh_.triangles[static_cast<std::size_t>(t)].vertex) {
      if (vertex != at && std::find(found.begin(), found.end(), vertex) == found.end())
        found.push_back(vertex);
    }
  });
  return found;
}

void MeshCutter::Mark(int at, int to, std::vector<Vec2> between) {
  if (at > to) std::reverse(between.begin(), between.end());
  SplitMesh::Line& line = mesh_.lines[std::minmax(at, to)];
  if (!line.summits && !line.pits) line.places = std::move(between);
  (summits_ ? line.summits : line.pits) = true;
  on_line_[static_cast<std::size_t>(at)] = on_line_[static_cast<std::size_t>(to)] = true;
}

// Makes a new vertex on the side a b near `at`. If the side is a chord of a field's curve or of a line, the
// vertex lies on that curve.
int MeshCutter::Split(int a, int b, const Vec2& at) {
  const ZeroVertex &from = mesh_.vertices[static_cast<std::size_t>(a)],
                   &to = mesh_.vertices[static_cast<std::size_t>(b)];
  ZeroVertex fresh;
  Vec2 q = at;
  fresh.on = from.on & to.on;
  for (std::size_t k = 0; k < fields_.size(); ++k) {
    if (((fresh.on >> k) & 1u) == 0 || !fields_[k].smooth) continue;
    std::vector<Vec2> arc{Place(a)};
    const std::vector<Vec2> inner = RefineZeroArc(piece_, fields_[k], Place(a), Place(b), snap_);
    arc.insert(arc.end(), inner.begin(), inner.end());
    arc.push_back(Place(b));
    q = NearestOn(arc, at).first;
    break;
  }
  const auto line = mesh_.lines.find(std::minmax(a, b));
  std::pair<std::vector<Vec2>, std::vector<Vec2>> halves;  // of the line along the side, from min(a, b)
  if (line != mesh_.lines.end()) {
    std::vector<Vec2> all{Place(std::min(a, b))};
    all.insert(all.end(), line->second.places.begin(), line->second.places.end());
    all.push_back(Place(std::max(a, b)));
    const auto [nearest, before] = NearestOn(all, at);
    q = nearest;
    halves.first.assign(all.begin() + 1, all.begin() + static_cast<std::ptrdiff_t>(before) + 1);
    halves.second.assign(all.begin() + static_cast<std::ptrdiff_t>(before) + 1, all.end() - 1);
  }
  for (int c = 0; c < 2; ++c) {  // a vertex on the piece's border stays there exactly
    const double border = Place(a)[c];
    if (border == Place(b)[c] && (border == 0.0 || border == 1.0)) q[c] = border;
  }
  fresh.u = q.x();
  fresh.v = q.y();
  fresh.p = Position(piece_, q.x(), q.y());
  const int vertex = static_cast<int>(mesh_.vertices.size());
  mesh_.vertices.push_back(fresh);
  fans_.AddVertex();
  on_line_.push_back(false);
  // The fan of a stays as it is: each triangle keeps its corner at a, and a new triangle is the half at b.
  fans_.ForEach(a, [&](int t) {
    SplitTriangle& old = mesh_.triangles[static_cast<std::size_t>(t)];
    const auto corner = [&](int v) { return std::find(old.vertex.begin(), old.vertex.end(), v); };
    if (corner(b) == old.vertex.end()) return;
    const int of_a = static_cast<int>(corner(a) - old.vertex.begin()),
              of_b = static_cast<int>(corner(b) - old.vertex.begin()), of_third = 3 - of_a - of_b;
    const int added = static_cast<int>(mesh_.triangles.size());
    SplitTriangle half = old;
    half.vertex[static_cast<std::size_t>(of_a)] = vertex;
    *corner(b) = vertex;
    fans_.AddTriangle();
    fans_.Replace(b, 3 * t + of_b, 3 * added + of_b);
    fans_.Append(half.vertex[static_cast<std::size_t>(of_third)], 3 * added + of_third);
    fans_.Append(vertex, 3 * t + of_b);
    fans_.Append(vertex, 3 * added + of_a);
    mesh_.triangles.push_back(half);
    cut_[static_cast<std::size_t>(t)] = true;
    cut_.push_back(true);
    if (std::binary_search(rim_.begin(), rim_.end(), t)) rim_.push_back(added);
  });
  if (line != mesh_.lines.end()) {
    const SplitMesh::Line old = std::move(line->second);
    mesh_.lines.erase(line);
    // The new vertex has the highest number, so the places of both halves run towards it.
    std::reverse(halves.second.begin(), halves.second.end());
    mesh_.lines[{std::min(a, b), vertex}] = {std::move(halves.first), old.summits, old.pits};
    mesh_.lines[{std::max(a, b), vertex}] = {std::move(halves.second), old.summits, old.pits};
    on_line_.back() = summits_ ? old.summits : old.pits;
  }
  return vertex;
}

int MeshCutter::VertexAt(int a, int b, const Vec2& at) {
  const Vec3 p = Position(piece_, at.x(), at.y());
  const double to_a = (p - mesh_.vertices[static_cast<std::size_t>(a)].p).norm(),
               to_b = (p - mesh_.vertices[static_cast<std::size_t>(b)].p).norm();
  if (std::min(to_a, to_b) <= snap_) return to_a <= to_b ? a : b;
  return Split(a, b, at);
}

std::optional<int> MeshCutter::OnBorder(const Vec3& p, double reach) {
  double nearest = reach;
  struct Found {
    int a, b;
    Vec2 at;
  };
  std::optional<Found> best;
  for (const int t : rim_) {
    const auto& v = mesh_.triangles[static_cast<std::size_t>(t)].vertex;
    for (std::size_t k = 0; k < 3; ++k) {
      const int a = v[k], b = v[(k + 1) % 3];
      const ZeroVertex &va = mesh_.vertices[static_cast<std::size_t>(a)],
                       &vb = mesh_.vertices[static_cast<std::size_t>(b)];
      if (!AlongBorder(va, vb)) continue;
      const Vec2 from(va.u, va.v), along = Vec2(vb.u, vb.v) - from;
      const Vec3 &pa = va.p, &pb = vb.p;
      // No side is taken to deviate from its chord by more than the length of the chord.
      if (SegmentDistance(p, pa, pb) > nearest + (pb - pa).norm()) continue;
      double share = SegmentFoot(p, pa, pb);
      for (int step = 0; step < 4; ++step) {
        const SurfaceJet jet = Evaluate(piece_, from.x() + share * along.x(), from.y() + share * along.y());
        const Vec3 tangent = along.x() * jet.du + along.y() * jet.dv;
        if (!(tangent.squaredNorm() > 0.0)) break;
        share = std::clamp(share + (p - jet.p).dot(tangent) / tangent.squaredNorm(), 0.0, 1.0);
      }
      const Vec2 at = from + share * along;
      const double d = (Position(piece_, at.x(), at.y()) - p).norm();
      if (d > nearest || (best && d == nearest)) continue;
      nearest = d;
      best = {a, b, at};
    }
  }
  if (!best) return std::nullopt;
  return VertexAt(best->a, best->b, best->at);
}

std::optional<MeshCutter::Next> MeshCutter::Advance(int at, std::vector<Vec2>& places, std::size_t& known) {
  Vec2 from = known > 0 ? places[known - 1] : Place(at);
  for (std::size_t k = known; k < places.size(); ++k) {
    std::optional<Crossing> first;
    std::pair<int, int> side;
    fans_.ForEach(at, [&](int t) {
      const auto& v = mesh_.triangles[static_cast<std::size_t>(t)].vertex;
      const auto own = static_cast<std::size_t>(std::find(v.begin(), v.end(), at) - v.begin());
      const int a = v[(own + 1) % 3], b = v[(own + 2) % 3];
      const auto crossing = Cross(from, places[k], Place(a), Place(b));
      if (!crossing || (first && crossing->along >= first->along)) return;
      first = crossing;
      side = {a, b};
    });
    if (!first) {
      from = places[k];
      continue;
    }
    const Vec2 out = from + std::clamp(first->along, 0.0, 1.0) * (places[k] - from);
    const int next = VertexAt(side.first, side.second, out);
    const bool met = OnLine(next);
    Mark(at, next, {places.begin(), places.begin() + static_cast<std::ptrdiff_t>(k)});
    places.erase(places.begin(), places.begin() + static_cast<std::ptrdiff_t>(k));
    known = 0;
    return Next{next, met};
  }
  known = places.size();
  return std::nullopt;
}

void MeshCutter::Finish(double steep_angle) {
  for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
    if (cut_[t]) MeasureTriangle(piece_, mesh_.vertices, steep_angle, mesh_.triangles[t]);
  }
}

}  // namespace patchmill
