// Preview through the wire: what edits change is what EditModel makes, whatever the server keeps.
#include <algorithm>

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
using ::testing::ElementsAreArray;
using testing::Embedded;
using ::testing::HasSubstr;
using testing::RpcStatusIs;

v1::PatchModel Sheet(v1::LengthUnit unit = v1::LENGTH_UNIT_MILLIMETER) {
  return testing::SheetModel(6, unit);
}

v1::PreviewRequest RequestOf(const v1::PatchModel& model, const std::string& rest) {
  v1::PreviewRequest request;
  const auto status = google::protobuf::util::JsonStringToMessage(rest, &request);
  EXPECT_TRUE(status.ok()) << status.ToString();
  *request.mutable_source()->mutable_model() = model;
  return request;
}

v1::PreviewResponse Show(const Embedded& embedded, const v1::PreviewRequest& request) {
  grpc::ClientContext context;
  v1::PreviewResponse response;
  const grpc::Status status = embedded.analysis->Preview(&context, request, &response);
  EXPECT_TRUE(status.ok()) << status.error_message();
  return response;
}

v1::EditModelResponse Edit(const Embedded& embedded, const v1::PreviewRequest& preview) {
  v1::EditModelRequest request;
  *request.mutable_source() = preview.source();
  *request.mutable_edits() = preview.edits();
  grpc::ClientContext context;
  v1::EditModelResponse response;
  const grpc::Status status = embedded.model->EditModel(&context, request, &response);
  EXPECT_TRUE(status.ok()) << status.error_message();
  return response;
}

constexpr char kEdits[] = R"("edits": [
  {"bend_section": {"start": 14, "end": 15, "face": 12, "curvature": -0.05}},
  {"reach_goals": {"points": [{"face": 6, "u": 0.2, "v": 0.8, "distance": 1.0}]}}])";

TEST(Preview, ShowsOfTheChangedFacesWhatTheEditedModelHas) {
  const Embedded embedded;
  const auto request = RequestOf(
      Sheet(), fmt::format(R"({{{}, "with_controls": true, "with_combs": true, "cells": 7}})", kEdits));
  const v1::PreviewResponse shown = Show(embedded, request);
  const v1::EditModelResponse edited = Edit(embedded, request);
  EXPECT_THAT(shown.changed_faces(), ElementsAreArray(edited.changed_faces()));
  ASSERT_GT(shown.changed_faces_size(), 1);
  ASSERT_LT(shown.changed_faces_size(), 10);
  ASSERT_EQ(shown.goals_size(), 1);
  EXPECT_TRUE(MessageDifferencer::Equals(shown.goals(0), edited.goals(0)));
  EXPECT_EQ(shown.face_count(), 25);

  v1::PreviewRequest whole = RequestOf(
      edited.model(), R"({"all_faces": true, "with_controls": true, "with_combs": true, "cells": 7})");
  const v1::PreviewResponse all = Show(embedded, whole);
  EXPECT_EQ(all.changed_faces_size(), 0);
  ASSERT_EQ(all.patches_size(), 25);
  ASSERT_EQ(shown.patches_size(), shown.changed_faces_size());
  for (const v1::PreviewPatch& patch : shown.patches()) {
    EXPECT_EQ(patch.position_mm_size(), 3 * 8 * 8);
    EXPECT_EQ(patch.middles_size(), 4);
    EXPECT_EQ(patch.combs_size(), 2);
    EXPECT_TRUE(MessageDifferencer::Equals(patch, all.patches(patch.patch_index()))) << patch.face();
  }
  EXPECT_EQ(all.edges_size(), 60);  // 6 rows and 6 columns of 5 edges
  for (const v1::PreviewEdge& edge : shown.edges()) {
    EXPECT_TRUE(std::ranges::any_of(
        edge.faces(), [&](int face) { return std::ranges::count(shown.changed_faces(), face) > 0; }));
    EXPECT_EQ(edge.kind(),
              edge.faces_size() == 1 ? v1::PREVIEW_EDGE_KIND_FREE : v1::PREVIEW_EDGE_KIND_EQUAL_CURVATURE);
  }
}

TEST(Preview, WhatTheServerKeepsChangesNoByte) {
  const Embedded forgets;
  const Embedded keeps(StartEmbeddedServer(ServerOptions()), "");
  const auto request = RequestOf(
      Sheet(),
      fmt::format(
          R"({{{}, "with_combs": true, "families": [{{"kind": "LINE_KIND_HIGHLIGHT", "count": 3}}]}})",
          kEdits));
  const std::string first = Show(forgets, request).SerializeAsString();
  EXPECT_EQ(Show(keeps, request).SerializeAsString(), first);
  EXPECT_EQ(Show(keeps, request).SerializeAsString(), first);
  // Edits of one call leave no trace in the next.
  v1::PreviewRequest none = request;
  none.clear_edits();
  EXPECT_EQ(Show(keeps, none).patches_size(), 0);
}

TEST(Preview, LinesLieOnTheChangedFacesAlone) {
  const Embedded embedded;
  const v1::PreviewResponse shown = Show(
      embedded,
      RequestOf(
          Sheet(),
          fmt::format(R"({{{}, "families": [{{"kind": "LINE_KIND_CONTOUR", "levels": [0, 2]}}]}})", kEdits)));
  ASSERT_EQ(shown.sets_size(), 2);
  int points = 0;
  for (const v1::LineSet& set : shown.sets()) {
    for (const v1::SurfaceLine& line : set.lines()) {
      for (int k = 0; k < line.patch_index_size(); ++k, ++points) {
        EXPECT_NEAR(line.points_mm(3 * k + 2), set.level(), 1e-9);
        EXPECT_EQ(std::ranges::count(shown.changed_faces(), line.patch_index(k)), 1);
      }
    }
  }
  EXPECT_GT(points, 10);
}

// A family that is chosen from the normals is that of the network before the edits, whatever these change.
TEST(Preview, FamiliesFromNormalsStay) {
  const Embedded embedded;
  std::vector<v1::LineSet> first;
  for (const double height : {0.1, 0.5}) {
    const v1::PreviewResponse shown = Show(
        embedded,
        RequestOf(Sheet(), fmt::format(R"({{"edits": [{{"move_vertex": {{"vertex": 14, "by": [0, 0, {}]}}}}],
                       "families": [{{"kind": "LINE_KIND_HIGHLIGHT", "count": 5, "from_normals": true}}]}})",
                                       height)));
    ASSERT_EQ(shown.sets_size(), 5);
    for (int k = 0; k < 5; ++k) {
      if (height == 0.1) {
        first.push_back(shown.sets(k));
        continue;
      }
      EXPECT_EQ(shown.sets(k).level(), first[static_cast<std::size_t>(k)].level());
      EXPECT_TRUE(MessageDifferencer::Equals(shown.sets(k).direction(),
                                             first[static_cast<std::size_t>(k)].direction()));
    }
  }
}

TEST(Preview, PlacesAreInMillimetres) {
  const Embedded embedded;
  const v1::PreviewResponse inch =
      Show(embedded, RequestOf(Sheet(v1::LENGTH_UNIT_INCH), R"({"all_faces": true, "cells": 2})"));
  const v1::PreviewResponse mm = Show(embedded, RequestOf(Sheet(), R"({"all_faces": true, "cells": 2})"));
  ASSERT_EQ(inch.patches_size(), mm.patches_size());
  for (int p = 0; p < mm.patches_size(); ++p) {
    for (int k = 0; k < mm.patches(p).position_mm_size(); ++k) {
      EXPECT_NEAR(inch.patches(p).position_mm(k), mm.patches(p).position_mm(k), 1e-9);
    }
  }
}

// A control point that is shown can be moved where it is shown.
TEST(Preview, AControlPointThatMovesIsShownWhereItWasPut) {
  const Embedded embedded;
  const v1::PatchModel sheet = Sheet();
  const v1::PreviewResponse before =
      Show(embedded, RequestOf(sheet, R"({"all_faces": true, "with_controls": true, "cells": 1})"));
  const v1::MiddleControl& middle = before.patches(12).middles(1);
  const auto request = RequestOf(
      sheet,
      fmt::format(R"({{"with_controls": true, "cells": 1, "edits": [{{"move_control_point": {{"start": {},
                 "end": {}, "face": 12, "point": 2, "position": [{:.17g}, {:.17g}, {:.17g}]}}}}]}})",
                  middle.start(), middle.end(), middle.q2_mm(0), middle.q2_mm(1), middle.q2_mm(2) + 0.3));
  const v1::PreviewResponse after = Show(embedded, request);
  ASSERT_EQ(after.changed_faces_size(), 2);  // and the face across the edge
  const auto face = std::ranges::find(after.patches(), 12, &v1::PreviewPatch::face);
  ASSERT_NE(face, after.patches().end());
  EXPECT_NEAR(face->middles(1).q2_mm(2), middle.q2_mm(2) + 0.3, 1e-9);
  for (int k = 0; k < 3; ++k) {
    EXPECT_NEAR(face->middles(1).q1_mm(k), middle.q1_mm(k), 1e-9);
    EXPECT_NEAR(face->middles(1).q0_mm(k), middle.q0_mm(k), 1e-9);
  }
}

TEST(Preview, RefusesWithThePathOfTheField) {
  const Embedded embedded;
  const auto refused = [&](const std::string& rest, const std::string& text) {
    grpc::ClientContext context;
    v1::PreviewResponse response;
    const grpc::Status status = embedded.analysis->Preview(&context, RequestOf(Sheet(), rest), &response);
    EXPECT_THAT(status, RpcStatusIs(StatusCode::INVALID_ARGUMENT, HasSubstr(text)));
  };
  refused(R"({"cells": 0})", "cells = 0; must be in [1, 64]");
  refused(R"({"cells": 65})", "cells = 65; must be in [1, 64]");
  refused(R"({"families": [{"kind": "LINE_KIND_CONTOUR"}]})", "families[0].levels is missing");
  refused(R"({"families": [{"kind": "LINE_KIND_FLOW"}]})", "families[0].kind = LINE_KIND_FLOW");
  refused(R"({"edits": [{"push_face": {"face": 25, "push": {"u": 0.5, "v": 0.5, "amount": 1}}}]})",
          "edits[0].push_face.face = 25; must be in [0, 24]");
}

// A network that cannot be joined after the edits changes no picture.
TEST(Preview, ABrokenNetworkComesAsAFinding) {
  const Embedded embedded;
  const v1::PreviewResponse shown =
      Show(embedded, RequestOf(Sheet(), R"({"edits": [{"move_vertex": {"vertex": 7, "by": [0, 0, 1e9]}}]})"));
  EXPECT_GT(shown.diagnostics_size(), 0);
  EXPECT_EQ(shown.patches_size(), 0);
  EXPECT_EQ(shown.changed_faces_size(), 0);
}

}  // namespace
}  // namespace patchmill
