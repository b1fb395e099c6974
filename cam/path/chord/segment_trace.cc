#include "cam/path/chord/segment_trace.h"

#include <algorithm>
#include <cmath>

#include "cam/path/chord/chord_bounds.h"
#include "cam/path/chord/chord_supports.h"
#include "cam/path/chord/fewest_chords.h"

namespace patchmill {
namespace {

// mm: two heights closer than this belong to one branch. It is a hundred times the error of a local maximum.
constexpr double kSameHeight = 1e-7;
// mm: stations at a drop stand this far from the exact place of the wall, clear of rounding.
constexpr double kDropOffset = 1e-8;
// mm in plan: stations closer than this are the ends of a drop that could not be placed otherwise.
constexpr double kSmallestAdvance = 1e-7;
// mm along the line: switches are solved to this.
constexpr double kSwitchAccuracy = 1e-11;
// Most steps of a solver, and deepest halving at which switches and drops are still sought.
constexpr int kMaxIterations = 80;
// Parts of the permitted deviation that a predicted chord between vertices, and one between stations, uses.
// With these most chords pass their test at once.
constexpr double kOfChord = 0.85, kOfExcess = 0.6;
constexpr double kShortest = 0.125;  // of the chord that [location T2] allows: shortest first trial

struct BranchPoint {
  double z = 0.0;
  std::optional<SurfacePoint> contact;  // absent: the floor
};

class SegmentTracer {
 public:
  SegmentTracer(const Locator& locator, const XyLine& line, const SegmentTraceParams& params)
      : locator_(locator), line_(line), params_(params), radius_(locator.radius()) {}

  std::vector<std::vector<TraceStation>> Run();

 private:
  std::optional<TraceStation> Query(double t, const std::optional<SurfacePoint>& hint) const;
  std::optional<BranchPoint> Branch(const std::optional<SurfacePoint>& contact, double t) const;
  Vec3 Center(const TraceStation& s) const { return Lift(s.q, s.z); }
  Support SupportOf(const std::optional<SurfacePoint>& contact) const {
    return contact ? Support{contact->p, params_.floor_center} : Support{{}, params_.floor_center};
  }
  double DiscExit(const SurfacePoint& contact, double sign) const;
  std::optional<double> Bend() const;
  double NextChord() const;
  double NextAdvance(const TraceStation& s) const;
  // Are two contacts so far apart that the corner between them is worth a vertex of its own?
  bool Apart(const std::optional<SurfacePoint>& p, const std::optional<SurfacePoint>& q) const {
    return p.has_value() != q.has_value() || (p && (p->p - q->p).norm() > 1e-3 * radius_);
  }
  bool ChordIsGood(const TraceStation& a, const TraceStation& b) const;

  void Emit(const TraceStation& s);
  void BreakRun();
  void Refine(TraceStation a, TraceStation b, int depth);
  bool RefineAtSwitch(const TraceStation& a, const TraceStation& b, const BranchPoint& a_at_b,
                      const BranchPoint& b_at_a, int depth);
  bool RefineAtDrop(const TraceStation& a, const TraceStation& b, bool from_a, int depth);
  TraceStation LastBeforeGap(const TraceStation& from, double gap_t) const;

  const Locator& locator_;
  const XyLine& line_;
  const SegmentTraceParams& params_;
  const double radius_;
  std::vector<std::vector<TraceStation>> runs_;
};

std::optional<TraceStation> SegmentTracer::Query(double t, const std::optional<SurfacePoint>& hint) const {
  const Vec2 q = line_.At(t);
  TraceStation s;
  s.t = t;
  s.q = s.at = q;
  const SurfacePoint* near = hint ? &*hint : nullptr;
  if (params_.certificate_gap > 0.0) {
    const auto h = locator_.CertifiedHeight(q, params_.certificate_gap, near);
    if (!h) return std::nullopt;
    s.z = h->z;
    s.ceiling = h->z + h->gap;
    s.hint = h->contact;
  } else {
    const auto h = locator_.Height(q, near);
    if (!h) return std::nullopt;
    s.z = h->z;
    s.hint = h->contact;
  }
  s.left = s.right = s.hint;
  if (s.z < params_.floor_center) {
    s.z = params_.floor_center;
    s.ceiling = std::max(s.ceiling, s.z);
    s.left.reset();
    s.right.reset();
  }
  return s;
}

std::optional<BranchPoint> SegmentTracer::Branch(const std::optional<SurfacePoint>& contact, double t) const {
  if (!contact) return BranchPoint{params_.floor_center, {}};
  const auto c = locator_.Follow(*contact, line_.At(t));
  if (!c) return std::nullopt;
  return BranchPoint{c->z, c->contact};
}

// Returns where the line, going in direction `sign`, leaves the disc of radius R around the contact.
double SegmentTracer::DiscExit(const SurfacePoint& contact, double sign) const {
  const Vec2 d = Xy(contact.p) - line_.start;
  const double along = d.dot(line_.direction), across = Cross(line_.direction, d);
  return along + sign * std::sqrt(std::max(0.0, radius_ * radius_ - across * across));
}

// Returns how the curve of centres bends over the last three stations (1/mm, > 0 convex), or nullopt where
// they do not show it.
std::optional<double> SegmentTracer::Bend() const {
  if (runs_.empty() || runs_.back().size() < 3) return std::nullopt;
  const TraceStation* s = &*(runs_.back().end() - 3);
  if (s[1].keep || !(s[0].t < s[1].t && s[1].t < s[2].t)) return std::nullopt;
  const Vec3 a = Center(s[0]), ab = Center(s[1]) - a, ac = Center(s[2]) - a;
  const double sides = ab.norm() * ac.norm() * (ac - ab).norm();
  const double over = ab.z() * (s[2].t - s[0].t) - ac.z() * (s[1].t - s[0].t);
  return std::copysign(2.0 * ab.cross(ac).norm() / sides, over);
}

// Returns the longest next chord (mm) whose [location T2] gouge and T3 excess are within their tolerances, as
// far as the bend shows. A whole number of them makes a chord between vertices as long as FewestChords
// permits.
double SegmentTracer::NextChord() const {
  const double gouge = params_.chord_tolerance, excess = std::min(gouge, params_.excess_tolerance);
  const double chord = LongestChord(radius_, 0.97 * gouge);
  const std::optional<double> bend = Bend();
  if (!bend || *bend == 0.0) return chord;
  const auto reach = [&](double sagitta) { return std::sqrt(8.0 * sagitta / std::abs(*bend)); };
  const bool bulges = *bend > 0.0;
  const double most = bulges ? chord : std::min(chord, reach(kOfExcess * excess));
  const double whole = reach(kOfChord * (bulges ? gouge : DeepestVertex(gouge, excess) + excess));
  // The bend of stations too close to each other is mostly noise.
  return std::max(whole / std::ceil(whole / most), kShortest * chord);
}

// Returns the advance in plan that makes the next chord that long, from the slope under the ball.
double SegmentTracer::NextAdvance(const TraceStation& s) const {
  const double chord = NextChord();
  if (!s.right) return chord;
  const Vec3 n = Center(s) - s.right->p;
  const double along = Xy(n).dot(line_.direction);
  const double cosine = n.z() / std::hypot(along, n.z());
  // The slope may grow over the chord by about its length over R. A chord that fails is halved anyway.
  return chord * std::clamp(cosine - 0.02, 0.05, 1.0);
}

bool SegmentTracer::ChordIsGood(const TraceStation& a, const TraceStation& b) const {
  const Vec3 ca = Center(a), cb = Center(b);
  const double length = (cb - ca).norm(), limit = std::min(params_.chord_tolerance, params_.excess_tolerance);
  if (ChordGouge(radius_, length) > params_.chord_tolerance) return false;
  const Support left = SupportOf(a.right), right = SupportOf(b.left);
  if (ChordExcess(radius_, ca, cb, left, right) <= limit) return true;
  if (!a.right || !b.left || a.right->piece.value != b.left->piece.value) return false;
  const std::vector<Support> between = SupportsBetween(
      locator_.surface(), *a.right, *b.left, SupportParts(radius_, length, limit), params_.floor_center);
  return ExcessWithin(radius_, {ca, cb, left, right, between}, limit);
}

void SegmentTracer::Emit(const TraceStation& s) {
  if (runs_.empty()) runs_.emplace_back();
  runs_.back().push_back(s);
}

void SegmentTracer::BreakRun() {
  if (runs_.empty() || !runs_.back().empty()) runs_.emplace_back();
}

// Emits everything after a up to and including b.
void SegmentTracer::Refine(TraceStation a, TraceStation b, int depth) {
  if (b.t - a.t < kSmallestAdvance) {
    if (std::abs(a.z - b.z) > params_.chord_tolerance) b.keep = true;
    Emit(b);
    return;
  }
  if (ChordIsGood(a, b)) {
    Emit(b);
    return;
  }
  if (depth < kMaxIterations) {
    const auto a_at_b = Branch(a.right, b.t);
    const auto b_at_a = Branch(b.left, a.t);
    if (a_at_b && b_at_a) {
      const bool a_reaches_b = a_at_b->z >= b.z - kSameHeight;
      const bool b_reaches_a = b_at_a->z >= a.z - kSameHeight;
      if (!a_reaches_b && !b_reaches_a) {
        if (RefineAtSwitch(a, b, *a_at_b, *b_at_a, depth)) return;
      } else if (a_reaches_b != b_reaches_a) {
        // One end stands exactly on a switch: it takes the support of this side.
        if (a_reaches_b) b.left = a_at_b->contact;
        if (b_reaches_a) {
          a.right = b_at_a->contact;
          runs_.back().back().right = a.right;  // a is the last station emitted
          runs_.back().back().keep |= Apart(a.left, a.right);
        }
        b.keep |= Apart(b.left, b.right);
        if (ChordIsGood(a, b)) {
          Emit(b);
          return;
        }
      }
    } else {
      if (!a_at_b && RefineAtDrop(a, b, true, depth)) return;
      if (!b_at_a && RefineAtDrop(a, b, false, depth)) return;
    }
  }
  const double mid = 0.5 * (a.t + b.t);
  const auto m = Query(mid, a.hint);
  if (m) {
    Refine(a, *m, depth + 1);
    Refine(*m, b, depth + 1);
    return;
  }
  const TraceStation end = LastBeforeGap(a, mid), begin = LastBeforeGap(b, mid);
  Refine(a, end, depth + 1);
  BreakRun();
  Emit(begin);
  Refine(begin, b, depth + 1);
}

// Solves branch a = branch b. Returns true if the root was the switch (or a third branch lies above it) and
// all stations are emitted.
bool SegmentTracer::RefineAtSwitch(const TraceStation& a, const TraceStation& b, const BranchPoint& a_at_b,
                                   const BranchPoint& b_at_a, int depth) {
  double t0 = a.t, t1 = b.t;
  double f0 = a.z - b_at_a.z, f1 = a_at_b.z - b.z;  // f0 > 0 > f1
  std::optional<SurfacePoint> on_a = a.right, on_b = b.left;
  double t = t0, z = 0.0;
  bool solved = false;
  for (int i = 0, side = 0; i < kMaxIterations; ++i) {
    t = (t0 * f1 - t1 * f0) / (f1 - f0);
    if (!(t > t0 && t < t1)) t = 0.5 * (t0 + t1);
    const auto pa = Branch(on_a, t), pb = Branch(on_b, t);
    if (!pa || !pb) return false;
    on_a = pa->contact;
    on_b = pb->contact;
    const double f = pa->z - pb->z;
    z = std::max(pa->z, pb->z);
    if (std::abs(f) < 1e-13 * std::max(1.0, std::abs(z)) || t1 - t0 < kSwitchAccuracy) {
      solved = std::abs(f) < kSameHeight;
      break;
    }
    if (f > 0) {
      t0 = t;
      f0 = f;
      if (side == 1) f1 *= 0.5;
      side = 1;
    } else {
      t1 = t;
      f1 = f;
      if (side == -1) f0 *= 0.5;
      side = -1;
    }
  }
  if (!solved || t - a.t < kSwitchAccuracy || b.t - t < kSwitchAccuracy) return false;
  auto k = Query(t, a.hint);
  if (!k) return false;
  if (k->z <= z + kSameHeight) {
    k->z = std::max(k->z, z);
    k->ceiling = std::max(k->ceiling, k->z);
    k->left = on_a;
    k->right = on_b;
    k->keep = Apart(on_a, on_b);
    // Both sides are smooth now, unless a third branch rises inside one of them.
  }
  Refine(a, *k, depth + 1);
  Refine(*k, b, depth + 1);
  return true;
}

// The higher branch ends where its contact leaves the disc. Emits both ends of the drop there.
bool SegmentTracer::RefineAtDrop(const TraceStation& a, const TraceStation& b, bool from_a, int depth) {
  const TraceStation& high = from_a ? a : b;
  const double sign = from_a ? 1.0 : -1.0, far = from_a ? b.t : a.t;
  const std::optional<SurfacePoint>& start = from_a ? a.right : b.left;
  if (!start) return false;
  SurfacePoint contact = *start;
  double wall = high.t;
  for (int i = 0; i < kMaxIterations; ++i) {
    const double exit = DiscExit(contact, sign);
    if (sign * (far - exit) <= 2.0 * kDropOffset) return false;
    const bool converged = sign * (exit - wall) < 1e-10;
    if (sign * (exit - wall) > 0.0) wall = exit;
    if (converged) break;
    const auto next = locator_.Follow(contact, line_.At(wall - sign * 1e-10));
    if (!next) break;
    contact = next->contact;
  }
  if (sign * (wall - high.t) <= 2.0 * kDropOffset) return false;
  auto top = Query(wall - sign * kDropOffset, contact);
  if (!top) return false;
  const auto foot = Query(wall + sign * kDropOffset, contact);
  if (!foot) {
    // The surface itself ends here. It begins again before the other end.
    const TraceStation other = LastBeforeGap(from_a ? b : a, wall + sign * kDropOffset);
    top->keep = true;
    if (from_a) {
      Refine(a, *top, depth + 1);
      BreakRun();
      Emit(other);
      Refine(other, b, depth + 1);
    } else {
      Refine(a, other, depth + 1);
      BreakRun();
      Emit(*top);
      Refine(*top, b, depth + 1);
    }
    return true;
  }
  TraceStation foot_station = *foot;
  if (top->z - foot->z > params_.chord_tolerance) {
    // Both stations stand over the place of the foot, which is outside the wall.
    top->t = foot->t;
    top->q = foot->q;
    top->keep = foot_station.keep = true;
    if (from_a) {
      Refine(a, *top, depth + 1);
      Emit(foot_station);
      Refine(foot_station, b, depth + 1);
    } else {
      Refine(a, foot_station, depth + 1);
      Emit(*top);
      Refine(*top, b, depth + 1);
    }
    return true;
  }
  // Another part of the surface carries the ball past that place: it is an ordinary station.
  if (top->t - a.t < kSmallestAdvance || b.t - top->t < kSmallestAdvance) return false;
  Refine(a, *top, depth + 1);
  Refine(*top, b, depth + 1);
  return true;
}

// Returns the end of the run that holds `from`, given that h does not exist at gap_t.
TraceStation SegmentTracer::LastBeforeGap(const TraceStation& from, double gap_t) const {
  const double sign = gap_t > from.t ? 1.0 : -1.0;
  TraceStation inside = from;
  double outside = gap_t;
  for (int i = 0; i < 2 * kMaxIterations && sign * (outside - inside.t) > 2.0 * kDropOffset; ++i) {
    double t = 0.5 * (inside.t + outside);
    if (i < kMaxIterations) {
      const double exit = DiscExit(*inside.hint, sign);
      // Try the edge of the contact's own disc, then a place just past it. One of the two brackets the end.
      const double edge = exit - sign * kDropOffset;
      t = sign * (edge - inside.t) > 0.5 * kDropOffset ? edge : exit + sign * kDropOffset;
      if (sign * (outside - t) <= 0.0 || sign * (t - inside.t) <= 0.0) t = 0.5 * (inside.t + outside);
    }
    if (auto s = Query(t, inside.hint)) {
      inside = *s;
    } else {
      outside = t;
    }
  }
  inside.keep = true;
  return inside;
}

std::vector<std::vector<TraceStation>> SegmentTracer::Run() {
  auto at = Query(0.0, std::nullopt);
  double t = 0.0;
  if (at) {
    at->keep = true;
    Emit(*at);
  }
  while (t < line_.length && !(params_.run != nullptr && params_.run->Cancelled())) {
    double advance = at ? NextAdvance(*at) : LongestChord(radius_, params_.chord_tolerance);
    // The last two chords share what is left.
    const double rest = line_.length - t;
    if (rest < advance * 1.0000001) {
      advance = rest;
    } else if (rest < 2.0 * advance) {
      advance = 0.5 * rest;
    }
    const double next_t = advance == rest ? line_.length : t + advance;
    auto next = Query(next_t, at ? at->hint : std::nullopt);
    if (next && next_t == line_.length) next->keep = true;
    if (at && next) {
      Refine(*at, *next, 0);
    } else if (at) {
      Refine(*at, LastBeforeGap(*at, next_t), 0);
      BreakRun();
    } else if (next) {
      BreakRun();
      const TraceStation begin = LastBeforeGap(*next, t);
      Emit(begin);
      Refine(begin, *next, 0);
    }
    at = next;
    t = next_t;
  }
  std::erase_if(runs_, [](const auto& run) { return run.empty(); });
  return std::move(runs_);
}

}  // namespace

XyLine XyLine::Through(const Vec2& a, const Vec2& b) {
  const double length = (b - a).norm();
  return {a, length > 0.0 ? Vec2((b - a) / length) : Vec2(Vec2::UnitX()), length};
}

std::vector<std::vector<TraceStation>> TraceSegment(const Locator& locator, const XyLine& line,
                                                    const SegmentTraceParams& params) {
  return SegmentTracer(locator, line, params).Run();
}

}  // namespace patchmill
