#include "cam/path/scan_line.h"

#include "cam/path/chord_thinning.h"
#include "cam/path/line_trace.h"

namespace patchmill {

std::vector<ScanRun> ScanLine(const Locator& locator, const Vec2& a, const Vec2& b, const PassParams& params,
                              const RunContext* run) {
  const LineTraceParams trace{.chord_tolerance = params.chord_tolerance - CertificateGap(params),
                              .floor_center = params.floor_z + locator.radius(),
                              .certificate_gap = CertificateGap(params),
                              .run = run};
  std::vector<ScanRun> runs;
  for (const auto& stations : TraceLine(locator, PlanLine::Through(a, b), trace)) {
    runs.push_back({ThinStations(locator, stations, params, run)});
  }
  return runs;
}

}  // namespace patchmill
