// The parts of the surface that a ball may touch while its centre is at one level, as a tree that is opened
// on demand.
//
// Here c is the level (height of the centre, mm), q a place in plan and R the radius of the ball. A surface
// point p forbids the disc |q - p_xy| < rho(p) with rho = sqrt(R^2 - max(0, c - p_z)^2) [contours (1)]. At a
// place q of the waterline the ball touches a point p with |q - p_xy| = rho(p) [contours T8b]. If the surface
// is smooth at p, the contact rule of level_bounds.h holds, and (q, c) lies in the box of the part's centres.
// On an open edge or a crease, and where the ball may touch with its equator, only the distance from q to p
// counts.
#pragma once

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "cam/location/locator.h"
#include "cam/path/stepover/pass_params.h"
#include "cam/path/zlevel/direction_cone.h"
#include "cam/path/zlevel/level_bounds.h"
#include "cam/path/zlevel/piece_sides.h"

namespace patchmill {

// An axis-parallel rectangle in plan: a cell, or an edge of one (then one half side is zero).
struct XyRect {
  Vec2 mid = Vec2::Zero();
  Vec2 half = Vec2::Zero();
};

class ContactCandidates {
 public:
  // Keeps all references.
  ContactCandidates(const Locator& locator, const PieceSides& sides, const LevelBounds& bounds, double z);

  // A candidate is the index of a part, or (negative) a node of the surface that is not opened yet.
  static constexpr std::int32_t kRoot = -1;

  // Appends the parts of `candidates` that may be touched from the cell, opened until they are small enough
  // for a cell of `width` ([contours (3)]).
  void Collect(const std::vector<std::int32_t>& candidates, const XyRect& cell, double width,
               std::vector<std::int32_t>& out);
  // True if the disc of the candidate's middle point covers the cell, so that all of the cell is forbidden.
  bool Covers(std::int32_t candidate, const XyRect& cell) const;
  // True if a contact on the candidate may be part of a pass: if it may lie no higher than the centre and
  // have its slope in the window.
  bool Wanted(std::int32_t candidate, const SlopeWindow& window) const;
  // Returns the directions from contacts on the candidates to points of the cell. With `closely` the
  // directions from the parts' boxes count too, which costs more.
  DirectionCone Directions(const std::vector<std::int32_t>& candidates, const XyRect& cell,
                           bool closely) const;

 private:
  enum class Kind : std::int8_t { kRect, kCurve };
  struct Candidate {
    // Where in plan the centres lie that touch the part, for the test of a cell. All of them lie in the box
    // x0..x1, y0..y1. If `oriented`, this is the box of the part's centres, cut at the level, and |ax x + ay
    // y - mid| <= half holds for each of three axes, too. Otherwise it is the box of the part, widened by
    // rho.
    double x0 = 0, x1 = 0, y0 = 0, y1 = 0;
    std::array<double, 3> ax{}, ay{}, mid{}, half{};
    bool oriented = false;
    bool directed = false;
    // True: the part lies below the centre. Then the ball must also reach the part's own box, |ax x + ay y -
    // own_mid| <= own_half for each of three axes. That is exact where the centres of a round hollow meet.
    bool below = false;
    Kind kind = Kind::kRect;
    bool opened = false;
    std::int32_t first = 0, last = 0;  // children, if opened
    double rho2 = 0, rho = 0;          // of the largest disc
    std::array<double, 3> own_mid{}, own_half{};
    // `directed`: directions from contacts to centres, as in CenterBounds.
    Vec2 right = Vec2::Zero(), left = Vec2::Zero();
    double px0 = 0, px1 = 0, py0 = 0, py1 = 0;  // plan box of the part
    double size = 0;                            // its larger side
    std::int32_t piece = 0;
    int side = 0;  // kCurve: side of its piece; kRect: 1 or -1 as in level_bounds.h, 0: both
    double u0 = 0, u1 = 1, v0 = 0, v1 = 1;
    NormalCone normals;
    double z_min = -kInfinity, z_max = kInfinity;
    Vec2 middle = Vec2::Zero();  // plan of a surface point, with its disc
    double middle_rho = -1.0;
  };

  double ForbiddenRadius2(double z) const;
  bool NodeTouches(std::int32_t node, const XyRect& cell) const;
  bool Touches(const Candidate& item, const XyRect& cell) const;
  DirectionCone DirectionsFrom(const Candidate& item, const XyRect& cell, bool closely) const;
  bool NeedsOpening(const Candidate& item, double width) const;
  void Open(std::int32_t index);
  // Returns the range of a leaf's candidates. They are made at the first call.
  std::pair<std::int32_t, std::int32_t> OfLeaf(std::int32_t node);
  bool SetLevel(Candidate& item, const Box3& box) const;  // false: out of reach
  void AddFace(Candidate item, const RectBounds& part);
  void AddRect(const Candidate& parent, double u0, double u1, double v0, double v1);
  void SetMiddle(Candidate& item, const Vec3& p) const;
  void AddCurve(PieceId piece, int side, double t0, double t1);

  const Locator& locator_;
  const Surface& surface_;
  const PieceSides& sides_;
  const LevelBounds& bounds_;
  double z_, radius_;
  std::vector<Candidate> candidates_;
  std::vector<std::int32_t> first_of_leaf_;  // -1: not made yet
  std::vector<std::int32_t> stack_;
};

}  // namespace patchmill
