#include "core/patch/patch.h"

#include "core/patch/bulge.h"
#include "core/patch/kinds.h"

namespace patchmill {

SurfaceJet Evaluate(const PatchShape& shape, double u, double v) {
  return std::visit(
      [&](const auto& s) {
        SurfaceJet jet = internal::EvaluateShape(s, u, v);
        if constexpr (requires { s.bulges; }) internal::AddBulges(s.bulges, u, v, jet);
        return jet;
      },
      shape);
}

Vec3 Position(const PatchShape& shape, double u, double v) {
  return std::visit(
      [&](const auto& s) {
        Vec3 p = internal::ShapePosition(s, u, v);
        if constexpr (requires { s.bulges; }) {
          for (const Bulge& b : s.bulges) p += BulgeWeight(b.u, b.v, u, v).f * b.by;
        }
        return p;
      },
      shape);
}

bool IsTriangle(const PatchShape& shape) {
  return std::holds_alternative<BezierTriangle>(shape) || std::holds_alternative<GregoryTriangle>(shape) ||
         std::holds_alternative<LoftTriangle>(shape);
}

}  // namespace patchmill
