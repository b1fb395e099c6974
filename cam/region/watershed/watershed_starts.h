// Finds where the watershed lines from passes begin, and the flows that they follow.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "cam/region/watershed/height_tops.h"
#include "core/base/run_context.h"
#include "core/lines/flow_step.h"

namespace patchmill {

// The line of steepest slope from a place, step by step, computed on demand. It depends on that place alone.
// Keeps references.
class FlowTrack {
 public:
  struct Step {
    FlowPlace place;
    bool at_border = false;
    std::optional<FlowPlace> beyond = {};  // where the flow continues across the border, if it does
  };
  // `length` is that of the first step, mm. The lengths of later steps follow from it.
  FlowTrack(const Surface& surface, const FlowParams& params, double sign, std::optional<FlowPlace> start,
            double length)
      : surface_(&surface), params_(&params), sign_(sign), start_(std::move(start)), length_(length) {}

  const std::optional<FlowPlace>& Start() const { return start_; }
  // Step k, or null if the flow ends before it.
  const Step* At(std::size_t k);
  // Computes as many steps in advance as most lines need.
  void GoAhead(const RunContext& run);

 private:
  void Extend();

  const Surface* surface_;
  const FlowParams* params_;
  double sign_;
  std::optional<FlowPlace> start_;
  double length_;  // mm, of the step to try next
  std::vector<Step> steps_;
  bool ended_ = false;
};

// The start of a line that leaves the vertex `from` into `piece`.
struct WatershedStart {
  MeshVertex from;
  PieceId piece;
  FlowTrack track;
};

// The starts of the lines from a pass between summits (`sign` 1; lines run down) or pits (-1; lines run up).
// Lines leave the saddle of the surface next to the pass, or the pass itself if there is no saddle, to both
// sides. boxes[piece] is the box of the piece's vertices. The tracks keep references to the surface of the
// split and to `flow`.
std::vector<WatershedStart> FindStarts(const SplitSurface& split, const std::vector<Box3>& boxes,
                                       const FlowParams& flow, double sign, const MeshVertex& pass);

}  // namespace patchmill
