#include "cam/path/contour/spiral_paths.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "cam/path/chord/certify_centers.h"
#include "cam/path/chord/chord_bounds.h"
#include "cam/path/chord/chord_supports.h"
#include "cam/path/chord/chord_thinning.h"
#include "cam/path/stepover/step_over.h"
#include "cam/path/zlevel/level_oracle.h"
#include "cam/path/zlevel/level_trace.h"
#include "cam/path/zlevel/loop_refine.h"
#include "core/base/parallel.h"
#include "core/base/status.h"

namespace patchmill {
namespace {

// Flat step-overs: contours that are farther apart anywhere do not belong together. Full levels lie up to two
// apart, and twice that on the surface where they pass a saddle.
constexpr double kMaxTurnGap = 4.0;
constexpr double kBackOff = 0.02;  // radii: how far behind the upper contour the way out begins
constexpr double kNoWay = 1e-6;    // mm: contours this near to each other leave the way out to the normal
constexpr int kMostHalvings = 24;  // of a chord

Vec2 OutwardOf(const CutterPoint& p) {
  const auto from = [&](const SurfacePoint& contact) -> Vec2 {
    const Vec2 d = Xy(Vec3(p.center - contact.p));
    const double length = d.norm();
    return length > 0.0 ? Vec2(d / length) : Vec2(Vec2::Zero());
  };
  Vec2 out = p.contact ? from(*p.contact) : Vec2(Vec2::Zero());
  if (p.other_contact) out += from(*p.other_contact);
  const double length = out.norm();
  return length > 1e-6 ? Vec2(out / length) : Vec2(Vec2::Zero());
}

const SurfacePoint& After(const CutterPoint& p) { return p.other_contact ? *p.other_contact : *p.contact; }

// Returns what the ball at a centre touches. Where the shank touches it is the wall beside the centre.
Support ContactPoints(const Vec3& center, const SurfacePoint& contact) {
  return {Vec3(Lift(Xy(contact.p), std::min(contact.p.z(), center.z()))), -kInfinity};
}

// Does the chord keep the tolerances on both sides?
bool Proven(const CutterPoint& a, const CutterPoint& b, const Locator& locator,
            const LoopTolerance& tolerance) {
  const double radius = locator.radius(), length = (b.center - a.center).norm();
  if (ChordGouge(radius, length) > tolerance.gouge) return false;
  const SurfacePoint &from = After(a), &to = *b.contact;
  const Support left = ContactPoints(a.center, from), right = ContactPoints(b.center, to);
  if (ChordExcess(radius, a.center, b.center, left, right) <= tolerance.excess) return true;
  if (from.piece.value != to.piece.value) return false;
  const int parts = SupportParts(radius, length, tolerance.excess);
  const std::vector<Support> between = SupportsBetween(locator.surface(), from, to, parts, -kInfinity);
  return ExcessWithin(radius, {a.center, b.center, left, right, between}, tolerance.excess);
}

// A closed contour, parametrised by its length in plan.
class Loop {
 public:
  explicit Loop(std::vector<CutterPoint> points) : points_(std::move(points)), at_(points_.size() + 1, 0.0) {
    for (std::size_t i = 0; i < points_.size(); ++i) at_[i + 1] = at_[i] + (Place(i + 1) - Place(i)).norm();
  }
  const std::vector<CutterPoint>& points() const { return points_; }
  double length() const { return at_.back(); }
  double z() const { return points_.front().center.z(); }
  Vec2 Place(std::size_t i) const { return Xy(points_[i % points_.size()].center); }
  double At(std::size_t i) const { return at_[i]; }

  Vec2 PlaceAt(double s) const {
    const std::size_t i = SegmentAt(s);
    const double d = at_[i + 1] - at_[i];
    return d > 0.0 ? Vec2(Place(i) + (s - at_[i]) / d * (Place(i + 1) - Place(i))) : Place(i);
  }
  std::size_t SegmentAt(double s) const {
    const auto after = std::upper_bound(at_.begin(), at_.end(), s);
    return std::min(static_cast<std::size_t>(std::max<std::ptrdiff_t>(0, after - at_.begin() - 1)),
                    points_.size() - 1);
  }
  struct Foot {
    double s = 0.0, distance = kInfinity;
  };
  // Returns the place nearest to q, on segments [first, last) only.
  Foot Nearest(const Vec2& q, std::size_t first, std::size_t last) const {
    Foot best;
    for (std::size_t i = first; i < last; ++i) {
      const Vec2 a = Place(i), d = Place(i + 1) - a;
      const double l2 = d.squaredNorm();
      const double t = l2 > 0.0 ? std::clamp((q - a).dot(d) / l2, 0.0, 1.0) : 0.0;
      const double distance = (q - a - t * d).norm();
      if (distance < best.distance) best = {at_[i] + t * (at_[i + 1] - at_[i]), distance};
    }
    return best;
  }
  double Area() const {
    double twice = 0.0;
    for (std::size_t i = 0; i < points_.size(); ++i) twice += Cross(Place(i), Place(i + 1));
    return 0.5 * twice;
  }
  // Returns the same contour begun at the segment beside `start`, with `start` as its first point.
  Loop BegunAt(const CutterPoint& start) const {
    const std::size_t segment = SegmentAt(Nearest(Xy(start.center), 0, points_.size()).s);
    std::vector<CutterPoint> points = {start};
    for (std::size_t k = 1; k <= points_.size(); ++k) {
      const CutterPoint& p = points_[(segment + k) % points_.size()];
      if ((p.center - start.center).norm() > 1e-9) points.push_back(p);
    }
    return Loop(std::move(points));
  }

 private:
  std::vector<CutterPoint> points_;
  std::vector<double> at_;
};

bool RunsBeside(const Loop& a, const Loop& b, double most) {
  for (std::size_t i = 0; i < a.points().size(); ++i) {
    const Loop::Foot foot = b.Nearest(a.Place(i), 0, b.points().size());
    if (std::hypot(foot.distance, a.z() - b.z()) > most) return false;
  }
  return true;
}

// One turn from `upper`, which begins where the last turn ended, down to `lower`.
class Turn {
 public:
  Turn(const LevelContext& context, const Loop& upper, const Loop& lower, const LoopTolerance& tolerance)
      : context_(context),
        upper_(upper),
        // It begins beside the upper one's first point, so that feet run from 0 to its length.
        lower_(lower.BegunAt(AsPoint(lower, upper.Place(0)))),
        tolerance_(tolerance),
        radius_(context.locator.radius()) {}

  // Returns the points after the upper contour's first one; empty if one cannot be found or proven.
  std::vector<CutterPoint> Wind() {
    Match();
    CutterPoint last = upper_.points().front();
    double s = 0.0;
    for (std::size_t i = 1; i <= upper_.points().size(); ++i) {
      const std::optional<CutterPoint> next = At(upper_.At(i));
      if (!next || !Way(s, last, upper_.At(i), *next, 0)) return {};
      s = upper_.At(i);
      last = *next;
    }
    return std::move(points_);
  }

 private:
  static CutterPoint AsPoint(const Loop& loop, const Vec2& near) {
    const Loop::Foot foot = loop.Nearest(near, 0, loop.points().size());
    CutterPoint p = loop.points()[loop.SegmentAt(foot.s)];
    p.center = Lift(loop.PlaceAt(foot.s), loop.z());
    return p;
  }

  // Finds the feet of the upper contour's vertices on the lower one. They never go back.
  void Match() {
    const std::size_t n = upper_.points().size(), m = lower_.points().size();
    lower_places_.assign(n + 1, 0.0);
    for (std::size_t i = 1; i < n; ++i) {
      // A foot must lie at the same share of the way, to within a quarter of the length. So it does not lie
      // on the far side of a narrow neck.
      const double share = upper_.At(i) / upper_.length();
      const auto segment = [&](double part) {
        return std::min(m, lower_.SegmentAt(std::clamp(part, 0.0, 1.0) * lower_.length()));
      };
      const Loop::Foot foot =
          lower_.Nearest(upper_.Place(i), segment(share - 0.25), std::min(m, segment(share + 0.25) + 1));
      lower_places_[i] = std::max(lower_places_[i - 1], foot.s);
    }
    lower_places_[n] = lower_.length();
  }

  // Returns the point at length s of the upper contour, lowered by its share of the fall.
  std::optional<CutterPoint> At(double s) const {
    const std::size_t i = upper_.SegmentAt(s);
    const double span = upper_.At(i + 1) - upper_.At(i);
    const double part = span > 0.0 ? std::clamp((s - upper_.At(i)) / span, 0.0, 1.0) : 0.0;
    const Vec2 base = upper_.PlaceAt(s);
    const CutterPoint& vertex = upper_.points()[i];
    Vec2 way = lower_.PlaceAt(lower_places_[i] + part * (lower_places_[i + 1] - lower_places_[i])) - base;
    const Vec2 outward = OutwardOf(vertex);
    if (way.norm() < kNoWay || way.dot(outward) < 0.0) way = outward;
    if (way.norm() < kNoWay) return std::nullopt;
    way.normalize();
    const double z = upper_.z() + s / upper_.length() * (lower_.z() - upper_.z());
    const LevelOracle oracle(context_.locator, context_.sides, z);
    const Vec2 start = base - kBackOff * radius_ * way;
    const double reach = radius_;
    const LevelPoint out = oracle.Exit(start, After(vertex), way, reach);
    if ((out.q - start).norm() >= reach - 1e-9) return std::nullopt;  // the walk stopped there
    return CutterPoint{Lift(out.q, z), out.contact, out.other};
  }

  // Appends the points after a up to b, with every chord proven.
  bool Way(double sa, const CutterPoint& a, double sb, const CutterPoint& b, int depth) {
    if (Proven(a, b, context_.locator, tolerance_)) {
      points_.push_back(b);
      return true;
    }
    if (depth >= kMostHalvings) return false;
    const double middle = 0.5 * (sa + sb);
    const std::optional<CutterPoint> m = At(middle);
    return m && Way(sa, a, middle, *m, depth + 1) && Way(middle, *m, sb, b, depth + 1);
  }

  const LevelContext& context_;
  const Loop& upper_;
  const Loop lower_;
  const LoopTolerance tolerance_;
  const double radius_;
  std::vector<double> lower_places_;
  std::vector<CutterPoint> points_;
};

// Are the chords between a new first point of a contour and its neighbours within the tolerances?
bool ClosesWithin(const Loop& loop, const Locator& locator, const LoopTolerance& both) {
  const std::vector<CutterPoint>& points = loop.points();
  return Proven(points[0], points[1], locator, both) && Proven(points.back(), points[0], locator, both);
}

// For each closed contour, returns the one closed contour of the next line that it runs beside; -1: none.
// Each contour follows at most one other.
std::vector<int> Followers(const std::vector<CutterPath>& contours, double most) {
  std::map<int, std::vector<std::size_t>> lines;
  for (std::size_t i = 0; i < contours.size(); ++i) {
    const CutterPath& c = contours[i];
    const bool touches = std::all_of(c.points.begin(), c.points.end(),
                                     [](const CutterPoint& p) { return p.contact.has_value(); });
    if (c.kind == PassKind::kContour && c.closed && c.points.size() > 2 && touches)
      lines[c.order_key].push_back(i);
  }
  std::vector<int> below(contours.size(), -1);
  std::vector<char> taken(contours.size(), 0);
  for (const auto& [line, upper] : lines) {
    const auto next = lines.find(line + 1);
    if (next == lines.end()) continue;
    for (const std::size_t i : upper) {
      const Loop a(contours[i].points);
      for (const std::size_t k : next->second) {
        const Loop b(contours[k].points);
        if (taken[k] || b.z() >= a.z() || a.Area() * b.Area() <= 0.0) continue;
        if (!RunsBeside(a, b, most) || !RunsBeside(b, a, most)) continue;
        below[i] = static_cast<int>(k);
        taken[k] = 1;
        break;
      }
    }
  }
  return below;
}

}  // namespace

absl::StatusOr<std::vector<CutterPath>> SpiralPaths(const Locator& locator, std::vector<CutterPath> contours,
                                                    const PassParams& params, bool backwards,
                                                    const RunContext& run) {
  const double radius = locator.radius();
  const LoopTolerance tolerance{params.chord_tolerance, ExcessTolerance(params)};
  const LevelContext context(locator, run);
  PM_RETURN_IF_ERROR(run.Check());
  const std::vector<int> below = Followers(contours, kMaxTurnGap * CenterStep(radius, params.scallop, 0.0));
  std::vector<char> follows(contours.size(), 0);
  for (const int k : below) {
    if (k >= 0) follows[static_cast<std::size_t>(k)] = 1;
  }
  std::vector<std::size_t> tops;
  for (std::size_t i = 0; i < contours.size(); ++i) {
    if (below[i] >= 0 && !follows[i]) tops.push_back(i);
  }
  // Each turn begins where the last one ended, so turns are made one after the other. Chains run in parallel.
  std::vector<std::vector<CutterPath>> spirals(tops.size());
  const auto loop_of = [&](std::size_t i) {
    std::vector<CutterPoint> points = contours[i].points;
    if (backwards) {
      std::reverse(points.begin(), points.end());
      for (CutterPoint& p : points) {
        if (p.other_contact) std::swap(p.contact, p.other_contact);
      }
    }
    return Loop(std::move(points));
  };
  PM_RETURN_IF_ERROR(ParallelFor(run, nullptr, tops.size(), [&](std::size_t t) {
    std::size_t at = tops[t];
    CutterPath spiral = contours[at];
    Loop loop = loop_of(at);
    std::vector<CutterPoint> points;
    const auto finish = [&] {
      if (points.empty()) {
        spiral = contours[at];
      } else {
        points.insert(points.end(), loop.points().begin() + 1, loop.points().end());
        points.push_back(loop.points().front());
        spiral.closed = false;
        spiral.traversal = Traversal::kSpiral;
        spiral.points = std::move(points);
        CertifyCenters(locator, CertificateGap(params), spiral);
        points.clear();
      }
      spirals[t].push_back(std::move(spiral));
    };
    while (below[at] >= 0 && !run.Cancelled()) {
      const auto next = static_cast<std::size_t>(below[at]);
      const Loop lower = loop_of(next);
      const std::vector<CutterPoint> turn = Turn(context, loop, lower, tolerance).Wind();
      std::optional<Loop> begun;
      if (!turn.empty()) begun = lower.BegunAt(turn.back());
      if (begun && ClosesWithin(*begun, locator, tolerance)) {
        if (points.empty()) {
          points = loop.points();
          points.push_back(loop.points().front());
        }
        points.insert(points.end(), turn.begin(), turn.end());
        loop = *std::move(begun);
      } else {
        finish();
        spiral = contours[next];
        loop = lower;
      }
      at = next;
    }
    finish();
  }));
  std::vector<CutterPath> out;
  std::size_t t = 0;
  for (std::size_t i = 0; i < contours.size(); ++i) {
    if (t < tops.size() && tops[t] == i) {
      for (CutterPath& spiral : spirals[t++]) out.push_back(std::move(spiral));
    } else if (!follows[i]) {
      out.push_back(std::move(contours[i]));
    }
  }
  return out;
}

}  // namespace patchmill
