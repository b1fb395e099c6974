// The border of {h > c} at one level c, point by point; h is the only judge.
#pragma once

#include <array>
#include <cmath>
#include <optional>

#include "cam/location/locator.h"
#include "cam/location/ray_slide.h"
#include "cam/path/zlevel/piece_sides.h"

namespace patchmill {

// A point of the border: its contact forbids a disc on whose rim it lies, and h <= c (to 1e-9).
struct LevelPoint {
  Vec2 q = Vec2::Zero();
  SurfacePoint contact;
  std::optional<SurfacePoint> other;  // the second contact at a corner
};

// The last few forbidden discs found: most questions lie in one of them.
class RecentDiscs {
 public:
  void Add(const SurfacePoint& contact, double rho) {
    discs_[next_] = {contact, rho};
    next_ = (next_ + 1) % discs_.size();
  }
  // A contact whose disc holds all points within `half` of `mid`, by at least `margin` mm; else null.
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

  // A point that forbids q (its disc holds q), none where q is free.
  // `hint`: a contact nearby, for speed.
  std::optional<SurfacePoint> Obstacle(const Vec2& q, const SurfacePoint* hint) const;
  // The nearest point of the branch of `from` to the ball with everything above it, centred at (q, c).
  SurfacePoint Deepest(const SurfacePoint& from, const Vec2& q) const;
  // Radius of the disc that a surface point forbids at this level (0 when it is too low).
  double ForbiddenRadius(const Vec3& p) const;
  // Distance of the centre (q, c) from a contact, beyond the radius: what stays standing on it.
  double Excess(const Vec2& q, const Vec3& contact) const;

  // How far from q, inside the disc of a contact, it is to the disc's rim along the unit vector `direction`;
  // 0 outside of the disc.
  double ExitLength(const Vec2& q, const Vec3& contact, const Vec2& direction) const;

  // From a point in the disc of a contact (or on its rim), straight along the unit vector `direction`: the
  // first point of the border. Every step is the exit from a disc that truly is forbidden, so no free stretch
  // is skipped ([contours (4)]); the disc is that of the deepest point of its branch, so that steep walls
  // cost no more than gentle ground. Stops at `reach` (mm), which the caller knows to be free, at the latest.
  LevelPoint Exit(const Vec2& start, const SurfacePoint& contact, const Vec2& direction, double reach) const;

  // How far a line is searched on both sides of its middle (mm). `crossed`: it is known to lead from
  // forbidden ground at its back to free ground in front, across the border once only.
  struct Stretch {
    double back = 0.0, front = 0.0;
    bool crossed = false;
  };
  // A border point on the line through m along `direction` (pointing to the free side): from m outward when m
  // is forbidden, else from the nearest disc of the two contacts behind m, else from the back.
  std::optional<LevelPoint> RootOnLine(const Vec2& m, const Vec2& direction, const SurfacePoint& a,
                                       const SurfacePoint& b, const Stretch& stretch) const;

  // The corner between the branches of two contacts, nearest to the chord a b: both discs at once,
  // re-localised until they stand still (quadratic). nullopt when the branches are one, the corner is covered
  // by a third contact, or is farther than `reach` from the chord's middle.
  std::optional<LevelPoint> Corner(const LevelPoint& a, const LevelPoint& b, double reach) const;

 private:
  // A straight way, and how far along it.
  struct Way {
    Vec2 start, direction;
    double gone = 0.0;
    Vec2 At() const { return start + gone * direction; }
  };
  // Along `way` until it leaves the discs of the branch of `from`, or reaches `reach`. The last contact.
  SurfacePoint LeaveBranch(Way& way, const SurfacePoint& from, double reach) const;
  // The same place on the piece across the side that holds `slide` back, if there is one.
  std::optional<SurfacePoint> Beyond(const RaySlide& slide) const;

  const Locator& locator_;
  const PieceSides& sides_;
  double z_, radius_;
};

}  // namespace patchmill
