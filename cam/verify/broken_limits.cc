#include "cam/verify/broken_limits.h"

#include <algorithm>
#include <functional>

#include <fmt/format.h>

#include "cam/verify/motion_sets.h"
#include "core/surface/closest.h"

namespace patchmill {
namespace {

constexpr double kCertainty = 1e-3;  // mm; how exactly the deepest violation of a move is known
constexpr double kClear = 0.5;       // mm; room that a centre this far from touching the surface counts as
constexpr std::size_t kMost = 20;    // findings per code

using Room = std::function<double(const Vec3&)>;          // mm, room of a centre; slope at most 1
using Floor = std::function<double(const PathSegment&)>;  // mm, a lower bound for the room on a move

struct Least {
  double room = kInfinity;
  Vec3 at = Vec3::Zero();
  int move = -1;
};

// Lowers `least` to the smallest room on the segment a b if that is smaller by more than the certainty. No
// room on it is below `floor`. Over large areas the room may be constant; then `floor` ends the search.
void Lower(const Room& room, double floor, const Vec3& a, const Vec3& b, Least& least) {
  if (floor >= least.room - kCertainty) return;
  const Vec3 middle = 0.5 * (a + b);
  const double here = room(middle), half = 0.5 * (b - a).norm();
  if (here < least.room) {
    least.room = here;
    least.at = middle;
  }
  if (half < kCertainty || here - half >= least.room - kCertainty) return;
  Lower(room, floor, a, middle, least);
  Lower(room, floor, middle, b, least);
}

// A level rectangle with corners a and b and sides along x and y.
struct LevelRect {
  Vec2 a, b;
  double z = 0.0;
};

// The same over a level rectangle.
void LowerOver(const Room& room, double floor, const LevelRect& rect, Least& least) {
  if (floor >= least.room - kCertainty) return;
  const auto& [a, b, z] = rect;
  const Vec2 middle = 0.5 * (a + b);
  const double here = room(Lift(middle, z)), half = 0.5 * (b - a).norm();
  if (here < least.room) {
    least.room = here;
    least.at = Lift(middle, z);
  }
  if (half < kCertainty || here - half >= least.room - kCertainty) return;
  const bool x_longer = std::abs(b.x() - a.x()) >= std::abs(b.y() - a.y());
  LowerOver(room, floor, {a, x_longer ? Vec2(middle.x(), b.y()) : Vec2(b.x(), middle.y()), z}, least);
  LowerOver(room, floor, {x_longer ? Vec2(middle.x(), a.y()) : Vec2(a.x(), middle.y()), b, z}, least);
}

class Report {
 public:
  Report(const ProgramMotion& motion, const Vec3& offset, Diagnostics& out)
      : motion_(motion), offset_(offset), out_(out) {}

  void Add(const char* code, std::vector<Least> broken, const std::string& what) {
    std::stable_sort(broken.begin(), broken.end(),
                     [](const Least& a, const Least& b) { return a.room < b.room; });
    std::vector<int> lines;
    for (const Least& b : broken) {
      const int line = motion_.moves[static_cast<std::size_t>(b.move)].line;
      if (std::find(lines.begin(), lines.end(), line) != lines.end()) continue;
      if (lines.size() == kMost) return;
      lines.push_back(line);
      const Vec3 tip = b.at - offset_;
      out_.push_back(MakeError(code,
                               fmt::format("line {}: {} by {:.4f} mm, the tip at X{:.4f} Y{:.4f} Z{:.4f}",
                                           line, what, -b.room, tip.x(), tip.y(), tip.z()),
                               {.point = b.at, .line = line}));
    }
  }

 private:
  const ProgramMotion& motion_;
  const Vec3 offset_;
  Diagnostics& out_;
};

std::vector<Least> Broken(const std::vector<PathSegment>& moves, const Room& room, const Floor& floor,
                          double slack, const RunContext& run) {
  std::vector<Least> broken;
  for (const PathSegment& s : moves) {
    Least least{-slack, Vec3::Zero(), -1};
    if (run.Cancelled()) break;
    Lower(room, floor(s), s.a, s.b, least);
    if (least.room >= -slack) continue;
    least.move = s.move;
    broken.push_back(least);
  }
  return broken;
}

constexpr double kLeastPart = 0.01;  // mm; shorter parts of a move are not divided

// Adds the parts of the segment that lie in no material.
void AddFree(const Containment& c, double ball, const PathSegment& s, std::vector<PathSegment>& out) {
  const Vec3 tip = 0.5 * (s.a + s.b) - Vec3(0.0, 0.0, ball);
  double room = kInfinity;
  for (const BesideStrip& strip : c.beside) {
    if (strip.kind == StripKind::kMaterial) room = std::min(room, StripRoom(strip, tip));
  }
  const double half = 0.5 * (s.b - s.a).norm();
  if (room >= half) {
    out.push_back(s);
    return;
  }
  if (room <= -half && room < 0.0) return;
  if (half < 0.5 * kLeastPart) {
    if (room >= 0.0) out.push_back(s);
    return;
  }
  const Vec3 middle = 0.5 * (s.a + s.b);
  AddFree(c, ball, {s.a, middle, s.move}, out);
  AddFree(c, ball, {middle, s.b, s.move}, out);
}

}  // namespace

std::vector<PathSegment> OutsideOfMaterial(const CenterLimits& limits, std::vector<PathSegment> moves) {
  const bool any = limits.containment != nullptr &&
                   std::any_of(limits.containment->beside.begin(), limits.containment->beside.end(),
                               [](const BesideStrip& strip) { return strip.kind == StripKind::kMaterial; });
  if (!any) return moves;
  std::vector<PathSegment> out;
  for (const PathSegment& s : moves) AddFree(*limits.containment, limits.ball, s, out);
  return out;
}

Diagnostics BrokenLimits(const Surface& surface, const ProgramMotion& motion, const LimitCheck& check,
                         const RunContext& run) {
  const CenterLimits& limits = check.limits;
  const Vec3& offset = check.offset;
  const double slack = check.slack;
  Diagnostics found;
  if (limits.containment == nullptr) return found;
  const Containment& c = *limits.containment;
  Report report(motion, offset, found);
  const Floor no_floor = [](const PathSegment&) { return -kInfinity; };
  const std::vector<PathSegment> all = CollectMoves(motion, MotionSet::kSwept, offset);
  const std::vector<PathSegment> dog_legs = CollectMoves(motion, MotionSet::kDogLegs, offset);
  for (const Obstacle& o : c.obstacles) {
    if (o.stock != nullptr) continue;  // HOLDER_IN_STOCK
    const Room room = [&](const Vec3& center) {
      return ObstacleRoom(o, center - Vec3(0.0, 0.0, limits.ball), limits.tool);
    };
    const Floor over_top = [&](const PathSegment& s) {
      return std::min(s.a.z(), s.b.z()) - limits.ball - o.top_z - o.margin;
    };
    const char* code = o.of_holder ? "HOLDER_HIT" : "OBSTACLE_HIT";
    const std::string within = fmt::format("within {:.4g} mm of obstacle {}", o.margin, o.name);
    report.Add(code, Broken(all, room, over_top, slack, run),
               o.of_holder ? "the holder is too near to obstacle " + o.name : "the tool is " + within);
    std::vector<Least> beside;
    for (const PathSegment& s : dog_legs) {
      if (run.Cancelled()) break;
      Least least{-slack, Vec3::Zero(), -1};
      LowerOver(room, over_top(s), {Xy(s.a), Xy(s.b), std::min(s.a.z(), s.b.z())}, least);
      if (least.room >= -slack) continue;
      least.move = s.move;
      beside.push_back(least);
    }
    report.Add(code, std::move(beside),
               "not driving all axes together, a control may come " +
                   (o.of_holder ? "too near with the holder to obstacle " + o.name : within));
  }
  if (!c.beside.empty()) {
    const Room room = [&](const Vec3& center) { return BesideRoom(c, center - Vec3(0.0, 0.0, limits.ball)); };
    const Floor over_all = [&](const PathSegment& s) {
      double highest = -kInfinity;
      for (const BesideStrip& strip : c.beside) highest = std::max(highest, strip.lowest_tip_z);
      return std::min(s.a.z(), s.b.z()) - limits.ball - highest;
    };
    report.Add("BESIDE_PART", Broken(all, room, over_all, slack, run),
               "the tool goes down beside the part, below a wall's upper edge");
  }
  if (c.boundary && c.boundary->mode != BoundaryMode::kContact) {
    const Room room = [&](const Vec3& center) { return BoundaryRoom(c, Xy(center), limits.ball); };
    report.Add("OUTSIDE_BOUNDARY",
               Broken(CollectMoves(motion, MotionSet::kCut, offset), room, no_floor, slack, run),
               "a feed leaves the boundary");
  }
  if (c.top_z) {
    // A ball touches the surface if it is within `slack` of it. Broken allows another `slack`.
    const double touching = check.radius + 2.0 * slack;
    const Room room = [&](const Vec3& center) {
      const double below = TopRoom(c, center.z() - limits.ball);
      if (below >= 0.0) return below;
      const auto nearest = ClosestToPoint(surface, center, touching + kClear, 0.1 * kCertainty);
      return std::max(below, nearest ? nearest->distance - touching : kClear);
    };
    std::vector<PathSegment> feeds = CollectMoves(motion, MotionSet::kCut, offset);
    std::erase_if(feeds, [](const PathSegment& s) { return Xy(s.b - s.a).norm() < kCertainty; });
    std::vector<Least> broken = Broken(feeds, room, no_floor, slack, run);
    for (Least& b : broken) b.room = TopRoom(c, b.at.z() - limits.ball);
    report.Add("ABOVE_TOP", std::move(broken), "a feed touches the surface above the highest tip");
  }
  return found;
}

}  // namespace patchmill
