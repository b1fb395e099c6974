// Finds, for a place p of the surface, the nearest centre at which the ball may stand: free, above the floor
// and allowed.
#pragma once

#include <optional>

#include "cam/location/limits/operation_limits.h"
#include "cam/location/locator.h"

namespace patchmill {

struct LeftoverParams {
  double floor_z = -kInfinity;                        // mm, lowest tip
  const OperationLimits* operation_limits = nullptr;  // null: allows all centres
  double fine = 0.0;                                  // mm: accuracy of depths, or R / 1000 if that is more
};

// The best centre over one place in plan: of the free and allowed centres over it, the one nearest to p.
struct Column {
  Vec3 center = Vec3::Zero();   // if none is allowed: the lowest centre that is free of the surface
  Vec3 normal = Vec3::UnitZ();  // normal of the border of the free centres at `center`, towards them
  bool held = false;            // `center` lies on that border
  double distance = kInfinity;  // mm from p to `center`; infinite if none is allowed
  // Contact of the lowest free ball in the column.
  std::optional<SurfacePoint> contact = std::nullopt;
};

// Searches the free centre nearest to the place p, in steps of rising cost. Each step ends early when it has
// a centre within `enough` (mm). Keeps references to locator and params.
class NearestCenter {
 public:
  NearestCenter(const Locator& locator, const LeftoverParams& params, const Vec3& p, double enough = 0.0)
      : locator_(locator), params_(params), p_(p), enough_(enough) {}

  // The column right above p. Its distance is infinite if no centre is allowed there. Cost: one height, less
  // if a column nearby is passed.
  Column Above(const Column& near = Column()) const { return At(Xy(p_), near); }
  // Descent by half-spaces. Each column adds the half-space of free centres behind its normal. The next
  // column lies towards the point nearest to p that all half-spaces contain. This is exact in kinks, where
  // two contacts hold the ball and coordinate searches stop. Cost: some ten heights.
  Column Descend(Column at) const;
  // The free centre near p + R normal, pushed aside by what is in the way there (FreeCenterNear). It finds
  // centres whose neighbouring columns are not free, as in a hole of the ball's own size.
  Column Beside(const Vec3& normal, Column known) const;
  // Searches columns in all directions, as far away as a centre nearer than `known` may be. Cost: some two
  // hundred heights.
  Column FromAround(Column known) const;
  // Steps in eight directions, ever shorter. It is exact where a whole circle holds the ball, as on the rim
  // of a hole or dimple, where a descent by half-spaces stops before the minimum. Cost: up to 600 heights.
  Column Settle(Column at) const;

 private:
  // A column at the distance `radius` (mm) from p, in a direction of FromAround.
  struct RingColumn {
    double radius = 0.0;
    Column column;
  };
  Column Between(const Vec2& way, const RingColumn& inner, const RingColumn& outer, int halvings,
                 Column best) const;
  Column Polish(Column at) const;
  Column AlongRay(Column at) const;
  // The column over q. `near` is a column nearby and only makes it faster. The height is exact to R / 1000,
  // or to `gap` (mm).
  Column At(const Vec2& q, const Column& near) const;
  Column At(const Vec2& q, const Column& near, double gap) const;

  const Locator& locator_;
  const LeftoverParams& params_;
  const Vec3 p_;
  const double enough_;
};

}  // namespace patchmill
