// The guide curve of a row of faces: exact for cubics, closed, with given directions.
#include "core/editing/guide_curve.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace patchmill {
namespace {

// Points of one cubic at uneven parameters, with its derivatives: the guide has exactly these derivatives.
TEST(GuideCurve, ACubicIsKept) {
  const auto p = [](double t) { return Vec3(3 * t, t * t - t, 0.5 * t * t * t - t * t); };
  const auto d = [](double t) { return Vec3(3, 2 * t - 1, 1.5 * t * t - 2 * t); };
  const auto dd = [](double t) { return Vec3(0, 2, 3 * t - 2); };
  const std::vector<double> at = {0.0, 0.4, 0.9, 1.2, 2.0};
  std::vector<Vec3> middles;
  std::vector<GuideSpan> faces;
  for (const double t : at) middles.push_back(p(t));
  for (std::size_t k = 0; k + 1 < at.size(); ++k) {
    const double h = at[k + 1] - at[k];
    faces.push_back({h * d(at[k]), -h * d(at[k + 1])});
  }
  const auto guide = GuideThrough(middles, faces, {});
  ASSERT_TRUE(guide.ok()) << guide.status();
  ASSERT_EQ(guide->size(), faces.size());
  for (std::size_t k = 0; k < faces.size(); ++k) {
    const double h = at[k + 1] - at[k];
    EXPECT_LE(((*guide)[k].from.d - h * d(at[k])).norm(), 1e-12) << k;
    EXPECT_LE(((*guide)[k].to.d + h * d(at[k + 1])).norm(), 1e-12) << k;
    EXPECT_LE(((*guide)[k].from.dd - h * h * dd(at[k])).norm(), 1e-12) << k;
    EXPECT_LE(((*guide)[k].to.dd - h * h * dd(at[k + 1])).norm(), 1e-12) << k;
  }
}

// Through a regular polygon, closed: the curvature of all sections is that of the circle, to the fourth
// order.
TEST(GuideCurve, AClosedRowOnACircle) {
  const int n = 16;
  const double step = 2.0 * std::numbers::pi / n;
  std::vector<Vec3> middles;
  std::vector<GuideSpan> faces;
  for (int k = 0; k < n; ++k) {
    const auto tangent = [&](int i) { return Vec3(-std::sin(step * i), std::cos(step * i), 0); };
    middles.push_back(Vec3(std::cos(step * k), std::sin(step * k), 0));
    faces.push_back({step * tangent(k), -step * tangent(k + 1)});
  }
  const auto guide = GuideThrough(middles, faces, {});
  ASSERT_TRUE(guide.ok()) << guide.status();
  for (const GuideSection& s : *guide) {
    EXPECT_NEAR(s.from.d.cross(s.from.dd).norm() / std::pow(s.from.d.norm(), 3), 1.0, std::pow(step, 4));
    EXPECT_NEAR(s.to.d.cross(s.to.dd).norm() / std::pow(s.to.d.norm(), 3), 1.0, std::pow(step, 4));
  }
}

// Ratios far from those of the chords would make the guide wind. Then the chords serve: points in line at
// equal steps have equal derivatives.
TEST(GuideCurve, ChordsReplaceRatiosThatDoNotFit) {
  const std::vector<Vec3> middles = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(2, 0, 0), Vec3(3, 0, 0)};
  const std::vector<GuideSpan> faces = {
      {Vec3(1, 0, 0), Vec3(-30, 0, 0)}, {Vec3(1, 0, 0), Vec3(-1, 0, 0)}, {Vec3(1, 0, 0), Vec3(-1, 0, 0)}};
  const auto guide = GuideThrough(middles, faces, {});
  ASSERT_TRUE(guide.ok()) << guide.status();
  for (const GuideSection& s : *guide) {
    EXPECT_LE((s.from.d - Vec3(1, 0, 0)).norm(), 1e-12);
    EXPECT_LE(s.from.dd.norm(), 1e-12);
  }
}

TEST(GuideCurve, GivenDirectionsAndErrors) {
  const std::vector<Vec3> middles = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(2, 1, 0)};
  const std::vector<GuideSpan> faces = {{Vec3(0.7, 0, 0), Vec3(-1, 0, 0)}, {Vec3(1, 0, 0), Vec3(-1, -1, 0)}};
  const auto guide = GuideThrough(middles, faces, {Vec3(0, 0, 5), {}});
  ASSERT_TRUE(guide.ok()) << guide.status();
  EXPECT_LE((guide->front().from.d - Vec3(0, 0, 0.7)).norm(), 1e-12);  // the length is that of the surface
  EXPECT_LE((guide->back().to.d - Vec3(-1, -1, 0)).norm(), 1e-12);
  EXPECT_FALSE(GuideThrough({middles[0], middles[0], middles[2]}, faces, {}).ok());
}

}  // namespace
}  // namespace patchmill
