#include "core/trim/plane_strips.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <optional>
#include <utility>

#include <absl/status/status.h>
#include <absl/strings/str_format.h>

#include "core/base/index.h"
#include "core/math/bernstein.h"

namespace patchmill {
namespace {

constexpr double kSameX = 1e-9;              // mm: corners closer than that along the plane get one wall
constexpr double kThinnestTrapezoid = 1e-6;  // mm

// A part of a border, homogeneous (w x, w y, w), with x not decreasing. A wall is at either end.
struct Arc {
  std::vector<Vec3> points;
  int use = 0;                  // place of the edge's use in the loops
  double from = 0.0, to = 1.0;  // parameters of the edge's curve at the points' ends

  int degree() const { return static_cast<int>(points.size()) - 1; }
  bool straight() const { return degree() == 1; }
  double x0() const { return points.front().x() / points.front().z(); }
  double x1() const { return points.back().x() / points.back().z(); }
};

Vec2 ArcPointAt(const Arc& arc, double s) {
  std::vector<Vec3> p = arc.points;
  KeepLeft(p.data(), arc.degree(), 1, s);
  return p.back().head<2>() / p.back().z();
}

// The parameter in [0,1] at which the arc has this x.
double WhereX(const Arc& arc, double x) {
  if (x <= arc.x0()) return 0.0;
  if (x >= arc.x1()) return 1.0;
  double low = 0.0, high = 1.0;
  for (int round = 0; round < 60; ++round) {
    const double middle = 0.5 * (low + high);
    (ArcPointAt(arc, middle).x() < x ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

void MoveEnd(Vec3& end, const Vec2& to) { end.head<2>() = end.z() * to; }

// The part between two walls. Its ends lie on the walls exactly.
Arc Between(const Arc& arc, double x0, double x1) {
  Arc part = arc;
  const double s0 = WhereX(arc, x0), s1 = WhereX(arc, x1);
  if (s1 < 1.0) KeepLeft(part.points.data(), arc.degree(), 1, s1);
  if (s0 > 0.0) KeepRight(part.points.data(), arc.degree(), 1, s1 > 0.0 ? s0 / s1 : 0.0);
  part.from = arc.from + s0 * (arc.to - arc.from);
  part.to = arc.from + s1 * (arc.to - arc.from);
  part.points.front().x() = x0 * part.points.front().z();
  part.points.back().x() = x1 * part.points.back().z();
  return part;
}

// Parameters in (0,1) where x turns back: zeros of X' W - X W'.
void TurnsOf(const std::vector<double>& c, double from, double to, int depth, std::vector<double>& turns) {
  double low = kInfinity, high = -kInfinity, size = 0.0;
  for (const double x : c) {
    low = std::min(low, x);
    high = std::max(high, x);
    size = std::max(size, std::abs(x));
  }
  if (low >= 0.0 || high <= 0.0) {
    // A zero at an end of a part only: between two parts it may be a turn, which the caller looks at.
    if (depth > 0 && c.front() == 0.0 && size > 0.0) turns.push_back(from);
    return;
  }
  if (depth > 50 || to - from < 1e-14) {
    turns.push_back(0.5 * (from + to));
    return;
  }
  std::vector<double> left = c, right = c;
  const int n = static_cast<int>(c.size()) - 1;
  KeepLeft(left.data(), n, 1, 0.5);
  KeepRight(right.data(), n, 1, 0.5);
  TurnsOf(left, from, 0.5 * (from + to), depth + 1, turns);
  TurnsOf(right, 0.5 * (from + to), to, depth + 1, turns);
}
std::vector<double> TurnsOf(const Arc& arc) {
  std::vector<double> turns;
  const int n = arc.degree();
  if (n < 2) return turns;
  std::vector<double> x, w, dx, dw;
  for (const Vec3& p : arc.points) {
    x.push_back(p.x());
    w.push_back(p.z());
  }
  for (int i = 0; i < n; ++i) {
    dx.push_back(n * (x[At(i + 1)] - x[At(i)]));
    dw.push_back(n * (w[At(i + 1)] - w[At(i)]));
  }
  std::vector<double> f = BernsteinProduct(dx, w);
  const std::vector<double> g = BernsteinProduct(x, dw);
  for (std::size_t i = 0; i < f.size(); ++i) f[i] -= g[i];
  double size = 0.0;
  for (const double c : f) size = std::max(size, std::abs(c));
  for (double& c : f) {
    if (std::abs(c) < 1e-13 * size) c = 0.0;
  }
  TurnsOf(f, 0.0, 1.0, 0, turns);
  std::sort(turns.begin(), turns.end());
  std::erase_if(turns, [](double t) { return t < 1e-9 || t > 1.0 - 1e-9; });
  turns.erase(std::unique(turns.begin(), turns.end(), [](double a, double b) { return b - a < 1e-9; }),
              turns.end());
  return turns;
}

// The direction of the longest straight edge, in the frame; x if there is none.
Vec2 LongestStraight(const std::vector<Arc>& arcs) {
  Vec2 best = Vec2::UnitX();
  double longest = 0.0;
  for (const Arc& arc : arcs) {
    if (!arc.straight()) continue;
    const Vec2 d = ArcPointAt(arc, 1.0) - ArcPointAt(arc, 0.0);
    if (d.norm() > longest * (1.0 + 1e-9)) {
      longest = d.norm();
      best = d / longest;
    }
  }
  return best;
}

struct Trapezoid {
  int below = 0, above = 0;  // arcs
  double x0 = 0.0, x1 = 0.0;
};

class PlaneCutter {
 public:
  PlaneCutter(const BrepFrame& frame, const std::vector<BrepLoop>& loops, const EdgeCurveTable& curves)
      : frame_(frame), loops_(loops), curves_(curves) {}

  absl::StatusOr<PlanePatches> Run(const RunContext& run) {
    if (const absl::Status status = ReadLoops(); !status.ok()) return status;
    TurnFrame();
    std::vector<double> walls = SnapWalls();
    absl::StatusOr<std::vector<Trapezoid>> cells = FindTrapezoids(walls, run);
    if (!cells.ok()) return cells.status();
    for (const Trapezoid& t : *cells) {
      Emit(Between(arcs_[At(t.below)], t.x0, t.x1), Between(arcs_[At(t.above)], t.x0, t.x1), 0);
    }
    for (std::vector<double>& breaks : result_.breaks) {
      std::sort(breaks.begin(), breaks.end());
      breaks.erase(std::unique(breaks.begin(), breaks.end()), breaks.end());
    }
    return std::move(result_);
  }

 private:
  // The borders' spans in the frame, neighbours closed.
  absl::Status ReadLoops() {
    int use_index = 0;
    for (const BrepLoop& loop : loops_) {
      const std::size_t first = arcs_.size();
      std::vector<std::size_t> ends;  // the arcs run in the loop's direction for now
      for (const BrepEdgeUse& use : loop) {
        const SpannedCurve& curve = curves_[At(use.edge)];
        result_.breaks.emplace_back();
        if (curve.spans.empty()) {
          ++use_index;
          continue;
        }
        std::vector<Arc> own;
        for (const CurveSpan& span : curve.spans) {
          Arc arc;
          arc.use = use_index;
          arc.from = span.from;
          arc.to = span.to;
          for (const Vec4& h : span.points) {
            const Vec3 q = h.head<3>() - h.w() * frame_.origin;
            arc.points.push_back({q.dot(frame_.x), q.dot(frame_.y), h.w()});
            result_.gap = std::max(result_.gap, std::abs(q.dot(frame_.z)) / h.w());
          }
          own.push_back(std::move(arc));
        }
        if (!use.forward) {
          std::reverse(own.begin(), own.end());
          for (Arc& arc : own) Reverse(arc);
        }
        for (Arc& arc : own) arcs_.push_back(std::move(arc));
        ++use_index;
      }
      for (std::size_t k = first; k < arcs_.size(); ++k) {
        Arc& next = arcs_[k + 1 < arcs_.size() ? k + 1 : first];
        const Vec2 a = ArcPointAt(arcs_[k], 1.0), b = ArcPointAt(next, 0.0);
        const double apart = (a - b).norm();
        if (apart > 0.05) {
          return absl::FailedPreconditionError(absl::StrFormat("a loop is open by %g mm", apart));
        }
        result_.gap = std::max(result_.gap, apart);
        MoveEnd(arcs_[k].points.back(), 0.5 * (a + b));
        MoveEnd(next.points.front(), 0.5 * (a + b));
      }
    }
    return absl::OkStatus();
  }

  static void Reverse(Arc& arc) {
    std::reverse(arc.points.begin(), arc.points.end());
    std::swap(arc.from, arc.to);
  }

  // From here on x runs along the longest straight edge, and so do the arcs, each without a turn.
  void TurnFrame() {
    const Vec2 d = LongestStraight(arcs_);
    const Vec3 x = d.x() * frame_.x + d.y() * frame_.y, y = -d.y() * frame_.x + d.x() * frame_.y;
    frame_.x = x;
    frame_.y = y;
    std::vector<Arc> parts;
    for (Arc& arc : arcs_) {
      for (Vec3& p : arc.points) p.head<2>() = Vec2(d.dot(p.head<2>()), Cross(d, Vec2(p.head<2>())));
      const std::vector<double> turns = TurnsOf(arc);
      double done = 0.0;
      Arc rest = arc;
      for (const double t : turns) {
        const double s = (t - done) / (1.0 - done);
        Arc part = rest;
        KeepLeft(part.points.data(), part.degree(), 1, s);
        KeepRight(rest.points.data(), rest.degree(), 1, s);
        rest.points.front() = part.points.back();
        part.to = rest.from = arc.from + t * (arc.to - arc.from);
        parts.push_back(std::move(part));
        done = t;
      }
      parts.push_back(std::move(rest));
    }
    arcs_ = std::move(parts);
  }

  // Corners that differ in x by rounding get the same x. Returns all x of corners. Borders along a wall bound
  // nothing above or below and are left out.
  std::vector<double> SnapWalls() {
    std::vector<double> xs;
    for (const Arc& arc : arcs_) {
      xs.push_back(arc.x0());
      xs.push_back(arc.x1());
    }
    std::sort(xs.begin(), xs.end());
    std::vector<double> walls;
    double last = -kInfinity;
    for (const double x : xs) {
      if (x - last > kSameX) walls.push_back(x);
      last = x;
    }
    const auto snapped = [&walls](double x) {
      const auto after = std::upper_bound(walls.begin(), walls.end(), x);
      return after == walls.begin() ? *after : *(after - 1);
    };
    std::vector<Arc> kept;
    for (Arc& arc : arcs_) {
      Vec3 &first = arc.points.front(), &last_point = arc.points.back();
      const double a = snapped(arc.x0()), b = snapped(arc.x1());
      first.x() = a * first.z();
      last_point.x() = b * last_point.z();
      result_.breaks[At(arc.use)].push_back(arc.from);
      result_.breaks[At(arc.use)].push_back(arc.to);
      if (a == b) continue;
      if (a > b) Reverse(arc);
      kept.push_back(std::move(arc));
    }
    arcs_ = std::move(kept);
    return walls;
  }

  absl::StatusOr<std::vector<Trapezoid>> FindTrapezoids(const std::vector<double>& walls,
                                                        const RunContext& run) {
    std::vector<Trapezoid> done;
    std::map<std::pair<int, int>, double> open;  // from which x on two arcs bound a trapezoid
    std::vector<int> by_start(arcs_.size());
    for (std::size_t k = 0; k < by_start.size(); ++k) by_start[k] = static_cast<int>(k);
    std::sort(by_start.begin(), by_start.end(), [&](int a, int b) {
      return std::make_pair(arcs_[At(a)].x0(), a) < std::make_pair(arcs_[At(b)].x0(), b);
    });
    std::size_t next = 0;
    std::vector<int> active;
    for (std::size_t k = 0; k + 1 < walls.size(); ++k) {
      if (const absl::Status status = run.Check(); !status.ok()) return status;
      const double x0 = walls[k], x1 = walls[k + 1], middle = x0 + 0.41421356 * (x1 - x0);
      std::erase_if(active, [&](int a) { return arcs_[At(a)].x1() <= x0; });
      while (next < by_start.size() && arcs_[At(by_start[next])].x0() <= x0)
        active.push_back(by_start[next++]);
      std::vector<std::pair<double, int>> stack;
      for (const int a : active) {
        const Arc& arc = arcs_[At(a)];
        stack.emplace_back(ArcPointAt(arc, WhereX(arc, middle)).y(), a);
      }
      std::sort(stack.begin(), stack.end());
      if (stack.size() % 2 != 0) {
        return absl::FailedPreconditionError(
            absl::StrFormat("the borders do not close at %g mm along the plane", middle));
      }
      std::map<std::pair<int, int>, double> still;
      for (std::size_t i = 0; i + 1 < stack.size(); i += 2) {
        const std::pair<int, int> pair(stack[i].second, stack[i + 1].second);
        const auto before = open.find(pair);
        still[pair] = before == open.end() ? x0 : before->second;
        if (before != open.end()) open.erase(before);
      }
      for (const auto& [pair, from] : open) done.push_back({pair.first, pair.second, from, x0});
      open = std::move(still);
    }
    for (const auto& [pair, from] : open) done.push_back({pair.first, pair.second, from, walls.back()});
    return done;
  }

  // The straight line from one place to another, with the x and the weights of an arc.
  static Arc LineUnder(const Arc& arc, const Vec2& a, const Vec2& b) {
    Arc line = arc;
    const double slope = (b.y() - a.y()) / (b.x() - a.x());
    for (Vec3& p : line.points) p.y() = a.y() * p.z() + slope * (p.x() - a.x() * p.z());
    MoveEnd(line.points.front(), a);
    MoveEnd(line.points.back(), b);
    return line;
  }

  // Whether all of the arc lies on one side of the line; side 1: above.
  static bool Beside(const Arc& arc, const Vec2& a, const Vec2& b, double side) {
    const double slope = (b.y() - a.y()) / (b.x() - a.x());
    return std::all_of(arc.points.begin(), arc.points.end(), [&](const Vec3& p) {
      return side * (p.y() / p.z() - a.y() - slope * (p.x() / p.z() - a.x())) >=
             -1e-12 * (1.0 + std::abs(a.y()));
    });
  }

  void Emit(const Arc& below, const Arc& above, int halvings) {
    for (const Arc* arc : {&below, &above}) {
      result_.breaks[At(arc->use)].push_back(arc->from);
      result_.breaks[At(arc->use)].push_back(arc->to);
    }
    const Vec2 b0 = ArcPointAt(below, 0.0), b1 = ArcPointAt(below, 1.0), a0 = ArcPointAt(above, 0.0),
               a1 = ArcPointAt(above, 1.0);
    if (below.straight()) {
      EmitPatch(LineUnder(above, b0, b1), above);
    } else if (above.straight()) {
      EmitPatch(below, LineUnder(below, a0, a1));
    } else {
      const Vec2 m0 = 0.5 * (a0 + b0), m1 = 0.5 * (a1 + b1);
      if ((Beside(below, m0, m1, -1.0) && Beside(above, m0, m1, 1.0)) || halvings > 10) {
        EmitPatch(below, LineUnder(below, m0, m1));
        EmitPatch(LineUnder(above, m0, m1), above);
        return;
      }
      const double middle = 0.5 * (b0.x() + b1.x());
      Emit(Between(below, b0.x(), middle), Between(above, b0.x(), middle), halvings + 1);
      Emit(Between(below, middle, b1.x()), Between(above, middle, b1.x()), halvings + 1);
    }
  }

  void EmitPatch(const Arc& below, const Arc& above) {
    double most = 0.0;
    for (std::size_t i = 0; i < below.points.size(); ++i) {
      most = std::max(most,
                      above.points[i].y() / above.points[i].z() - below.points[i].y() / below.points[i].z());
    }
    if (most < kThinnestTrapezoid) return;
    BernsteinNet net{below.degree(), 1, true, {}};
    bool rational = false;
    for (std::size_t i = 0; i < below.points.size(); ++i) {
      for (const Vec3& p : {below.points[i], above.points[i]}) {
        const Vec3 q = p.x() * frame_.x + p.y() * frame_.y + p.z() * frame_.origin;
        net.points.push_back({q.x(), q.y(), q.z(), p.z()});
        rational = rational || p.z() != 1.0;
      }
    }
    net.rational = rational;
    result_.nets.push_back(std::move(net));
  }

  BrepFrame frame_;
  const std::vector<BrepLoop>& loops_;
  const EdgeCurveTable& curves_;
  std::vector<Arc> arcs_;
  PlanePatches result_;
};

}  // namespace

absl::StatusOr<PlanePatches> CutPlane(const BrepFrame& frame, const std::vector<BrepLoop>& loops,
                                      const EdgeCurveTable& curves, const RunContext& run) {
  return PlaneCutter(frame, loops, curves).Run(run);
}

}  // namespace patchmill
