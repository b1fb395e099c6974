// The curve of an edge in the parameters of a surface.
#pragma once

#include <vector>

#include <Geom2d_Curve.hxx>
#include <Geom_Curve.hxx>
#include <Standard_Handle.hxx>

#include "core/base/vec.h"
#include "core/brep/brep_model.h"

namespace patchmill {

struct PlaceJet {
  Vec2 place = Vec2::Zero();  // parameters of the surface
  Vec2 d = Vec2::Zero();      // with respect to the edge's parameter
};

// Over the range [first, last] of the edge's parameter: a curve of the file between two of its own
// parameters, or the projection of the edge's curve in space on a plane.
class PlaceCurve {
 public:
  PlaceCurve() = default;
  PlaceCurve(const Handle(Geom2d_Curve) & curve, double curve_first, double curve_last, double first,
             double last);
  PlaceCurve(const Handle(Geom_Curve) & curve, const BrepFrame& plane, double first, double last);

  double first() const { return first_; }
  double last() const { return last_; }
  bool empty() const { return flat_.IsNull() && space_.IsNull(); }

  PlaceJet At(double t) const;
  void Shift(const Vec2& by) { shift_ += by; }

  // The ends, and parameters between them at which it is not smooth; increasing.
  std::vector<double> Breaks() const;

 private:
  Handle(Geom2d_Curve) flat_;
  Handle(Geom_Curve) space_;
  BrepFrame plane_;
  double first_ = 0.0, last_ = 1.0;
  double curve_first_ = 0.0, scale_ = 1.0;
  Vec2 shift_ = Vec2::Zero();
};

}  // namespace patchmill
