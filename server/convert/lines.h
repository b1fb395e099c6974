// v1.LineFamily -> LineFamily with its levels, and curves -> v1.LineSet.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/lines/flow_lines.h"
#include "core/lines/line_family.h"
#include "core/lines/occurring_normals.h"
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
  int count = 12;                  // number of levels to choose when none are given; 0: there are none
  // Highlights and brightnesses: what is not given is chosen from the normals that occur.
  bool from_normals = false;
  bool has_direction = false;  // given
};

// Whether lines of this kind have levels, given or chosen.
bool HasLevels(const LineOrder& order);

LineOrder FromProto(const v1::LineFamily& proto, const std::string& at, FieldErrors& errors);

// Moves places and levels from the program frame to the placed frame: adds program zero.
LineOrder Placed(LineOrder order, const Vec3& zero);

// Chooses direction and levels of an order with `from_normals`, as far as they are not given. Others come
// back as they are.
LineOrder Chosen(LineOrder order, const OccurringNormals& normals);
// Whether one of the orders is chosen from normals.
bool NeedsNormals(const std::vector<LineOrder>& orders);
// Says in `set` which direction was chosen.
void AddChosen(const LineOrder& chosen, v1::LineSet& set);

// The level in the unit of the wire: program frame, degrees.
double WireLevel(const LineOrder& placed, double level, const Vec3& zero);

// Names lines: "contour 12 mm", "slope 30 degrees", ...
std::string Describe(v1::LineKind kind, double wire_level);

v1::SurfaceLine ToProto(const Surface& surface, const ZeroCurve& curve, const Vec3& zero);
double LengthOf(const ZeroCurve& curve);

}  // namespace patchmill
