// Answers questions about single points of one waterline.
//
// In this folder h(q) is the centre height over the place q in plan: the lowest centre at which ball and
// shank gouge nothing [location (1)]. c is the level: the centre height (mm) of the waterline. A place q is
// *forbidden* if h(q) > c, else *free*; the waterline is the border between both [contours]. A surface point
// p forbids the disc of radius rho(p) around p_xy [contours (1)], at places q inside which a ball centred at
// (q, c) would gouge p. A *branch* of the surface is a part on which the point nearest to the ball moves
// smoothly with the ball [location, section 10].
#pragma once

#include <array>
#include <cmath>
#include <optional>

#include "cam/location/locator.h"
#include "cam/location/ray_slide.h"
#include "cam/path/zlevel/piece_sides.h"

namespace patchmill {

// A point of the waterline: the place q lies on the rim of the disc that `contact` forbids, and is free, h(q)
// <= c + 1e-9 mm.
struct LevelPoint {
  Vec2 q = Vec2::Zero();
  SurfacePoint contact;
  std::optional<SurfacePoint> other;  // the second contact, if two discs meet here (a corner)
};

// Remembers the last few forbidden discs. Most forbidden places lie in one of them, which saves a query.
class RecentDiscs {
 public:
  void Add(const SurfacePoint& contact, double rho) {
    discs_[next_] = {contact, rho};
    next_ = (next_ + 1) % discs_.size();
  }
  // Returns a contact whose disc, smaller by `margin` (mm), contains the rectangle with this middle and these
  // half sides in plan; null if none is known.
  const SurfacePoint* Holding(const Vec2& mid, const Vec2& half, double margin) const {
    for (const Disc& disc : discs_) {
      const double dx = std::abs(mid.x() - disc.contact.p.x()) + half.x();
      const double dy = std::abs(mid.y() - disc.contact.p.y()) + half.y();
      if (disc.rho > margin && dx * dx + dy * dy < (disc.rho - margin) * (disc.rho - margin)) {
        return &disc.contact;
      }
    }
    return nullptr;
  }

 private:
  struct Disc {
    SurfacePoint contact;
    double rho = 0.0;
  };
  std::array<Disc, 8> discs_;
  std::size_t next_ = 0;
};

// Decides with exact queries of h whether a place of one level is free, and walks from forbidden places to
// the waterline. Const; keeps references.
class LevelOracle {
 public:
  // `z` is c, mm.
  LevelOracle(const Locator& locator, const PieceSides& sides, double z)
      : locator_(locator), sides_(sides), z_(z), radius_(locator.radius()) {}

  double z() const { return z_; }
  double radius() const { return radius_; }
  const Surface& surface() const { return locator_.surface(); }
  Vec3 Center(const Vec2& q) const { return Lift(q, z_); }

  // Returns a surface point whose disc contains q; nullopt where q is free. `hint` is a contact nearby. It
  // saves time only.
  std::optional<SurfacePoint> Obstacle(const Vec2& q, const SurfacePoint* hint) const;
  // Returns the surface point that is deepest in the ball at (q, c) and its upward sweep, on the branch on
  // which `from` lies: the point nearest to the upward ray at (q, c).
  SurfacePoint DeepestOnBranch(const SurfacePoint& from, const Vec2& q) const;
  // Radius rho(p) of the disc that p forbids at this level, mm; 0 if p is too low, p_z <= c - R.
  double ForbiddenRadius(const Vec3& p) const;
  // Distance of the contact from the upward ray at (q, c), less R, mm: what a ball there leaves at the
  // contact. Negative if the ball would gouge it.
  double Excess(const Vec2& q, const Vec3& contact) const;

  // Length (mm) of the straight way from q along the unit vector `direction` to the rim of the disc that the
  // contact forbids; 0 if q lies outside of the disc.
  double ExitLength(const Vec2& q, const Vec3& contact, const Vec2& direction) const;

  // Walks from `start`, in the disc of `contact` or on its rim, straight along the unit vector `direction`
  // and returns the first point of the waterline. Each step leads to the rim of a disc that is forbidden, so
  // no free stretch is skipped [contours (4)]. The disc of each step is that of the deepest point of a
  // branch; so steep walls take no more steps than gentle slopes. The walk ends at `reach` (mm from `start`)
  // at the latest; that place must be free.
  LevelPoint Exit(const Vec2& start, const SurfacePoint& contact, const Vec2& direction, double reach) const;

  // The part of a line that is searched: `back` mm behind its middle to `front` mm before it. `crossed`: the
  // line is known to be forbidden at its back end and free at its front end, with one crossing of the
  // waterline in between.
  struct Stretch {
    double back = 0.0, front = 0.0;
    bool crossed = false;
  };
  // Returns a point of the waterline on the line through m along the unit vector `direction`, which points to
  // the free side; nullopt if none is found. The search starts at m if m is forbidden. Else it starts at the
  // first rim behind m of the discs of a and b; else, if stretch.crossed, at the back end of the stretch.
  std::optional<LevelPoint> RootOnLine(const Vec2& m, const Vec2& direction, const SurfacePoint& a,
                                       const SurfacePoint& b, const Stretch& stretch) const;

  // Returns the corner between a and b: the place at which the rims of two forbidden discs meet, one of a's
  // branch and one of b's. The rims meet at two places; the search begins with the one nearer to the middle
  // of the chord a b. At each place the deepest points of both branches give new discs, until the place
  // stands still (quadratic convergence). nullopt if both branches are one, if a third contact forbids the
  // corner, or if it is farther than `reach` (mm) from the middle of the chord.
  std::optional<LevelPoint> Corner(const LevelPoint& a, const LevelPoint& b, double reach) const;

 private:
  // A straight way in plan, and the distance (mm) gone along it. `direction` is a unit vector, or zero: no
  // motion.
  struct Way {
    Vec2 start, direction;
    double gone = 0.0;
    Vec2 At() const { return start + gone * direction; }
  };
  // Goes along `way` until no disc of the branch of `from` contains the place, or until `reach` (mm). Returns
  // the deepest point of the branch there.
  SurfacePoint LeaveBranch(Way& way, const SurfacePoint& from, double reach) const;
  // Returns the point at which `slide` stands, on the neighbouring piece, if a side of its own piece stopped
  // the last step; nullopt at an open side or if no side did.
  std::optional<SurfacePoint> Beyond(const RaySlide& slide) const;

  const Locator& locator_;
  const PieceSides& sides_;
  double z_, radius_;
};

}  // namespace patchmill
