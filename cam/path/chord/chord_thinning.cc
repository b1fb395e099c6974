#include "cam/path/chord/chord_thinning.h"

#include <algorithm>

#include "cam/path/chord/fewest_chords.h"
#include "core/base/parallel.h"
#include "core/base/status.h"

namespace patchmill {
namespace {

// In radii: a second contact at least this far from the first one makes a vertex of its own.
constexpr double kSecondContact = 1e-3;

const SurfacePoint* Known(const std::optional<SurfacePoint>& contact) {
  return contact ? &*contact : nullptr;
}

CutterPoint Certify(const Locator& locator, const TraceStation& s, double gap) {
  CutterPoint p{Lift(s.q, s.z), s.left, {}};
  if (s.left && s.right && (s.left->p - s.right->p).norm() > kSecondContact * locator.radius()) {
    p.other_contact = s.right;
  }
  if (!s.left) p.other_contact = s.right;
  if (s.ceiling < kInfinity) {
    p.center.z() = s.ceiling;
    return p;
  }
  const auto c = locator.CertifiedHeight(s.at, gap, s.hint ? &*s.hint : nullptr);
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

ChordLimits LimitsOf(const PassParams& params) {
  ChordLimits limits;
  limits.certificate_gap = CertificateGap(params);
  limits.gouge = params.chord_tolerance;
  limits.excess = ExcessTolerance(params) - limits.certificate_gap;
  limits.deepest = DeepestVertex(params.chord_tolerance, ExcessTolerance(params));
  return limits;
}

// Returns the direction in plan away from the surface, for a ball whose contacts are all beside it rather
// than below it.
std::optional<Vec3> AwayInXy(const CutterPoint& p) {
  if (!p.contact) return std::nullopt;
  Vec2 away = Xy(Vec3(p.center - p.contact->p));
  if (p.other_contact) away = away.normalized() + Xy(Vec3(p.center - p.other_contact->p)).normalized();
  if (!(away.norm() > 0.0)) return std::nullopt;
  return Lift(away.normalized(), 0.0);
}

void ThinContour(const Locator& locator, const PassParams& params, const RunContext& run, CutterPath& path) {
  const std::size_t n = path.points.size(), count = n + (path.closed ? 1 : 0);
  if (n < 3) return;
  std::vector<ChordStation> stations(count);
  for (std::size_t k = 0; k < count; ++k) {
    const CutterPoint& p = path.points[k % n];
    const std::optional<Vec3> away = AwayInXy(p);
    if (!away) return;
    stations[k] = {.center = p.center,
                   .away = *away,
                   .left = Known(p.contact),
                   .right = Known(p.other_contact ? p.other_contact : p.contact),
                   .keep = p.other_contact.has_value(),
                   .proven = true};
  }
  ChordLimits limits = LimitsOf(params);
  limits.longest = locator.radius();
  const auto proven = [&](std::size_t k) { return path.points[k % n].center; };
  const std::vector<ChordVertex> vertices = FewestChords(locator, stations, limits, proven, &run);
  if (vertices.back().station + 1 < count) return;  // cancelled
  std::vector<CutterPoint> points;
  for (const ChordVertex& v : vertices) {
    if (v.station == n) break;
    points.push_back(path.points[v.station]);
    points.back().center -= v.below * stations[v.station].away;
  }
  path.points = std::move(points);
}

}  // namespace

double CertificateGap(const PassParams& params) {
  return std::clamp(params.certificate_gap, 1e-7, std::max(1e-7, 0.1 * ExcessTolerance(params)));
}

std::vector<CutterPoint> ThinStations(const Locator& locator, const std::vector<TraceStation>& stations,
                                      const PassParams& params, const RunContext* run) {
  ChordLimits limits = LimitsOf(params);
  limits.floor_center = params.floor_z + locator.radius();
  std::vector<ChordStation> chord_stations;
  chord_stations.reserve(stations.size());
  for (const TraceStation& s : stations) {
    chord_stations.push_back({.center = Lift(s.q, s.z),
                              .left = Known(s.left),
                              .right = Known(s.right),
                              .keep = s.keep,
                              .proven = s.ceiling - s.z <= limits.certificate_gap + 1e-12});
  }
  const auto certify = [&](std::size_t k) { return Certify(locator, stations[k], limits.certificate_gap); };
  const auto proven = [&](std::size_t k) { return certify(k).center; };
  std::vector<CutterPoint> points;
  for (const ChordVertex& v : FewestChords(locator, chord_stations, limits, proven, run)) {
    points.push_back(certify(v.station));
    points.back().center.z() -= v.below;
  }
  return points;
}

absl::Status ThinContours(const Locator& locator, const PassParams& params, const ThinWhich& which,
                          const RunContext& run, std::vector<CutterPath>& paths) {
  return ParallelFor(run, nullptr, paths.size(), [&](std::size_t i) {
    if (paths[i].kind == PassKind::kContour && which(paths[i])) ThinContour(locator, params, run, paths[i]);
  });
}

}  // namespace patchmill
