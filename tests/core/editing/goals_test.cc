// Edits by goal: what is wanted is reached, and joints stay as smooth as they were.
#include "core/editing/goals.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "core/base/index.h"
#include "core/base/status.h"
#include "core/editing/edit_network.h"
#include "core/editing/reach_points.h"
#include "core/joining/continuity.h"
#include "core/joining/join_network.h"
#include "core/network/control_points.h"
#include "tests/core/joining/networks.h"

namespace patchmill {
namespace {

EditedNetwork Edited(const CurveNetwork& network, const std::vector<NetworkEdit>& edits) {
  const auto edited = EditNetwork(network, edits);
  EXPECT_TRUE(edited.ok()) << edited.status();
  return *edited;
}

std::string Refusal(const CurveNetwork& network, const NetworkEdit& edit) {
  return std::string(EditNetwork(network, {edit}).status().message());
}

JoinedNetwork Join(const CurveNetwork& network) {
  JoinedNetwork joined = JoinNetwork(network);
  EXPECT_TRUE(joined.findings.empty()) << testing::Text(joined.findings);
  return joined;
}

ReachEdit Points(std::vector<PointGoal> points) { return {{{}, std::move(points), {}}}; }
ReachEdit Edges(std::vector<EdgeGoal> edges) { return {{std::move(edges), {}, {}}}; }

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

bool SamePatch(const PatchShape& a, const PatchShape& b) {
  return std::ranges::equal(ControlPoints(a), ControlPoints(b)) && std::ranges::equal(Bulges(a), Bulges(b));
}

// Four quads of one scheme on a 3 x 3 grid of vertices, higher in the middle.
CurveNetwork Sheet(PatchScheme scheme, const Eigen::Affine3d& motion = Eigen::Affine3d::Identity()) {
  CurveNetwork network;
  for (int j = 0; j < 3; ++j) {
    for (int i = 0; i < 3; ++i) {
      NetworkVertex vertex;
      vertex.position = motion * Vec3(20.0 * i, 15.0 * j, 4.0 - (i - 1) * (i - 1) - 1.5 * (j - 1) * (j - 1));
      vertex.normals = {{motion.linear() * Vec3(0.1 * (i - 1), 0.2 * (j - 1), 1.0), {}}};
      network.vertices.push_back(vertex);
    }
  }
  for (const int corner : {0, 1, 3, 4}) {
    network.faces.push_back({"", {corner, corner + 1, corner + 4, corner + 3}, scheme});
  }
  return network;
}

struct Case {
  std::string name;
  CurveNetwork network;
  int face = 0;
  bool curvature = false;
};
std::vector<Case> EveryKind() {
  CurveNetwork hosaka = Sheet(PatchScheme::kAuto);
  hosaka.faces[0].scheme = PatchScheme::kHosaka;
  return {{"Gregory", testing::Cuboctahedron(4), 2},
          {"Brown", Sheet(PatchScheme::kBrown), 0},
          {"G2", testing::LineSheet(1, 4, 4), 4, true},
          {"Hosaka", hosaka, 0}};
}

TEST(PointGoal, PeaksWhereItIsPicked) {
  for (const Case& c : EveryKind()) {
    SCOPED_TRACE(c.name);
    const JoinedNetwork before = Join(c.network);
    const PatchShape& old = before.model.patches[At(c.face)].shape;
    for (const Vec2& pick : {Vec2(0.2, 0.8), Vec2(0.5, 0.5), Vec2(0.06, 0.9)}) {
      const EditedNetwork edited =
          Edited(c.network, {Points({{.face = c.face, .u = pick.x(), .v = pick.y(), .distance = 0.7}})});
      const JoinedNetwork after = Join(edited.network);
      const PatchShape& made = after.model.patches[At(c.face)].shape;
      const SurfaceJet s = Evaluate(old, pick.x(), pick.y());
      const Vec3 normal = s.du.cross(s.dv).normalized();
      EXPECT_LE((Position(made, pick.x(), pick.y()) - s.p - 0.7 * normal).norm(), 1e-9);
      double most = 0.0;
      Vec2 peak(0, 0);
      for (int i = 0; i <= 200; ++i) {
        for (int j = 0; j <= 200; ++j) {
          const double u = i / 200.0, v = j / 200.0, d = (Position(made, u, v) - Position(old, u, v)).norm();
          if (d > most) most = d, peak = Vec2(u, v);
        }
      }
      EXPECT_LE((peak - pick).lpNorm<Eigen::Infinity>(), 0.02);
      EXPECT_NEAR(most, 0.7, 1e-9);
      for (std::size_t f = 0; f < after.model.patches.size(); ++f) {
        if (static_cast<int>(f) != c.face) {
          EXPECT_TRUE(SamePatch(before.model.patches[f].shape, after.model.patches[f].shape)) << f;
        }
      }
      ExpectSmooth(after, c.curvature);
      ASSERT_EQ(edited.reached.size(), 1u);
      EXPECT_FALSE(edited.reached[0].missed);
      EXPECT_LE((edited.reached[0].target - s.p - 0.7 * normal).norm(), 1e-12);
      EXPECT_TRUE(edited.findings.empty());
    }
  }
}

TEST(PointGoal, SeveralAreReachedAtOnce) {
  const CurveNetwork network = testing::LineSheet(2, 4, 4);
  const JoinedNetwork before = Join(network);
  const Vec3 to = Position(before.model.patches[3].shape, 0.4, 0.3) + Vec3(0.2, -0.1, 0.5);
  const Vec3 picked = Position(before.model.patches[3].shape, 0.7, 0.8);
  const std::vector<PointGoal> goals = {{.face = 3, .u = 0.4, .v = 0.3, .to = to},
                                        {.face = 3, .near = picked, .distance = -0.3},
                                        {.face = 3, .u = 0.5, .v = 0.5, .distance = 0.0},
                                        {.face = 8, .u = 0.5, .v = 0.1, .distance = 1.0}};
  const EditedNetwork edited = Edited(network, {Points(goals)});
  const JoinedNetwork after = Join(edited.network);
  EXPECT_LE((Position(after.model.patches[3].shape, 0.4, 0.3) - to).norm(), 1e-9);
  EXPECT_NEAR((Position(after.model.patches[3].shape, 0.7, 0.8) - picked).norm(), 0.3, 1e-9);
  EXPECT_LE(
      (Position(after.model.patches[3].shape, 0.5, 0.5) - Position(before.model.patches[3].shape, 0.5, 0.5))
          .norm(),
      1e-9);
  ExpectSmooth(after, true);
  ASSERT_EQ(edited.reached.size(), 4u);
  EXPECT_LE((edited.reached[1].place - Vec2(0.7, 0.8)).norm(), 1e-7);
  for (int k = 0; k < 4; ++k) {
    EXPECT_EQ(edited.reached[At(k)].goal, k);
    EXPECT_LE(edited.reached[At(k)].distance, 1e-9);
  }
}

TEST(PointGoal, TwoForOnePlaceMeetInTheMiddleAndAreReported) {
  const CurveNetwork network = testing::Cuboctahedron(4);
  const Vec3 p = Position(Join(network).model.patches[0].shape, 0.3, 0.6);
  const EditedNetwork edited =
      Edited(network, {Points({{.face = 0, .u = 0.3, .v = 0.6, .to = Vec3(p + Vec3(1, 0, 0))},
                               {.face = 0, .u = 0.3, .v = 0.6, .to = Vec3(p + Vec3(0, 2, 0))}})});
  EXPECT_LE((Position(Join(edited.network).model.patches[0].shape, 0.3, 0.6) - p - Vec3(0.5, 1, 0)).norm(),
            1e-9);
  ASSERT_EQ(edited.findings.size(), 2u);
  for (const Diagnostic& finding : edited.findings) {
    EXPECT_EQ(finding.code, "GOAL_NOT_REACHED");
    EXPECT_EQ(finding.severity, Severity::kWarning);
  }
  EXPECT_EQ(edited.findings[1].where.field, "edits[0].points[1]");
  for (const ReachedGoal& goal : edited.reached) EXPECT_NEAR(goal.distance, std::sqrt(1.25), 1e-9);
}

TEST(PointGoal, TurnsAndGrowsWithTheNetwork) {
  Eigen::Affine3d motion = Eigen::Translation3d(5, -3, 11) *
                           Eigen::AngleAxisd(1.1, Vec3(1, 2, 3).normalized()) * Eigen::Scaling(25.4);
  for (const PatchScheme scheme : {PatchScheme::kGregory, PatchScheme::kBrown}) {
    const auto edit = [](double unit, const auto& place) {
      return std::vector<NetworkEdit>{ReachEdit{
          {{{4, 5, 0.4, place(Vec3(28, 15.5, 3.9))}}, {{.face = 1, .u = 0.3, .distance = 0.5 * unit}}, {}}}};
    };
    const CurveNetwork a = Edited(Sheet(scheme), edit(1.0, [](const Vec3& p) { return p; })).network;
    const CurveNetwork b =
        Edited(Sheet(scheme, motion), edit(25.4, [&](const Vec3& p) { return Vec3(motion * p); })).network;
    const JoinedNetwork ja = Join(a), jb = Join(b);
    for (std::size_t f = 0; f < 4; ++f) {
      for (const Vec2& q : {Vec2(0.3, 0.5), Vec2(0.8, 0.1), Vec2(1.0, 0.4)}) {
        EXPECT_LE((motion * Position(ja.model.patches[f].shape, q.x(), q.y()) -
                   Position(jb.model.patches[f].shape, q.x(), q.y()))
                      .norm(),
                  1e-8);
      }
    }
  }
}

TEST(PointGoal, NearestPlaceComesBack) {
  const JoinedNetwork joined = Join(testing::Cuboctahedron(4));
  for (const Vec2& at : {Vec2(0.1, 0.2), Vec2(0.77, 0.5), Vec2(0.5, 0.99)}) {
    const PatchShape& shape = joined.model.patches[1].shape;
    const SurfaceJet s = Evaluate(shape, at.x(), at.y());
    const Vec3 above = s.p + 0.5 * s.du.cross(s.dv).normalized();
    EXPECT_LE((NearestPlace(shape, above) - at).norm(), 1e-6);
  }
}

TEST(FullnessGoal, OneIsTheMiddleOfTheCoonsSurface) {
  const CurveNetwork network = Sheet(PatchScheme::kGregory);
  for (const double fullness : {0.0, 1.0, 1.7}) {
    const EditedNetwork edited = Edited(network, {ReachEdit{{{}, {}, {{3, fullness}}}}});
    const JoinedNetwork joined = Join(edited.network);
    const PatchShape& shape = joined.model.patches[3].shape;
    const auto at = [&](double u, double v) { return Position(shape, u, v); };
    const Vec3 corners = 0.25 * (at(0, 0) + at(1, 0) + at(0, 1) + at(1, 1));
    const Vec3 rise = 0.5 * (at(0.5, 0) + at(0.5, 1) + at(0, 0.5) + at(1, 0.5)) - 2.0 * corners;
    EXPECT_NEAR((at(0.5, 0.5) - corners).dot(rise) / rise.squaredNorm(), fullness, 1e-9);
    ExpectSmooth(joined, false);
  }
}

TEST(EdgeGoal, BendsAnEdgeWithinItsTangentPlanes) {
  const CurveNetwork network = Sheet(PatchScheme::kGregory);
  const JoinedNetwork before = Join(network);
  const Vec3 through(30.2, 15.3, 3.7);
  const EditedNetwork edited = Edited(network, {Edges({{5, 4, {}, through}})});
  const JoinedNetwork after = Join(edited.network);
  ExpectSmooth(after, false);
  ASSERT_EQ(edited.reached.size(), 1u);
  EXPECT_FALSE(edited.reached[0].missed);
  const PatchShape& shape = after.model.patches[1].shape;  // its side v=1 runs from 4 to 5
  double least = kInfinity;
  for (int k = 0; k <= 10000; ++k)
    least = std::min(least, (Position(shape, k / 10000.0, 1.0) - through).norm());
  EXPECT_LE(least, 2e-3);  // half of the step
  EXPECT_TRUE(std::holds_alternative<GregoryPatch>(shape));
  for (const std::size_t f : {0u, 2u}) {  // faces that touch an end only
    const PatchShape &a = before.model.patches[f].shape, &b = after.model.patches[f].shape;
    EXPECT_LE((Position(a, 0.0, 0.3) - Position(b, 0.0, 0.3)).norm(), 1e-9);
  }
}

TEST(EdgeGoal, LeavesATangentPlaneByAnExtraTerm) {
  CurveNetwork flat = Sheet(PatchScheme::kAuto);
  for (NetworkVertex& v : flat.vertices) v.position.z() = 0.0, v.normals = {{Vec3::UnitZ(), {}}};
  const EditedNetwork edited = Edited(flat, {Edges({{4, 5, 0.3, Vec3(26, 15, 0.8)}})});
  EXPECT_TRUE(edited.findings.empty());
  ASSERT_EQ(edited.reached.size(), 1u);
  EXPECT_LE(edited.reached[0].distance, 1e-12);
  const JoinedNetwork after = Join(edited.network);
  ExpectSmooth(after, false);
  EXPECT_LE((Position(after.model.patches[1].shape, 0.3, 1.0) - Vec3(26, 15, 0.8)).norm(), 1e-12);
  // Gregory quads take cubics only: the plane holds the edge back, which is said.
  for (NetworkFace& face : flat.faces) face.scheme = PatchScheme::kGregory;
  const EditedNetwork held = Edited(flat, {Edges({{4, 5, 0.3, Vec3(26, 15, 0.8)}})});
  ASSERT_EQ(held.findings.size(), 1u);
  EXPECT_EQ(held.findings[0].code, "GOAL_NOT_REACHED");
  EXPECT_NEAR(held.reached[0].distance, 0.8, 1e-12);
}

TEST(EdgeGoal, MovesTheVerticesOfALineAndKeepsCurvature) {
  const CurveNetwork network = testing::LineSheet(3, 4, 4);
  const JoinedNetwork before = Join(network);
  const auto edge = std::ranges::find_if(before.edges, [](const JoinedEdge& e) {
    return std::min(e.topology.start, e.topology.end) == 5 && std::max(e.topology.start, e.topology.end) == 6;
  });
  ASSERT_NE(edge, before.edges.end());
  const Vec3 through = Evaluate(edge->curve, 0.5).p + Vec3(0.3, 0.2, -0.6);
  const EditedNetwork edited =
      Edited(network, {Edges({{edge->topology.start, edge->topology.end, 0.5, through}})});
  EXPECT_TRUE(edited.findings.empty());
  const JoinedNetwork after = Join(edited.network);
  ExpectSmooth(after, true);
  double least = kInfinity;
  for (const JoinedEdge& e : after.edges)
    least = std::min(least, (Evaluate(e.curve, 0.5).p - through).norm());
  EXPECT_LE(least, 1e-10);
  for (const int v : {0, 1, 2, 3, 4, 7, 8, 15}) {
    EXPECT_EQ(edited.network.vertices[At(v)].position, network.vertices[At(v)].position);
  }
}

TEST(VertexEdit, MovesTheVertexAndKeepsJoints) {
  for (const bool lines : {false, true}) {
    const CurveNetwork network = lines ? testing::LineSheet(1, 4, 4) : Sheet(PatchScheme::kGregory);
    const int vertex = lines ? 5 : 4;
    const Vec3 by(0.4, -0.3, 1.2), to = network.vertices[At(vertex)].position + by;
    const CurveNetwork moved = Edited(network, {VertexEdit{vertex, by, true}}).network;
    EXPECT_EQ(moved.vertices[At(vertex)].position, to);
    EXPECT_EQ(Edited(network, {VertexEdit{vertex, to}}).network.vertices[At(vertex)].position, to);
    ExpectSmooth(Join(moved), lines);
  }
  // A curve that is given moves with its end and keeps its end tangent.
  CurveNetwork given = Sheet(PatchScheme::kGregory);
  const std::vector<Vec3> points = {given.vertices[3].position, Vec3(7, 15, 4.2), Vec3(13, 15, 4.0),
                                    given.vertices[4].position};
  NetworkEdge edge{"", 3, 4, CurveEdge{BezierCurve{points}}};
  given.edges = {edge};
  const CurveNetwork moved = Edited(given, {VertexEdit{4, Vec3(0, 0, 1), true}}).network;
  const auto& curve = std::get<BezierCurve>(std::get<CurveEdge>(moved.edges[0].shape).curve);
  EXPECT_EQ(curve.points[1], points[1]);
  EXPECT_EQ(curve.points[3] - curve.points[2], points[3] - points[2]);
}

double WorstAngle(const CurveNetwork& network) {
  auto built = BuildNetwork(Join(network).model);
  double worst = 0.0;
  const auto joints = MeasureContinuity(*built, 30, RunContext(1));
  PM_CHECK(joints.ok());
  for (const EdgeContinuity& e : joints->edges) worst = std::max(worst, e.max_angle);
  return worst;
}

TEST(CreaseEdit, IsSetAndTakenAway) {
  CurveNetwork network = Sheet(PatchScheme::kGregory);
  network.vertices[5].normals.clear();  // each face takes the plane of its own edges there
  network.vertices[5].position.z() += 4.0;
  const double smooth = WorstAngle(network);
  EXPECT_LE(smooth, 1e-10);
  const CurveNetwork creased = Edited(network, {CreaseEdit{5, 4, true}}).network;
  EXPECT_GT(WorstAngle(creased), 0.02);
  EXPECT_LE(WorstAngle(Edited(creased, {CreaseEdit{4, 5, false}}).network), 1e-10);
}

TEST(CreaseEdit, OfALineKeepsItsCurves) {
  const CurveNetwork network = testing::LineSheet(1, 4, 4);
  const CurveNetwork creased = Edited(network, {CreaseEdit{5, 6, true}}).network;
  EXPECT_EQ(creased.lines.size(), network.lines.size() - 1);
  const JoinedNetwork before = Join(network), after = JoinNetwork(creased);
  ASSERT_EQ(before.edges.size(), after.edges.size());
  for (const JoinedEdge& a : before.edges) {
    for (const JoinedEdge& b : after.edges) {
      if (std::minmax(a.topology.start, a.topology.end) != std::minmax(b.topology.start, b.topology.end))
        continue;
      const double t = a.topology.start == b.topology.start ? 0.3 : 0.7;
      EXPECT_LE((Evaluate(a.curve, 0.3).p - Evaluate(b.curve, t).p).norm(), 1e-12);
    }
  }
}

TEST(CreaseEdit, SmoothWithTwoNormalsTakesTheirMean) {
  CurveNetwork network = Sheet(PatchScheme::kGregory);
  NetworkEdge edge;
  edge.start = 1, edge.end = 4, edge.crease = true;
  network.edges = {edge};
  network.vertices[1].normals = {{Vec3(0.3, 0, 1), {0}}, {Vec3(0.3, 0, -1), {1}}};
  const CurveNetwork smooth = Edited(network, {CreaseEdit{1, 4, false}}).network;
  ASSERT_EQ(smooth.vertices[1].normals.size(), 1u);
  EXPECT_LE(smooth.vertices[1].normals[0].direction.cross(Vec3::UnitX()).norm(), 1.0);
  EXPECT_EQ(smooth.vertices[1].normals[0].faces, (std::vector<int>{0, 1}));
  EXPECT_LE(WorstAngle(smooth), 1e-10);
}

TEST(Goals, ThatCannotBeAreRefusedWithTheirPlace) {
  const CurveNetwork network = testing::Cuboctahedron(4);  // faces 6 to 13 are triangles
  EXPECT_EQ(Refusal(network, ReachEdit{}), "edits[0] has no goals; give edges, points or fullness");
  EXPECT_NE(Refusal(network, Points({{.face = 14}})).find("edits[0].points[0].face = 14; must be in [0, 13]"),
            std::string::npos);
  EXPECT_NE(Refusal(network, Points({{}, {.face = 6}})).find("edits[0].points[1].face = 6; must be a quad"),
            std::string::npos);
  EXPECT_NE(Refusal(network, Points({{.face = 1, .u = 0.001}})).find("gives the place (0.001, 0.5)"),
            std::string::npos);
  EXPECT_NE(Refusal(network, Points({{.face = 1, .distance = kInfinity}})).find(".distance must be finite"),
            std::string::npos);
  EXPECT_NE(Refusal(network, Edges({{0, 0, {}, Vec3::Zero()}})).find("there is no such edge"),
            std::string::npos);
  EXPECT_NE(Refusal(network, CreaseEdit{0, 0}).find("there is no such edge"), std::string::npos);
  EXPECT_NE(Refusal(network, VertexEdit{12}).find(".vertex = 12; must be in [0, 11]"), std::string::npos);
  CurveNetwork flat = Sheet(PatchScheme::kGregory);
  for (NetworkVertex& v : flat.vertices) v.position.z() = 0.0, v.normals = {{Vec3::UnitZ(), {}}};
  EXPECT_NE(Refusal(flat, ReachEdit{{{}, {}, {{0, 1.2}}}}).find("no fullness"), std::string::npos);
}

}  // namespace
}  // namespace patchmill
