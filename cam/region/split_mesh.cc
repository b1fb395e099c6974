#include "cam/region/split_mesh.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <unordered_map>

#include "core/diffgeo/forms.h"

namespace patchmill {
namespace {

constexpr int kMaxLevel = 7;           // cells down to 1/128 of a piece
constexpr int kExtraLevels = 2;        // finer than the shape asks for where a border passes
constexpr double kMaxTurn = 0.35;      // rad, of the normal across a cell
constexpr int kGrid = 1 << kMaxLevel;  // vertices sit on this grid before any is cut in

int Sign(double x) { return x > kFieldNoise ? 1 : x < -kFieldNoise ? -1 : 0; }

// Builder of one piece's mesh; owns the vertices and the maps that make edges share them.
class Builder {
 public:
  Builder(const Piece& piece, const ReachTest& reach, const SplitMeshParams& params)
      : piece_(piece), reach_(reach), params_(params) {}

  SplitMesh Build() {
    const Levels levels = ChooseLevels();
    const int cells = 1 << levels.start;
    for (int i = 0; i < cells; ++i) {
      for (int j = 0; j < cells; ++j) Refine(levels.start, i, j, levels.finest);
    }
    for (const Cell& cell : cells_) Fan(cell);
    for (int k = 0; k < kFieldCount; ++k) Cut(static_cast<Field>(k));
    for (SplitTriangle& t : mesh_.triangles) Finish(t);
    return std::move(mesh_);
  }

 private:
  struct Cell {
    int level, i, j;
  };

  struct Levels {
    int start = 1, finest = 1;
  };
  Levels ChooseLevels() const {
    // Turn of the normal and length of the sides, seen on a 5 x 5 grid.
    constexpr int n = 4;
    double turn = 0.0, side = 0.0;
    Vec3 points[n + 1][n + 1];
    std::optional<Vec3> normals[n + 1][n + 1];
    for (int i = 0; i <= n; ++i) {
      for (int j = 0; j <= n; ++j) {
        const SurfaceJet jet = Evaluate(piece_, double(i) / n, double(j) / n);
        points[i][j] = jet.p;
        normals[i][j] = UnitNormal(jet);
      }
    }
    const auto compare = [&](int i, int j, int k, int l) {
      side = std::max(side, n * (points[i][j] - points[k][l]).norm());
      if (normals[i][j] && normals[k][l]) {
        turn = std::max(turn, n * std::acos(std::clamp(normals[i][j]->dot(*normals[k][l]), -1.0, 1.0)));
      }
    };
    for (int i = 0; i <= n; ++i) {
      for (int j = 0; j <= n; ++j) {
        if (i < n) compare(i, j, i + 1, j);
        if (j < n) compare(i, j, i, j + 1);
      }
    }
    const double cells = std::max({1.0, turn / kMaxTurn, side / params_.max_cell});
    const int fine_enough = std::clamp(
        static_cast<int>(std::floor(std::log2(std::max(2.0, side / params_.min_cell)))), 1, kMaxLevel);
    Levels levels;
    levels.start =
        std::min({static_cast<int>(std::ceil(std::log2(cells))), fine_enough, kMaxLevel - kExtraLevels});
    levels.start = std::max(levels.start, 1);
    levels.finest =
        std::clamp(levels.start + kExtraLevels, levels.start, std::max(levels.start, fine_enough));
    return levels;
  }

  int GridVertex(int gi, int gj) {
    const int key = gi * (kGrid + 1) + gj;
    const auto [it, fresh] = grid_.try_emplace(key, static_cast<int>(mesh_.vertices.size()));
    if (fresh) AddVertex(static_cast<double>(gi) / kGrid, static_cast<double>(gj) / kGrid);
    return it->second;
  }

  int AddVertex(double u, double v) {
    const FieldValues f = EvaluateFields(piece_, u, v, params_.cos_steep);
    SplitVertex vertex;
    vertex.u = u;
    vertex.v = v;
    vertex.p = f.p;
    for (int k = 0; k < 3; ++k)
      vertex.sign[static_cast<std::size_t>(k)] =
          static_cast<std::int8_t>(Sign(f.value[static_cast<std::size_t>(k)]));
    vertex.sign[3] = f.degenerate ? 0 : reach_.Reachable(piece_, u, v) ? 1 : -1;
    mesh_.vertices.push_back(vertex);
    return static_cast<int>(mesh_.vertices.size()) - 1;
  }

  bool BorderPasses(int level, int i, int j) {
    const int step = kGrid >> level;
    int seen[kFieldCount][2] = {};
    for (int a = 0; a <= 2; ++a) {
      for (int b = 0; b <= 2; ++b) {
        const auto& sign = mesh_
                               .vertices[static_cast<std::size_t>(
                                   GridVertex(i * step + a * step / 2, j * step + b * step / 2))]
                               .sign;
        for (int k = 0; k < kFieldCount; ++k) {
          if (sign[static_cast<std::size_t>(k)] != 0) seen[k][sign[static_cast<std::size_t>(k)] > 0] = 1;
        }
      }
    }
    for (const auto& s : seen) {
      if (s[0] != 0 && s[1] != 0) return true;
    }
    return false;
  }

  void Refine(int level, int i, int j, int limit) {
    if (level < limit && BorderPasses(level, i, j)) {
      for (const int a : {0, 1}) {
        for (const int b : {0, 1}) Refine(level + 1, 2 * i + a, 2 * j + b, limit);
      }
      return;
    }
    const int step = kGrid >> level;
    for (const int a : {0, 1}) {
      for (const int b : {0, 1}) GridVertex((i + a) * step, (j + b) * step);
    }
    cells_.push_back({level, i, j});
  }

  // Vertices strictly between two corners of a cell on one of its sides: corners of finer neighbours.
  void Between(int i0, int j0, int i1, int j1, std::vector<int>& ring) {
    const int length = std::abs(i1 - i0) + std::abs(j1 - j0);
    for (int s = 1; s < length; ++s) {
      const int gi = i0 + (i1 - i0) * s / length, gj = j0 + (j1 - j0) * s / length;
      const auto it = grid_.find(gi * (kGrid + 1) + gj);
      if (it != grid_.end()) ring.push_back(it->second);
    }
  }

  void Fan(const Cell& cell) {
    const int step = kGrid >> cell.level;
    const int i0 = cell.i * step, j0 = cell.j * step, i1 = i0 + step, j1 = j0 + step;
    const int corner[4][2] = {{i0, j0}, {i1, j0}, {i1, j1}, {i0, j1}};
    std::vector<int> ring;
    for (int k = 0; k < 4; ++k) {
      const auto& a = corner[k];
      const auto& b = corner[(k + 1) % 4];
      ring.push_back(GridVertex(a[0], a[1]));
      Between(a[0], a[1], b[0], b[1], ring);
    }
    const int center = step >= 2 ? GridVertex(i0 + step / 2, j0 + step / 2)
                                 : AddVertex((i0 + 0.5 * step) / kGrid, (j0 + 0.5 * step) / kGrid);
    for (std::size_t k = 0; k < ring.size(); ++k) {
      mesh_.triangles.push_back({{center, ring[k], ring[(k + 1) % ring.size()]}, {}, 0.0, 0.0});
    }
  }

  double Value(Field field, double u, double v) const {
    if (field == Field::kReach) return reach_.Reachable(piece_, u, v) ? 1.0 : -1.0;
    return EvaluateFields(piece_, u, v, params_.cos_steep).value[static_cast<std::size_t>(field)];
  }

  // The vertex where `field` changes sign on the edge between a and b; made once for both triangles of the
  // edge.
  int Crossing(Field field, int a, int b) {
    const auto key = std::make_pair(std::min(a, b), std::max(a, b));
    const auto it = crossings_.find(key);
    if (it != crossings_.end()) return it->second;
    const SplitVertex& from = mesh_.vertices[static_cast<std::size_t>(key.first)];
    const SplitVertex& to = mesh_.vertices[static_cast<std::size_t>(key.second)];
    const auto k = static_cast<std::size_t>(field);
    double low = 0.0, high = 1.0;
    const double low_sign = from.sign[k];
    const double length = (to.p - from.p).norm();
    const double stop =
        field == Field::kReach ? 0.25 * params_.border_tolerance / std::max(length, 1e-9) : 1e-12;
    for (int i = 0; i < 48 && high - low > stop; ++i) {
      const double t = 0.5 * (low + high);
      const double value = Value(field, from.u + t * (to.u - from.u), from.v + t * (to.v - from.v));
      ((value > 0.0) == (low_sign > 0.0) ? low : high) = t;
    }
    const double t = 0.5 * (low + high);
    const int id = AddVertex(from.u + t * (to.u - from.u), from.v + t * (to.v - from.v));
    SplitVertex& vertex = mesh_.vertices[static_cast<std::size_t>(id)];
    vertex.on = static_cast<std::uint8_t>(1u << k);
    vertex.sign[k] = 0;
    // An edge that runs along another field's curve keeps its crossing on that curve.
    const std::uint8_t both = mesh_.vertices[static_cast<std::size_t>(key.first)].on &
                              mesh_.vertices[static_cast<std::size_t>(key.second)].on;
    for (std::size_t other = 0; other < k; ++other) {
      if ((both >> other) & 1u) {
        vertex.on = static_cast<std::uint8_t>(vertex.on | (1u << other));
        vertex.sign[other] = 0;
      }
    }
    crossings_.emplace(key, id);
    return id;
  }

  void Cut(Field field) {
    crossings_.clear();
    const auto k = static_cast<std::size_t>(field);
    std::vector<SplitTriangle> whole = std::move(mesh_.triangles);
    mesh_.triangles.clear();
    for (const SplitTriangle& t : whole) {
      const auto sign = [&](int corner) {
        return mesh_.vertices[static_cast<std::size_t>(t.vertex[static_cast<std::size_t>(corner)])].sign[k];
      };
      // Turn the triangle so that corner 0 is the odd one out: alone on its side, or the vertex on the curve.
      int odd = -1;
      bool through_vertex = false;
      for (int c = 0; c < 3 && odd < 0; ++c) {
        const int s0 = sign(c), s1 = sign((c + 1) % 3), s2 = sign((c + 2) % 3);
        if (s0 * s1 < 0 && s0 * s2 < 0) odd = c;
        if (s0 == 0 && s1 * s2 < 0) {
          odd = c;
          through_vertex = true;
        }
      }
      if (odd < 0) {
        mesh_.triangles.push_back(t);
        continue;
      }
      const auto corner = [&](int c) { return t.vertex[static_cast<std::size_t>((odd + c) % 3)]; };
      const int a = corner(0), b = corner(1), c = corner(2);
      if (through_vertex) {
        const int m = Crossing(field, b, c);
        mesh_.triangles.push_back({{a, b, m}, {}, 0.0, 0.0});
        mesh_.triangles.push_back({{a, m, c}, {}, 0.0, 0.0});
        // The curve leaves the triangle through this vertex: it lies on it as far as rounding can tell.
        mesh_.vertices[static_cast<std::size_t>(a)].on |= static_cast<std::uint8_t>(1u << k);
        continue;
      }
      const int m = Crossing(field, a, b), n = Crossing(field, a, c);
      mesh_.triangles.push_back({{a, m, n}, {}, 0.0, 0.0});
      mesh_.triangles.push_back({{m, b, c}, {}, 0.0, 0.0});
      mesh_.triangles.push_back({{m, c, n}, {}, 0.0, 0.0});
    }
  }

  // Sign of a field on a triangle: of a vertex off the curve, else of the centroid.
  int SignOn(const SplitTriangle& t, Field field, double u, double v) const {
    const auto k = static_cast<std::size_t>(field);
    for (const int id : t.vertex) {
      const SplitVertex& vertex = mesh_.vertices[static_cast<std::size_t>(id)];
      if (((vertex.on >> k) & 1u) == 0 && vertex.sign[k] != 0) return vertex.sign[k];
    }
    return Sign(Value(field, u, v));
  }

  void Finish(SplitTriangle& t) {
    const SplitVertex& a = mesh_.vertices[static_cast<std::size_t>(t.vertex[0])];
    const SplitVertex& b = mesh_.vertices[static_cast<std::size_t>(t.vertex[1])];
    const SplitVertex& c = mesh_.vertices[static_cast<std::size_t>(t.vertex[2])];
    const double u = (a.u + b.u + c.u) / 3.0, v = (a.v + b.v + c.v) / 3.0;
    const double domain = 0.5 * std::abs((b.u - a.u) * (c.v - a.v) - (c.u - a.u) * (b.v - a.v));
    // Degree-2 rule at the points (4 a + b + c)/6, ...; weights 1/3.
    const SplitVertex* corners[3] = {&a, &b, &c};
    const int turn = SignOn(t, Field::kTurn, u, v);
    for (int k = 0; k < 3; ++k) {
      const double qu = 0.5 * u + 0.5 * corners[k]->u, qv = 0.5 * v + 0.5 * corners[k]->v;
      const SurfaceJet jet = Evaluate(piece_, qu, qv);
      const double element = domain / 3.0 * jet.du.cross(jet.dv).norm();
      t.area += element;
      if (const auto normal = UnitNormal(jet))
        t.curvature += turn * element * ContourCurvature(jet, Forms(jet, *normal));
    }
    t.label.curvature = static_cast<std::int8_t>(turn * SignOn(t, Field::kCurvature, u, v));
    t.label.steep = SignOn(t, Field::kSlope, u, v) < 0;
    if (SignOn(t, Field::kReach, u, v) < 0) {
      t.label.reason = reach_.Reason(piece_, u, v);
      // The centroid may lie beyond a limit that the vertices do not see.
      if (t.label.reason == UnreachableReason::kNone) t.label.reason = ReasonAtCorners(t);
    }
  }

  UnreachableReason ReasonAtCorners(const SplitTriangle& t) {
    for (const int id : t.vertex) {
      const SplitVertex& vertex = mesh_.vertices[static_cast<std::size_t>(id)];
      if (vertex.sign[3] < 0) {
        const UnreachableReason reason = reach_.Reason(piece_, vertex.u, vertex.v);
        if (reason != UnreachableReason::kNone) return reason;
      }
    }
    return UnreachableReason::kNone;
  }

  const Piece& piece_;
  const ReachTest& reach_;
  const SplitMeshParams& params_;
  SplitMesh mesh_;
  std::vector<Cell> cells_;
  std::unordered_map<int, int> grid_;  // looked up, never walked: order does not matter
  std::map<std::pair<int, int>, int> crossings_;
};

}  // namespace

SplitMesh BuildSplitMesh(const Piece& piece, const ReachTest& reach, const SplitMeshParams& params) {
  return Builder(piece, reach, params).Build();
}

std::vector<Vec2> RefineArc(const Piece& piece, Field field, const SplitVertex& a, const SplitVertex& b,
                            double cos_steep, double tolerance) {
  std::vector<Vec2> out;
  const auto value = [&](const Vec2& q) {
    return EvaluateFields(piece, q.x(), q.y(), cos_steep).value[static_cast<std::size_t>(field)];
  };
  const auto recurse = [&](const auto& self, const Vec2& from, const Vec2& to, int depth) -> void {
    if (depth == 0) return;
    const Vec2 mid = 0.5 * (from + to);
    const Vec2 across(-(to - from).y(), (to - from).x());
    // Bracket the root on the perpendicular through the chord's middle, at most half a chord away, inside the
    // piece.
    const double at_mid = value(mid);
    double low = 0.0, high = 0.0;
    bool found = false;
    for (const double reach : {0.05, 0.15, 0.5}) {
      for (const double side : {reach, -reach}) {
        const Vec2 q = mid + side * across;
        if (q.minCoeff() < 0.0 || q.maxCoeff() > 1.0 || found) continue;
        if ((value(q) > 0.0) != (at_mid > 0.0)) {
          high = side;
          found = true;
        }
      }
    }
    if (!found) return;
    for (int i = 0; i < 40; ++i) {
      const double s = 0.5 * (low + high);
      ((value(mid + s * across) > 0.0) == (at_mid > 0.0) ? low : high) = s;
    }
    const Vec2 root = mid + 0.5 * (low + high) * across;
    const Vec3 p = Position(piece, root.x(), root.y());
    const Vec3 chord_from = Position(piece, from.x(), from.y()), chord_to = Position(piece, to.x(), to.y());
    const Vec3 d = chord_to - chord_from;
    const double t =
        d.squaredNorm() > 0.0 ? std::clamp((p - chord_from).dot(d) / d.squaredNorm(), 0.0, 1.0) : 0.0;
    if ((chord_from + t * d - p).norm() <= tolerance) return;
    self(self, from, root, depth - 1);
    out.push_back(root);
    self(self, root, to, depth - 1);
  };
  recurse(recurse, Vec2(a.u, a.v), Vec2(b.u, b.v), 8);
  return out;
}

}  // namespace patchmill
