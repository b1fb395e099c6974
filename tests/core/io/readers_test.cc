// What the readers make of sound text, number by number, and that the writers give it back.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error_details.h"
#include "core/io/bez.h"
#include "core/io/bpt.h"
#include "core/io/bv.h"
#include "core/io/patches.h"
#include "core/network/control_points.h"
#include "tests/support/files.h"
#include "tests/support/random.h"
#include "tests/support/shapes.h"

namespace patchmill {
namespace {

using ::testing::HasSubstr;
using testing::LoadModel;
using testing::Single;

// Numbers 0, 1, 2, ... as points (k, 0, k*k).
std::string Points(int count) {
  std::string text;
  for (int k = 0; k < count; ++k) text += std::to_string(k) + " 0 " + std::to_string(k * k) + "\n";
  return text;
}
Vec3 NumberedPoint(int k) { return Vec3(k, 0, k * k); }

void ExpectSame(const PatchModel& a, const PatchModel& b, double tolerance) {
  ASSERT_EQ(a.patches.size(), b.patches.size());
  for (std::size_t k = 0; k < a.patches.size(); ++k) {
    const PatchShape &p = a.patches[k].shape, &q = b.patches[k].shape;
    ASSERT_EQ(p.index(), q.index());
    const auto pp = ControlPoints(p), qq = ControlPoints(q);
    ASSERT_EQ(pp.size(), qq.size());
    for (std::size_t i = 0; i < pp.size(); ++i) EXPECT_LE((pp[i] - qq[i]).norm(), tolerance);
    if (const auto* x = std::get_if<BezierPatch>(&p)) {
      const auto& y = std::get<BezierPatch>(q);
      EXPECT_EQ(x->degree_u, y.degree_u);
      EXPECT_EQ(x->degree_v, y.degree_v);
      EXPECT_EQ(x->weights, y.weights);
    }
  }
}

TEST(ReadBpt, KeepsTheOrderOfTheFile) {
  const auto model = ReadBpt("1\n1 2\n" + Points(6));
  ASSERT_TRUE(model.ok()) << model.status();
  const auto& patch = std::get<BezierPatch>(model->patches[0].shape);
  EXPECT_EQ(patch.degree_u, 1);
  EXPECT_EQ(patch.degree_v, 2);
  for (int k = 0; k < 6; ++k) EXPECT_EQ(patch.points[static_cast<std::size_t>(k)], NumberedPoint(k));
  // The first points are the edge u = 0.
  EXPECT_EQ(Position(model->patches[0].shape, 0, 0), NumberedPoint(0));
  EXPECT_EQ(Position(model->patches[0].shape, 0, 1), NumberedPoint(2));
  EXPECT_EQ(Position(model->patches[0].shape, 1, 0), NumberedPoint(3));
}

TEST(ReadBpt, TakesAnyWhiteSpaceAndNumberForm) {
  const auto model =
      ReadBpt("\xef\xbb\xbf 1 1\t1\r\n+1 -.5e1 0.25\f1. 1e-3 -0\r\n 1E+1 2 3\n\n4 5 6   \n \n");
  ASSERT_TRUE(model.ok()) << model.status();
  const auto points = ControlPoints(model->patches[0].shape);
  EXPECT_EQ(points[0], Vec3(1, -5, 0.25));
  EXPECT_EQ(points[1], Vec3(1, 0.001, 0));
  EXPECT_EQ(points[2], Vec3(10, 2, 3));
}

TEST(ReadBpt, CountsLinesAlsoWithCarriageReturns) {
  EXPECT_THAT(std::string(ReadBpt("1\r\n1 1\r\n0 0 0\r\n1 0 x\r\n").status().message()),
              HasSubstr("the text has room for 0"));
  EXPECT_THAT(std::string(ReadBpt("1\r\n1 1\r\n0 0 0\r\n1 0 x\r\n0 0 0\r\n0 0 0\r\n").status().message()),
              HasSubstr("line 4: \"x\" is not a number"));
}

TEST(ReadBv, ReadsEveryKind) {
  const std::string text = "Group 3 some name\n3 2\n" + Points(6) + "4\n2\n" + Points(9) + "5\n1 3\n" +
                           Points(8) + "Group 4\n8 1 1\n2 0 4 2\n0 3 0 3\n4 0 0 4\n1 1 1 1\n";
  const auto model = ReadBv(text);
  ASSERT_TRUE(model.ok()) << model.status();
  ASSERT_EQ(model->patches.size(), 4u);
  const PatchShape& triangle = model->patches[0].shape;
  EXPECT_EQ(std::get<BezierTriangle>(triangle).degree, 2);
  EXPECT_EQ(Position(triangle, 0, 0), NumberedPoint(0));
  EXPECT_EQ(Position(triangle, 1, 0), NumberedPoint(2));
  EXPECT_EQ(Position(triangle, 0, 1), NumberedPoint(5));
  EXPECT_EQ(std::get<BezierPatch>(model->patches[1].shape).degree_v, 2);
  const PatchShape& five = model->patches[2].shape;
  EXPECT_EQ(Position(five, 0, 1), NumberedPoint(3));  // v runs fastest
  EXPECT_EQ(Position(five, 1, 0), NumberedPoint(4));
  const auto& rational = std::get<BezierPatch>(model->patches[3].shape);
  EXPECT_THAT(rational.weights, ::testing::ElementsAre(2, 3, 4, 1));
  EXPECT_EQ(rational.points[0], Vec3(1, 0, 2));
  EXPECT_EQ(rational.points[1], Vec3(0, 1, 0));
}

TEST(ReadBv, DividesTheSphereOfBembelByItsWeights) {
  const auto text = testing::ReadSharedFile("data/patches/sphere_rational.bv");
  if (!text) GTEST_SKIP() << "../shared/data/patches/sphere_rational.bv is not there";
  const auto model = ReadBv(*text);
  ASSERT_TRUE(model.ok()) << model.status();
  for (const Patch& patch : model->patches) {
    for (double u = 0; u <= 1; u += 0.25) {
      for (double v = 0; v <= 1; v += 0.25) EXPECT_NEAR(Position(patch.shape, u, v).norm(), 1.0, 1e-10);
    }
  }
}

TEST(ReadPatches, ReadsEveryKindWithUFastest) {
  const std::string text = "patches 4\nbezier 1 2\n" + Points(6) + "triangle 2\n" + Points(6) + "gregory4\n" +
                           Points(20) + "gregory3\n" + Points(18);
  const auto model = ReadPatches(text);
  ASSERT_TRUE(model.ok()) << model.status();
  const PatchShape& quad = model->patches[0].shape;
  EXPECT_EQ(Position(quad, 1, 0), NumberedPoint(1));
  EXPECT_EQ(Position(quad, 0, 1), NumberedPoint(4));
  EXPECT_EQ(Position(quad, 1, 1), NumberedPoint(5));
  EXPECT_EQ(Position(model->patches[1].shape, 1, 0), NumberedPoint(2));
  const auto& gregory = std::get<GregoryPatch>(model->patches[2].shape);
  EXPECT_EQ(gregory.blend, GregoryPatch::Blend::kCorner);
  EXPECT_EQ(Position(model->patches[2].shape, 1, 0), NumberedPoint(5));
  EXPECT_EQ(Position(model->patches[2].shape, 0, 1), NumberedPoint(15));
  EXPECT_EQ(std::get<GregoryTriangle>(model->patches[3].shape).blend, GregoryPatch::Blend::kCorner);
  EXPECT_EQ(Position(model->patches[3].shape, 1, 0), NumberedPoint(5));
  EXPECT_EQ(Position(model->patches[3].shape, 0, 1), NumberedPoint(10));
  // The middle of edge 0-1 is 0 1 15 7 5 in quartic form.
  const Vec3 middle = (NumberedPoint(0) + 4 * NumberedPoint(1) + 6 * NumberedPoint(15) +
                       4 * NumberedPoint(7) + NumberedPoint(5)) /
                      16;
  EXPECT_LE((Position(model->patches[3].shape, 0.5, 0) - middle).norm(), 1e-13);
}

TEST(ReadBez, QuarterCylinderIsExactWithUAroundIt) {
  const PatchModel model = LoadModel("tests/models/quarter_cylinder.bez");
  ASSERT_EQ(model.patches.size(), 1u);
  const auto& patch = std::get<BezierPatch>(model.patches[0].shape);
  EXPECT_EQ(patch.degree_u, 2);
  EXPECT_EQ(patch.degree_v, 1);
  for (double u = 0; u <= 1; u += 0.125) {
    for (double v = 0; v <= 1; v += 0.25) {
      const Vec3 p = Position(model.patches[0].shape, u, v);
      EXPECT_NEAR(std::hypot(p.x(), p.z()), 10.0, 1e-14);
      EXPECT_NEAR(p.y(), 20.0 * v, 1e-13);
    }
  }
}

TEST(ReadBez, BicubicsWithUFastest) {
  const auto model = ReadBez("BBP #" + Points(1) + Points(16) + Points(16));
  ASSERT_TRUE(model.ok()) << model.status();
  ASSERT_EQ(model->patches.size(), 2u);
  EXPECT_EQ(Position(model->patches[1].shape, 1, 0), NumberedPoint(3));
  EXPECT_EQ(Position(model->patches[1].shape, 0, 1), NumberedPoint(12));
}

TEST(ReadBez, RefusesTheTorusWithPointsAtInfinity) {
  const auto text = testing::ReadSharedFile("data/patches/torus.bez");
  if (!text) GTEST_SKIP() << "../shared/data/patches/torus.bez is not there";
  const absl::Status status = ReadBez(*text).status();
  EXPECT_EQ(std::string(status.message()),
            "line 4: ZERO_WEIGHT: weight of a point = 0; must be in [1e-09, 1e+09]");
  EXPECT_EQ(CodeOf(status), "ZERO_WEIGHT");
}

TEST(Readers, AgreeOnTheTeapot) {
  const auto bv = testing::ReadSharedFile("data/patches/teapot.bv");
  if (!bv) GTEST_SKIP() << "../shared/data/patches/teapot.bv is not there";
  ExpectSame(*ReadBv(*bv), LoadModel("examples/teapot.bpt"), 0.0);
}

TEST(Writers, GiveBackWhatTheyWereGiven) {
  PatchModel model;
  for (int d = 1; d <= 15; ++d) {
    model.patches.push_back({"", testing::RandomBezier(static_cast<std::uint64_t>(d), d, 16 - d, false)});
  }
  ExpectSame(*ReadBpt(*WriteBpt(model)), model, 0.0);
  ExpectSame(*ReadBv(*WriteBv(model)), model, 0.0);
  for (int d = 1; d <= 15; ++d) {
    model.patches.push_back({"", testing::RandomTriangle(static_cast<std::uint64_t>(d), d, false)});
  }
  ExpectSame(*ReadBv(*WriteBv(model)), model, 0.0);
  model.patches.push_back({"", testing::RandomGregory(3, GregoryPatch::Blend::kCorner)});
  model.patches.push_back({"", testing::RandomGregoryTriangle(4, GregoryPatch::Blend::kCorner)});
  ExpectSame(*ReadPatches(*WritePatches(model)), model, 0.0);
}

TEST(Writers, GiveBackRationalPatchesToRounding) {
  const PatchModel model = Single(testing::RandomBezier(5, 3, 4, true));
  ExpectSame(*ReadBv(*WriteBv(model)), model, 1e-13);
}

TEST(Writers, RefuseWhatTheFormatCannotHold) {
  const PatchModel spline = testing::TwoHills(), rational = Single(testing::RandomBezier(5, 3, 4, true));
  const PatchModel edge_blend = Single(testing::RandomGregory(3, GregoryPatch::Blend::kEdge));
  EXPECT_FALSE(WriteBpt(spline).ok());
  EXPECT_FALSE(WriteBpt(rational).ok());
  EXPECT_FALSE(WriteBv(spline).ok());
  EXPECT_FALSE(WriteBv(edge_blend).ok());
  EXPECT_FALSE(WriteBv(Single(testing::RandomTriangle(1, 3, true))).ok());
  EXPECT_FALSE(WritePatches(spline).ok());
  EXPECT_FALSE(WritePatches(rational).ok());
  EXPECT_FALSE(WritePatches(Single(testing::RandomGregoryTriangle(4, GregoryPatch::Blend::kEdge))).ok());
  EXPECT_THAT(std::string(WritePatches(edge_blend).status().message()), HasSubstr("patches[0]"));
}

}  // namespace
}  // namespace patchmill
