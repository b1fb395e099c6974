#include <limits>

#include <gmock/gmock.h>
#include <google/protobuf/util/message_differencer.h>
#include <gtest/gtest.h>

#include "server/convert/model.h"
#include "server/digest.h"
#include "server/limits.h"
#include "tests/service/requests.h"
#include "tests/service/status_matchers.h"

namespace patchmill {
namespace {

using google::protobuf::util::MessageDifferencer;
using testing::Bump;
using ::testing::HasSubstr;
using testing::StatusIs;

// One patch of every kind, polynomial and rational.
v1::PatchModel AllKinds() {
  v1::PatchModel model = Bump();
  model.set_join_tolerance_mm(0.01);
  v1::BsplinePatch& spline = *model.add_patches()->mutable_bspline();
  spline.set_degree_u(1);
  spline.set_degree_v(2);
  for (const double k : {0.0, 0.0, 0.5, 1.0, 1.0}) spline.add_knots_u(k);
  for (const double k : {0.0, 0.0, 0.0, 2.0, 2.0, 2.0}) spline.add_knots_v(k);
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      for (const double x : {20.0 + i, 1.0 * j, 0.25 * i * j}) spline.add_points(x);
      spline.add_weights(1.0 + 0.1 * j);
    }
  }
  v1::Patch& gregory = *model.add_patches();
  gregory.set_id("g");
  gregory.mutable_gregory()->set_blend(v1::GREGORY_BLEND_EDGE);
  for (int i = 0; i < 60; ++i) gregory.mutable_gregory()->add_points(0.1 * i * i);
  v1::BezierTriangle& triangle = *model.add_patches()->mutable_triangle();
  triangle.set_degree(1);
  for (const double x : {0.0, 0.0, 5.0, 1.0, 0.0, 5.0, 0.0, 1.0, 6.0}) triangle.add_points(x);
  for (const double w : {1.0, 0.5, 2.0}) triangle.add_weights(w);
  const auto fill = [](int count, auto& shape) {
    for (int i = 0; i < 3 * count; ++i) shape.add_points(0.1 * i * i);
  };
  v1::BrownPatch& brown = *model.add_patches()->mutable_brown();
  brown.set_degree_u(3);
  brown.set_degree_v(5);
  fill(28, brown);
  v1::GregoryTriangle& quartic = *model.add_patches()->mutable_gregory_triangle();
  quartic.set_blend(v1::GREGORY_BLEND_EDGE);
  fill(18, quartic);
  v1::LoftTriangle& loft = *model.add_patches()->mutable_loft_triangle();
  loft.set_degree(4);
  loft.set_squared(true);
  fill(21, loft);
  v1::G2GregoryPatch& g2 = *model.add_patches()->mutable_g2_gregory();
  g2.set_degree(5);
  fill(52, g2);
  v1::HosakaPatch& hosaka = *model.add_patches()->mutable_hosaka();
  hosaka.set_degree(3);
  for (const int side : {0, 3, 3}) {
    v1::HosakaBreak& b = *hosaka.add_breaks();
    b.set_side(side);
    b.set_at(0.2 + 0.1 * hosaka.breaks_size());
    b.set_value(0.15 * hosaka.breaks_size());
  }
  hosaka.set_inner_degree_u(1);
  hosaka.set_inner_degree_v(0);
  hosaka.set_inner_order(2);
  fill(14, hosaka);
  return model;
}

TEST(ModelRoundTrip, EveryKindComesBackAsItWent) {
  const v1::PatchModel model = AllKinds();
  const auto checked = FromProto(model, "source.model");
  ASSERT_TRUE(checked.ok()) << checked.status();
  EXPECT_TRUE(checked->faults.empty()) << checked->faults[0].message;
  std::string difference;
  MessageDifferencer differencer;
  differencer.ReportDifferencesToString(&difference);
  EXPECT_TRUE(differencer.Compare(ToProto(checked->model), model)) << difference;
}

TEST(ModelRoundTrip, FacesComeBackAsTheyWent) {
  v1::PatchModel model = Bump();
  v1::Face& face = *model.add_faces();
  face.set_id("f1");
  face.set_name("pocket floor");
  face.set_body("PLATE");
  face.set_layer("3");
  face.set_rgb(0x00FF7F);
  face.set_kind(v1::SURFACE_KIND_TORUS);
  face.set_radius_mm(2.5);
  face.set_hollow(true);
  face.set_entity(1234567890123);
  model.mutable_patches(0)->set_face_index(0);
  const auto read = FromProto(model, "model");
  ASSERT_TRUE(read.ok());
  EXPECT_TRUE(read->faults.empty());
  EXPECT_TRUE(MessageDifferencer::Equals(ToProto(read->model), model));
  model.set_length_unit(v1::LENGTH_UNIT_INCH);
  EXPECT_EQ(FromProto(model, "model")->model.faces[0].radius, 2.5);  // its name says mm
}

TEST(ModelDigestTest, DependsOnFacesWhereThereAreAny) {
  v1::PatchModel model = Bump();
  const auto digest = [&] { return ModelDigest(FromProto(model, "model")->model); };
  const std::string bare = digest();
  model.add_faces()->set_id("f1");
  const std::string unused = digest();
  model.mutable_patches(0)->set_face_index(0);
  const std::string used = digest();
  model.mutable_faces(0)->set_name("lid");
  EXPECT_NE(bare, unused);
  EXPECT_NE(unused, used);
  EXPECT_NE(used, digest());
}

TEST(FaceFaults, OfTheMessageAreAllReported) {
  v1::PatchModel model = Bump();
  v1::Face& face = *model.add_faces();
  face.set_id("f1");
  face.set_name(std::string(201, 'x'));
  face.set_rgb(0x1000000);
  face.set_kind(static_cast<v1::SurfaceKind>(99));
  model.mutable_patches(0)->set_face_index(7);
  const auto read = FromProto(model, "model");
  ASSERT_TRUE(read.ok());
  std::vector<std::string> fields;
  for (const Diagnostic& fault : read->faults) {
    EXPECT_EQ(fault.code, "INVALID_FACE");
    fields.push_back(fault.where.field);
  }
  EXPECT_THAT(fields, ::testing::ElementsAre("faces[0].name", "faces[0].rgb", "faces[0].kind",
                                             "patches[0].face_index"));
}

TEST(FaceFaults, ANetworkHasNoFaces) {
  v1::PatchModel model;
  model.set_length_unit(v1::LENGTH_UNIT_MILLIMETER);
  model.mutable_network();
  model.add_faces()->set_id("f1");
  EXPECT_THAT(FromProto(model, "model").status(),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("model.faces")));
}

TEST(ModelUnits, EveryUnitBecomesMillimeters) {
  v1::PatchModel model = Bump(1.0);
  for (const auto& [unit, factor] : {std::pair{v1::LENGTH_UNIT_MILLIMETER, 1.0},
                                     {v1::LENGTH_UNIT_INCH, 25.4},
                                     {v1::LENGTH_UNIT_METER, 1000.0}}) {
    model.set_length_unit(unit);
    const auto checked = FromProto(model, "m");
    ASSERT_TRUE(checked.ok());
    EXPECT_DOUBLE_EQ(ControlBox(checked->model).max.x(), factor);
  }
}

TEST(ModelDigestTest, DependsOnEveryNumberAndNotOnTheUnitItCameIn) {
  const auto digest = [](const v1::PatchModel& model) { return ModelDigest(FromProto(model, "m")->model); };
  const std::string base = digest(AllKinds());
  for (int patch = 0; patch < AllKinds().patches_size(); ++patch) {
    v1::PatchModel changed = AllKinds();
    v1::Patch& p = *changed.mutable_patches(patch);
    if (p.has_bezier()) p.mutable_bezier()->set_points(7, 3.125);
    if (p.has_bspline()) p.mutable_bspline()->set_weights(2, 1.25);
    if (p.has_gregory()) p.mutable_gregory()->set_blend(v1::GREGORY_BLEND_CORNER);
    if (p.has_triangle()) p.mutable_triangle()->set_points(8, 6.5);
    if (p.has_brown()) p.mutable_brown()->set_points(8, 6.25);
    if (p.has_gregory_triangle()) p.mutable_gregory_triangle()->set_blend(v1::GREGORY_BLEND_CORNER);
    if (p.has_loft_triangle()) p.mutable_loft_triangle()->set_points(8, 6.25);
    if (p.has_g2_gregory()) p.mutable_g2_gregory()->set_points(155, 6.25);
    if (p.has_hosaka()) p.mutable_hosaka()->mutable_breaks(2)->set_value(0.5);
    EXPECT_NE(digest(changed), base) << patch;
  }
  v1::PatchModel meters = Bump(2.0, 1.0), millimeters = Bump(2000.0, 1000.0);
  meters.set_length_unit(v1::LENGTH_UNIT_METER);
  EXPECT_EQ(digest(meters), digest(millimeters));
}

// Wrong as a request: a status.
TEST(ModelErrors, MissingUnitPatchesOrToleranceIsAStatus) {
  v1::PatchModel model = Bump();
  model.clear_length_unit();
  EXPECT_THAT(FromProto(model, "source.model").status(),
              StatusIs(absl::StatusCode::kInvalidArgument,
                       HasSubstr("source.model.length_unit is missing; add \"length_unit\"")));
  model = Bump();
  model.clear_patches();
  EXPECT_THAT(FromProto(model, "source.model").status(),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("source.model.patches is missing")));
  for (const double bad : {0.0, -1.0, 11.0, std::numeric_limits<double>::quiet_NaN()}) {
    model = Bump();
    model.set_join_tolerance_mm(bad);
    EXPECT_THAT(FromProto(model, "m").status(),
                StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("m.join_tolerance_mm = ")));
  }
}

TEST(ModelErrors, LimitsAreCheckedByCountBeforeAnythingIsCopied) {
  v1::PatchModel model;
  model.set_length_unit(v1::LENGTH_UNIT_MILLIMETER);
  for (std::size_t i = 0; i <= limits::kMaxPatches; ++i) model.add_patches();
  EXPECT_THAT(FromProto(model, "m").status(),
              StatusIs(absl::StatusCode::kResourceExhausted, HasSubstr("model.patch_count = 100001")));
  model = Bump();
  model.mutable_patches(0)->mutable_bezier()->mutable_points()->Resize(3 * (limits::kMaxControlPoints + 1),
                                                                       0.0);
  EXPECT_THAT(FromProto(model, "m").status(), StatusIs(absl::StatusCode::kResourceExhausted,
                                                       HasSubstr("model.control_point_count = 2500001")));
}

// Wrong patches: findings, each with its place, all at once.
struct PatchFault {
  const char* name;
  void (*spoil)(v1::PatchModel&);
  const char* message;
};

class PatchFaults : public ::testing::TestWithParam<PatchFault> {};

TEST_P(PatchFaults, IsAFindingWithItsField) {
  v1::PatchModel model = AllKinds();
  GetParam().spoil(model);
  const auto checked = FromProto(model, "m");
  ASSERT_TRUE(checked.ok()) << checked.status();
  ASSERT_FALSE(checked->faults.empty());
  EXPECT_THAT(checked->faults[0].message, HasSubstr(GetParam().message));
  EXPECT_EQ(checked->faults[0].severity, Severity::kError);
}

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

// Each break beside others makes a whole row of pieces.
TEST(ModelErrors, HosakaPatchesCountWithThePiecesOfTheirBreaks) {
  v1::PatchModel model;
  model.set_length_unit(v1::LENGTH_UNIT_MILLIMETER);
  v1::HosakaPatch& hosaka = *model.add_patches()->mutable_hosaka();
  hosaka.set_degree(3);
  for (int side = 0; side < 4; ++side) {
    for (int k = 0; k < 16; ++k) hosaka.add_breaks()->set_side(side);
  }
  while (model.patches_size() * 33 * 33 * 49 <= 2'500'000) *model.add_patches() = model.patches(0);
  EXPECT_THAT(FromProto(model, "m").status(),
              StatusIs(absl::StatusCode::kResourceExhausted, HasSubstr("model.control_point_count")));
  model.mutable_patches()->RemoveLast();
  EXPECT_TRUE(FromProto(model, "m").ok());
}

// Each rectangle between distinct knots makes a Bezier piece; the points given are far fewer.
TEST(ModelErrors, BsplinesCountWithThePiecesTheyAreCutInto) {
  const auto sheet = [](int degree, int spans) {
    v1::PatchModel model = Bump();
    v1::BsplinePatch& bspline = *model.add_patches()->mutable_bspline();
    bspline.set_degree_u(degree);
    bspline.set_degree_v(degree);
    for (int k = -degree; k <= spans + degree; ++k) bspline.add_knots_u(std::clamp(k, 0, spans));
    *bspline.mutable_knots_v() = bspline.knots_u();
    const int points = spans + degree;
    for (int i = 0; i < points * points; ++i) {
      for (const int x : {i / points, i % points, 0}) bspline.add_points(x);
    }
    return model;
  };
  const absl::Status status = FromProto(sheet(15, 99), "m").status();
  EXPECT_THAT(
      status,
      StatusIs(absl::StatusCode::kResourceExhausted,
               HasSubstr("model.control_point_count = 2509072; the limit is 2500000; patches[1].bspline "
                         "counts as 2509056")));
  EXPECT_TRUE(FromProto(sheet(15, 98), "m").ok());
  EXPECT_TRUE(FromProto(sheet(3, 390), "m").ok());
  EXPECT_FALSE(FromProto(sheet(3, 396), "m").ok());
  // Knots that make no B-spline count with its points, and are a finding.
  v1::PatchModel wrong = sheet(15, 99);
  wrong.mutable_patches(1)->mutable_bspline()->set_degree_u(16);
  EXPECT_FALSE(FromProto(wrong, "m")->faults.empty());
}

INSTANTIATE_TEST_SUITE_P(
    All, PatchFaults,
    ::testing::Values(
        PatchFault{"NoShape", [](v1::PatchModel& m) { m.mutable_patches(0)->clear_shape(); },
                   "patches[0].shape is missing"},
        PatchFault{"DegreeZero",
                   [](v1::PatchModel& m) { m.mutable_patches(0)->mutable_bezier()->set_degree_u(0); },
                   "patches[0].bezier.degree_u = 0; must be in [1, 15]"},
        PatchFault{
            "DegreeHuge",
            [](v1::PatchModel& m) { m.mutable_patches(0)->mutable_bezier()->set_degree_v(2000000000); },
            "patches[0].bezier.degree_v = 2000000000"},
        PatchFault{"DegreeNegative",
                   [](v1::PatchModel& m) { m.mutable_patches(3)->mutable_triangle()->set_degree(-3); },
                   "patches[3].triangle.degree = -3"},
        PatchFault{"PointsNotTriples",
                   [](v1::PatchModel& m) { m.mutable_patches(0)->mutable_bezier()->add_points(1); },
                   "patches[0].bezier.points has 49 numbers; must be packed x y z"},
        PatchFault{
            "PointMissing",
            [](v1::PatchModel& m) { m.mutable_patches(0)->mutable_bezier()->mutable_points()->Truncate(45); },
            "patches[0].bezier.points has 15 points; must have 16"},
        PatchFault{"NotFinite",
                   [](v1::PatchModel& m) { m.mutable_patches(0)->mutable_bezier()->set_points(4, kNan); },
                   "patches[0].bezier.points has a number that is not finite in point 1"},
        PatchFault{"Huge",
                   [](v1::PatchModel& m) { m.mutable_patches(0)->mutable_bezier()->set_points(4, 1e300); },
                   "patches[0].bezier.points has 1e+300"},
        PatchFault{"WeightZero",
                   [](v1::PatchModel& m) { m.mutable_patches(1)->mutable_bspline()->set_weights(4, 0); },
                   "patches[1].bspline.weights has 0 at point 4"},
        PatchFault{"WeightNegative",
                   [](v1::PatchModel& m) { m.mutable_patches(3)->mutable_triangle()->set_weights(1, -1); },
                   "patches[3].triangle.weights has -1 at point 1"},
        PatchFault{"WeightCount",
                   [](v1::PatchModel& m) { m.mutable_patches(3)->mutable_triangle()->add_weights(1); },
                   "patches[3].triangle.weights has 4 numbers"},
        PatchFault{"KnotsDecrease",
                   [](v1::PatchModel& m) { m.mutable_patches(1)->mutable_bspline()->set_knots_u(2, 7); },
                   "patches[1].bspline.knots_u"},
        PatchFault{"KnotsTooFew",
                   [](v1::PatchModel& m) {
                     m.mutable_patches(1)->mutable_bspline()->mutable_knots_v()->Truncate(3);
                   },
                   "patches[1].bspline.knots_v has 3 knots"},
        PatchFault{"GregoryCount",
                   [](v1::PatchModel& m) {
                     m.mutable_patches(2)->mutable_gregory()->mutable_points()->Truncate(57);
                   },
                   "patches[2].gregory.points has 19 points; must have 20"},
        PatchFault{"GregoryBlend",
                   [](v1::PatchModel& m) { m.mutable_patches(2)->mutable_gregory()->clear_blend(); },
                   "patches[2].gregory.blend = 0; must be"},
        PatchFault{"BrownDegree",
                   [](v1::PatchModel& m) { m.mutable_patches(4)->mutable_brown()->set_degree_v(12); },
                   "patches[4].brown.degree_v = 12; must be in [3, 11]"},
        PatchFault{"BrownCount",
                   [](v1::PatchModel& m) { m.mutable_patches(4)->mutable_brown()->set_degree_u(4); },
                   "patches[4].brown.points has 28 points; must have 32"},
        PatchFault{"GregoryTriangleCount",
                   [](v1::PatchModel& m) {
                     m.mutable_patches(5)->mutable_gregory_triangle()->mutable_points()->Truncate(51);
                   },
                   "patches[5].gregory_triangle.points has 17 points; must have 18"},
        PatchFault{
            "LoftDegree",
            [](v1::PatchModel& m) { m.mutable_patches(6)->mutable_loft_triangle()->set_squared(false); },
            "patches[6].loft_triangle.degree = 4; must be in [3, 3]"},
        PatchFault{"G2Degree",
                   [](v1::PatchModel& m) { m.mutable_patches(7)->mutable_g2_gregory()->set_degree(8); },
                   "patches[7].g2_gregory.degree = 8; must be in [5, 7]"},
        PatchFault{
            "HosakaSide",
            [](v1::PatchModel& m) { m.mutable_patches(8)->mutable_hosaka()->mutable_breaks(0)->set_side(4); },
            "patches[8].hosaka.breaks name side 4"},
        PatchFault{
            "HosakaBreakOrder",
            [](v1::PatchModel& m) { m.mutable_patches(8)->mutable_hosaka()->mutable_breaks(2)->set_at(0.1); },
            "patches[8].hosaka.breaks of side 3 have (0.1"},
        PatchFault{"HosakaInner",
                   [](v1::PatchModel& m) { m.mutable_patches(8)->mutable_hosaka()->set_inner_degree_u(9); },
                   "patches[8].hosaka.inner_degree_u = 9; must be in [0, 4]"},
        PatchFault{"IdTooLong",
                   [](v1::PatchModel& m) { m.mutable_patches(0)->set_id(std::string(201, 'x')); },
                   "patches[0].id has 201 bytes"},
        PatchFault{"IdTwice", [](v1::PatchModel& m) { m.mutable_patches(2)->set_id("bump"); },
                   "patches[2].id"}),
    [](const auto& wrong) { return std::string(wrong.param.name); });

TEST(PatchFaultsTogether, AreAllReported) {
  v1::PatchModel model = AllKinds();
  for (int i = 0; i < 4; ++i) model.mutable_patches(i)->clear_shape();
  const auto checked = FromProto(model, "m");
  ASSERT_TRUE(checked.ok());
  EXPECT_EQ(checked->faults.size(), 4u);
  EXPECT_EQ(checked->faults[3].where.patch_index, 3);
}

}  // namespace
}  // namespace patchmill
