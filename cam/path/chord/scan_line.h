// One certified scan line: the centres at the centre height h(q) [location (1)] over the places q of a
// straight segment in plan, as a polyline of certified chords [location, section 11].
#pragma once

#include <span>
#include <vector>

#include "cam/location/locator.h"
#include "cam/path/stepover/pass_params.h"
#include "cam/toolpath/cutter_path.h"
#include "core/base/run_context.h"

namespace patchmill {

// A stretch of a scan line without a gap. There is a gap where h does not exist: no surface lies within R of
// the place in plan. A vertical drop is two points over the same place.
struct ScanRun {
  std::vector<CutterPoint> points;  // from a to b
};

// Returns runs of certified chords. Gouge <= chord_tolerance ([location T2]); excess normal to the path <=
// ExcessTolerance(params) ([location T3]). Contact switches that a chord may not pass over are solved to 1e-9
// mm and kept as vertices with both contacts. Drops at vertical walls and open edges are placed to 1e-7 mm.
// Flat runs are merged by swept-ball queries. Heights are h (or the floor, whichever is higher), certified
// and raised by their gap. `run` is polled when set; a cancelled line is cut short and must not be used.
std::vector<ScanRun> ScanLine(const Locator& locator, const Vec2& a, const Vec2& b, const PassParams& params,
                              const RunContext* run = nullptr);

// The same over a line with corners (two or more), each of them a vertex. Runs continue over corners.
std::vector<ScanRun> ScanPolyline(const Locator& locator, std::span<const Vec2> corners,
                                  const PassParams& params, const RunContext* run = nullptr);

}  // namespace patchmill
