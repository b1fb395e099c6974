// Where a patch is defined.
#pragma once

#include "core/patch/patch.h"

namespace patchmill {

// [low, high] in both native parameters; of a triangle only low <= (s, t), s + t <= 1.
struct ParameterDomain {
  Vec2 low = Vec2::Zero(), high = Vec2::Ones();
  bool triangle = false;
};

// `shape` is sound (ValidateModel).
ParameterDomain DomainOf(const PatchShape& shape);

bool Contains(const ParameterDomain& domain, const Vec2& uv);

}  // namespace patchmill
