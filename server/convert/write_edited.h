// An edited network back into its message.
#pragma once

#include <vector>

#include "core/joining/curve_network.h"
#include "patchmill/v1/network.pb.h"

namespace patchmill {

struct EditedFrom {
  double unit = 1.0;  // the length unit in mm
  // Of each edge after the edits its place before them, -1 for a new one. Empty: none was removed.
  std::vector<int> edges = {};
};

// `proto` is the message of `before`. Writes into it everything that differs in `after`. The rest stays as
// it is, to the bit.
void WriteEdited(const CurveNetwork& before, const CurveNetwork& after, const EditedFrom& origins,
                 v1::CurveNetwork* proto);

}  // namespace patchmill
