#include "cam/region/surface_fields.h"

#include <cmath>

#include "core/diffgeo/forms.h"

namespace patchmill {

FieldValues EvaluateFields(const Piece& piece, double u, double v, double cos_steep) {
  const SurfaceJet jet = Evaluate(piece, u, v);
  FieldValues f;
  f.p = jet.p;
  const auto normal = UnitNormal(jet);
  if (!normal) {
    f.degenerate = true;
    return f;
  }
  f.value[static_cast<int>(Field::kTurn)] = normal->z();
  f.value[static_cast<int>(Field::kSlope)] = std::abs(normal->z()) - cos_steep;
  f.value[static_cast<int>(Field::kCurvature)] = ContourCurvature(jet, Forms(jet, *normal));
  return f;
}

}  // namespace patchmill
