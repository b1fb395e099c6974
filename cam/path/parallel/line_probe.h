// What a zig-zag line needs to know about one place: may the ball be there, and how far may the next line be?
#pragma once

#include <optional>
#include <vector>

#include "cam/limits/surface_mask.h"
#include "cam/location/limits/operation_limits.h"
#include "cam/location/locator.h"
#include "cam/path/edge/sheet_border.h"
#include "cam/path/parallel/line_frame.h"
#include "cam/path/parallel/line_shape.h"
#include "cam/path/stepover/pass_params.h"
#include "core/base/run_context.h"

namespace patchmill {

struct LineProbe {
  double t = 0.0;
  Vec3 center = Vec3::Zero();
  std::optional<SurfacePoint> contact;  // absent: h does not exist here, or the floor carries the ball
  bool allowed = false;                 // h exists, and the ball does not roll off an open edge
  bool wanted = false;                  // allowed and touching, with the slope in the window and the contact
                                        // in the part
  bool finishes = false;                // wanted, and the ball does more than roll over an edge
  double need = kInfinity;              // mm: largest distance in y to the next line that keeps the scallop
  double half_step = 0.0;               // mm on the centre surface, half the step across the line
  double lateral = 0.0;                 // mm, the same in y

  bool exists() const { return half_step > 0.0; }
};

struct LineProbeParams {
  PassParams pass;
  const OperationLimits* part = nullptr;  // a contact is wanted only where it wants it; null: everywhere
  const SurfaceMask* where = nullptr;     // and only where it holds it; null: everywhere
};

// Probes places along and beside lines of one frame. Once `run` is cancelled rows end early and are
// meaningless. Thread-safe.
class LineProber {
 public:
  LineProber(const Locator& locator, const SheetBorder& border, const LineFrame& frame,
             const LineProbeParams& params, const RunContext& run);

  // Probes a line that runs at `slope` (dy/dt) through the place. Cost: one exact height and one surface
  // evaluation. `hint` is a contact nearby.
  LineProbe Probe(double t, double y, double slope, const SurfacePoint* hint = nullptr) const;
  // Probes count + 1 places of one line, evenly spaced from t0 to t1, both included. Heights are computed in
  // vector lanes.
  std::vector<LineProbe> ProbeRow(double t0, double t1, int count, const LineShape& line) const;

  bool Cancelled() const { return run_.Cancelled(); }
  double radius() const { return locator_.radius(); }
  double flat_step() const { return flat_step_; }
  // mm: lines come no nearer to each other, whatever the scallop needs.
  double min_step() const { return params_.min_step_fraction * flat_step_; }
  const LineFrame& frame() const { return frame_; }

 private:
  LineProbe Judge(double t, double y, double slope, const std::optional<CenterPoint>& h) const;

  const Locator& locator_;
  const SheetBorder& border_;
  const LineFrame frame_;
  const PassParams params_;
  const OperationLimits* const part_;
  const SurfaceMask* const where_;
  const RunContext& run_;
  const double flat_step_;
};

}  // namespace patchmill
