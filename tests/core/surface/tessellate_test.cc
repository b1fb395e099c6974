#include "core/surface/tessellate.h"

#include <gtest/gtest.h>

#include "tests/core/surface/surface_models.h"

namespace patchmill {
namespace {

using testing::MakeSurface;

const TessellationVertex& At(const Tessellation::PieceMesh& mesh, int i, int j) {
  return mesh.vertices[static_cast<std::size_t>(i * (mesh.nv + 1) + j)];
}

class EveryMesh : public ::testing::TestWithParam<testing::NamedModel> {};

TEST_P(EveryMesh, IsAGridOfSurfacePointsCloseToTheSurface) {
  const Surface s = MakeSurface(GetParam().model);
  for (const double chord : {0.3, 0.01}) {
    const Tessellation t = Tessellate(s, chord, 2000);
    ASSERT_EQ(t.meshes.size(), s.pieces.size());
    double worst = 0.0;
    for (const auto& mesh : t.meshes) {
      ASSERT_EQ(mesh.vertices.size(), static_cast<std::size_t>((mesh.nu + 1) * (mesh.nv + 1)));
      const Piece& piece = s.piece(mesh.piece);
      for (int i = 0; i < mesh.nu; ++i) {
        for (int j = 0; j < mesh.nv; ++j) {
          const double u = static_cast<double>(i) / mesh.nu, v = static_cast<double>(j) / mesh.nv;
          EXPECT_LT((At(mesh, i, j).p - Position(piece, u, v)).norm(), 1e-11);
          // Middle of the diagonal and of two sides of each cell: where triangles deviate most.
          const double mu = (i + 0.5) / mesh.nu, mv = (j + 0.5) / mesh.nv;
          const Vec3 diagonal = 0.5 * (At(mesh, i, j).p + At(mesh, i + 1, j + 1).p);
          worst = std::max(worst, (Position(piece, mu, mv) - diagonal).norm());
          const Vec3 side = 0.5 * (At(mesh, i, j).p + At(mesh, i + 1, j).p);
          worst = std::max(worst, (Position(piece, mu, v) - side).norm());
        }
      }
    }
    EXPECT_LE(worst, 1.5 * chord);
  }
}

INSTANTIATE_TEST_SUITE_P(Tessellate, EveryMesh, ::testing::ValuesIn(testing::EveryKindOfPatch()),
                         [](const auto& model) { return model.param.name; });

TEST(Tessellate, NormalsPointUpAndVanishAtPoles) {
  const Vec3 center(1, 2, 3);
  const Surface s = MakeSurface(testing::Sphere(center, 7.0));
  const Tessellation t = Tessellate(s, 0.05, 100);
  int poles = 0;
  for (const auto& mesh : t.meshes) {
    for (const TessellationVertex& vertex : mesh.vertices) {
      const Vec3 radial = (vertex.p - center) / 7.0;
      if (std::abs(radial.z()) > 1.0 - 1e-12) {
        EXPECT_EQ(vertex.normal, Vec3::Zero());
        ++poles;
        continue;
      }
      EXPECT_GE(vertex.normal.z(), 0.0);
      EXPECT_LT(vertex.normal.cross(radial).norm(), 1e-9);
      EXPECT_NEAR(vertex.normal.norm(), 1.0, 1e-12);
    }
  }
  EXPECT_GT(poles, 0);
}

TEST(Tessellate, ObeysItsLimits) {
  const Surface plane = MakeSurface(testing::Plane(50.0));
  EXPECT_EQ(Tessellate(plane, 1e-6, 100).meshes.front().vertices.size(), 4u);  // flat: one cell
  const Surface wild = MakeSurface(testing::RandomBspline(1));
  for (const auto& mesh : Tessellate(wild, 1e-9, 7).meshes) {
    EXPECT_EQ(mesh.nu, 7);
    EXPECT_EQ(mesh.nv, 7);
  }
}

}  // namespace
}  // namespace patchmill
