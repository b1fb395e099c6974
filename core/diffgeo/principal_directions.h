// The directions of the principal curvatures [shapes, section 9].
#pragma once

#include <optional>

#include "core/diffgeo/forms.h"

namespace patchmill {

// Unit tangents, square to each other; their signs are free.
struct PrincipalDirections {
  Vec3 min = Vec3::Zero(), max = Vec3::Zero();  // of k_min and k_max
};

// `f` is Forms(jet, UnitNormal). Nothing where all directions are principal ones: where the curvatures differ
// by less than 1e-9 of themselves, or bend a step of one parameter by less than 1e-12 rad differently.
std::optional<PrincipalDirections> DirectionsOf(const SurfaceJet& jet, const FundamentalForms& f);

}  // namespace patchmill
