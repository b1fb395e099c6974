#include "core/lines/zero_mesh.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <absl/container/flat_hash_map.h>

#include "core/lines/fan_middle.h"
#include "core/lines/limit_on_curve.h"
#include "core/lines/zero_cells.h"
#include "core/lines/zero_root.h"

namespace patchmill {
namespace {

std::uint64_t EdgeKey(int a, int b) {
  return (static_cast<std::uint64_t>(std::min(a, b)) << 32) | static_cast<std::uint32_t>(std::max(a, b));
}

// The triangles of one piece: fans of the cells, cut along one field after the other.
class Builder {
 public:
  Builder(const Piece& piece, std::span<const ZeroField> fields, const ZeroMeshParams& params)
      : piece_(piece), fields_(fields), run_(params.run), vertices_(piece, fields, params.run) {
    cells_ = DivideForFields(piece, fields, params, vertices_);
  }

  ZeroMesh Build() {
    for (const ZeroCell& cell : cells_.cells) Fan(cell);
    for (std::size_t k = 0; k < fields_.size(); ++k) Cut(k);
    for (ZeroTriangle& t : triangles_) Label(t);
    return {vertices_.Take(), std::move(triangles_)};
  }

 private:
  // Appends the vertices strictly between two corners of a cell on one of its sides, in order: corners of
  // finer neighbours, and nodes.
  void Between(int i0, int j0, int i1, int j1, std::vector<int>& ring) {
    const int length = std::abs(i1 - i0) + std::abs(j1 - j0);
    const Vec2 from = Vec2(i0, j0) / kZeroGrid, along = Vec2(i1 - i0, j1 - j0) / kZeroGrid;
    std::vector<std::pair<double, int>> found;  // share of the side, id
    for (int s = 1; s < length; ++s) {
      const int gi = i0 + (i1 - i0) * s / length, gj = j0 + (j1 - j0) * s / length;
      if (cells_.corners[static_cast<std::size_t>(gi * (kZeroGrid + 1) + gj)])
        found.emplace_back(static_cast<double>(s) / length, vertices_.OnGrid(gi, gj));
    }
    for (const int id : cells_.on_sides) {
      const Vec2 to = Vec2(vertices_[id].u, vertices_[id].v) - from;
      const double t = to.dot(along) / along.squaredNorm();
      if (Cross(along, to) == 0.0 && t > 0.0 && t < 1.0) found.emplace_back(t, id);
    }
    std::sort(found.begin(), found.end());
    for (const auto& [t, id] : found) ring.push_back(id);
  }

  int Middle(const ZeroCell& cell, const std::vector<int>& ring) {
    if (cell.node) return *cell.node;
    const int step = kZeroGrid >> cell.level;
    const Vec2 low = Vec2(cell.i, cell.j) * step / kZeroGrid;
    const double side = static_cast<double>(step) / kZeroGrid;
    if (!cell.settled) {
      if (const auto place = BetterMiddle(vertices_, fields_, ring, low, side)) return vertices_.Add(*place);
    }
    if (step >= 2) return vertices_.OnGrid(cell.i * step + step / 2, cell.j * step + step / 2);
    return vertices_.Add(low + Vec2::Constant(0.5 * side));
  }

  // True if the middle lies on the side a b of the cell. Sides run along the axes.
  bool InLine(int middle, int a, int b) const {
    const ZeroVertex &m = vertices_[middle], &x = vertices_[a], &y = vertices_[b];
    return (m.u == x.u && m.u == y.u) || (m.v == x.v && m.v == y.v);
  }

  void Fan(const ZeroCell& cell) {
    const int step = kZeroGrid >> cell.level;
    const int i0 = cell.i * step, j0 = cell.j * step, i1 = i0 + step, j1 = j0 + step;
    const int corner[4][2] = {{i0, j0}, {i1, j0}, {i1, j1}, {i0, j1}};
    std::vector<int> ring;
    for (int k = 0; k < 4; ++k) {
      const auto& a = corner[k];
      const auto& b = corner[(k + 1) % 4];
      ring.push_back(vertices_.OnGrid(a[0], a[1]));
      Between(a[0], a[1], b[0], b[1], ring);
    }
    if (ring.size() == 4 && cell.settled && !cell.node) {
      triangles_.push_back({{ring[0], ring[1], ring[2]}, {}});
      triangles_.push_back({{ring[0], ring[2], ring[3]}, {}});
      return;
    }
    const int middle = Middle(cell, ring);
    for (std::size_t k = 0; k < ring.size(); ++k) {
      const int a = ring[k], b = ring[(k + 1) % ring.size()];
      if (!InLine(middle, a, b)) triangles_.push_back({{middle, a, b}, {}});
    }
  }

  // True if field k counts on a triangle. The curves of the field `where` must be cut out already.
  bool Counts(const ZeroTriangle& t, std::size_t k) {
    const int where = fields_[k].where;
    if (where < 0) return true;
    for (const int id : t.vertex) {
      if (const int sign = vertices_.Sign(id, static_cast<std::size_t>(where)); sign != 0)
        return sign == fields_[k].where_sign;
    }
    return true;
  }

  struct Edge {
    int a, b;  // a < b
    ZeroBracket bracket;
  };
  Vec2 At(const Edge& e, double t) const {
    const ZeroVertex &x = vertices_[e.a], &y = vertices_[e.b];
    return Vec2(x.u, x.v) + t * (Vec2(y.u, y.v) - Vec2(x.u, x.v));
  }

  // Finds the vertices where field k changes sign on an edge. Both triangles of an edge share one vertex.
  void FindCrossings(std::size_t k) {
    crossings_.clear();
    const bool by_sign = !fields_[k].smooth;
    std::vector<Edge> edges;
    for (const ZeroTriangle& t : triangles_) {
      if (!Counts(t, k)) continue;
      for (std::size_t s = 0; s < 3; ++s) {
        const int a = std::min(t.vertex[s], t.vertex[(s + 1) % 3]),
                  b = std::max(t.vertex[s], t.vertex[(s + 1) % 3]);
        const int sa = vertices_.Sign(a, k), sb = vertices_.Sign(b, k);
        if (sa * sb >= 0 || !crossings_.try_emplace(EdgeKey(a, b), -1).second) continue;
        edges.push_back(
            {a, b,
             ZeroBracket(sa, sb, EnoughFor(fields_[k], (vertices_[b].p - vertices_[a].p).norm()), by_sign)});
      }
    }
    if (fields_[k].limits) {
      std::vector<ZeroSegment> segments;
      for (const Edge& e : edges) {
        const bool forth = vertices_.Sign(e.a, k) < 0;
        segments.push_back({At(e, forth ? 0.0 : 1.0), At(e, forth ? 1.0 : 0.0)});
      }
      std::vector<double> limits(edges.size());
      fields_[k].limits(piece_, segments, limits);
      for (std::size_t i = 0; i < edges.size(); ++i) {
        const double t = vertices_.Sign(edges[i].a, k) < 0 ? limits[i] : 1.0 - limits[i];
        crossings_[EdgeKey(edges[i].a, edges[i].b)] = AddCrossing(k, edges[i], t);
      }
      return;
    }
    const auto many = [&](std::size_t count, const auto& place) {
      std::vector<Vec2> places;
      for (std::size_t i = 0; i < count; ++i) places.push_back(place(i));
      return vertices_.Values(places, k);
    };
    if (fields_[k].smooth) {  // values at the ends, for better first steps
      const auto low = many(edges.size(), [&](std::size_t i) { return At(edges[i], 0.0); });
      const auto high = many(edges.size(), [&](std::size_t i) { return At(edges[i], 1.0); });
      for (std::size_t i = 0; i < edges.size(); ++i)
        edges[i].bracket = ZeroBracket(low[i], high[i], EnoughFor(fields_[k], 1.0), false);
    }
    for (std::vector<std::size_t> open;;) {
      open.clear();
      for (std::size_t i = 0; i < edges.size(); ++i) {
        if (edges[i].bracket.Open()) open.push_back(i);
      }
      if (open.empty() || (run_ != nullptr && run_->Cancelled())) break;
      const auto values =
          many(open.size(), [&](std::size_t i) { return At(edges[open[i]], edges[open[i]].bracket.Next()); });
      for (std::size_t i = 0; i < open.size(); ++i) edges[open[i]].bracket.Put(values[i]);
    }
    for (const Edge& e : edges) crossings_[EdgeKey(e.a, e.b)] = AddCrossing(k, e, e.bracket.Middle());
  }

  int AddCrossing(std::size_t k, const Edge& e, double t) {
    const ZeroVertex x = vertices_[e.a], y = vertices_[e.b];
    const Vec2 from(x.u, x.v), to(y.u, y.v);
    Vec2 q = from + t * (to - from);
    // The edge lies along another field's curve: the crossing is where both fields vanish.
    const ZeroFieldBits both = x.on & y.on;
    for (std::size_t other = 0; other < k; ++other) {
      if (((both >> other) & 1u) == 0) continue;
      if (const auto common = CommonPlace(k, other, q, 0.5 * (to - from).norm())) {
        q = *common;
        break;
      }
    }
    for (int c = 0; c < 2; ++c) {  // a point of the piece's border stays on it
      if (from[c] == to[c] && (from[c] == 0.0 || from[c] == 1.0)) q[c] = from[c];
    }
    const int id = vertices_.Add(q);
    vertices_.PutOn(id, k);
    // With respect to fields that were cut before, the edge lies on one side of their curves or on them.
    // Where they do not count, the sign does not matter.
    for (std::size_t other = 0; other < k; ++other) {
      if ((both >> other) & 1u) {
        vertices_.PutOn(id, other);
      } else {
        vertices_.SetSign(id, other, x.sign[other] != 0 ? x.sign[other] : y.sign[other]);
      }
    }
    return id;
  }

  // The place near q where two fields change sign.
  std::optional<Vec2> CommonPlace(std::size_t k, std::size_t other, const Vec2& q, double reach) const {
    const ZeroField &a = fields_[k], &b = fields_[other];
    if (a.smooth && b.smooth) return CommonZero(k, other, q, reach);
    // Limits may bend within a cell, but chords deviate from them by less than their length.
    if (a.smooth && b.limits) return LimitOnCurve(a, b, piece_, q, 2.0 * reach);
    if (b.smooth && a.limits) return LimitOnCurve(b, a, piece_, q, 2.0 * reach);
    return std::nullopt;
  }

  // Newton's method on two fields from q, with differences. nullopt if it leaves the piece or the
  // neighbourhood.
  std::optional<Vec2> CommonZero(std::size_t k, std::size_t other, Vec2 q, double reach) const {
    constexpr double kStep = 1e-6, kDone = 1e-12;
    const Vec2 start = q;
    for (int i = 0; i < 8; ++i) {
      Vec2 gradient[2];
      double at[2];
      const std::size_t pair[2] = {k, other};
      for (int f = 0; f < 2; ++f) {
        const ZeroField& field = fields_[pair[f]];
        at[f] = Value(field, piece_, q);
        const double hu = q.x() < 0.5 ? kStep : -kStep, hv = q.y() < 0.5 ? kStep : -kStep;
        gradient[f] = {(Value(field, piece_, q + Vec2(hu, 0)) - at[f]) / hu,
                       (Value(field, piece_, q + Vec2(0, hv)) - at[f]) / hv};
      }
      const double det = Cross(gradient[0], gradient[1]);
      if (!(std::abs(det) > 0.0)) return std::nullopt;
      const Vec2 step((at[0] * gradient[1].y() - at[1] * gradient[0].y()) / det,
                      (gradient[0].x() * at[1] - gradient[1].x() * at[0]) / det);
      q -= step;
      if (!((q - start).norm() <= reach) || q.minCoeff() < 0.0 || q.maxCoeff() > 1.0) return std::nullopt;
      if (step.norm() < kDone) return q;
    }
    return std::nullopt;
  }

  void Cut(std::size_t k) {
    std::vector<int> corners;
    for (const ZeroTriangle& t : triangles_) corners.insert(corners.end(), t.vertex.begin(), t.vertex.end());
    vertices_.Ask(corners, k);
    FindCrossings(k);
    const auto crossing = [&](int a, int b) { return crossings_.at(EdgeKey(a, b)); };
    // A triangle on which the field does not count is divided only to match a neighbour on which it does.
    const auto keep = [&](ZeroTriangle t, const auto& self) -> void {
      for (std::size_t s = 0; s < 3; ++s) {
        const int a = t.vertex[s], b = t.vertex[(s + 1) % 3], c = t.vertex[(s + 2) % 3];
        const auto found = crossings_.find(EdgeKey(a, b));
        if (found == crossings_.end()) continue;
        self({{a, found->second, c}, {}}, self);
        self({{found->second, b, c}, {}}, self);
        return;
      }
      triangles_.push_back(t);
    };
    std::vector<ZeroTriangle> whole = std::move(triangles_);
    triangles_.clear();
    triangles_.reserve(whole.size() + whole.size() / 4);
    for (const ZeroTriangle& t : whole) {
      if (!Counts(t, k)) {
        keep(t, keep);
        continue;
      }
      const int sign[3] = {vertices_.Sign(t.vertex[0], k), vertices_.Sign(t.vertex[1], k),
                           vertices_.Sign(t.vertex[2], k)};
      // Turn the triangle so that corner 0 is alone on its side, or is the vertex on the curve.
      int odd = -1;
      for (int c = 0; c < 3 && odd < 0; ++c) {
        const int s0 = sign[c], s1 = sign[(c + 1) % 3], s2 = sign[(c + 2) % 3];
        if ((s0 * s1 < 0 && s0 * s2 < 0) || (s0 == 0 && s1 * s2 < 0)) odd = c;
      }
      if (odd < 0) {
        triangles_.push_back(t);
        continue;
      }
      const auto corner = [&](int c) { return t.vertex[static_cast<std::size_t>((odd + c) % 3)]; };
      const int a = corner(0), b = corner(1), c = corner(2);
      if (sign[odd] == 0) {
        const int m = crossing(b, c);
        triangles_.push_back({{a, b, m}, {}});
        triangles_.push_back({{a, m, c}, {}});
        // The curve leaves the triangle through this vertex, so the vertex lies on it as far as rounding can
        // show.
        vertices_[a].on |= static_cast<ZeroFieldBits>(1u << k);
        continue;
      }
      const int m = crossing(a, b), n = crossing(a, c);
      triangles_.push_back({{a, m, n}, {}});
      triangles_.push_back({{m, b, c}, {}});
      triangles_.push_back({{m, c, n}, {}});
    }
  }

  // The sign of each field on a triangle: that of a vertex off the field's curve, else that of the centroid.
  void Label(ZeroTriangle& t) {
    for (std::size_t k = 0; k < fields_.size(); ++k) {
      const int where = fields_[k].where;
      if (where >= 0 && t.sign[static_cast<std::size_t>(where)] != fields_[k].where_sign) continue;
      for (const int id : t.vertex) {
        if (((vertices_[id].on >> k) & 1u) == 0 && t.sign[k] == 0)
          t.sign[k] = static_cast<std::int8_t>(vertices_.Sign(id, k));
      }
      if (t.sign[k] != 0) continue;
      const ZeroVertex &a = vertices_[t.vertex[0]], &b = vertices_[t.vertex[1]], &c = vertices_[t.vertex[2]];
      t.sign[k] =
          vertices_.SignOf(k, Value(fields_[k], piece_, {(a.u + b.u + c.u) / 3.0, (a.v + b.v + c.v) / 3.0}));
    }
  }

  const Piece& piece_;
  std::span<const ZeroField> fields_;
  const RunContext* run_;
  ZeroVertices vertices_;
  ZeroCells cells_;
  std::vector<ZeroTriangle> triangles_;
  absl::flat_hash_map<std::uint64_t, int> crossings_;  // of one field; looked up, never iterated
};

}  // namespace

ZeroMesh BuildZeroMesh(const Piece& piece, std::span<const ZeroField> fields, const ZeroMeshParams& params) {
  return Builder(piece, fields, params).Build();
}

}  // namespace patchmill
