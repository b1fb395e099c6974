// The border of {h > c} at one level c, point by point. Only h decides what is forbidden.
#pragma once

#include <array>
#include <cmath>
#include <optional>

#include "cam/location/locator.h"
#include "cam/location/ray_slide.h"
#include "cam/path/zlevel/piece_sides.h"

namespace patchmill {

// A point of the border: it lies on the rim of the disc that its contact forbids, and h <= c (to 1e-9).
struct LevelPoint {
  Vec2 q = Vec2::Zero();
  SurfacePoint contact;
  std::optional<SurfacePoint> other;  // the second contact at a corner
};

// The last few forbidden discs found. Most queries lie in one of them.
class RecentDiscs {
 public:
  void Add(const SurfacePoint& contact, double rho) {
    discs_[next_] = {contact, rho};
    next_ = (next_ + 1) % discs_.size();
  }
  // Returns a contact whose disc holds all points within `half` of `mid`, by at least `margin` mm; else null.
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

class LevelOracle {
 public:
  // Keeps references.
  LevelOracle(const Locator& locator, const PieceSides& sides, double z)
      : locator_(locator), sides_(sides), z_(z), radius_(locator.radius()) {}

  double z() const { return z_; }
  double radius() const { return radius_; }
  const Surface& surface() const { return locator_.surface(); }
  Vec3 Center(const Vec2& q) const { return Lift(q, z_); }

  // Returns a point that forbids q (its disc holds q), or nothing where q is free. `hint` is a contact
  // nearby, for speed.
  std::optional<SurfacePoint> Obstacle(const Vec2& q, const SurfacePoint* hint) const;
  // Returns the point of the branch of `from` that is nearest to the ball centred at (q, c), with everything
  // above the ball.
  SurfacePoint Deepest(const SurfacePoint& from, const Vec2& q) const;
  // Radius of the disc that a surface point forbids at this level (0 when it is too low).
  double ForbiddenRadius(const Vec3& p) const;
  // Distance of the centre (q, c) from a contact, less the radius: the height that stays standing on it.
  double Excess(const Vec2& q, const Vec3& contact) const;

  // Length of the way from q, inside the disc of a contact, to the disc's rim along the unit vector
  // `direction`; 0 outside of the disc.
  double ExitLength(const Vec2& q, const Vec3& contact, const Vec2& direction) const;

  // Goes from a point in the disc of a contact (or on its rim) straight along the unit vector `direction` and
  // returns the first point of the border. Every step leaves a disc that truly is forbidden, so no free
  // stretch is skipped ([contours (4)]). The disc is that of the deepest point of its branch, so steep walls
  // cost no more than gentle slopes. Stops at `reach` (mm) at the latest, which must be free.
  LevelPoint Exit(const Vec2& start, const SurfacePoint& contact, const Vec2& direction, double reach) const;

  // How far a line is searched on both sides of its middle (mm). `crossed`: the line is known to lead from
  // forbidden places at its back to free places in front, and to cross the border once only.
  struct Stretch {
    double back = 0.0, front = 0.0;
    bool crossed = false;
  };
  // Returns a border point on the line through m along `direction`, which points to the free side. The search
  // starts at m if m is forbidden, else at the nearest disc of the two contacts behind m, else at the back.
  std::optional<LevelPoint> RootOnLine(const Vec2& m, const Vec2& direction, const SurfacePoint& a,
                                       const SurfacePoint& b, const Stretch& stretch) const;

  // Returns the corner between the branches of two contacts that is nearest to the chord a b. Both discs are
  // located anew together until they stand still (quadratic convergence). Returns nullopt when the branches
  // are one, or the corner is covered by a third contact or farther than `reach` from the chord's middle.
  std::optional<LevelPoint> Corner(const LevelPoint& a, const LevelPoint& b, double reach) const;

 private:
  // A straight way, and the distance gone along it.
  struct Way {
    Vec2 start, direction;
    double gone = 0.0;
    Vec2 At() const { return start + gone * direction; }
  };
  // Goes along `way` until it leaves the discs of the branch of `from` or is at `reach`; returns the contact.
  SurfacePoint LeaveBranch(Way& way, const SurfacePoint& from, double reach) const;
  // Returns the same place on the piece across the side that holds `slide` back, if there is one.
  std::optional<SurfacePoint> Beyond(const RaySlide& slide) const;

  const Locator& locator_;
  const PieceSides& sides_;
  double z_, radius_;
};

}  // namespace patchmill
