#include "cam/toolpath/linuxcnc_times.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>

#include "cam/toolpath/trapezoids.h"

namespace patchmill {
namespace {

constexpr double kShortestBlock = 1e-9;  // mm; a shorter move takes no time, and no move is cut shorter
constexpr double kAlongArc = 0.5;        // share of the acceleration along an arc
const double kAcrossArc = std::sqrt(1.0 - kAlongArc * kAlongArc);
const double kTurnsBack = -std::cos(Radians(2.0));  // cosine of a corner
constexpr double kStraightOn = 1.0 - 1e-12;         // the same
constexpr double kSamePlane = 1e-6;                 // rad
constexpr double kSharpest = 1e-3;                  // rad, half the inner angle of a corner that is rounded

// The most speed (mm/s) and acceleration (mm/s^2) of each axis.
struct AxisLimits {
  Vec3 rapid, feed, acceleration;
};

AxisLimits LimitsOf(const Machine& machine) {
  AxisLimits limits;
  for (int k = 0; k < 3; ++k) {
    const MachineAxis& axis = machine.axes[static_cast<std::size_t>(k)];
    limits.rapid[k] = axis.rapid / 60.0;
    limits.feed[k] = axis.feed / 60.0;
    limits.acceleration[k] = axis.acceleration;
  }
  return limits;
}

// The arc of a block, as seen from its ends.
struct BlockArc {
  Vec3 axis;
  Vec3 from_center_start, from_center_end;
  double radius = 0.0, sweep = 0.0;
};

// A move as LinuxCNC queues it.
struct Block {
  std::size_t move = 0;
  double length = 0.0;  // mm, of the whole
  double left = 0.0;    // mm, what the arcs in the corners leave of it
  double speed = 0.0, acceleration = 0.0;
  Vec3 start, end;  // directions there
  bool rapid = false;
  bool halved = false;  // its acceleration
  std::optional<BlockArc> arc;
};

double Limit(const Vec3& direction, const Vec3& limits) {
  double least = kInfinity;
  for (int k = 0; k < 3; ++k) {
    if (std::abs(direction[k]) > 1e-12) least = std::min(least, limits[k] / std::abs(direction[k]));
  }
  return least;
}

Block LineBlock(const Vec3& way, const Move& move, const AxisLimits& limits) {
  Block block;
  block.length = way.norm();
  if (block.length < kShortestBlock) return block;
  block.start = block.end = way / block.length;
  block.rapid = move.kind == MoveKind::kRapid;
  block.speed = block.rapid ? Limit(block.start, limits.rapid)
                            : std::min(move.feed / 60.0, Limit(block.start, limits.feed));
  block.acceleration = Limit(block.start, limits.acceleration);
  return block;
}

Block ArcBlock(const ArcEnds& ends, double sweep, const Move& move, const AxisLimits& limits) {
  const Arc& arc = *move.arc;
  const Vec3 from = ToPlane(arc.plane, ends.from), to = ToPlane(arc.plane, ends.to);
  const Vec2 out_from = from.head<2>() - arc.center, out_to = to.head<2>() - arc.center;
  BlockArc turn;
  turn.axis = FromPlane(arc.plane, Vec3(0, 0, 1));
  turn.radius = out_from.norm();
  turn.from_center_start = FromPlane(arc.plane, Vec3(out_from.x(), out_from.y(), 0));
  turn.from_center_end = FromPlane(arc.plane, Vec3(out_to.x(), out_to.y(), 0));
  Block block;
  if (turn.radius < kShortestBlock || out_to.norm() < kShortestBlock) return block;
  turn.sweep = sweep;
  const double level = turn.radius * turn.sweep, rise = to.z() - from.z();
  block.length = std::hypot(level, rise);
  const auto direction = [&](const Vec3& from_center) -> Vec3 {
    const Vec3 round = (arc.clockwise ? -1.0 : 1.0) * turn.axis.cross(from_center).normalized();
    return (level * round + rise * turn.axis) / block.length;
  };
  block.start = direction(turn.from_center_start);
  block.end = direction(turn.from_center_end);
  const auto limit = [&](const Vec3& axes) {
    const Vec3 in_plane = ToPlane(arc.plane, axes);
    return block.length /
           std::max(level / std::min(in_plane.x(), in_plane.y()), std::abs(rise) / in_plane.z());
  };
  block.speed = std::min(move.feed / 60.0, limit(limits.feed));
  block.acceleration = limit(limits.acceleration);
  block.arc = turn;
  return block;
}

// Positions are those of the program, since whether moves lie in one plane depends on its decimals. Sweeps
// are not: the ends of a short arc must not become those of a full circle.
std::vector<Block> BlocksOf(const Toolpath& toolpath, const AxisLimits& limits, double step) {
  const auto written = [&](const Vec3& p) -> Vec3 { return step * (p / step).array().round().matrix(); };
  std::vector<Block> blocks;
  for (std::size_t i = 1; i < toolpath.moves.size(); ++i) {
    const Move& move = toolpath.moves[i];
    const Vec3& at = toolpath.moves[i - 1].to;
    const ArcEnds ends{written(at), written(move.to)};
    Block block = move.arc ? ArcBlock(ends, Sweep(*move.arc, {at, move.to}), move, limits)
                           : LineBlock(ends.to - ends.from, move, limits);
    if (block.length < kShortestBlock) continue;
    block.move = i;
    block.left = block.length;
    blocks.push_back(block);
  }
  return blocks;
}

// The way in which the control joins a block to the next.
struct Joint {
  enum class Kind { kRest, kNoCorner, kArc, kOverlap };
  Kind kind = Kind::kRest;
  double speed = 0.0, acceleration = 0.0;  // of kArc
  double length = 0.0;                     // mm, of kArc
  double cut = 0.0;                        // mm, by which kArc cuts both blocks
  double cosine = 0.0;                     // of half the inner angle, of kOverlap
};

// The corner between two blocks, for the arc that rounds it.
struct Corner {
  double half_angle = 0.0;           // rad, half of the inner one
  double before = 0.0, after = 0.0;  // mm, how much of the blocks the arc may take
};

// Where an arc bends towards the corner's inside, LinuxCNC takes its chord instead. That sharpens the corner.
Corner CornerBetween(const Block& a, const Block& b, double half_angle) {
  Corner corner{half_angle, std::min(a.left, 0.5 * a.length), 0.5 * b.length};
  const auto take = [&](const BlockArc& arc, double share, bool inside) {
    if (!inside) return std::min(share * arc.sweep, 0.5 * kPi) * arc.radius;
    const double angle = std::min(share * arc.sweep, half_angle);
    corner.half_angle = std::min(corner.half_angle, half_angle - 0.25 * angle);
    return std::sin(0.25 * angle) * arc.radius;
  };
  if (a.arc) corner.before = take(*a.arc, 2.0 / 3.0, a.arc->from_center_end.dot(b.start) < 0.0);
  if (b.arc) corner.after = take(*b.arc, 1.0 / 3.0, b.arc->from_center_start.dot(a.end) >= 0.0);
  return corner;
}

// The least acceleration of the axes in a plane.
double AccelerationIn(const Vec3& normal, const Vec3& axes) {
  double least = kInfinity;
  for (int k = 0; k < 3; ++k) {
    const double share = std::sqrt(std::max(0.0, 1.0 - normal[k] * normal[k]));
    if (share > 1e-12) least = std::min(least, axes[k] / share);
  }
  return least;
}

Joint JointOf(const Block& a, const Block& b, const Vec3& axes, double tolerance) {
  Joint joint;
  const double cosine = a.end.dot(b.start);
  if (tolerance <= 0.0 || a.rapid != b.rapid || cosine < kTurnsBack) return joint;
  if (cosine > kStraightOn) {
    joint.kind = Joint::Kind::kNoCorner;
    return joint;
  }
  const Vec3 across = a.end.cross(b.start);
  const Vec3 normal = across.normalized();
  const double half_angle = 0.5 * (kPi - std::atan2(across.norm(), cosine));
  const auto in_plane = [&](const Block& block) {
    return !block.arc || normal.cross(block.arc->axis).norm() < kSamePlane;
  };
  const Corner corner = CornerBetween(a, b, half_angle);
  if (!in_plane(a) || !in_plane(b) || corner.half_angle < kSharpest) {
    joint.kind = Joint::Kind::kOverlap;
    joint.cosine = std::cos(half_angle);
    return joint;
  }
  joint.kind = Joint::Kind::kArc;
  joint.acceleration = AccelerationIn(normal, axes);
  const double most_across = kAcrossArc * joint.acceleration;
  const double tangent = std::tan(corner.half_angle), turn = kPi - 2.0 * corner.half_angle;
  const double within = std::min({tolerance, 0.25 * a.length, 0.25 * b.length});
  const double reach = std::min({within * std::cos(corner.half_angle) / (1.0 - std::sin(corner.half_angle)),
                                 corner.before, corner.after});
  const double widest = tangent * reach;
  joint.speed = std::min({a.speed, b.speed, std::sqrt(most_across * widest)});
  // The arc is as wide as the speed needs, or as braking to it with half of the acceleration would take.
  const double braked = std::min(std::sqrt(joint.acceleration * reach), joint.speed);
  const double as_braking = braked * joint.speed / (0.5 * joint.acceleration * turn);
  const double radius = std::max(joint.speed * joint.speed / most_across, std::min(widest, as_braking));
  joint.length = radius * turn;
  joint.cut = radius / tangent;
  return joint;
}

// The stretch of a block between the arcs in its corners.
Stretch StretchBetween(const Block& block) {
  Stretch stretch{std::max(block.left, kShortestBlock), block.speed, block.acceleration};
  if (block.halved) stretch.acceleration *= 0.5;
  if (block.arc) {
    stretch.speed = std::min(stretch.speed, std::sqrt(kAcrossArc * stretch.acceleration * block.arc->radius));
    stretch.acceleration *= kAlongArc;
  }
  return stretch;
}

// S: the second stretch begins that long before the first one ends.
double Overlap(const Stretch& a, const Stretch& b, double cosine, double tolerance) {
  const auto reached = [](const Stretch& s) {
    return std::min(s.speed, std::sqrt(0.5 * s.acceleration * s.length));
  };
  const double from = reached(a), to = reached(b);
  const double most = std::min(a.length / from, b.length / to);
  const double time = std::min(most, std::max(from / a.acceleration, to / b.acceleration));
  const double speed = std::min(from, time * a.acceleration);
  const double in_tolerance = 2.0 * std::sqrt(a.acceleration * tolerance / std::max(cosine, 1e-3));
  return std::min(speed, in_tolerance) / a.acceleration;
}

}  // namespace

std::vector<double> LinuxCncTimes(const Machine& machine, const Toolpath& toolpath,
                                  const LinuxCncPlanner& planner) {
  const AxisLimits limits = LimitsOf(machine);
  std::vector<double> times(toolpath.moves.size(), 0.0);
  std::vector<Block> blocks = BlocksOf(toolpath, limits, planner.step);
  if (blocks.empty()) return times;
  std::vector<Joint> joints(blocks.size());  // joint k is at the start of block k
  for (std::size_t k = 1; k < blocks.size(); ++k) {
    Block &a = blocks[k - 1], &b = blocks[k];
    joints[k] = JointOf(a, b, limits.acceleration, planner.tolerance);
    a.left -= joints[k].cut;
    b.left -= joints[k].cut;
    if (joints[k].kind == Joint::Kind::kOverlap) a.halved = b.halved = true;
  }
  blocks.back().halved = true;

  std::vector<Stretch> stretches;
  std::vector<double> corners;
  std::vector<std::size_t> of, of_block;  // the move of each stretch, the stretch of each block
  for (std::size_t k = 0; k < blocks.size(); ++k) {
    const Joint& joint = joints[k];
    if (joint.kind == Joint::Kind::kArc) {
      stretches.push_back(
          {std::max(joint.length, kShortestBlock), joint.speed, kAlongArc * joint.acceleration});
      corners.push_back(joint.speed);
      of.push_back(blocks[k - 1].move);
    }
    const bool rests = joint.kind == Joint::Kind::kRest || joint.kind == Joint::Kind::kOverlap;
    corners.push_back(rests ? 0.0 : kInfinity);
    of_block.push_back(stretches.size());
    stretches.push_back(StretchBetween(blocks[k]));
    of.push_back(blocks[k].move);
  }
  corners.push_back(0.0);
  const std::vector<double> taken = TrapezoidTimes(stretches, std::move(corners));
  for (std::size_t i = 0; i < taken.size(); ++i) times[of[i]] += taken[i];
  for (std::size_t k = 1; k < blocks.size(); ++k) {
    if (joints[k].kind != Joint::Kind::kOverlap) continue;
    const std::size_t a = of_block[k - 1], b = of_block[k];
    const double both = Overlap(stretches[a], stretches[b], joints[k].cosine, planner.tolerance);
    times[blocks[k - 1].move] -= std::min(both, 0.5 * taken[a]);
  }
  return times;
}

}  // namespace patchmill
