// EditModel through the wire: every edit, units, what stays, refusals.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <google/protobuf/util/json_util.h>
#include <google/protobuf/util/message_differencer.h>
#include <gtest/gtest.h>

#include "server/convert/model.h"
#include "tests/service/embedded.h"
#include "tests/service/line_sheet.h"
#include "tests/service/status_matchers.h"

namespace patchmill {
namespace {

using google::protobuf::util::MessageDifferencer;
using grpc::StatusCode;
using ::testing::ElementsAre;
using testing::Embedded;
using ::testing::HasSubstr;
using testing::RpcStatusIs;

grpc::Status Edit(const v1::EditModelRequest& request, v1::EditModelResponse* response) {
  static Embedded embedded;
  grpc::ClientContext context;
  return embedded.model->EditModel(&context, request, response);
}

// 4 x 4 vertices with lines, G2-Gregory faces, in the given unit.
v1::EditModelRequest Sheet(v1::LengthUnit unit = v1::LENGTH_UNIT_MILLIMETER) {
  v1::EditModelRequest request;
  *request.mutable_source()->mutable_model() = testing::SheetModel(4, unit);
  return request;
}

void AddEdits(v1::EditModelRequest& request, const std::string& json) {
  v1::EditModelRequest edits;
  const auto status = google::protobuf::util::JsonStringToMessage("{\"edits\": [" + json + "]}", &edits);
  ASSERT_TRUE(status.ok()) << std::string(status.message());
  for (const v1::ModelEdit& edit : edits.edits()) *request.add_edits() = edit;
}

TEST(EditModel, WithoutEditsTheModelComesBackAsItWent) {
  v1::EditModelRequest request = Sheet(v1::LENGTH_UNIT_INCH);
  request.set_continuity_steps(20);
  v1::EditModelResponse response;
  ASSERT_TRUE(Edit(request, &response).ok());
  EXPECT_TRUE(MessageDifferencer::Equals(response.model(), request.source().model()));
  EXPECT_EQ(response.changed_faces_size(), 0);
  EXPECT_FALSE(response.has_patches());
  EXPECT_EQ(response.diagnostics_size(), 0);
  ASSERT_EQ(response.joints_size(), 12);
  for (const v1::EdgeContinuity& joint : response.joints()) {
    EXPECT_LE(joint.max_angle_deg(), 1e-9);
    EXPECT_GT(joint.max_curvature_per_mm(), 0.0);
    EXPECT_LE(joint.max_curvature_gap_per_mm(), 1e-9 * joint.max_curvature_per_mm());
  }
}

TEST(EditModel, EditsReachTheSurfaceInTheModelsUnit) {
  for (const auto unit : {v1::LENGTH_UNIT_MILLIMETER, v1::LENGTH_UNIT_INCH}) {
    const double mm = *MillimetersPer(unit);
    v1::EditModelRequest request = Sheet(unit);
    AddEdits(
        request,
        fmt::format(
            R"({{"set_control": {{"start": 5, "end": 6, "control": {{"face": 4, "first_derivative": [{0}, {1}, {1}]}}}}}},
                                     {{"bend_section": {{"start": 9, "end": 10, "face": 4, "curvature": {2}}}}})",
            10 / mm, 1 / mm, 0.04 * mm));
    request.set_with_patches(true);
    v1::EditModelResponse response;
    const grpc::Status status = Edit(request, &response);
    ASSERT_TRUE(status.ok()) << status.error_message();
    EXPECT_EQ(response.diagnostics_size(), 0);
    EXPECT_THAT(response.changed_faces(), ElementsAre(1, 4, 7));
    EXPECT_EQ(response.model().length_unit(), unit);
    ASSERT_EQ(response.model().network().controls_size(), 2);
    EXPECT_NEAR(response.model().network().controls(0).control().first_derivative(0), 10 / mm, 1e-13);
    ASSERT_EQ(response.patches().patches_size(), 9);
    const auto patches = FromProto(response.patches(), "m");
    ASSERT_TRUE(patches.ok() && patches->faults.empty());
    // Face 4 has the vertices 5 9 10 6 from some corner on: its middle edges by place.
    const v1::NetworkFace& face = request.source().model().network().faces(4);
    int met = 0;
    for (int side = 0; side < 4; ++side) {
      const int a = face.vertices(side), b = face.vertices((side + 1) % 4);
      if (std::minmax(a, b) != std::minmax(5, 6)) continue;
      const double u = side == 1 ? 1 : side == 3 ? 0 : 0.5, v = side == 0 ? 0 : side == 2 ? 1 : 0.5;
      const SurfaceJet s = Evaluate(patches->model.patches[4].shape, u, v);
      const Vec3 inward = (side == 0 || side == 3 ? 1 : -1) * (side % 2 == 0 ? s.dv : s.du);
      EXPECT_LE((inward - Vec3(10, 1, 1)).norm(), 1e-12);
      ++met;
    }
    EXPECT_EQ(met, 1);
    // The answer edits on: the same again, from the edited model, changes nothing more.
    v1::EditModelRequest again;
    *again.mutable_source()->mutable_model() = response.model();
    v1::EditModelResponse same;
    ASSERT_TRUE(Edit(again, &same).ok());
    EXPECT_TRUE(MessageDifferencer::Equals(same.model(), response.model()));
  }
}

TEST(EditModel, EveryKindOfEdit) {
  v1::EditModelRequest request = Sheet();
  for (int f = 0; f < 9; ++f) {  // a push is for twists
    if (f != 4)
      request.mutable_source()->mutable_model()->mutable_network()->mutable_faces(f)->clear_scheme();
  }
  request.mutable_source()->mutable_model()->mutable_network()->clear_lines();
  AddEdits(request, R"({"push_face": {"face": 0, "push": {"u": 0.5, "v": 0.5, "amount": 0.02}}},
                       {"turn_normal": {"vertex": 15, "direction": [0.1, 0, 1]}},
                       {"turn_normal": {"vertex": 12, "face": 6, "direction": [0, 0.1, 1]}})");
  v1::EditModelResponse response;
  grpc::Status status = Edit(request, &response);
  ASSERT_TRUE(status.ok()) << status.error_message();
  EXPECT_TRUE(response.model().network().faces(0).has_push());
  EXPECT_EQ(response.model().network().vertices(15).normals_size(), 1);
  EXPECT_THAT(response.model().network().vertices(12).normals(0).faces(), ElementsAre(6));
  EXPECT_EQ(response.diagnostics_size(), 4);  // face 4 gets tangent planes only

  request = Sheet();
  AddEdits(
      request,
      R"({"guide_row": {"edges": [{"start": 1, "end": 2}, {"start": 5, "end": 6}, {"start": 9, "end": 10}],
                                      "start_direction": [1, 0, 0.2]}},
                       {"move_control_point": {"start": 5, "end": 6, "face": 1, "point": 2, "position": [4, 18, 3]}})");
  response.Clear();
  status = Edit(request, &response);
  ASSERT_TRUE(status.ok()) << status.error_message();
  EXPECT_EQ(response.diagnostics_size(), 0);
  EXPECT_THAT(response.changed_faces(), ElementsAre(1, 4, 7));
}

Vec3 Point(const google::protobuf::RepeatedField<double>& numbers) {
  return numbers.size() == 3 ? Vec3(numbers[0], numbers[1], numbers[2]) : Vec3::Constant(kInfinity);
}

TEST(EditModel, GoalsAreReachedInTheModelsUnitAndReported) {
  for (const auto unit : {v1::LENGTH_UNIT_MILLIMETER, v1::LENGTH_UNIT_INCH}) {
    const double mm = *MillimetersPer(unit);
    v1::EditModelRequest request = Sheet(unit);
    request.set_with_patches(true);
    v1::EditModelResponse before;
    ASSERT_TRUE(Edit(request, &before).ok());
    AddEdits(request, fmt::format(R"({{"reach_goals": {{"points": [
        {{"face": 4, "u": 0.2, "v": 0.8, "distance": {0}}}, {{"face": 1, "u": 0.5, "v": 0.5, "to": [5, 18, 9]}},
        {{"face": 1, "u": 0.5, "v": 0.5, "to": [5, 18, 8]}}]}}}})",
                                  1.0 / mm));
    v1::EditModelResponse response;
    const grpc::Status status = Edit(request, &response);
    ASSERT_TRUE(status.ok()) << status.error_message();
    EXPECT_THAT(response.changed_faces(), ElementsAre(1, 4));
    const auto old = FromProto(before.patches(), "m"), made = FromProto(response.patches(), "m");
    ASSERT_TRUE(old.ok() && made.ok() && made->faults.empty());
    const SurfaceJet s = Evaluate(old->model.patches[4].shape, 0.2, 0.8);
    const Vec3 wanted = s.p + s.du.cross(s.dv).normalized();
    EXPECT_LE((Position(made->model.patches[4].shape, 0.2, 0.8) - wanted).norm(), 1e-9);
    EXPECT_LE((Position(made->model.patches[1].shape, 0.5, 0.5) - mm * Vec3(5, 18, 8.5)).norm(), 1e-9);
    ASSERT_EQ(response.goals_size(), 3);
    EXPECT_EQ(response.goals(0).field(), "edits[0].reach_goals.points[0]");
    EXPECT_LE((mm * Point(response.goals(0).reached()) - wanted).norm(), 1e-9);
    EXPECT_FALSE(response.goals(0).missed());
    EXPECT_NEAR(response.goals(2).distance(), 0.5, 1e-12);
    EXPECT_TRUE(response.goals(2).missed());
    ASSERT_EQ(response.diagnostics_size(), 2);
    EXPECT_EQ(response.diagnostics(1).code(), "GOAL_NOT_REACHED");
    EXPECT_THAT(response.diagnostics(1).message(), HasSubstr("edits[0].reach_goals.points[2] comes to"));
    v1::EditModelRequest again;  // the answer edits on
    *again.mutable_source()->mutable_model() = response.model();
    again.set_with_patches(true);
    v1::EditModelResponse same;
    ASSERT_TRUE(Edit(again, &same).ok());
    EXPECT_TRUE(MessageDifferencer::Equals(same.model(), response.model()));
    EXPECT_TRUE(MessageDifferencer::Equals(same.patches(), response.patches()));
  }
}

TEST(EditModel, VerticesMoveAndEdgesBecomeCreases) {
  v1::EditModelRequest request = Sheet(v1::LENGTH_UNIT_INCH);
  AddEdits(request, R"({"move_vertex": {"vertex": 5, "by": [0, 0, 0.1]}},
                       {"set_crease": {"start": 10, "end": 9, "crease": true}},
                       {"reach_goals": {"edges": [{"start": 0, "end": 1, "through": [0.05, 0.25, 0.2]}]}})");
  v1::EditModelResponse response;
  const grpc::Status status = Edit(request, &response);
  ASSERT_TRUE(status.ok()) << status.error_message();
  const v1::CurveNetwork &was = request.source().model().network(), &is = response.model().network();
  EXPECT_LE((Point(is.vertices(5).position()) - Point(was.vertices(5).position()) - Vec3(0, 0, 0.1)).norm(),
            1e-12);
  EXPECT_EQ(is.lines_size(), was.lines_size() - 1);
  ASSERT_EQ(is.edges_size(), 3);  // those of the line through 8 9 10 11
  EXPECT_FALSE(is.edges(0).crease());
  EXPECT_TRUE(is.edges(1).crease());
  EXPECT_EQ(is.edges(1).bezier().points_size(), 12);
  ASSERT_EQ(response.goals_size(), 1);
  EXPECT_FALSE(response.goals(0).missed());
  EXPECT_NE(Point(is.vertices(0).position()), Point(was.vertices(0).position()));
}

TEST(EditModel, RowsAreSplitAndTheAnswerEditsOn) {
  v1::EditModelRequest request = Sheet(v1::LENGTH_UNIT_INCH);
  AddEdits(request, R"({"split_faces": {"start": 5, "end": 6, "parameter": 0.4}})");
  request.set_with_patches(true);
  request.set_continuity_steps(20);
  v1::EditModelResponse response;
  const grpc::Status status = Edit(request, &response);
  ASSERT_TRUE(status.ok()) << status.error_message();
  ASSERT_EQ(response.diagnostics_size(), 1);
  EXPECT_EQ(response.diagnostics(0).code(), "FACES_SPLIT");
  EXPECT_THAT(response.diagnostics(0).message(), HasSubstr("edits[0].split_faces makes 6 faces of 3"));
  EXPECT_EQ(response.model().network().faces_size(), 12);
  EXPECT_EQ(response.model().network().vertices_size(), 20);
  EXPECT_EQ(response.patches().patches_size(), 12);
  EXPECT_THAT(response.changed_faces(), ::testing::IsSupersetOf({1, 4, 7, 9, 10, 11}));
  ASSERT_EQ(response.joints_size(), 17);
  for (const v1::EdgeContinuity& joint : response.joints()) {
    EXPECT_LE(joint.max_curvature_gap_per_mm(), 1e-8 * joint.max_curvature_per_mm());
  }
  v1::EditModelRequest again;
  *again.mutable_source()->mutable_model() = response.model();
  again.set_with_patches(true);
  v1::EditModelResponse same;
  ASSERT_TRUE(Edit(again, &same).ok());
  EXPECT_EQ(same.diagnostics_size(), 0);
  const auto a = FromProto(response.patches(), "m"), b = FromProto(same.patches(), "m");
  ASSERT_TRUE(a.ok() && b.ok());
  for (std::size_t f = 0; f < 12; ++f) {
    EXPECT_LE((Position(a->model.patches[f].shape, 0.3, 0.6) - Position(b->model.patches[f].shape, 0.3, 0.6))
                  .norm(),
              1e-11);
  }
}

TEST(EditModel, ACutIsTakenAwayWithItsCurve) {
  v1::EditModelRequest request = Sheet();
  v1::CurveNetwork& network = *request.mutable_source()->mutable_model()->mutable_network();
  network.clear_lines();
  for (v1::NetworkFace& face : *network.mutable_faces()) face.clear_scheme();
  v1::EditModelRequest cut = request;
  for (const auto& [start, end] : {std::pair(0, 5), std::pair(5, 6)}) {
    v1::NetworkEdge& edge = *cut.mutable_source()->mutable_model()->mutable_network()->add_edges();
    edge.set_id(std::to_string(start));
    edge.set_start(start);
    edge.set_end(end);
  }
  v1::FaceCut& made = *cut.mutable_source()->mutable_model()->mutable_network()->mutable_faces(0)->add_cuts();
  made.set_start(0);
  made.set_end(5);
  AddEdits(cut, R"({"cut_face": {"face": 0, "start": 5, "end": 0, "remove": true}})");
  v1::EditModelResponse response;
  const grpc::Status status = Edit(cut, &response);
  ASSERT_TRUE(status.ok()) << status.error_message();
  EXPECT_EQ(response.model().network().faces(0).cuts_size(), 0);
  ASSERT_EQ(response.model().network().edges_size(), 1);
  EXPECT_EQ(response.model().network().edges(0).id(), "5");
}

TEST(EditModel, MeasuredPointsAreFitted) {
  v1::EditModelRequest request = Sheet(v1::LENGTH_UNIT_INCH);
  AddEdits(request, R"({"fit_points": {"points": [0.6, 0.7, 0.2, 0.5, 0.7, 0.2], "band": 0.01}},
                       {"cut_face": {"face": 0, "start": 0, "end": 5}})");
  v1::EditModelResponse response;
  const grpc::Status status = Edit(request, &response);
  ASSERT_TRUE(status.ok()) << status.error_message();
  ASSERT_EQ(response.goals_size(), 2);
  EXPECT_EQ(response.goals(1).field(), "edits[0].fit_points.points[1]");
  EXPECT_LE(response.goals(1).distance(), 0.0101);
  EXPECT_EQ(response.model().network().faces(0).cuts_size(), 1);
}

TEST(EditModel, WhatCannotBeDoneIsRefusedWithItsPath) {
  const auto refused = [](const std::string& edit, const std::string& text) {
    v1::EditModelRequest request = Sheet();
    AddEdits(request, edit);
    v1::EditModelResponse response;
    EXPECT_THAT(Edit(request, &response), RpcStatusIs(StatusCode::INVALID_ARGUMENT, HasSubstr(text)));
  };
  refused("{}", "edits[0]");
  refused(R"({"push_face": {"face": 12, "push": {}}})", "edits[0].push_face.face = 12; must be in [0, 8]");
  refused(R"({"push_face": {"face": 1}})", "edits[0].push_face.push");
  refused(R"({"turn_normal": {"vertex": 1, "direction": [1, 2]}})",
          "edits[0].turn_normal.direction has 2 numbers");
  refused(R"({"guide_row": {"edges": [{"start": 1, "end": 2}]}})",
          "edits[0].guide_row.edges are 1; must be at least 2");
  refused(R"({"reach_goals": {"points": [{"face": 1, "u": 0.5, "v": 0.5}]}})",
          "edits[0].reach_goals.points[0] has neither distance nor to; must have one of them");
  refused(R"({"reach_goals": {"points": [{"face": 1, "distance": 1}]}})",
          "edits[0].reach_goals.points[0].u gives the place (0, 0)");
  refused(R"({"reach_goals": {"edges": [{"start": 0, "end": 1, "through": [1, 2]}]}})",
          "edits[0].reach_goals.edges[0].through has 2 numbers");
  refused(R"({"reach_goals": {}})", "edits[0].reach_goals has no goals");
  refused(R"({"move_vertex": {"vertex": 1, "by": [1, 2, 3], "position": [1, 2, 3]}})",
          "edits[0].move_vertex has both position and by");
  refused(R"({"split_faces": {"start": 0, "end": 1, "parameter": 1}})", "edits[0].split_faces.parameter = 1");
  refused(R"({"cut_face": {"face": 0, "start": 0, "end": 15}})", "edits[0].cut_face names vertex 15");
  refused(R"({"fit_points": {"points": [1, 2]}})", "edits[0].fit_points.points has 2 numbers");
  refused(R"({"set_crease": {"start": 0, "end": 15}})", "edits[0].set_crease names the edge 0 15");
  v1::EditModelRequest request = Sheet();
  v1::EditModelResponse response;
  request.mutable_source()->mutable_model()->clear_network();
  request.mutable_source()->mutable_model()->add_patches();
  EXPECT_THAT(Edit(request, &response), RpcStatusIs(StatusCode::INVALID_ARGUMENT, HasSubstr("no network")));
  request = Sheet();
  request.set_continuity_steps(-1);
  EXPECT_THAT(Edit(request, &response),
              RpcStatusIs(StatusCode::INVALID_ARGUMENT, HasSubstr("continuity_steps = -1")));
  request = Sheet();
  for (int k = 0; k < 1001; ++k) request.add_edits();
  EXPECT_THAT(Edit(request, &response),
              RpcStatusIs(StatusCode::RESOURCE_EXHAUSTED, HasSubstr("edits = 1001")));
  request = Sheet();
  request.mutable_source()->mutable_file()->set_format("bpt");
  request.mutable_source()->mutable_file()->set_content("1");
  EXPECT_THAT(Edit(request, &response),
              RpcStatusIs(StatusCode::INVALID_ARGUMENT, HasSubstr("must be json or pb")));
}

// An edit may spoil the network: the findings say so, and the model comes back for the user to see.
TEST(EditModel, ASpoiledNetworkComesBackWithFindings) {
  v1::EditModelRequest request = Sheet();
  AddEdits(request, R"({"push_face": {"face": 0, "push": {"u": 0.5, "v": 0.5, "amount": 1}}})");
  v1::EditModelResponse response;
  ASSERT_TRUE(Edit(request, &response).ok());
  ASSERT_EQ(response.diagnostics_size(), 1);
  EXPECT_EQ(response.diagnostics(0).code(), "UNSUPPORTED_SCHEME");
  EXPECT_TRUE(response.model().network().faces(0).has_push());
  EXPECT_EQ(response.joints_size(), 0);
}

}  // namespace
}  // namespace patchmill
