// The control points of any kind of patch as one span.
#pragma once

#include <span>
#include <variant>

#include "core/patch/patch.h"

namespace patchmill {

inline std::span<Vec3> ControlPoints(PatchShape& shape) {
  return std::visit([](auto& s) { return std::span<Vec3>(s.points); }, shape);
}
inline std::span<const Vec3> ControlPoints(const PatchShape& shape) {
  return std::visit([](const auto& s) { return std::span<const Vec3>(s.points); }, shape);
}

// The bulges of a quad; empty for kinds that have none.
inline std::span<Bulge> Bulges(PatchShape& shape) {
  return std::visit(
      [](auto& s) {
        if constexpr (requires { s.bulges; }) {
          return std::span<Bulge>(s.bulges);
        } else {
          return std::span<Bulge>();
        }
      },
      shape);
}
inline std::span<const Bulge> Bulges(const PatchShape& shape) {
  return std::visit(
      [](const auto& s) {
        if constexpr (requires { s.bulges; }) {
          return std::span<const Bulge>(s.bulges);
        } else {
          return std::span<const Bulge>();
        }
      },
      shape);
}

}  // namespace patchmill
