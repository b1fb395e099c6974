// From dense stations to as few certified vertices as the chord tolerance allows.
#pragma once

#include <vector>

#include "cam/path/line_trace.h"
#include "cam/path/pass_params.h"
#include "cam/toolpath/cutter_path.h"

namespace patchmill {

// The certificate gap in force: params.certificate_gap, but no more than a tenth of the excess tolerance.
double CertificateGap(const PassParams& params);

// Vertices of one run: the first, the last, all `keep` stations, and what else is needed. Chord excess is
// proven by T3 on the stations' supports and points of the surface between their contacts, gouge by the swept
// query (T2 where a chord joins neighbouring stations); heights are certified and raised by their gap.
// Stations' neighbours must be joined by chords within params.chord_tolerance and ExcessTolerance(params),
// each less CertificateGap(params), already. `run` is polled when set: cancelled, the vertices end early.
std::vector<CutterPoint> ThinStations(const Locator& locator, const std::vector<LineStation>& stations,
                                      const PassParams& params, const RunContext* run = nullptr);

}  // namespace patchmill
