// Where the ball's centre can be while it touches a part of the surface.
//
// On a smooth surface a contact p obeys the contact rule. Either c = p + R e with e = +-n, n the unit normal
// there, and e_z >= 0; or p is above the centre, the shank touches it, and c_xy = p_xy + R e_xy with e_z = 0.
// The centres of a small part therefore lie in a box hardly larger than the part. The box is thin along the
// normal and spans only few heights. It decides which parts a cell of a level has to look at; the mere reach
// of the ball would admit far more.
#pragma once

#include <array>
#include <vector>

#include "cam/path/zlevel/level_slopes.h"
#include "cam/path/zlevel/piece_sides.h"
#include "core/base/run_context.h"
#include "core/surface/surface.h"

namespace patchmill {

// Bounds for one side of a part: e lies in the cone about the axis of its normals, or about the opposite one.
struct CenterBounds {
  bool possible = true;  // false: the side faces down and nothing can touch it
  // For every contact off the creases and open sides: |(p + R e - center) . axis.col(k)| <= half[k].
  Vec3 center = Vec3::Zero();
  Eigen::Matrix3d axis = Eigen::Matrix3d::Identity();
  Vec3 half = Vec3::Zero();
  Box3 box;            // of centres; reaches down to -infinity where the shank may touch
  bool shank = false;  // the normals reach the horizon
  // Directions of e in plan, counter-clockwise from right to left, less than half a turn. They are set only
  // where no e is vertical.
  bool directed = false;
  Vec2 right = Vec2::Zero(), left = Vec2::Zero();
};

// Bounds the centres of balls that touch `part` from one side. `normals` must be narrower than kWidestNormals
// and include JointSlack. `side` is 1 or -1.
CenterBounds BoundCenters(const RectBounds& part, const NormalCone& normals, int side, double radius);

// rad: cones at least this wide bound nothing better than the reach of the ball does.
inline constexpr double kWidestNormals = 1.2;

// The bounds of all leaves of a surface and of the nodes above them. References are not kept.
class LevelBounds {
 public:
  struct NodeBox {  // rounded outward
    std::array<float, 3> min, max;
  };

  // Cost about 1 us a leaf of a bicubic, 45 us of a rational net of degree 7, in parallel; 70 bytes a leaf.
  // The object is unusable if the run was cancelled meanwhile.
  LevelBounds(const Surface& surface, const PieceSides& sides, double radius, const RunContext& run);

  // Boxes of the centres of balls that touch anything below a node of the surface, from any side but below.
  // They include contacts with creases and open sides.
  const std::vector<NodeBox>& nodes() const { return nodes_; }
  // Normals of a leaf. The cone includes the leaf's JointSlack.
  NormalCone Normals(std::size_t leaf) const;

 private:
  struct Cone {
    std::array<float, 3> axis;
    float angle;
  };
  std::vector<NodeBox> nodes_;
  std::vector<Cone> cones_;
};

// Angle (rad) by which a contact on one of the smooth joints among the sides of a leaf may leave the leaf's
// own normals. It is the joint's turn, plus what the step between patches that do not meet exactly allows.
double JointSlack(const SurfaceLeaf& leaf, const PieceSides& sides, double radius);

// Does the leaf reach this side of its piece?
bool OnSide(const SurfaceLeaf& leaf, int side);

}  // namespace patchmill
