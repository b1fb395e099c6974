// The zero curves of a field over a whole surface, as polylines on it. One tracer serves every line that is a
// zero of a function of the jet. line_fields.h lists the fields; a new kind of line is a new ZeroField.
//
//   const ZeroField field = SlopeField(Radians(30));
//   PM_ASSIGN_OR_RETURN(const std::vector<ZeroCurve> curves,
//                       TraceZeroCurves(surface, field, ZeroMeshParams(), 0.01, run));
//
// Where the field has a form (line_forms.h: all usual degrees), all loops and branches inside a piece are
// found by proof, down to ZeroMeshParams::min_cell. Elsewhere those wider than max_cell / 2 are found. Two
// curves nearer to each other than min_cell may be joined the other way round, but they never lie far from
// their true places. Source: [lines, section 4] (certified quadtree, signs decide);
// [references: plantinga2004] for the isotopy argument.
#pragma once

#include <span>
#include <vector>

#include <absl/status/statusor.h>

#include "core/base/run_context.h"
#include "core/lines/zero_mesh.h"
#include "core/surface/surface.h"

namespace patchmill {

struct ZeroCurve {
  std::vector<SurfacePoint> points;  // at least two; seen from S_u x S_v, the field is positive on the left
  bool closed = false;               // the last point joins the first, which is not repeated
};

// Points lie on the zero curve up to rounding (about 1e-13 of a cell). Chords deviate by at most `tolerance`
// (mm, > 0). Curves continue across piece borders if both sides see them. They end at nodes and at the border
// of the surface. A node is a place where more than two branches meet; a loop back to its node has the node
// at both ends and is not closed. Order: by piece of the first point, open curves of a piece first. The
// result is the same for any number of threads. `params.curves_only` is implied. CANCELLED and
// DEADLINE_EXCEEDED from `run`. Cost: some ten microseconds per cell that the curve passes, and the form of
// every piece.
absl::StatusOr<std::vector<ZeroCurve>> TraceZeroCurves(const Surface& surface, const ZeroField& field,
                                                       const ZeroMeshParams& params, double tolerance,
                                                       const RunContext& run);
// The same for many fields (a family of levels) in parallel. [k] holds the curves of fields[k].
absl::StatusOr<std::vector<std::vector<ZeroCurve>>> TraceZeroCurves(const Surface& surface,
                                                                    std::span<const ZeroField> fields,
                                                                    const ZeroMeshParams& params,
                                                                    double tolerance, const RunContext& run);

}  // namespace patchmill
