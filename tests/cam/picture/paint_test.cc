// Colours tell steep from gentle and outward from inward.
#include "cam/picture/paint.h"

#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "tests/support/shapes.h"
#include "tests/support/surface_of.h"

namespace patchmill {
namespace {

using namespace testing;  // NOLINT: the support folder's

// 0 red, 1 green, 2 blue.
int Part(const std::string& color, std::size_t k) {
  return std::stoi(color.substr(1 + 2 * k, 2), nullptr, 16);
}

TEST(Paint, ChangesFromGreenToRedAtTheSteepAngle) {
  PaintScales scales;
  for (const double steep : {20.0, 45.0, 70.0}) {
    scales.steep_angle = Radians(steep);
    for (double slope = 1.0; slope < 90.0; slope += 1.0) {
      if (std::abs(slope - steep) < 1e-9) continue;
      const std::string color = SlopeColor(Radians(slope), scales);
      EXPECT_EQ(Part(color, 0) > Part(color, 1), slope > steep) << steep << " " << slope << " " << color;
    }
  }
}

TEST(Paint, IsRedWhereContoursBendOutwardAndBlueInward) {
  PaintScales scales;
  scales.radius = 2.0;
  const std::string out = CurvatureColor(-0.1, scales), in = CurvatureColor(0.1, scales);
  EXPECT_GT(Part(out, 0), Part(out, 2));
  EXPECT_LT(Part(in, 0), Part(in, 2));
  EXPECT_EQ(CurvatureColor(-0.5, scales), CurvatureColor(-7.0, scales));  // full at 1 / radius
  EXPECT_NE(CurvatureColor(-0.5, scales), CurvatureColor(-0.4, scales));
}

TEST(Paint, OfASurfaceFollowsItsJet) {
  const double rho = 12.0;
  const Surface dome = SurfaceOf(Sphere(Vec3::Zero(), rho, Half::kUpper));
  PaintScales scales;
  scales.steep_angle = Radians(40.0);  // no row of points is as steep
  const Piece& piece = dome.pieces[0];
  for (int i = 1; i < 8; ++i) {
    for (int j = 1; j < 8; ++j) {
      const SurfaceJet jet = Evaluate(piece, i / 8.0, j / 8.0);
      const double slope = std::acos(jet.p.z() / rho);
      EXPECT_EQ(PaintedColor(Paint::kSlope, jet, scales), SlopeColor(slope, scales));
      // A contour of a ball bends by 1 / rho in the surface, whatever its height.
      EXPECT_EQ(PaintedColor(Paint::kCurvature, jet, scales), CurvatureColor(-1.0 / rho, scales));
    }
  }
}

}  // namespace
}  // namespace patchmill
