#include "cam/path/edge/border_passes.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <utility>

#include "cam/path/chord/chord_thinning.h"
#include "cam/path/chord/scan_line.h"
#include "cam/path/stepover/step_over.h"
#include "cam/toolpath/segment_tree.h"
#include "core/base/parallel.h"
#include "core/base/status.h"
#include "core/diffgeo/forms.h"

namespace patchmill {
namespace {

constexpr double kSpacing = 0.5;   // flat step-overs: between places on a border
constexpr double kShortest = 4.0;  // flat step-overs: shortest pass, and shortest gap between two
constexpr double kReach = 2.0;     // flat step-overs: lines farther away do not count
constexpr double kLeft = 0.55;     // flat step-overs: a pass this near finishes the border
constexpr double kTouch = 0.02;    // flat step-overs: largest distance of contact and border
constexpr int kSteps = 12;         // most iterations towards the ball that touches a place

struct Stand {
  Vec3 center;
  SurfacePoint contact;
};

// Returns where the ball stands that touches the surface at `p` with its own normal (over an edge it could
// roll). The place in plan moves to where the normal of the contact found would have the ball over p. The
// move is scaled by how far the contact lagged behind in the last one (more than 1 on ridges, less in concave
// places). Returns nothing if the contact does not come within `near` (mm) of p. `last` is the ball at a
// place nearby.
std::optional<Stand> BallTouching(const Locator& locator, double gap, const Vec3& p, double near,
                                  const std::optional<Stand>& last) {
  Vec2 q = Xy(p), before_q = q, before_off = Vec2::Zero();
  if (last) q += Xy(last->center - last->contact.p);
  const SurfacePoint* hint = last ? &last->contact : nullptr;
  std::optional<CenterPoint> at;
  for (int k = 0; k < kSteps; ++k) {
    at = locator.Height(q, at ? &at->contact : hint, gap);
    if (!at) return std::nullopt;
    const SurfacePoint& contact = at->contact;
    const auto n = UpwardNormal(Evaluate(locator.surface(), contact.piece, contact.u, contact.v));
    if (!n) return std::nullopt;
    const Vec2 off = Xy(p + locator.radius() * *n) - q;
    if (off.norm() <= near && (p - contact.p).norm() <= near) return Stand{Lift(q, at->z), contact};
    double lag = 1.0;
    if (k > 0) {
      const double moved = (before_off - off).norm();
      lag = moved > 0.0 ? std::clamp((q - before_q).norm() / moved, 0.05, 20.0) : 1.0;
    }
    before_q = q;
    before_off = off;
    q += lag * off;
  }
  return std::nullopt;
}

// What is known of a place on a border.
struct BorderPlace {
  std::optional<Stand> stand;
  bool along = false;  // the nearest line runs along the border here
  bool left = false;   // no pass is near
};

class BorderWalk {
 public:
  BorderWalk(const Locator& locator, const PassParams& params, const SegmentTree& lines,
             const SegmentTree& all)
      : locator_(locator),
        lines_(lines),
        all_(all),
        flat_(CenterStep(locator.radius(), params.scallop, 0.0)),
        gap_(CertificateGap(params)) {}

  double flat() const { return flat_; }

  std::vector<BorderPlace> Look(const BorderCurve& border, const RunContext& run) const {
    const std::vector<Vec3> points = PlacesOn(border, kSpacing * flat_);
    std::vector<BorderPlace> places(points.size());
    std::optional<Stand> last;
    for (std::size_t i = 0; i < points.size() && !run.Cancelled(); ++i) {
      BorderPlace& place = places[i];
      last = place.stand = BallTouching(locator_, gap_, points[i], kTouch * flat_, last);
      if (!place.stand) continue;
      const Vec3& c = place.stand->center;
      const int line = lines_.FindNearest(c, kReach * flat_).segment;
      if (line < 0) continue;
      const PathSegment segment = lines_.segment(line);
      const Vec2 runs = Xy(segment.b - segment.a);
      const Vec2 way = Xy(points[std::min(i + 1, points.size() - 1)] - points[i > 0 ? i - 1 : 0]);
      // Drops have no direction in plan.
      const double size = runs.norm() * way.norm();
      place.along = runs.norm() > 1e-6 * (segment.b - segment.a).norm() && size > 0.0 &&
                    std::abs(Cross(runs, way)) <= std::sin(kAlongBorder) * size;
      place.left = all_.FindNearest(c, kLeft * flat_).segment < 0;
    }
    if (border.closed && places.size() > 2) {
      // Begin where no pass runs, so that no pass is cut in two there.
      places.pop_back();
      const auto rest = std::find_if(places.begin(), places.end(),
                                     [](const BorderPlace& p) { return !p.along || !p.stand; });
      if (rest != places.end()) std::rotate(places.begin(), rest, places.end());
      places.push_back(places.front());
    }
    return places;
  }

  // A stretch from one place to another, both included, where a pass is worth its way.
  struct Stretch {
    std::size_t first, last;
  };
  std::vector<Stretch> Stretches(const std::vector<BorderPlace>& places) const {
    const auto shortest = static_cast<std::size_t>(kShortest / kSpacing);
    std::vector<Stretch> stretches;
    for (std::size_t i = 0; i < places.size(); ++i) {
      if (!places[i].along || !places[i].left) continue;
      // A stretch continues to the next place that needs a pass if it can.
      const auto goes = [&](std::size_t from, std::size_t to) {
        return std::all_of(places.begin() + static_cast<std::ptrdiff_t>(from),
                           places.begin() + static_cast<std::ptrdiff_t>(to),
                           [](const BorderPlace& p) { return p.stand && p.along; });
      };
      if (!stretches.empty() && i - stretches.back().last <= shortest && goes(stretches.back().last, i)) {
        stretches.back().last = i;
      } else {
        stretches.push_back({i, i});
      }
    }
    std::erase_if(stretches, [&](const Stretch& s) { return s.last - s.first < shortest; });
    return stretches;
  }

 private:
  const Locator& locator_;
  const SegmentTree &lines_, &all_;
  const double flat_, gap_;
};

}  // namespace

absl::StatusOr<std::vector<CutterPath>> BorderPasses(const Locator& locator,
                                                     const std::vector<BorderCurve>& borders,
                                                     const std::vector<CutterPath>& paths,
                                                     const PassParams& params, const RunContext& run) {
  std::vector<CutterPath> lines;
  std::copy_if(paths.begin(), paths.end(), std::back_inserter(lines),
               [](const CutterPath& path) { return path.kind == PassKind::kZigzag; });
  if (lines.empty()) return std::vector<CutterPath>();
  const SegmentTree line_tree(MovesOf(lines), Metric::kPath, kInfinity, run);
  const SegmentTree all(MovesOf(paths), Metric::kPath, kInfinity, run);
  const BorderWalk walk(locator, params, line_tree, all);
  std::vector<std::vector<CutterPath>> found(borders.size());
  PM_RETURN_IF_ERROR(ParallelFor(run, "border passes", borders.size(), [&](std::size_t k) {
    const std::vector<BorderPlace> places = walk.Look(borders[k], run);
    for (const BorderWalk::Stretch& s : walk.Stretches(places)) {
      std::vector<Vec2> at;
      for (std::size_t i = s.first; i <= s.last; ++i) at.push_back(Xy(places[i].stand->center));
      for (ScanRun& r : ScanPolyline(locator, Thinned(at, kTouch * walk.flat()), params, &run)) {
        if (r.points.size() < 2) continue;
        found[k].push_back({.kind = PassKind::kBorder, .points = std::move(r.points)});
      }
    }
  }));
  std::vector<CutterPath> passes;
  for (std::vector<CutterPath>& f : found) {
    passes.insert(passes.end(), std::make_move_iterator(f.begin()), std::make_move_iterator(f.end()));
  }
  return passes;
}

}  // namespace patchmill
