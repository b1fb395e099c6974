// Surfaces for the tests of core/surface: one of every kind of patch, degenerate ones included.
#pragma once

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "core/surface/surface.h"
#include "tests/support/shapes.h"

namespace patchmill::testing {

inline Surface MakeSurface(PatchModel model, double leaf_thickness = 0.02, int threads = 2) {
  PatchNetwork network;
  network.model = std::move(model);
  auto surface = BuildSurface(std::move(network), {.leaf_thickness = leaf_thickness}, RunContext(threads));
  EXPECT_TRUE(surface.ok()) << surface.status();
  return *std::move(surface);
}

struct NamedModel {
  std::string name;
  PatchModel model;
};
inline void PrintTo(const NamedModel& m, std::ostream* out) { *out << m.name; }

inline std::vector<NamedModel> EveryKindOfPatch() {
  using Blend = GregoryPatch::Blend;
  // Two collapsed edges: a leaf of a flower.
  BezierPatch lens{3, 3, {}, {}};
  // All points on a line, and all in one point: no area at all.
  BezierPatch line{2, 2, {}, {}}, point{1, 1, {}, {}};
  for (int i = 0; i <= 3; ++i) {
    for (int j = 0; j <= 3; ++j) {
      const double width = i == 0 || i == 3 ? 0.0 : 3.0;
      lens.points.emplace_back(4.0 * i, width * (j - 1.5), i == 1 ? 2.0 : 0.0);
    }
  }
  for (int i = 0; i <= 2; ++i) {
    for (int j = 0; j <= 2; ++j) line.points.push_back(Vec3(1, 2, 3) * (i + 0.5 * j));
  }
  point.points.assign(4, Vec3(1, 2, 3));
  // A flat ring sector of 180 degrees: thickness zero, yet nothing like its box.
  const double w = std::sqrt(0.5);
  BezierPatch ring{
      2, 1, {{10, 0, 0}, {8, 0, 0}, {10, 10, 0}, {8, 8, 0}, {0, 10, 0}, {0, 8, 0}}, {1, 1, w, w, 1, 1}};
  // Pieces of the patches before each other patch: several, one, one, one.
  PatchModel mixed = RandomBspline(13, {.spans = 3});
  for (const PatchModel& more : {Single(RandomTriangle(14, 3, false)), Single(RandomBezier(15, 3, 2, false)),
                                 RandomBspline(16, {.spans = 1}), Single(RandomBezier(17, 2, 3, true))}) {
    mixed.patches.push_back(more.patches[0]);
  }
  return {
      {"Mixed", mixed},
      {"Bicubic", Single(RandomBezier(1, 3, 3, false))},
      {"RationalBicubic", Single(RandomBezier(2, 3, 3, true))},
      {"Degree15", Single(RandomBezier(3, 15, 15, false))},
      {"Degree1By7Rational", Single(RandomBezier(4, 1, 7, true))},
      {"Bspline", RandomBspline(5)},
      {"OneSpanNurbs", RandomBspline(12, {.spans = 1, .rational = true})},
      {"FoldedNurbs", RandomBspline(6, {.spans = 4, .folds = true, .rational = true})},
      {"UnevenKnotsWithCrease", Single(RandomKnots(11, 3, 2, true))},
      {"GregoryCorner", Single(RandomGregory(7, Blend::kCorner))},
      {"GregoryEdge", Single(RandomGregory(8, Blend::kEdge))},
      {"Triangle", Single(RandomTriangle(9, 4, false))},
      {"RationalTriangle", Single(RandomTriangle(10, 3, true))},
      {"Sphere", Sphere(Vec3(1, 2, 3), 7.0)},
      {"Torus", Torus(Vec3::Zero(), 10.0, 3.0)},
      {"Block", Block(5.0, 4.0, 12.0)},
      {"Lens", Single(lens)},
      {"Line", Single(line)},
      {"Point", Single(point)},
      {"FlatRing", Single(ring)},
  };
}

}  // namespace patchmill::testing
