#include "cam/plan/circular_lines_choice.h"

#include <algorithm>
#include <bitset>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include <Eigen/Dense>

#include "cam/path/stepover/across_feed.h"
#include "cam/path/stepover/cheapest_step.h"
#include "cam/path/stepover/step_over.h"
#include "cam/plan/region_points.h"
#include "core/base/parallel.h"
#include "core/base/status.h"

namespace patchmill {
namespace {

// Of the straight lines' length: circles this short pay; where the angle is open, these need no comparison in
// time, and these are worth one.
constexpr double kUseRatio = 0.9, kUseWithoutTimingRatio = 0.8, kTryByTimingRatio = 1.2;
// Sine of the angle between circles and borders, on average: 0.13 for a hexagon, 0.29 for a square, whose
// frames and ledges come to many short arcs that the estimate does not see.
constexpr double kMostSlant = 0.2;
constexpr int kAngles = 6;  // of straight lines whose angle is open
constexpr std::size_t kMostMasked =
    5'000'000;  // pieces times components: each of these has a mask of its own
constexpr double kMinComponentRadii2 =
    1.0;  // ball radii^2: components of less are not worth an angle of their own

// A direction in plan that should run around the center: m . (p - c) = 0.
struct Tangent {
  Vec2 p, m;
  double weight = 0.0;
};

// c of the least sum of weight (m . (p - c))^2; then, so that a spout or a handle beside a rim does not draw
// it away, with weights that fall off for what misses it by more than `near` (mm). None where all m are about
// parallel.
std::optional<Vec2> CenterOf(const std::vector<Tangent>& tangents, double near) {
  constexpr int kRounds = 10;
  std::optional<Vec2> center;
  for (int round = 0; round < kRounds; ++round) {
    Eigen::Matrix2d a = Eigen::Matrix2d::Zero();
    Vec2 b = Vec2::Zero();
    for (const Tangent& t : tangents) {
      const double length2 = t.m.squaredNorm();
      if (!(length2 > 0.0)) continue;
      const double miss = center ? t.m.dot(t.p - *center) : 0.0;
      const double counts = 1.0 / (1.0 + miss * miss / (near * near * length2)),
                   weight = t.weight * counts * counts;
      a += weight * t.m * t.m.transpose();
      b += weight * t.m.dot(t.p) * t.m;
    }
    const double trace = a.trace();
    if (!(a.determinant() > 1e-6 * trace * trace)) return std::nullopt;
    center = a.inverse() * b;
  }
  return center;
}

// A point of a gentle area.
struct GentlePoint {
  ComponentId component;
  SurfaceJet jet;
  Vec3 normal = Vec3::UnitZ();
  double centers = 0.0;                                       // mm2 of the centre surface that it stands for
  Vec2 to_steep_u = Vec2::Zero(), to_steep_v = Vec2::Zero();  // mm: of the limit of slope, beside it
};

// The gentle points of a piece that are wanted, of regions with an `open` choice.
std::vector<GentlePoint> GentlePoints(const RegionPoints& all, std::size_t piece, const Resolved& resolved,
                                      const std::vector<bool>& open) {
  const RegionMap& map = all.map();
  const int stride = all.stride();
  const double radius = resolved.plan_radius;
  std::vector<ComponentId> steep(map.labels[piece].size(), kNoComponent);  // the component of cells that are
  std::vector<std::pair<std::size_t, GentlePoint>> found;                  // cell, point
  const double share = all.Share(), way = std::sqrt(share), limit = std::cos(resolved.split_angle);
  const PatchId patch = all.surface().pieces[piece].patch;
  all.VisitPiece(
      piece, [&](RegionId id) { return open[id.index()]; },
      [&](const RegionPoint& at) {
        const SurfaceJet& jet = at.jet;
        const Vec3& e = at.normal;
        const ComponentId component = map.ComponentAt(piece, at.cell);
        if (component == kNoComponent) return;
        if (e.z() < limit) {
          steep[at.cell] = component;
          return;
        }
        const PrincipalCurvatures k = Principal(Forms(jet, e));
        if (!(k.k_max * radius < 1.0) || !IsWanted(resolved.containment, patch, jet.p)) return;
        const double centers = (1.0 - k.k_min * radius) * (1.0 - k.k_max * radius);
        found.push_back(
            {at.cell, {component, jet, e, share * centers * jet.du.cross(jet.dv).norm(), {}, {}}});
      });
  const int n = map.cells;
  std::vector<GentlePoint> points;
  points.reserve(found.size());
  for (auto& [cell, point] : found) {
    const int i = static_cast<int>(cell) / n, j = static_cast<int>(cell) % n;
    const auto is_steep = [&, component = point.component](int a, int b) {
      return a >= 0 && b >= 0 && a < n && b < n && steep[static_cast<std::size_t>(a * n + b)] == component;
    };
    const int u = is_steep(i - stride, j) + is_steep(i + stride, j);
    const int v = is_steep(i, j - stride) + is_steep(i, j + stride);
    point.to_steep_u = u * way * Xy(point.jet.dv);
    point.to_steep_v = v * way * Xy(point.jet.du);
    points.push_back(std::move(point));
  }
  return points;
}

const Region& RegionOf(const RegionMap& map, ComponentId component) {
  return map.regions[map.component_region[component.index()].index()];
}

// The gentle area of a component. It tells which borders of the component are its own: all of them in a
// gentle region; in a steep one those that lie in the plane of a point nearby.
class GentleArea {
 public:
  void Add(const GentlePoint& point, double way) {
    const double reach = 1.5 * way * std::max(point.jet.du.norm(), point.jet.dv.norm());
    farthest_ = std::max(farthest_, reach);
    places_.push_back({point.jet.p, point.normal, reach});
  }
  // Along the longest side of its box.
  void Sort() {
    Box3 box;
    for (const Place& place : places_) box.Add(place.p);
    if (!box.Empty()) (box.max - box.min).maxCoeff(&along_);
    std::stable_sort(places_.begin(), places_.end(),
                     [this](const Place& a, const Place& b) { return a.p[along_] < b.p[along_]; });
  }
  bool Beside(const Vec3& p) const {
    auto place = std::lower_bound(places_.begin(), places_.end(), p[along_] - farthest_,
                                  [this](const Place& a, double x) { return a.p[along_] < x; });
    for (; place != places_.end() && place->p[along_] <= p[along_] + farthest_; ++place) {
      const Vec3 off = p - place->p;
      if (off.norm() <= place->reach && std::abs(off.dot(place->normal)) <= kInPlane * place->reach)
        return true;
    }
    return false;
  }

 private:
  static constexpr double kInPlane = 0.25;
  struct Place {
    Vec3 p, normal;
    double reach = 0.0;  // mm
  };
  std::vector<Place> places_;
  double farthest_ = 0.0;
  Eigen::Index along_ = 0;  // axis
};

// Calls visit(from, to), in plan, for the stretches from point to point of the borders of a component's
// gentle area.
template <class Visit>
void VisitBorders(const RegionMap& map, ComponentId component, const GentleArea& area, const Visit& visit) {
  const bool all = RegionOf(map, component).slope == SlopeClass::kGentle;
  for (const BorderLine& line : map.border_lines) {
    if (line.component != component && line.other_component != component) continue;
    const std::size_t n = line.points.size();
    for (std::size_t i = 0; i + (line.closed ? 0 : 1) < n; ++i) {
      const Vec3 &from = line.points[i], &to = line.points[(i + 1) % n];
      if (all || area.Beside(0.5 * (from + to))) visit(Xy(from), Xy(to));
    }
  }
}

// Lines in one direction over the gentle area of a component, and their total length.
struct Family {
  std::optional<CircularLines> around;  // else they are straight
  double angle = 0.0;                   // rad
  double passes = 0.0;                  // mm, for the steps needed
  double ends = 0.0;                    // mm of borders, as seen along the lines
  double border = 0.0;                  // mm of them

  Vec2 LineAt(const Vec2& p) const { return around ? CircleTangentAt(*around, p) : StraightLine(angle); }
  bool AlongBorders() const { return ends <= kMostSlant * border; }
  void AddBorder(const Vec2& from, const Vec2& to) {
    border += (to - from).norm();
    ends += std::abs(Cross(LineAt(0.5 * (from + to)), to - from));
  }
  void Add(const GentlePoint& point, double radius, double scallop) {
    const Vec2 line = LineAt(Xy(point.jet.p));
    for (const Vec2& limit : {point.to_steep_u, point.to_steep_v}) {
      border += limit.norm();
      ends += std::abs(Cross(line, limit));
    }
    const auto across = AcrossLines(point.normal, line);
    if (!across) return;
    const double kappa = NormalCurvature(Forms(point.jet, point.normal), point.jet, *across);
    const double step = CenterStep(radius, scallop, kappa);
    if (step > 0.0) passes += point.centers / step;
  }
  // One line ends for every step of border, at half of what a run costs.
  double Sum(double radius, double step) const { return passes + 0.5 * kRunCost * radius * ends / step; }
};

// How an area lies around a place.
struct Extent {
  static constexpr int kSectors = 24;
  double nearest = kInfinity, farthest = 0.0;  // mm
  double cell = 0.0;                           // mm, the largest side of a cell of the map
  std::bitset<kSectors> sectors;               // in which there is some

  void Add(const Vec2& from_center, double cell_here) {
    nearest = std::min(nearest, from_center.norm());
    farthest = std::max(farthest, from_center.norm());
    cell = std::max(cell, cell_here);
    const double turns = std::atan2(from_center.y(), from_center.x()) / (2.0 * kPi) + 0.5;
    sectors.set(static_cast<std::size_t>(std::clamp(static_cast<int>(turns * kSectors), 0, kSectors - 1)));
  }
  bool GoesAround() const { return 4 * sectors.count() >= 3 * kSectors; }
};

// A component that may be cut along circles, and the straight lines they are compared with.
struct Candidate {
  Family round;
  std::vector<Family> straight;  // at the angle it has, or at some where that is open
  Extent extent;

  template <class Visit>
  void VisitFamilies(const Visit& visit) {
    visit(round);
    for (Family& family : straight) visit(family);
  }
};

Candidate CandidateOf(double angle, bool angle_open, const Vec2& center) {
  Candidate candidate;
  candidate.round.around = CircularLines{center, 0.0, 0.0};
  const int angles = angle_open ? kAngles : 1;
  for (int k = 0; k < angles; ++k) candidate.straight.emplace_back().angle = angle + k * kPi / angles;
  return candidate;
}

}  // namespace

absl::StatusOr<CircularChoices> ChooseCircularLines(const JobContext& context, const RegionMap& map,
                                                    RegionChoices chosen) {
  const Surface& surface = context.surface;
  const Resolved& resolved = context.resolved;
  const RunContext& run = context.run;
  std::vector<RegionChoice>& choices = chosen.choices;
  const double radius = resolved.plan_radius;
  std::vector<CircularTrial> to_try(choices.size());
  std::vector<bool> open(choices.size());
  for (std::size_t id = 0; id < choices.size(); ++id) {
    const RegionChoice& choice = choices[id];
    open[id] = chosen.open[id].circles && !choice.skip && !choice.one_way &&
               choice.strategy == Strategy::kAuto && map.regions[id].kind != RegionKind::kUnreachable;
    chosen.open[id].circles = false;
  }
  if (std::none_of(open.begin(), open.end(), [](bool o) { return o; }))
    return CircularChoices{std::move(chosen), std::move(to_try)};

  const int stride = std::min(2 * StrideOf(map), map.cells);
  const RegionPoints points(surface, map, stride);
  std::vector<std::vector<GentlePoint>> pieces(surface.pieces.size());
  PM_RETURN_IF_ERROR(ParallelFor(run, nullptr, pieces.size(), [&](std::size_t i) {
    pieces[i] = GentlePoints(points, i, resolved, open);
  }));
  const std::size_t count = map.component_region.size();
  const auto choice_of = [&](ComponentId component) -> RegionChoice& {
    return choices[map.component_region[component.index()].index()];
  };
  const auto angle_open = [&](ComponentId component) {
    return chosen.open[map.component_region[component.index()].index()].angle;
  };
  std::vector<std::vector<Tangent>> tangents(count);
  std::vector<GentleArea> gentle(count);
  std::vector<double> area(count, 0.0);  // mm2 of centers
  const double way = std::sqrt(points.Share());
  for (const std::vector<GentlePoint>& piece : pieces) {
    for (const GentlePoint& point : piece) {
      area[point.component.index()] += point.centers;
      tangents[point.component.index()].push_back(
          {Xy(point.jet.p), {-point.normal.y(), point.normal.x()}, point.centers});
      if (RegionOf(map, point.component).slope == SlopeClass::kSteep)
        gentle[point.component.index()].Add(point, way);
    }
  }
  for (GentleArea& own : gentle) own.Sort();
  std::vector<std::optional<Candidate>> candidates(count);
  for (std::size_t k = 0; k < count; ++k) {
    if (!open[map.component_region[k].index()]) continue;
    const ComponentId component(k);
    const double flat = CenterStep(radius, choice_of(component).scallop, 0.0);
    VisitBorders(map, component, gentle[k], [&](const Vec2& from, const Vec2& to) {
      const double length = (to - from).norm();
      if (length > 0.0) tangents[k].push_back({0.5 * (from + to), (to - from) / length, flat * length});
    });
    const auto center = CenterOf(tangents[k], radius);
    if (!center) continue;
    candidates[k] = CandidateOf(choice_of(component).zigzag_angle, angle_open(component), *center);
    VisitBorders(map, component, gentle[k], [&](const Vec2& from, const Vec2& to) {
      candidates[k]->VisitFamilies([&](Family& family) { family.AddBorder(from, to); });
    });
  }
  for (const std::vector<GentlePoint>& piece : pieces) {
    for (const GentlePoint& point : piece) {
      if (!candidates[point.component.index()]) continue;
      Candidate& candidate = *candidates[point.component.index()];
      const double scallop = choice_of(point.component).scallop;
      candidate.VisitFamilies([&](Family& family) { family.Add(point, radius, scallop); });
      const double cell = std::max(Xy(point.jet.du).norm(), Xy(point.jet.dv).norm()) / map.cells;
      candidate.extent.Add(Xy(point.jet.p) - candidate.round.around->center, cell);
    }
  }
  std::size_t rounds = 0;
  std::vector<std::size_t> straight(choices.size(), 0);  // components that are not round
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t id = map.component_region[k].index();
    straight[id] += area[k] > kMinComponentRadii2 * radius * radius;
    if (!candidates[k]) continue;
    const double flat = CenterStep(radius, choices[id].scallop, 0.0);
    const Extent& extent = candidates[k]->extent;
    if (!(extent.nearest > radius + flat) || !extent.GoesAround()) continue;
    double least = kInfinity;
    for (const Family& family : candidates[k]->straight) least = std::min(least, family.Sum(radius, flat));
    if (!candidates[k]->round.AlongBorders()) continue;
    const double length = candidates[k]->round.Sum(radius, flat);
    const bool to_time = angle_open(ComponentId(k));
    if (!(length < (to_time ? kTryByTimingRatio : kUseRatio) * least)) continue;
    if (rounds++ >= kMostMasked / surface.pieces.size()) continue;
    CircularComponent round{ComponentId(k), *candidates[k]->round.around};
    // All of its cells, and those that are cut with them; outwards to whole ball radii: where lines are
    // looked for is not to hang on which points were visited.
    const double more = (stride + kCellsBesideCircles) * extent.cell;
    round.lines.inner = radius * std::floor(std::max(0.0, extent.nearest - more) / radius);
    round.lines.outer = radius * std::ceil((extent.farthest + more) / radius);
    straight[id] -= area[k] > kMinComponentRadii2 * radius * radius;
    if (to_time && length >= kUseWithoutTimingRatio * least) {
      to_try[id].more.push_back(round);
    } else {
      choices[id].around.push_back(round);
    }
  }
  for (std::size_t id = 0; id < choices.size(); ++id) {
    const bool all = straight[id] == 0 && !(to_try[id].more.empty() && choices[id].around.empty());
    to_try[id].all = all;
    if (!all || !to_try[id].more.empty()) continue;
    choices[id].all_circular = true;
    chosen.open[id].angle = false;
  }
  return CircularChoices{std::move(chosen), std::move(to_try)};
}

}  // namespace patchmill
