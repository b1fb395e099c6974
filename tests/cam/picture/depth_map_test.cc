// Hidden lines on shapes for which they are known.
#include "cam/picture/depth_map.h"

#include <cmath>

#include <gtest/gtest.h>

#include "cam/picture/seen_lines.h"
#include "cam/picture/svg_writer.h"
#include "tests/support/shapes.h"
#include "tests/support/surface_of.h"

namespace patchmill {
namespace {

using namespace testing;  // NOLINT: the support folder's

TEST(DepthMap, TheNearHalfOfASphereIsSeen) {
  const Surface surface = SurfaceOf(Sphere(Vec3(3, -2, 1), 10));
  for (const View& raw : {TopView(), IsometricView()}) {
    const View view = FitView(raw, surface.box, {0, 0}, 600, 600);
    const DepthMap depth(surface, view, {{0, 0}, 600, 600, 1.5}, 24);
    for (int i = 0; i < 40; ++i) {
      for (int j = 0; j < 40; ++j) {
        const double h = -0.95 + 1.9 * i / 39, a = 2 * kPi * j / 40, r = std::sqrt(1 - h * h);
        const Vec3 n = r * std::cos(a) * view.right + r * std::sin(a) * view.up + h * view.toward;
        if (std::abs(h) < 0.25) continue;  // along the silhouette dots decide
        EXPECT_EQ(depth.Visible(Vec3(3, -2, 1) + 10 * n, 0.2), h > 0) << h;
      }
    }
  }
}

TEST(DepthMap, NothingIsHiddenByASheetItLiesOn) {
  const Surface surface = SurfaceOf(Saddle(0.02, 0.03, 20));
  const View view = FitView(TopView(), surface.box, {10, 20}, 400, 300);
  const DepthMap depth(surface, view, {{10, 20}, 400, 300, 1.5}, 24);
  for (int i = 0; i <= 50; ++i) {
    for (int j = 0; j <= 50; ++j) {
      const double x = -20 + 0.8 * i, y = -20 + 0.8 * j, z = 0.02 * x * x - 0.03 * y * y;
      EXPECT_TRUE(depth.Visible(Vec3(x, y, z), 0.1)) << x << " " << y;
      if (std::abs(x) < 19 && std::abs(y) < 19) {
        EXPECT_FALSE(depth.Visible(Vec3(x, y, z - 5), 0.1));
      }
    }
  }
}

// A line through a ball comes out in two parts.
TEST(SeenLines, WhatIsInsideIsLeftOut) {
  const Surface surface = SurfaceOf(Sphere(Vec3::Zero(), 10));
  Box3 box = surface.box;
  box.Add(Vec3(-30, 0, 0));
  box.Add(Vec3(30, 0, 0));
  const View view = FitView(TopView(), box, {0, 0}, 600, 600);
  const SeenLines seen(surface, view, {0, 0}, {600, 600}, 24);
  std::vector<Vec3> line;
  for (int i = 0; i <= 600; ++i) line.push_back(Vec3(-30 + 0.1 * i, 0, 0));
  SvgWriter svg(600, 600);
  seen.Draw(line, svg);
  const std::string text = std::move(svg).Finish();
  int parts = 0;
  for (std::size_t at = text.find("<polyline"); at != std::string::npos; at = text.find("<polyline", at + 1))
    ++parts;
  EXPECT_EQ(parts, 2);
}

}  // namespace
}  // namespace patchmill
