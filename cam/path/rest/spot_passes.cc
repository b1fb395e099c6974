#include "cam/path/rest/spot_passes.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "cam/limits/reach_tolerance.h"
#include "cam/location/free_center.h"
#include "cam/path/chord/chord_bounds.h"
#include "cam/path/chord/chord_thinning.h"
#include "cam/path/chord/scan_line.h"
#include "cam/path/edge/limits_clip.h"
#include "cam/path/rest/pencil_trace.h"
#include "cam/path/stepover/step_over.h"
#include "cam/path/zlevel/level_trace.h"
#include "core/base/progress_throttle.h"
#include "core/base/status.h"
#include "core/spatial/point_cells.h"

namespace patchmill {
namespace {

// Part of ReachTolerance by which centres between walls that leave no room may gouge.
constexpr double kWedgeGougeShare = 0.1;
// Parts of ReachTolerance for centres and chords where no other pass serves: in slots and holes narrower
// than the ball by some of the tolerance, which admits it. The certificates' share is included, since these
// passes are proven by themselves.
constexpr double kWedge = 1.15, kWedgedChord = 1.2;
constexpr double kSamePlace = 1e-6;             // mm: centres this near to each other count as one
const double kSteep = std::cos(Radians(60.0));  // of walls: scan lines over them would climb at every turn

// The parameters of passes that stay straight: their chords may use the share of arcs, too.
PassParams StraightPass(const RestPassParams& params) {
  PassParams pass = params.pass;
  pass.chord_tolerance = ReachTolerance(params.tolerance);
  return pass;
}

std::vector<Vec3> CentersOf(const std::vector<LeftoverSpot>& spots) {
  std::vector<Vec3> centers;
  centers.reserve(spots.size());
  for (const LeftoverSpot& spot : spots) centers.push_back(spot.center);
  return centers;
}

class RestPassMaker {
 public:
  RestPassMaker(const Locator& locator, const std::vector<LeftoverSpot>& spots, const RestPassParams& params,
                const RunContext& run)
      : locator_(locator),
        spots_(spots),
        params_(params),
        straight_(StraightPass(params)),
        run_(run),
        radius_(locator.radius()),
        flat_(CenterStep(locator.radius(), params.pass.scallop, 0.0)),
        border_(locator.surface(), params.pass.roll),
        cells_(CentersOf(spots), flat_),
        open_(spots.size(), true),
        wedge_gouge_(kWedgeGougeShare * straight_.chord_tolerance),
        asked_(spots.size(), false),
        wedge_asked_(spots.size(), false),
        free_(spots.size()),
        wedged_(spots.size()) {
    for (const LeftoverSpot& spot : spots_) highest_ = std::max(highest_, spot.center.z());
  }

  absl::StatusOr<std::vector<CutterPath>> Run(RestMethod method);

 private:
  bool Gentle(std::size_t i) const { return spots_[i].normal.z() > kSteep; }
  Vec2 Level(std::size_t i) const;
  bool Needed(const Vec3& c, double reach) const;
  bool AlongPencil(std::size_t i);
  bool AlongRidge(std::size_t i);
  bool AlongLevel(std::size_t i);
  bool AlongCenters(std::size_t i, bool wedged = false);
  const std::optional<Vec3>& FreeNear(std::size_t i);
  const std::optional<Vec3>& WedgedNear(std::size_t i);
  bool Tight(std::size_t i);
  void FromAbove(std::size_t i);
  std::size_t NextOnRidge(const Vec3& from, const Vec3& heading, bool gentle,
                          const std::vector<bool>& used) const;
  std::vector<std::size_t> Chain(std::size_t i, bool gentle) const;
  bool LevelIsMissing(std::size_t i) const;
  std::vector<CutterPath> Allowed(CutterPath pass) const;
  bool Add(PassKind kind, std::vector<CutterPoint> points);

  const Locator& locator_;
  const std::vector<LeftoverSpot>& spots_;
  const RestPassParams& params_;
  const PassParams straight_;  // of rest passes; pencil passes may become arcs
  const RunContext& run_;
  const double radius_;
  const double flat_;
  const SheetBorder border_;
  const PointCells cells_;       // of the spots' centres
  std::vector<bool> open_;       // not finished yet
  double highest_ = -kInfinity;  // of the spots' centres
  const double wedge_gouge_;
  std::vector<bool> asked_, wedge_asked_;           // by FreeNear, WedgedNear
  std::vector<std::optional<Vec3>> free_, wedged_;  // their answers
  std::optional<LevelContext> levels_;
  int level_count_ = 0;
  std::vector<CutterPath> paths_;
};

bool RestPassMaker::Needed(const Vec3& c, double reach) const {
  bool needed = false;
  cells_.Near(c, reach, [&](std::size_t i) { needed |= open_[i]; });
  return needed;
}

std::vector<CutterPath> RestPassMaker::Allowed(CutterPath pass) const {
  if (params_.operation_limits == nullptr) return {std::move(pass)};
  auto parts = ClipToLimits(locator_, *params_.operation_limits, {std::move(pass)}, flat_, run_);
  return parts.ok() ? *std::move(parts) : std::vector<CutterPath>();  // only a cancelled clip fails
}

// Keeps the allowed parts of the pass that finish an open spot, and closes the spots that they finish.
bool RestPassMaker::Add(PassKind kind, std::vector<CutterPoint> points) {
  if (points.size() < 2) return false;
  bool any = false;
  const double limit = radius_ + params_.limit;
  for (CutterPath& part : Allowed({.kind = kind, .points = std::move(points)})) {
    bool useful = false;
    for (std::size_t k = 0; k + 1 < part.points.size(); ++k) {
      const Vec3 &a = part.points[k].center, &b = part.points[k + 1].center;
      const double length = (b - a).norm();
      // A ball that finishes p stands near p's own centre. Look there.
      cells_.Near(0.5 * (a + b), 0.5 * length + flat_, [&](std::size_t i) {
        if (open_[i] && SegmentDistance(spots_[i].at.p, a, b) <= limit) {
          open_[i] = false;
          useful = true;
        }
      });
    }
    if (!useful) continue;
    any = true;
    part.order_key = static_cast<int>(paths_.size());
    paths_.push_back(std::move(part));
  }
  return any;
}

bool RestPassMaker::AlongPencil(std::size_t i) {
  const auto seed = FindPencilPoint(locator_, Xy(spots_[i].center), 0.75 * flat_, params_.pass, run_);
  if (!seed || (seed->center - spots_[i].center).norm() > flat_) return false;
  const PencilWanted wanted{[&](const Vec3& c) { return !run_.Cancelled() && Needed(c, 0.75 * flat_); },
                            3.0 * flat_};
  const auto stations = TracePencil(locator_, border_, *seed, params_.pass, wanted);
  if (stations.size() < 2) return false;
  Add(PassKind::kPencil, ThinStations(locator_, stations, params_.pass, &run_));
  return !open_[i];
}

// Returns the open spot one step on in this direction that leaves most; spots_.size() if there is none.
std::size_t RestPassMaker::NextOnRidge(const Vec3& from, const Vec3& heading, bool gentle,
                                       const std::vector<bool>& used) const {
  // Scan lines may also cross a few steps of covered surface, as between the ends of lines at a slanting
  // border. The pass is longer than needed, but it is one instead of many.
  const double reach = (gentle ? 6.0 : 1.6) * flat_;
  std::size_t best = spots_.size();
  double best_score = -kInfinity;
  cells_.Near(from, reach, [&](std::size_t i) {
    if (!open_[i] || used[i] || Gentle(i) != gentle) return;
    const Vec3 d = spots_[i].center - from;
    const double length = d.norm();
    if (length < 0.4 * flat_) return;
    const double straight = heading.isZero() ? 1.0 : d.dot(heading) / length;
    if (straight < (length < 1.6 * flat_ ? 0.6 : 0.85)) return;
    const double score = spots_[i].leftover * straight / (1.0 + length / flat_);
    if (score > best_score || (score == best_score && i < best)) {
      best_score = score;
      best = i;
    }
  });
  return best;
}

Vec2 RestPassMaker::Level(std::size_t i) const {
  const Vec2 n = Xy(spots_[i].normal);
  return n.norm() > 1e-3 ? Vec2(Vec2(-n.y(), n.x()).normalized()) : Vec2(Vec2::UnitX());
}

// Returns the spots along the ridge through i, both ways. On walls it looks along the level first.
std::vector<std::size_t> RestPassMaker::Chain(std::size_t i, bool gentle) const {
  const Vec2 level = Level(i);
  std::vector<bool> used(spots_.size(), false);
  used[i] = true;
  std::vector<std::size_t> chain{i};
  // Most spots of one chain.
  constexpr std::size_t kLongest = 2000;
  for (int end = 0; end < 2; ++end) {
    Vec3 heading = gentle ? Vec3(Vec3::Zero()) : Lift(end == 0 ? level : Vec2(-level), 0.0);
    if (chain.size() > 1) {
      heading =
          (spots_[chain[chain.size() - 1]].center - spots_[chain[chain.size() - 2]].center).normalized();
    }
    while (chain.size() < kLongest) {
      const Vec3 from = spots_[chain.back()].center;
      const std::size_t next = NextOnRidge(from, heading, gentle, used);
      if (next == spots_.size()) break;
      heading = (spots_[next].center - from).normalized();
      used[next] = true;
      // The step serves the spots beside it.
      const Vec3 to = spots_[next].center;
      cells_.Near(0.5 * (to + from), 0.5 * (to - from).norm() + 0.4 * flat_, [&](std::size_t k) {
        if (SegmentDistance(spots_[k].center, from, to) < 0.4 * flat_) used[k] = true;
      });
      chain.push_back(next);
    }
    std::reverse(chain.begin(), chain.end());
  }
  return chain;
}

bool RestPassMaker::AlongRidge(std::size_t i) {
  const std::vector<std::size_t> chain = Chain(i, true);
  std::vector<Vec2> corners;
  for (std::size_t k : chain) corners.push_back(Xy(spots_[k].center));
  // Add half a step at both ends, so that what lies between the samples is covered too.
  const Vec2 level = Level(i);
  const auto beyond = [&](const Vec2& end, const Vec2& before) -> Vec2 {
    const Vec2 d = end - before;
    return end + 0.3 * flat_ * (d.norm() > 1e-6 ? Vec2(d.normalized()) : level);
  };
  corners.insert(corners.begin(),
                 beyond(corners.front(), corners.size() > 1 ? corners[1] : Vec2(corners[0] + level)));
  corners.push_back(beyond(corners.back(), corners[corners.size() - 2]));
  bool added = false;
  for (ScanRun& run : ScanPolyline(locator_, corners, straight_, &run_))
    added |= Add(PassKind::kRest, std::move(run.points));
  return added && !open_[i];
}

// Adds the parts of the level through a wall spot that pass open spots.
bool RestPassMaker::AlongLevel(std::size_t i) {
  if (!levels_) levels_.emplace(locator_, run_);
  ContourParams contour;
  contour.pass = straight_;
  const LevelContours level = TraceLevel(*levels_, spots_[i].center.z(), contour, run_);
  const double reach = 0.75 * flat_;
  for (const CutterPath& loop : level.loops) {
    const std::size_t n = loop.points.size();
    if (n < 2) continue;
    const std::size_t moves = loop.closed ? n : n - 1;
    // Cut the chords short, so that a part is not much longer than its purpose requires.
    std::vector<CutterPoint> fine;
    for (std::size_t k = 0; k < moves; ++k) {
      const CutterPoint &a = loop.points[k], &b = loop.points[(k + 1) % n];
      const int parts = 1 + static_cast<int>((b.center - a.center).norm() / flat_);
      for (int j = 0; j < parts; ++j) {
        CutterPoint p = a;
        if (j > 0) {
          p.center += (b.center - a.center) * (static_cast<double>(j) / parts);
          p.other_contact.reset();
        }
        fine.push_back(p);
      }
    }
    if (!loop.closed) fine.push_back(loop.points.back());
    const std::size_t m = fine.size();
    std::vector<bool> wanted(m);
    bool any = false, all = true;
    for (std::size_t k = 0; k < m; ++k) {
      wanted[k] = Needed(fine[k].center, reach);
      any |= wanted[k];
      all &= wanted[k];
    }
    if (!any) continue;
    std::size_t start = 0;  // of a closed loop: a place where nothing is wanted
    if (loop.closed && !all) {
      while (wanted[start]) ++start;
    }
    std::vector<CutterPoint> part;
    const std::size_t count = loop.closed ? m + 1 : m;
    for (std::size_t k = 0; k < count; ++k) {
      const std::size_t at = (start + k) % m;
      if (wanted[at]) {
        part.push_back(fine[at]);
      } else if (!part.empty()) {
        Add(PassKind::kRest, std::move(part));
        part.clear();
      }
    }
    Add(PassKind::kRest, std::move(part));
  }
  return !open_[i];
}

// Returns a centre that leaves less at the spot than the passes so far.
const std::optional<Vec3>& RestPassMaker::FreeNear(std::size_t i) {
  if (!asked_[i]) {
    asked_[i] = true;
    const LeftoverSpot& spot = spots_[i];
    free_[i] = FreeCenterNear(
        locator_, spot.at.p, spot.normal,
        {.lowest_z = params_.pass.floor_z + radius_, .most = spot.leftover, .gouge = wedge_gouge_});
  }
  return free_[i];
}

// Returns, where there is none, a centre that gouges as much as it may.
const std::optional<Vec3>& RestPassMaker::WedgedNear(std::size_t i) {
  if (FreeNear(i)) return free_[i];
  if (!wedge_asked_[i]) {
    wedge_asked_[i] = true;
    const LeftoverSpot& spot = spots_[i];
    wedged_[i] = FreeCenterNear(locator_, spot.at.p, spot.normal,
                                {.lowest_z = params_.pass.floor_z + radius_,
                                 .most = spot.leftover,
                                 .gouge = kWedge * straight_.chord_tolerance,
                                 .wedged = true});
  }
  return wedged_[i];
}

// Has the ball no room there? Then free centres are a line or a point, which no height or level finds.
bool RestPassMaker::Tight(std::size_t i) { return FreeNear(i) && !locator_.Free(*FreeNear(i)); }

// Goes from spot to spot. The swept query proves every chord; the pass ends where it does not.
bool RestPassMaker::AlongCenters(std::size_t i, bool wedged) {
  const auto near = [&](std::size_t k) -> const std::optional<Vec3>& {
    return wedged ? WedgedNear(k) : FreeNear(k);
  };
  if (!near(i)) return false;
  const double limit = (wedged ? kWedgedChord : 1.0) * straight_.chord_tolerance;
  std::vector<CutterPoint> points;
  for (std::size_t k : Chain(i, Gentle(i))) {
    if (run_.Cancelled()) return false;
    const std::optional<Vec3>& c = near(k);
    if (!c) continue;
    if (!points.empty()) {
      const Vec3& last = points.back().center;
      if ((*c - last).norm() < kSamePlace) continue;
      const bool proven =
          (!wedged && ChordGouge(radius_ - wedge_gouge_, (*c - last).norm()) + wedge_gouge_ <= limit) ||
          locator_.GougeWithin(last, *c, limit, (wedged ? 0.02 : 0.1) * straight_.chord_tolerance);
      if (!proven) {
        Add(PassKind::kRest, std::move(points));
        points.clear();
      }
    }
    points.push_back({*c, spots_[k].at, {}});
  }
  Add(PassKind::kRest, std::move(points));
  return !open_[i];
}

// Adds a plunge through all that is open above: upward of a free place everything is free. In a hole as wide
// as the ball it is the only possible pass.
void RestPassMaker::FromAbove(std::size_t i) {
  if (const std::optional<Vec3>& c = WedgedNear(i)) {
    const SurfacePoint& at = spots_[i].at;
    Vec3 top = *c + Vec3(0, 0, 0.1 * flat_);
    while (top.z() < highest_ && Needed(top, 0.75 * flat_)) top.z() += 0.5 * flat_;
    Add(PassKind::kRest, {{top, at, {}}, {*c, at, {}}});
  }
  open_[i] = false;
}

// Are there many open wall spots at this height nearby? Then a stretch of level is missing, not a spot.
bool RestPassMaker::LevelIsMissing(std::size_t i) const {
  const Vec3& c = spots_[i].center;
  std::size_t count = 0;
  cells_.Near(c, 10.0 * flat_, [&](std::size_t k) {
    count += open_[k] && !Gentle(k) && std::abs(spots_[k].center.z() - c.z()) < 0.3 * flat_;
  });
  return count >= 15;
}

absl::StatusOr<std::vector<CutterPath>> RestPassMaker::Run(RestMethod method) {
  std::vector<std::size_t> order(spots_.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return spots_[a].leftover > spots_[b].leftover; });
  const std::size_t report_every = order.size() / 64 + 1;
  ProgressThrottle throttle;
  for (std::size_t n = 0; n < order.size(); ++n) {
    const std::size_t i = order[n];
    if (n % report_every == 0 || throttle.Due()) {
      throttle.Report();
      run_.Progress("coverage: passes", static_cast<double>(n) / static_cast<double>(order.size()));
    }
    if (!open_[i]) continue;
    PM_RETURN_IF_ERROR(run_.Check());
    if (method == RestMethod::kCentersOnly || Tight(i)) {
      if (AlongCenters(i)) continue;
    } else if (Gentle(i)) {
      if (AlongPencil(i) || AlongRidge(i) || AlongCenters(i)) continue;
    } else {
      // A level costs as much as hundreds of chords over walls.
      constexpr int kMostLevels = 24;
      if (level_count_ < kMostLevels && LevelIsMissing(i)) {
        ++level_count_;
        if (AlongLevel(i)) continue;
      }
      if (!open_[i] || AlongCenters(i)) continue;
    }
    if (!FreeNear(i) && AlongCenters(i, true)) continue;
    FromAbove(i);
  }
  PM_RETURN_IF_ERROR(run_.Check());  // a cancelled line was cut short
  return std::move(paths_);
}

}  // namespace

absl::StatusOr<std::vector<CutterPath>> RestPassesAt(const Locator& locator,
                                                     const std::vector<LeftoverSpot>& spots,
                                                     const RestPassParams& params, RestMethod method,
                                                     const RunContext& run) {
  return RestPassMaker(locator, spots, params, run).Run(method);
}

}  // namespace patchmill
