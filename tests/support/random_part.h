// Random parts of every kind of patch, awkward ones among them.
#pragma once

#include "tests/support/random.h"
#include "tests/support/shapes.h"

namespace patchmill::testing {

struct RandomPart {
  PatchModel model;
  double radius = 1.0;  // mm, of a ball that suits its size
};

// Now and then two of them at once, the same one twice, a sliver, or one turned on its side; from microns to
// a hundred metres.
RandomPart DrawPart(Random& random);

}  // namespace patchmill::testing
