// Patches and edges of a joined network -> messages of a preview.
#pragma once

#include "core/joining/join_network.h"
#include "patchmill/v1/preview.pb.h"

namespace patchmill {

// What a preview shows of a patch or an edge.
struct PreviewDetail {
  int cells = 12;
  bool controls = false, combs = false;
};

// Without `middles`.
v1::PreviewPatch ToPreview(const JoinedNetwork& joined, int patch, const PreviewDetail& detail);
v1::PreviewEdge ToPreview(const JoinedNetwork& joined, const JoinedEdge& edge, const PreviewDetail& detail);
// Of a G2-Gregory patch at its side `side`, which is `edge`.
v1::MiddleControl ToMiddle(const PatchShape& quad, int side, const JoinedEdge& edge);

}  // namespace patchmill
