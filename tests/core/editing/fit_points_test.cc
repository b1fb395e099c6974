// Measured points: a network moves onto the surface that they come from, and no farther than it must.
#include "core/editing/fit_points.h"

#include <cmath>

#include <gtest/gtest.h>

#include "core/base/index.h"
#include "core/editing/edit_network.h"
#include "core/joining/join_network.h"
#include "tests/core/joining/networks.h"

namespace patchmill {
namespace {

CurveNetwork Sheet() {
  CurveNetwork network;
  for (int j = 0; j < 3; ++j) {
    for (int i = 0; i < 3; ++i) {
      NetworkVertex vertex;
      vertex.position = Vec3(20.0 * i, 15.0 * j, 4.0 - (i - 1) * (i - 1) - 1.5 * (j - 1) * (j - 1));
      vertex.normals = {{Vec3(0.1 * (i - 1), 0.2 * (j - 1), 1.0), {}}};
      network.vertices.push_back(vertex);
    }
  }
  for (const int corner : {0, 1, 3, 4})
    network.faces.push_back({"", {corner, corner + 1, corner + 4, corner + 3}});
  return network;
}

std::vector<Vec3> PointsOn(const CurveNetwork& network, int steps) {
  const JoinedNetwork joined = JoinNetwork(network);
  std::vector<Vec3> points;
  for (const Patch& patch : joined.model.patches) {
    for (int i = 0; i < steps; ++i) {
      for (int j = 0; j < steps; ++j)
        points.push_back(Position(patch.shape, (i + 0.5) / steps, (j + 0.5) / steps));
    }
  }
  return points;
}

EditedNetwork Fitted(const CurveNetwork& network, const PointFit& fit) {
  const auto edited = EditNetwork(network, {FitEdit{fit}});
  EXPECT_TRUE(edited.ok()) << edited.status();
  return *edited;
}

TEST(FitEdit, PointsOnTheSurfaceMoveNothing) {
  const CurveNetwork network = Sheet();
  const EditedNetwork fitted = Fitted(network, {PointsOn(network, 4)});
  EXPECT_TRUE(fitted.findings.empty());
  for (std::size_t v = 0; v < network.vertices.size(); ++v) {
    EXPECT_LE((fitted.network.vertices[v].position - network.vertices[v].position).norm(), 1e-9);
  }
}

TEST(FitEdit, FindsTheNetworkOfThePoints) {
  const CurveNetwork truth = Sheet();
  CurveNetwork bent = truth;
  bent.vertices[4].position.z() += 0.6;
  bent.vertices[1].position.z() -= 0.4;
  bent.vertices[4].normals[0].direction = Vec3(0.05, -0.04, 1.0);
  const EditedNetwork fitted = Fitted(bent, {PointsOn(truth, 5), 1e-3});
  EXPECT_TRUE(fitted.findings.empty()) << testing::Text(fitted.findings);
  ASSERT_EQ(fitted.reached.size(), 100u);
  for (const ReachedGoal& goal : fitted.reached) EXPECT_LE(goal.distance, 1e-3 + 1e-6);
}

TEST(FitEdit, StopsAtTheBand) {
  CurveNetwork flat = Sheet();
  for (NetworkVertex& v : flat.vertices) v.position.z() = 0.0, v.normals = {{Vec3::UnitZ(), {}}};
  std::vector<Vec3> points = PointsOn(flat, 3);
  for (Vec3& p : points) p.z() += 0.5;
  const EditedNetwork fitted = Fitted(flat, {points, 0.2});
  EXPECT_TRUE(fitted.findings.empty()) << testing::Text(fitted.findings);
  for (const ReachedGoal& goal : fitted.reached) {
    EXPECT_LE(goal.distance, 0.2 + 1e-6);
    EXPECT_GE(goal.distance, 0.1);  // and not much farther than that
  }
  EXPECT_TRUE(
      Fitted(flat, {points, 0.6}).network.faces[0].bulges.empty());  // all lie within the band already
}

TEST(FitEdit, SaysWhichPointsItCannotMeet) {
  std::vector<Vec3> points = PointsOn(Sheet(), 6);
  points.resize(36);  // of one face, which has 13 unknowns
  for (std::size_t k = 0; k < points.size(); ++k) points[k].z() += (k + k / 6) % 2 == 0 ? 0.5 : -0.5;
  const EditedNetwork fitted = Fitted(Sheet(), {points, 0.1});
  std::size_t missed = 0;
  for (const ReachedGoal& goal : fitted.reached) missed += goal.missed;
  EXPECT_GE(missed, 10u);
  ASSERT_EQ(fitted.findings.size(), missed);
  for (const Diagnostic& finding : fitted.findings) EXPECT_EQ(finding.code, "GOAL_NOT_REACHED");
  EXPECT_EQ(fitted.findings[0].where.field.find("edits[0].points["), 0u);
}

TEST(FitEdit, WhatCannotBeFittedIsRefused) {
  const auto refusal = [](const PointFit& fit) {
    return std::string(EditNetwork(Sheet(), {FitEdit{fit}}).status().message());
  };
  EXPECT_EQ(refusal({}), "edits[0].points are missing");
  EXPECT_NE(refusal({{Vec3(1, 2, kInfinity)}}).find("edits[0].points[0] must be finite"), std::string::npos);
  EXPECT_NE(refusal({{Vec3(1, 2, 3)}, -1.0}).find("edits[0].band = -1"), std::string::npos);
  EXPECT_NE(refusal({std::vector<Vec3>(kMaxFitPoints + 1, Vec3::Zero())}).find("at most 2000"),
            std::string::npos);
}

TEST(FitEdit, IsCancelled) {
  CurveNetwork bent = Sheet();
  bent.vertices[4].position.z() += 1.0;
  RunContext run(1);
  run.Cancel();
  EXPECT_FALSE(EditNetwork(bent, {FitEdit{{PointsOn(Sheet(), 5)}}}, run).ok());
}

}  // namespace
}  // namespace patchmill
