// The zero curves of a field over a whole surface, as polylines on it: the one tracer for every line that is
// a zero of a function of the jet. line_fields.h lists the fields; a new kind of line is a new ZeroField.
//
//   const ZeroField field = SlopeField(Radians(30));
//   PM_ASSIGN_OR_RETURN(const std::vector<ZeroCurve> curves,
//                       TraceZeroCurves(surface, field, ZeroMeshParams(), 0.01, run));
//
// Found are all loops and branches inside a piece down to ZeroMeshParams::min_cell where the field has a form
// (line_forms.h: all usual degrees), by proof; elsewhere those wider than max_cell / 2. Two curves nearer to
// each other than min_cell may come out joined the other way round, never far from where they are. Source:
// [lines, section 4] (certified quadtree, signs decide); [references: plantinga2004] for the isotopy
// argument.
#pragma once

#include <span>
#include <vector>

#include <absl/status/statusor.h>

#include "core/base/run_context.h"
#include "core/lines/zero_mesh.h"
#include "core/surface/surface.h"

namespace patchmill {

struct ZeroCurve {
  std::vector<SurfacePoint> points;  // at least two; the field is positive on the left, seen from S_u x S_v
  bool closed = false;               // the last point joins the first (not repeated)
};

// Points lie on the zero curve to rounding (about 1e-13 of a cell), chords keep to `tolerance` (mm, > 0).
// Curves run on across piece borders where both sides see them, end at nodes (where more than two branches
// meet; a loop back to its node has it at both ends and is not closed) and at the surface's border. Order: by
// piece of the first point, open curves of a piece first. The same for any number of threads.
// `params.curves_only` is implied. CANCELLED, DEADLINE_EXCEEDED from `run`. Cost: some ten microseconds a
// cell the curve passes, and the form of every piece.
absl::StatusOr<std::vector<ZeroCurve>> TraceZeroCurves(const Surface& surface, const ZeroField& field,
                                                       const ZeroMeshParams& params, double tolerance,
                                                       const RunContext& run);
// The same for many fields (a family of levels) in parallel: [k] has the curves of fields[k].
absl::StatusOr<std::vector<std::vector<ZeroCurve>>> TraceZeroCurves(const Surface& surface,
                                                                    std::span<const ZeroField> fields,
                                                                    const ZeroMeshParams& params,
                                                                    double tolerance, const RunContext& run);

}  // namespace patchmill
