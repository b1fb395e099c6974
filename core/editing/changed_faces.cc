#include "core/editing/changed_faces.h"

#include <algorithm>
#include <set>

#include "core/network/control_points.h"

namespace patchmill {
namespace {

bool SamePatch(const PatchShape& a, const PatchShape& b) {
  return std::ranges::equal(ControlPoints(a), ControlPoints(b)) && std::ranges::equal(Bulges(a), Bulges(b));
}

}  // namespace

std::vector<int> ChangedFaces(const JoinedNetwork& before, const JoinedNetwork& after) {
  std::set<int> changed;
  for (std::size_t f = 0; f < after.model.patches.size(); ++f) {
    const bool known = f < before.model.patches.size() && before.face_of[f] == after.face_of[f];
    if (known && SamePatch(before.model.patches[f].shape, after.model.patches[f].shape)) continue;
    changed.insert(after.face_of[f]);
  }
  return {changed.begin(), changed.end()};
}

}  // namespace patchmill
