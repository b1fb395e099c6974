#include "core/patch/patch.h"

#include "core/patch/kinds.h"

namespace patchmill {

SurfaceJet Evaluate(const PatchShape& shape, double u, double v) {
  return std::visit([&](const auto& s) { return internal::EvaluateShape(s, u, v); }, shape);
}

Vec3 Position(const PatchShape& shape, double u, double v) {
  return std::visit([&](const auto& s) { return internal::ShapePosition(s, u, v); }, shape);
}

bool IsTriangle(const PatchShape& shape) {
  return std::holds_alternative<BezierTriangle>(shape) || std::holds_alternative<GregoryTriangle>(shape) ||
         std::holds_alternative<LoftTriangle>(shape);
}

}  // namespace patchmill
