// Lines with given ends: the half torus from three sections, and what is refused.
#include <cmath>
#include <numbers>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "core/base/index.h"
#include "core/joining/join_network.h"
#include "tests/core/joining/networks.h"

namespace patchmill {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kLarge = 60.0, kSmall = 25.0;
constexpr int kAround = 8;  // points of a section

// Sections at 0, 90 and 180 degrees, each a closed line, and lines along the torus.
CurveNetwork HalfTorus(bool directions) {
  CurveNetwork network;
  for (int s = 0; s < 3; ++s) {
    const double a = 0.5 * kPi * s;
    NetworkLine section;
    section.closed = true;
    for (int k = 0; k < kAround; ++k) {
      const double b = 2.0 * kPi * k / kAround, r = kLarge + kSmall * std::cos(b);
      NetworkVertex vertex;
      vertex.position = Vec3(r * std::cos(a), r * std::sin(a), kSmall * std::sin(b));
      section.vertices.push_back(static_cast<int>(network.vertices.size()));
      network.vertices.push_back(vertex);
    }
    network.lines.push_back(section);
  }
  for (int k = 0; k < kAround; ++k) {
    NetworkLine line{{k, kAround + k, 2 * kAround + k}};
    if (directions) line.start.direction = Vec3(0, 1, 0), line.end.direction = Vec3(0, -1, 0);
    network.lines.push_back(line);
    const int next = (k + 1) % kAround;
    for (const int s : {0, kAround}) {
      network.faces.push_back(
          {"", {s + k, s + next, s + kAround + next, s + kAround + k}, PatchScheme::kG2Gregory});
    }
  }
  return network;
}

double TorusError(const JoinedNetwork& joined) {
  double largest = 0.0;
  for (const Patch& patch : joined.model.patches) {
    for (double u = 0; u <= 1; u += 0.0625) {
      for (double v = 0; v <= 1; v += 0.0625) {
        const Vec3 p = Evaluate(patch.shape, u, v).p;
        const double r = std::hypot(p.head<2>().norm() - kLarge, p.z());
        largest = std::max(largest, std::abs(r - kSmall));
      }
    }
  }
  return largest;
}

TEST(LineEnds, AHalfTorusFromThreeSections) {
  const JoinedNetwork round = JoinNetwork(HalfTorus(true)), natural = JoinNetwork(HalfTorus(false));
  ASSERT_EQ(round.model.patches.size(), 16u) << testing::Text(round.findings);
  ASSERT_EQ(natural.model.patches.size(), 16u) << testing::Text(natural.findings);
  fmt::print("half torus: natural ends {:.3f} mm, directions {:.3f} mm\n", TorusError(natural),
             TorusError(round));
  // The natural line through three points of a half circle leaves it by 15 % of its radius of 85.
  EXPECT_GE(TorusError(natural), 12.0);
  EXPECT_LE(TorusError(round), 0.5);
  int joints = 0;
  for (const JoinedEdge& edge : round.edges) joints += edge.equal_curvature;
  EXPECT_EQ(joints, 8 + 16);
}

TEST(LineEnds, WhatIsRefused) {
  const auto found = [](auto change) {
    CurveNetwork network = testing::LineSheet(7, 3, 3);
    change(network);
    return testing::Text(JoinNetwork(network).findings);
  };
  const auto has = [](const std::string& text, const std::string& part) {
    return text.find("INVALID_LINE") != std::string::npos && text.find(part) != std::string::npos;
  };
  EXPECT_EQ(found([](CurveNetwork& n) { n.lines[0].start.direction = Vec3(0, 2, 0.3); }), "");
  EXPECT_EQ(found([](CurveNetwork& n) { n.lines[0].end.curvature = Vec3(0, 0, 0.01); }), "");
  std::string text = found([](CurveNetwork& n) { n.lines[0].start.direction = Vec3::Zero(); });
  EXPECT_TRUE(has(text, "network.lines[0] has no spline: start direction must be finite and not zero"))
      << text;
  text = found([](CurveNetwork& n) { n.lines[1].end.direction = Vec3(0, -1, 0); });
  EXPECT_TRUE(has(text, "end direction is")) << text;
  EXPECT_TRUE(has(text, "must be at most 2")) << text;
  text = found([](CurveNetwork& n) { n.lines[0].start = {Vec3(0, 1, 0), Vec3(0, 0, 0.1)}; });
  EXPECT_TRUE(has(text, "a direction and a curvature")) << text;
  text = found([](CurveNetwork& n) { n.lines[0].start.curvature = Vec3(0, 0, 50); });
  EXPECT_TRUE(has(text, "cannot be met")) << text;
  text = found([](CurveNetwork& n) { n.lines[0].start.curvature = Vec3(0, 0, std::nan("")); });
  EXPECT_TRUE(has(text, "must be finite")) << text;
  CurveNetwork torus = HalfTorus(true);
  torus.lines[0].start.direction = Vec3(0, 0, 1);
  text = testing::Text(JoinNetwork(torus).findings);
  EXPECT_TRUE(has(text, "a closed line has no end")) << text;
}

}  // namespace
}  // namespace patchmill
