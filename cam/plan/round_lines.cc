#include "cam/plan/round_lines.h"

#include <algorithm>
#include <bitset>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include <Eigen/Dense>

#include "cam/path/across_feed.h"
#include "cam/path/cheapest_step.h"
#include "cam/path/spacing.h"
#include "cam/plan/region_points.h"
#include "core/base/parallel.h"
#include "core/base/status.h"

namespace patchmill {
namespace {

// Of the straight lines' length: circles this short pay; where the angle is open, these need no comparison in
// time, and these are worth one.
constexpr double kWorthwhile = 0.9, kPlainly = 0.8, kArguably = 1.2;
// Sine of the angle between circles and borders, on average: 0.13 for a hexagon, 0.29 for a square, whose
// frames and ledges come to many short arcs that the estimate does not see.
constexpr double kMostSlant = 0.2;
constexpr int kAngles = 6;  // of straight lines whose angle is open

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

// A point of gentle ground.
struct GentlePoint {
  std::size_t region = 0;
  SurfaceJet jet;
  Vec3 normal = Vec3::UnitZ();
  double centers = 0.0;                                       // mm2 of the centre surface that it stands for
  Vec2 to_steep_u = Vec2::Zero(), to_steep_v = Vec2::Zero();  // mm: of the limit of slope, beside it
};

// The gentle points of a piece that are wanted, of regions with an `open` choice.
std::vector<GentlePoint> GentlePoints(const Surface& surface, std::size_t piece, const RegionMap& map,
                                      int stride, const Resolved& resolved, const std::vector<bool>& open) {
  const double radius = resolved.plan_radius;
  std::vector<int> steep(map.labels[piece].size(), 0);
  std::vector<std::pair<std::size_t, GentlePoint>> found;  // cell, point
  const double share = ShareOfPoint(map, stride), way = std::sqrt(share),
               limit = std::cos(resolved.split_angle);
  VisitPiece(
      surface, piece, map, stride, [&](std::size_t id) { return open[id]; },
      [&](std::size_t id, std::size_t cell, const SurfaceJet& jet, const Vec3& e) {
        if (e.z() < limit) {
          steep[cell] = map.labels[piece][cell] + 1;
          return;
        }
        const PrincipalCurvatures k = Principal(Forms(jet, e));
        if (!(k.k_max * radius < 1.0) || !IsWanted(resolved.containment, surface.pieces[piece].patch, jet.p))
          return;
        const double centers = (1.0 - k.k_min * radius) * (1.0 - k.k_max * radius);
        found.push_back({cell, {id, jet, e, share * centers * jet.du.cross(jet.dv).norm(), {}, {}}});
      });
  const int n = map.cells;
  std::vector<GentlePoint> points;
  points.reserve(found.size());
  for (auto& [cell, point] : found) {
    const int i = static_cast<int>(cell) / n, j = static_cast<int>(cell) % n;
    const auto is_steep = [&](int a, int b) {
      return a >= 0 && b >= 0 && a < n && b < n &&
             steep[static_cast<std::size_t>(a * n + b)] == static_cast<int>(point.region) + 1;
    };
    const int u = is_steep(i - stride, j) + is_steep(i + stride, j);
    const int v = is_steep(i, j - stride) + is_steep(i, j + stride);
    point.to_steep_u = u * way * Plan(point.jet.dv);
    point.to_steep_v = v * way * Plan(point.jet.du);
    points.push_back(std::move(point));
  }
  return points;
}

// The gentle ground of a region, to tell which of the region's borders are its own: all of a gentle one's; of
// a steep one those that lie in the plane of a point nearby.
class GentleGround {
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

// Calls visit(from, to), in plan, for the stretches from point to point of the borders of a region's gentle
// ground.
template <class Visit>
void VisitBorders(const RegionMap& map, std::size_t id, const GentleGround& ground, const Visit& visit) {
  const bool all = map.regions[id].slope == SlopeClass::kGentle;
  for (const BorderLine& line : map.border_lines) {
    if (line.region != map.regions[id].id && line.other != map.regions[id].id) continue;
    const std::size_t n = line.points.size();
    for (std::size_t i = 0; i + (line.closed ? 0 : 1) < n; ++i) {
      const Vec3 &from = line.points[i], &to = line.points[(i + 1) % n];
      if (all || ground.Beside(0.5 * (from + to))) visit(Plan(from), Plan(to));
    }
  }
}

// Lines in one way over a region's gentle ground, and what they come to.
struct Family {
  RegionChoice choice;
  double passes = 0.0;  // mm, for the steps needed
  double ends = 0.0;    // mm of borders, as seen along the lines
  double border = 0.0;  // mm of them

  bool AlongBorders() const { return ends <= kMostSlant * border; }
  void AddBorder(const Vec2& from, const Vec2& to) {
    border += (to - from).norm();
    ends += std::abs(Cross(LineAt(choice, Lift(0.5 * (from + to), 0.0)), to - from));
  }
  void Add(const GentlePoint& point, double radius) {
    const Vec2 line = LineAt(choice, point.jet.p);
    for (const Vec2& limit : {point.to_steep_u, point.to_steep_v}) {
      border += limit.norm();
      ends += std::abs(Cross(line, limit));
    }
    const auto across = AcrossLines(point.normal, line);
    if (!across) return;
    const double kappa = NormalCurvature(Forms(point.jet, point.normal), point.jet, *across);
    const double step = CenterStep(radius, choice.scallop, kappa);
    if (step > 0.0) passes += point.centers / step;
  }
  // One line ends for every step of border, at half of what a run costs.
  double Sum(double radius, double step) const { return passes + 0.5 * kWayToRun * radius * ends / step; }
};

// How ground lies around a place.
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

// A region that may be cut along circles, and the straight lines they are compared with.
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

Candidate CandidateOf(const RegionChoice& choice, const Vec2& center) {
  Candidate candidate;
  candidate.round.choice = choice;
  candidate.round.choice.around = RoundLines{center, 0.0, 0.0};
  candidate.round.choice.angle_open = false;
  const int angles = choice.angle_open ? kAngles : 1;
  for (int k = 0; k < angles; ++k) {
    Family& family = candidate.straight.emplace_back();
    family.choice = choice;
    family.choice.zigzag_angle += k * kPi / angles;
  }
  return candidate;
}

}  // namespace

absl::StatusOr<std::vector<std::optional<RoundLines>>> ChooseRoundLines(const Surface& surface,
                                                                        const RegionMap& map,
                                                                        const Resolved& resolved,
                                                                        const RunContext& run,
                                                                        std::vector<RegionChoice>& choices) {
  const double radius = resolved.plan_radius;
  std::vector<std::optional<RoundLines>> to_try(choices.size());
  std::vector<bool> open(choices.size());
  for (std::size_t id = 0; id < choices.size(); ++id) {
    const RegionChoice& choice = choices[id];
    open[id] = choice.round_open && !choice.skip && !choice.one_way && choice.strategy == Strategy::kAuto &&
               map.regions[id].kind != RegionKind::kUnreachable;
    choices[id].round_open = false;
  }
  if (std::none_of(open.begin(), open.end(), [](bool o) { return o; })) return to_try;

  const int stride = std::min(2 * StrideOf(map), map.cells);
  std::vector<std::vector<GentlePoint>> pieces(surface.pieces.size());
  PM_RETURN_IF_ERROR(ParallelFor(run, nullptr, pieces.size(), [&](std::size_t i) {
    pieces[i] = GentlePoints(surface, i, map, stride, resolved, open);
  }));
  std::vector<std::vector<Tangent>> tangents(choices.size());
  std::vector<GentleGround> grounds(choices.size());
  const double way = std::sqrt(ShareOfPoint(map, stride));
  for (const std::vector<GentlePoint>& piece : pieces) {
    for (const GentlePoint& point : piece) {
      tangents[point.region].push_back(
          {Plan(point.jet.p), {-point.normal.y(), point.normal.x()}, point.centers});
      if (map.regions[point.region].slope == SlopeClass::kSteep) grounds[point.region].Add(point, way);
    }
  }
  for (GentleGround& ground : grounds) ground.Sort();
  std::vector<std::optional<Candidate>> candidates(choices.size());
  for (std::size_t id = 0; id < choices.size(); ++id) {
    if (!open[id]) continue;
    const double flat = CenterStep(radius, choices[id].scallop, 0.0);
    VisitBorders(map, id, grounds[id], [&](const Vec2& from, const Vec2& to) {
      const double length = (to - from).norm();
      if (length > 0.0) tangents[id].push_back({0.5 * (from + to), (to - from) / length, flat * length});
    });
    const auto center = CenterOf(tangents[id], radius);
    if (!center) continue;
    candidates[id] = CandidateOf(choices[id], *center);
    VisitBorders(map, id, grounds[id], [&](const Vec2& from, const Vec2& to) {
      candidates[id]->VisitFamilies([&](Family& family) { family.AddBorder(from, to); });
    });
  }
  for (const std::vector<GentlePoint>& piece : pieces) {
    for (const GentlePoint& point : piece) {
      if (!candidates[point.region]) continue;
      Candidate& candidate = *candidates[point.region];
      candidate.VisitFamilies([&](Family& family) { family.Add(point, radius); });
      const double cell = std::max(Plan(point.jet.du).norm(), Plan(point.jet.dv).norm()) / map.cells;
      candidate.extent.Add(Plan(point.jet.p) - candidate.round.choice.around->center, cell);
    }
  }
  for (std::size_t id = 0; id < choices.size(); ++id) {
    if (!candidates[id]) continue;
    const double flat = CenterStep(radius, choices[id].scallop, 0.0);
    const Extent& extent = candidates[id]->extent;
    if (!(extent.nearest > radius + flat) || !extent.GoesAround()) continue;
    double least = kInfinity;
    for (const Family& family : candidates[id]->straight) least = std::min(least, family.Sum(radius, flat));
    if (!candidates[id]->round.AlongBorders()) continue;
    const double length = candidates[id]->round.Sum(radius, flat);
    const bool angle_open = choices[id].angle_open;
    if (!(length < (angle_open ? kArguably : kWorthwhile) * least)) continue;
    RegionChoice round = candidates[id]->round.choice;
    // All of its cells, and those that are cut with them; outwards to whole ball radii: where lines are
    // looked for is not to hang on which points were visited.
    const double more = (stride + kRoundBeside) * extent.cell;
    round.around->inner = radius * std::floor(std::max(0.0, extent.nearest - more) / radius);
    round.around->outer = radius * std::ceil((extent.farthest + more) / radius);
    if (angle_open && length >= kPlainly * least) {
      to_try[id] = round.around;
    } else {
      choices[id] = round;
    }
  }
  return to_try;
}

}  // namespace patchmill
