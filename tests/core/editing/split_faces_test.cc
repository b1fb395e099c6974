// Faces split in rows: the curves stay, the surface nearly, and joints are as smooth as before.
#include "core/editing/split_faces.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "core/base/index.h"
#include "core/editing/edit_network.h"
#include "core/joining/continuity.h"
#include "core/network/control_points.h"
#include "tests/core/joining/networks.h"
#include "tests/support/known_surfaces.h"

namespace patchmill {
namespace {

EditedNetwork Edited(const CurveNetwork& network, const std::vector<NetworkEdit>& edits) {
  const auto edited = EditNetwork(network, edits);
  EXPECT_TRUE(edited.ok()) << edited.status();
  return *edited;
}

JoinedNetwork Join(const CurveNetwork& network) {
  JoinedNetwork joined = JoinNetwork(network);
  EXPECT_TRUE(joined.findings.empty()) << testing::Text(joined.findings);
  return joined;
}

void ExpectSmooth(const JoinedNetwork& joined, bool curvature) {
  auto network = BuildNetwork(joined.model);
  ASSERT_TRUE(network.ok());
  const auto continuity = MeasureContinuity(*network, 30, RunContext(1));
  ASSERT_TRUE(continuity.ok());
  for (const EdgeContinuity& e : continuity->edges) {
    EXPECT_LE(e.max_gap, 1e-11);
    EXPECT_LE(e.max_angle, 1e-10);
    if (curvature) {
      EXPECT_LE(e.max_curvature_gap, 1e-8 * e.max_curvature);
    }
  }
}

// A plane grid of Gregory quads on the bicubic z = x y (1-x)(1-y)/50 and others, from its true derivatives.
CurveNetwork Waves(PatchScheme scheme) {
  CurveNetwork network;
  for (int j = 0; j < 3; ++j) {
    for (int i = 0; i < 4; ++i) {
      NetworkVertex vertex;
      vertex.position = Vec3(20.0 * i, 15.0 * j, 2.0 * std::sin(1.1 * i) * std::cos(0.9 * j));
      const double dx = 2.2 * std::cos(1.1 * i) * std::cos(0.9 * j) / 20.0,
                   dy = -1.8 * std::sin(1.1 * i) * std::sin(0.9 * j) / 15.0;
      vertex.normals = {{Vec3(-dx, -dy, 1.0), {}}};
      network.vertices.push_back(vertex);
    }
  }
  for (const int corner : {0, 1, 2, 4, 5, 6}) {
    network.faces.push_back(
        {"f" + std::to_string(corner), {corner, corner + 1, corner + 5, corner + 4}, scheme});
  }
  return network;
}

double Change(const EditedNetwork& edited) {
  EXPECT_EQ(edited.findings.size(), 1u);
  EXPECT_EQ(edited.findings[0].code, "FACES_SPLIT");
  const std::string& text = edited.findings[0].message;
  return std::stod(text.substr(text.find("up to ") + 6));
}

TEST(SplitEdit, CutsARowFromBorderToBorder) {
  for (const PatchScheme scheme : {PatchScheme::kGregory, PatchScheme::kBrown}) {
    for (const double at : {0.5, 0.3}) {
      const CurveNetwork network = Waves(scheme);
      const EditedNetwork edited = Edited(network, {SplitEdit{{5, 6, at}}});
      EXPECT_EQ(edited.network.faces.size(), 8u);
      EXPECT_EQ(edited.network.vertices.size(), 15u);
      const JoinedNetwork before = Join(network), after = Join(edited.network);
      ExpectSmooth(after, false);
      EXPECT_LE(Change(edited), 0.02);  // of faces of 20 x 15
      // Faces beside the row stay nearly: where the ratio of the lengths across an edge varies along it, the
      // shorter tangents of a half meet its neighbour in another way.
      for (const std::size_t f : {0u, 2u, 3u, 5u}) {
        for (const Vec2& q : {Vec2(0.3, 0.4), Vec2(0.9, 0.1), Vec2(0.05, 0.7)}) {
          EXPECT_LE((Position(before.model.patches[f].shape, q.x(), q.y()) -
                     Position(after.model.patches[f].shape, q.x(), q.y()))
                        .norm(),
                    1e-4);
        }
      }
      // The borders of the halves are those of the face, exactly.
      const PatchShape &whole = before.model.patches[1].shape, &low = after.model.patches[1].shape;
      EXPECT_LE((Position(whole, at * 0.7, 0.0) - Position(low, 0.7, 0.0)).norm(), 1e-13);
      EXPECT_LE((Position(whole, 0.0, 0.7) - Position(low, 0.0, 0.7)).norm(), 1e-13);
    }
  }
}

TEST(SplitEdit, CutsTheOtherWayToo) {
  const CurveNetwork network = Waves(PatchScheme::kGregory);
  const EditedNetwork edited = Edited(network, {SplitEdit{{5, 9, 0.4}}});
  EXPECT_EQ(edited.network.faces.size(), 9u);
  const JoinedNetwork before = Join(network), after = Join(edited.network);
  ExpectSmooth(after, false);
  EXPECT_LE(Change(edited), 0.02);
  EXPECT_LE(
      (Position(before.model.patches[4].shape, 0.0, 0.2) - Position(after.model.patches[4].shape, 0.0, 0.5))
          .norm(),
      1e-13);
}

TEST(SplitEdit, APlaneStaysAPlane) {
  CurveNetwork network = Waves(PatchScheme::kGregory);
  for (NetworkVertex& v : network.vertices) v.position.z() = 0.0, v.normals = {{Vec3::UnitZ(), {}}};
  EXPECT_LE(Change(Edited(network, {SplitEdit{{5, 6, 0.25}}})), 1e-12);
}

TEST(SplitEdit, OfABicubicSheetWithCurvatureKeepsCurvature) {
  const testing::KnownNetwork known = testing::KnownBicubic();
  const JoinedNetwork before = Join(known.network);
  const TableEdge& edge = before.edges[0].topology;
  const EditedNetwork edited = Edited(known.network, {SplitEdit{{edge.start, edge.end, 0.5}}});
  const JoinedNetwork after = Join(edited.network);
  ExpectSmooth(after, true);
  EXPECT_LE(Change(edited), 0.05);  // of 100 x 100
}

TEST(SplitEdit, GoesRoundAClosedRow) {
  // A tube of four quads around and two along.
  CurveNetwork network;
  for (int j = 0; j < 3; ++j) {
    for (int i = 0; i < 4; ++i) {
      const Vec3 out(std::cos(i * M_PI_2), std::sin(i * M_PI_2), 0.0);
      NetworkVertex vertex;
      vertex.position = 10.0 * out + Vec3(0, 0, 12.0 * j);
      vertex.normals = {{out, {}}};
      network.vertices.push_back(vertex);
    }
  }
  for (int j = 0; j < 2; ++j) {
    for (int i = 0; i < 4; ++i) {
      const int next = (i + 1) % 4;
      network.faces.push_back({"", {4 * j + i, 4 * j + next, 4 * j + 4 + next, 4 * j + 4 + i}});
    }
  }
  const EditedNetwork edited = Edited(network, {SplitEdit{{4, 0, 0.5}}});
  EXPECT_EQ(edited.network.faces.size(), 12u);
  EXPECT_EQ(edited.network.vertices.size(), 16u);
  ExpectSmooth(Join(edited.network), false);
  EXPECT_LE(Change(edited), 1e-9);  // straight along: the halves are the same cylinders
}

TEST(CutEdit, IsPutInAndTakenOutAgain) {
  CurveNetwork network = Waves(PatchScheme::kAuto);
  NetworkEdge given;  // the curve of a cut that comes and goes, between two others
  given.start = 5, given.end = 0;
  NetworkEdge other;
  other.start = 5, other.end = 6;
  network.edges = {other};
  const EditedNetwork cut = Edited(network, {CutEdit{0, {0, 5}}});
  EXPECT_EQ(Join(cut.network).model.patches.size(), 7u);
  ExpectSmooth(Join(cut.network), false);
  CurveNetwork with_curve = cut.network;
  with_curve.edges = {given, other};
  const EditedNetwork merged = Edited(with_curve, {CutEdit{0, {5, 0}, true}, CreaseEdit{6, 7}});
  EXPECT_EQ(merged.edge_of, (std::vector<int>{1, -1}));
  EXPECT_TRUE(merged.network.faces[0].cuts.empty());
  const JoinedNetwork again = JoinNetwork(Edited(with_curve, {CutEdit{0, {5, 0}, true}}).network),
                      plain = Join(network);
  for (std::size_t f = 0; f < 6; ++f) {
    EXPECT_EQ(Position(again.model.patches[f].shape, 0.3, 0.4),
              Position(plain.model.patches[f].shape, 0.3, 0.4));
  }
  const std::string refusal(EditNetwork(network, {CutEdit{0, {0, 5}, true}}).status().message());
  EXPECT_EQ(refusal, "edits[0] names the edge 0 5, which is no cut of face 0");
}

TEST(SplitEdit, WhatCannotBeSplitIsRefused) {
  const auto refusal = [](const CurveNetwork& network, const FaceSplit& split) {
    return std::string(EditNetwork(network, {SplitEdit{split}}).status().message());
  };
  CurveNetwork network = Waves(PatchScheme::kGregory);
  EXPECT_NE(refusal(network, {0, 6, 0.5}).find("there is no such edge"), std::string::npos);
  EXPECT_NE(refusal(network, {5, 6, 0.0}).find("edits[0].parameter = 0; must be in [0.05, 0.95]"),
            std::string::npos);
  network.faces[1].bulges = {{0.5, 0.5, Vec3::UnitZ()}};
  EXPECT_NE(refusal(network, {5, 6, 0.5}).find("crosses face 1, which has bulges"), std::string::npos);
  const CurveNetwork cuboctahedron = testing::Cuboctahedron(4);  // quads meet triangles at every edge
  const auto& loop = cuboctahedron.faces[0].vertices;
  EXPECT_NE(refusal(cuboctahedron, {loop[0], loop[1], 0.5}).find("which is no quad"), std::string::npos);
}

}  // namespace
}  // namespace patchmill
