#include "core/trim/trapezoids.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <map>
#include <utility>

#include <absl/status/status.h>
#include <absl/strings/str_format.h>

#include "core/base/index.h"
#include "core/math/bernstein.h"

namespace patchmill {
namespace {

// The parameter in [0,1] at which the arc has this x.
double WhereX(const BorderArc& arc, double x) {
  if (x <= arc.x0()) return 0.0;
  if (x >= arc.x1()) return 1.0;
  double low = 0.0, high = 1.0;
  for (int round = 0; round < 60; ++round) {
    const double middle = 0.5 * (low + high);
    (PointOn(arc, middle).x() < x ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

// The part between two walls. Its ends lie on the walls exactly.
BorderArc Between(const BorderArc& arc, double x0, double x1) {
  BorderArc part = arc;
  const double s0 = WhereX(arc, x0), s1 = WhereX(arc, x1);
  if (s1 < 1.0) KeepLeft(part.points.data(), arc.degree(), 1, s1);
  if (s0 > 0.0) KeepRight(part.points.data(), arc.degree(), 1, s1 > 0.0 ? s0 / s1 : 0.0);
  part.from = arc.from + s0 * (arc.to - arc.from);
  part.to = arc.from + s1 * (arc.to - arc.from);
  part.points.front().x() = x0 * part.points.front().z();
  part.points.back().x() = x1 * part.points.back().z();
  return part;
}

struct Trapezoid {
  int below = 0, above = 0;  // arcs
  double x0 = 0.0, x1 = 0.0;
};

class TrapezoidCutter {
 public:
  TrapezoidCutter(const std::vector<BorderArc>& arcs, double thinnest) : arcs_(arcs), thinnest_(thinnest) {
    for (const BorderArc& arc : arcs) {
      walls_.push_back(arc.x0());
      walls_.push_back(arc.x1());
    }
    std::sort(walls_.begin(), walls_.end());
    // The x of an end is a quotient: what is one wall may differ in the last bits.
    walls_.erase(std::unique(walls_.begin(), walls_.end(), SameWall), walls_.end());
    for (const BorderArc& arc : arcs) spans_.push_back({WallAt(arc.x0()), WallAt(arc.x1())});
  }

  absl::StatusOr<Trapezoids> Run(const RunContext& run) {
    absl::StatusOr<std::vector<Trapezoid>> cells = FindTrapezoids(walls_, run);
    if (!cells.ok()) return cells.status();
    for (const Trapezoid& t : *cells) {
      Emit(Between(arcs_[At(t.below)], t.x0, t.x1), Between(arcs_[At(t.above)], t.x0, t.x1), 0);
    }
    return std::move(result_);
  }

 private:
  // The walls at both ends of an arc.
  struct WallSpan {
    double from = 0.0, to = 0.0;
  };
  static bool SameWall(double a, double b) {
    return std::abs(b - a) <=
           8.0 * std::numeric_limits<double>::epsilon() * std::max(std::abs(a), std::abs(b));
  }
  double WallAt(double x) const {
    const auto after = std::upper_bound(walls_.begin(), walls_.end(), x);
    if (after != walls_.end() && SameWall(x, *after)) return *after;
    return after == walls_.begin() ? *after : *(after - 1);
  }

  absl::StatusOr<std::vector<Trapezoid>> FindTrapezoids(const std::vector<double>& walls,
                                                        const RunContext& run) {
    std::vector<Trapezoid> done;
    std::map<std::pair<int, int>, double> open;  // from which x on two arcs bound a trapezoid
    std::vector<int> by_start(arcs_.size());
    for (std::size_t k = 0; k < by_start.size(); ++k) by_start[k] = static_cast<int>(k);
    std::sort(by_start.begin(), by_start.end(), [&](int a, int b) {
      return std::make_pair(spans_[At(a)].from, a) < std::make_pair(spans_[At(b)].from, b);
    });
    std::size_t next = 0;
    std::vector<int> active;
    for (std::size_t k = 0; k + 1 < walls.size(); ++k) {
      if (const absl::Status status = run.Check(); !status.ok()) return status;
      const double x0 = walls[k], x1 = walls[k + 1], middle = x0 + 0.41421356 * (x1 - x0);
      std::erase_if(active, [&](int a) { return spans_[At(a)].to <= x0; });
      while (next < by_start.size() && spans_[At(by_start[next])].from <= x0)
        active.push_back(by_start[next++]);
      std::vector<std::pair<double, int>> stack;
      for (const int a : active) {
        const BorderArc& arc = arcs_[At(a)];
        stack.emplace_back(PointOn(arc, WhereX(arc, middle)).y(), a);
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
  static BorderArc LineUnder(const BorderArc& arc, const Vec2& a, const Vec2& b) {
    BorderArc line = arc;
    const double slope = (b.y() - a.y()) / (b.x() - a.x());
    for (Vec3& p : line.points) p.y() = a.y() * p.z() + slope * (p.x() - a.x() * p.z());
    MoveEnd(line.points.front(), a);
    MoveEnd(line.points.back(), b);
    return line;
  }

  // Whether all of the arc lies on one side of the line; side 1: above.
  static bool Beside(const BorderArc& arc, const Vec2& a, const Vec2& b, double side) {
    const double slope = (b.y() - a.y()) / (b.x() - a.x());
    return std::all_of(arc.points.begin(), arc.points.end(), [&](const Vec3& p) {
      return side * (p.y() / p.z() - a.y() - slope * (p.x() / p.z() - a.x())) >=
             -1e-12 * (1.0 + std::abs(a.y()));
    });
  }

  void Emit(const BorderArc& below, const BorderArc& above, int halvings) {
    result_.parts.push_back(below);
    result_.parts.push_back(above);
    const Vec2 b0 = PointOn(below, 0.0), b1 = PointOn(below, 1.0), a0 = PointOn(above, 0.0),
               a1 = PointOn(above, 1.0);
    if (Straight(below)) {
      Keep(LineUnder(above, b0, b1), above);
    } else if (Straight(above)) {
      Keep(below, LineUnder(below, a0, a1));
    } else {
      const Vec2 m0 = 0.5 * (a0 + b0), m1 = 0.5 * (a1 + b1);
      if ((Beside(below, m0, m1, -1.0) && Beside(above, m0, m1, 1.0)) || halvings > 10) {
        Keep(below, LineUnder(below, m0, m1));
        Keep(LineUnder(above, m0, m1), above);
        return;
      }
      const double middle = 0.5 * (b0.x() + b1.x());
      Emit(Between(below, b0.x(), middle), Between(above, b0.x(), middle), halvings + 1);
      Emit(Between(below, middle, b1.x()), Between(above, middle, b1.x()), halvings + 1);
    }
  }

  void Keep(BorderArc below, BorderArc above) {
    double most = 0.0;
    for (std::size_t i = 0; i < below.points.size(); ++i) {
      most = std::max(most,
                      above.points[i].y() / above.points[i].z() - below.points[i].y() / below.points[i].z());
    }
    if (most >= thinnest_) result_.pairs.push_back({std::move(below), std::move(above)});
  }
  static bool Straight(const BorderArc& arc) { return arc.degree() == 1; }

  const std::vector<BorderArc>& arcs_;
  const double thinnest_;
  std::vector<double> walls_;
  std::vector<WallSpan> spans_;  // [arc]
  Trapezoids result_;
};

}  // namespace

Vec2 PointOn(const BorderArc& arc, double s) {
  std::vector<Vec3> p = arc.points;
  KeepLeft(p.data(), arc.degree(), 1, s);
  return p.back().head<2>() / p.back().z();
}

void MoveEnd(Vec3& end, const Vec2& to) { end.head<2>() = end.z() * to; }

WalledArcs ArcsBetweenWalls(std::vector<BorderArc> arcs, double same_x) {
  std::vector<double> xs;
  for (const BorderArc& arc : arcs) {
    xs.push_back(arc.x0());
    xs.push_back(arc.x1());
  }
  std::sort(xs.begin(), xs.end());
  struct Wall {
    double from, x;  // the first end of an arc in it, and where it stands
  };
  std::vector<Wall> walls;
  for (const double x : xs) {
    if (walls.empty() || x - walls.back().from > same_x) {
      walls.push_back({x, x});
    } else if (x == 0.0 || x == 1.0) {
      walls.back().x = x;
    }
  }
  const auto snapped = [&walls](double x) {
    const auto after =
        std::upper_bound(walls.begin(), walls.end(), x, [](double at, const Wall& w) { return at < w.from; });
    return after == walls.begin() ? after->x : (after - 1)->x;
  };
  WalledArcs walled;
  for (BorderArc& arc : arcs) {
    const double a = snapped(arc.x0()), b = snapped(arc.x1());
    walled.moved = std::max({walled.moved, std::abs(a - arc.x0()), std::abs(b - arc.x1())});
    if (a == b) continue;
    arc.points.front().x() = a * arc.points.front().z();
    arc.points.back().x() = b * arc.points.back().z();
    if (a > b) {
      std::reverse(arc.points.begin(), arc.points.end());
      std::swap(arc.from, arc.to);
    }
    walled.arcs.push_back(std::move(arc));
  }
  return walled;
}

absl::StatusOr<Trapezoids> CutIntoTrapezoids(const std::vector<BorderArc>& arcs, double thinnest,
                                             const RunContext& run) {
  return TrapezoidCutter(arcs, thinnest).Run(run);
}

}  // namespace patchmill
