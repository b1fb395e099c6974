// Polygon meshes as networks: a cube with and without creases, mixed polygons, faults.
#include "core/division/mesh_network.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "core/joining/join_network.h"
#include "core/joining/network_findings.h"
#include "core/network/patch_network.h"

namespace patchmill {
namespace {

PolygonMesh Cube() {
  PolygonMesh mesh;
  for (int k = 0; k < 8; ++k) mesh.points.emplace_back(10.0 * (k & 1), 10.0 * (k >> 1 & 1), 10.0 * (k >> 2));
  mesh.faces = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  return mesh;
}

TEST(MeshNetwork, ACubeWithCreasesIsTheCube) {
  Diagnostics findings;
  const CurveNetwork network = MeshNetwork(Cube(), Radians(60), findings);
  EXPECT_TRUE(findings.empty());
  EXPECT_EQ(network.edges.size(), 12u);
  const JoinedNetwork joined = JoinNetwork(network);
  ASSERT_EQ(joined.model.patches.size(), 6u);
  for (const Patch& patch : joined.model.patches) {
    const Vec3 p = Position(patch.shape, 0.3, 0.6);
    double off = kInfinity;
    for (const double x : p) off = std::min({off, std::abs(x), std::abs(x - 10)});
    EXPECT_LE(off, 1e-12);
  }
}

TEST(MeshNetwork, WithoutCreasesItIsSmoothAndClosed) {
  Diagnostics findings;
  const JoinedNetwork joined = JoinNetwork(MeshNetwork(Cube(), kPi, findings));
  ASSERT_FALSE(HasError(joined.findings));
  const auto network = BuildNetwork(joined.model);
  ASSERT_TRUE(network.ok());
  EXPECT_EQ(network->open_edge_count, 0);
  for (const EdgeLink& link : network->edges) EXPECT_LE(link.max_angle, 1e-6);
}

TEST(MeshNetwork, TrianglesAndQuadsMix) {
  PolygonMesh mesh;
  mesh.points = {{0, 0, 0}, {10, 0, 1}, {10, 10, 0}, {0, 10, 1}, {18, 5, -2}};
  mesh.faces = {{0, 1, 2, 3}, {1, 4, 2}};
  Diagnostics findings;
  const JoinedNetwork joined = JoinNetwork(MeshNetwork(mesh, kPi, findings));
  EXPECT_EQ(joined.model.patches.size(), 2u);
}

TEST(MeshNetwork, FacesWithoutAreaAreNamedAndLeftOut) {
  PolygonMesh mesh = Cube();
  mesh.faces.push_back({0, 1, 1});
  mesh.faces.push_back({0, 0, 1, 2});
  Diagnostics findings;
  EXPECT_EQ(MeshNetwork(mesh, kPi, findings).faces.size(), 6u);
  ASSERT_EQ(findings.size(), 2u);
  EXPECT_EQ(findings[0].code, "DEGENERATE_FACE");
}

}  // namespace
}  // namespace patchmill
