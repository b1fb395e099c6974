#include "cam/path/edge/rim_passes.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "cam/path/chord/scan_line.h"
#include "cam/path/edge/sheet_border.h"
#include "cam/path/stepover/step_over.h"
#include "core/base/status.h"
#include "core/spatial/point_cells.h"
#include "core/surface/closest.h"

namespace patchmill {
namespace {

constexpr double kSpacing = 0.5;    // flat step-overs: between places on a border
constexpr double kMaxRimGap = 2.0;  // ball radii: largest gap between two lines of one run
constexpr double kBeyond = 2.0;     // flat step-overs: overrun before the first line and after the last
constexpr double kLook = 0.5;       // ball radii: between tested places of a line
constexpr double kThin = 0.02;      // flat step-overs: how far the pass may be off the rim in plan

// Returns the points that a path touches, at every vertex and often enough between them, if all of the path
// rolls over an open edge; else nothing. A straight line over a sheet has only its ends on the edge.
std::vector<Vec3> RolledOver(const CutterPath& path, const Surface& surface, const SheetBorder& border,
                             double radius) {
  std::vector<Vec3> touched;
  if (path.kind != PassKind::kZigzag || path.closed) return touched;
  const auto rolls = [&](const SurfacePoint& at, const Vec3& center) {
    touched.push_back(at.p);
    return border.On(at) && !border.OnSurfaceNormal(at, (center - at.p) / radius);
  };
  const auto vertex_rolls = [&](const CutterPoint& p) {
    return p.contact && rolls(*p.contact, p.center) &&
           (!p.other_contact || rolls(*p.other_contact, p.center));
  };
  const auto chord_rolls = [&](const Vec3& a, const Vec3& b) {
    const int parts = 1 + static_cast<int>((b - a).norm() / (kLook * radius));
    for (int k = 0; k < parts; ++k) {
      const Vec3 c = a + ((k + 0.5) / parts) * (b - a);
      const auto at = ClosestToPoint(surface, c, 1.1 * radius, 1e-6 * radius);
      if (!at || !rolls(at->at, c)) return false;
    }
    return true;
  };
  for (std::size_t i = 0; i < path.points.size(); ++i) {
    if (!vertex_rolls(path.points[i]) ||
        (i > 0 && !chord_rolls(path.points[i - 1].center, path.points[i].center))) {
      return {};
    }
  }
  return touched;
}

// The places of one border, and the lines that cross it.
struct Rim {
  std::vector<Vec3> places;
  bool closed = false;
  // Place and line, for every point that lines touch there.
  std::vector<std::pair<std::size_t, std::size_t>> crossings;
};

// Returns the borders, each with the points that lines touch on it.
absl::StatusOr<std::vector<Rim>> RimsTouched(const Locator& locator, const std::vector<BorderCurve>& borders,
                                             const std::vector<CutterPath>& paths, double spacing,
                                             const RunContext& run) {
  const SheetBorder border(locator.surface());
  std::vector<std::pair<Vec3, std::size_t>> touched;  // point, line
  for (std::size_t i = 0; i < paths.size(); ++i) {
    PM_RETURN_IF_ERROR(run.Check());
    for (const Vec3& p : RolledOver(paths[i], locator.surface(), border, locator.radius()))
      touched.push_back({p, i});
  }
  std::vector<Rim> rims;
  if (touched.empty()) return rims;
  std::vector<Vec3> places;
  std::vector<std::pair<std::size_t, std::size_t>> origin;  // for each place: its rim and its number there
  for (const BorderCurve& curve : borders) {
    std::vector<Vec3> own = PlacesOn(curve, spacing);
    if (own.size() < 3) continue;
    for (std::size_t i = 0; i < own.size(); ++i) {
      places.push_back(own[i]);
      origin.push_back({rims.size(), i});
    }
    rims.push_back({std::move(own), curve.closed, {}});
  }
  const PointCells cells(places, spacing);
  for (const auto& [p, line] : touched) {
    double least = kInfinity;
    std::size_t nearest = 0;
    cells.Near(p, spacing, [&, &at = p](std::size_t k) {
      const double distance = (places[k] - at).norm();
      if (distance > least || (distance == least && k > nearest)) return;
      least = distance;
      nearest = k;
    });
    if (least < kInfinity) rims[origin[nearest].first].crossings.push_back({origin[nearest].second, line});
  }
  for (Rim& rim : rims) std::sort(rim.crossings.begin(), rim.crossings.end());
  return rims;
}

// Lines that follow each other along a rim: from one of its crossings to another, which may lie before it on
// a closed rim.
struct Run {
  std::size_t first = 0, count = 0;  // crossings of the rim
  bool around = false;
};

// Returns the runs of a rim. `apart` is the largest number of places between two lines of one run.
std::vector<Run> RunsOf(const Rim& rim, std::size_t apart) {
  const std::size_t n = rim.crossings.size(), all = rim.places.size() - 1;
  // Is the way from crossing i to the next one short?
  const auto joined = [&](std::size_t i) {
    const std::size_t here = rim.crossings[i].first, next = rim.crossings[(i + 1) % n].first;
    if (i + 1 < n) return next - here <= apart;
    return rim.closed && next + all - here <= apart;
  };
  std::size_t start = 0;  // the crossing after a long way
  while (start < n && joined((start + n - 1) % n)) ++start;
  if (start == n) return {{0, n, true}};
  std::vector<Run> runs;
  for (std::size_t k = 0; k < n; ++k) {
    const std::size_t i = (start + k) % n;
    if (k == 0 || !joined((i + n - 1) % n)) runs.push_back({i, 0, false});
    ++runs.back().count;
  }
  return runs;
}

// Returns the way in plan from `beyond` places before the first crossing to as many after the last, or all
// around.
std::vector<Vec2> WayAlong(const Rim& rim, const Run& run, std::size_t beyond) {
  const std::size_t all = rim.places.size() - 1;  // the last place of a closed rim is the first
  const std::size_t first = rim.crossings[run.first].first,
                    last = rim.crossings[(run.first + run.count - 1) % rim.crossings.size()].first;
  std::size_t from = 0, way = all;
  if (!run.around && rim.closed) {
    from = first + all - beyond % all;
    way = std::min(all, (last + all - first) % all + 2 * beyond);
  } else if (!run.around) {
    from = first > beyond ? first - beyond : 0;
    way = std::min(all, last + beyond) - from;
  }
  std::vector<Vec2> at;
  for (std::size_t i = 0; i <= way; ++i)
    at.push_back(Xy(rim.places[rim.closed ? (from + i) % all : from + i]));
  return at;
}

}  // namespace

absl::StatusOr<std::vector<CutterPath>> RimPasses(const Locator& locator,
                                                  const std::vector<BorderCurve>& borders,
                                                  const PassParams& params, const RunContext& run,
                                                  std::vector<CutterPath>& paths) {
  const double radius = locator.radius(), flat = CenterStep(radius, params.scallop, 0.0),
               spacing = kSpacing * flat;
  if (params.roll || borders.empty()) return std::vector<CutterPath>();
  PM_ASSIGN_OR_RETURN(const std::vector<Rim> rims, RimsTouched(locator, borders, paths, spacing, run));
  std::vector<CutterPath> passes;
  std::vector<bool> out(paths.size(), false);
  const auto apart = static_cast<std::size_t>(kMaxRimGap * radius / spacing),
             beyond = static_cast<std::size_t>(kBeyond / kSpacing);
  for (const Rim& rim : rims) {
    if (rim.crossings.size() < 2) continue;
    for (const Run& found : RunsOf(rim, apart)) {
      PM_RETURN_IF_ERROR(run.Check());
      const auto crossing = [&](std::size_t k) {
        return rim.crossings[(found.first + k) % rim.crossings.size()];
      };
      std::set<std::size_t> crossed;
      for (std::size_t k = 0; k < found.count; ++k) crossed.insert(crossing(k).second);
      if (crossed.size() < 2) continue;
      const std::vector<Vec2> at = WayAlong(rim, found, beyond);
      for (ScanRun& r : ScanPolyline(locator, Thinned(at, kThin * flat), params, &run)) {
        if (r.points.size() < 2) continue;
        passes.push_back({.kind = PassKind::kBorder, .points = std::move(r.points)});
      }
      for (const std::size_t i : crossed) out[i] = true;
    }
  }
  PM_RETURN_IF_ERROR(run.Check());
  std::size_t kept = 0;
  for (std::size_t i = 0; i < paths.size(); ++i)
    if (!out[i]) std::swap(paths[kept++], paths[i]);
  paths.resize(kept);
  return passes;
}

}  // namespace patchmill
