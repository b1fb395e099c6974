// Patches by what a person calls them.
//
//   #12              the thirteenth patch of the model
//   lid              the patch with this id
//   f12, face:f12    the face with this id. A patch with the same id goes first
//   f12+             the face, and all faces that smooth edges lead to from it
//   name=TEXT        faces with this name; body=TEXT, layer=TEXT likewise
//   color=#rrggbb    faces of this colour
//   kind=cylinder    faces on this kind of surface: plane, cylinder, cone, sphere, torus, spline
//   radius<=3        faces with at most this radius, mm of the placed model; radius>=3 likewise
//
// Conditions on faces may be joined by "&": all of them must hold, "kind=cylinder&radius<=3". Several names
// select what any of them selects.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <absl/status/statusor.h>

#include "core/base/run_context.h"
#include "core/network/patch_network.h"

namespace patchmill {

// One flag for each patch of the network's model; empty when `names` is. INVALID_ARGUMENT for a name that
// cannot be read, or that nothing in the model has; it names `field` (a path of the request) and its index.
// Else the errors of `run`. Cost: names times faces.
absl::StatusOr<std::vector<bool>> SelectPatches(const PatchNetwork& network,
                                                const std::vector<std::string>& names, std::string_view field,
                                                const RunContext& run);

}  // namespace patchmill
