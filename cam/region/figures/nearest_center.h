// The centre nearest to a place where a ball may stand: free, above the floor, allowed.
#pragma once

#include <optional>

#include "cam/location/limits/operation_limits.h"
#include "cam/location/locator.h"

namespace patchmill {

struct LeftoverParams {
  double floor_z = -kInfinity;                        // mm, lowest tip
  const OperationLimits* operation_limits = nullptr;  // null: allows all centres
  double fine = 0.0;                                  // mm, at least R / 1000: depths are not told closer
};

// The centre in the column over a place of the plane that is nearest to what is asked for.
struct Column {
  Vec3 center = Vec3::Zero();   // where none is allowed, the lowest that the surface alone would leave free
  Vec3 normal = Vec3::UnitZ();  // of the free centres' border there, towards them
  bool held = false;            // stands on that border
  double distance = kInfinity;  // infinite: not allowed
  // What the lowest free ball over this place touches.
  std::optional<SurfacePoint> contact = std::nullopt;
};

// Search for the free centre that is nearest to one place, by steps that know more and more. One as near as
// `enough` (mm) ends each of them. Keeps references to locator and params.
class NearestCenter {
 public:
  NearestCenter(const Locator& locator, const LeftoverParams& params, const Vec3& p, double enough = 0.0)
      : locator_(locator), params_(params), p_(p), enough_(enough) {}

  // From right above it; no distance: nothing is allowed there. Cost: a height, less with a column nearby.
  Column Above(const Column& near = Column()) const { return At(Xy(p_), near); }
  // Each column looked at adds the half-space that it knows; the next one is towards the point of all of them
  // that is nearest to p. Exact in kinks, where two contacts hold the ball and coordinate searches stop.
  // Cost: some ten heights.
  Column Descend(Column at) const;
  // On the side of a normal at p, pushed aside by what is in the way there: where no column beside that one
  // is free.
  Column Beside(const Vec3& normal, Column known) const;
  // From all around, as far as something nearer than `known` may be. Cost: some two hundred heights.
  Column FromAround(Column known) const;
  // Eight ways around, ever closer: exact where a whole circle holds the ball, as on the rim of a hole or a
  // dimple, where every descent by half-spaces ends beside the tip. Cost: up to 600 heights.
  Column Settle(Column at) const;

 private:
  void Between(const Vec2& way, double low, const Column& inner, double high, const Column& outer,
               int halvings, Column& best) const;
  Column Polish(Column at) const;
  Column AlongRay(Column at) const;
  // The column over q; one nearby, only for speed. To a thousandth of R, or to the gap in mm.
  Column At(const Vec2& q, const Column& near) const;
  Column At(const Vec2& q, const Column& near, double gap) const;

  const Locator& locator_;
  const LeftoverParams& params_;
  const Vec3 p_;
  const double enough_;
};

}  // namespace patchmill
