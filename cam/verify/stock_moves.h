// Measures moves against the stock as it lies on the machine.
#pragma once

#include <vector>

#include "cam/limits/stock_depth.h"
#include "cam/limits/stock_solid.h"
#include "cam/toolpath/segment_metric.h"
#include "core/base/run_context.h"

namespace patchmill {

// The feed moves that cut deeper into the stock than they may.
struct DeepCuts {
  double deepest = 0.0;        // mm; 0: none
  double limit = 0.0;          // mm; how deep the cut may be there
  Vec3 center = Vec3::Zero();  // of the ball there
  int move = -1;               // PathSegment::move of the deepest
  double length = 0.0;         // mm of feed that is too deep
};

// The ball cuts as deep as its deepest point lies below the nearest side or the top of the solid. Depths
// are known to the accuracy of the solid, which counts in favour of the move. The limit is that of the side
// which the ball cuts. `feeds` are moves of the centre of a ball with this radius (mm). The result is
// meaningless once `run` is cancelled. Cost: some distances for each move.
DeepCuts FindDeepCuts(const StockSolid& stock, const std::vector<PathSegment>& feeds, double radius,
                      const StockDepth& limit, const RunContext& run);

// The first move of a ball with this radius (mm) that may touch the solid; -1 if none does. With `any_way`
// a control may drive the axes one after the other, so every place over the rectangle between the ends
// counts, at the height of the lower one.
int FirstInStock(const StockSolid& stock, const std::vector<PathSegment>& moves, double radius, bool any_way,
                 const RunContext& run);

// The first move of a shank with this radius (mm) that stands in the solid by more than `limit` (mm); -1 if
// none does. `moves` are those of the middle of the shank's lower end.
int FirstShankInStock(const StockSolid& stock, const std::vector<PathSegment>& moves, double radius,
                      double limit, const RunContext& run);

}  // namespace patchmill
