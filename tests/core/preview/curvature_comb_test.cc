// Combs and triangles of a sphere, a cylinder and a plane.
#include "core/preview/curvature_comb.h"

#include <cmath>

#include <gtest/gtest.h>

#include "core/preview/patch_mesh.h"

namespace patchmill {
namespace {

// A quarter circle of radius 5 about the z axis, extruded by 8 along z: rational, exact.
BezierPatch QuarterCylinder() {
  BezierPatch patch;
  patch.degree_u = 2, patch.degree_v = 1;
  const Vec2 arc[3] = {Vec2(5, 0), Vec2(5, 5), Vec2(0, 5)};
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 2; ++j) {
      patch.points.emplace_back(arc[i].x(), arc[i].y(), 8.0 * j);
      patch.weights.push_back(i == 1 ? std::sqrt(0.5) : 1.0);
    }
  }
  return patch;
}

// The octant of a sphere of radius 7 about the origin between z = 0 and the pole, without the pole: the
// rational biquadratic, whose edge v = 1 is a point.
BezierPatch Octant() {
  BezierPatch patch;
  patch.degree_u = patch.degree_v = 2;
  const Vec2 arc[3] = {Vec2(1, 0), Vec2(1, 1), Vec2(0, 1)};
  const double w = std::sqrt(0.5), weight[3] = {1.0, w, 1.0};
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      patch.points.emplace_back(7 * arc[i].x() * arc[j].x(), 7 * arc[i].y() * arc[j].x(), 7 * arc[j].y());
      patch.weights.push_back(weight[i] * weight[j]);
    }
  }
  return patch;
}

TEST(CurvatureComb, TeethOfACylinderPointToItsAxis) {
  for (const CombTooth& tooth : CombAlong(QuarterCylinder(), true, 0.5, 10)) {
    EXPECT_NEAR(tooth.curvature.norm(), 1.0 / 5.0, 1e-12);
    const Vec3 axis = tooth.place + tooth.curvature / tooth.curvature.squaredNorm();
    EXPECT_NEAR(Vec2(axis.x(), axis.y()).norm(), 0.0, 1e-11);
    EXPECT_NEAR(axis.z(), 4.0, 1e-11);
  }
  for (const CombTooth& tooth : CombAlong(QuarterCylinder(), false, 0.5, 10)) {
    EXPECT_NEAR(tooth.curvature.norm(), 0.0, 1e-13);
  }
}

TEST(CurvatureComb, ParallelsOfASphereHaveTheirOwnRadiusAndMeridiansThatOfTheSphere) {
  for (const CombTooth& tooth : CombAlong(Octant(), false, 0.3, 10)) {
    if (tooth.curvature.isZero()) continue;
    EXPECT_NEAR(tooth.curvature.norm(), 1.0 / 7.0, 1e-11);
    EXPECT_LE((tooth.place + 49.0 * tooth.curvature).norm(), 1e-8);
  }
  for (const CombTooth& tooth : CombAlong(Octant(), true, 0.4, 10)) {
    const double radius = Vec2(tooth.place.x(), tooth.place.y()).norm();
    EXPECT_NEAR(tooth.curvature.norm(), 1.0 / radius, 1e-11);
  }
}

TEST(CurvatureComb, ACurveWithoutDirectionHasNoTooth) {
  EXPECT_EQ(CurvatureVector(Vec3::Zero(), Vec3(1, 2, 3)), Vec3::Zero());
  EXPECT_EQ(CurvatureVector(Vec3(2, 0, 0), Vec3(5, 8, 0)), Vec3(0, 2, 0));
}

TEST(PatchMesh, TrianglesOfASphereLieOnItAndRunAnticlockwiseAboutTheNormals) {
  const PatchMesh mesh = MeshOf(Octant(), 16);
  ASSERT_EQ(mesh.places.size(), 17u * 17u);
  ASSERT_EQ(mesh.corners.size(), 2u * 16u * 16u);
  double area = 0.0;
  for (const auto& corners : mesh.corners) {
    const Vec3 &a = mesh.places[static_cast<std::size_t>(corners[0])],
               &b = mesh.places[static_cast<std::size_t>(corners[1])],
               &c = mesh.places[static_cast<std::size_t>(corners[2])];
    const Vec3 turn = (b - a).cross(c - a);
    EXPECT_GE(turn.dot(mesh.normals[static_cast<std::size_t>(corners[0])]), -1e-12);
    area += 0.5 * turn.norm();
  }
  EXPECT_NEAR(area, 49.0 * M_PI / 2.0, 0.3);  // chords of 1/16 of a quarter turn lose some thousandths
  for (std::size_t k = 0; k < mesh.places.size(); ++k) {
    EXPECT_NEAR(mesh.places[k].norm(), 7.0, 1e-12);
    const bool pole = mesh.places[k].z() > 6.999999;
    EXPECT_LE((mesh.normals[k] - mesh.places[k] / 7.0).norm(), pole ? 1e-5 : 1e-11);
  }
}

TEST(PatchMesh, TrianglesOfATriangleCoverIt) {
  BezierTriangle flat;
  flat.degree = 1;
  flat.points = {Vec3(0, 0, 1), Vec3(4, 0, 1), Vec3(0, 6, 1)};
  const PatchMesh mesh = MeshOf(flat, 5);
  ASSERT_EQ(mesh.places.size(), 21u);
  ASSERT_EQ(mesh.corners.size(), 25u);
  double area = 0.0;
  for (const auto& corners : mesh.corners) {
    const Vec3 &a = mesh.places[static_cast<std::size_t>(corners[0])],
               &b = mesh.places[static_cast<std::size_t>(corners[1])],
               &c = mesh.places[static_cast<std::size_t>(corners[2])];
    const double z = (b - a).cross(c - a).z();
    EXPECT_GT(z, 0.0);
    area += 0.5 * z;
  }
  EXPECT_NEAR(area, 12.0, 1e-12);
}

}  // namespace
}  // namespace patchmill
