#include "cam/path/rest/pencil_trace.h"

#include <algorithm>
#include <cmath>

#include "cam/path/chord/chord_bounds.h"
#include "cam/path/chord/chord_thinning.h"

namespace patchmill {
namespace {

constexpr double kSmallestAngle = 0.1;  // rad between the two contact directions
constexpr double kSteepest = 0.05;  // n_z of a contact direction below which a branch is too steep to follow
constexpr double kThirdBranch = 1e-6;  // mm by which another branch must rise above the crease to take over
// Most stations of one run.
constexpr std::size_t kMostStations = 20000;

class PencilTracer {
 public:
  PencilTracer(const Locator& locator, const SheetBorder& border, const PassParams& params)
      : locator_(locator),
        border_(border),
        radius_(locator.radius()),
        tolerance_(params.chord_tolerance - CertificateGap(params)),
        floor_center_(params.floor_z + locator.radius()) {}

  // Returns the crease point on the line q + s m nearest to s = 0, found from contacts near it.
  std::optional<PencilPoint> Correct(const Vec2& q, const Vec2& m, const PencilPoint& near,
                                     double reach) const;
  bool Valid(const PencilPoint& p) const;
  std::optional<Vec2> Direction(const PencilPoint& p) const;
  std::optional<PencilPoint> Advance(const PencilPoint& from, const Vec2& heading, double step) const;
  bool ChordIsGood(const PencilPoint& a, const PencilPoint& b) const;
  struct Run {
    std::vector<PencilPoint> points;
    bool ring = false;  // the run came back to the seed
  };
  Run Follow(const PencilPoint& seed, double sign, const PencilWanted& wanted) const;

 private:
  Vec3 DirectionTo(const PencilPoint& p, const SurfacePoint& contact) const {
    return (p.center - contact.p) / radius_;
  }
  // Returns the gradient in plan of the branch's centre height.
  Vec2 Gradient(const Vec3& center, const SurfacePoint& contact) const {
    const Vec3 n = center - contact.p;
    return -Xy(n) / n.z();
  }

  const Locator& locator_;
  const SheetBorder& border_;
  const double radius_;
  const double tolerance_;
  const double floor_center_;
};

std::optional<PencilPoint> PencilTracer::Correct(const Vec2& q, const Vec2& m, const PencilPoint& near,
                                                 double reach) const {
  SurfacePoint a = near.first, b = near.second;
  double s = 0.0;
  for (int i = 0; i < 20; ++i) {
    const Vec2 at = q + s * m;
    const auto ca = locator_.Follow(a, at), cb = locator_.Follow(b, at);
    if (!ca || !cb) return std::nullopt;
    a = ca->contact;
    b = cb->contact;
    const PencilPoint p{Lift(at, std::max(ca->z, cb->z)), a, b};
    const double f = ca->z - cb->z;
    const double slope = (Gradient(Lift(at, ca->z), a) - Gradient(Lift(at, cb->z), b)).dot(m);
    if (std::abs(f) <= 1e-12 * std::max(1.0, std::abs(p.center.z()))) return p;
    const double move = -f / slope;
    if (!(std::abs(s + move) <= reach)) return std::nullopt;
    s += move;
    if (std::abs(move) < 1e-10) return p;
  }
  return std::nullopt;
}

bool PencilTracer::Valid(const PencilPoint& p) const {
  const Vec3 na = DirectionTo(p, p.first), nb = DirectionTo(p, p.second);
  if (na.cross(nb).norm() < kSmallestAngle || na.z() < kSteepest || nb.z() < kSteepest) return false;
  if (p.center.z() < floor_center_) return false;
  if (!border_.Allowed(p.first, na) || !border_.Allowed(p.second, nb)) return false;
  const auto h = locator_.Height(Xy(p.center), &p.first);
  return h && h->z <= p.center.z() + kThirdBranch;
}

std::optional<Vec2> PencilTracer::Direction(const PencilPoint& p) const {
  const Vec2 d = Gradient(p.center, p.first) - Gradient(p.center, p.second);
  const double length = d.norm();
  if (!(length > 1e-6)) return std::nullopt;
  return Vec2(-d.y() / length, d.x() / length);
}

std::optional<PencilPoint> PencilTracer::Advance(const PencilPoint& from, const Vec2& heading,
                                                 double step) const {
  const double rise = Gradient(from.center, from.first).dot(heading);
  const Vec2 q = Xy(from.center) + step / std::sqrt(1.0 + rise * rise) * heading;
  auto next = Correct(q, {-heading.y(), heading.x()}, from, step);
  if (!next || !Valid(*next) || !ChordIsGood(from, *next)) return std::nullopt;
  return next;
}

bool PencilTracer::ChordIsGood(const PencilPoint& a, const PencilPoint& b) const {
  if (ChordGouge(radius_, (b.center - a.center).norm()) > tolerance_) return false;
  const auto excess = [&](const SurfacePoint& p, const SurfacePoint& q) {
    return ChordExcess(radius_, a.center, b.center, {p.p, floor_center_}, {q.p, floor_center_});
  };
  return std::min(excess(a.first, b.first), excess(a.second, b.second)) <= tolerance_;
}

PencilTracer::Run PencilTracer::Follow(const PencilPoint& seed, double sign,
                                       const PencilWanted& wanted) const {
  Run run;
  std::vector<PencilPoint>& out = run.points;
  const auto start = Direction(seed);
  if (!start) return run;
  const double full = LongestChord(radius_, 0.95 * tolerance_);
  Vec2 heading = sign * *start;
  PencilPoint at = seed;
  std::size_t keep = 0;
  double unwanted = 0.0, step = full;
  while (out.size() < kMostStations && unwanted <= wanted.patience) {
    // If the seed lies ahead within a step, the chord to it closes the ring, if need be after a shorter step.
    const Vec3 back = seed.center - at.center;
    const bool round = out.size() > 4 && back.norm() <= step && Xy(back).dot(heading) > 0.0;
    if (round && ChordIsGood(at, seed)) {
      run.ring = true;
      return run;
    }
    const auto next = round ? std::nullopt : Advance(at, heading, step);
    if (!next) {
      step *= 0.5;
      if (step < 1e-3 * full) break;
      continue;
    }
    unwanted += (next->center - at.center).norm();
    out.push_back(*next);
    if (wanted.center(next->center)) {
      unwanted = 0.0;
      keep = out.size();
    }
    const auto turn = Direction(*next);
    if (!turn) break;
    heading = turn->dot(heading) >= 0 ? *turn : Vec2(-*turn);
    at = *next;
    step = std::min(full, 2.0 * step);
  }
  out.resize(keep);
  return run;
}

}  // namespace

std::optional<PencilPoint> FindPencilPoint(const Locator& locator, const Vec2& q, double reach,
                                           const PassParams& params, const RunContext& run) {
  std::optional<PencilPoint> best;
  double best_distance = reach;
  // rad: two directions in plan that are unlikely to be those of a part's own edges.
  constexpr double kHeading = 0.4;
  for (double heading : {kHeading, kHeading + kPi / 2}) {
    const Vec2 d(std::cos(heading), std::sin(heading));
    const XyLine line = XyLine::Through(q - 1.5 * reach * d, q + 1.5 * reach * d);
    const SegmentTraceParams trace{.chord_tolerance = params.chord_tolerance,
                                   .floor_center = params.floor_z + locator.radius(),
                                   .run = &run};
    for (const auto& stations : TraceSegment(locator, line, trace)) {
      for (const TraceStation& s : stations) {
        if (!s.keep || !s.left || !s.right) continue;
        const PencilPoint p{Lift(s.q, s.z), *s.left, *s.right};
        const Vec3 na = (p.center - p.first.p).normalized(), nb = (p.center - p.second.p).normalized();
        if (na.cross(nb).norm() < kSmallestAngle) continue;
        const double distance = (s.q - q).norm();
        if (distance < best_distance) {
          best_distance = distance;
          best = p;
        }
      }
    }
  }
  return best;
}

std::vector<TraceStation> TracePencil(const Locator& locator, const SheetBorder& border,
                                      const PencilPoint& seed, const PassParams& params,
                                      const PencilWanted& wanted) {
  const PencilTracer tracer(locator, border, params);
  PencilTracer::Run onward = tracer.Follow(seed, 1.0, wanted);
  std::vector<PencilPoint> points;
  if (!onward.ring) {
    points = tracer.Follow(seed, -1.0, wanted).points;
    std::reverse(points.begin(), points.end());
  }
  points.push_back(seed);
  points.insert(points.end(), onward.points.begin(), onward.points.end());
  if (onward.ring) points.push_back(seed);
  std::vector<TraceStation> stations;
  double t = 0.0;
  for (const PencilPoint& p : points) {
    const Vec2 q = Xy(p.center);
    if (!stations.empty()) t += (q - stations.back().q).norm();
    TraceStation s;
    s.t = t;
    s.q = s.at = q;
    s.z = p.center.z();
    s.left = p.first;
    s.right = p.second;
    s.hint = p.first;
    stations.push_back(s);
  }
  return stations;
}

}  // namespace patchmill
