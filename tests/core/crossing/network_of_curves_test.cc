// Networks from curves that cross: known surfaces, bad strokes, nets drawn by hand.
#include "core/crossing/network_of_curves.h"

#include <algorithm>
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/joining/network_findings.h"
#include "core/network/patch_network.h"
#include "tests/support/drawn_nets.h"

namespace patchmill {
namespace {

using ::testing::HasSubstr;

// A line of the surface z = x^2 / 40 - y^2 / 60, over a straight segment in plan. It is a parabola.
DrawnCurve SurfaceLine(const Vec2& a, const Vec2& b) {
  const auto z = [](const Vec2& p) { return p.x() * p.x() / 40 - p.y() * p.y() / 60; };
  const Vec2 m = 0.5 * (a + b);
  const double middle = 2 * z(m) - 0.5 * (z(a) + z(b));
  return {"", AsChain(BezierCurve{{Lift(a, z(a)), Lift(m, middle), Lift(b, z(b))}})};
}
// Three lines each way, `beyond` longer than the square of 20 that they divide.
std::vector<DrawnCurve> Grid(double beyond) {
  std::vector<DrawnCurve> curves;
  for (const double c : {-10.0, 0.0, 10.0}) {
    curves.push_back(SurfaceLine({c, -10 - beyond}, {c, 10 + beyond}));
    curves.push_back(SurfaceLine({-10 - beyond, c}, {10 + beyond, c}));
  }
  return curves;
}
NetworkOfCurves Made(const std::vector<DrawnCurve>& curves, CrossingOptions options) {
  const auto made = MakeNetworkOfCurves(curves, options, RunContext());
  EXPECT_TRUE(made.ok()) << made.status();
  return made.ok() ? *made : NetworkOfCurves();
}
int Count(const Diagnostics& findings, std::string_view code) {
  return static_cast<int>(
      std::ranges::count_if(findings, [&](const Diagnostic& d) { return d.code == code; }));
}
std::string MessageOf(const Diagnostics& findings, std::string_view code) {
  const auto found = std::ranges::find_if(findings, [&](const Diagnostic& d) { return d.code == code; });
  return found == findings.end() ? "none" : found->message;
}
int Creases(const CurveNetwork& network) {
  return static_cast<int>(
      std::ranges::count_if(network.edges, [](const NetworkEdge& e) { return e.crease; }));
}

double FarthestFromSaddle(const PatchModel& model) {
  double farthest = 0.0;
  for (const Patch& patch : model.patches) {
    for (int i = 0; i <= 8; ++i) {
      for (int j = 0; j <= 8; ++j) {
        const Vec3 p = Position(patch.shape, i / 8.0, j / 8.0);
        farthest = std::max(farthest, std::abs(p.z() - p.x() * p.x() / 40 + p.y() * p.y() / 60));
      }
    }
  }
  return farthest;
}

TEST(NetworkOfCurves, LinesOfASurfaceGiveTheSurfaceBack) {
  // The surface has no twist and its cross tangents are linear: the joined quads are the surface itself.
  const NetworkOfCurves made = Made(Grid(0), {.tolerance = 1e-3});
  EXPECT_TRUE(made.findings.empty()) << MessageOf(made.findings, made.findings.front().code);
  EXPECT_TRUE(made.joined.findings.empty());
  EXPECT_EQ(made.network.vertices.size(), 9u);
  EXPECT_EQ(made.network.edges.size(), 12u);
  ASSERT_EQ(made.joined.model.patches.size(), 4u);
  EXPECT_EQ(Creases(made.network), 0);
  EXPECT_LE(made.max_moved, 1e-12);
  EXPECT_LE(FarthestFromSaddle(made.joined.model), 1e-9);
  const auto network = BuildNetwork(made.joined.model);
  ASSERT_TRUE(network.ok());
  EXPECT_EQ(network->open_edge_count, 8);
  EXPECT_EQ(network->euler_characteristic, 1);
}

TEST(NetworkOfCurves, TheProjectionAlongAnAxisGivesTheSameFaces) {
  const NetworkOfCurves made = Made(Grid(0), {.tolerance = 1e-3, .direction = Vec3(0, 0, 2)});
  ASSERT_EQ(made.joined.model.patches.size(), 4u);
  EXPECT_LE(FarthestFromSaddle(made.joined.model), 1e-9);
}

TEST(NetworkOfCurves, EndsBeyondAreCutOffOrRefused) {
  const NetworkOfCurves made = Made(Grid(3), {.tolerance = 1e-3});
  EXPECT_EQ(Count(made.findings, "CURVE_END_TRIMMED"), 12);
  ASSERT_EQ(made.joined.model.patches.size(), 4u);
  EXPECT_LE(FarthestFromSaddle(made.joined.model), 1e-9);
  const NetworkOfCurves refused = Made(Grid(3), {.tolerance = 1e-3, .free_ends = FreeEnds::kRefuse});
  EXPECT_EQ(Count(refused.findings, "CURVE_END_FREE"), 12);
  EXPECT_TRUE(HasError(refused.findings));
}

TEST(NetworkOfCurves, AStrokeDrawnTwiceIsNamedOnceAndLeftOut) {
  std::vector<DrawnCurve> curves = Grid(0);
  curves.push_back(curves[2]);
  curves.back().id = "again";
  const NetworkOfCurves made = Made(curves, {.tolerance = 1e-3});
  ASSERT_EQ(made.findings.size(), 1u);
  EXPECT_EQ(made.findings[0].code, "DOUBLED_CURVE");
  EXPECT_THAT(made.findings[0].message, HasSubstr("curves[6] (again) is drawn along curves[2]"));
  EXPECT_EQ(made.joined.model.patches.size(), 4u);
}

TEST(NetworkOfCurves, AStrokeThatEndsBetweenTwoOthersCutsTheFaceBesideIt) {
  // From the middle of a side of the square to the line y = 0: the face above has five corners, one of 180
  // degrees, and is cut there.
  std::vector<DrawnCurve> curves = Grid(0);
  curves.push_back(SurfaceLine({5, -10}, {5, 0}));
  const NetworkOfCurves made = Made(curves, {.tolerance = 1e-3});
  EXPECT_TRUE(made.findings.empty());
  EXPECT_EQ(made.joined.model.patches.size(), 6u);  // 5 faces, one of them in two pieces
  EXPECT_FALSE(HasError(made.joined.findings));
  const auto network = BuildNetwork(made.joined.model);
  ASSERT_TRUE(network.ok());
  EXPECT_EQ(network->euler_characteristic, 1);
}

TEST(NetworkOfCurves, AnEndThatMissesIsToldByHowMuch) {
  std::vector<DrawnCurve> curves = Grid(0);
  curves.push_back(SurfaceLine({5, -10}, {5, -0.004}));
  const NetworkOfCurves made = Made(curves, {.tolerance = 1e-3});
  EXPECT_EQ(made.joined.model.patches.size(), 4u);
  ASSERT_EQ(Count(made.findings, "CURVE_UNUSED"), 1);
  EXPECT_THAT(MessageOf(made.findings, "CURVE_UNUSED"), HasSubstr("its end misses curves[3] by 0.004 mm"));
  EXPECT_EQ(Made(curves, {.tolerance = 5e-3}).joined.model.patches.size(), 6u);
}

TEST(NetworkOfCurves, CurvesThatTouchAreNamed) {
  std::vector<DrawnCurve> curves = Grid(0);
  // In plan y = x^2 / 20 + 1e-4 over the line y = 0, 1e-4 above it; it ends on the two outer lines.
  DrawnCurve touching{"arc", AsChain(BezierCurve{{Vec3(-10, 5, 0), Vec3(0, -5, 0), Vec3(10, 5, 0)}})};
  curves = {SurfaceLine({-10, 0}, {10, 0})};
  for (Vec3& p : curves[0].chain.points) p.z() = 0.0;
  curves.push_back(touching);
  const NetworkOfCurves made = Made(curves, {.tolerance = 1e-3});
  EXPECT_EQ(Count(made.findings, "CURVES_TOUCH"), 1);
  EXPECT_EQ(Count(made.findings, "NO_FACE"), 1);
}

TEST(NetworkOfCurves, TheEdgesOfACubeGiveSixFacesWithCreases) {
  std::vector<DrawnCurve> curves;
  for (int axis = 0; axis < 3; ++axis) {
    for (int k = 0; k < 4; ++k) {
      Vec3 a = Vec3::Zero(), b = Vec3::Zero();
      a[(axis + 1) % 3] = b[(axis + 1) % 3] = 10.0 * (k % 2);
      a[(axis + 2) % 3] = b[(axis + 2) % 3] = 10.0 * (k / 2);
      b[axis] = 10.0;
      curves.push_back({"", AsChain(BezierCurve{{a, b}})});
    }
  }
  const NetworkOfCurves made = Made(curves, {.tolerance = 1e-3});
  EXPECT_TRUE(made.findings.empty());
  ASSERT_EQ(made.joined.model.patches.size(), 6u);
  EXPECT_EQ(Creases(made.network), 12);
  const auto network = BuildNetwork(made.joined.model);
  ASSERT_TRUE(network.ok());
  EXPECT_EQ(network->open_edge_count, 0);
  EXPECT_EQ(network->euler_characteristic, 2);
  for (const Patch& patch : made.joined.model.patches) {
    const Vec3 p = Position(patch.shape, 0.3, 0.6);  // on one of the six planes
    double off = kInfinity;
    for (const double x : p) off = std::min({off, std::abs(x), std::abs(x - 10)});
    EXPECT_LE(off, 1e-12);
  }
}

TEST(NetworkOfCurves, OrderAndDirectionOfCurvesDoNotMatter) {
  std::vector<DrawnCurve> curves = Grid(2);
  const NetworkOfCurves first = Made(curves, {.tolerance = 1e-3});
  std::ranges::reverse(curves);
  for (DrawnCurve& curve : curves) curve.chain = Reversed(curve.chain);
  const NetworkOfCurves second = Made(curves, {.tolerance = 1e-3});
  EXPECT_EQ(first.joined.model.patches.size(), second.joined.model.patches.size());
  EXPECT_LE(FarthestFromSaddle(second.joined.model), 1e-9);
}

const char* const kNets = PATCHMILL_SOURCE_DIR "/tests/models/networks";

TEST(NetworkOfCurves, TheWedgeDrawnByHandCloses) {
  const NetworkOfCurves made =
      Made(testing::DrawnStrokes(std::string(kNets) + "/11-2-2.graph.json", 100), {.tolerance = 0.1});
  EXPECT_EQ(Count(made.findings, "FACE_LEFT_OUT"), 0);
  EXPECT_FALSE(HasError(made.findings));
  EXPECT_FALSE(HasError(made.joined.findings));
  const auto network = BuildNetwork(made.joined.model);
  ASSERT_TRUE(network.ok());
  EXPECT_EQ(network->open_edge_count, 0);
  EXPECT_EQ(network->euler_characteristic, 2);
}

TEST(NetworkOfCurves, TheMouseDrawnByHandIsOneSheet) {
  const NetworkOfCurves made =
      Made(testing::DrawnStrokes(std::string(kNets) + "/computer-mouse.graph.json", 75), {.tolerance = 0.1});
  EXPECT_FALSE(HasError(made.findings));
  EXPECT_FALSE(HasError(made.joined.findings));
  // 17 quads and 4 triangles were written by hand for the same strokes (DrawnMouse); cuts add to them.
  EXPECT_GE(made.joined.model.patches.size(), 21u);
  // The wheel is drawn as a tangle: its face is named.
  EXPECT_EQ(Count(made.findings, "FACE_LEFT_OUT"), 1);
  const auto network = BuildNetwork(made.joined.model);
  ASSERT_TRUE(network.ok());
}

TEST(NetworkOfCurves, WhatDoesNotCloseOfTheShieldIsNamed) {
  const NetworkOfCurves made =
      Made(testing::DrawnStrokes(std::string(kNets) + "/shield.graph.json", 100), {.tolerance = 0.1});
  EXPECT_FALSE(HasError(made.findings));
  EXPECT_FALSE(HasError(made.joined.findings));
  EXPECT_GE(made.joined.model.patches.size(), 40u);
  EXPECT_EQ(Count(made.findings, "CURVES_APART"), 1);
  for (const Diagnostic& d : made.findings) {
    if (d.code != "FACE_LEFT_OUT") continue;
    EXPECT_THAT(d.message, HasSubstr("between curves["));
  }
}

}  // namespace
}  // namespace patchmill
