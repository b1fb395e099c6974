// Boxes around faces that are not trimmed, against dense samples of the surfaces' own formulas.
#include "core/trim/face_box.h"

#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "core/base/status.h"
#include "core/trim/trim_model.h"
#include "tests/support/brep_parts.h"

namespace patchmill {
namespace {

using namespace testing;  // NOLINT: the support folder's

// A face over a rectangle of its parameters, of which nothing but the parameters is known.
BrepModel OverRectangle(BrepSurface surface, const Vec2& a, const Vec2& b) {
  PartMaker maker;
  const Vec2 corners[] = {a, {b.x(), a.y()}, b, {a.x(), b.y()}};
  BrepLoop loop;
  for (int k = 0; k < 4; ++k)
    loop.push_back(StraightUse(maker.Pole(), true, corners[k], corners[(k + 1) % 4]));
  maker.Face(std::move(surface), {loop});
  return maker.part();
}

Vec3 InFrame(const BrepFrame& f, double x, double y, double z) {
  return f.origin + x * f.x + y * f.y + z * f.z;
}

struct Sampled {
  std::string name;
  BrepSurface surface;
  std::function<Vec3(double, double)> at;
};

std::vector<Sampled> Surfaces(const BrepFrame& f) {
  return {{"cylinder", BrepCylinder{f, 6.0},
           [f](double u, double v) { return InFrame(f, 6 * std::cos(u), 6 * std::sin(u), v); }},
          {"cone", BrepCone{f, 6.0, 0.4},
           [f](double u, double v) {
             const double r = 6 + v * std::sin(0.4);
             return InFrame(f, r * std::cos(u), r * std::sin(u), v * std::cos(0.4));
           }},
          {"sphere", BrepSphere{f, 5.0},
           [f](double u, double v) {
             return InFrame(f, 5 * std::cos(v) * std::cos(u), 5 * std::cos(v) * std::sin(u), 5 * std::sin(v));
           }},
          {"torus", BrepTorus{f, 8.0, 3.0}, [f](double u, double v) {
             const double r = 8 + 3 * std::cos(v);
             return InFrame(f, r * std::cos(u), r * std::sin(u), 3 * std::sin(v));
           }}};
}

TEST(FaceBox, HoldsTheSurfaceAndIsHardlyLarger) {
  const std::pair<Vec2, Vec2> rectangles[] = {{{0, 0}, {2 * kPi, kPi / 2}},
                                              {{-1.3, -0.7}, {0.4, 1.1}},
                                              {{2.0, 0.2}, {2.3, 0.5}},
                                              {{0, 0}, {kPi / 2, 1}}};
  for (const BrepFrame& frame : {BrepFrame(), TiltedFrame()}) {
    for (const Sampled& s : Surfaces(frame)) {
      for (const auto& [a, b] : rectangles) {
        SCOPED_TRACE(s.name);
        const BrepModel part = OverRectangle(s.surface, a, b);
        const Box3 box = BoxOfFace(part, part.faces[0]);
        Box3 seen;
        constexpr int kSteps = 60;
        for (int i = 0; i <= kSteps; ++i) {
          for (int j = 0; j <= kSteps; ++j) {
            seen.Add(s.at(a.x() + (b.x() - a.x()) * i / kSteps, a.y() + (b.y() - a.y()) * j / kSteps));
          }
        }
        EXPECT_TRUE((box.min.array() <= seen.min.array() + 1e-9).all());
        EXPECT_TRUE((box.max.array() >= seen.max.array() - 1e-9).all());
        EXPECT_LT((box.max - seen.max).maxCoeff(), 0.08 * seen.Diagonal());
        EXPECT_LT((seen.min - box.min).maxCoeff(), 0.08 * seen.Diagonal());
      }
    }
  }
}

// The hemisphere lies above its only edge.
TEST(FaceBox, AHemisphereIsNotFlat) {
  const BrepModel part = OverRectangle(BrepSphere{{}, 7.0}, {0, 0}, {2 * kPi, kPi / 2});
  const Box3 box = BoxOfFace(part, part.faces[0]);
  EXPECT_NEAR(box.max.z(), 7.0, 1e-9);
  EXPECT_LE(box.max.z() - box.min.z(), 7.5);
  EXPECT_NEAR(box.max.x(), 7.0, 1e-9);
}

TEST(FaceBox, OfAFaceThatCouldNotBeReadIsTheReaders) {
  BrepModel part;
  part.faces.emplace_back();
  EXPECT_TRUE(BoxOfFace(part, part.faces[0]).Empty());
  Box3 known;
  known.Add(Vec3(1, 2, 3));
  known.Add(Vec3(4, 6, 8));
  part.faces[0].box = known;
  EXPECT_EQ(BoxOfFace(part, part.faces[0]).min, known.min);
  EXPECT_EQ(BoxOfFace(part, part.faces[0]).max, known.max);
}

TEST(FaceBox, SidesLookOutward) {
  Box3 box;
  box.Add(Vec3(1, 2, 3));
  box.Add(Vec3(4, 6, 8));
  double area = 0.0;
  Box3 all;
  for (const BezierPatch& side : SidesOf(box)) {
    const SurfaceJet jet = Evaluate(PatchShape(side), 0.5, 0.5);
    const Vec3 normal = jet.du.cross(jet.dv);
    area += normal.norm();
    // From the middle of the box outwards.
    EXPECT_NEAR(normal.dot(jet.p - box.Center()), normal.norm() * (jet.p - box.Center()).norm(), 1e-9);
    for (const Vec3& p : side.points) all.Add(p);
  }
  EXPECT_NEAR(area, 2.0 * (3 * 4 + 4 * 5 + 5 * 3), 1e-9);
  EXPECT_EQ(all.min, box.min);
  EXPECT_EQ(all.max, box.max);
}

// Two squares side by side. What is left of the part is as without the skipped face.
TEST(TrimSkipped, ABoxStandsInTheFacesPlace) {
  PartMaker maker;
  for (const double x : {0.0, 10.0}) {
    BrepLoop loop;
    const std::vector<Vec3> p = {{x, 0, 5}, {x + 10, 0, 5}, {x + 10, 10, 5}, {x, 10, 5}};
    for (std::size_t k = 0; k < 4; ++k) {
      const Vec3 &a = p[k], &b = p[(k + 1) % 4];
      loop.push_back(StraightUse(maker.Edge(StraightCurve(a, b)), true, Xy(a), Xy(b)));
    }
    BrepPlane plane;
    plane.frame.origin = Vec3(0, 0, 5);
    maker.Face(plane, {loop}).area = x > 0.0 ? 12345.0 : 100.0;  // a fault of the second face
  }
  const auto whole = TrimFaces(maker.part(), {}, RunContext());
  ASSERT_TRUE(whole.ok());
  ASSERT_EQ(whole->findings.size(), 1u);
  EXPECT_EQ(whole->findings[0].code, "FACE_AREA_DIFFERS");
  TrimParams params;
  params.skipped = {FaceId(std::size_t{1})};
  const auto trimmed = TrimFaces(maker.part(), params, RunContext());
  ASSERT_TRUE(trimmed.ok()) << trimmed.status();
  EXPECT_TRUE(trimmed->findings.empty());
  ASSERT_EQ(trimmed->model.patches.size(), 7u);
  EXPECT_FALSE(trimmed->model.faces[0].skipped);
  EXPECT_TRUE(trimmed->model.faces[1].skipped);
  EXPECT_EQ(std::get<BezierPatch>(trimmed->model.patches[0].shape).points,
            std::get<BezierPatch>(whole->model.patches[0].shape).points);
  Box3 box;
  for (std::size_t k = 1; k < 7; ++k) {
    EXPECT_EQ(trimmed->model.patches[k].id, "f2." + std::to_string(k));
    EXPECT_TRUE(patchmill::IsSkipped(trimmed->model, PatchId(k)));
    for (const Vec3& p : std::get<BezierPatch>(trimmed->model.patches[k].shape).points) box.Add(p);
  }
  // The plane face gets a little height.
  EXPECT_LT(box.min.z(), 5.0);
  EXPECT_GT(box.max.z(), 5.0);
  EXPECT_LT(box.max.z(), 5.01);
  EXPECT_LT(box.min.x(), 10.0);
  EXPECT_GT(box.min.x(), 9.99);
  EXPECT_TRUE(ValidateModel(trimmed->model).empty());
  params.skipped = {FaceId(std::size_t{0}), FaceId(std::size_t{1})};
  EXPECT_FALSE(TrimFaces(maker.part(), params, RunContext()).ok());
}

}  // namespace
}  // namespace patchmill
