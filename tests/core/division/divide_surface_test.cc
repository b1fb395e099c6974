// Surfaces divided into networks: bicubics come back to rounding, others within the tolerance; poles, seams,
// creases at knots.
#include "core/division/divide_surface.h"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>
#include <gtest/gtest.h>

#include "core/joining/continuity.h"
#include "core/joining/network_findings.h"
#include "core/math/bernstein.h"
#include "core/network/patch_network.h"
#include "core/patch/outline_surface.h"

namespace patchmill {
namespace {

// A net whose points are no simple function of their place.
BsplinePatch Wavy(int degree, int count, std::vector<double> knots) {
  BsplinePatch patch;
  patch.degree_u = patch.degree_v = degree;
  patch.knots_u = patch.knots_v = std::move(knots);
  for (int i = 0; i < count; ++i) {
    for (int j = 0; j < count; ++j)
      patch.points.emplace_back(10.0 * i + j, 9.0 * j - i, 6 * std::sin(2.0 * i + 3.0 * j * j));
  }
  return patch;
}
DividedSurface Divided(const BsplinePatch& patch, const Division& division) {
  const auto divided = DivideSurface(patch, division, RunContext());
  EXPECT_TRUE(divided.ok()) << divided.status();
  if (!divided.ok()) return {};
  for (const Diagnostic& d : divided->findings) {
    EXPECT_NE(d.severity, Severity::kError) << d.code << " " << d.message;
  }
  return *divided;
}
ContinuityReport Continuity(const PatchModel& model) {
  const auto network = BuildNetwork(model);
  EXPECT_TRUE(network.ok());
  const auto report = MeasureContinuity(*network, 50, RunContext(1));
  EXPECT_TRUE(report.ok());
  return *report;
}

TEST(DivideSurface, ABicubicSplineComesBackToRounding) {
  const BsplinePatch patch = Wavy(3, 7, {0, 0, 0, 0, 1, 2, 4, 5, 5, 5, 5});
  const DividedSurface divided = Divided(patch, {});
  ASSERT_EQ(divided.joined.model.patches.size(), 16u);
  EXPECT_LE(divided.max_distance, 1e-9);
  // The places of equal parameters are the same, too: knots 0 1 2 4 5 of 5.
  const double knots[] = {0, 0.2, 0.4, 0.8, 1};
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) {
      const PatchShape& shape = divided.joined.model.patches[static_cast<std::size_t>(4 * i + j)].shape;
      for (const double a : {0.25, 0.7}) {
        const Vec3 wanted = Position(PatchShape(patch), std::lerp(knots[i], knots[i + 1], a),
                                     std::lerp(knots[j], knots[j + 1], 0.4));
        EXPECT_LE((Position(shape, a, 0.4) - wanted).norm(), 1e-9);
      }
    }
  }
  for (const EdgeContinuity& joint : Continuity(divided.joined.model).edges) {
    EXPECT_LE(joint.max_gap, 1e-10);
    EXPECT_LE(joint.max_angle, 1e-7);
  }
}

TEST(DivideSurface, ASkinThroughSectionsComesBackToRounding) {
  std::vector<Curve> sections;
  for (const double y : {0.0, 30.0, 65.0, 109.0}) {
    sections.push_back(BezierCurve{
        {Vec3(0, y, 0), Vec3(20, y + 3, 12 + 0.1 * y), Vec3(45, y, 20 - 0.1 * y), Vec3(65, y, 2)}});
  }
  const auto skin = SkinSurface(sections);
  ASSERT_TRUE(skin.ok());
  const DividedSurface divided = Divided(*skin, {.parts_u = 3});
  EXPECT_EQ(divided.joined.model.patches.size(), 9u);
  EXPECT_LE(divided.max_distance, 1e-9);
}

// One bicubic on knots of its own: the knots change nothing, and one face is enough.
TEST(DivideSurface, TheFewestFacesOfABicubicWithIdleKnotsAreOne) {
  const auto height = [](double u, double v) { return 3 * u * u * u - 2 * u * v * v + v * v * v - u; };
  // The polar form of a polynomial gives its control points on any knots.
  const std::vector<double> knots = {0, 0, 0, 0, 0.2, 0.5, 0.6, 1, 1, 1, 1};
  BsplinePatch patch;
  patch.degree_u = patch.degree_v = 3;
  patch.knots_u = patch.knots_v = knots;
  const auto polar = [&](int power, std::size_t k) {  // of t^power at knots k+1 .. k+3
    const double a = knots[k + 1], b = knots[k + 2], c = knots[k + 3];
    const double value[4] = {1.0, (a + b + c) / 3, (a * b + b * c + a * c) / 3, a * b * c};
    return value[power];
  };
  for (std::size_t i = 0; i < 7; ++i) {
    for (std::size_t j = 0; j < 7; ++j) {
      const double z = 3 * polar(3, i) - 2 * polar(1, i) * polar(2, j) + polar(3, j) - polar(1, i);
      patch.points.emplace_back(20 * polar(1, i), 30 * polar(1, j), 5 * z);
    }
  }
  ASSERT_NEAR(Position(PatchShape(patch), 0.3, 0.7).z(), 5 * height(0.3, 0.7), 1e-12);
  EXPECT_EQ(Divided(patch, {}).joined.model.patches.size(), 16u);
  const DividedSurface fewest = Divided(patch, {.lines = DivisionLines::kFewest});
  EXPECT_EQ(fewest.joined.model.patches.size(), 1u);
  EXPECT_LE(fewest.max_distance, 1e-9);
}

TEST(DivideSurface, TheFewestFacesKeepTheToleranceAndCreases) {
  const BsplinePatch patch = Wavy(3, 9, {0, 0, 0, 0, 1, 2, 3, 4, 5, 6, 6, 6, 6});
  const std::size_t all = Divided(patch, {}).joined.model.patches.size();
  std::size_t before = 0;
  for (const double tolerance : {4.0, 1e-1, 1e-2}) {
    const DividedSurface divided = Divided(patch, {.tolerance = tolerance, .lines = DivisionLines::kFewest});
    EXPECT_LE(divided.max_distance, tolerance);
    EXPECT_GE(divided.joined.model.patches.size(), before);
    before = divided.joined.model.patches.size();
    if (tolerance > 0.5) {
      EXPECT_LT(before, all);
    }
  }
  // A roof: its ridge is a line of the grid, whatever the tolerance.
  BsplinePatch roof;
  roof.degree_u = roof.degree_v = 1;
  roof.knots_u = {0, 0, 0.3, 0.5, 1, 1}, roof.knots_v = {0, 0, 1, 1};
  for (const double x : {0.0, 6.0, 10.0, 20.0}) {
    for (const double y : {0.0, 10.0}) roof.points.emplace_back(x, y, 5 - std::abs(x - 10) / 2);
  }
  const DividedSurface folded = Divided(roof, {.tolerance = 5.0, .lines = DivisionLines::kFewest});
  EXPECT_EQ(folded.joined.model.patches.size(), 2u);
  EXPECT_LE(folded.max_distance, 1e-9);
}

// One control point of many is out of the plane, and one span bulges between places of equal steps.
TEST(DivideSurface, SeesWhatLiesBetweenFewSamples) {
  std::vector<double> knots = {0, 0, 0};
  for (int k = 0; k <= 32; ++k) knots.push_back(k);
  knots.insert(knots.end(), 3, 32.0);
  BsplinePatch patch;
  patch.degree_u = patch.degree_v = 3;
  patch.knots_u = patch.knots_v = knots;
  for (int i = 0; i < 35; ++i) {
    for (int j = 0; j < 35; ++j) patch.points.emplace_back(3.0 * i, 3.0 * j, i == 13 && j == 21 ? 5.0 : 0.0);
  }
  const DividedSurface bump = Divided(patch, {.tolerance = 0.02, .lines = DivisionLines::kFewest});
  EXPECT_LE(bump.max_distance, 0.02);
  double top = 0.0;
  for (const Patch& p : bump.joined.model.patches) {
    for (int i = 0; i <= 20; ++i) {
      for (int j = 0; j <= 20; ++j) top = std::max(top, Position(p.shape, i / 20.0, j / 20.0).z());
    }
  }
  EXPECT_NEAR(top, 5.0 * 4 / 9, 0.03);  // 2/3 each way
  // Degree 10 with zeros of second order at 0, 1/4, 1/2, 3/4 and 1.
  BsplinePatch wave;
  wave.degree_u = 10, wave.degree_v = 1;
  wave.knots_u.assign(11, 0.0), wave.knots_u.insert(wave.knots_u.end(), 11, 1.0);
  wave.knots_v = {0, 0, 1, 1};
  const auto height = [](double t) {
    return 5e5 * std::pow(t * (1 - t) * (t - 0.25) * (t - 0.5) * (t - 0.75), 2);
  };
  Eigen::Matrix<double, 11, 11> basis;
  Eigen::Matrix<double, 11, 1> values;
  for (int k = 0; k <= 10; ++k) {
    double row[kMaxBasisDegree + 1];
    AllBernstein(10, k / 10.0, row);
    for (int j = 0; j <= 10; ++j) basis(k, j) = row[j];
    values[k] = height(k / 10.0);
  }
  const Eigen::Matrix<double, 11, 1> z = basis.fullPivLu().solve(values);
  for (int i = 0; i <= 10; ++i) {
    for (const double y : {0.0, 20.0}) wave.points.emplace_back(10.0 * i, y, z[i]);
  }
  const DividedSurface divided = Divided(wave, {.tolerance = 1e-2});
  EXPECT_LE(divided.max_distance, 1e-2);
  EXPECT_GT(divided.joined.model.patches.size(), 4u);
}

TEST(DivideSurface, AHigherDegreeIsMetWithinTheTolerance) {
  const BsplinePatch patch = Wavy(4, 5, {0, 0, 0, 0, 0, 1, 1, 1, 1, 1});
  for (const double tolerance : {1e-1, 1e-3}) {
    const DividedSurface divided = Divided(patch, {.tolerance = tolerance});
    EXPECT_LE(divided.max_distance, tolerance);
  }
}

TEST(DivideSurface, ARationalQuarterOfACylinderIsMetWithinTheTolerance) {
  BsplinePatch patch;
  patch.degree_u = 2, patch.degree_v = 1;
  patch.knots_u = {0, 0, 0, 1, 1, 1};
  patch.knots_v = {0, 0, 1, 1};
  for (const Vec2& q : {Vec2(10, 0), Vec2(10, 10), Vec2(0, 10)}) {
    for (const double z : {0.0, 20.0}) patch.points.push_back(Lift(q, z));
  }
  patch.weights = {1, 1, std::sqrt(0.5), std::sqrt(0.5), 1, 1};
  const DividedSurface divided = Divided(patch, {.tolerance = 1e-4});
  EXPECT_LE(divided.max_distance, 1e-4);
  for (const Patch& p : divided.joined.model.patches) {
    EXPECT_NEAR(Xy(Position(p.shape, 0.37, 0.6)).norm(), 10.0, 2e-4);
  }
}

TEST(DivideSurface, ACreaseAtAKnotStaysOne) {
  // Two planes that meet at x = 10: degree 1.
  BsplinePatch patch;
  patch.degree_u = patch.degree_v = 1;
  patch.knots_u = {0, 0, 1, 2, 2};
  patch.knots_v = {0, 0, 1, 1};
  for (const Vec3& p : {Vec3(0, 0, 0), Vec3(10, 0, 5), Vec3(20, 0, 0)}) {
    patch.points.push_back(p), patch.points.push_back(p + Vec3(0, 10, 0));
  }
  const DividedSurface divided = Divided(patch, {});
  EXPECT_LE(divided.max_distance, 1e-12);
  EXPECT_EQ(std::ranges::count_if(divided.network.edges, [](const NetworkEdge& e) { return e.crease; }), 1);
}

TEST(DivideSurface, SectionsThatEndInAPointGiveAPole) {
  std::vector<Curve> sections;
  for (int k = 0; k < 4; ++k) {
    const double w = 10 - 10.0 * k / 3, y = 10.0 * k, z = 10 - 0.1 * k * k;
    sections.push_back(
        BezierCurve{{Vec3(-w, y, z - w), Vec3(-w / 3, y, z), Vec3(w / 3, y, z), Vec3(w, y, z - w)}});
  }
  const auto skin = SkinSurface(sections);
  ASSERT_TRUE(skin.ok());
  const DividedSurface divided = Divided(*skin, {.parts_u = 2, .tolerance = 0.05});
  ASSERT_FALSE(divided.joined.model.patches.empty());
  EXPECT_LE(divided.max_distance, 0.05);
  const auto triangles = std::ranges::count_if(divided.network.faces,
                                               [](const NetworkFace& f) { return f.vertices.size() == 3; });
  EXPECT_GE(triangles, 2);
}

TEST(DivideSurface, AClosedSurfaceHasASeamWithoutBorder) {
  // A tube of four straight walls with rounded corners would do; here a closed cubic ring of 6 points.
  BsplinePatch patch;
  patch.degree_u = 3, patch.degree_v = 1;
  for (int k = 0; k < 13; ++k) patch.knots_u.push_back(k - 3);
  patch.knots_v = {0, 0, 1, 1};
  for (int k = 0; k < 9; ++k) {
    const Vec2 q(10 * std::cos(k * kPi / 3), 8 * std::sin(k * kPi / 3));
    patch.points.push_back(Lift(q, 0)), patch.points.push_back(Lift(q, 15));
  }
  const DividedSurface divided = Divided(patch, {});
  EXPECT_LE(divided.max_distance, 1e-9);
  const auto network = BuildNetwork(divided.joined.model);
  ASSERT_TRUE(network.ok());
  EXPECT_EQ(network->open_edge_count, 12);  // both ends of the tube
  EXPECT_EQ(network->euler_characteristic, 0);
  for (const EdgeContinuity& joint : Continuity(divided.joined.model).edges) EXPECT_LE(joint.max_angle, 1e-7);
}

TEST(DivideSurface, EndsWhenItIsCancelled) {
  RunContext run;
  run.Cancel();
  const auto divided = DivideSurface(Wavy(3, 4, {0, 0, 0, 0, 1, 1, 1, 1}), {}, run);
  EXPECT_EQ(divided.status().code(), absl::StatusCode::kCancelled);
}

}  // namespace
}  // namespace patchmill
