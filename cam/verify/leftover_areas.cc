#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <optional>
#include <unordered_map>

#include "cam/verify/beyond_strategy.h"
#include "cam/verify/leftover.h"
#include "core/base/parallel.h"
#include "core/base/status.h"

namespace patchmill {

namespace {

// The largest number of quarterings, and the number of cells that they may take, about.
struct Spent {
  int deepest;
  double cells;
};
constexpr Spent kBorder = {5, 60'000};   // for the border of the reachable set
constexpr Spent kReasons = {4, 2'000};   // for borders between two reasons
constexpr Spent kFinish = {4, 250'000};  // for all reachable cells if something is not finished
constexpr double kFarSlack = 0.02;       // relative error of the distance of far unreachable points
constexpr double kNear = 2.0;            // of R: nearer unreachable points are measured exactly

// One point of the surface.
struct Sample {
  std::optional<FinishClass> kind;  // nullopt where the surface has no normal; it has no area there
  double element = 0.0;             // |S_u x S_v|
  double plan_element = 0.0;        // its part along Z
};

struct Sums {
  AreaReport report;
  // Places of report.lowest_center, report.raise and report.deepest, as rectangles without size.
  CellRect lowest;
  EnumArray<UpperPart, CellRect> raised;
  EnumArray<FinishClass, CellRect> deepest;
};

// A place on a piece. Cells share corners. Halving is exact, so equal places have equal parameters.
struct PiecePlace {
  PieceId piece;
  double u, v;
  bool operator==(const PiecePlace&) const = default;
};

SurfaceJet EvaluateAt(const Surface& surface, const PiecePlace& at) {
  return Evaluate(surface, at.piece, at.u, at.v);
}

// Height of the centre over a point that only the floor makes unreachable, mm; infinity for other points.
double CenterBelowFloor(const Surface& surface, const PiecePlace& at, const ReachParams& reach) {
  const SurfaceJet jet = EvaluateAt(surface, at);
  const auto facing = FacingAt(jet);
  if (!facing || ReachAt(surface, jet.p, *facing, reach) != ReachClass::kFloor) return kInfinity;
  ReachParams lower = reach;
  lower.floor_z = -kInfinity;
  if (ReachAt(surface, jet.p, *facing, lower) != ReachClass::kReachable) return kInfinity;
  return jet.p.z() + reach.radius * facing->e.z();
}

// RaiseNeeded of a place; known.by if there is no normal.
double RaiseAt(const Surface& surface, const PiecePlace& at, const ReachParams& reach,
               const PartRaise& known) {
  const SurfaceJet jet = EvaluateAt(surface, at);
  const auto facing = FacingAt(jet);
  return facing ? RaiseNeeded(surface, jet.p, *facing, reach, known) : known.by;
}

// The smallest value that a pattern search finds in the piece around a place with the value `best`.
// value(place, best) may return anything >= best if the value is not smaller.
template <class Value>
double LeastAround(const CellRect& place, double best, const Value& value) {
  double u = place.u0, v = place.v0;
  if (!std::isfinite(best)) return best;
  int left = 2000;  // evaluations
  for (double step = 0.0625; step > 1e-6; step *= 0.5) {
    for (int k = 0; k < 9 && left > 0; ++k, --left) {
      const double x = std::clamp(u + (k / 3 - 1) * step, 0.0, 1.0);
      const double y = std::clamp(v + (k % 3 - 1) * step, 0.0, 1.0);
      const double z = value({place.piece, x, y}, best);
      if (z >= best - 1e-9) continue;
      best = z;
      u = x;
      v = y;
      k = -1;  // start again around the new place
    }
  }
  return best;
}

// What the samples of a cell show.
struct Limits {
  bool border = false;   // the border of the reachable set crosses the cell
  bool reasons = false;  // a border between two reasons crosses the cell
  bool reached = false;  // the cell has reachable places
  bool finish = false;   // some of these are not finished
};

struct PlaceHash {
  std::size_t operator()(const PiecePlace& at) const {
    auto h = static_cast<std::uint64_t>(at.piece.value);
    for (const double x : {at.u, at.v}) h = (h ^ std::bit_cast<std::uint64_t>(x)) * 0x9e3779b97f4a7c15ULL;
    return static_cast<std::size_t>(h ^ (h >> 32));
  }
};

// How often this many cells may be quartered if their number grows `more` times with each quartering. The
// cells along a line double.
int DeepestFor(std::size_t cells, const Spent& spent, double more = 2.0) {
  int deepest = 1;
  while (deepest < spent.deepest && static_cast<double>(cells) * std::pow(more, deepest + 1) <= spent.cells) {
    ++deepest;
  }
  return deepest;
}

bool Unreachable(FinishClass kind) {
  return kind == FinishClass::kUndercut || kind == FinishClass::kConcave || kind == FinishClass::kFloor ||
         kind == FinishClass::kAvoided || kind == FinishClass::kShank || kind == FinishClass::kHolder ||
         kind == FinishClass::kOutside || kind == FinishClass::kUnderside;
}

// True for a reachable place, finished or not.
bool Reached(FinishClass kind) {
  return kind == FinishClass::kDone || kind == FinishClass::kAboveLimit || kind == FinishClass::kStrategy;
}

class AreaSampler {
 public:
  // Cells are quartered `border` times at the border of the reachable set and `reasons` times between
  // reasons. They are not quartered at the edge of unfinished places: ridges between passes are narrower than
  // cells, so quartering only the cells whose samples meet a ridge would underestimate their area.
  AreaSampler(const Surface& surface, const SegmentTree& tree, const LeftoverParams& params, int border,
              int reasons)
      : surface_(surface), tree_(tree), params_(params), border_(border), reasons_(reasons) {}

  // Adds the areas of the cell, which is quartered at least `all` times. Returns what its samples show.
  Limits Add(const CellRect& cell, int depth, int all, Sums& sums) {
    // Samples at the middle and the corners show whether a border crosses the cell. The weights make the area
    // exact for a cubic area element.
    constexpr double kMiddleWeight = 2.0 / 3.0, kCornerWeight = 1.0 / 12.0;
    const std::array<const Sample*, 5> samples = {
        &At({cell.piece, cell.u0, cell.v0}, sums), &At({cell.piece, cell.u0, cell.v1}, sums),
        &At({cell.piece, cell.u1, cell.v0}, sums), &At({cell.piece, cell.u1, cell.v1}, sums),
        &At({cell.piece, cell.u(), cell.v()}, sums)};
    const std::optional<FinishClass> middle = samples[4]->kind;
    Limits limits;
    for (const Sample* sample : samples) {
      if (sample->kind && Reached(*sample->kind)) {
        limits.reached = true;
        limits.finish = limits.finish || *sample->kind != FinishClass::kDone;
      }
      if (!middle || !sample->kind || *sample->kind == *middle) continue;
      if (!Reached(*middle) || !Reached(*sample->kind))
        (Unreachable(*middle) && Unreachable(*sample->kind) ? limits.reasons : limits.border) = true;
    }
    if (depth < all || (limits.border && depth < border_) || (limits.reasons && depth < reasons_)) {
      for (int k = 0; k < 4; ++k) {
        CellRect part = cell;
        (k / 2 == 0 ? part.u1 : part.u0) = cell.u();
        (k % 2 == 0 ? part.v1 : part.v0) = cell.v();
        Add(part, depth + 1, all, sums);
      }
      return limits;
    }
    const double size = (cell.u1 - cell.u0) * (cell.v1 - cell.v0);
    for (std::size_t k = 0; k < 5; ++k) {
      if (!samples[k]->kind) continue;
      const double weight = size * (k == 4 ? kMiddleWeight : kCornerWeight);
      sums.report.area[*samples[k]->kind] += weight * samples[k]->element;
      sums.report.plan_area[*samples[k]->kind] += weight * samples[k]->plan_element;
    }
    return limits;
  }

  // The largest leftover of a class around a sample with much of it.
  Extreme DeepestAround(FinishClass kind, const Extreme& sample, const CellRect& place) {
    Extreme deepest = sample;
    LeastAround(place, -sample.value, [&](const PiecePlace& at, double best) {
      Sums here;
      if (Classify(EvaluateAt(surface_, at), at, here) != kind) return best;
      const Extreme& found = here.report.deepest[kind];
      if (found.value > deepest.value) deepest = found;
      return std::min(best, -found.value);
    });
    return deepest;
  }

 private:
  const Sample& At(const PiecePlace& place, Sums& sums) {
    const auto [at, added] = samples_.try_emplace(place);
    if (added) {
      const SurfaceJet jet = EvaluateAt(surface_, place);
      const Vec3 across = jet.du.cross(jet.dv);
      at->second = {Classify(jet, place, sums), across.norm(), std::abs(across.z())};
      const auto& [piece, u, v] = place;
      if (at->second.kind == FinishClass::kFloor) {
        const double z = CenterBelowFloor(surface_, place, params_.reach);
        if (z < sums.report.lowest_center) {
          sums.report.lowest_center = z;
          sums.lowest = {piece, u, u, v, v};
        }
      }
      if (at->second.kind == FinishClass::kShank || at->second.kind == FinishClass::kHolder) {
        const UpperPart part =
            at->second.kind == FinishClass::kShank ? UpperPart::kShank : UpperPart::kHolder;
        const double raise = RaiseAt(surface_, place, params_.reach, {part, sums.report.raise[part]});
        if (raise > sums.report.raise[part]) {
          sums.report.raise[part] = raise;
          sums.raised[part] = {piece, u, u, v, v};
        }
      }
    }
    return at->second;
  }

  std::optional<FinishClass> Classify(const SurfaceJet& jet, const PiecePlace& place, Sums& sums) {
    const auto facing = FacingAt(jet);
    if (!facing) return std::nullopt;
    const SurfacePoint at{place.piece, place.u, place.v, jet.p};
    if (!IsWantedAt(surface_, params_, at)) return FinishClass::kUnwanted;
    FinishClass kind = FinishClass::kDone;
    switch (ReachOn(surface_, at, *facing, params_.reach, obstacles_)) {
      case ReachClass::kReachable:
        break;
      case ReachClass::kUndercut:
        kind = FinishClass::kUndercut;
        break;
      case ReachClass::kConcave:
        kind = FinishClass::kConcave;
        break;
      case ReachClass::kFloor:
        kind = FinishClass::kFloor;
        break;
      case ReachClass::kAvoided:
        kind = FinishClass::kAvoided;
        break;
      case ReachClass::kShank:
        kind = FinishClass::kShank;
        break;
      case ReachClass::kHolder:
        kind = FinishClass::kHolder;
        break;
      case ReachClass::kOutside:
        kind = FinishClass::kOutside;
        break;
    }
    if (Unreachable(kind) && jet.sides.IsUnderside(jet.du.cross(jet.dv).normalized().z()))
      return FinishClass::kUnderside;
    Extreme& known = sums.report.deepest[kind];
    if (hint_ >= 0) {
      // Any move is an upper bound for the distance, so most points need no search.
      const double most = tree_.Distance(hint_, jet.p) + params_.chord_error - params_.reach.radius;
      if (most <= known.value && (kind != FinishClass::kDone || most <= params_.limit)) return kind;
    }
    const double slack = kind == FinishClass::kDone ? 0.0 : kFarSlack;
    auto nearest = tree_.FindNearest(jet.p, kInfinity, hint_, slack);
    if (slack > 0.0 && nearest.distance < kNear * params_.reach.radius) {
      nearest = tree_.FindNearest(jet.p, kInfinity, nearest.segment);
    }
    hint_ = nearest.segment;
    const double left = std::min(params_.most, nearest.distance + params_.chord_error - params_.reach.radius);
    if (kind == FinishClass::kDone && left > params_.limit) {
      kind = BeyondStrategy(jet, *facing, params_) ? FinishClass::kStrategy : FinishClass::kAboveLimit;
    }
    Extreme& deepest = sums.report.deepest[kind];
    if (left > deepest.value) {
      deepest = {left, jet.p, place.piece, nearest.segment < 0 ? -1 : tree_.segment(nearest.segment).move};
      sums.deepest[kind] = {place.piece, place.u, place.u, place.v, place.v};
    }
    return kind;
  }

  const Surface& surface_;
  const SegmentTree& tree_;
  const LeftoverParams& params_;
  int border_, reasons_;
  Obstacles obstacles_;
  int hint_ = -1;
  std::unordered_map<PiecePlace, Sample, PlaceHash> samples_;
};

}  // namespace

bool IsWantedAt(const Surface& surface, const LeftoverParams& params, const SurfacePoint& at) {
  if (params.where != nullptr && !params.where->Has(at.piece, at.u, at.v)) return false;
  const Containment* containment = params.reach.limits.containment;
  return containment == nullptr || IsWanted(*containment, surface.piece(at.piece).patch, at.p);
}

absl::StatusOr<AreaReport> MeasureAreas(const RootedSurface& rooted, const SegmentTree& tree,
                                        const LeftoverParams& params, const RunContext& run) {
  const Surface& surface = rooted.surface;
  const std::vector<CellRect>& roots = rooted.roots;
  constexpr std::size_t kChunk = 64;  // roots in one task
  const std::size_t chunks = (roots.size() + kChunk - 1) / kChunk;
  std::vector<Sums> parts(chunks);
  std::vector<Limits> limits(roots.size());
  std::vector<char> again(roots.size(), 0);  // 1 if the root's areas are measured in the second round
  // The first round takes all roots as they are. The second quarters those with borders, as finely as the
  // number of these roots allows.
  PM_RETURN_IF_ERROR(ParallelFor(run, "verify: reach", chunks, [&](std::size_t chunk) {
    AreaSampler sampler(surface, tree, params, 0, 0);
    EnumArray<FinishClass, double>& area = parts[chunk].report.area;
    const std::size_t end = std::min(roots.size(), (chunk + 1) * kChunk);
    for (std::size_t i = chunk * kChunk; i < end && !run.Cancelled(); ++i) {
      const EnumArray<FinishClass, double> before = area;
      limits[i] = sampler.Add(roots[i], 0, 0, parts[chunk]);
      again[i] = limits[i].border || limits[i].reasons;
      if (again[i]) area = before;
    }
  }));
  std::size_t with_border = 0, with_reasons = 0, reached = 0, unfinished = 0;
  for (const Limits& limit : limits) {
    with_border += limit.border;
    with_reasons += limit.reasons;
    reached += limit.reached;
    unfinished += limit.finish;
  }
  const int border = DeepestFor(with_border, kBorder), reasons = DeepestFor(with_reasons, kReasons),
            finish = unfinished > 0 ? DeepestFor(reached, kFinish, 4.0) : 0;
  PM_RETURN_IF_ERROR(ParallelFor(run, "verify: limits of reach", chunks, [&](std::size_t chunk) {
    AreaSampler sampler(surface, tree, params, border, reasons);
    const std::size_t end = std::min(roots.size(), (chunk + 1) * kChunk);
    for (std::size_t i = chunk * kChunk; i < end && !run.Cancelled(); ++i) {
      const int all = limits[i].reached ? finish : 0;
      if (!again[i] && all == 0) continue;
      if (!again[i]) {
        Sums known;
        sampler.Add(roots[i], 0, 0, known);
        for (const FinishClass kind : Enumerators<FinishClass>())
          parts[chunk].report.area[kind] -= known.report.area[kind];
      }
      sampler.Add(roots[i], 0, all, parts[chunk]);
    }
  }));
  Sums sums;
  for (const Sums& part : parts) {
    for (const FinishClass kind : Enumerators<FinishClass>()) {
      sums.report.area[kind] += part.report.area[kind];
      sums.report.plan_area[kind] += part.report.plan_area[kind];
      if (part.report.deepest[kind].value > sums.report.deepest[kind].value) {
        sums.report.deepest[kind] = part.report.deepest[kind];
        sums.deepest[kind] = part.deepest[kind];
      }
    }
    if (part.report.lowest_center < sums.report.lowest_center) {
      sums.report.lowest_center = part.report.lowest_center;
      sums.lowest = part.lowest;
    }
    for (const UpperPart upper : Enumerators<UpperPart>()) {
      if (part.report.raise[upper] <= sums.report.raise[upper]) continue;
      sums.report.raise[upper] = part.report.raise[upper];
      sums.raised[upper] = part.raised[upper];
    }
  }
  for (const FinishClass kind : Enumerators<FinishClass>()) {
    const Extreme& sample = sums.report.deepest[kind];
    if (!(sample.value > 0.0) || !(Unreachable(kind) || kind == FinishClass::kStrategy)) continue;
    PM_RETURN_IF_ERROR(run.Check());
    sums.report.deepest[kind] =
        AreaSampler(surface, tree, params, 0, 0).DeepestAround(kind, sample, sums.deepest[kind]);
  }
  sums.report.lowest_center =
      LeastAround(sums.lowest, sums.report.lowest_center,
                  [&](const PiecePlace& at, double) { return CenterBelowFloor(surface, at, params.reach); });
  for (const UpperPart part : Enumerators<UpperPart>()) {
    double& raise = sums.report.raise[part];
    if (!(raise > 0.0)) continue;
    raise = -LeastAround(sums.raised[part], -raise, [&](const PiecePlace& at, double best) {
      return -RaiseAt(surface, at, params.reach, {part, -best});
    });
  }
  return sums.report;
}

}  // namespace patchmill
