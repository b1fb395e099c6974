#include "core/trim/plane_strips.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>

#include <absl/status/status.h>
#include <absl/strings/str_format.h>

#include "core/base/index.h"
#include "core/math/bernstein.h"
#include "core/trim/trapezoids.h"

namespace patchmill {
namespace {

constexpr double kSameX = 1e-9;              // mm: corners closer than that along the plane get one wall
constexpr double kThinnestTrapezoid = 1e-6;  // mm

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
std::vector<double> TurnsOf(const BorderArc& arc) {
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
Vec2 LongestStraight(const std::vector<BorderArc>& arcs) {
  Vec2 best = Vec2::UnitX();
  double longest = 0.0;
  for (const BorderArc& arc : arcs) {
    if (arc.degree() != 1) continue;
    const Vec2 d = PointOn(arc, 1.0) - PointOn(arc, 0.0);
    if (d.norm() > longest * (1.0 + 1e-9)) {
      longest = d.norm();
      best = d / longest;
    }
  }
  return best;
}

class PlaneCutter {
 public:
  PlaneCutter(const BrepFrame& frame, const std::vector<BrepLoop>& loops, const EdgeCurveTable& curves)
      : frame_(frame), loops_(loops), curves_(curves) {}

  absl::StatusOr<PlanePatches> Run(const RunContext& run) {
    if (const absl::Status status = ReadLoops(); !status.ok()) return status;
    TurnFrame();
    SnapWalls();
    const absl::StatusOr<Trapezoids> cut = CutIntoTrapezoids(arcs_, kThinnestTrapezoid, run);
    if (!cut.ok()) return cut.status();
    for (const ArcPair& pair : cut->pairs) AddPatch(pair);
    for (const BorderArc& part : cut->parts) {
      result_.breaks[At(part.use)].push_back(part.from);
      result_.breaks[At(part.use)].push_back(part.to);
    }
    for (std::vector<double>& breaks : result_.breaks) {
      std::sort(breaks.begin(), breaks.end());
      breaks.erase(std::unique(breaks.begin(), breaks.end()), breaks.end());
    }
    return std::move(result_);
  }

 private:
  // The borders' spans in the frame, along their loops. Neighbours meet exactly.
  absl::Status ReadLoops() {
    int use_index = 0;
    for (const BrepLoop& loop : loops_) {
      const std::size_t first = arcs_.size();
      for (const BrepEdgeUse& use : loop) {
        const SpannedCurve& curve = curves_[At(use.edge)];
        result_.breaks.emplace_back();
        if (curve.spans.empty()) {
          ++use_index;
          continue;
        }
        std::vector<BorderArc> own;
        for (const CurveSpan& span : curve.spans) {
          BorderArc arc;
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
          for (BorderArc& arc : own) Reverse(arc);
        }
        for (BorderArc& arc : own) arcs_.push_back(std::move(arc));
        ++use_index;
      }
      for (std::size_t k = first; k < arcs_.size(); ++k) {
        BorderArc& next = arcs_[k + 1 < arcs_.size() ? k + 1 : first];
        const Vec2 a = PointOn(arcs_[k], 1.0), b = PointOn(next, 0.0);
        const double apart = (a - b).norm();
        if (apart > kOpenLoop) {
          return absl::FailedPreconditionError(absl::StrFormat("a loop is open by %g mm", apart));
        }
        result_.gap = std::max(result_.gap, apart);
        MoveEnd(arcs_[k].points.back(), 0.5 * (a + b));
        MoveEnd(next.points.front(), 0.5 * (a + b));
      }
    }
    return absl::OkStatus();
  }

  static void Reverse(BorderArc& arc) {
    std::reverse(arc.points.begin(), arc.points.end());
    std::swap(arc.from, arc.to);
  }

  // From here on x runs along the longest straight edge, and so do the arcs, each without a turn.
  void TurnFrame() {
    const Vec2 d = LongestStraight(arcs_);
    const Vec3 x = d.x() * frame_.x + d.y() * frame_.y, y = -d.y() * frame_.x + d.x() * frame_.y;
    frame_.x = x;
    frame_.y = y;
    std::vector<BorderArc> parts;
    for (BorderArc& arc : arcs_) {
      for (Vec3& p : arc.points) p.head<2>() = Vec2(d.dot(p.head<2>()), Cross(d, Vec2(p.head<2>())));
      const std::vector<double> turns = TurnsOf(arc);
      double done = 0.0;
      BorderArc rest = arc;
      for (const double t : turns) {
        const double s = (t - done) / (1.0 - done);
        BorderArc part = rest;
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

  // Corners that differ in x by rounding get the same x. Borders along a wall are left out.
  void SnapWalls() {
    for (const BorderArc& arc : arcs_) {
      result_.breaks[At(arc.use)].push_back(arc.from);
      result_.breaks[At(arc.use)].push_back(arc.to);
    }
    arcs_ = ArcsBetweenWalls(std::move(arcs_), kSameX).arcs;
  }

  void AddPatch(const ArcPair& pair) {
    const BorderArc &below = pair.below, &above = pair.above;
    BernsteinNet net{below.degree(), 1, false, {}};
    for (std::size_t i = 0; i < below.points.size(); ++i) {
      for (const Vec3& p : {below.points[i], above.points[i]}) {
        const Vec3 q = p.x() * frame_.x + p.y() * frame_.y + p.z() * frame_.origin;
        net.points.push_back({q.x(), q.y(), q.z(), p.z()});
        net.rational = net.rational || p.z() != 1.0;
      }
    }
    result_.nets.push_back(std::move(net));
  }

  BrepFrame frame_;
  const std::vector<BrepLoop>& loops_;
  const EdgeCurveTable& curves_;
  std::vector<BorderArc> arcs_;
  PlanePatches result_;
};

}  // namespace

absl::StatusOr<PlanePatches> CutPlane(const BrepFrame& frame, const std::vector<BrepLoop>& loops,
                                      const EdgeCurveTable& curves, const RunContext& run) {
  return PlaneCutter(frame, loops, curves).Run(run);
}

}  // namespace patchmill
