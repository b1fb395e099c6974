#include "cam/path/scan_line.h"

#include <algorithm>
#include <cmath>

#include "cam/path/chord_bounds.h"
#include "cam/path/line_trace.h"

namespace patchmill {
namespace {

// Picks vertices out of the stations of one run: as few as the chord tolerance allows, every one certified.
class RunThinner {
 public:
  RunThinner(const Locator& locator, const PlanLine& line, const std::vector<LineStation>& stations,
             const PassParams& params, double gap)
      : locator_(locator),
        line_(line),
        stations_(stations),
        radius_(locator.radius()),
        tolerance_(params.chord_tolerance),
        gap_(gap),
        floor_center_(params.floor_z + locator.radius()),
        middle_(stations.size()) {}

  ScanRun Thin();

 private:
  struct Middle {
    bool known = false;
    std::optional<Support> support;
  };

  Support SupportOf(const std::optional<SurfacePoint>& contact) const {
    Support s{{}, floor_center_};
    if (contact) s.contact = contact->p;
    return s;
  }
  const std::optional<Support>& MiddleOf(std::size_t k);
  bool Fits(std::size_t i, std::size_t j);
  std::size_t Farthest(std::size_t i, std::size_t barrier);
  CutterPoint Certify(const LineStation& s) const;

  const Locator& locator_;
  const PlanLine& line_;
  const std::vector<LineStation>& stations_;
  const double radius_, tolerance_, gap_, floor_center_;
  std::vector<Middle> middle_;
};

// A support half way between stations k and k+1: one branch following, and any surface point is a valid lower
// bound of h.
const std::optional<Support>& RunThinner::MiddleOf(std::size_t k) {
  Middle& m = middle_[k];
  if (!m.known) {
    m.known = true;
    const LineStation &a = stations_[k], &b = stations_[k + 1];
    if (a.right) {
      if (const auto c = locator_.Follow(*a.right, line_.At(0.5 * (a.t + b.t)))) {
        m.support = SupportOf(c->contact);
      }
    }
  }
  return m.support;
}

// Closed-form test of the chord from station i to j against every support between: excess proven (T3), gouge
// predicted (proven afterwards by the swept query).
bool RunThinner::Fits(std::size_t i, std::size_t j) {
  const LineStation &first = stations_[i], &last = stations_[j];
  const Vec3 a = Lift(line_.At(first.t), first.z), b = Lift(line_.At(last.t), last.z);
  const double span = last.t - first.t;
  const double excess_limit = tolerance_ - gap_, gouge_limit = 0.9 * tolerance_;
  const auto on_chord = [&](double t) -> Vec3 { return a + (t - first.t) / span * (b - a); };
  const auto gouges = [&](const Support& s) {
    return s.contact && radius_ - SegmentDistance(*s.contact, a, b) > gouge_limit;
  };
  for (std::size_t k = i; k < j; ++k) {
    const LineStation &s = stations_[k], &e = stations_[k + 1];
    const Support left = SupportOf(s.right), right = SupportOf(e.left);
    if (gouges(left) || gouges(right)) return false;
    const Vec3 x = on_chord(s.t), y = on_chord(e.t);
    if (left.Clearance(x, radius_) > excess_limit || right.Clearance(y, radius_) > excess_limit) return false;
    const auto& middle = MiddleOf(k);
    if (!middle) {
      if (ChordExcess(radius_, x, y, left, right) > excess_limit) return false;
      continue;
    }
    if (gouges(*middle)) return false;
    const Vec3 m = 0.5 * (x + y);
    if (ChordExcess(radius_, x, m, left, *middle) > excess_limit ||
        ChordExcess(radius_, m, y, *middle, right) > excess_limit) {
      return false;
    }
  }
  return true;
}

std::size_t RunThinner::Farthest(std::size_t i, std::size_t barrier) {
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

CutterPoint RunThinner::Certify(const LineStation& s) const {
  CutterPoint p{Lift(line_.At(s.t), s.z), s.left, {}};
  if (s.left && s.right && (s.left->p - s.right->p).norm() > 1e-3 * radius_) p.other_contact = s.right;
  if (!s.left) p.other_contact = s.right;
  const auto c = locator_.CertifiedHeight(line_.At(s.at), gap_, s.hint ? &*s.hint : nullptr);
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

ScanRun RunThinner::Thin() {
  ScanRun run;
  const std::size_t n = stations_.size();
  run.points.push_back(Certify(stations_[0]));
  std::size_t i = 0;
  while (i + 1 < n) {
    std::size_t barrier = i + 1;
    while (barrier + 1 < n && !stations_[barrier].keep) ++barrier;
    std::size_t j = Farthest(i, barrier);
    CutterPoint next = Certify(stations_[j]);
    while (j > i + 1 &&
           locator_.SweptGouge(run.points.back().center, next.center, 0.05 * tolerance_) > tolerance_) {
      j = i + (j - i) / 2;
      next = Certify(stations_[j]);
    }
    run.points.push_back(next);
    i = j;
  }
  return run;
}

}  // namespace

std::vector<ScanRun> ScanLine(const Locator& locator, const Vec2& a, const Vec2& b,
                              const PassParams& params) {
  const PlanLine line = PlanLine::Through(a, b);
  const double gap = std::clamp(params.certificate_gap, 1e-7, std::max(1e-7, 0.1 * params.chord_tolerance));
  const LineTraceParams trace{.chord_tolerance = params.chord_tolerance - gap,
                              .floor_center = params.floor_z + locator.radius()};
  std::vector<ScanRun> runs;
  for (const auto& stations : TraceLine(locator, line, trace)) {
    runs.push_back(RunThinner(locator, line, stations, params, gap).Thin());
  }
  return runs;
}

}  // namespace patchmill
