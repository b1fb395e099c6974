#include "core/lines/patch_crossings.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <optional>
#include <tuple>

#include <Eigen/LU>
#include <fmt/format.h>

#include "core/base/draw.h"
#include "core/base/index.h"
#include "core/base/segment.h"
#include "core/spatial/box_tree.h"

namespace patchmill {
namespace {

constexpr int kMostSteps = 96;                 // cells of a piece each way
constexpr std::size_t kMostCells = 1'500'000;  // of the whole surface
constexpr double kSame = 10 * kCrossingGap;    // mm: ends nearer to each other are one
constexpr double kNewtonEnd = 1e-12;           // share of the surface's size

// The search moves each patch by this share of the surface's size, in a direction of its own. So no edge of
// a grid meets an edge or a corner of another patch's grid, as those of parts with straight walls and
// symmetries would. A curve along a border then lies on one side of it or on the other: a second search
// moves all patches the other way. The curves are refined on the surfaces themselves.
constexpr double kShift = 1e-9;

// A vector in [-1, 1]^3 for a patch.
Vec3 ShiftOf(PatchId patch) {
  const std::uint64_t k = 3 * static_cast<std::uint64_t>(patch.value);
  return {2 * Draw(k + 1) - 1, 2 * Draw(k + 2) - 1, 2 * Draw(k + 3) - 1};
}

// A piece cut into cells of equal parameters; a cell is two triangles.
struct PieceGrid {
  int nu = 1, nv = 1;
  int first_cell = 0, first_point = 0;
};

// Where an edge of one grid meets a triangle of another: an end of a short straight part of a curve. The edge
// belongs to both triangles beside it, so their parts share the end.
struct EdgeKey {
  int p = 0, q = 0;  // grid points of the edge, p < q
  int triangle = 0;  // of the other patch
  auto operator<=>(const EdgeKey&) const = default;
};

struct CrossingPoint {
  PieceId piece_a, piece_b;
  Vec2 a = Vec2::Zero(), b = Vec2::Zero();
  Vec3 p = Vec3::Zero();
  bool good = false;
};

double SecondDifference(const BernsteinNet& net, bool along_u) {
  const int nu = net.degree_u, nv = net.degree_v;
  double most = 0.0;
  const auto at = [&](int i, int j) -> Vec3 {
    const Vec4& h = net.points[At(i * (nv + 1) + j)];
    return h.w() > 0.0 ? Vec3(h.head<3>() / h.w()) : Vec3::Constant(std::nan(""));
  };
  const int di = along_u ? 1 : 0, dj = 1 - di, degree = along_u ? nu : nv;
  for (int i = 0; i + 2 * di <= nu; ++i) {
    for (int j = 0; j + 2 * dj <= nv; ++j) {
      const double d = (at(i, j) - 2 * at(i + di, j + dj) + at(i + 2 * di, j + 2 * dj)).norm();
      if (std::isfinite(d)) most = std::max(most, degree * (degree - 1) * d);
    }
  }
  return most;
}

class CrossingFinder {
 public:
  CrossingFinder(const Surface& surface, const CrossingParams& params, const RunContext& run)
      : surface_(surface), params_(params), run_(run) {}

  absl::StatusOr<Crossings3d> Find() {
    result_.depth = params_.depth;
    MakeGrids();
    for (const double side : {1.0, -1.0}) {
      if (absl::Status status = MakePoints(side * kShift * surface_.scale); !status.ok()) return status;
      if (absl::Status status = FindParts(side < 0); !status.ok()) return status;
      for (auto& [pair, parts] : parts_) {
        if (absl::Status status = run_.Check(); !status.ok()) return status;
        TracePair(pair, parts);
      }
    }
    DropDoubles();
    for (auto& [pair, found] : found_) {
      if (!found.curves.empty()) result_.pairs.push_back(std::move(found));
    }
    JoinCurves();
    return std::move(result_);
  }

 private:
  using PatchPair = std::pair<int, int>;
  using Part = std::array<EdgeKey, 2>;

  struct Cell {
    PieceId piece;
    int i = 0, j = 0;
  };

  // The curves of a pair, and for each one the edges of the patches that it runs along.
  struct Found : PatchCrossing {
    std::vector<std::optional<PatchEdge>> edges_a, edges_b;
  };

  void MakeGrids() {
    std::vector<std::array<double, 2>> bends;
    for (const Piece& piece : surface_.pieces) {
      bends.push_back({SecondDifference(piece.net, true), SecondDifference(piece.net, false)});
    }
    for (;; result_.depth *= 2) {
      std::size_t cells = 0;
      bool cut_short = false;
      grids_.clear();
      for (const auto& bend : bends) {
        const auto steps = [&](double b) {
          const double wish = std::ceil(std::sqrt(b / (4.0 * result_.depth)));  // both ways: half of it each
          cut_short = cut_short || wish > kMostSteps;
          return static_cast<int>(std::clamp(wish, 2.0, double(kMostSteps)));
        };
        const PieceGrid grid{steps(bend[0]), steps(bend[1]), 0, 0};
        grids_.push_back(grid);
        cells += At(grid.nu) * At(grid.nv);
      }
      result_.complete = result_.complete && !cut_short;
      if (cells <= kMostCells) return;
      result_.complete = false;
    }
  }

  absl::Status MakePoints(double shift) {
    points_.clear(), cells_.clear(), parts_.clear();
    for (std::size_t k = 0; k < grids_.size(); ++k) {
      if (absl::Status status = run_.Check(); !status.ok()) return status;
      PieceGrid& grid = grids_[k];
      grid.first_cell = static_cast<int>(cells_.size()), grid.first_point = static_cast<int>(points_.size());
      const PieceId piece{static_cast<int>(k)};
      const Vec3 moved = shift * ShiftOf(surface_.piece(piece).patch);
      for (int i = 0; i <= grid.nu; ++i) {
        for (int j = 0; j <= grid.nv; ++j) {
          points_.push_back(Position(surface_.piece(piece), i / double(grid.nu), j / double(grid.nv)) +
                            moved);
          if (i < grid.nu && j < grid.nv) cells_.push_back({piece, i, j});
        }
      }
    }
    return absl::OkStatus();
  }

  int PointOf(const Cell& cell, int di, int dj) const {
    const PieceGrid& grid = grids_[cell.piece.index()];
    return grid.first_point + (cell.i + di) * (grid.nv + 1) + cell.j + dj;
  }
  std::array<int, 3> Corners(int triangle) const {
    const Cell& cell = cells_[At(triangle / 2)];
    return triangle % 2 == 0
               ? std::array<int, 3>{PointOf(cell, 0, 0), PointOf(cell, 1, 0), PointOf(cell, 0, 1)}
               : std::array<int, 3>{PointOf(cell, 1, 1), PointOf(cell, 0, 1), PointOf(cell, 1, 0)};
  }
  int PatchOf(const Cell& cell) const { return surface_.piece(cell.piece).patch.value; }

  absl::Status FindParts(bool second) {
    std::vector<Box3> boxes(cells_.size());
    std::vector<double> reach(cells_.size());
    for (std::size_t c = 0; c < cells_.size(); ++c) {
      for (const int di : {0, 1}) {
        for (const int dj : {0, 1}) boxes[c].Add(points_[At(PointOf(cells_[c], di, dj))]);
      }
      reach[c] = 0.5 * (boxes[c].max - boxes[c].min).maxCoeff();
    }
    const BoxTree tree(boxes);
    const auto& patches = surface_.network.model.patches;
    for (std::size_t c = 0; c < cells_.size(); ++c) {
      if (c % 256 == 0) {
        if (absl::Status status = run_.Check(); !status.ok()) return status;
        run_.Progress("crossings", 0.5 * (second + double(c) / double(cells_.size())));
      }
      const int patch = PatchOf(cells_[c]);
      int polled = 0;
      tree.Near(boxes[c].Center(), reach[c], [&](int other) {
        if (++polled % 4096 == 0 && run_.Cancelled()) return false;
        const int beside = PatchOf(cells_[At(other)]);
        if (beside <= patch) return true;
        if ((boxes[c].min.array() > boxes[At(other)].max.array()).any() ||
            (boxes[c].max.array() < boxes[At(other)].min.array()).any()) {
          return true;
        }
        const PatchPair pair(patch, beside);
        const auto &face_a = patches[At(patch)].face, &face_b = patches[At(beside)].face;
        if (face_a && face_a == face_b) return true;
        for (const int s : {0, 1}) {
          for (const int t : {0, 1}) Cross(pair, 2 * static_cast<int>(c) + s, 2 * other + t);
        }
        return true;
      });
    }
    return run_.Check();
  }

  // The side of the plane of a triangle on which a point lies. A point on it counts as above.
  double SideOf(int point, const std::array<int, 3>& t) const {
    const Vec3 &a = points_[At(t[0])], n = (points_[At(t[1])] - a).cross(points_[At(t[2])] - a);
    return (points_[At(point)] - a).dot(n) < 0 ? -1.0 : 1.0;
  }

  // Whether the segment p q, whose ends lie on both sides of the triangle, passes through it.
  bool Through(int p, int q, const std::array<int, 3>& t) const {
    const Vec3 &a = points_[At(p)], d = points_[At(q)] - a;
    double signs = 0.0;
    for (int k = 0; k < 3; ++k) {
      const int from = t[At(k)], to = t[At((k + 1) % 3)];
      // The sign does not depend on the triangle that the side is seen from.
      const Vec3 &x = points_[At(std::min(from, to))], &y = points_[At(std::max(from, to))];
      const double volume = d.dot((x - a).cross(y - a));
      signs += ((volume < 0) == (from < to)) ? -1.0 : 1.0;
    }
    return std::abs(signs) == 3.0;
  }

  void Cross(const PatchPair& pair, int s, int t) {
    const std::array<int, 3> a = Corners(s), b = Corners(t);
    std::vector<EdgeKey> ends;
    for (const bool first : {true, false}) {
      const std::array<int, 3>&of = first ? a : b, &other = first ? b : a;
      std::array<double, 3> side;
      for (int k = 0; k < 3; ++k) side[At(k)] = SideOf(of[At(k)], other);
      for (int k = 0; k < 3; ++k) {
        const int next = (k + 1) % 3;
        if (side[At(k)] == side[At(next)]) continue;
        const auto [p, q] = std::minmax(of[At(k)], of[At(next)]);
        if (Through(p, q, other)) ends.push_back({p, q, first ? t : s});
      }
    }
    if (ends.size() == 2) parts_[pair].push_back({ends[0], ends[1]});
  }

  Vec2 ParametersOf(int point, const PieceGrid& grid) const {
    const int k = point - grid.first_point;
    return {(k / (grid.nv + 1)) / double(grid.nu), (k % (grid.nv + 1)) / double(grid.nv)};
  }
  PieceId PieceOfPoint(int point) const {
    const auto after = std::ranges::upper_bound(grids_, point, {}, &PieceGrid::first_point);
    return PieceId{static_cast<int>(after - grids_.begin()) - 1};
  }

  // A start for the place of an end: on the edge of one patch, inside the triangle of the other.
  CrossingPoint StartOf(const EdgeKey& key, int patch_a) const {
    const PieceId on = PieceOfPoint(key.p);
    const PieceGrid& grid = grids_[on.index()];
    const Cell& cell = cells_[At(key.triangle / 2)];
    const PieceGrid& other = grids_[cell.piece.index()];
    const std::array<int, 3> t = Corners(key.triangle);
    const Vec3 &x = points_[At(t[0])], e1 = points_[At(t[1])] - x, e2 = points_[At(t[2])] - x;
    const Vec3 &p = points_[At(key.p)], d = points_[At(key.q)] - p, n = e1.cross(e2);
    const double along = d.dot(n) != 0 ? std::clamp((x - p).dot(n) / d.dot(n), 0.0, 1.0) : 0.5;
    const Vec3 r = p + along * d - x;
    const double w = n.squaredNorm();
    const double s = w > 0 ? r.cross(e2).dot(n) / w : 0.3, u = w > 0 ? e1.cross(r).dot(n) / w : 0.3;
    const Vec2 o = ParametersOf(t[0], other);
    const Vec2 in = o + s * (ParametersOf(t[1], other) - o) + u * (ParametersOf(t[2], other) - o);
    const Vec2 edge = (1 - along) * ParametersOf(key.p, grid) + along * ParametersOf(key.q, grid);
    CrossingPoint point;
    const bool edge_is_a = surface_.piece(on).patch.value == patch_a;
    point.piece_a = edge_is_a ? on : cell.piece, point.piece_b = edge_is_a ? cell.piece : on;
    point.a = edge_is_a ? edge : in, point.b = edge_is_a ? in : edge;
    return point;
  }

  // Which parameters of a point stay: those of an edge of the grid on the border of its piece, so that the
  // curves of neighbours end in one place.
  static std::array<bool, 4> HeldOf(const CrossingPoint& at) {
    const auto held = [](double x) { return x <= 0.0 || x >= 1.0; };
    return {held(at.a.x()), held(at.a.y()), held(at.b.x()), held(at.b.y())};
  }

  // Newton steps of least length in space onto both surfaces.
  CrossingPoint Refined(CrossingPoint at, const std::array<bool, 4>& held) const {
    const double enough = kNewtonEnd * std::max(1.0, surface_.scale);
    double gap = kInfinity;
    for (int round = 0; round < 30; ++round) {
      const SurfaceJet a = Evaluate(surface_, at.piece_a, at.a.x(), at.a.y());
      const SurfaceJet b = Evaluate(surface_, at.piece_b, at.b.x(), at.b.y());
      const Vec3 r = b.p - a.p;
      at.p = 0.5 * (a.p + b.p);
      gap = r.norm();
      if (gap <= enough) break;
      Eigen::Matrix<double, 3, 4> j;
      j << a.du, a.dv, -b.du, -b.dv;
      // Columns scaled to steps in space; held ones drop out.
      Vec4 scale;
      for (int k = 0; k < 4; ++k) {
        const double length = j.col(k).norm();
        scale[k] = held[At(k)] || !(length > 0) ? 0.0 : 1.0 / length;
        j.col(k) *= scale[k];
      }
      const Eigen::Matrix3d m = j * j.transpose();
      const Eigen::FullPivLU<Eigen::Matrix3d> lu(m);
      if (!lu.isInvertible()) break;
      const Vec4 step = scale.cwiseProduct(Vec4(j.transpose() * lu.solve(r)));
      double most = 0.0;
      for (int k = 0; k < 4; ++k) {
        double& x = k < 2 ? at.a[k] : at.b[k - 2];
        const double next = std::clamp(x + step[k], 0.0, 1.0);
        most = std::max(most, std::abs(next - x));
        x = next;
      }
      if (most < 1e-16) break;
    }
    at.good = gap <= kCrossingGap;
    return at;
  }

  static bool OnBorder(const Vec2& x) { return x.minCoeff() <= 1e-9 || x.maxCoeff() >= 1 - 1e-9; }

  // Both surfaces pass through each other there, rather than touching or ending on each other.
  bool Passes(const CrossingPoint& at) const {
    const SurfaceJet a = Evaluate(surface_, at.piece_a, at.a.x(), at.a.y());
    const SurfaceJet b = Evaluate(surface_, at.piece_b, at.b.x(), at.b.y());
    const Vec3 na = a.du.cross(a.dv).normalized(), nb = b.du.cross(b.dv).normalized();
    return na.cross(nb).norm() > 1e-3;
  }
  // The place is at least `away` (mm) inside the border of the patch on this piece.
  bool Inside(PieceId piece, const Vec2& x, double away) const {
    const SurfaceJet jet = Evaluate(surface_, piece, x.x(), x.y());
    const Piece& on = surface_.piece(piece);
    const Vec2 native = NativeParameters(on, x.x(), x.y());
    const bool inner =
        native.minCoeff() > 1e-9 && native.maxCoeff() < 1 - 1e-9 &&
        !(IsTriangle(surface_.network.model.patches[on.patch.index()].shape) && native.sum() > 1 - 1e-9);
    if (inner && OnBorder(x)) return true;  // between pieces of one patch
    return std::min(std::min(x.x(), 1 - x.x()) * jet.du.norm(), std::min(x.y(), 1 - x.y()) * jet.dv.norm()) >
               away ||
           (inner && std::min({native.x(), native.y(), 1 - native.x(), 1 - native.y()}) > 1e-3);
  }

  void TracePair(const PatchPair& pair, const std::vector<Part>& parts) {
    std::map<EdgeKey, std::vector<int>> at_end;
    for (int k = 0; k < static_cast<int>(parts.size()); ++k) {
      for (const EdgeKey& key : parts[At(k)]) at_end[key].push_back(k);
    }
    std::vector<bool> used(parts.size(), false);
    Found crossing{{PatchId{pair.first}, PatchId{pair.second}, {}, 0.0}, {}, {}};
    const auto walk = [&](int part, const EdgeKey& from) {
      std::vector<EdgeKey> keys = {from};
      for (int now = part; now >= 0 && !used[At(now)];) {
        used[At(now)] = true;
        const EdgeKey next = parts[At(now)][0] == keys.back() ? parts[At(now)][1] : parts[At(now)][0];
        keys.push_back(next);
        int on = -1;
        for (const int other : at_end[next]) {
          if (!used[At(other)]) on = other;
        }
        now = on;
      }
      AddCurve(pair, keys, crossing);
    };
    for (const auto& [key, list] : at_end) {  // open ones from their ends
      if (list.size() == 1 && !used[At(list[0])]) walk(list[0], key);
    }
    for (int k = 0; k < static_cast<int>(parts.size()); ++k) {
      if (!used[At(k)]) walk(k, parts[At(k)][0]);
    }
    Found& found = found_[pair];
    if (crossing.length > found.length + kSame) found = std::move(crossing);
  }

  void AddCurve(const PatchPair& pair, const std::vector<EdgeKey>& keys, Found& crossing) {
    const bool closed = keys.size() > 3 && keys.front() == keys.back();
    std::vector<CrossingPoint> points;
    for (std::size_t k = 0; k + (closed ? 1 : 0) < keys.size(); ++k) {
      const CrossingPoint start = StartOf(keys[k], pair.first);
      CrossingPoint at = Refined(start, HeldOf(start));
      if (!at.good) at = Refined(start, {});
      if (at.good) points.push_back(at);
    }
    if (points.size() < 2) return;
    // At least one place where the surfaces pass through each other, inside of both.
    const double away = 4 * result_.depth;
    const auto passes = [&](const CrossingPoint& at) {
      if (!Passes(at)) return false;
      const bool in_a = Inside(at.piece_a, at.a, away), in_b = Inside(at.piece_b, at.b, away);
      return (in_a && in_b) || (in_b && GoesOnAcross(at.piece_a, at.a, at.piece_b, at.b)) ||
             (in_a && GoesOnAcross(at.piece_b, at.b, at.piece_a, at.a));
    };
    if (std::ranges::none_of(points, passes)) return;
    std::vector<CrossingPoint> fine;
    const std::size_t count = points.size();
    for (std::size_t k = 0; k + (closed ? 0 : 1) < count; ++k) {
      fine.push_back(points[k]);
      Subdivide(points[k], points[(k + 1) % count], 0, fine);
    }
    if (!closed) fine.push_back(points.back());
    ZeroCurve curve;
    curve.closed = closed;
    for (const CrossingPoint& at : fine) {
      if (!curve.points.empty() && (curve.points.back().p - at.p).norm() <= 1e-9) continue;
      curve.points.push_back({at.piece_a, at.a.x(), at.a.y(), at.p});
    }
    if (curve.points.size() < 2) return;
    double length = 0.0;
    for (std::size_t k = 0; k + (closed ? 0 : 1) < curve.points.size(); ++k) {
      length += (curve.points[(k + 1) % curve.points.size()].p - curve.points[k].p).norm();
    }
    if (length <= kSame) return;  // a point where the surfaces touch
    crossing.length += length;
    crossing.curves.push_back(std::move(curve));
    crossing.edges_a.push_back(EdgeAlong(fine, true));
    crossing.edges_b.push_back(EdgeAlong(fine, false));
  }

  // The edge of its patch on which all points of a curve lie.
  std::optional<PatchEdge> EdgeAlong(const std::vector<CrossingPoint>& points, bool on_a) const {
    std::array<std::size_t, 4> count = {};
    const auto piece = [&](const CrossingPoint& at) { return on_a ? at.piece_a : at.piece_b; };
    for (const CrossingPoint& at : points) {
      for (const PatchEdge& edge : EdgesOf(piece(at), on_a ? at.a : at.b)) ++count[At(edge.edge)];
    }
    for (int e = 0; e < 4; ++e) {
      if (count[At(e)] == points.size()) return PatchEdge{surface_.piece(piece(points.front())).patch, e};
    }
    return std::nullopt;
  }

  // The edges of its patch on which a place lies: two at a corner.
  std::vector<PatchEdge> EdgesOf(PieceId piece, const Vec2& x) const {
    const Piece& on = surface_.piece(piece);
    const Vec2 native = NativeParameters(on, x.x(), x.y());
    const bool triangle = IsTriangle(surface_.network.model.patches[on.patch.index()].shape);
    const SurfaceJet jet = Evaluate(surface_, on.patch, native.x(), native.y());
    const double u = jet.du.norm(), v = jet.dv.norm();
    // Distances from the edges, mm. The parameters alone say nothing near a pole.
    const double beyond[4] = {native.y() * v,
                              triangle ? (1 - native.sum()) * std::max(u, v) : (1 - native.x()) * u,
                              triangle ? native.x() * u : (1 - native.y()) * v, native.x() * u};
    std::vector<PatchEdge> edges;
    for (int e = 0; e < (triangle ? 3 : 4); ++e) {
      if (beyond[e] <= kCrossingGap) edges.push_back({on.patch, e});
    }
    return edges;
  }
  // A place on an edge of the first patch: its neighbour there is on the other side of the second patch.
  bool GoesOnAcross(PieceId piece, const Vec2& x, PieceId other, const Vec2& y) const {
    const std::vector<PatchEdge> edges = EdgesOf(piece, x);
    if (edges.size() != 1) return false;
    const PatchEdge edge = edges[0];
    const EdgeLink& link = surface_.network.Link(edge);
    if (!link.neighbor) return false;
    const auto is_triangle = [&](PatchId patch) {
      return IsTriangle(surface_.network.model.patches[patch.index()].shape);
    };
    const Vec2 native = NativeParameters(surface_.piece(piece), x.x(), x.y());
    const double t = edge.edge == 0 || (!is_triangle(edge.patch) && edge.edge == 2) ? native.x() : native.y();
    const SurfaceJet jet = Evaluate(surface_, other, y.x(), y.y());
    const Vec3 n = jet.du.cross(jet.dv).normalized();
    const auto inwards = [&](const PatchEdge& of, double at) {
      constexpr double kStep = 1e-3;  // share of the way to the middle of the patch
      const Vec2 on = EdgeParameters(surface_.network.model.patches[of.patch.index()].shape, of.edge, at);
      const Vec2 middle = is_triangle(of.patch) ? Vec2(1.0 / 3, 1.0 / 3) : Vec2(0.5, 0.5);
      const Vec2 in = on + kStep * (middle - on);
      const Vec3 p = Evaluate(surface_, of.patch, on.x(), on.y()).p;
      return n.dot((Evaluate(surface_, of.patch, in.x(), in.y()).p - p).normalized());
    };
    const double here = inwards(edge, t);
    const double there = inwards(*link.neighbor, link.reversed ? 1 - t : t);
    constexpr double kAcross = 1e-3;  // rad
    return std::abs(here) > kAcross && std::abs(there) > kAcross && (here < 0) != (there < 0);
  }

  // A curve along an edge that two patches share may have been found on both. The patch of lower index
  // keeps it.
  void DropDoubles() {
    const auto has = [&](int a, int b, const PatchEdge& edge) {
      const auto at = found_.find(std::minmax(a, b));
      if (at == found_.end()) return false;
      const auto& edges = at->second.a == edge.patch ? at->second.edges_a : at->second.edges_b;
      return std::ranges::find(edges, std::optional(edge)) != edges.end();
    };
    for (auto& [pair, found] : found_) {
      for (std::size_t k = found.curves.size(); k-- > 0;) {
        bool drop = false;
        for (const bool first : {true, false}) {
          const std::optional<PatchEdge>& edge = first ? found.edges_a[k] : found.edges_b[k];
          const EdgeLink* link = edge ? &surface_.network.Link(*edge) : nullptr;
          if (link == nullptr || !link->neighbor || link->neighbor->patch >= edge->patch) continue;
          drop = drop || has(link->neighbor->patch.value, first ? pair.second : pair.first, *link->neighbor);
        }
        if (!drop) continue;
        const ZeroCurve& curve = found.curves[k];
        for (std::size_t i = 0; i + (curve.closed ? 0 : 1) < curve.points.size(); ++i)
          found.length -= (curve.points[(i + 1) % curve.points.size()].p - curve.points[i].p).norm();
        const auto at = static_cast<std::ptrdiff_t>(k);
        found.curves.erase(found.curves.begin() + at);
        found.edges_a.erase(found.edges_a.begin() + at), found.edges_b.erase(found.edges_b.begin() + at);
      }
    }
  }

  // Points between two, until their chords keep the tolerance.
  void Subdivide(const CrossingPoint& a, const CrossingPoint& b, int depth,
                 std::vector<CrossingPoint>& to) const {
    if (depth >= 12 || a.piece_a != b.piece_a || a.piece_b != b.piece_b) return;
    CrossingPoint middle = a;
    middle.a = 0.5 * (a.a + b.a), middle.b = 0.5 * (a.b + b.b);
    middle = Refined(middle, {});
    const double chord = (b.p - a.p).norm();
    if (!middle.good || (middle.p - 0.5 * (a.p + b.p)).norm() > chord) return;
    if (SegmentDistance(middle.p, a.p, b.p) <= params_.tolerance) return;
    Subdivide(a, middle, depth + 1, to);
    to.push_back(middle);
    Subdivide(middle, b, depth + 1, to);
  }

  // Curves of pairs that end in one place are one.
  void JoinCurves() {
    std::vector<ZeroCurve> open;
    for (const PatchCrossing& pair : result_.pairs) {
      for (const ZeroCurve& curve : pair.curves) (curve.closed ? result_.curves : open).push_back(curve);
    }
    std::vector<bool> used(open.size(), false);
    const auto next = [&](const Vec3& end, bool& turned) {
      for (std::size_t k = 0; k < open.size(); ++k) {
        if (used[k]) continue;
        for (const bool back : {false, true}) {
          const Vec3& start = back ? open[k].points.back().p : open[k].points.front().p;
          if ((start - end).norm() > kSame) continue;
          turned = back;
          return static_cast<int>(k);
        }
      }
      return -1;
    };
    for (std::size_t first = 0; first < open.size(); ++first) {
      if (used[first]) continue;
      used[first] = true;
      ZeroCurve curve = open[first];
      for (const bool forward : {true, false}) {
        bool turned = false;
        for (int k = next(curve.points.back().p, turned); k >= 0; k = next(curve.points.back().p, turned)) {
          used[At(k)] = true;
          std::vector<SurfacePoint> more = open[At(k)].points;
          if (turned) std::ranges::reverse(more);
          curve.points.insert(curve.points.end(), more.begin() + 1, more.end());
        }
        if ((curve.points.back().p - curve.points.front().p).norm() <= kSame && curve.points.size() > 3) {
          curve.points.pop_back();
          curve.closed = true;
          break;
        }
        if (forward) std::ranges::reverse(curve.points);
      }
      result_.curves.push_back(std::move(curve));
    }
  }

  const Surface& surface_;
  const CrossingParams& params_;
  const RunContext& run_;
  Crossings3d result_;
  std::vector<PieceGrid> grids_;
  std::vector<Vec3> points_;
  std::vector<Cell> cells_;
  std::map<PatchPair, std::vector<Part>> parts_;
  std::map<PatchPair, Found> found_;
};

}  // namespace

absl::StatusOr<Crossings3d> FindPatchCrossings(const Surface& surface, const CrossingParams& params,
                                               const RunContext& run) {
  return CrossingFinder(surface, params, run).Find();
}

Diagnostics CrossingFindings(const Surface& surface, const Crossings3d& crossings) {
  Diagnostics findings;
  struct BodyPair {
    double length = 0.0;
    int faces = 0;
    Where where;
  };
  std::map<std::pair<std::string, std::string>, BodyPair> bodies;
  std::map<std::pair<std::string, std::string>, std::pair<double, Where>> names;
  const PatchModel& model = surface.network.model;
  const auto name = [&](PatchId patch) {
    const Patch& p = model.patches[patch.index()];
    if (p.face) return fmt::format("face {}", Title(model.faces[p.face->index()]));
    return p.id.empty() ? fmt::format("patch {}", patch.value)
                        : fmt::format("patch {} ({})", patch.value, p.id);
  };
  for (const PatchCrossing& pair : crossings.pairs) {
    const Patch &a = model.patches[pair.a.index()], &b = model.patches[pair.b.index()];
    const ZeroCurve& longest = pair.curves.front();
    Where where;
    where.patch_id = a.id, where.patch_index = pair.a.value;
    where.point = longest.points[longest.points.size() / 2].p;
    if (a.face) where.face_id = model.faces[a.face->index()].id;
    const std::string body_a = a.face ? model.faces[a.face->index()].body : "",
                      body_b = b.face ? model.faces[b.face->index()].body : "";
    if (!body_a.empty() && !body_b.empty() && body_a != body_b) {
      BodyPair& to = bodies[std::minmax(body_a, body_b)];
      if (to.faces == 0) to.where = where;
      to.length += pair.length;
      ++to.faces;
      continue;
    }
    auto& to = names[{name(pair.a), name(pair.b)}];
    if (to.first == 0.0) to.second = where;
    to.first += pair.length;
  }
  for (const auto& [pair, at] : bodies) {
    findings.push_back(
        MakeWarning("BODIES_CROSS",
                    fmt::format("body {} and body {} cross along {:.4g} mm; the upper one of two "
                                "surfaces is milled",
                                pair.first, pair.second, at.length),
                    at.where));
  }
  constexpr std::size_t kMostNamed = 1000;
  for (const auto& [pair, at] : names) {
    if (findings.size() > kMostNamed) break;
    findings.push_back(MakeWarning(
        "PATCHES_CROSS", fmt::format("{} and {} cross along {:.4g} mm", pair.first, pair.second, at.first),
        at.second));
  }
  if (!crossings.complete) {
    findings.push_back(
        MakeInfo("CROSSINGS_COARSE",
                 fmt::format("crossings that are less than {:.3g} mm deep may be missing: the surface "
                             "has too much detail for a finer search",
                             2 * crossings.depth)));
  }
  return findings;
}

}  // namespace patchmill
