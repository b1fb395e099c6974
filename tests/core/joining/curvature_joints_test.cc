// Networks of G2-Gregory faces: the vector of [joining, section 8], equal normal curvature by differencing
// normals, fall back to tangent planes.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "core/base/index.h"
#include "core/diffgeo/forms.h"
#include "core/joining/continuity.h"
#include "core/joining/join_network.h"
#include "tests/core/joining/networks.h"
#include "tests/support/json.h"
#include "tests/support/known_surfaces.h"

namespace patchmill {
namespace {

using testing::Json;
using testing::LoadJson;
using testing::Text;

int Count(const JoinedNetwork& joined, const std::string& code) {
  return static_cast<int>(std::ranges::count(joined.findings, code, &Diagnostic::code));
}

BezierCurve Curve(const Json& points) {
  BezierCurve curve;
  for (const Json& p : points.Items()) curve.points.push_back(p.Vector());
  return curve;
}

// The two patches of the vector as a network: vertices 0 1 2 below, 3 4 5 above, the shared edge from 1 to 4
// with control vectors for both faces.
TEST(CurvatureJoints, Vector) {
  const Json data = LoadJson(PATCHMILL_SOURCE_DIR "/tests/vectors/basis_patch.json");
  const auto part = [&](const char* key, const char* at, bool left) {
    BezierCurve curve = Curve(data[key]);
    const double t = data[at].Number();
    left ? KeepLeft(curve.points.data(), 3, 1, t) : KeepRight(curve.points.data(), 3, 1, t);
    return curve;
  };
  CurveNetwork network;
  network.vertices.resize(6);
  const auto edge = [&](int from, int to, const BezierCurve& curve) {
    network.vertices[At(from)].position = curve.points.front();
    network.vertices[At(to)].position = curve.points.back();
    network.edges.push_back({"", from, to, CurveEdge{curve}, false});
  };
  edge(0, 1, part("bottom_cubic", "split_bottom", true));
  edge(1, 2, part("bottom_cubic", "split_bottom", false));
  edge(3, 4, part("top_cubic", "split_top", true));
  edge(4, 5, part("top_cubic", "split_top", false));
  edge(0, 3, Curve(data["left"]));
  edge(1, 4, Curve(data["mid"]));
  edge(2, 5, Curve(data["right"]));
  network.faces = {{"A", {0, 1, 4, 3}, PatchScheme::kG2Gregory, {}},
                   {"B", {1, 2, 5, 4}, PatchScheme::kG2Gregory, {}}};
  network.controls = {{1, 4, 0, -6 * data["T0"].Vector(), 30 * data["C0"].Vector()},
                      {4, 1, 1, 6 * data["T1"].Vector(), 30 * data["C1"].Vector()}};
  // At the borders the vector has the means of the ends.
  const JoinedNetwork shared = JoinNetwork(network);
  ASSERT_TRUE(shared.findings.empty()) << Text(shared.findings);
  for (const JoinedEdge& border : shared.edges) {
    if (border.kind != EdgeKind::kFree) continue;
    network.controls.push_back(testing::MeanControl(network, shared, border.topology.faces[0]));
  }
  const JoinedNetwork joined = JoinNetwork(network);
  ASSERT_TRUE(joined.findings.empty()) << Text(joined.findings);
  EXPECT_TRUE(joined.edges[5].equal_curvature);
  for (const int face : {0, 1}) {
    const auto& made = std::get<G2GregoryPatch>(joined.model.patches[At(face)].shape);
    const Json &p0 = data[face == 0 ? "PA0" : "PB0"], &p1 = data[face == 0 ? "PA1" : "PB1"];
    for (int i = 0; i <= 6; ++i) {
      for (int j = 0; j <= 6; ++j) {
        EXPECT_LE((made.points[At(7 * i + j)] - p0[i][j].Vector()).norm(), 1e-12) << face << i << j;
        if (i % 3 == 0 || j % 3 == 0) continue;
        const int block = 4 * (i < 3 ? i - 1 : i - 2) + (j < 3 ? j - 1 : j - 2);
        EXPECT_LE((made.points[At(49 + block)] - p1[i][j].Vector()).norm(), 1e-12) << face << i << j;
      }
    }
    // The curvature along the shared edge, in the frame given: the same from both.
    for (const Json& at : data["curvature_tensor"].Items()) {
      const SurfaceJet s = Evaluate(PatchShape(made), face == 0 ? 1.0 : 0.0, at["v"].Number());
      const Vec3 t1 = at["t1"].Vector(), t2 = at["t2"].Vector();
      const FundamentalForms f = Forms(s, t1.cross(t2));
      Eigen::Matrix<double, 3, 2> frame;
      frame << s.du, s.dv;
      const Eigen::Matrix2d in_uv =
          frame.colPivHouseholderQr().solve((Eigen::Matrix<double, 3, 2>() << t1, t2).finished());
      Eigen::Matrix2d second;
      second << f.L, f.M, f.M, f.N;
      const Eigen::Matrix2d made_tensor = in_uv.transpose() * second * in_uv;
      EXPECT_NEAR(made_tensor(0, 0), at["II"][0].Number(), 1e-12) << face;
      EXPECT_NEAR(made_tensor(0, 1), at["II"][1].Number(), 1e-12) << face;
      EXPECT_NEAR(made_tensor(1, 1), at["II"][2].Number(), 1e-12) << face;
    }
  }
}

// Unit normal of a patch at the foot of a space point, found by Newton steps on the two tangential equations.
struct Foot {
  Vec2 uv;
  Vec3 p, n;
};
Foot FootOf(const PatchShape& shape, Vec2 uv, const Vec3& q) {
  for (int k = 0; k < 50; ++k) {
    const SurfaceJet s = Evaluate(shape, uv.x(), uv.y());
    const Vec3 d = s.p - q;
    Eigen::Matrix2d jacobian;
    jacobian << s.du.dot(s.du) + d.dot(s.duu), s.du.dot(s.dv) + d.dot(s.duv),  //
        s.du.dot(s.dv) + d.dot(s.duv), s.dv.dot(s.dv) + d.dot(s.dvv);
    const Vec2 step = jacobian.inverse() * Vec2(d.dot(s.du), d.dot(s.dv));
    uv -= step;
    if (step.norm() < 1e-15) break;
  }
  const SurfaceJet s = Evaluate(shape, uv.x(), uv.y());
  return {uv, s.p, s.du.cross(s.dv).normalized()};
}

// Normal curvature by differencing normals alone: the normals at the feet of p +- h t, one-sided (the patch
// ends at p), extrapolated in h. No second derivatives of the patch enter the value.
double CurvatureByNormals(const PatchShape& shape, const Vec2& at, const Vec3& t) {
  const Foot here = FootOf(shape, at, Evaluate(shape, at.x(), at.y()).p);
  std::vector<double> values;
  const double base = 0.1;
  for (int k = 0; k < 7; ++k) {  // Richardson over h = base 2^-k
    const double h = base / (1 << k);
    const Foot there = FootOf(shape, here.uv, here.p + h * t);
    values.push_back(-(there.n - here.n).dot(there.p - here.p) / (there.p - here.p).squaredNorm());
  }
  for (int level = 1; level < 7; ++level) {
    const double factor = std::pow(2.0, level);
    for (int k = 6; k >= level; --k) {
      values[At(k)] = (factor * values[At(k)] - values[At(k - 1)]) / (factor - 1.0);
    }
  }
  return values.back();
}

Vec2 OnSide(const FaceSide& s, double t) {
  switch (s.side) {
    case 0:
      return {t, 0};
    case 1:
      return {1, t};
    case 2:
      return {1 - t, 1};
    default:
      return {0, 1 - t};
  }
}

// Every edge between two of the faces, at places along it, in directions all around: equal normal curvature.
// Directions into the one patch are met from the other one by -t: curvature is even.
int ExpectEqualCurvature(const CurveNetwork& network, const JoinedNetwork& joined) {
  int edges = 0;
  for (const JoinedEdge& edge : joined.edges) {
    if (!edge.equal_curvature) continue;
    ++edges;
    double largest = 0.0, worst = 0.0;
    for (const double t : {0.13, 0.5, 0.77}) {
      Vec3 normal[2];
      std::vector<double> curvature[2];
      const Vec3 along = Evaluate(edge.curve, t).d.normalized();
      for (const std::size_t k : {0, 1}) {
        const FaceSide& s = edge.topology.faces[k];
        const bool forward = network.faces[At(s.face)].vertices[At(s.side)] == edge.topology.start;
        const Vec2 uv = OnSide(s, forward ? t : 1 - t);
        const PatchShape& shape = joined.model.patches[At(s.face)].shape;
        const SurfaceJet jet = Evaluate(shape, uv.x(), uv.y());
        normal[k] = jet.du.cross(jet.dv).normalized();
        const Vec3 inward =
            Evaluate(BezierCurve{{edge.rows[k].first.begin(), edge.rows[k].first.end()}}, t).p;
        const double side = inward.dot(normal[0].cross(along)) > 0 ? 1.0 : -1.0;
        for (const double angle : {0.3, 0.9, 1.4, 2.0, 2.7}) {
          const Vec3 direction = side * (std::cos(angle) * along + std::sin(angle) * normal[0].cross(along));
          curvature[k].push_back((normal[k].dot(normal[0]) > 0 ? 1 : -1) *
                                 CurvatureByNormals(shape, uv, direction));
        }
      }
      EXPECT_LE(normal[0].cross(normal[1]).norm(), 1e-12);
      for (std::size_t i = 0; i < curvature[0].size(); ++i) {
        largest = std::max({largest, std::abs(curvature[0][i]), std::abs(curvature[1][i])});
        worst = std::max(worst, std::abs(curvature[0][i] - curvature[1][i]));
      }
    }
    EXPECT_GT(largest, 1e-4);
    EXPECT_LE(worst, 1e-9 * largest) << edge.topology.start << "-" << edge.topology.end;
  }
  return edges;
}

TEST(CurvatureJoints, SheetsOfLinesHaveEqualCurvatureAcrossEveryEdge) {
  for (std::uint64_t seed = 0; seed < 3; ++seed) {
    const CurveNetwork network = testing::LineSheet(seed, 5, 4);
    const JoinedNetwork joined = JoinNetwork(network);
    ASSERT_TRUE(joined.findings.empty()) << Text(joined.findings);
    EXPECT_EQ(ExpectEqualCurvature(network, joined), 3 * 3 + 4 * 2);
  }
}

// Largest angle between normals over all joints.
double WorstAngle(const JoinedNetwork& joined) {
  auto network = BuildNetwork(joined.model);
  EXPECT_TRUE(network.ok());
  double worst = 0.0;
  const auto continuity = MeasureContinuity(*network, 200, RunContext(1));
  EXPECT_TRUE(continuity.ok());
  for (const EdgeContinuity& e : continuity->edges) {
    EXPECT_LE(e.max_gap, 1e-12);
    worst = std::max(worst, e.max_angle);
  }
  return worst;
}

// First and second derivative of a face across the middle of an edge, into the face.
std::pair<Vec3, Vec3> AcrossMiddle(const CurveNetwork& network, const JoinedNetwork& joined, int from, int to,
                                   int face) {
  const auto& loop = network.faces[At(face)].vertices;
  for (int side = 0; side < 4; ++side) {
    const int a = loop[At(side)], b = loop[At((side + 1) % 4)];
    if (std::minmax(a, b) != std::minmax(from, to)) continue;
    const Vec2 uv = OnSide({face, side}, 0.5);
    const SurfaceJet s = Evaluate(joined.model.patches[At(face)].shape, uv.x(), uv.y());
    const double sign = side == 0 || side == 3 ? 1.0 : -1.0;
    return {sign * (side % 2 == 0 ? s.dv : s.du), side % 2 == 0 ? s.dvv : s.duu};
  }
  ADD_FAILURE();
  return {};
}

// Control vectors of one face are met exactly, the face across follows: its first derivative parallel with
// its old share of the length, curvature equal; faces away from the edge stay the same to the bit.
TEST(CurvatureJoints, ControlVectorsAreMetAndTheNeighbourFollows) {
  CurveNetwork network = testing::LineSheet(4, 4, 4);
  const JoinedNetwork plain = JoinNetwork(network);
  ASSERT_TRUE(plain.findings.empty()) << Text(plain.findings);
  // The edge between the inner vertices 5 and 6; faces are cells (i, j) = (0, 1) and (1, 1).
  const int a = 1, b = 4;
  const auto old_a = AcrossMiddle(network, plain, 5, 6, a), old_b = AcrossMiddle(network, plain, 5, 6, b);
  const Vec3 first = 1.2 * old_a.first + Vec3(0.3, -0.8, 0.9), second = old_a.second + Vec3(2, -1, 6);
  network.controls = {{5, 6, a, first, second}};
  const JoinedNetwork joined = JoinNetwork(network);
  ASSERT_TRUE(joined.findings.empty()) << Text(joined.findings);
  const auto new_a = AcrossMiddle(network, joined, 5, 6, a), new_b = AcrossMiddle(network, joined, 5, 6, b);
  EXPECT_LE((new_a.first - first).norm(), 1e-12);
  EXPECT_LE((new_a.second - second).norm(), 1e-11);
  EXPECT_LE(new_b.first.cross(first).norm(), 1e-12 * first.squaredNorm());
  EXPECT_LT(new_b.first.dot(first), 0.0);
  const auto share = [](const std::pair<Vec3, Vec3>& x, const std::pair<Vec3, Vec3>& y) {
    return x.first.norm() / y.first.norm();
  };
  EXPECT_GT((new_b.first - old_b.first).norm(), 0.1);
  // The share of the neighbour's length is kept.
  EXPECT_NEAR(share(new_b, new_a), share(old_b, old_a), 1e-12);
  ExpectEqualCurvature(network, joined);
  for (std::size_t f = 0; f < network.faces.size(); ++f) {
    const auto& p = std::get<G2GregoryPatch>(plain.model.patches[f].shape).points;
    const auto& q = std::get<G2GregoryPatch>(joined.model.patches[f].shape).points;
    if (static_cast<int>(f) != a && static_cast<int>(f) != b) {
      EXPECT_EQ(p, q) << f;
    } else {
      EXPECT_NE(p, q) << f;
    }
  }
}

// The report knows the difference: rounding on these sheets, far more between tangent planes only.
TEST(CurvatureJoints, TheReportTellsEqualCurvature) {
  CurveNetwork network = testing::LineSheet(8, 4, 4);
  const auto measure = [&](PatchScheme scheme) {
    for (NetworkFace& face : network.faces) face.scheme = scheme;
    auto checked = BuildNetwork(JoinNetwork(network).model);
    EXPECT_TRUE(checked.ok());
    return MeasureContinuity(*checked, 40, RunContext(1))->edges;
  };
  const auto equal = measure(PatchScheme::kG2Gregory), unequal = measure(PatchScheme::kGregory);
  ASSERT_EQ(equal.size(), 12u);
  ASSERT_EQ(unequal.size(), 12u);
  for (std::size_t k = 0; k < equal.size(); ++k) {
    EXPECT_LE(equal[k].max_curvature_gap, 1e-10 * equal[k].max_curvature);
    EXPECT_GT(unequal[k].max_curvature_gap, 1e-3 * unequal[k].max_curvature);
    EXPECT_LE(unequal[k].max_curvature_gap, 2 * unequal[k].max_curvature);
  }
}

TEST(CurvatureJoints, FallBackToTangentPlanesWithAReason) {
  CurveNetwork network = testing::LineSheet(5, 4, 4);
  network.lines.clear();  // edges from normals: the crossing ones are out of line
  const JoinedNetwork bent = JoinNetwork(network);
  EXPECT_EQ(Count(bent, "TANGENT_PLANE_ONLY"), 12) << Text(bent.findings);
  EXPECT_EQ(bent.findings.size(), 12u);
  EXPECT_NE(bent.findings[0].message.find("out of line"), std::string::npos);
  EXPECT_LE(WorstAngle(bent), 1e-11);

  network = testing::LineSheet(5, 4, 4);  // one face of another kind: its four edges
  network.faces[4].scheme = PatchScheme::kGregory;
  const JoinedNetwork mixed = JoinNetwork(network);
  EXPECT_EQ(Count(mixed, "TANGENT_PLANE_ONLY"), 4) << Text(mixed.findings);
  EXPECT_NE(mixed.findings[0].message.find("faces[4] is no G2-Gregory patch"), std::string::npos);
  EXPECT_LE(WorstAngle(mixed), 1e-11);
  EXPECT_EQ(ExpectEqualCurvature(network, mixed), 8);

  // The edge from 9 to the border leaves 9 in line but bends otherwise: the two edges that it crosses there.
  network = testing::LineSheet(5, 4, 4);
  const JoinedNetwork plain = JoinNetwork(network);
  network.lines.clear();
  for (const JoinedEdge& edge : plain.edges) {
    BezierCurve curve = SpanOf(edge.curve, 0);
    if (edge.topology.start == 9 && edge.topology.end == 13) curve.points[2] += Vec3(0, 0, 1e-4);
    network.edges.push_back({"", edge.topology.start, edge.topology.end, CurveEdge{curve}, false});
  }
  const JoinedNetwork bumped = JoinNetwork(network);
  ASSERT_EQ(bumped.findings.size(), 2u) << Text(bumped.findings);
  for (const Diagnostic& finding : bumped.findings) {
    EXPECT_EQ(finding.code, "TANGENT_PLANE_ONLY");
    EXPECT_NE(finding.message.find("at vertex 9 the edges that cross it differ in curvature"),
              std::string::npos);
  }
  EXPECT_LE(WorstAngle(bumped), 1e-11);
}

TEST(CurvatureJoints, CreasesAndBordersNeedNoPartner) {
  CurveNetwork network = testing::LineSheet(6, 4, 4);
  network.lines[1].crease = true;  // across the sheet
  const JoinedNetwork joined = JoinNetwork(network);
  EXPECT_TRUE(joined.findings.empty()) << Text(joined.findings);
  EXPECT_EQ(ExpectEqualCurvature(network, joined), 12 - 3);
}

TEST(CurvatureJoints, FindingsOfControlsAndLines) {
  const auto with = [](auto change) {
    CurveNetwork network = testing::LineSheet(7, 3, 3);
    change(network);
    return JoinNetwork(network);
  };
  const auto found = [](const JoinedNetwork& joined, const std::string& code, const std::string& text) {
    EXPECT_TRUE(joined.model.patches.empty());
    EXPECT_EQ(joined.findings.size(), 1u) << Text(joined.findings);
    EXPECT_EQ(Count(joined, code), 1) << Text(joined.findings);
    EXPECT_NE(Text(joined.findings).find(text), std::string::npos) << Text(joined.findings);
  };
  found(with([](CurveNetwork& n) { n.lines[0].vertices[1] = 9; }), "INVALID_LINE",
        "names vertex 9; must be in [0, 8]");
  found(with([](CurveNetwork& n) { n.lines[0].vertices = {3}; }), "INVALID_LINE", "at least 2");
  found(with([](CurveNetwork& n) { n.lines[0].vertices = {0, 1, 1, 2}; }), "INVALID_LINE", "0 apart");
  found(with([](CurveNetwork& n) { n.faces[0].pushes = {FacePush{}}; }), "UNSUPPORTED_SCHEME",
        "control vectors");
  const auto controls = [&](std::vector<CrossControl> list) {
    return with([&](CurveNetwork& n) { n.controls = list; });
  };
  EXPECT_TRUE(controls({{3, 4, 0, Vec3(-9, 1, 0), {}}}).findings.empty());
  found(controls({{3, 4, 3, Vec3(-9, 1, 0), {}}}), "INVALID_CONTROL", "there is none");
  found(controls({{3, 4, -1, Vec3(-9, 1, 0), {}}}), "INVALID_CONTROL", "there is none");
  found(controls({{3, 4, 0, Vec3(-9, 1, 0), {}}, {4, 3, 0, {}, Vec3(1, 0, 0)}}), "INVALID_CONTROL",
        "controls[0]");
  found(controls({{3, 4, 0, Vec3(0, 0, 0), {}}}), "INVALID_CONTROL", "without direction");
  found(controls({{3, 4, 0, Vec3(-9, 1, 0), {}}, {3, 4, 2, Vec3(9, 1, 0), {}}}), "INVALID_CONTROL", "differ");
  found(controls({{3, 4, 0, Vec3(-0.01, 0, 0), {}}}), "INVALID_CONTROL", "turn back");
  found(controls({{3, 4, 0, Vec3(std::nan(""), 0, 0), {}}}), "NOT_FINITE", "controls[0]");
}

}  // namespace
}  // namespace patchmill
