#include "cam/path/rest/redundant_passes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <utility>

#include "cam/path/rest/leftover_spots.h"
#include "cam/path/stepover/step_over.h"
#include "cam/toolpath/segment_tree.h"
#include "core/base/parallel.h"
#include "core/base/progress_throttle.h"
#include "core/base/status.h"
#include "core/diffgeo/forms.h"

namespace patchmill {
namespace {

constexpr double kCoarse = 2.0, kFine = 0.25;  // flat step-overs between the tested places of a pass
constexpr double kBesideDistance = 0.2;        // flat step-overs: another pass this near may replace it
constexpr double kWider = 1.022;               // times the step: how far others may lie apart; its square is
                                               // kRedundantLimit
constexpr int kPlaces = 4;       // on either side of a chord: places at which others are looked for
constexpr double kWidest = 4.0;  // flat step-overs: passes farther away are not looked for
constexpr double kProof = 0.01;  // of the scallop: margin within which FindSpots need not decide
constexpr double kRemovedMarginShare = 0.05;  // of the tolerance: removed passes must have left less by this
constexpr double kMinRemainder = 1.0;  // ball radii: no shorter part of a pass is left between removed ones

// A move of a pass.
struct Chord {
  std::size_t path = 0;
  Vec3 a = Vec3::Zero(), b = Vec3::Zero();  // ball centres
  Vec3 across = Vec3::Zero();               // along the surface, unit
  double step = 0.0;                        // mm: passes on both sides may be this far apart
  bool removed = false;                     // the chord is redundant
  double Length() const { return (b - a).norm(); }
};

// Chords [first, last) of a pass. On a closed pass the count continues past its end.
struct Stretch {
  std::size_t first = 0, last = 0;
  double length = 0.0;  // mm
};

class RedundantPassRemover {
 public:
  RedundantPassRemover(const Locator& locator, const std::vector<CutterPath>& paths, const PassParams& params,
                       const RunContext& run)
      : locator_(locator),
        paths_(paths),
        scallop_(params.scallop),
        flat_(CenterStep(locator.radius(), params.scallop, 0.0)),
        least_(params.min_step_fraction * flat_),
        chords_(AllChords(paths)),
        tree_(Segments([](const Chord&) { return true; }), Metric::kPath, kInfinity, run) {
    first_.push_back(0);
    for (const CutterPath& path : paths) first_.push_back(first_.back() + ChordCount(path));
  }

  // Marks the chords that seem redundant as removed.
  absl::Status Take(const RunContext& run);
  // Restores the chord that left least at each spot, and then what is not worth its gap any more. Returns
  // what was restored. `removed` is a tree of Removed().
  std::vector<PathSegment> Restore(const std::vector<LeftoverSpot>& spots, const SegmentTree& removed);
  std::vector<PathSegment> Removed() const {
    return Segments([](const Chord& c) { return c.removed; });
  }
  std::vector<PathSegment> Kept() const {
    return Segments([](const Chord& c) { return !c.removed; });
  }
  std::vector<CutterPath> Passes() const;

 private:
  static std::size_t ChordCount(const CutterPath& path) {
    const std::size_t n = path.points.size();
    return n <= 1 ? n : n - 1 + (path.closed ? 1 : 0);
  }
  static std::vector<Chord> AllChords(const std::vector<CutterPath>& paths) {
    std::vector<Chord> chords;
    for (std::size_t k = 0; k < paths.size(); ++k) {
      const std::vector<CutterPoint>& points = paths[k].points;
      for (std::size_t i = 0; i < ChordCount(paths[k]); ++i)
        chords.push_back({.path = k, .a = points[i].center, .b = points[(i + 1) % points.size()].center});
    }
    return chords;
  }
  template <class Which>
  std::vector<PathSegment> Segments(const Which& which) const {
    std::vector<PathSegment> segments;
    for (std::size_t i = 0; i < chords_.size(); ++i) {
      if (which(chords_[i])) segments.push_back({chords_[i].a, chords_[i].b, static_cast<int>(i)});
    }
    return segments;
  }
  void Measure(Chord& chord, const CutterPoint& from, const CutterPoint& to) const;
  bool SeemsRedundant(const Chord& chord, double spacing, std::vector<int>& found) const;
  std::vector<Stretch> StretchesWorthRemoving(std::size_t path, const std::vector<char>& removable) const;

  const Locator& locator_;
  const std::vector<CutterPath>& paths_;
  const double scallop_, flat_, least_;  // mm
  std::vector<Chord> chords_;            // path by path
  std::vector<std::size_t> first_;       // first chord of each path, and the end
  const SegmentTree tree_;               // of all chords, by their numbers
};

// Sets `across`, and `step` to the shorter one of both ends. Where nothing is touched the step is the flat
// step-over.
void RedundantPassRemover::Measure(Chord& chord, const CutterPoint& from, const CutterPoint& to) const {
  const double radius = locator_.radius();
  const Vec3 d = chord.b - chord.a;
  chord.across = Vec3(d.y(), -d.x(), 0.0);
  chord.step = kInfinity;
  for (const CutterPoint* at : {&from, &to}) {
    double step = flat_;
    if (at->contact) {
      const SurfaceJet jet = Evaluate(locator_.surface(), at->contact->piece, at->contact->u, at->contact->v);
      const Vec3 up = (at->center - at->contact->p) / radius;
      const Vec3 across = d.cross(up);
      const auto normal = UpwardNormal(jet);
      if (normal && across.norm() > 1e-6 * d.norm()) {
        chord.across = across;
        // Take the normal of the side on which the ball is.
        const Vec3 n = normal->dot(up) < 0.0 ? Vec3(-*normal) : *normal;
        const Vec3 tangent = across.normalized();
        step = CenterStep(radius, scallop_, NormalCurvature(Forms(jet, n), jet, tangent));
      }
    }
    chord.step = std::min(chord.step, std::clamp(step, least_, kWidest * flat_));
  }
  chord.across.normalize();
}

// Do other passes finish what the chord finishes? Only passes that are not removed count. They are looked for
// at places of the chord at most `spacing` (mm) apart.
bool RedundantPassRemover::SeemsRedundant(const Chord& chord, double spacing, std::vector<int>& found) const {
  const Vec3 d = chord.b - chord.a;
  const double length = d.norm();
  if (!(length > 0.0)) return true;  // a chord of no length goes with its neighbours
  const int count = static_cast<int>(std::ceil(length / spacing));
  const double reach = 0.5 * kWider * chord.step, beside = kBesideDistance * flat_;
  for (int k = 0; k < count; ++k) {
    const Vec3 c = chord.a + (k + 0.5) / count * d;
    std::array<double, 2 * kPlaces + 1> off2;  // mm^2, distances of the nearest passes at places across the
                                               // chord
    off2.fill(kInfinity);
    tree_.FindWithin(c, reach + 0.5 * chord.step, found);
    for (const int i : found) {
      const PathSegment s = tree_.segment(i);
      const Chord& other = chords_[static_cast<std::size_t>(s.move)];
      if (other.removed || other.path == chord.path) continue;
      const PathRuler ruler(s);
      for (int p = -kPlaces; p <= kPlaces; ++p) {
        double& at = off2[static_cast<std::size_t>(p + kPlaces)];
        at = std::min(at, ruler.Distance2(c + 0.5 * p / kPlaces * chord.step * chord.across));
      }
    }
    if (off2[kPlaces] <= beside * beside) continue;
    if (*std::max_element(off2.begin(), off2.end()) > reach * reach) return false;
  }
  return true;
}

std::vector<Stretch> RedundantPassRemover::StretchesWorthRemoving(std::size_t path,
                                                                  const std::vector<char>& removable) const {
  const std::size_t n = removable.size();
  const bool closed = paths_[path].closed;
  std::size_t start = 0;
  if (closed) {
    while (start < n && removable[start]) ++start;
    start %= n;
  }
  std::vector<Stretch> stretches;
  for (std::size_t k = start; k < start + n;) {
    Stretch s{k, k, 0.0};
    for (; s.last < start + n && removable[s.last % n]; ++s.last)
      s.length += chords_[first_[path] + s.last % n].Length();
    const bool whole = s.last - s.first == n, at_end = !closed && (s.first == 0 || s.last == n);
    const double worth = locator_.radius() * (whole ? 0.0 : at_end ? kMinRemovedAtEnd : kMinRemovedBetween);
    if (s.last > s.first && s.length >= worth) stretches.push_back(s);
    k = s.last + 1;
  }
  // A short remainder between two stretches costs more than it saves: the shorter stretch stays.
  for (std::size_t i = 0; i < stretches.size();) {
    const std::size_t next = (i + 1) % stretches.size();
    if (next == 0 && !closed) break;
    double between = 0.0;
    const std::size_t end = stretches[next].first + (next == 0 ? n : 0);
    for (std::size_t k = stretches[i].last; k < end; ++k) between += chords_[first_[path] + k % n].Length();
    if (next == i || between >= kMinRemainder * locator_.radius()) {
      ++i;
      continue;
    }
    const std::size_t shorter = stretches[i].length < stretches[next].length ? i : next;
    stretches.erase(stretches.begin() + static_cast<std::ptrdiff_t>(shorter));
    if (shorter < i) --i;  // the first stretch was removed, next to the last one
  }
  return stretches;
}

absl::Status RedundantPassRemover::Take(const RunContext& run) {
  std::vector<char> possible(paths_.size(), 0);
  std::vector<std::vector<char>> seems(paths_.size());
  PM_RETURN_IF_ERROR(ParallelFor(run, "redundant passes", paths_.size(), [&](std::size_t k) {
    if (paths_[k].traversal == Traversal::kSpiral || paths_[k].points.size() < 2) return;
    std::vector<int> found;
    for (std::size_t i = first_[k]; i < first_[k + 1] && !run.Cancelled(); ++i) {
      const std::size_t at = i - first_[k];
      const std::vector<CutterPoint>& points = paths_[k].points;
      Measure(chords_[i], points[at], points[(at + 1) % points.size()]);
      seems[k].push_back(SeemsRedundant(chords_[i], kCoarse * flat_, found));
    }
    possible[k] = !run.Cancelled() && !StretchesWorthRemoving(k, seems[k]).empty();
  }));
  PM_RETURN_IF_ERROR(run.Check());
  std::vector<std::size_t> order;
  std::vector<double> length(paths_.size());
  for (std::size_t k = 0; k < paths_.size(); ++k) {
    if (possible[k]) order.push_back(k);
    length[k] = Length(paths_[k]);
  }
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t i, std::size_t k) { return length[i] < length[k]; });
  std::vector<int> found;
  ProgressThrottle throttle;
  for (std::size_t n = 0; n < order.size(); ++n) {
    const std::size_t k = order[n];
    if (throttle.Due()) {
      throttle.Report();
      run.Progress("redundant passes", static_cast<double>(n) / static_cast<double>(order.size()));
    }
    for (std::size_t i = 0; i < seems[k].size() && !run.Cancelled(); ++i)
      seems[k][i] = seems[k][i] && SeemsRedundant(chords_[first_[k] + i], kFine * flat_, found);
    PM_RETURN_IF_ERROR(run.Check());
    for (const Stretch& s : StretchesWorthRemoving(k, seems[k])) {
      for (std::size_t i = s.first; i < s.last; ++i) chords_[first_[k] + i % seems[k].size()].removed = true;
    }
  }
  return absl::OkStatus();
}

std::vector<PathSegment> RedundantPassRemover::Restore(const std::vector<LeftoverSpot>& spots,
                                                       const SegmentTree& removed) {
  std::vector<PathSegment> back;
  std::vector<char> given(paths_.size(), 0);
  const auto give = [&](Chord& chord, int number) {
    if (!chord.removed) return;
    chord.removed = false;
    given[chord.path] = 1;
    back.push_back({chord.a, chord.b, number});
  };
  for (const LeftoverSpot& spot : spots) {
    const int i = removed.FindNearest(spot.at.p, kInfinity).segment;
    PM_CHECK(i >= 0);
    const int number = removed.segment(i).move;
    give(chords_[static_cast<std::size_t>(number)], number);
  }
  for (std::size_t k = 0; k < paths_.size(); ++k) {
    if (!given[k]) continue;
    std::vector<char> still;
    for (std::size_t i = first_[k]; i < first_[k + 1]; ++i) still.push_back(chords_[i].removed);
    std::vector<char> worth(still.size(), 0);
    for (const Stretch& s : StretchesWorthRemoving(k, still)) {
      for (std::size_t i = s.first; i < s.last; ++i) worth[i % worth.size()] = 1;
    }
    for (std::size_t i = 0; i < still.size(); ++i) {
      if (!worth[i]) give(chords_[first_[k] + i], static_cast<int>(first_[k] + i));
    }
  }
  return back;
}

std::vector<CutterPath> RedundantPassRemover::Passes() const {
  std::vector<CutterPath> passes;
  for (std::size_t k = 0; k < paths_.size(); ++k) {
    const CutterPath& path = paths_[k];
    const std::size_t n = first_[k + 1] - first_[k];
    const auto removed = [&](std::size_t i) { return chords_[first_[k] + i % n].removed; };
    std::size_t start = 0;  // the first chord that is removed
    while (start < n && !removed(start)) ++start;
    if (start == n) {
      passes.push_back(path);
      continue;
    }
    if (!path.closed) start = 0;
    CutterPath like_it = path;
    like_it.closed = false;
    like_it.points.clear();
    for (std::size_t i = start; i < start + n;) {
      std::size_t end = i;
      while (end < start + n && !removed(end)) ++end;
      if (end > i) {
        CutterPath part = like_it;
        for (std::size_t p = i; p <= end; ++p) part.points.push_back(path.points[p % path.points.size()]);
        passes.push_back(std::move(part));
      }
      i = end + 1;
    }
  }
  return passes;
}

}  // namespace

absl::StatusOr<std::vector<CutterPath>> RemoveRedundantPasses(const Locator& locator, const Locator& reach,
                                                              std::vector<CutterPath> paths,
                                                              const std::vector<RestPassParams>& parts,
                                                              const RunContext& run) {
  if (paths.empty() || parts.empty()) return paths;
  const PassParams& finest =
      std::min_element(parts.begin(), parts.end(), [](const RestPassParams& a, const RestPassParams& b) {
        return a.pass.scallop < b.pass.scallop;
      })->pass;
  RedundantPassRemover remover(locator, paths, finest, run);
  PM_RETURN_IF_ERROR(remover.Take(run));
  if (remover.Removed().empty()) return paths;
  std::vector<std::unique_ptr<SegmentTree>> owned;
  std::vector<const SegmentTree*> trees;
  const auto grow = [&](std::vector<PathSegment> more) {
    owned.push_back(std::make_unique<SegmentTree>(std::move(more), Metric::kPath, kInfinity, run));
    trees.push_back(owned.back().get());
  };
  grow(remover.Kept());
  std::vector<SurfaceRect> whole;
  for (const SurfaceLeaf& leaf : locator.surface().leaves)
    whole.push_back({leaf.piece, leaf.u0, leaf.u1, leaf.v0, leaf.v1});
  for (const RestPassParams& part : parts) {
    // Check the finish first; then the limit, which is proven wherever it was kept before.
    for (const bool finish : {true, false}) {
      RestPassParams params = part;
      if (finish) {
        params.forced = {};
        params.limit = std::min(part.limit, kRedundantLimit * part.pass.scallop);
        params.margin = kProof * part.pass.scallop;
        params.removed_margin = std::min(kProof * part.pass.scallop, kRemovedMarginShare * part.tolerance);
        params.coarse_where_both_exceed = true;
      } else {
        // Together the margins are what RestPaths may add to the limit.
        params.margin = (kProofMargin - kRemovedMarginShare) * part.tolerance;
        params.removed_margin = kRemovedMarginShare * part.tolerance;
      }
      std::vector<SurfaceRect> rects = whole;
      while (!rects.empty()) {
        const SegmentTree removed(remover.Removed(), Metric::kPath, kInfinity, run);
        params.removed = &removed;
        PM_ASSIGN_OR_RETURN(const std::vector<LeftoverSpot> spots,
                            FindSpots({locator, reach}, trees, rects, params, run));
        // A restored chord uncovers nothing: only the rectangles of the spots need another look.
        rects.clear();
        for (const LeftoverSpot& spot : spots) rects.push_back(spot.rect);
        if (!spots.empty()) grow(remover.Restore(spots, removed));
      }
    }
  }
  return remover.Passes();
}

}  // namespace patchmill
