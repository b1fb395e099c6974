#include "core/division/divide_surface.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>

#include <fmt/format.h>

#include "core/base/error_details.h"
#include "core/base/index.h"
#include "core/base/status.h"
#include "core/base/union_find.h"
#include "core/joining/network_findings.h"
#include "core/math/bspline_basis.h"

namespace patchmill {
namespace {

constexpr double kSamePlace = 1e-10;      // share of the size: nearer points are one
constexpr double kSameNormal = 1e-8;      // rad; joining admits 1e-7
constexpr double kSameDerivative = 1e-8;  // share of its length
constexpr int kCreaseSamples = 5;
constexpr int kDistanceSteps = 4;

// The part of the surface between knots, with its own derivatives up to its border.
struct KnotRectangle {
  PatchShape shape;
};

BsplinePatch Restricted(const BsplinePatch& from, int ku, int kv) {
  BsplinePatch part;
  part.degree_u = from.degree_u, part.degree_v = from.degree_v;
  const int pu = from.degree_u, pv = from.degree_v;
  part.knots_u.assign(from.knots_u.begin() + (ku - pu), from.knots_u.begin() + (ku + pu + 2));
  part.knots_v.assign(from.knots_v.begin() + (kv - pv), from.knots_v.begin() + (kv + pv + 2));
  const int columns = static_cast<int>(from.knots_v.size()) - pv - 1;
  for (int i = ku - pu; i <= ku; ++i) {
    for (int j = kv - pv; j <= kv; ++j) {
      part.points.push_back(from.points[At(i * columns + j)]);
      if (!from.weights.empty()) part.weights.push_back(from.weights[At(i * columns + j)]);
    }
  }
  return part;
}

// The distinct knots of one parameter, from the start of the surface to its end.
std::vector<double> DistinctKnots(const std::vector<double>& knots, const std::vector<int>& spans) {
  std::vector<double> distinct;
  for (const int k : spans) distinct.push_back(knots[At(k)]);
  distinct.push_back(knots[At(spans.back() + 1)]);
  return distinct;
}

// Each interval cut into equal parts.
std::vector<double> Parts(const std::vector<double>& ends, int parts) {
  std::vector<double> breaks;
  for (std::size_t k = 0; k + 1 < ends.size(); ++k) {
    for (int i = 0; i < parts; ++i) breaks.push_back(std::lerp(ends[k], ends[k + 1], double(i) / parts));
  }
  breaks.push_back(ends.back());
  return breaks;
}

// Grid lines of both parameters. Faces lie between neighbours.
struct GridLines {
  std::vector<double> u, v;
  long long Faces() const {
    return static_cast<long long>(u.size() - 1) * static_cast<long long>(v.size() - 1);
  }
};

// Distances of a patch from the surface on its sides along u, on those along v, and inside, mm.
struct CellDistance {
  double sides_u = 0.0, sides_v = 0.0, inside = 0.0;
  double Most() const { return std::max({sides_u, sides_v, inside}); }
};

class Divider {
 public:
  Divider(const BsplinePatch& patch, const RunContext& run) : run_(run) {
    const std::vector<int> us = NonEmptySpans(patch.knots_u, patch.degree_u);
    const std::vector<int> vs = NonEmptySpans(patch.knots_v, patch.degree_v);
    spans_u_ = static_cast<int>(us.size()), spans_v_ = static_cast<int>(vs.size());
    degree_u_ = patch.degree_u, degree_v_ = patch.degree_v;
    knots_ = {DistinctKnots(patch.knots_u, us), DistinctKnots(patch.knots_v, vs)};
    for (const int ku : us) {
      for (const int kv : vs) rectangles_.push_back({Restricted(patch, ku, kv)});
    }
    Box3 box;
    for (const Vec3& p : patch.points) box.Add(p);
    size_ = box.Diagonal();
    MeasureSides();
  }

  const GridLines& knots() const { return knots_; }
  // A seam needs three faces around: two nodes have one edge between them.
  bool Enough(const GridLines& lines) const {
    return (!closed_u_ || lines.u.size() > 3) && (!closed_v_ || lines.v.size() > 3);
  }

  // Lines at which the derivative across them jumps, and the ends of the surface.
  GridLines Breaks() const {
    GridLines lines{{knots_.u.front()}, {knots_.v.front()}};
    for (int k = 1; k < spans_u_; ++k) {
      if (!Smooth(k, true)) lines.u.push_back(knots_.u[At(k)]);
    }
    for (int k = 1; k < spans_v_; ++k) {
      if (!Smooth(k, false)) lines.v.push_back(knots_.v[At(k)]);
    }
    lines.u.push_back(knots_.u.back()), lines.v.push_back(knots_.v.back());
    return lines;
  }

  absl::StatusOr<DividedSurface> Divide(const GridLines& lines) {
    lines_ = lines;
    nu_ = static_cast<int>(lines.u.size()) - 1, nv_ = static_cast<int>(lines.v.size()) - 1;
    result_ = {};
    edge_of_.clear();
    distances_.clear();
    edge_index_.clear();
    FindNodes();
    PM_RETURN_IF_ERROR(run_.Check());
    AddFaces();
    PM_RETURN_IF_ERROR(run_.Check());
    AddNormals();
    PM_ASSIGN_OR_RETURN(result_.joined, JoinNetwork(result_.network, run_));
    result_.findings = result_.joined.findings;
    if (HasError(result_.findings)) return std::move(result_);
    for (std::size_t k = 0; k < cells_.size(); ++k) {
      if (k % 16 == 0) PM_RETURN_IF_ERROR(run_.Check());
      distances_.push_back(DistanceOf(static_cast<int>(k)));
      result_.max_distance = std::max(result_.max_distance, distances_.back().Most());
    }
    return std::move(result_);
  }

  // The lines of the last division, and one more across each face that is farther than the tolerance from the
  // surface: along the sides that are, or both ways.
  GridLines Refined(double tolerance) const {
    std::vector<bool> cut_u(At(nu_), false), cut_v(At(nv_), false);
    for (std::size_t k = 0; k < cells_.size(); ++k) {
      const CellDistance& d = distances_[k];
      if (d.Most() <= tolerance) continue;
      const bool u = d.sides_u > 0.5 * tolerance, v = d.sides_v > 0.5 * tolerance;
      if (u || !v) cut_u[At(cells_[k].i)] = true;
      if (v || !u) cut_v[At(cells_[k].j)] = true;
    }
    return {Cut(lines_.u, cut_u, knots_.u), Cut(lines_.v, cut_v, knots_.v)};
  }

 private:
  // A face of the network: the part of the surface between grid lines.
  struct Cell {
    int i = 0, j = 0;
    std::vector<int> corners;  // of the quad, 0..3 anticlockwise; without one of a collapsed side
  };
  // Cuts the marked intervals at the knot nearest to their middle, if one lies in the middle half.
  static std::vector<double> Cut(const std::vector<double>& lines, const std::vector<bool>& marked,
                                 const std::vector<double>& knots) {
    std::vector<double> cut;
    for (std::size_t k = 0; k + 1 < lines.size(); ++k) {
      cut.push_back(lines[k]);
      if (!marked[k]) continue;
      const double middle = std::midpoint(lines[k], lines[k + 1]), reach = 0.25 * (lines[k + 1] - lines[k]);
      const double knot =
          *std::ranges::min_element(knots, {}, [middle](double t) { return std::abs(t - middle); });
      cut.push_back(std::abs(knot - middle) <= reach ? knot : middle);
    }
    cut.push_back(lines.back());
    return cut;
  }

  // One parameter of a place: the span between knots, the share of that span, and its derivative by the share
  // of the cell. Ends of a cell are seen from inside of it; shares beyond it go on.
  struct SpanPlace {
    int span = 0;
    double share = 0.0, slope = 1.0;
  };
  static SpanPlace PlaceOn(const std::vector<double>& lines, const std::vector<double>& knots, int cell,
                           double share) {
    const double from = lines[At(cell)], to = lines[At(cell + 1)], t = std::lerp(from, to, share);
    const int last = static_cast<int>(knots.size()) - 2;
    const auto after = share >= 1.0 ? std::ranges::lower_bound(knots, t) : std::ranges::upper_bound(knots, t);
    const int span = std::clamp(static_cast<int>(after - knots.begin()) - 1, 0, last);
    const double low = knots[At(span)], length = knots[At(span + 1)] - low;
    return {span, (t - low) / length, (to - from) / length};
  }

  // The jet at the place (u, v) in [0,1] of a cell, by the cell's own parameters.
  SurfaceJet JetIn(int i, int j, double u, double v) const {
    const SpanPlace a = PlaceOn(lines_.u, knots_.u, i, u), b = PlaceOn(lines_.v, knots_.v, j, v);
    SurfaceJet jet = Evaluate(rectangles_[At(a.span * spans_v_ + b.span)].shape, a.share, b.share);
    jet.du *= a.slope, jet.dv *= b.slope, jet.duv *= a.slope * b.slope;
    return jet;
  }

  // The derivative across the inner knot `k` is the same on both sides, at places all along it.
  bool Smooth(int k, bool across_u) const {
    const std::vector<double>& knots = across_u ? knots_.u : knots_.v;
    const double before = knots[At(k)] - knots[At(k - 1)], after = knots[At(k + 1)] - knots[At(k)];
    for (int span = 0; span < (across_u ? spans_v_ : spans_u_); ++span) {
      for (int n = 0; n <= kCreaseSamples; ++n) {
        const double share = double(n) / kCreaseSamples;
        const auto jet = [&](int side, double at) {
          const int rectangle = across_u ? side * spans_v_ + span : span * spans_v_ + side;
          const SurfaceJet j =
              Evaluate(rectangles_[At(rectangle)].shape, across_u ? at : share, across_u ? share : at);
          return across_u ? j.du : j.dv;
        };
        const Vec3 a = jet(k - 1, 1.0) / before, b = jet(k, 0.0) / after;
        if ((a - b).norm() > kSameDerivative * std::max(a.norm(), b.norm())) return false;
      }
    }
    return true;
  }
  Vec3 Corner(int span_u, int span_v, double u, double v) const {
    return Position(rectangles_[At(span_u * spans_v_ + span_v)].shape, u, v);
  }

  void MeasureSides() {
    const double near = kSamePlace * size_;
    const auto along = [&](int steps, const auto& point) {  // whether all points of a side lie in one place
      for (int k = 1; k <= steps; ++k) {
        if ((point(k) - point(0)).norm() > near) return false;
      }
      return true;
    };
    constexpr int kPer = 4;
    const auto on_u = [&](int k, double v) {
      const int span = std::min(k / kPer, spans_u_ - 1);
      return Corner(span, v > 0 ? spans_v_ - 1 : 0, (k - span * kPer) / double(kPer), v);
    };
    const auto on_v = [&](int k, double u) {
      const int span = std::min(k / kPer, spans_v_ - 1);
      return Corner(u > 0 ? spans_u_ - 1 : 0, span, u, (k - span * kPer) / double(kPer));
    };
    for (const int side : {0, 1}) {
      pole_v_[At(side)] = along(kPer * spans_u_, [&](int k) { return on_u(k, side); });
      pole_u_[At(side)] = along(kPer * spans_v_, [&](int k) { return on_v(k, side); });
    }
    closed_v_ = closed_u_ = true;
    for (int k = 0; k <= kPer * spans_u_; ++k)
      closed_v_ = closed_v_ && (on_u(k, 0) - on_u(k, 1)).norm() <= near;
    for (int k = 0; k <= kPer * spans_v_; ++k)
      closed_u_ = closed_u_ && (on_v(k, 0) - on_v(k, 1)).norm() <= near;
    if (pole_v_[0] || pole_v_[1]) closed_v_ = false;
    if (pole_u_[0] || pole_u_[1]) closed_u_ = false;
  }

  int Grid(int i, int j) const { return i * (nv_ + 1) + j; }

  void FindNodes() {
    UnionFind sets(At((nu_ + 1) * (nv_ + 1)));
    const auto join = [&](int a, int b) { sets.Join(At(a), At(b)); };
    for (int i = 0; i <= nu_; ++i) {
      if (pole_v_[0]) join(Grid(0, 0), Grid(i, 0));
      if (pole_v_[1]) join(Grid(0, nv_), Grid(i, nv_));
      if (closed_v_) join(Grid(i, 0), Grid(i, nv_));
    }
    for (int j = 0; j <= nv_; ++j) {
      if (pole_u_[0]) join(Grid(0, 0), Grid(0, j));
      if (pole_u_[1]) join(Grid(nu_, 0), Grid(nu_, j));
      if (closed_u_) join(Grid(0, j), Grid(nu_, j));
    }
    vertex_.assign(At((nu_ + 1) * (nv_ + 1)), -1);
    for (int i = 0; i <= nu_; ++i) {
      for (int j = 0; j <= nv_; ++j) {
        const std::size_t first = sets.Find(At(Grid(i, j)));
        if (vertex_[first] < 0) {
          vertex_[first] = static_cast<int>(result_.network.vertices.size());
          const int ci = std::min(i, nu_ - 1), cj = std::min(j, nv_ - 1);
          result_.network.vertices.emplace_back().position = JetIn(ci, cj, i - ci, j - cj).p;
        }
        vertex_[At(Grid(i, j))] = vertex_[first];
      }
    }
  }

  static constexpr std::array<std::array<int, 2>, 4> kCornerAt = {{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
  int VertexOf(const Cell& cell, int corner) const {
    return vertex_[At(Grid(cell.i + kCornerAt[At(corner)][0], cell.j + kCornerAt[At(corner)][1]))];
  }
  SurfaceJet JetAt(const Cell& cell, int corner) const {
    return JetIn(cell.i, cell.j, kCornerAt[At(corner)][0], kCornerAt[At(corner)][1]);
  }
  // Derivative along side k of the quad, from corner k to the next, at one of them.
  static Vec3 Along(const SurfaceJet& jet, int side) {
    const Vec3 d = side % 2 == 0 ? jet.du : jet.dv;
    return side < 2 ? d : Vec3(-d);
  }

  void AddFaces() {
    cells_.clear();
    for (int i = 0; i < nu_; ++i) {
      for (int j = 0; j < nv_; ++j) {
        Cell cell{i, j, {}};
        for (int c = 0; c < 4; ++c) {
          if (VertexOf(cell, c) != VertexOf(cell, (c + 3) % 4)) cell.corners.push_back(c);
        }
        if (cell.corners.size() < 3) continue;
        NetworkFace& face = result_.network.faces.emplace_back();
        face.id = fmt::format("{}/{}", i + 1, j + 1);
        for (const int c : cell.corners) face.vertices.push_back(VertexOf(cell, c));
        const int number = static_cast<int>(cells_.size());
        for (int side = 0; side < 4; ++side) AddSide(cell, number, side);
        // Wa at the start of side k is S_uv with the sign of the two directions [joining (3)].
        if (cell.corners.size() == 4) {
          for (int side = 0; side < 4; ++side) {
            const int next = (side + 1) % 4;
            const double sign[4] = {1, -1, 1, -1};
            face.twists.push_back({VertexOf(cell, side), VertexOf(cell, next),
                                   Vec3(sign[side] * JetAt(cell, side).duv),
                                   Vec3(sign[next] * JetAt(cell, next).duv)});
          }
        }
        cells_.push_back(std::move(cell));
      }
    }
  }

  struct SideOf {
    int face = 0, side = 0;
  };
  void AddSide(const Cell& cell, int face, int side) {
    const int next = (side + 1) % 4, a = VertexOf(cell, side), b = VertexOf(cell, next);
    if (a == b) return;
    const auto [entry, is_new] = edge_index_.try_emplace(std::minmax(a, b));
    entry->second.push_back({face, side});
    if (!is_new) return;
    const SurfaceJet from = JetAt(cell, side), to = JetAt(cell, next);
    const Vec3 p = result_.network.vertices[At(a)].position, q = result_.network.vertices[At(b)].position;
    NetworkEdge& edge = result_.network.edges.emplace_back();
    edge.start = a, edge.end = b;
    edge.shape = CurveEdge{BezierCurve{{p, p + Along(from, side) / 3, q - Along(to, side) / 3, q}}};
    edge_of_[std::minmax(a, b)] = static_cast<int>(result_.network.edges.size()) - 1;
  }

  // The normal of a cell on its side, at a share of the way from its first corner.
  Vec3 NormalOn(const Cell& cell, int side, double share) const {
    const auto &a = kCornerAt[At(side)], &b = kCornerAt[At((side + 1) % 4)];
    const SurfaceJet jet = JetIn(cell.i, cell.j, std::lerp(a[0], b[0], share), std::lerp(a[1], b[1], share));
    return jet.du.cross(jet.dv).normalized();
  }

  // The plane of the two sides that meet at a corner.
  Vec3 CornerNormal(const Cell& cell, int corner) const {
    const SurfaceJet jet = JetAt(cell, corner);
    const Vec3 n = jet.du.cross(jet.dv);
    if (n.norm() > 1e-9 * size_ * size_ / (double(nu_) * nv_)) return n.normalized();
    // At a pole: of the meridians on both sides.
    const int other =
        VertexOf(cell, corner) == VertexOf(cell, (corner + 1) % 4) ? (corner + 1) % 4 : (corner + 3) % 4;
    const bool along_u = corner / 2 == other / 2 && (corner + other) % 4 == 1;
    const SurfaceJet beside = JetAt(cell, other);
    const Vec3 d0 = along_u ? jet.dv : jet.du, d1 = along_u ? beside.dv : beside.du;
    const Vec3 m = d0.cross(d1);
    return m.norm() > 0 ? Vec3(m.normalized()) : Vec3::Zero();
  }

  void AddNormals() {
    for (const auto& [ends, sides] : edge_index_) {
      if (sides.size() != 2) continue;
      bool crease = false;
      for (int k = 0; k < kCreaseSamples && !crease; ++k) {
        const double share = (k + 0.5) / kCreaseSamples;
        const bool turned = VertexOf(cells_[At(sides[0].face)], sides[0].side) ==
                            VertexOf(cells_[At(sides[1].face)], sides[1].side);
        const Vec3 a = NormalOn(cells_[At(sides[0].face)], sides[0].side, share);
        const Vec3 b = NormalOn(cells_[At(sides[1].face)], sides[1].side, turned ? share : 1 - share);
        crease = a.cross(b).norm() > kSameNormal || a.dot(b) < 0;
      }
      result_.network.edges[At(edge_of_.at(ends))].crease = crease;
    }
    // Corners of each vertex; those of one normal share it.
    std::vector<std::vector<std::pair<Vec3, std::vector<int>>>> normals(result_.network.vertices.size());
    std::vector<int> count(result_.network.vertices.size(), 0);
    for (int f = 0; f < static_cast<int>(cells_.size()); ++f) {
      for (const int c : cells_[At(f)].corners) {
        const int v = VertexOf(cells_[At(f)], c);
        const Vec3 n = CornerNormal(cells_[At(f)], c);
        if (n.isZero()) continue;
        ++count[At(v)];
        auto& list = normals[At(v)];
        const auto same = std::ranges::find_if(list, [&](const auto& entry) {
          return entry.first.cross(n).norm() <= kSameNormal && entry.first.dot(n) > 0;
        });
        if (same == list.end()) {
          list.push_back({n, {f}});
        } else {
          same->second.push_back(f);
        }
      }
    }
    for (std::size_t v = 0; v < normals.size(); ++v) {
      const bool one = normals[v].size() == 1;
      for (auto& [n, faces] : normals[v]) {
        result_.network.vertices[v].normals.push_back({n, one ? std::vector<int>() : faces});
      }
      if (one || normals[v].empty()) continue;
      // Faces of different planes meet here: at a crease, or at a pole that is pointed.
      for (NetworkEdge& edge : result_.network.edges) {
        if (edge.start != static_cast<int>(v) && edge.end != static_cast<int>(v)) continue;
        const auto& sides = edge_index_.at(std::minmax(edge.start, edge.end));
        if (sides.size() != 2) continue;
        const auto plane_of = [&](int face) {
          return std::ranges::find_if(
              normals[v], [&](const auto& e) { return std::ranges::find(e.second, face) != e.second.end(); });
        };
        if (plane_of(sides[0].face) != plane_of(sides[1].face)) edge.crease = true;
      }
    }
  }

  // Shares of a cell at which its distance is measured: in each part between knots, as many as the degree
  // needs.
  std::vector<double> SharesOf(const std::vector<double>& lines, const std::vector<double>& knots, int cell,
                               int degree) const {
    const double from = lines[At(cell)], to = lines[At(cell + 1)];
    std::vector<double> ends = {from};
    for (const double t : knots) {
      if (t > from && t < to) ends.push_back(t);
    }
    ends.push_back(to);
    std::vector<double> shares = Parts(ends, std::max(kDistanceSteps, degree + 2));
    for (double& t : shares) t = (t - from) / (to - from);
    return shares;
  }

  // Distance of a patch from the surface, from the places of equal parameters on.
  CellDistance DistanceOf(int number) const {
    const Cell& cell = cells_[At(number)];
    const PatchShape& shape = result_.joined.model.patches[At(number)].shape;
    const std::vector<double> us = SharesOf(lines_.u, knots_.u, cell.i, degree_u_);
    const std::vector<double> vs = SharesOf(lines_.v, knots_.v, cell.j, degree_v_);
    CellDistance most;
    const auto take = [](double& to, double distance) { to = std::max(to, distance); };
    if (cell.corners.size() == 4) {
      for (const double u : us) {
        for (const double v : vs) {
          const bool side_u = v == vs.front() || v == vs.back(), side_v = u == us.front() || u == us.back();
          take(side_u   ? most.sides_u
               : side_v ? most.sides_v
                        : most.inside,
               FromSurface(cell, Position(shape, u, v), u, v));
        }
      }
      return most;
    }
    const int steps = static_cast<int>(std::max(us.size(), vs.size())) - 1;
    for (int a = 0; a <= steps; ++a) {
      for (int b = 0; a + b <= steps; ++b) {
        // The places of the corners, mixed by their shares.
        const double u = a / double(steps), v = b / double(steps);
        Vec2 at = Vec2::Zero();
        const double share[3] = {1 - u - v, u, v};
        for (int k = 0; k < 3; ++k) {
          const auto& corner = kCornerAt[At(cell.corners[At(k)])];
          at += share[k] * Vec2(corner[0], corner[1]);
        }
        take(most.inside, FromSurface(cell, Position(shape, u, v), at.x(), at.y()));
      }
    }
    return most;
  }

  // A share of a cell, moved into the surface; the surface goes on beyond the cell.
  static double WithinSurface(const std::vector<double>& lines, int cell, double share) {
    const double from = lines[At(cell)], length = lines[At(cell + 1)] - from;
    return std::clamp(share, (lines.front() - from) / length, (lines.back() - from) / length);
  }

  double FromSurface(const Cell& cell, const Vec3& p, double u, double v) const {
    double best = kInfinity;
    for (int round = 0; round < 12; ++round) {
      const SurfaceJet jet = JetIn(cell.i, cell.j, u, v);
      const Vec3 r = p - jet.p;
      const double now = r.norm();
      if (!(now < best * (1 - 1e-6)) && round > 0) break;
      best = std::min(best, now);
      const double e = jet.du.squaredNorm(), f = jet.du.dot(jet.dv), g = jet.dv.squaredNorm(),
                   w = e * g - f * f;
      if (!(w > 1e-12 * e * g)) break;
      const double x = jet.du.dot(r), y = jet.dv.dot(r);
      u = WithinSurface(lines_.u, cell.i, u + (g * x - f * y) / w);
      v = WithinSurface(lines_.v, cell.j, v + (e * y - f * x) / w);
    }
    return best;
  }

  const RunContext& run_;
  std::vector<KnotRectangle> rectangles_;
  int spans_u_ = 0, spans_v_ = 0;
  double size_ = 0.0;
  std::array<bool, 2> pole_u_ = {}, pole_v_ = {};  // the sides u = 0, 1 and v = 0, 1 are points
  bool closed_u_ = false, closed_v_ = false;
  GridLines knots_, lines_;
  int degree_u_ = 1, degree_v_ = 1;
  int nu_ = 0, nv_ = 0;
  std::vector<CellDistance> distances_;
  DividedSurface result_;
  std::vector<int> vertex_;
  std::vector<Cell> cells_;
  std::map<std::pair<int, int>, std::vector<SideOf>> edge_index_;
  std::map<std::pair<int, int>, int> edge_of_;
};

// The lines to begin with.
GridLines FirstLines(const Divider& divider, const Division& division) {
  const GridLines ends = division.lines == DivisionLines::kFewest ? divider.Breaks() : divider.knots();
  for (int more = 0;; ++more) {
    GridLines lines{Parts(ends.u, division.parts_u + more), Parts(ends.v, division.parts_v + more)};
    if (divider.Enough(lines)) return lines;
  }
}

// Whether an interval between knots has more than kMaxDivisionParts parts.
bool TooMany(const std::vector<double>& lines, const std::vector<double>& knots) {
  for (std::size_t k = 0; k + 1 < knots.size(); ++k) {
    const auto first = std::ranges::lower_bound(lines, knots[k]),
               last = std::ranges::lower_bound(lines, knots[k + 1]);
    if (last - first > kMaxDivisionParts) return true;
  }
  return false;
}

GridLines NextLines(const Divider& divider, const Division& division, const GridLines& lines) {
  if (division.lines == DivisionLines::kFewest) return divider.Refined(division.tolerance);
  return {Parts(lines.u, 2), Parts(lines.v, 2)};
}

}  // namespace

absl::StatusOr<DividedSurface> DivideSurface(const BsplinePatch& patch, const Division& division,
                                             const RunContext& run) {
  Divider divider(patch, run);
  GridLines lines = FirstLines(divider, division);
  if (lines.Faces() > kMaxNetworkFaces) {
    return FieldError("division",
                      fmt::format("makes {} faces; must be at most {}", lines.Faces(), kMaxNetworkFaces));
  }
  for (;;) {
    PM_ASSIGN_OR_RETURN(DividedSurface divided, divider.Divide(lines));
    if (HasError(divided.findings) || divided.max_distance <= division.tolerance) return divided;
    GridLines next = NextLines(divider, division, lines);
    const GridLines& knots = divider.knots();
    if (next.Faces() > kMaxNetworkFaces || TooMany(next.u, knots.u) || TooMany(next.v, knots.v)) {
      divided.findings.push_back(MakeWarning(
          "DIVISION_COARSE",
          fmt::format("the network leaves the surface by {:.3g} mm, more than the tolerance {:g}, "
                      "in {} faces",
                      divided.max_distance, division.tolerance, lines.Faces())));
      return divided;
    }
    lines = std::move(next);
  }
}

}  // namespace patchmill
