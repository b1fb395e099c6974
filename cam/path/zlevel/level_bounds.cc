#include "cam/path/zlevel/level_bounds.h"

#include <algorithm>
#include <cmath>

#include "core/base/parallel.h"

namespace patchmill {
namespace {

constexpr std::size_t kBlock = 256;  // leaves per task
// rad: a normal nearer to the horizon than this may be touched sideways.
constexpr double kHorizon = 1e-6;
// rad: a stored cone is wider by this than the computed one, since its axis is rounded to floats.
constexpr double kStoredSlack = 2e-7;
// Factor on a joint's turn and step, which are found at samples only (piece_sides.h).
constexpr double kJointMargin = 1.5;

// An angle by its cosine and sine.
struct Turn {
  double cos, sin;
};

// Range of e . t over the unit vectors e within `turn` of an axis. `cosine` is the dot product of the axis
// with the unit vector t.
struct Span {
  double lo, hi;
};
Span Along(double cosine, const Turn& turn) {
  constexpr double kRounding = 4e-8;  // of the sine near 0
  const double sine = std::sqrt(std::max(0.0, 1.0 - cosine * cosine));
  const double middle = cosine * turn.cos, half = sine * turn.sin + kRounding;
  return {-cosine > turn.cos ? -1.0 : middle - half, cosine > turn.cos ? 1.0 : middle + half};
}

LevelBounds::NodeBox Outward(const Box3& box) {
  LevelBounds::NodeBox out;
  for (int k = 0; k < 3; ++k) {
    const auto i = static_cast<std::size_t>(k);
    out.min[i] = std::nextafterf(static_cast<float>(box.min[k]), -HUGE_VALF);
    out.max[i] = std::nextafterf(static_cast<float>(box.max[k]), HUGE_VALF);
  }
  return out;
}

// Box of the centres of balls that touch anything in the part's box, from any side but below.
Box3 Around(const Box3& part, double radius) {
  Box3 box = part;
  box.min -= Vec3(radius, radius, kInfinity);
  box.max += Vec3::Constant(radius);
  return box;
}

}  // namespace

CenterBounds BoundCenters(const RectBounds& part, const NormalCone& normals, int side, double radius) {
  CenterBounds bounds;
  const Vec3 e = side * normals.axis;
  const Turn turn{std::cos(normals.angle), std::sin(normals.angle)};
  const double level = std::hypot(e.x(), e.y());  // sine of the axis' slope; e.z() is its cosine
  bounds.possible = e.z() * turn.cos + level * turn.sin > -kHorizon;
  if (!bounds.possible) return bounds;
  bounds.shank = e.z() * turn.cos - level * turn.sin < kHorizon;
  bounds.axis = part.axis;
  for (int k = 0; k < 3; ++k) {
    const Span along = Along(e.dot(part.axis.col(k)), turn);
    bounds.half[k] = part.half[k] + 0.5 * radius * (along.hi - along.lo);
    bounds.center +=
        part.axis.col(k) * (part.center.dot(part.axis.col(k)) + 0.5 * radius * (along.hi + along.lo));
    const Span own = Along(e[k], turn);
    bounds.box.min[k] = part.box.min[k] + radius * own.lo;
    bounds.box.max[k] = part.box.max[k] + radius * own.hi;
  }
  if (bounds.shank) bounds.box.min.z() = -kInfinity;
  if (turn.sin + 1e-7 < level * (1.0 - 1e-7)) {
    const double sine = turn.sin / level + 1e-7, cosine = std::sqrt(1.0 - sine * sine);
    const Vec2 middle = Xy(e) / level;
    const Vec2 across(-middle.y(), middle.x());
    bounds.directed = true;
    bounds.right = cosine * middle - sine * across;
    bounds.left = cosine * middle + sine * across;
  }
  return bounds;
}

bool OnSide(const SurfaceLeaf& leaf, int side) {
  switch (side) {
    case 0:
      return leaf.v0 == 0.0F;
    case 1:
      return leaf.u1 == 1.0F;
    case 2:
      return leaf.v1 == 1.0F;
    default:
      return leaf.u0 == 0.0F;
  }
}

double JointSlack(const SurfaceLeaf& leaf, const PieceSides& sides, double radius) {
  double slack = 0.0;
  for (int side = 0; side < 4; ++side) {
    const PieceSide& s = sides.At(leaf.piece, side);
    if (s.kind != SideKind::kSmooth || !OnSide(leaf, side)) continue;
    // A ball that rests on the edge of a step of height g leans over it by up to acos(1 - g/R).
    const double lean = std::acos(std::max(-1.0, 1.0 - s.step / radius));
    slack = std::max(slack, kJointMargin * (s.angle + lean));
  }
  return slack;
}

namespace {

// Does the leaf have creases or open sides? Contacts with these follow no normals.
bool HasCurves(const SurfaceLeaf& leaf, const PieceSides& sides) {
  for (int side = 0; side < 4; ++side) {
    if (OnSide(leaf, side) && sides.At(leaf.piece, side).kind != SideKind::kSmooth) return true;
  }
  return false;
}

Box3 CentersOfFace(const RectBounds& part, const NormalCone& normals, double radius) {
  if (!(normals.angle < kWidestNormals)) return Around(part.box, radius);
  Box3 box;
  for (const int side : {1, -1}) {
    const CenterBounds centers = BoundCenters(part, normals, side, radius);
    if (centers.possible) box.Add(centers.box);
  }
  return box;
}

}  // namespace

LevelBounds::LevelBounds(const Surface& surface, const PieceSides& sides, double radius,
                         const RunContext& run) {
  const std::size_t count = surface.leaves.size();
  cones_.resize(count);
  nodes_.resize(surface.nodes.size());
  std::vector<std::int32_t> node_of(count, 0);
  for (std::size_t i = 0; i < surface.nodes.size(); ++i) {
    if (surface.nodes[i].leaf >= 0)
      node_of[static_cast<std::size_t>(surface.nodes[i].leaf)] = static_cast<std::int32_t>(i);
  }
  const absl::Status status =
      ParallelFor(run, "contours: bounds", (count + kBlock - 1) / kBlock, [&](std::size_t block) {
        for (std::size_t i = block * kBlock; i < std::min(count, (block + 1) * kBlock); ++i) {
          const SurfaceLeaf& leaf = surface.leaves[i];
          const Piece& piece = surface.piece(leaf.piece);
          const NormalCone normals = BoundNormals(SubNet(piece.net, leaf.u0, leaf.u1, leaf.v0, leaf.v1));
          const double angle = normals.angle + JointSlack(leaf, sides, radius) + kStoredSlack;
          cones_[i] = {{static_cast<float>(normals.axis.x()), static_cast<float>(normals.axis.y()),
                        static_cast<float>(normals.axis.z())},
                       std::nextafterf(static_cast<float>(std::min(kPi, angle)), HUGE_VALF)};
          const auto node = static_cast<std::size_t>(node_of[i]);
          const RectBounds part = leaf.Bounds(surface.nodes[node].box);
          nodes_[node] = Outward(HasCurves(leaf, sides) ? Around(part.box, radius)
                                                        : CentersOfFace(part, Normals(i), radius));
        }
      });
  if (!status.ok()) return;
  // Children come after their parents.
  for (std::size_t i = surface.nodes.size(); i-- > 0;) {
    const SurfaceNode& node = surface.nodes[i];
    if (node.leaf >= 0) continue;
    const NodeBox &a = nodes_[i + 1], &b = nodes_[static_cast<std::size_t>(node.right)];
    for (std::size_t k = 0; k < 3; ++k) {
      nodes_[i].min[k] = std::min(a.min[k], b.min[k]);
      nodes_[i].max[k] = std::max(a.max[k], b.max[k]);
    }
  }
}

NormalCone LevelBounds::Normals(std::size_t leaf) const {
  const Cone& cone = cones_[leaf];
  return {Vec3(cone.axis[0], cone.axis[1], cone.axis[2]).normalized(), cone.angle};
}

}  // namespace patchmill
