// From dense stations to as few certified vertices as the chord tolerance allows.
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

// Vertices of one run: the first, the last, all `keep` stations, and what else is needed (fewest_chords.h).
// Heights are certified and raised by their gap; on hollow ground vertices are below them where chords may
// take more than they may leave. Stations' neighbours must be joined by chords within params.chord_tolerance
// and ExcessTolerance(params), each less CertificateGap(params), already. `run` is polled when set:
// cancelled, the vertices end early.
std::vector<CutterPoint> ThinStations(const Locator& locator, const std::vector<TraceStation>& stations,
                                      const PassParams& params, const RunContext* run = nullptr);

using ThinWhich = std::function<bool(const CutterPath&)>;

// Leaves out the points that chords can do without, of contours and spirals that `which` names; chords may be
// as long as the ball's radius, so that closed contours can be begun about anywhere. All centres of those
// must be proven to CertificateGap(params), as ContourPaths and SpiralPaths make them: no points that
// clipping put on chords. Chords stay within the same tolerances. Vertices go sideways into hollow ground. In
// parallel. CANCELLED and DEADLINE_EXCEEDED.
absl::Status ThinContours(const Locator& locator, const PassParams& params, const ThinWhich& which,
                          const RunContext& run, std::vector<CutterPath>& paths);

}  // namespace patchmill
