// Where the ball's centre can be while it touches a part of the surface.
//
// On smooth ground a contact p obeys the contact rule: c = p + R e with e = +-n, n the unit normal there, and
// e_z >= 0; or, where p is above the centre and the shank touches, c_xy = p_xy + R e_xy with e_z = 0. The
// centres of a small part therefore lie in a box hardly larger than the part, thin along the normal, and only
// at few heights: this, not the mere reach of the ball, tells which parts a cell of a level has to look at.
#pragma once

#include <array>
#include <vector>

#include "cam/path/zlevel/level_slopes.h"
#include "cam/path/zlevel/piece_sides.h"
#include "core/base/run_context.h"
#include "core/surface/surface.h"

namespace patchmill {

// For one side of a part: e in the cone about the axis of its normals, or about the opposite one.
struct CenterBounds {
  bool possible = true;  // false: the side faces down, nothing can touch it
  // |(p + R e - center) . axis.col(k)| <= half[k] for every contact off the creases and open sides.
  Vec3 center = Vec3::Zero();
  Eigen::Matrix3d axis = Eigen::Matrix3d::Identity();
  Vec3 half = Vec3::Zero();
  Box3 box;            // of centres; down to -infinity where the shank may touch
  bool shank = false;  // the normals reach the horizon
  // Plan directions of e, counter-clockwise from right to left, less than half a turn; only where no e is
  // vertical.
  bool directed = false;
  Vec2 right = Vec2::Zero(), left = Vec2::Zero();
};

// `normals` narrower than kWidestNormals, with what a contact on a smooth joint may leave it by; `side` 1 or
// -1.
CenterBounds BoundCenters(const RectBounds& part, const NormalCone& normals, int side, double radius);

// rad: wider cones bound nothing but the reach of the ball.
inline constexpr double kWidestNormals = 1.2;

// The bounds of all leaves of a surface and of the nodes above them. References are not kept.
class LevelBounds {
 public:
  struct NodeBox {  // rounded outward
    std::array<float, 3> min, max;
  };

  // Cost about 1 us a leaf of a bicubic, 45 us of a rational net of degree 7, parallel; 70 bytes a leaf.
  // Unusable when the run was cancelled meanwhile.
  LevelBounds(const Surface& surface, const PieceSides& sides, double radius, const RunContext& run);

  // Boxes of the centres of balls that touch anything below a node of the surface, from any side but below.
  // Contacts with creases and open sides are in them too.
  const std::vector<NodeBox>& nodes() const { return nodes_; }
  // By leaf; what a contact on a smooth joint may leave the normals by is added.
  NormalCone Normals(std::size_t leaf) const;

 private:
  struct Cone {
    std::array<float, 3> axis;
    float angle;
  };
  std::vector<NodeBox> nodes_;
  std::vector<Cone> cones_;
};

// By how much (rad) a contact on one of the smooth joints among the sides of a leaf may leave the leaf's own
// normals: the joint's turn, and what the step between patches that do not meet exactly allows.
double JointSlack(const SurfaceLeaf& leaf, const PieceSides& sides, double radius);

// Does the leaf reach this side of its piece?
bool OnSide(const SurfaceLeaf& leaf, int side);

}  // namespace patchmill
