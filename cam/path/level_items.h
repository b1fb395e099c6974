// The parts of the surface that can carry a contact of one level of h, as a tree that is opened on demand.
//
// At centre height c a surface point p forbids the disc |q - p_xy| < rho(p), rho = sqrt(R^2 - max(0, c -
// p_z)^2). A point q of the contour touches some p with |q - p_xy| = rho(p) (T8b), and there the contact rule
// holds: on smooth ground (c - p)/R is the normal, so that its slope is known from p_z; on an open edge or a
// crease p lies on that curve. Parts that can do neither are dropped once and for all at this level.
#pragma once

#include <cstdint>
#include <vector>

#include "cam/location/locator.h"
#include "cam/path/contour_sides.h"
#include "cam/path/level_slopes.h"
#include "cam/path/pass_params.h"

namespace patchmill {

// An axis-parallel rectangle in plan: a cell, or an edge of one (one half side zero).
struct PlanCell {
  Vec2 mid = Vec2::Zero();
  Vec2 half = Vec2::Zero();
};

// Open cone of plan directions, narrower than pi, as its two extreme unit-free directions.
struct DirectionCone {
  bool valid = false;  // false: half turn or more
  bool empty = true;
  Vec2 right = Vec2::Zero(), left = Vec2::Zero();  // counter-clockwise from right to left
  double Angle() const;                            // rad
};

class LevelItems {
 public:
  // `slopes`: per leaf of the surface, or empty (then found on demand). All references are kept.
  LevelItems(const Locator& locator, const PieceSides& sides, const std::vector<SlopeRange>& slopes,
             double z);

  std::int32_t root() const { return 0; }

  // Can an item touch the ball at some q of the cell?
  bool Touches(std::int32_t item, const PlanCell& cell) const;
  // Appends the parts of `items` that touch the cell, opened until they are small enough for a cell of
  // `width` (the rule of ALGORITHMS 11: about sqrt(width R)).
  void Collect(const std::vector<std::int32_t>& items, const PlanCell& cell, double width,
               std::vector<std::int32_t>& out);
  // Is the cell covered by the disc of one item's middle point?
  bool Covers(std::int32_t item, const PlanCell& cell) const;
  // Can a contact on the item be part of a pass: not above the centre, its slope in the window?
  bool Wanted(std::int32_t item, const SlopeWindow& window) const;
  // Directions from contacts on the items to points of the cell.
  DirectionCone Directions(const std::vector<std::int32_t>& items, const PlanCell& cell) const;

 private:
  enum class Kind : std::int8_t { kNode, kRect, kCurve };
  struct Item {
    Kind kind = Kind::kNode;
    bool opened = false;
    bool oriented = false;             // the oriented box below counts
    std::int32_t first = 0, last = 0;  // children, when opened
    std::int32_t id = 0;               // node index or piece
    std::int32_t side = 0;             // kCurve
    double x0 = 0, x1 = 0, y0 = 0, y1 = 0;
    double rho2 = 0, rho = 0;                // largest disc
    double size = 0;                         // larger side of the plan box
    double nx = 0, ny = 0, off = kInfinity;  // contact needs nx x + ny y <= off
    double u0 = 0, u1 = 1, v0 = 0, v1 = 1;
    bool split_u = true;
    double slope_slack = 0;  // rad, by which a smooth joint may turn
    SlopeRange slope;
    double z_min = -kInfinity;
    double flattest = 0.0, steepest = kPi / 2.0;  // slopes of contacts at the heights it has
    Vec2 middle = Vec2::Zero();                   // plan of a surface point, with its disc
    double middle_rho = -1.0;
    Vec3 center = Vec3::Zero(), half = Vec3::Zero();
    Eigen::Matrix3d axis = Eigen::Matrix3d::Identity();
  };

  double Rho2(double z) const;
  bool SlopeFits(const SlopeRange& slope, double slack, double z_min, double z_max) const;
  bool SetBox(Item& item, const Box3& box) const;  // false: out of reach at this level
  void SetOriented(Item& item, const Vec3& center, const Eigen::Matrix3d& axis, const Vec3& half,
                   double z_max) const;
  void Open(std::int32_t index);
  void AddNode(std::int32_t node);
  void AddLeaf(const SurfaceLeaf& leaf, std::size_t leaf_index, const Box3& box);
  void AddRect(const Item& parent, double u0, double u1, double v0, double v1);
  void AddCurve(PieceId piece, int side, double t0, double t1);
  bool CanOpen(const Item& item) const;

  const Locator& locator_;
  const Surface& surface_;
  const PieceSides& sides_;
  const std::vector<SlopeRange>& slopes_;
  double z_, radius_;
  std::vector<Item> items_;
  std::vector<std::int32_t> stack_;
};

}  // namespace patchmill
