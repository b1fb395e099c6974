// Reduces the dense stations of a trace to the few certified vertices that the chord tolerance needs.
#pragma once

#include <functional>
#include <vector>

#include <absl/status/status.h>

#include "cam/path/chord/segment_trace.h"
#include "cam/path/stepover/pass_params.h"
#include "cam/toolpath/cutter_path.h"

namespace patchmill {

// The certificate gap in force: params.certificate_gap, but no more than a tenth of the excess tolerance.
double CertificateGap(const PassParams& params);

// Returns the vertices of one run: the first station, the last, all `keep` stations, and what else is needed
// (fewest_chords.h). Heights are certified and raised by their gap. On a concave surface vertices lie below
// these heights if chords may gouge more than they may leave. Precondition: chords between neighbouring
// stations are within params.chord_tolerance and ExcessTolerance(params), each less CertificateGap(params).
// `run` is polled when set; once it is cancelled the vertices end early.
std::vector<CutterPoint> ThinStations(const Locator& locator, const std::vector<TraceStation>& stations,
                                      const PassParams& params, const RunContext* run = nullptr);

using ThinWhich = std::function<bool(const CutterPath&)>;

// Removes vertices from the contours and spirals in `paths` that `which` selects, as long as the chords stay
// within the tolerances of `params`. No chord becomes longer than the ball's radius, so that closed contours
// can later begin nearly anywhere. Every centre of a selected path must be proven free to
// CertificateGap(params), as ContourPaths and SpiralPaths return them. So ClipToLimits must not have cut the
// path before: it puts points on chords. On a concave surface vertices move sideways into the surface
// (fewest_chords.h). Runs in parallel. Errors: CANCELLED and DEADLINE_EXCEEDED from `run`.
absl::Status ThinContours(const Locator& locator, const PassParams& params, const ThinWhich& which,
                          const RunContext& run, std::vector<CutterPath>& paths);

}  // namespace patchmill
