#include "cam/path/chord/scan_line.h"

#include "cam/path/chord/chord_thinning.h"
#include "cam/path/chord/segment_trace.h"

namespace patchmill {

std::vector<ScanRun> ScanLine(const Locator& locator, const Vec2& a, const Vec2& b, const PassParams& params,
                              const RunContext* run) {
  const SegmentTraceParams trace{.chord_tolerance = params.chord_tolerance - CertificateGap(params),
                                 .excess_tolerance = ExcessTolerance(params) - CertificateGap(params),
                                 .floor_center = params.floor_z + locator.radius(),
                                 .certificate_gap = CertificateGap(params),
                                 .run = run};
  std::vector<ScanRun> runs;
  for (const auto& stations : TraceSegment(locator, XyLine::Through(a, b), trace)) {
    runs.push_back({ThinStations(locator, stations, params, run)});
  }
  return runs;
}

std::vector<ScanRun> ScanPolyline(const Locator& locator, std::span<const Vec2> corners,
                                  const PassParams& params, const RunContext* run) {
  std::vector<ScanRun> runs;
  for (std::size_t i = 0; i + 1 < corners.size(); ++i) {
    bool joins = !runs.empty();
    for (ScanRun& next : ScanLine(locator, corners[i], corners[i + 1], params, run)) {
      if (next.points.empty()) continue;
      // Both stretches have their own height over the common corner, each certified to its own gap.
      const Vec3 step = joins ? Vec3(next.points.front().center - runs.back().points.back().center) : Vec3();
      if (!joins || step.norm() > 1e-9 + CertificateGap(params)) {
        runs.push_back(std::move(next));
      } else {
        std::vector<CutterPoint>& points = runs.back().points;
        if (step.z() > 0.0) points.back() = next.points.front();
        points.insert(points.end(), next.points.begin() + 1, next.points.end());
      }
      joins = false;
    }
  }
  return runs;
}

}  // namespace patchmill
