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

// Kind 11: an octant of a sphere is a rational triangle of degree four. Here the cone x^2 + y^2 = z^2
// between the angles 0 and 90 degrees, from its tip: degree two, with the weights of a quarter circle.
TEST(ReadBv, RationalTriangles) {
  const double w = std::sqrt(0.5);
  // From the tip (row 0, left) to the arc: the points of the net are those of degree 2 in barycentric order.
  BezierTriangle cone;
  cone.degree = 2;
  cone.points = {Vec3(0, 0, 0),     Vec3(0.5, 0, 0.5), Vec3(1, 0, 1),
                 Vec3(0, 0.5, 0.5), Vec3(1, 1, 1),     Vec3(0, 1, 1)};
  cone.weights = {1, 1, 1, 1, w, 1};
  PatchModel model;
  model.patches.push_back({"", cone});
  const auto text = WriteBv(model);
  ASSERT_TRUE(text.ok()) << text.status();
  EXPECT_EQ(text->substr(0, 5), "11 2\n");
  const auto read = ReadBv(*text);
  ASSERT_TRUE(read.ok()) << read.status();
  const auto& triangle = std::get<BezierTriangle>(read->patches[0].shape);
  EXPECT_THAT(triangle.weights, ::testing::ElementsAreArray(cone.weights));
  for (double t = 0; t <= 1; t += 0.125) {  // the side opposite to the tip is the circle z = 1
    const Vec3 p = Position(read->patches[0].shape, 1 - t, t);
    EXPECT_NEAR(p.head<2>().norm(), 1.0, 1e-15);
    EXPECT_NEAR(p.z(), 1.0, 1e-15);
  }
  EXPECT_THAT(std::string(ReadBv("11\n1\n0 0 0 1\n1 0 0 1\n0 1 0 0\n").status().message()),
              HasSubstr("weight of a point = 0; must be in"));
}

TEST(ReadBv, ReadsOverPolygonMeshesBesidePatches) {
  const std::string mesh = "Group 1 net\n1\n4 2\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2\n4 0 1 2 3\n";
  const std::string patch = "4 1\n0 0 0\n0 10 0\n10 0 0\n10 10 0\n";
  for (const std::string& text : {mesh + patch + mesh, patch + mesh + mesh}) {
    Diagnostics remarks;
    const auto model = ReadBv(text, &remarks);
    ASSERT_TRUE(model.ok()) << model.status();
    EXPECT_EQ(model->patches.size(), 1u);
    ASSERT_EQ(remarks.size(), 1u);
    EXPECT_EQ(remarks[0].code, "MESH_LEFT_OUT");
    EXPECT_EQ(remarks[0].where.line, text[0] == 'G' ? 2 : 7);
    EXPECT_THAT(remarks[0].message, HasSubstr("2 of the file's parts are meshes of kind 1, with 4 polygons"));
  }
  Diagnostics remarks;
  EXPECT_TRUE(ReadBv(patch, &remarks).ok());
  EXPECT_TRUE(remarks.empty());
  const auto fault = [](const std::string& text) { return std::string(ReadBv(text).status().message()); };
  EXPECT_THAT(fault(mesh), HasSubstr("line 2: kind 1 is a polygon mesh, not a patch"));
  EXPECT_THAT(fault(patch + "1\n3 1\n0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n"),
              HasSubstr("line 11: vertex of a polygon = \"3\"; must be in [0, 2]"));
  EXPECT_THAT(fault(patch + "1\n3 1\n0 0 0\n1 0 0\n0 1 0\n2 0 1\n"),
              HasSubstr("number of vertices of a polygon"));
  EXPECT_THAT(fault(patch + "1\n1000000000 1\n"), HasSubstr("number of vertices of the mesh"));
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

// All degrees of rational triangles: the products of the file, divided by their weights, round.
TEST(Writers, RationalTrianglesGoRound) {
  PatchModel model;
  for (int d = 1; d <= 15; ++d) {
    model.patches.push_back({"", testing::RandomTriangle(static_cast<std::uint64_t>(d), d, true)});
  }
  const auto read = ReadBv(*WriteBv(model));
  ASSERT_TRUE(read.ok()) << read.status();
  ExpectSame(*read, model, 1e-13);
  for (std::size_t k = 0; k < model.patches.size(); ++k) {
    EXPECT_EQ(std::get<BezierTriangle>(read->patches[k].shape).weights,
              std::get<BezierTriangle>(model.patches[k].shape).weights);
  }
}

TEST(Writers, RefuseWhatTheFormatCannotHold) {
  const PatchModel spline = testing::TwoHills(), rational = Single(testing::RandomBezier(5, 3, 4, true));
  const PatchModel edge_blend = Single(testing::RandomGregory(3, GregoryPatch::Blend::kEdge));
  EXPECT_FALSE(WriteBpt(spline).ok());
  EXPECT_FALSE(WriteBpt(rational).ok());
  EXPECT_FALSE(WriteBv(spline).ok());
  EXPECT_FALSE(WriteBv(edge_blend).ok());
  EXPECT_FALSE(WritePatches(spline).ok());
  EXPECT_FALSE(WritePatches(rational).ok());
  EXPECT_FALSE(WritePatches(Single(testing::RandomGregoryTriangle(4, GregoryPatch::Blend::kEdge))).ok());
  EXPECT_THAT(std::string(WritePatches(edge_blend).status().message()), HasSubstr("patches[0]"));
}

}  // namespace
}  // namespace patchmill
