#include "cam/path/edge/limits_clip.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "cam/location/contact_points.h"
#include "core/base/parallel.h"
#include "core/base/status.h"
#include "core/surface/closest.h"

namespace patchmill {
namespace {

constexpr double kAsNear = 2e-3;  // of the radius: places this much farther than the nearest one count as
                                  // contacts
constexpr int kHalvings = 4;      // of half the reach, to place the end of the selected surface
constexpr double kAbove = 0.02;   // of the radius: height above the centre at which a contact still counts
constexpr double kClipLength = 1e-3;  // mm: shorter parts across a limit are left out

// A pass divided into chords, each of which is kept or not.
struct Chords {
  std::vector<CutterPoint> points;  // the last one closes a closed path
  std::vector<bool> keep;           // of the chord from points[i] to points[i + 1]
  bool begun = false;               // the last chord belongs to the move that is being divided
};

class Clipper {
 public:
  Clipper(const Locator& locator, const OperationLimits& operation_limits, double reach)
      : locator_(locator), operation_limits_(operation_limits), reach_(reach) {}

  std::vector<CutterPath> Clip(const CutterPath& path) const {
    Chords chords;
    const std::size_t n = path.points.size();
    if (n == 0) return {};
    if (n == 1) {
      const CutterPoint& only = path.points.front();
      const bool kept = !operation_limits_.TooHigh(only.center.z()) && WantsNear(only) &&
                        operation_limits_.AllowsMove(only.center, only.center, true);
      return kept ? std::vector<CutterPath>{path} : std::vector<CutterPath>{};
    }
    chords.points.push_back(path.points.front());
    const std::size_t moves = path.closed ? n : n - 1;
    for (std::size_t i = 0; i < moves; ++i) AddChord(path.points[i], path.points[(i + 1) % n], chords);
    return Gather(path, chords);
  }

 private:
  void AddChord(const CutterPoint& a, const CutterPoint& b, Chords& chords) const {
    const double length = (b.center - a.center).norm();
    const int parts = operation_limits_.WantsAll() ? 1 : 1 + static_cast<int>(2.0 * length / reach_);
    chords.begun = false;
    CutterPoint from = a;
    bool wanted = WantsNear(a);
    for (int k = 1; k <= parts; ++k) {
      const CutterPoint to = k == parts ? b : Between(a, b, static_cast<double>(k) / parts);
      const bool before = std::exchange(wanted, WantsNear(to));
      if (before && wanted) {
        AddAllowed(from, to, chords);
      } else if (before) {
        const CutterPoint end = Switch(from, to);
        AddAllowed(from, end, chords);
        Push(to, false, chords);
      } else if (wanted) {
        const CutterPoint start = Switch(to, from);
        Push(start, false, chords);
        AddAllowed(start, to, chords);
      } else {
        Push(to, false, chords);
      }
      from = to;
    }
  }

  // Returns a place between a wanted and an unwanted one, just beyond the end of the selected surface.
  // Farther away, in a corner, the ball would climb the next wall.
  CutterPoint Switch(const CutterPoint& wanted, const CutterPoint& not_wanted) const {
    double low = 0.0, high = 1.0;
    CutterPoint end = not_wanted;
    for (int i = 0; i < kHalvings; ++i) {
      const double middle = 0.5 * (low + high);
      const CutterPoint at = Between(wanted, not_wanted, middle);
      const bool more = WantsNear(at);
      if (!more) end = at;
      (more ? low : high) = middle;
    }
    return end;
  }

  void AddAllowed(const CutterPoint& a, const CutterPoint& b, Chords& chords) const {
    if (operation_limits_.TooHigh(std::min(a.center.z(), b.center.z()))) {
      Push(b, false, chords);
      return;
    }
    if (operation_limits_.AllowsAll() || operation_limits_.AllowsMove(a.center, b.center, true)) {
      Push(b, true, chords);
      return;
    }
    const double half = 0.5 * (b.center - a.center).norm();
    if (half < 0.5 * kClipLength || operation_limits_.Forbids(0.5 * (a.center + b.center), half)) {
      Push(b, false, chords);
      return;
    }
    const CutterPoint middle = Between(a, b, 0.5);
    AddAllowed(a, middle, chords);
    AddAllowed(middle, b, chords);
  }

  // Adds a chord. Neighbouring chords that are left out become one, and so do kept ones of one move.
  static void Push(const CutterPoint& to, bool keep, Chords& chords) {
    const bool same = !chords.keep.empty() && chords.keep.back() == keep;
    if (same && (!keep || chords.begun)) {
      chords.points.back() = to;
    } else {
      chords.points.push_back(to);
      chords.keep.push_back(keep);
    }
    chords.begun = true;
  }

  CutterPoint Between(const CutterPoint& a, const CutterPoint& b, double share) const {
    CutterPoint p;
    p.center = a.center + share * (b.center - a.center);
    const double reach = 1.1 * locator_.radius();
    if (const auto contact = ClosestToPoint(locator_.surface(), p.center, reach, 1e-4 * locator_.radius())) {
      p.contact = contact->at;
    }
    return p;
  }

  // Does the ball touch the surface near a selected place? A contact above its centre is one of the shank,
  // which finishes nothing; at a vertical face the ball's own contact is known less exactly. A point may name
  // only one of several contacts.
  bool WantsNear(const CutterPoint& p) const {
    if (operation_limits_.WantsAll()) return true;
    const double radius = locator_.radius();
    const auto wanted = [&](const SurfacePoint& place) {
      return place.p.z() <= p.center.z() + kAbove * radius && operation_limits_.WantsNear(place, reach_);
    };
    if ((p.contact && wanted(*p.contact)) || (p.other_contact && wanted(*p.other_contact))) return true;
    if (operation_limits_.WantsNothingNear(p.center, kContactReach * radius + reach_)) return false;
    const std::vector<SurfacePoint> touched =
        ContactPoints(locator_.surface(), p.center, radius, kAsNear * radius);
    return std::any_of(touched.begin(), touched.end(), wanted);
  }

  static std::vector<CutterPath> Gather(const CutterPath& path, const Chords& chords) {
    const std::size_t count = chords.keep.size();
    std::size_t start = 0;  // of a closed path: a chord that is left out
    while (start < count && chords.keep[start]) ++start;
    if (start == count) return {path};
    if (!path.closed) start = 0;
    std::vector<CutterPath> parts;
    bool open = false;
    for (std::size_t k = 0; k < count; ++k) {
      const std::size_t i = (start + k) % count;
      if (!chords.keep[i]) {
        open = false;
        continue;
      }
      if (!open) {
        parts.push_back(path);
        parts.back().closed = false;
        parts.back().points = {chords.points[i]};
        open = true;
      }
      parts.back().points.push_back(chords.points[i + 1]);
    }
    return parts;
  }

  const Locator& locator_;
  const OperationLimits& operation_limits_;
  double reach_;
};

}  // namespace

absl::StatusOr<std::vector<CutterPath>> ClipToLimits(const Locator& locator,
                                                     const OperationLimits& operation_limits,
                                                     std::vector<CutterPath> paths, double reach,
                                                     const RunContext& run) {
  if (operation_limits.WantsAll() && operation_limits.AllowsAll()) return paths;
  const Clipper clipper(locator, operation_limits, reach);
  std::vector<std::vector<CutterPath>> parts(paths.size());
  PM_RETURN_IF_ERROR(
      ParallelFor(run, nullptr, paths.size(), [&](std::size_t i) { parts[i] = clipper.Clip(paths[i]); }));
  std::vector<CutterPath> kept;
  for (std::vector<CutterPath>& of_path : parts) {
    kept.insert(kept.end(), std::make_move_iterator(of_path.begin()), std::make_move_iterator(of_path.end()));
  }
  return kept;
}

}  // namespace patchmill
