#include "cam/path/chord_thinning.h"

#include <algorithm>
#include <cmath>

#include "cam/path/chord_bounds.h"
#include "cam/path/chord_supports.h"

namespace patchmill {
namespace {

// Picks vertices out of the stations of one run: as few as the chord tolerance allows, every one certified.
class Thinner {
 public:
  Thinner(const Locator& locator, const std::vector<LineStation>& stations, const PassParams& params,
          double gap)
      : locator_(locator),
        stations_(stations),
        radius_(locator.radius()),
        tolerance_(params.chord_tolerance),
        gap_(gap),
        excess_(ExcessTolerance(params) - gap),
        floor_center_(params.floor_z + locator.radius()),
        between_(stations.size()) {}

  std::vector<CutterPoint> Thin(const RunContext* run);

 private:
  struct Between {
    bool known = false;
    std::vector<Support> supports;  // empty: none are known
  };

  Support SupportOf(const std::optional<SurfacePoint>& contact) const {
    Support s{{}, floor_center_};
    if (contact) s.contact = contact->p;
    return s;
  }
  const std::vector<Support>& SupportsAfter(std::size_t k);
  bool Fits(std::size_t i, std::size_t j);
  std::size_t Farthest(std::size_t i, std::size_t barrier);
  CutterPoint Certify(const LineStation& s) const;
  bool Gouges(std::size_t i, std::size_t j, const Vec3& a, const Vec3& b);

  const Locator& locator_;
  const std::vector<LineStation>& stations_;
  const double radius_, tolerance_, gap_, excess_, floor_center_;
  std::vector<Between> between_;
  std::vector<Vec3> free_;  // scratch
};

// Supports between stations k and k+1. Any surface point will do: on one piece those between the contacts,
// else one by branch following.
const std::vector<Support>& Thinner::SupportsAfter(std::size_t k) {
  Between& between = between_[k];
  if (!between.known) {
    between.known = true;
    const LineStation &a = stations_[k], &b = stations_[k + 1];
    if (a.right && b.left && a.right->piece.value == b.left->piece.value) {
      const double length = (Lift(b.q, b.z) - Lift(a.q, a.z)).norm();
      between.supports = SupportsBetween(locator_.surface(), *a.right, *b.left,
                                         SupportParts(radius_, length, excess_), floor_center_);
    } else if (a.right) {
      if (const auto c = locator_.Follow(*a.right, 0.5 * (a.q + b.q))) {
        between.supports.push_back(SupportOf(c->contact));
      }
    }
  }
  return between.supports;
}

// Closed-form test of the chord from station i to j against every support between: excess proven (T3), gouge
// predicted (proven afterwards by the swept query).
bool Thinner::Fits(std::size_t i, std::size_t j) {
  const LineStation &first = stations_[i], &last = stations_[j];
  const Vec3 a = Lift(first.q, first.z), b = Lift(last.q, last.z);
  const double span = last.t - first.t;
  const double gouge_limit = 0.9 * tolerance_;
  const auto on_chord = [&](double t) -> Vec3 { return a + (t - first.t) / span * (b - a); };
  const auto gouges = [&](const Support& s) {
    return s.contact && radius_ - SegmentDistance(*s.contact, a, b) > gouge_limit;
  };
  for (std::size_t k = i; k < j; ++k) {
    const LineStation &s = stations_[k], &e = stations_[k + 1];
    const Support left = SupportOf(s.right), right = SupportOf(e.left);
    if (gouges(left) || gouges(right)) return false;
    const Vec3 x = on_chord(s.t), y = on_chord(e.t);
    if (left.Clearance(x, radius_) > excess_ || right.Clearance(y, radius_) > excess_) return false;
    const std::vector<Support>& between = SupportsAfter(k);
    if (std::any_of(between.begin(), between.end(), gouges)) return false;
    if (!ExcessWithin(radius_, x, y, left, between, right, excess_)) return false;
  }
  return true;
}

std::size_t Thinner::Farthest(std::size_t i, std::size_t barrier) {
  std::size_t good = i + 1, bad = barrier + 1;
  for (std::size_t step = 2; good < barrier; step *= 2) {
    const std::size_t j = std::min(i + step, barrier);
    if (!Fits(i, j)) {
      bad = j;
      break;
    }
    good = j;
  }
  while (bad - good > 1 && bad <= barrier) {
    const std::size_t mid = (good + bad) / 2;
    (Fits(i, mid) ? good : bad) = mid;
  }
  return good;
}

CutterPoint Thinner::Certify(const LineStation& s) const {
  CutterPoint p{Lift(s.q, s.z), s.left, {}};
  if (s.left && s.right && (s.left->p - s.right->p).norm() > 1e-3 * radius_) p.other_contact = s.right;
  if (!s.left) p.other_contact = s.right;
  if (s.ceiling < kInfinity) {
    p.center.z() = s.ceiling;
    return p;
  }
  const auto c = locator_.CertifiedHeight(s.at, gap_, s.hint ? &*s.hint : nullptr);
  if (!c) return p;  // the rim of the domain of h, within rounding
  const double z = c->z + c->gap;
  if (z >= p.center.z()) {
    p.center.z() = z;
    if (c->z > s.z + 1e-7) {  // the search had missed a branch
      p.contact = c->contact;
      p.other_contact.reset();
    }
  }
  return p;
}

// Of the chord a b from station i to j: first by the certified stations between, then by the surface.
bool Thinner::Gouges(std::size_t i, std::size_t j, const Vec3& a, const Vec3& b) {
  free_.clear();
  for (std::size_t k = i; k <= j && stations_[k].ceiling < kInfinity; ++k) {
    free_.push_back(Lift(stations_[k].q, stations_[k].ceiling));
  }
  if (free_.size() == j - i + 1 && ChordGouge(radius_, a, b, free_) <= tolerance_) return false;
  return !locator_.GougeWithin(a, b, tolerance_, 0.05 * tolerance_);
}

std::vector<CutterPoint> Thinner::Thin(const RunContext* run) {
  std::vector<CutterPoint> points;
  const std::size_t n = stations_.size();
  points.push_back(Certify(stations_[0]));
  std::size_t i = 0;
  while (i + 1 < n && !(run != nullptr && run->Cancelled())) {
    std::size_t barrier = i + 1;
    while (barrier + 1 < n && !stations_[barrier].keep) ++barrier;
    std::size_t j = Farthest(i, barrier);
    CutterPoint next = Certify(stations_[j]);
    while (j > i + 1 && Gouges(i, j, points.back().center, next.center)) {
      j = i + (j - i) / 2;
      next = Certify(stations_[j]);
    }
    points.push_back(next);
    i = j;
  }
  return points;
}

}  // namespace

double CertificateGap(const PassParams& params) {
  return std::clamp(params.certificate_gap, 1e-7, std::max(1e-7, 0.1 * ExcessTolerance(params)));
}

std::vector<CutterPoint> ThinStations(const Locator& locator, const std::vector<LineStation>& stations,
                                      const PassParams& params, const RunContext* run) {
  if (stations.empty()) return {};
  return Thinner(locator, stations, params, CertificateGap(params)).Thin(run);
}

}  // namespace patchmill
