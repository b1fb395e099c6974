#include "cam/path/chord/fewest_chords.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "cam/path/chord/chord_bounds.h"
#include "cam/path/chord/chord_supports.h"

namespace patchmill {
namespace {

// Parts of the gouge tolerance: the most that a closed-form prediction may use, and the slack of the proof
// after it.
constexpr double kPredicted = 0.9, kProofSlack = 0.05;
// Least clearance that the ball gains per mm of a small step away from the surface. Where the true gain is
// less, vertices go down no farther than for this one.
constexpr double kLeastUpright = 0.2;
constexpr double kMostTilt = 0.5;  // cosine of the largest turn of `away` under one chord
// Part of the excess: a station this far below the chord between its neighbours lies on a concave stretch.
// Less is rounding, or does not hinder chords of dozens of stations.
constexpr double kHollow = 1e-3;
constexpr std::size_t kFirstLook = 8;  // stations ahead that are tried first
constexpr double kSamePlace = 1e-9;    // mm: centres this near to each other count as one

class Funnel {
 public:
  Funnel(const Locator& locator, std::span<const ChordStation> stations, const ChordLimits& limits,
         const ProvenCenter& proven)
      : locator_(locator),
        stations_(stations),
        limits_(limits),
        proven_(proven),
        radius_(locator.radius()),
        between_(stations.size()) {}

  std::vector<ChordVertex> Run(const RunContext* run);

 private:
  struct Between {
    bool known = false;
    std::vector<Support> supports;  // empty: none are known
  };
  // How far below a station a vertex may be, given the stations passed over; nowhere if least > most.
  struct Depths {
    double least = 0.0, most = 0.0;
    bool Any() const { return least <= most; }
  };
  // Slopes (rise over run) that chords from one vertex may have; from `touching` on they touch the surface.
  struct Slopes {
    double least = -kInfinity, most = kInfinity, touching = kInfinity;
    bool Open() const { return least <= most && most > -kInfinity; }
  };
  // The frame in which chords from one vertex are seen: along the way, and away from the surface.
  struct Frame {
    Vec3 origin, along, up;
  };

  // A contact above the ball's centre touches the shank. It counts as a vertical wall that continues
  // downwards.
  Support SupportOf(const SurfacePoint* contact, double center_z) const {
    Support s{{}, limits_.floor_center};
    if (contact != nullptr) s.contact = Lift(Xy(contact->p), std::min(contact->p.z(), center_z));
    return s;
  }
  Vec3 Place(const ChordVertex& v) const {
    const ChordStation& s = stations_[v.station];
    return s.center - v.below * s.away;
  }
  double Upright(const ChordStation& s, const Vec3& up) const;
  double Deepest(std::size_t k) const;
  bool Hollow(std::size_t k) const;
  ChordVertex At(std::size_t k, const Depths& depths) const {
    return {k, Hollow(k) ? depths.most : depths.least};
  }
  std::optional<Frame> FrameAt(const ChordVertex& v) const;
  std::size_t PassOver(const ChordVertex& from, const Frame& frame, std::size_t barrier, Slopes& slopes);
  const std::vector<Support>& SupportsAfter(std::size_t k);
  bool Fits(const ChordVertex& from, const ChordVertex& to);
  bool TryFits(const ChordVertex& from, std::size_t k) {
    const Depths& depths = depths_[k - from.station];
    return depths.Any() && Fits(from, At(k, depths));
  }
  std::size_t Farthest(const ChordVertex& from, std::size_t barrier);
  // A vertex with its proven centre. `known` is false if that centre is higher than its station.
  struct Reached {
    ChordVertex vertex;
    Vec3 center = Vec3::Zero();
    bool known = true;
  };
  Reached Reach(const ChordVertex& v) const;
  bool Gouges(const ChordVertex& from, const ChordVertex& to, const Vec3& a, const Vec3& b, bool proven);
  bool LeadsOn(const ChordVertex& v);
  std::size_t BarrierAfter(std::size_t k);
  Reached Next(const Reached& from);

  const Locator& locator_;
  const std::span<const ChordStation> stations_;
  const ChordLimits& limits_;
  const ProvenCenter& proven_;
  const double radius_;
  std::vector<Between> between_;
  std::vector<Depths> depths_;  // of the stations from the last vertex on
  std::size_t barrier_ = 0;     // the next station that must be kept
  std::vector<Vec3> free_;      // scratch
};

// Returns the clearance that the ball gains from its supports per mm of a small step along `up`.
double Funnel::Upright(const ChordStation& s, const Vec3& up) const {
  double upright = 0.0;
  for (const SurfacePoint* contact : {s.left, s.right}) {
    upright = std::max(upright, contact != nullptr ? (s.center - contact->p).dot(up) / radius_ : 1.0);
  }
  return std::max(upright, kLeastUpright);
}

// Returns how far below station k a vertex may be, whatever the chords.
double Funnel::Deepest(std::size_t k) const {
  const ChordStation& s = stations_[k];
  if (s.keep || !s.proven || k == 0 || k + 1 == stations_.size()) return 0.0;
  if (s.left == nullptr || s.right == nullptr) return 0.0;
  double most = limits_.deepest / Upright(s, s.away);
  if (s.away.z() > 0.0) most = std::min(most, (s.center.z() - limits_.floor_center) / s.away.z());
  return std::max(0.0, most);
}

bool Funnel::Hollow(std::size_t k) const {
  if (k == 0 || k + 1 == stations_.size()) return false;
  const Vec3 a = stations_[k - 1].center, way = stations_[k + 1].center - a, off = stations_[k].center - a;
  const Vec3& up = stations_[k].away;
  const Vec3 along = way - way.dot(up) * up;
  const double length2 = along.squaredNorm();
  return length2 > 0.0 && way.dot(up) * off.dot(along) / length2 - off.dot(up) > kHollow * limits_.excess;
}

std::optional<Funnel::Frame> Funnel::FrameAt(const ChordVertex& v) const {
  const ChordStation& s = stations_[v.station];
  const Vec3 way = stations_[v.station + 1].center - s.center;
  const Vec3 along = way - way.dot(s.away) * s.away;
  const double length = along.norm();
  if (!(length > 0.0)) return std::nullopt;
  return Frame{Place(v), along / length, s.away};
}

// Passes over stations up to `barrier` and narrows the slopes. Notes for each station how far below it the
// next vertex may be. Returns the last station that may have a vertex.
std::size_t Funnel::PassOver(const ChordVertex& from, const Frame& frame, std::size_t barrier,
                             Slopes& slopes) {
  std::size_t last = from.station;
  for (std::size_t k = from.station + depths_.size(); k <= barrier && slopes.Open(); ++k) {
    const ChordStation& s = stations_[k];
    const Vec3 off = s.center - frame.origin;
    const double run = off.dot(frame.along), rise = off.dot(frame.up), tilt = s.away.dot(frame.up);
    Depths depths{0.0, Deepest(k)};
    if (k > from.station + 1) {
      if (!(run > 0.0) || tilt < kMostTilt || off.norm() > limits_.longest) {
        slopes.most = -kInfinity;
        break;
      }
      depths.least = std::max(0.0, (rise - slopes.most * run) / tilt);
      depths.most = std::min(depths.most, (rise - slopes.least * run) / tilt);
    }
    // No chord may be below the surface all along: it would lower the crests on its sides by more than its
    // gouge does elsewhere.
    if (from.below > 0.0) {
      const double touching = std::max(0.0, (rise - slopes.touching * run) / std::max(tilt, kMostTilt));
      depths.most = std::min(depths.most, std::max(depths.least, touching));
    }
    depths_.push_back(depths);
    if (depths.Any()) last = k;
    if (!(run > 0.0)) continue;
    const double upright = Upright(s, frame.up);
    slopes.least = std::max(slopes.least, (rise - kPredicted * limits_.gouge / upright) / run);
    slopes.most = std::min(slopes.most, (rise + limits_.excess / upright) / run);
    slopes.touching = std::min(slopes.touching, rise / run);
  }
  return last;
}

// Returns the supports between stations k and k+1. Any surface point will do: on one piece those between the
// contacts, else one found by following the branch.
const std::vector<Support>& Funnel::SupportsAfter(std::size_t k) {
  Between& between = between_[k];
  if (!between.known) {
    between.known = true;
    const ChordStation &a = stations_[k], &b = stations_[k + 1];
    if (a.right != nullptr && b.left != nullptr && a.right->piece.value == b.left->piece.value) {
      const double length = (b.center - a.center).norm();
      between.supports = SupportsBetween(locator_.surface(), *a.right, *b.left,
                                         SupportParts(radius_, length, limits_.excess), limits_.floor_center);
      for (Support& support : between.supports) {
        Vec3& p = *support.contact;
        p.z() = std::min(p.z(), std::max(a.center.z(), b.center.z()));
      }
    } else if (a.right != nullptr) {
      if (const auto c = locator_.Follow(*a.right, Xy(Vec3(0.5 * (a.center + b.center))))) {
        between.supports.push_back(SupportOf(&c->contact, std::max(a.center.z(), b.center.z())));
      }
    }
  }
  return between.supports;
}

// Tests a chord in closed form against every support between its ends. The excess is proven ([location T3]),
// the gouge only predicted; it is proven afterwards.
bool Funnel::Fits(const ChordVertex& from, const ChordVertex& to) {
  const Vec3 a = Place(from), b = Place(to), way = b - a;
  const auto on_chord = [&](std::size_t k) -> Vec3 {
    if (k == from.station) return a;
    if (k == to.station) return b;
    const double t = (stations_[k].center - a).dot(way) / way.squaredNorm();
    return a + std::clamp(t, 0.0, 1.0) * way;
  };
  const auto gouges = [&](const Support& s) {
    return s.contact && radius_ - SegmentDistance(*s.contact, a, b) > kPredicted * limits_.gouge;
  };
  Vec3 x = a;
  double highest = -kInfinity;  // clearance of the highest place over its supports
  for (std::size_t k = from.station; k < to.station; ++k) {
    const ChordStation &s = stations_[k], &e = stations_[k + 1];
    const Support left = SupportOf(s.right, s.center.z()), right = SupportOf(e.left, e.center.z());
    if (gouges(left) || gouges(right)) return false;
    const Vec3 y = on_chord(k + 1);
    if ((y - x).dot(way) < 0.0) return false;
    const double over_left = left.Clearance(x, radius_), over_right = right.Clearance(y, radius_);
    if (std::max(over_left, over_right) > limits_.excess) return false;
    highest = std::max({highest, over_left, over_right});
    const std::vector<Support>& between = SupportsAfter(k);
    if (std::any_of(between.begin(), between.end(), gouges)) return false;
    if (!ExcessWithin(radius_, {x, y, left, right, between}, limits_.excess)) return false;
    x = y;
  }
  return from.below == 0.0 || to.below == 0.0 || highest >= -limits_.excess;
}

// Returns the farthest station that a chord may lead to, by closed forms.
std::size_t Funnel::Farthest(const ChordVertex& from, std::size_t barrier) {
  depths_.assign(1, Depths{from.below, from.below});
  Slopes slopes;
  std::size_t good = from.station + 1, bad = 0;
  const std::optional<Frame> frame = FrameAt(from);
  if (!frame) {
    depths_.push_back({});
    return good;
  }
  for (std::size_t ahead = kFirstLook; bad == 0; ahead *= 4) {
    const std::size_t j = PassOver(from, *frame, std::min(from.station + ahead, barrier), slopes);
    if (j > good) (TryFits(from, j) ? good : bad) = j;
    if (from.station + depths_.size() > barrier || !slopes.Open()) break;
  }
  // The farthest good station is mostly just before the bad one.
  for (std::size_t step = 1; bad > good + 1; step *= 2) {
    const std::size_t j = std::max(good + 1, bad - std::min(step, bad));
    if (TryFits(from, j)) {
      good = j;
      while (bad - good > 1) {
        const std::size_t mid = (good + bad) / 2;
        (TryFits(from, mid) ? good : bad) = mid;
      }
    } else {
      bad = j;
    }
  }
  return good;
}

// Does the chord between two vertices gouge? a and b are the centres over them, `proven` or not. Tests first
// by [location T2b] along the stations between, then by the surface. The chord runs nowhere farther below a b
// than its ends do.
bool Funnel::Gouges(const ChordVertex& from, const ChordVertex& to, const Vec3& a, const Vec3& b,
                    bool proven) {
  free_.assign(1, a);
  for (std::size_t k = from.station + 1; k < to.station; ++k) {
    free_.push_back(stations_[k].center);
    proven = proven && stations_[k].proven;
  }
  free_.push_back(b);
  const double lowered = std::max(from.below, to.below) + limits_.certificate_gap;
  if (proven && ChordGouge(radius_, a, b, free_) + lowered <= limits_.gouge) return false;
  return !locator_.GougeWithin(a - from.below * stations_[from.station].away,
                               b - to.below * stations_[to.station].away, limits_.gouge,
                               kProofSlack * limits_.gouge);
}

// May a vertex that far down be followed by the next station as it is, whatever follows?
bool Funnel::LeadsOn(const ChordVertex& v) {
  if (v.below == 0.0) return true;
  const ChordVertex next{v.station + 1, 0.0};
  const ChordStation &s = stations_[v.station], &e = stations_[next.station];
  return !Gouges(v, next, s.center, e.center, s.proven && e.proven);
}

std::size_t Funnel::BarrierAfter(std::size_t k) {
  if (barrier_ <= k) {
    barrier_ = k + 1;
    while (barrier_ + 1 < stations_.size() && !stations_[barrier_].keep) ++barrier_;
  }
  return barrier_;
}

Funnel::Reached Funnel::Reach(const ChordVertex& v) const {
  Reached at{v, proven_(v.station)};
  at.known = (at.center - stations_[v.station].center).norm() <= limits_.certificate_gap + kSamePlace;
  if (!at.known) at.vertex.below = 0.0;
  return at;
}

// The closed forms do not know of centres higher than their stations. Chords from and to such centres go from
// station to station.
Funnel::Reached Funnel::Next(const Reached& from) {
  const std::size_t start = from.vertex.station, first = start + 1;
  std::size_t j = Farthest(from.vertex, from.known ? BarrierAfter(start) : first);
  while (true) {
    const Depths& depths = depths_[j - start];
    const double best = At(j, depths).below;
    for (const double below : {best, depths.least}) {
      const Reached to = Reach({j, below});
      if (j > first && !to.known) break;
      if (LeadsOn(to.vertex) && !Gouges(from.vertex, to.vertex, from.center, to.center, true) &&
          (to.vertex.below == best || j == first || Fits(from.vertex, to.vertex))) {
        return to;
      }
      if (best == depths.least) break;
    }
    if (j == first) return Reach({j, 0.0});
    do {
      j = start + (j - start) / 2;
    } while (j > first && !TryFits(from.vertex, j));
  }
}

std::vector<ChordVertex> Funnel::Run(const RunContext* run) {
  std::vector<ChordVertex> vertices;
  if (stations_.empty()) return vertices;
  Reached at = Reach({});
  vertices.push_back(at.vertex);
  while (at.vertex.station + 1 < stations_.size() && !(run != nullptr && run->Cancelled())) {
    at = Next(at);
    vertices.push_back(at.vertex);
  }
  return vertices;
}

}  // namespace

std::vector<ChordVertex> FewestChords(const Locator& locator, std::span<const ChordStation> stations,
                                      const ChordLimits& limits, const ProvenCenter& proven,
                                      const RunContext* run) {
  return Funnel(locator, stations, limits, proven).Run(run);
}

double DeepestVertex(double gouge, double excess) {
  return std::clamp(0.6 * gouge - excess, 0.0, 0.5 * gouge);
}

}  // namespace patchmill
