// Bad networks: each fault found by its code, all at once, none crashes.
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <tuple>
#include <utility>

#include <gtest/gtest.h>

#include "core/joining/join_network.h"
#include "core/joining/network_findings.h"
#include "tests/core/joining/networks.h"

namespace patchmill {
namespace {

int Count(const CurveNetwork& network, std::string_view code) {
  const JoinedNetwork joined = JoinNetwork(network);
  if (HasError(joined.findings)) {
    EXPECT_TRUE(joined.model.patches.empty());
  }
  return static_cast<int>(std::ranges::count(joined.findings, code, &Diagnostic::code));
}

// Two quads side by side in a gently bent sheet.
CurveNetwork TwoQuads() {
  CurveNetwork network;
  for (const Vec3& p :
       {Vec3(0, 0, 0), Vec3(10, 0, 1), Vec3(20, 0, 0), Vec3(0, 10, 0), Vec3(10, 10, 1), Vec3(20, 10, 0)}) {
    NetworkVertex v;
    v.position = p;
    network.vertices.push_back(v);
  }
  network.faces.resize(2);
  network.faces[0].vertices = {0, 1, 4, 3};
  network.faces[1].vertices = {1, 2, 5, 4};
  return network;
}

TEST(NetworkFindings, SoundNetworkHasNone) { EXPECT_TRUE(JoinNetwork(TwoQuads()).findings.empty()); }

TEST(NetworkFindings, Topology) {
  CurveNetwork n = TwoQuads();
  n.edges.push_back({"", 0, 5, NormalsEdge{}, false});
  EXPECT_EQ(Count(n, "DANGLING_EDGE"), 1);

  n = TwoQuads();
  n.edges.push_back({"", 2, 2, NormalsEdge{}, false});
  EXPECT_EQ(Count(n, "ZERO_LENGTH_EDGE"), 1);

  n = TwoQuads();
  n.edges.push_back({"", 1, 4, NormalsEdge{}, false});
  n.edges.push_back({"", 4, 1, NormalsEdge{2.0}, false});
  EXPECT_EQ(Count(n, "DUPLICATE_EDGE"), 1);

  n = TwoQuads();
  n.vertices.push_back({"", Vec3(10, 5, 9), {}});
  n.faces.push_back({"", {1, 4, 6}, PatchScheme::kAuto, {}});
  EXPECT_EQ(Count(n, "NON_MANIFOLD_EDGE"), 1);

  n = TwoQuads();
  n.vertices.push_back({"", Vec3(-9, -1, 0), {}});
  n.vertices.push_back({"", Vec3(-1, -9, 0), {}});
  n.faces.push_back({"", {0, 6, 7}, PatchScheme::kAuto, {}});
  EXPECT_EQ(Count(n, "NON_MANIFOLD_VERTEX"), 1);

  n = TwoQuads();
  n.edges.push_back({"", 0, 1, NormalsEdge{}, true});
  EXPECT_EQ(Count(n, "CONTRADICTORY_CREASE"), 1);

  n = TwoQuads();
  n.faces[0].vertices = {0, 1, 2, 5, 3};
  EXPECT_EQ(Count(n, "FACE_SIDES"), 1);
  n.faces[0].vertices = {0, 1, 1, 3};
  EXPECT_EQ(Count(n, "ZERO_LENGTH_EDGE"), 1);
  n.faces[0].vertices = {0, 1, 17, -3};
  EXPECT_EQ(Count(n, "INVALID_REFERENCE"), 2);
  n.faces.clear();
  EXPECT_EQ(Count(n, "PATCH_COUNT"), 1);
}

TEST(NetworkFindings, Numbers) {
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    CurveNetwork n = TwoQuads();
    n.vertices[2].position.y() = bad;
    EXPECT_EQ(Count(n, "NOT_FINITE"), 1);
    n = TwoQuads();
    n.vertices[2].normals = {{Vec3(0, bad, 1), {}}};
    EXPECT_EQ(Count(n, "INVALID_NORMAL"), 1);
    n = TwoQuads();
    n.edges.push_back({"", 1, 4, TangentsEdge{Vec3(0, bad, 0), Vec3(0, -9, 0)}, false});
    EXPECT_GE(Count(n, "NOT_FINITE"), 1);
    n.edges[0].shape = NormalsEdge{bad};
    EXPECT_EQ(Count(n, "INVALID_GAMMA"), 1);
  }
  CurveNetwork n = TwoQuads();
  n.vertices[2].position.x() = 1e10;
  EXPECT_EQ(Count(n, "TOO_LARGE"), 1);
  n = TwoQuads();
  n.vertices[2].normals = {{Vec3::Zero(), {}}};
  EXPECT_EQ(Count(n, "INVALID_NORMAL"), 1);
  n = TwoQuads();
  n.vertices[2].position = n.vertices[5].position + Vec3(1e-7, 0, 0);
  EXPECT_EQ(Count(n, "DUPLICATE_VERTEX"), 1);
  n = TwoQuads();
  n.vertices.push_back({"", Vec3(50, 0, 0), {}});
  EXPECT_EQ(Count(n, "UNUSED_VERTEX"), 1);
  n = TwoQuads();
  n.faces[0].pushes = {{0.5, 1.5, 0.1}};
  n.faces[1].pushes = {{0.5, 0.5, std::numeric_limits<double>::infinity()}};
  EXPECT_EQ(Count(n, "INVALID_PUSH"), 2);
}

TEST(NetworkFindings, Shapes) {
  CurveNetwork n = TwoQuads();
  n.vertices[0].normals = {{Vec3(10, 0, 1), {}}};  // along the edge to vertex 1
  EXPECT_EQ(Count(n, "CHORD_ALONG_NORMAL"), 1);

  n = TwoQuads();
  n.vertices[1].normals = {{Vec3(0, 0, 1), {0}}, {Vec3(0.3, 0, 1), {1}}};
  EXPECT_EQ(Count(n, "INCONSISTENT_NORMALS"), 1);
  n.edges.push_back({"", 1, 4, NormalsEdge{}, true});  // said to be a crease: allowed
  EXPECT_EQ(Count(n, "INCONSISTENT_NORMALS"), 0);

  n = TwoQuads();
  n.vertices[1].normals = {{Vec3(0, 0, 1), {}}};
  n.edges.push_back({"", 1, 4, TangentsEdge{Vec3(0, 9, 1), Vec3(0, -9, 0)}, false});
  EXPECT_GE(Count(n, "INCONSISTENT_NORMALS"), 1);

  n = TwoQuads();
  n.edges.push_back(
      {"", 0, 3, CurveEdge{BezierCurve{{Vec3(0, 0, 0), Vec3(0, 5, 2), Vec3(0, 10, 0.5)}}}, false});
  EXPECT_EQ(Count(n, "CURVE_OFF_VERTEX"), 1);
  BsplineCurve spline{1, {0, 0, 1, 2, 2}, {Vec3(0, 0, 0), Vec3(0, 5, 2), Vec3(0, 10, 0)}};
  n.edges[0].shape = CurveEdge{spline};
  EXPECT_EQ(Count(n, "UNSUPPORTED_CURVE"), 1);
  n.edges[0].shape = ThroughPointEdge{Vec3(500, 5, 2)};
  EXPECT_EQ(Count(n, "NO_FIT"), 1);

  n = TwoQuads();
  n.faces[0].scheme = PatchScheme::kLoftTriangle;
  EXPECT_EQ(Count(n, "UNSUPPORTED_SCHEME"), 1);

  // The second face lies over the first one: both leave their common edge to the same side.
  n = TwoQuads();
  n.vertices[2].position = Vec3(1, 0, 0.5);
  n.vertices[5].position = Vec3(1, 10, 0.5);
  n.vertices[1].normals = n.vertices[4].normals = {{Vec3(0, 0, 1), {}}};
  EXPECT_EQ(Count(n, "FOLDED_EDGE"), 1);

  // Corner 4 of the first face: both edges leave along x.
  n = TwoQuads();
  n.edges.push_back({"", 0, 1, TangentsEdge{Vec3(9, 0, 0), Vec3(-9, 0, 0)}, false});
  n.edges.push_back({"", 0, 3, TangentsEdge{Vec3(9, 0, 0), Vec3(0, -9, 0)}, false});
  EXPECT_EQ(Count(n, "PARALLEL_TANGENTS"), 1);
}

// Whatever numbers an edge has: a finding, never a curve that is not there.
TEST(NetworkFindings, CurvesThatAreNone) {
  const auto count = [](const EdgeShape& shape, std::string_view code) {
    CurveNetwork n = TwoQuads();
    n.edges.push_back({"", 0, 3, shape, false});
    return Count(n, code);
  };
  const std::vector<Vec3> two = {Vec3(0, 0, 0), Vec3(0, 10, 0)};
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(count(CurveEdge{BezierCurve{}}, "UNSUPPORTED_CURVE"), 1);
  EXPECT_EQ(count(CurveEdge{BezierCurve{{two[0]}}}, "UNSUPPORTED_CURVE"), 1);
  EXPECT_EQ(count(CurveEdge{BezierCurve{std::vector<Vec3>(13, two[0])}}, "UNSUPPORTED_CURVE"), 1);
  EXPECT_EQ(count(CurveEdge{BezierCurve{{two[0], Vec3(0, 5, nan), two[1]}}}, "NOT_FINITE"), 1);
  EXPECT_EQ(count(CurveEdge{BsplineCurve{1, {0, 0, 1, 1}, two}}, "UNSUPPORTED_CURVE"), 0);
  EXPECT_EQ(count(CurveEdge{BsplineCurve{0, {0, 0, 1}, two}}, "UNSUPPORTED_CURVE"), 1);
  EXPECT_EQ(count(CurveEdge{BsplineCurve{1, {0, 0, 1}, two}}, "UNSUPPORTED_CURVE"), 1);
  EXPECT_EQ(count(CurveEdge{BsplineCurve{2, {0, 0, 0, 1, 1}, two}}, "UNSUPPORTED_CURVE"), 1);
  EXPECT_EQ(count(CurveEdge{BsplineCurve{1, {0, 1, 0, 1}, two}}, "UNSUPPORTED_CURVE"), 1);
  EXPECT_EQ(count(CurveEdge{BsplineCurve{1, {0, 0, nan, 1}, two}}, "UNSUPPORTED_CURVE"), 1);
  EXPECT_EQ(count(CurveEdge{BsplineCurve{1, {0, 0, 0, 1}, two}}, "UNSUPPORTED_CURVE"), 1);
  EXPECT_EQ(count(CurveEdge{HermiteCurve{two[0], Vec3(0, nan, 0), two[1], two[1]}}, "NOT_FINITE"), 1);
  EXPECT_EQ(count(TangentsEdge{Vec3::Zero(), two[1]}, "ZERO_TANGENT"), 1);
  EXPECT_EQ(count(ThroughPointEdge{Vec3(0, nan, 0)}, "NOT_FINITE"), 1);
  // All points in one place: the ends are there, the tangents are not.
  EXPECT_GE(count(CurveEdge{BezierCurve{{two[0], two[0], two[1], two[1]}}}, "PARALLEL_TANGENTS"), 1);
}

// Sound networks spoilt at random, a few places each: errors and no model, or one finite patch per face.
TEST(NetworkFindings, RandomDamageGivesFindingsOrFinitePatches) {
  testing::Random random(11);
  const double odd[] = {0.0,
                        -1.0,
                        1e-300,
                        1e10,
                        1e300,
                        std::numeric_limits<double>::quiet_NaN(),
                        std::numeric_limits<double>::infinity()};
  int refused = 0, made = 0;
  for (int round = 0; round < 3000; ++round) {
    CurveNetwork n = round % 2 == 0 ? TwoQuads() : testing::Cuboctahedron(static_cast<std::uint64_t>(round));
    const auto vertex = [&] { return random.Int(static_cast<int>(n.vertices.size()) + 1); };
    const auto number = [&] { return random.Int(2) == 0 ? odd[random.Int(7)] : 20 * random.Unit() - 10; };
    const auto point = [&] { return Vec3(number(), number(), number()); };
    const auto shape = [&]() -> EdgeShape {
      switch (random.Int(9)) {
        case 0:
          return NormalsEdge{number(), static_cast<TangentLength>(random.Int(3))};
        case 5:
          return PeakEdge{point()};
        case 6:
          return SlopeEdge{point(), random.Int(2) == 0 ? std::optional(point()) : std::nullopt};
        case 7:
          return LedEdge{
              {number()}, number(), point(), random.Int(2) == 0 ? std::optional(point()) : std::nullopt};
        case 8:
          return CurveEdge{
              HosakaSegment{point(), point(), point(), point(),
                            std::vector<Vec3>(static_cast<std::size_t>(random.Int(4)), point())}};
        case 1:
          return TangentsEdge{point(), point()};
        case 2:
          return ThroughPointEdge{point()};
        case 3:
          return CurveEdge{BezierCurve{std::vector<Vec3>(static_cast<std::size_t>(random.Int(14)), point())}};
        default:
          return CurveEdge{BsplineCurve{random.Int(4), {0, 0, number(), 1, 1}, {point(), point(), point()}}};
      }
    };
    for (int damage = 1 + random.Int(3); damage > 0; --damage) {
      NetworkVertex& v =
          n.vertices[static_cast<std::size_t>(random.Int(static_cast<int>(n.vertices.size())))];
      NetworkFace& f = n.faces[static_cast<std::size_t>(random.Int(static_cast<int>(n.faces.size())))];
      switch (random.Int(9)) {
        case 6:
          f.twists.push_back({vertex(), vertex(), point(), {}});
          break;
        case 7:
          f.twists.push_back({f.vertices[0], f.vertices[1], point(), point()});
          break;
        case 8:
          f.cuts.push_back({vertex(), f.vertices[2]});
          break;
        case 0:
          v.position[random.Int(3)] = number();
          break;
        case 1:
          v.normals = {{point(), {random.Int(static_cast<int>(n.faces.size()) + 1)}}};
          break;
        case 2:
          f.vertices[static_cast<std::size_t>(random.Int(3))] = vertex();
          break;
        case 3:
          f.scheme = static_cast<PatchScheme>(random.Int(7));
          break;
        default:
          n.edges.push_back(
              {"", f.vertices[0], f.vertices[random.Int(4) == 0 ? 2 : 1], shape(), random.Int(3) == 0});
      }
    }
    const JoinedNetwork joined = JoinNetwork(n);
    if (HasError(joined.findings)) {
      ++refused;
      EXPECT_TRUE(joined.model.patches.empty());
      continue;
    }
    ++made;
    std::size_t pieces = n.faces.size();
    for (const NetworkFace& f : n.faces) pieces += f.cuts.size();
    ASSERT_EQ(joined.model.patches.size(), pieces);
    ASSERT_EQ(joined.face_of.size(), pieces);
    for (const Patch& patch : joined.model.patches) {
      EXPECT_TRUE(Position(patch.shape, 0.3, 0.3).allFinite()) << "round " << round;
    }
  }
  EXPECT_GT(refused, 500);
  EXPECT_GT(made, 100);
}

// One fault, one finding: nothing that only follows from it.
TEST(NetworkFindings, OneEachAndNothingElse) {
  const auto expect = [](const CurveNetwork& n, const std::string& code, const std::string& field,
                         const std::string& text) {
    const Diagnostics findings = JoinNetwork(n).findings;
    std::string all;
    for (const Diagnostic& d : findings) all += d.code + ": " + d.message + "\n";
    ASSERT_EQ(findings.size(), 1u) << code << " in\n" << all;
    EXPECT_EQ(findings[0].code, code) << all;
    EXPECT_EQ(findings[0].severity, Severity::kError);
    EXPECT_EQ(findings[0].where.field, field) << all;
    EXPECT_NE(findings[0].message.find(text), std::string::npos) << all;
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto edge = [](int a, int b, EdgeShape shape = NormalsEdge{}, bool crease = false) {
    CurveNetwork n = TwoQuads();
    n.edges.push_back({"", a, b, std::move(shape), crease});
    return n;
  };

  CurveNetwork n = TwoQuads();
  n.vertices[2].position.x() = nan;
  expect(n, "NOT_FINITE", "network.vertices[2]", "position");
  expect(edge(0, 3, TangentsEdge{Vec3(0, nan, 0), Vec3(0, nan, 0)}), "NOT_FINITE", "network.edges[0]", "");
  expect(edge(1, 4, NormalsEdge{nan}), "INVALID_GAMMA", "network.edges[0]", "");
  n = TwoQuads();
  n.join_tolerance = nan;
  expect(n, "INVALID_JOIN_TOLERANCE", "network.join_tolerance", "must be > 0");

  n = TwoQuads();
  n.vertices[5].position = n.vertices[2].position;
  expect(n, "DUPLICATE_VERTEX", "network.vertices[5]", "vertices[2]");
  n = TwoQuads();
  n.vertices.push_back(n.vertices[1]);
  n.faces[1].vertices[0] = 6;
  expect(n, "DUPLICATE_VERTEX", "network.vertices[6]", "must name one vertex");

  expect(edge(2, 2), "ZERO_LENGTH_EDGE", "network.edges[0]", "same vertex");
  n = TwoQuads();
  n.faces[0].vertices = {0, 1, 1, 3};
  expect(n, "ZERO_LENGTH_EDGE", "network.faces[0]", "twice");

  expect(edge(0, 1, NormalsEdge{}, true), "CONTRADICTORY_CREASE", "network.edges[0]", "one face only");
  n = edge(1, 4, NormalsEdge{}, true);
  n.edges.push_back({"", 4, 1, NormalsEdge{}, false});
  expect(n, "DUPLICATE_EDGE", "network.edges[1]", "edges[0]");
  n = TwoQuads();
  n.lines.push_back({{0, 1, 2}, false, true});
  EXPECT_EQ(Count(n, "CONTRADICTORY_CREASE"), 2);  // two borders
  n = edge(1, 4, NormalsEdge{}, true);
  n.lines.push_back({{4, 1}, false, false});
  expect(n, "DUPLICATE_EDGE", "network.lines[0] between vertices 4 and 1", "edges[0]");

  expect(edge(0, 5), "DANGLING_EDGE", "network.edges[0]", "belongs to no face");
  n = TwoQuads();
  n.vertices.push_back({"", Vec3(10, 5, 9), {}});
  n.faces.push_back({"", {1, 4, 6}, PatchScheme::kAuto, {}});
  expect(n, "NON_MANIFOLD_EDGE", "network.vertices[1]", "has 3 faces");
  n = TwoQuads();
  n.vertices.push_back({"", Vec3(-9, -1, 0), {}});
  n.vertices.push_back({"", Vec3(-1, -9, 0), {}});
  n.faces.push_back({"", {0, 6, 7}, PatchScheme::kAuto, {}});
  expect(n, "NON_MANIFOLD_VERTEX", "network.vertices[0]", "one vertex to each");
  n = TwoQuads();
  n.vertices.push_back({"", Vec3(50, 0, 0), {}});
  expect(n, "UNUSED_VERTEX", "network.vertices[6]", "leave it out");

  n = TwoQuads();
  n.vertices[1].normals = {{Vec3(0, 0, 1), {0}}, {Vec3(0.3, 0, 1), {1}}};
  expect(n, "INCONSISTENT_NORMALS", "network.vertices[1]", "make it a crease");
  n = edge(1, 4, TangentsEdge{Vec3(0, 9, 1), Vec3(0, -9, 0)});
  n.vertices[1].normals = n.vertices[4].normals = {{Vec3(0, 0, 1), {}}};
  EXPECT_EQ(Count(n, "INCONSISTENT_NORMALS"), 2);  // one for each face it leaves
  n = TwoQuads();
  n.vertices[0].normals = {{Vec3(10, 0, 1), {}}};
  expect(n, "CHORD_ALONG_NORMAL", "network.vertices[0]", "from vertex 0 to 1");

  n = TwoQuads();
  n.vertices[2].position = Vec3(1, 0, 0.5);
  n.vertices[5].position = Vec3(1, 10, 0.5);
  n.vertices[1].normals = n.vertices[4].normals = {{Vec3(0, 0, 1), {}}};
  expect(n, "FOLDED_EDGE", "network.vertices[1]", "same side");
  n = edge(0, 1, TangentsEdge{Vec3(9, 0, 0), Vec3(-9, 0, 0)});
  n.edges.push_back({"", 0, 3, TangentsEdge{Vec3(9, 0, 0), Vec3(0, -9, 0)}, false});
  expect(n, "PARALLEL_TANGENTS", "network.faces[0]", "at vertex 0");
}

// The cuts that a face of too many sides could get, each of which makes faces that pass.
TEST(NetworkFindings, FacesOfManySidesSpellOutTheirCuts) {
  const auto ring = [](int sides) {
    CurveNetwork n;
    for (int k = 0; k < sides; ++k) {
      const double a = 2 * kPi * k / sides;
      n.vertices.push_back({"", Vec3(10 * std::cos(a), 10 * std::sin(a), std::sin(2 * a)), {}});
    }
    n.faces.resize(1);
    for (int k = 0; k < sides; ++k) n.faces[0].vertices.push_back(k);
    return n;
  };
  const auto message = [&](int sides) {
    const Diagnostics findings = JoinNetwork(ring(sides)).findings;
    EXPECT_EQ(findings.size(), 1u);
    EXPECT_EQ(findings.at(0).code, "FACE_SIDES");
    return findings.at(0).message;
  };
  EXPECT_NE(message(5).find("between vertices 0-2, 1-3, 2-4, 3-0 or 4-1, and give two faces"),
            std::string::npos)
      << message(5);
  EXPECT_NE(message(6).find("between vertices 0-3, 1-4 or 2-5, and give two faces of four sides"),
            std::string::npos)
      << message(6);
  EXPECT_NE(message(8).find("for instance between vertices 0-3, 0-5, that leave"), std::string::npos)
      << message(8);
  EXPECT_LT(message(5000).size(), 500u);
  for (int k = 0; k < 5; ++k) {
    CurveNetwork n = ring(5);
    const auto at = [&](int i) { return (k + i) % 5; };
    n.faces = {{"", {at(0), at(1), at(2)}, PatchScheme::kAuto, {}},
               {"", {at(2), at(3), at(4), at(0)}, PatchScheme::kAuto, {}}};
    EXPECT_TRUE(JoinNetwork(n).findings.empty());
  }
}

// A spline with a corner is no edge: the finding has the place, and taken part by part the same curve passes.
TEST(NetworkFindings, CurvesWithCornersTellWhereVerticesBelong) {
  const BsplineCurve spline{
      2,
      {0, 0, 0, 1, 1, 2, 2, 2},
      {Vec3(0, 0, 0), Vec3(1, 3, 2), Vec3(0, 5.5, 1.5), Vec3(-2, 8, 2), Vec3(0, 10, 0)}};
  CurveNetwork n = TwoQuads();
  n.edges.push_back({"", 0, 3, CurveEdge{spline}, false});
  const Diagnostics findings = JoinNetwork(n).findings;
  ASSERT_EQ(findings.size(), 1u);
  EXPECT_EQ(findings[0].code, "UNSUPPORTED_CURVE");
  EXPECT_NE(findings[0].message.find("first derivative jumps at (0, 5.5, 1.5): insert a vertex there"),
            std::string::npos)
      << findings[0].message;

  n = TwoQuads();
  n.vertices.push_back({"", Vec3(0, 5.5, 1.5), {}});
  n.faces[0].vertices = {0, 1, 6};
  n.faces.push_back({"", {6, 1, 4, 3}, PatchScheme::kAuto, {}});
  for (const auto& [first, start, end] : {std::tuple(0, 0, 6), std::tuple(2, 6, 3)}) {
    const auto p = spline.points.begin() + first;
    n.edges.push_back({"", start, end, CurveEdge{BezierCurve{{p, p + 3}}}, false});
  }
  const JoinedNetwork joined = JoinNetwork(n);
  ASSERT_TRUE(joined.findings.empty()) << joined.findings[0].message;
  EXPECT_LE((Position(joined.model.patches[2].shape, 0.0, 0.5) - Evaluate(spline, 0.75).p).norm(), 1e-12);
}

TEST(NetworkFindings, AllAtOnce) {
  CurveNetwork n = TwoQuads();
  n.vertices[0].normals = {{Vec3::Zero(), {}}};
  n.edges.push_back({"", 0, 5, NormalsEdge{}, false});
  n.edges.push_back({"", 0, 1, NormalsEdge{}, true});
  n.vertices.push_back({"", Vec3(50, 0, 0), {}});
  const Diagnostics findings = JoinNetwork(n).findings;
  for (const char* code : {"INVALID_NORMAL", "DANGLING_EDGE", "CONTRADICTORY_CREASE", "UNUSED_VERTEX"}) {
    EXPECT_EQ(std::ranges::count(findings, code, &Diagnostic::code), 1) << code;
  }
}

}  // namespace
}  // namespace patchmill
