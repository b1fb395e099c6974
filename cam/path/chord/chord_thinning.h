// Reduces dense stations to as few certified vertices as the chord tolerance allows.
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

// Leaves out the points that chords can do without, of the contours and spirals that `which` selects. Chords
// may be as long as the ball's radius, so that closed contours can begin about anywhere. All centres of those
// paths must be proven to CertificateGap(params), as ContourPaths and SpiralPaths make them; points that
// clipping put on chords are not allowed. Chords stay within the same tolerances. On a concave surface
// vertices move sideways into it. Runs in parallel. Errors: CANCELLED and DEADLINE_EXCEEDED.
absl::Status ThinContours(const Locator& locator, const PassParams& params, const ThinWhich& which,
                          const RunContext& run, std::vector<CutterPath>& paths);

}  // namespace patchmill
