// Where the lines from passes begin, and the flows that they follow.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "cam/region/watershed/height_tops.h"
#include "core/base/run_context.h"
#include "core/lines/flow_step.h"

namespace patchmill {

// The flow from a place on, step by step: a function of that place alone. Keeps references.
class FlowTrack {
 public:
  struct Step {
    FlowPlace place;
    bool at_border = false;
    std::optional<FlowPlace> beyond = {};  // the border: where the flow goes on, if it does
  };
  // `length`: of the first step, mm; later ones follow from it.
  FlowTrack(const Surface& surface, const FlowParams& params, double sign, std::optional<FlowPlace> start,
            double length)
      : surface_(&surface), params_(&params), sign_(sign), start_(std::move(start)), length_(length) {}

  const std::optional<FlowPlace>& Start() const { return start_; }
  // null from where the flow ends.
  const Step* At(std::size_t k);
  // Finds steps before they are asked for, as many as most lines have.
  void GoAhead(const RunContext& run);

 private:
  void Extend();

  const Surface* surface_;
  const FlowParams* params_;
  double sign_;
  std::optional<FlowPlace> start_;
  double length_;  // what to try next
  std::vector<Step> steps_;
  bool ended_ = false;
};

// A line leaves the vertex `from` into `piece`.
struct WatershedStart {
  MeshVertex from;
  PieceId piece;
  FlowTrack track;
};

// Of the lines from a pass between summits (`sign` 1; they run down) or pits (-1; up): from the saddle of the
// surface next to it, else from the pass itself, to both sides. boxes: of the pieces' vertices.
std::vector<WatershedStart> FindStarts(const Surface& surface, const FlowParams& flow, double sign,
                                       const std::vector<SplitMesh>& meshes, const std::vector<Box3>& boxes,
                                       const MeshVertex& pass);

}  // namespace patchmill
