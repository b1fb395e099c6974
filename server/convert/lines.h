// v1.LineFamily -> LineFamily with its levels, and curves -> v1.LineSet.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/lines/flow_lines.h"
#include "core/lines/line_family.h"
#include "core/lines/zero_curves.h"
#include "patchmill/v1/lines.pb.h"
#include "server/errors.h"

namespace patchmill {

struct LineOrder {
  v1::LineKind kind = v1::LINE_KIND_UNSPECIFIED;
  LineFamily family;               // places in the program frame; not used for a flow
  std::optional<FlowParams> flow;  // a spacing of 0 is still to be chosen
  bool crossings = false;          // of patches; neither family nor flow is used
  std::vector<double> levels;      // as given; program frame, rad
  int count = 12;                  // number of levels to choose when none are given
};

// Whether lines of this kind have levels, given or chosen.
bool HasLevels(const LineOrder& order);

LineOrder FromProto(const v1::LineFamily& proto, const std::string& at, FieldErrors& errors);

// Moves places and levels from the program frame to the placed frame: adds program zero.
LineOrder Placed(LineOrder order, const Vec3& zero);

// The level in the unit of the wire: program frame, degrees.
double WireLevel(const LineOrder& placed, double level, const Vec3& zero);

// Names lines: "contour 12 mm", "slope 30 degrees", ...
std::string Describe(v1::LineKind kind, double wire_level);

v1::SurfaceLine ToProto(const Surface& surface, const ZeroCurve& curve, const Vec3& zero);
double LengthOf(const ZeroCurve& curve);

}  // namespace patchmill
