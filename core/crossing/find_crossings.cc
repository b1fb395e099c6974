#include "core/crossing/find_crossings.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include <fmt/format.h>

#include "core/base/error_details.h"
#include "core/base/index.h"
#include "core/base/segment.h"
#include "core/base/status.h"
#include "core/spatial/box_tree.h"

namespace patchmill {
namespace {

constexpr double kParallel = 8.0;       // degrees: curves that meet at less than this do not cross there
constexpr double kDoubledShare = 0.25;  // of the shorter curve
constexpr double kWholeShare = 0.9;
constexpr int kSamplesPerPiece = 4;

struct FlatPiece {
  int curve = 0;
  double t0 = 0.0, t1 = 0.0;
  Vec3 a = Vec3::Zero(), b = Vec3::Zero();
};

// Distance of the control points from the chord bounds that of the curve.
double Sag(const std::vector<Vec3>& points) {
  double sag = 0.0;
  for (const Vec3& p : points) sag = std::max(sag, SegmentDistance(p, points.front(), points.back()));
  return sag;
}

bool Flatten(int curve, const BezierChain& chain, double flatness, std::vector<FlatPiece>& pieces) {
  struct Open {
    BezierCurve part;
    double t0, t1;
    int depth;
  };
  for (int k = 0; k < chain.spans(); ++k) {
    std::vector<Open> stack = {{SpanOf(chain, k), chain.breaks[At(k)], chain.breaks[At(k + 1)], 0}};
    while (!stack.empty()) {
      const Open open = std::move(stack.back());
      stack.pop_back();
      if (open.depth < 30 && (open.depth < 2 || Sag(open.part.points) > flatness)) {
        const double middle = 0.5 * (open.t0 + open.t1);
        stack.push_back({Part(open.part, 0.5, 1.0), middle, open.t1, open.depth + 1});
        stack.push_back({Part(open.part, 0.0, 0.5), open.t0, middle, open.depth + 1});
        continue;
      }
      pieces.push_back({curve, open.t0, open.t1, open.part.points.front(), open.part.points.back()});
      if (pieces.size() > kMaxFlatPieces) return false;
    }
  }
  return true;
}

double PieceDistance(const FlatPiece& p, const FlatPiece& q) {
  // Two segments are nearest at an end of one of them, or where their lines are nearest.
  double best = std::min({SegmentDistance(p.a, q.a, q.b), SegmentDistance(p.b, q.a, q.b),
                          SegmentDistance(q.a, p.a, p.b), SegmentDistance(q.b, p.a, p.b)});
  const Vec3 u = p.b - p.a, v = q.b - q.a, w = p.a - q.a;
  const double uu = u.dot(u), uv = u.dot(v), vv = v.dot(v), det = uu * vv - uv * uv;
  if (det > 1e-14 * uu * vv) {
    const double s = (uv * v.dot(w) - vv * u.dot(w)) / det, t = (uu * v.dot(w) - uv * u.dot(w)) / det;
    if (s >= 0 && s <= 1 && t >= 0 && t <= 1) best = std::min(best, (w + s * u - t * v).norm());
  }
  return best;
}

// The nearest places of two curves, from a start, by damped Gauss-Newton steps within the domains.
Meeting Nearest(const std::vector<DrawnCurve>& curves, Meeting m) {
  const BezierChain &a = curves[At(m.a.curve)].chain, &b = curves[At(m.b.curve)].chain;
  double damping = 1e-9;
  CurveJet p = Evaluate(a, m.a.t), q = Evaluate(b, m.b.t);
  double now = (p.p - q.p).squaredNorm();
  for (int round = 0; round < 60; ++round) {
    const Vec3 r = p.p - q.p;
    const double pp = p.d.squaredNorm(), qq = q.d.squaredNorm(), pq = p.d.dot(q.d);
    const double gp = p.d.dot(r), gq = -q.d.dot(r);
    double ds = 0.0, dt = 0.0;
    const bool hold_s = (m.a.t <= 0.0 && gp > 0) || (m.a.t >= 1.0 && gp < 0);
    const bool hold_t = (m.b.t <= 0.0 && gq > 0) || (m.b.t >= 1.0 && gq < 0);
    const double hp = pp * (1 + damping), hq = qq * (1 + damping);
    if (hold_s && hold_t) break;
    if (hold_s) {
      dt = hq > 0 ? -gq / hq : 0;
    } else if (hold_t) {
      ds = hp > 0 ? -gp / hp : 0;
    } else {
      const double det = hp * hq - pq * pq;
      if (!(det > 0)) break;
      ds = (-gp * hq - gq * pq) / det;
      dt = (-gq * hp - gp * pq) / det;
    }
    const double s = std::clamp(m.a.t + ds, 0.0, 1.0), t = std::clamp(m.b.t + dt, 0.0, 1.0);
    const CurveJet np = Evaluate(a, s), nq = Evaluate(b, t);
    const double next = (np.p - nq.p).squaredNorm();
    const double moved = std::max(std::abs(s - m.a.t), std::abs(t - m.b.t));
    if (next > now) {
      if (moved < 1e-13) break;
      damping = std::max(1e-4, damping * 16);
      if (damping > 1e12) break;
      continue;
    }
    damping *= 0.1;
    m.a.t = s, m.b.t = t, p = np, q = nq, now = next;
    if (moved < 1e-14) break;
  }
  m.distance = std::sqrt(now);
  return m;
}

double AngleBetween(const Vec3& a, const Vec3& b) {
  return Degrees(std::atan2(a.cross(b).norm(), std::abs(a.dot(b))));
}

struct PairFinder {
  const std::vector<DrawnCurve>& curves;
  const std::vector<FlatPiece>& pieces;
  double tolerance;
  std::vector<double> lengths;
  Crossings& found;

  // Near pairs of pieces of two curves, the first curve's in order.
  void Between(const std::vector<std::array<int, 2>>& near) {
    const int a = pieces[At(near[0][0])].curve, b = pieces[At(near[0][1])].curve;
    struct Sample {
      double s, t, distance, at;  // `at`: length along the first curve
    };
    std::vector<Sample> samples;
    std::size_t k = 0;
    while (k < near.size()) {
      const std::size_t first = k;
      while (k < near.size() && near[k][0] == near[first][0]) ++k;
      const FlatPiece& piece = pieces[At(near[first][0])];
      for (int i = 0; i <= kSamplesPerPiece; ++i) {
        const double s = std::lerp(piece.t0, piece.t1, i / double(kSamplesPerPiece));
        const Vec3 p = Evaluate(curves[At(a)].chain, s).p;
        double best = kInfinity, start = 0.0;
        for (std::size_t n = first; n < k; ++n) {
          const FlatPiece& other = pieces[At(near[n][1])];
          const double x = SegmentFoot(p, other.a, other.b);
          const double d = (p - other.a - x * (other.b - other.a)).norm();
          if (d < best) best = d, start = std::lerp(other.t0, other.t1, x);
        }
        const double t = FootFrom(curves[At(b)].chain, start, p);
        samples.push_back({s, t, (p - Evaluate(curves[At(b)].chain, t).p).norm(), 0.0});
      }
      // The exact nearest places that this piece leads to: a crossing may fall between two samples.
      for (std::size_t n = first; n < k; ++n) {
        const FlatPiece& other = pieces[At(near[n][1])];
        const Meeting m =
            Nearest(curves, {{a, 0.5 * (piece.t0 + piece.t1)}, {b, 0.5 * (other.t0 + other.t1)}, 0.0});
        if (m.distance <= tolerance) samples.push_back({m.a.t, m.b.t, m.distance, 0.0});
      }
    }
    // The ends of the second curve, which seldom are places of samples.
    for (const double t : {0.0, 1.0}) {
      const auto nearest = std::ranges::min_element(
          samples, [&](const Sample& x, const Sample& y) { return std::abs(x.t - t) < std::abs(y.t - t); });
      const Vec3 end = Evaluate(curves[At(b)].chain, t).p;
      const double s = FootFrom(curves[At(a)].chain, nearest->s, end);
      samples.push_back({s, t, (end - Evaluate(curves[At(a)].chain, s).p).norm(), 0.0});
    }
    std::erase_if(samples, [&](const Sample& s) { return !(s.distance <= tolerance); });
    std::ranges::sort(
        samples, [](const Sample& x, const Sample& y) { return std::tie(x.s, x.t) < std::tie(y.s, y.t); });
    const auto gap = [&](const Sample& x, const Sample& y) {
      const Vec3 from = Evaluate(curves[At(a)].chain, x.s).p, to = Evaluate(curves[At(a)].chain, y.s).p;
      return (to - from).norm();
    };
    // Runs along the first curve on which the second keeps near, at one place of it.
    std::vector<std::vector<Sample>> runs;
    for (const Sample& s : samples) {
      bool placed = false;
      for (auto run = runs.rbegin(); run != runs.rend() && !placed; ++run) {
        const Sample& last = run->back();
        const double step = gap(last, s);
        const double other =
            (Evaluate(curves[At(b)].chain, last.t).p - Evaluate(curves[At(b)].chain, s.t).p).norm();
        const double middle_s = 0.5 * (last.s + s.s), middle_t = 0.5 * (last.t + s.t);
        const bool together =
            std::max(step, other) <= 2 * tolerance ||
            ((Evaluate(curves[At(a)].chain, middle_s).p - Evaluate(curves[At(b)].chain, middle_t).p).norm() <=
                 2 * tolerance &&
             other <= 3 * step + tolerance && step <= 0.2 * std::min(lengths[At(a)], lengths[At(b)]));
        if (!together) continue;
        run->push_back(s);
        placed = true;
      }
      if (!placed) runs.push_back({s});
    }
    for (const auto& r : runs) {
      const auto best = std::ranges::min_element(
          r, [](const Sample& x, const Sample& y) { return x.distance < y.distance; });
      const auto [low, high] =
          std::minmax_element(r.begin(), r.end(), [](const Sample& x, const Sample& y) { return x.t < y.t; });
      Run(a, b, {r.front().s, r.back().s, low->t, high->t, r.front().t, r.back().t, best->s, best->t});
    }
  }

 private:
  struct Stretch {
    double s0, s1, t_low, t_high, t0, t1, s, t;
  };

  void Run(int a, int b, const Stretch& at) {
    const BezierChain &ca = curves[At(a)].chain, &cb = curves[At(b)].chain;
    Meeting m = Nearest(curves, {{a, at.s}, {b, at.t}, 0.0});
    const double length = std::max(LengthBetween(ca, at.s0, at.s1), LengthBetween(cb, at.t_low, at.t_high));
    const double shorter = std::min(lengths[At(a)], lengths[At(b)]);
    const double angle = AngleBetween(Evaluate(ca, m.a.t).d, Evaluate(cb, m.b.t).d);
    if (length >= kDoubledShare * shorter && length > 4 * tolerance && angle < 45.0) {
      return Doubled(a, b, at);
    }
    const bool end_a = at.s0 <= 0.0 || at.s1 >= 1.0, end_b = at.t_low <= 0.0 || at.t_high >= 1.0;
    if (angle >= kParallel || end_a || end_b) {
      if (angle < kParallel && end_a) {
        m.a.t = at.s0 <= 0.0 ? 0.0 : 1.0;
        m.b.t = FootFrom(cb, at.s0 <= 0.0 ? at.t0 : at.t1, Evaluate(ca, m.a.t).p);
      } else if (angle < kParallel && end_b) {
        m.b.t = at.t_low <= 0.0 ? 0.0 : 1.0;
        m.a.t = FootFrom(ca, at.s, Evaluate(cb, m.b.t).p);
      }
      m.distance = (Evaluate(ca, m.a.t).p - Evaluate(cb, m.b.t).p).norm();
      found.meetings.push_back(m);
      return;
    }
    found.touches.push_back({m.a, m.b, length});
  }

  void Doubled(int a, int b, const Stretch& at) {
    const bool drop_a = lengths[At(a)] < lengths[At(b)];
    const int dropped = drop_a ? a : b;
    const double from = drop_a ? at.s0 : at.t_low, to = drop_a ? at.s1 : at.t_high;
    const bool whole =
        LengthBetween(curves[At(dropped)].chain, from, to) >= kWholeShare * lengths[At(dropped)];
    found.doubled.push_back({dropped, from, to, drop_a ? b : a, whole});
    if (whole) return;
    for (const bool first : {true, false}) {
      const double t = first ? from : to;
      if (t <= 0.0 || t >= 1.0) continue;
      const bool start = drop_a ? first : (first == (at.t0 <= at.t1));
      found.meetings.push_back({{a, start ? at.s0 : at.s1}, {b, start ? at.t0 : at.t1}, tolerance});
    }
  }
};

// Places at which a curve meets itself: near in space, far along the curve.
void SelfMeetings(const std::vector<DrawnCurve>& curves, const std::vector<FlatPiece>& pieces,
                  const std::vector<std::array<int, 2>>& near, double tolerance,
                  std::vector<Meeting>& meetings) {
  const std::size_t first = meetings.size();
  for (const auto& [i, j] : near) {
    const FlatPiece &p = pieces[At(i)], &q = pieces[At(j)];
    Meeting m = Nearest(curves, {{p.curve, 0.5 * (p.t0 + p.t1)}, {q.curve, 0.5 * (q.t0 + q.t1)}, 0.0});
    if (m.a.t > m.b.t) std::swap(m.a, m.b);
    if (m.distance > tolerance) continue;
    const BezierChain& chain = curves[At(p.curve)].chain;
    const Vec3 middle = Evaluate(chain, 0.5 * (m.a.t + m.b.t)).p;
    if (LengthBetween(chain, m.a.t, m.b.t) <= 8 * tolerance ||
        (middle - Evaluate(chain, m.a.t).p).norm() <= 2 * tolerance) {
      continue;
    }
    const bool ends = m.a.t <= 0.0 && m.b.t >= 1.0;
    if (!ends && AngleBetween(Evaluate(chain, m.a.t).d, Evaluate(chain, m.b.t).d) < kParallel) continue;
    const bool known = std::any_of(
        meetings.begin() + static_cast<std::ptrdiff_t>(first), meetings.end(), [&](const Meeting& o) {
          return o.a.curve == m.a.curve && std::abs(o.a.t - m.a.t) < 1e-3 && std::abs(o.b.t - m.b.t) < 1e-3;
        });
    if (!known) meetings.push_back(m);
  }
}

}  // namespace

double LengthBetween(const BezierChain& chain, double from, double to) {
  if (from > to) std::swap(from, to);
  double length = 0.0;
  for (int k = 0; k < chain.spans(); ++k) {
    const double a = std::max(from, chain.breaks[At(k)]), b = std::min(to, chain.breaks[At(k + 1)]);
    if (!(a < b)) continue;
    constexpr int kSteps = 8;
    Vec3 before = Evaluate(chain, a).p;
    for (int i = 1; i <= kSteps; ++i) {
      const Vec3 p = Evaluate(chain, std::lerp(a, b, i / double(kSteps))).p;
      length += (p - before).norm();
      before = p;
    }
  }
  return length;
}

double FootFrom(const BezierChain& chain, double t, const Vec3& p) {
  CurveJet jet = Evaluate(chain, t);
  double now = (jet.p - p).squaredNorm();
  for (int round = 0; round < 40; ++round) {
    const double g = jet.d.dot(jet.p - p), gauss = jet.d.squaredNorm();
    const double newton = gauss + jet.dd.dot(jet.p - p);
    const double h = newton > 0.1 * gauss ? newton : gauss;
    if (!(h > 0.0)) break;
    double step = -g / h;
    bool better = false;
    for (int half = 0; half < 30 && !better; ++half, step *= 0.5) {
      const double next = std::clamp(t + step, 0.0, 1.0);
      if (next == t) return t;
      const CurveJet there = Evaluate(chain, next);
      const double distance = (there.p - p).squaredNorm();
      if (distance > now || (distance == now && half > 0)) continue;
      better = true;
      const bool done = std::abs(next - t) < 1e-15;
      t = next, jet = there, now = distance;
      if (done) return t;
    }
    if (!better) break;
  }
  return t;
}

absl::StatusOr<Crossings> FindCrossings(const std::vector<DrawnCurve>& curves, double tolerance,
                                        const RunContext& run) {
  std::vector<FlatPiece> pieces;
  std::vector<double> lengths;
  const double flatness = 0.25 * tolerance;
  for (int c = 0; c < static_cast<int>(curves.size()); ++c) {
    PM_RETURN_IF_ERROR(run.Check());
    if (!Flatten(c, curves[At(c)].chain, flatness, pieces)) {
      return FieldError("tolerance_mm",
                        fmt::format("= {:g}; is too small for these curves: they would be cut "
                                    "into more than {} straight pieces",
                                    tolerance, kMaxFlatPieces));
    }
    lengths.push_back(LengthBetween(curves[At(c)].chain, 0.0, 1.0));
  }
  std::vector<Box3> boxes(pieces.size());
  std::vector<double> reach(pieces.size());
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    boxes[i].Add(pieces[i].a), boxes[i].Add(pieces[i].b);
    reach[i] = 0.5 * (boxes[i].max - boxes[i].min).maxCoeff() + tolerance + 2 * flatness;
  }
  const BoxTree tree(boxes);
  std::map<std::array<int, 2>, std::vector<std::array<int, 2>>> pairs;
  std::size_t near_pairs = 0;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    if (i % 64 == 0) PM_RETURN_IF_ERROR(run.Check());
    tree.Near(boxes[i].Center(), reach[i], [&](int j) {
      const FlatPiece &p = pieces[i], &q = pieces[At(j)];
      if (j <= static_cast<int>(i) + (p.curve == q.curve ? 1 : 0)) return true;
      if (PieceDistance(p, q) > tolerance + 2 * flatness) return true;
      pairs[{p.curve, q.curve}].push_back({static_cast<int>(i), j});
      return ++near_pairs <= 4 * kMaxFlatPieces;
    });
    if (near_pairs > 4 * kMaxFlatPieces) {
      return FieldError("tolerance_mm",
                        fmt::format("= {:g}; is too large for these curves: nearly all of them "
                                    "come within it of each other",
                                    tolerance));
    }
  }
  Crossings found;
  PairFinder finder{curves, pieces, tolerance, lengths, found};
  for (auto& [pair, near] : pairs) {
    PM_RETURN_IF_ERROR(run.Check());
    std::ranges::sort(near);
    if (pair[0] == pair[1]) {
      SelfMeetings(curves, pieces, near, tolerance, found.meetings);
    } else {
      finder.Between(near);
    }
  }
  return found;
}

}  // namespace patchmill
