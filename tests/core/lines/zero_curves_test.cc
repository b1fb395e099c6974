// Zero curves of known shapes: how many, closed or not, and where.
#include "core/lines/zero_curves.h"

#include <cmath>

#include <gtest/gtest.h>

#include "core/lines/line_fields.h"
#include "tests/support/shapes.h"
#include "tests/support/surface_of.h"

namespace patchmill {
namespace {

using namespace testing;  // NOLINT: the support folder's

std::vector<ZeroCurve> Trace(const PatchModel& model, const ZeroField& field, double tolerance = 1e-6) {
  const Surface surface = SurfaceOf(model);
  auto curves = TraceZeroCurves(surface, field, ZeroMeshParams(), tolerance, RunContext());
  EXPECT_TRUE(curves.ok()) << curves.status();
  return *std::move(curves);
}

double Length(const ZeroCurve& curve) {
  double sum = 0.0;
  for (std::size_t i = 0; i + 1 < curve.points.size(); ++i)
    sum += (curve.points[i + 1].p - curve.points[i].p).norm();
  if (curve.closed) sum += (curve.points.front().p - curve.points.back().p).norm();
  return sum;
}

TEST(ZeroCurves, LevelLinesOfASphereAreClosedCircles) {
  for (const double z : {1.0, 6.0, 9.9}) {
    const auto curves = Trace(Sphere(Vec3::Zero(), 10), ContourField(z));
    ASSERT_EQ(curves.size(), 1u) << z;
    EXPECT_TRUE(curves[0].closed);
    const double radius = std::sqrt(100 - z * z);
    for (const SurfacePoint& p : curves[0].points) {
      EXPECT_NEAR(p.p.z(), z, 1e-9);
      EXPECT_NEAR(std::hypot(p.p.x(), p.p.y()), radius, 1e-9);
    }
    EXPECT_NEAR(Length(curves[0]), 2 * kPi * radius, 1e-5 * radius);
  }
  EXPECT_TRUE(Trace(Sphere(Vec3::Zero(), 10), ContourField(10.1)).empty());
}

TEST(ZeroCurves, SlopeLinesOfATorus) {
  // 30 degrees from horizontal: tube angles 60 and 120 above, and the same below: four circles.
  const auto curves = Trace(Torus(Vec3::Zero(), 20, 6), SlopeField(Radians(30)));
  ASSERT_EQ(curves.size(), 4u);
  for (const ZeroCurve& curve : curves) {
    EXPECT_TRUE(curve.closed);
    for (const SurfacePoint& p : curve.points) {
      EXPECT_NEAR(std::abs(p.p.z()), 6 * std::cos(Radians(30)), 1e-8);
      EXPECT_NEAR(std::abs(std::hypot(p.p.x(), p.p.y()) - 20), 3, 1e-8);
    }
  }
}

TEST(ZeroCurves, SilhouetteOfASphereIsItsEquatorHoweverItIsTurned) {
  Eigen::Affine3d motion = Eigen::Affine3d::Identity();
  motion.rotate(Eigen::AngleAxisd(0.4, Vec3::UnitX()));
  const PatchModel model = Transformed(Sphere(Vec3::Zero(), 10), motion);
  const auto curves = Trace(model, SilhouetteField());
  ASSERT_EQ(curves.size(), 1u);
  EXPECT_TRUE(curves[0].closed);
  for (const SurfacePoint& p : curves[0].points) EXPECT_NEAR(p.p.z(), 0.0, 1e-9);
}

TEST(ZeroCurves, SaddleBranchesMeetInTheNode) {
  const double a = 0.05, b = 0.03;
  const auto curves = Trace(Saddle(a, b, 8), ContourCurvatureField());
  EXPECT_EQ(curves.size(), 4u);
  for (const ZeroCurve& curve : curves) {
    EXPECT_FALSE(curve.closed);
    const double from = curve.points.front().p.norm(), to = curve.points.back().p.norm();
    EXPECT_LT(std::min(from, to), 1e-9);
    EXPECT_NEAR(std::abs((from < to ? curve.points.back() : curve.points.front()).p.y()), 8, 1e-9);
    for (const SurfacePoint& p : curve.points)
      EXPECT_NEAR(std::abs(p.p.y()), std::sqrt(a / b) * std::abs(p.p.x()), 1e-7);
  }
}

TEST(ZeroCurves, AreTheSameForAnyNumberOfThreads) {
  const Surface surface = SurfaceOf(RandomBspline(5));
  const auto one = TraceZeroCurves(surface, ContourCurvatureField(), ZeroMeshParams(), 1e-3, RunContext(1));
  const auto two = TraceZeroCurves(surface, ContourCurvatureField(), ZeroMeshParams(), 1e-3, RunContext(2));
  ASSERT_TRUE(one.ok() && two.ok());
  ASSERT_EQ(one->size(), two->size());
  EXPECT_GT(one->size(), 0u);
  for (std::size_t i = 0; i < one->size(); ++i) {
    ASSERT_EQ((*one)[i].points.size(), (*two)[i].points.size());
    for (std::size_t k = 0; k < (*one)[i].points.size(); ++k)
      EXPECT_EQ((*one)[i].points[k].p, (*two)[i].points[k].p);
  }
}

TEST(ZeroCurves, CancelIsObeyed) {
  RunContext run;
  run.Cancel();
  const Surface surface = SurfaceOf(RandomBspline(5));
  EXPECT_EQ(TraceZeroCurves(surface, SilhouetteField(), ZeroMeshParams(), 1e-3, run).status().code(),
            absl::StatusCode::kCancelled);
}

}  // namespace
}  // namespace patchmill
