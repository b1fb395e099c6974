// Normals taken from a surface: of a paraboloid known in closed form, and a network built on a skin.
#include "core/editing/surface_normals.h"

#include <cmath>

#include <gtest/gtest.h>

#include "core/joining/join_network.h"
#include "core/patch/outline_surface.h"
#include "tests/support/random.h"
#include "tests/support/surface_of.h"

namespace patchmill {
namespace {

using testing::Random;

// z = x^2/40 + y^2/60 over [-10,10]^2 as the skin of its sections y = const, which are parabolas: exact, as
// it is quadratic along y but for the natural ends of the spline; so clamp by comparing normals in the middle
// only.
BsplinePatch Paraboloid() {
  std::vector<Curve> sections;
  for (int k = -20; k <= 20; ++k) {
    const double y = 0.5 * k, low = y * y / 60;
    sections.push_back(BezierCurve{{{-10, y, 2.5 + low}, {0, y, -2.5 + low}, {10, y, 2.5 + low}}});
  }
  return *SkinSurface(sections);
}

PatchModel Model() {
  PatchModel model;
  model.patches = {{"", Paraboloid()}};
  return model;
}

TEST(WithNormalsOf, AreThoseOfAParaboloid) {
  const Surface surface = testing::SurfaceOf(Model());
  CurveNetwork network;
  Random random(1);
  for (int k = 0; k < 50; ++k) {
    const double x = random.Uniform(-6, 6), y = random.Uniform(-6, 6);
    NetworkVertex vertex;
    const Vec3 normal = Vec3(-x / 20, -y / 30, 1).normalized();
    vertex.position = Vec3(x, y, x * x / 40 + y * y / 60) + (k == 7 ? 0.25 : 0.0) * normal;
    network.vertices.push_back(vertex);
  }
  network.vertices[3].normals = {{Vec3(1, 0, 0), {}}};
  network.vertices.emplace_back().on_edge = {1, 2, 0.5};  // a T-junction has none: it follows
  const auto made = WithNormalsOf(surface, network, RunContext(2));
  ASSERT_TRUE(made.ok());
  EXPECT_TRUE(made->network.vertices.back().normals.empty());
  EXPECT_EQ(made->farthest_vertex, 7);
  EXPECT_NEAR(made->max_distance, 0.25, 1e-6);
  for (std::size_t k = 0; k + 1 < network.vertices.size(); ++k) {
    const auto& vertex = made->network.vertices[k];
    EXPECT_EQ(vertex.position, network.vertices[k].position);
    ASSERT_EQ(vertex.normals.size(), 1u);
    if (k == 3) {
      EXPECT_EQ(vertex.normals[0].direction, Vec3(1, 0, 0));
    } else if (k != 7) {
      const Vec3& p = vertex.position;
      const Vec3 wanted = Vec3(-p.x() / 20, -p.y() / 30, 1).normalized();
      EXPECT_LE(vertex.normals[0].direction.cross(wanted).norm(), 1e-4);  // the spline's ends ripple that far
    }
  }
}

// A grid of vertices on the skin becomes a smooth network that keeps near it.
TEST(WithNormalsOf, ANetworkOnItKeepsNear) {
  const Surface surface = testing::SurfaceOf(Model());
  CurveNetwork network;
  for (int i = 0; i < 5; ++i) {
    for (int j = 0; j < 5; ++j) {
      NetworkVertex vertex;
      const double x = -8 + 4 * i, y = -8 + 4 * j;
      vertex.position = Vec3(x, y, x * x / 40 + y * y / 60);
      network.vertices.push_back(vertex);
      if (i == 4 || j == 4) continue;
      const int a = 5 * i + j;
      network.faces.push_back({"", {a, a + 5, a + 6, a + 1}, PatchScheme::kAuto, {}});
    }
  }
  const auto made = WithNormalsOf(surface, network, RunContext(1));
  ASSERT_TRUE(made.ok());
  EXPECT_LE(made->max_distance, 1e-4);
  const JoinedNetwork joined = JoinNetwork(made->network);
  ASSERT_TRUE(joined.findings.empty());
  for (const Patch& patch : joined.model.patches) {
    for (const double u : {0.0, 0.3, 0.5, 1.0}) {
      for (const double v : {0.2, 0.5, 0.9}) {
        const Vec3 p = Position(patch.shape, u, v);
        EXPECT_NEAR(p.z(), p.x() * p.x() / 40 + p.y() * p.y() / 60, 5e-3);
      }
    }
  }
}

}  // namespace
}  // namespace patchmill
