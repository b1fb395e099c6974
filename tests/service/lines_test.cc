// TraceLines and EvaluateSurface through the wire, against closed forms.
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/service/embedded.h"
#include "tests/service/requests.h"
#include "tests/service/status_matchers.h"

namespace patchmill {
namespace {

using grpc::StatusCode;
using ::testing::ElementsAre;
using testing::Embedded;
using ::testing::HasSubstr;
using testing::InfoOf;
using testing::RpcStatusIs;

// z = (x^2 + y^2) / 20 over [-10, 10]^2 as a biquadratic patch; u along x.
v1::PatchModel Bowl() {
  v1::PatchModel model;
  model.set_length_unit(v1::LENGTH_UNIT_MILLIMETER);
  v1::Patch& patch = *model.add_patches();
  patch.set_id("bowl");
  v1::BezierPatch& bezier = *patch.mutable_bezier();
  bezier.set_degree_u(2);
  bezier.set_degree_v(2);
  const double square[3] = {100, -100, 100};  // Bezier heights of x^2
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      for (const double x : {10.0 * i - 10, 10.0 * j - 10, (square[i] + square[j]) / 20})
        bezier.add_points(x);
    }
  }
  return model;
}

class Lines : public ::testing::Test {
 protected:
  Lines() {
    *request_.mutable_source()->mutable_model() = Bowl();
    request_.add_families()->set_kind(v1::LINE_KIND_CONTOUR);
  }
  grpc::Status Trace() {
    grpc::ClientContext context;
    response_.Clear();
    return embedded_.analysis->TraceLines(&context, request_, &response_);
  }
  Embedded embedded_;
  v1::TraceLinesRequest request_;
  v1::TraceLinesResponse response_;
};

TEST_F(Lines, ContoursAreInTheProgramFrame) {
  request_.mutable_setup()->mutable_program_zero()->set_z_mm(1.0);
  request_.mutable_setup()->mutable_program_zero()->set_x_mm(2.0);
  request_.mutable_families(0)->add_levels(2.2);  // placed height 3.2: a circle of radius 8
  const grpc::Status status = Trace();
  ASSERT_TRUE(status.ok()) << status.error_message();
  ASSERT_EQ(response_.sets_size(), 1);
  const v1::LineSet& set = response_.sets(0);
  EXPECT_DOUBLE_EQ(set.level(), 2.2);
  ASSERT_EQ(set.lines_size(), 1);
  const v1::SurfaceLine& line = set.lines(0);
  EXPECT_TRUE(line.closed());
  EXPECT_NEAR(set.length_mm(), 2 * M_PI * 8, 0.05);
  const int n = line.patch_index_size();
  ASSERT_EQ(line.points_mm_size(), 3 * n);
  ASSERT_EQ(line.uv_size(), 2 * n);
  for (int k = 0; k < n; ++k) {
    const double x = line.points_mm(3 * k) + 2, y = line.points_mm(3 * k + 1);
    EXPECT_NEAR(std::hypot(x, y), 8, 1e-9);
    EXPECT_NEAR(line.points_mm(3 * k + 2), 2.2, 1e-9);
    EXPECT_NEAR(line.uv(2 * k), (x + 10) / 20, 1e-12);
    EXPECT_NEAR(line.uv(2 * k + 1), (y + 10) / 20, 1e-12);
  }
  EXPECT_THAT(response_.patch_ids(), ElementsAre("bowl"));
  EXPECT_FALSE(response_.has_picture());
}

TEST_F(Lines, LevelsAreChosenAndFamiliesKeepTheirPlace) {
  v1::LineFamily& slope = *request_.add_families();
  slope.set_kind(v1::LINE_KIND_EQUI_SLOPE);
  slope.set_count(2);  // 30 and 60 degrees; the bowl rises up to 54.7 in its corners
  request_.add_families()->set_kind(v1::LINE_KIND_SILHOUETTE);
  request_.set_picture(true);
  ASSERT_TRUE(Trace().ok());
  ASSERT_EQ(response_.sets_size(), 9 + 2 + 1);  // contours at 1, 2, .. 9 mm
  for (int k = 0; k < 9; ++k) {
    EXPECT_EQ(response_.sets(k).family_index(), 0);
    EXPECT_DOUBLE_EQ(response_.sets(k).level(), k + 1.0);
    EXPECT_EQ(response_.sets(k).lines_size(), k < 4 ? 1 : k == 4 ? response_.sets(k).lines_size() : 4);
  }
  EXPECT_NEAR(response_.sets(9).level(), 30, 1e-12);
  EXPECT_NEAR(response_.sets(9).length_mm(), 2 * M_PI * 10 * std::tan(M_PI / 6), 0.05);
  EXPECT_NEAR(response_.sets(10).level(), 60, 1e-12);
  EXPECT_EQ(response_.sets(10).lines_size(), 0);
  EXPECT_EQ(response_.sets(11).kind(), v1::LINE_KIND_SILHOUETTE);
  EXPECT_EQ(response_.sets(11).lines_size(), 0);
  EXPECT_THAT(response_.picture().data(), HasSubstr("<svg"));
  EXPECT_THAT(response_.picture().data(), HasSubstr("slope 30 degrees: 1"));
}

// A panel that is bent by a tenth of a degree has as many lines as requested, each with some length.
TEST_F(Lines, FamiliesFromNormals) {
  auto& points =
      *request_.mutable_source()->mutable_model()->mutable_patches(0)->mutable_bezier()->mutable_points();
  for (int k = 2; k < points.size(); k += 3) points[k] *= 1e-3;
  request_.clear_families();
  for (const v1::LineKind kind : {v1::LINE_KIND_HIGHLIGHT, v1::LINE_KIND_BRIGHTNESS}) {
    v1::LineFamily& family = *request_.add_families();
    family.set_kind(kind);
    family.set_count(7);
    family.set_from_normals(true);
  }
  grpc::Status status = Trace();
  ASSERT_TRUE(status.ok()) << status.error_message();
  ASSERT_EQ(response_.sets_size(), 14);
  for (const v1::LineSet& set : response_.sets()) {
    EXPECT_GT(set.length_mm(), 5.0) << set.family_index() << " " << set.level();
    EXPECT_TRUE(set.has_direction());
    EXPECT_EQ(set.has_across(), set.kind() == v1::LINE_KIND_HIGHLIGHT);
  }
  // The planes turn about a level direction, and the normals are nearly upright.
  EXPECT_NEAR(response_.sets(0).direction().z_mm(), 0.0, 1e-6);
  EXPECT_NEAR(std::abs(response_.sets(0).across().z_mm()), 1.0, 1e-6);
  // What is given stays.
  request_.mutable_families(0)->mutable_direction()->set_x_mm(2.0);
  request_.mutable_families(1)->add_levels(0.5);
  status = Trace();
  ASSERT_TRUE(status.ok()) << status.error_message();
  ASSERT_EQ(response_.sets_size(), 8);
  EXPECT_DOUBLE_EQ(response_.sets(0).direction().x_mm(), 1.0);
  EXPECT_DOUBLE_EQ(response_.sets(7).level(), 0.5);
  request_.mutable_families(0)->set_kind(v1::LINE_KIND_CONTOUR);
  EXPECT_THAT(Trace(), RpcStatusIs(StatusCode::INVALID_ARGUMENT, HasSubstr("families[0].from_normals")));
}

// Meridians and circles of the bowl, which has an umbilic in the middle. A level patch has none.
TEST_F(Lines, CurvatureOfTheBowl) {
  request_.mutable_families(0)->set_kind(v1::LINE_KIND_CURVATURE);
  request_.mutable_families(0)->set_spacing_mm(2);
  ASSERT_TRUE(Trace().ok());
  ASSERT_EQ(response_.sets_size(), 1);
  int closed = 0;
  for (const v1::SurfaceLine& line : response_.sets(0).lines()) {
    const int n = line.patch_index_size();
    double least = 1e9, most = 0, turn = 0;
    for (int k = 0; k < n; ++k) {
      const double x = line.points_mm(3 * k), y = line.points_mm(3 * k + 1);
      least = std::min(least, std::hypot(x, y));
      most = std::max(most, std::hypot(x, y));
      turn = std::max(turn, std::abs(x * line.points_mm(1) - y * line.points_mm(0)) / std::hypot(x, y));
    }
    EXPECT_LT(std::min(most - least, turn), 0.05);
    closed += line.closed();
    if (line.closed()) {
      EXPECT_LT(most, 10.05);  // those that the square does not cut
    }
  }
  EXPECT_GE(closed, 3);
  EXPECT_GT(response_.sets(0).lines_size(), closed + 10);
  for (const v1::Diagnostic& finding : response_.diagnostics()) EXPECT_NE(finding.code(), "CURVATURES_ALIKE");

  auto& points =
      *request_.mutable_source()->mutable_model()->mutable_patches(0)->mutable_bezier()->mutable_points();
  for (int k = 2; k < points.size(); k += 3) points[k] = 0;
  ASSERT_TRUE(Trace().ok());
  EXPECT_EQ(response_.sets(0).lines_size(), 0);
  int found = 0;
  for (const v1::Diagnostic& finding : response_.diagnostics()) found += finding.code() == "CURVATURES_ALIKE";
  EXPECT_EQ(found, 1);
}

TEST_F(Lines, FlowRunsUpTheBowl) {
  request_.mutable_families(0)->set_kind(v1::LINE_KIND_FLOW);
  request_.mutable_families(0)->set_spacing_mm(2);
  request_.add_families()->set_kind(v1::LINE_KIND_SLOPE_FLOW);
  ASSERT_TRUE(Trace().ok());
  ASSERT_EQ(response_.sets_size(), 2);
  EXPECT_GT(response_.sets(0).lines_size(), 10);
  EXPECT_GT(response_.sets(1).lines_size(), 10);
  for (const v1::LineSet& set : response_.sets()) {
    const bool up = set.kind() == v1::LINE_KIND_FLOW;  // slopes get gentler towards the middle
    for (const v1::SurfaceLine& line : set.lines()) {
      const int n = line.patch_index_size();
      const double first = std::atan2(line.points_mm(1), line.points_mm(0));
      for (int k = 1; k < n; ++k) {
        EXPECT_EQ(line.points_mm(3 * k + 2) > line.points_mm(3 * k - 1), up);
        const double r = std::hypot(line.points_mm(3 * k), line.points_mm(3 * k + 1));
        const double turned = std::atan2(line.points_mm(3 * k + 1), line.points_mm(3 * k)) - first;
        EXPECT_NEAR(r * std::sin(turned), 0.0, 0.02);
      }
    }
  }
}

// Refused by number before they fill the memory: 1000 levels of some thousand points each.
TEST_F(Lines, MorePointsThanAnAnswerHoldsAreRefused) {
  v1::LineFamily& contours = *request_.mutable_families(0);
  for (int k = 0; k < 1000; ++k) contours.add_levels(4.0 + 1e-3 * k);
  request_.set_tolerance_mm(1e-6);
  EXPECT_THAT(Trace(), RpcStatusIs(StatusCode::RESOURCE_EXHAUSTED, HasSubstr("line_points")));
  contours.clear_levels();
  contours.set_kind(v1::LINE_KIND_FLOW);
  contours.set_spacing_mm(0.03);
  EXPECT_THAT(Trace(), RpcStatusIs(StatusCode::RESOURCE_EXHAUSTED, HasSubstr("spacing")));
}

TEST_F(Lines, WrongFields) {
  const v1::TraceLinesRequest good = request_;
  const auto message = [&](auto spoil) {
    request_ = good;
    spoil(request_);
    const grpc::Status status = Trace();
    EXPECT_EQ(status.error_code(), StatusCode::INVALID_ARGUMENT);
    return status.error_message();
  };
  EXPECT_THAT(message([](auto& r) { r.clear_families(); }), HasSubstr("families is missing"));
  EXPECT_THAT(message([](auto& r) { r.mutable_families(0)->clear_kind(); }),
              HasSubstr("families[0].kind is missing"));
  EXPECT_THAT(message([](auto& r) { r.mutable_families(0)->set_kind(static_cast<v1::LineKind>(99)); }),
              HasSubstr("families[0].kind = 99"));
  EXPECT_THAT(message([](auto& r) { r.mutable_families(0)->mutable_direction(); }),
              HasSubstr("families[0].direction = (0, 0, 0); must be finite and longer than 0"));
  EXPECT_THAT(message([](auto& r) { r.mutable_families(0)->add_levels(NAN); }),
              HasSubstr("families[0].levels[0] = nan"));
  EXPECT_THAT(message([](auto& r) { r.mutable_families(0)->set_count(0); }),
              HasSubstr("families[0].count = 0; must be in [1, 1000]"));
  EXPECT_THAT(message([](auto& r) {
                r.mutable_families(0)->set_kind(v1::LINE_KIND_EQUI_SLOPE);
                r.mutable_families(0)->add_levels(90);
              }),
              HasSubstr("families[0].levels[0] = 90; must be in (0, 90)"));
  EXPECT_THAT(message([](auto& r) {
                r.mutable_families(0)->set_kind(v1::LINE_KIND_SILHOUETTE);
                r.mutable_families(0)->add_levels(1);
              }),
              HasSubstr("lines of this kind have no levels"));
  EXPECT_THAT(message([](auto& r) { r.mutable_families(0)->set_kind(v1::LINE_KIND_EYE_SILHOUETTE); }),
              HasSubstr("families[0].eye is missing"));
  EXPECT_THAT(message([](auto& r) {
                r.mutable_families(0)->set_kind(v1::LINE_KIND_HIGHLIGHT);
                r.mutable_families(0)->mutable_across()->set_z_mm(3);
              }),
              HasSubstr("families[0].across runs along the direction"));
  EXPECT_THAT(message([](auto& r) {
                r.mutable_families(0)->set_kind(v1::LINE_KIND_FLOW);
                r.mutable_families(0)->set_spacing_mm(-1);
              }),
              HasSubstr("families[0].spacing_mm = -1; must be in (0, 1000]"));
  EXPECT_THAT(message([](auto& r) { r.set_tolerance_mm(0); }), HasSubstr("tolerance_mm = 0; must be in"));
  EXPECT_THAT(message([](auto& r) { r.set_min_loop_mm(1e9); }), HasSubstr("min_loop_mm = 1000000000"));
}

class Evaluations : public ::testing::Test {
 protected:
  Evaluations() { *request_.mutable_source()->mutable_model() = Bowl(); }
  grpc::Status Evaluate() {
    grpc::ClientContext context;
    response_.Clear();
    return embedded_.analysis->EvaluateSurface(&context, request_, &response_);
  }
  void Add(int patch, double u, double v) {
    request_.add_patch_index(patch);
    request_.add_uv(u);
    request_.add_uv(v);
  }
  Embedded embedded_;
  v1::EvaluateSurfaceRequest request_;
  v1::EvaluateSurfaceResponse response_;
};

TEST_F(Evaluations, ABowlInClosedForm) {
  request_.mutable_setup()->mutable_program_zero()->set_y_mm(-1.0);
  Add(0, 0.5, 0.5);
  Add(0, 0.8, 0.5);
  const grpc::Status status = Evaluate();
  ASSERT_TRUE(status.ok()) << status.error_message();
  EXPECT_THAT(response_.points_mm(),
              ElementsAre(0, 1, 0, ::testing::DoubleNear(6, 1e-12), 1, ::testing::DoubleNear(1.8, 1e-12)));
  EXPECT_EQ(response_.normals_size(), 6);
  EXPECT_NEAR(response_.normals(2), 1.0, 1e-15);
  // z = x^2 / 20: k = z'' / (1 + z'^2)^(3/2) along x, z'' / (1 + z'^2)^(1/2) around; z' = 0.6 at x = 6.
  EXPECT_NEAR(response_.principal_curvatures_per_mm(0), 0.1, 1e-12);
  EXPECT_NEAR(response_.principal_curvatures_per_mm(1), 0.1, 1e-12);
  EXPECT_NEAR(response_.principal_curvatures_per_mm(2), 0.1 / std::pow(1.36, 1.5), 1e-12);
  EXPECT_NEAR(response_.principal_curvatures_per_mm(3), 0.1 / std::sqrt(1.36), 1e-12);
  // E = |S_u|^2 with x = 20 u - 10.
  EXPECT_NEAR(response_.first_form_mm2(3), 400 * 1.36, 1e-9);
  EXPECT_NEAR(response_.first_form_mm2(4), 0.0, 1e-9);
  EXPECT_NEAR(response_.first_form_mm2(5), 400, 1e-9);
  EXPECT_NEAR(response_.second_form_mm(3), 400 * 0.1 / std::sqrt(1.36), 1e-9);
  EXPECT_NEAR(response_.du_mm(3), 20, 1e-12);
  EXPECT_NEAR(response_.du_mm(5), 12, 1e-12);
  EXPECT_NEAR(response_.dv_mm(4), 20, 1e-12);
}

// Knots are no parameters. The places of a spline with knots from 5 to 25 are in [0,1], as for any patch.
TEST_F(Evaluations, ASplineWhoseKnotsAreFarFromZeroAndOne) {
  v1::PatchModel& model = *request_.mutable_source()->mutable_model();
  model.clear_patches();
  v1::BsplinePatch& spline = *model.add_patches()->mutable_bspline();
  spline.set_degree_u(1);
  spline.set_degree_v(1);
  for (const double knot : {5, 5, 10, 25, 25}) spline.add_knots_u(knot);
  for (const double knot : {-3, -3, 3, 3}) spline.add_knots_v(knot);
  for (const auto& [x, z] : {std::pair(0.0, 0.0), std::pair(10.0, 2.0), std::pair(40.0, 0.0)}) {
    for (const double y : {0.0, 8.0}) {
      for (const double value : {x, y, z}) spline.add_points(value);
    }
  }
  Add(0, 0.125, 0.5);  // knot 7.5
  Add(0, 1.0, 1.0);
  const grpc::Status status = Evaluate();
  ASSERT_TRUE(status.ok()) << status.error_message();
  const auto near = [](double x) { return ::testing::DoubleNear(x, 1e-12); };
  EXPECT_THAT(response_.points_mm(), ElementsAre(near(5), near(4), near(1), near(40), near(8), near(0)));
  request_.set_uv(0, 7.5);
  EXPECT_THAT(Evaluate(),
              RpcStatusIs(StatusCode::INVALID_ARGUMENT,
                          HasSubstr("uv[0] and the next = (7.5, 0.5); must be in [0, 1] x [0, 1]")));
}

TEST_F(Evaluations, WrongPlaces) {
  EXPECT_THAT(Evaluate(), RpcStatusIs(StatusCode::INVALID_ARGUMENT, HasSubstr("patch_index is missing")));
  Add(0, 0.5, 0.5);
  Add(1, 0.5, 0.5);
  EXPECT_THAT(Evaluate(),
              RpcStatusIs(StatusCode::INVALID_ARGUMENT, HasSubstr("patch_index[1] = 1; must be in [0, 0]")));
  request_.set_patch_index(1, 0);
  request_.set_uv(2, 1.5);
  EXPECT_THAT(Evaluate(),
              RpcStatusIs(StatusCode::INVALID_ARGUMENT,
                          HasSubstr("uv[2] and the next = (1.5, 0.5); must be in [0, 1] x [0, 1]")));
  request_.set_uv(2, NAN);
  EXPECT_THAT(Evaluate(), RpcStatusIs(StatusCode::INVALID_ARGUMENT, HasSubstr("uv[2]")));
  request_.add_uv(0.5);
  EXPECT_THAT(Evaluate(), RpcStatusIs(StatusCode::INVALID_ARGUMENT,
                                      HasSubstr("uv has 5 numbers; must have two for each of 2 points")));
}

// At x = 6, y = 0 of the bowl the slope is 0.6. The contour is a circle of radius 6, square to the meridian.
TEST(Evaluate, HasDirectionsAndContourCurvature) {
  const Embedded embedded;
  v1::EvaluateSurfaceRequest request;
  *request.mutable_source()->mutable_model() = Bowl();
  request.add_patch_index(0);
  request.add_uv(0.8);
  request.add_uv(0.5);
  grpc::ClientContext context;
  v1::EvaluateSurfaceResponse response;
  const grpc::Status status = embedded.analysis->EvaluateSurface(&context, request, &response);
  ASSERT_TRUE(status.ok()) << status.error_message();
  const double root = std::sqrt(1.36), contour = 0.1 / root;
  ASSERT_EQ(response.principal_directions_size(), 6);
  EXPECT_NEAR(std::abs(response.principal_directions(0)), 1.0 / root, 1e-12);  // the meridian bends less
  EXPECT_NEAR(response.principal_directions(1), 0.0, 1e-12);
  EXPECT_NEAR(std::abs(response.principal_directions(2)), 0.6 / root, 1e-12);
  EXPECT_NEAR(std::abs(response.principal_directions(4)), 1.0, 1e-12);
  ASSERT_EQ(response.contour_curvatures_per_mm_size(), 1);
  EXPECT_NEAR(response.contour_curvatures_per_mm(0), contour, 1e-12);
  ASSERT_EQ(response.contour_determinants_mm3_size(), 1);
  EXPECT_NEAR(response.contour_determinants_mm3(0), 20 * 20 * 12 * 12 * contour, 1e-7);
}

}  // namespace
}  // namespace patchmill
