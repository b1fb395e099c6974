// One certified scan line of h ([location, section 11]): the gouge-free curve of centres above a straight
// segment in plan.
#pragma once

#include <span>
#include <vector>

#include "cam/location/locator.h"
#include "cam/path/stepover/pass_params.h"
#include "cam/toolpath/cutter_path.h"
#include "core/base/run_context.h"

namespace patchmill {

// A maximal run without a gap (where h does not exist the line breaks). Vertical drops are two points over
// one xy.
struct ScanRun {
  std::vector<CutterPoint> points;  // from a to b
};

// Certified chords: gouge <= chord_tolerance ([location T2]), excess normal to the path <= chord_tolerance
// ([location T3]); contact switches that a chord may not pass over solved to 1e-9 mm and kept as vertices
// with both contacts; drops at vertical walls and open borders placed to 1e-7 mm; flat runs merged by
// swept-ball queries. Heights are h (or the floor, whichever is higher), certified and raised by their gap.
// `run` is polled when set: a cancelled line is cut short, and of no use.
std::vector<ScanRun> ScanLine(const Locator& locator, const Vec2& a, const Vec2& b, const PassParams& params,
                              const RunContext* run = nullptr);

// The same over a line with corners (two or more), each of them a vertex; runs go on over corners.
std::vector<ScanRun> ScanPolyline(const Locator& locator, std::span<const Vec2> corners,
                                  const PassParams& params, const RunContext* run = nullptr);

}  // namespace patchmill
