// Bounds the places of the ball's centre while it touches a part of the surface.
//
// Here c is a centre, R the radius of the ball, p a contact and n the unit normal of the surface at p. On a
// smooth surface a contact obeys the *contact rule* [contours T8b]. Either the ball touches p: c = p + R e
// with e = +-n, e_z >= 0. Or the shank touches p, which is above the centre: c_xy = p_xy + R e_xy with e_z =
// 0. So the centres of balls that touch a small part lie in a box that is hardly larger than the part, thin
// along the normal, and spans few heights. The boxes tell which parts of the surface matter for a cell of a
// level. The distance between part and cell alone would let far more parts pass.
#pragma once

#include <array>
#include <vector>

#include "cam/path/zlevel/level_slopes.h"
#include "cam/path/zlevel/piece_sides.h"
#include "core/base/run_context.h"
#include "core/surface/surface.h"

namespace patchmill {

// Bounds for balls on one side of a part. Their directions e lie in the cone of the part's normals, or in the
// opposite cone.
struct CenterBounds {
  bool possible = true;  // false: the side looks down everywhere, so no ball touches it
  // For every contact off the creases and open sides: |(p + R e - center) . axis.col(k)| <= half[k].
  Vec3 center = Vec3::Zero();
  Eigen::Matrix3d axis = Eigen::Matrix3d::Identity();
  Vec3 half = Vec3::Zero();
  Box3 box;            // of centres; reaches down to -infinity where the shank may touch
  bool shank = false;  // a normal may be horizontal, so the shank may touch
  // `directed`: no e is vertical, and the directions of e in plan run counter-clockwise from `right` to
  // `left`, by less than half a turn. Otherwise `right` and `left` are not set.
  bool directed = false;
  Vec2 right = Vec2::Zero(), left = Vec2::Zero();
};

// Bounds the centres of balls that touch `part` from one side. `normals` must be narrower than kWidestNormals
// and include JointSlack. `side` is 1 or -1.
CenterBounds BoundCenters(const RectBounds& part, const NormalCone& normals, int side, double radius);

// rad: wider cones of normals are not used. Their boxes would be no smaller than the part's box widened by R.
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

// Returns the angle (rad) by which the direction of a contact on a smooth side of the leaf may differ from
// the leaf's own normals. It is the angle between the tangent planes of both sides, plus the angle by which a
// ball may lean over a step between patches that do not meet exactly.
double JointSlack(const SurfaceLeaf& leaf, const PieceSides& sides, double radius);

// True if the leaf ends at this side of its piece.
bool OnSide(const SurfaceLeaf& leaf, int side);

}  // namespace patchmill
