// Graphs: values and where they are taken, cuts with shared ends, and turning.
#include "core/trim/grid_graph.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

namespace patchmill {
namespace {

GridGraph Cubic() { return {true, 2.0, 3.0, {4.1, 4.3, 4.6, 4.9}}; }

TEST(GridGraph, ValueAndItsInverse) {
  for (const bool falling : {false, true}) {
    GridGraph graph = Cubic();
    if (falling) std::reverse(graph.c.begin(), graph.c.end());
    for (int k = 0; k <= 20; ++k) {
      const double x = 2.0 + k / 20.0;
      EXPECT_NEAR(WhereValue(graph, ValueAt(graph, x)), x, 1e-14);
    }
  }
}

TEST(GridGraph, CutsShareTheirEndExactly) {
  for (const bool falling : {false, true}) {
    for (const int axis : {0, 1}) {
      GridGraph graph = Cubic();
      if (falling) std::reverse(graph.c.begin(), graph.c.end());
      const double at = axis == 0 ? 2.37 : 4.37;
      const GraphParts parts = CutGraph(graph, axis, at);
      EXPECT_EQ(parts.low.highest(axis), at);
      EXPECT_EQ(parts.high.lowest(axis), at);
      const bool in_order = parts.low.to == parts.high.from;
      EXPECT_EQ(in_order ? parts.low.end() : parts.low.start(),
                in_order ? parts.high.start() : parts.high.end());
      for (const GridGraph& part : {parts.low, parts.high}) {
        for (int k = 0; k <= 10; ++k) {
          const double x = part.from + (part.to - part.from) * k / 10.0;
          EXPECT_NEAR(ValueAt(part, x), ValueAt(graph, x), 1e-14);
        }
      }
    }
  }
}

TEST(GridGraph, PartsOfALevelGraphAreLevel) {
  const double c = 0.99019607843137247;
  GridGraph rest{true, 0.19787936834699157, 3.8946704425796188, {c, c}};
  for (const double line : {1.0, 2.0, 3.0}) {
    const GraphParts parts = CutGraph(rest, 0, line);
    EXPECT_EQ(parts.low.c, (std::vector<double>{c, c}));
    rest = parts.high;
    EXPECT_EQ(rest.c, (std::vector<double>{c, c}));
  }
}

TEST(GridGraph, TurnedHasTheSameEndsAndFollows) {
  const GridGraph graph = Cubic();
  const auto turned = TurnedGraph(graph, 3);
  ASSERT_TRUE(turned);
  EXPECT_FALSE(turned->along_u);
  EXPECT_EQ(turned->start(), graph.start());
  EXPECT_EQ(turned->end(), graph.end());
  for (int k = 0; k <= 10; ++k) {
    const double v = 4.1 + 0.8 * k / 10.0;
    EXPECT_NEAR(ValueAt(*turned, v), WhereValue(graph, v), 0.005);
  }
  EXPECT_FALSE(TurnedGraph({true, 0.0, 1.0, {0.5, 0.5}}, 3));
}

TEST(GridGraph, ThroughValuesIsThePolynomialUnlessItTurns) {
  const auto cubic = [](double s) { return 0.1 + 0.5 * s + 0.3 * s * s + 0.05 * s * s * s; };
  const GridGraph graph{true, 0.0, 1.0, ThroughValues({cubic(0), cubic(1.0 / 3), cubic(2.0 / 3), cubic(1)})};
  for (int k = 0; k <= 10; ++k) EXPECT_NEAR(ValueAt(graph, k / 10.0), cubic(k / 10.0), 1e-15);
  for (const double c : ThroughValues({0.0, 0.9, 0.95, 1.0})) {
    EXPECT_GE(c, 0.0);
    EXPECT_LE(c, 1.0);
  }
}

}  // namespace
}  // namespace patchmill
