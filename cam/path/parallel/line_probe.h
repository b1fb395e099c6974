// Examines a place of a zig-zag line: may the ball be there, and how far away may the next line be?
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
  bool allowed = false;  // h exists, and the edge rule allows the contact (SheetBorder::Allowed)
  // Allowed, the ball touches the surface, the slope is in the window and the contact in the part.
  bool wanted = false;
  bool finishes = false;    // wanted, and the ball touches a face or an open edge, not only a crease
  double need = kInfinity;  // mm in y: largest distance to the next line that keeps the scallop
  double half_step = 0.0;   // mm on the centre surface: half of the centre step across the line
  double lateral = 0.0;     // mm in y: half_step as the distance between lines

  bool exists() const { return half_step > 0.0; }
};

struct LineProbeParams {
  PassParams pass;
  const OperationLimits* part = nullptr;  // only contacts that it wants are wanted; null: all
  const SurfaceMask* where = nullptr;     // and only contacts on it; null: all
};

// Probes places of lines of one frame. Once `run` is cancelled rows end early and are meaningless.
// Thread-safe.
class LineProber {
 public:
  LineProber(const Locator& locator, const SheetBorder& border, const LineFrame& frame,
             const LineProbeParams& params, const RunContext& run);

  // Probes the place (t, y) of a line that has the slope dy/dt = `slope` there. Cost: one exact height and
  // one surface evaluation. `hint` is a contact nearby, which saves time.
  LineProbe Probe(double t, double y, double slope, const SurfacePoint* hint = nullptr) const;
  // Probes count + 1 places of one line, evenly spaced from t0 to t1, both included. Heights are computed in
  // vector lanes.
  std::vector<LineProbe> ProbeRow(double t0, double t1, int count, const LineShape& line) const;

  bool Cancelled() const { return run_.Cancelled(); }
  double radius() const { return locator_.radius(); }
  double flat_step() const { return flat_step_; }
  // mm: no lines lie closer together than this, whatever the scallop needs.
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
