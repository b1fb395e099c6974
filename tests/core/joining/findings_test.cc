// Bad networks: each fault found by its code, all at once, none crashes.
#include <algorithm>
#include <limits>

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
      switch (random.Int(5)) {
        case 0:
          return NormalsEdge{number()};
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
      switch (random.Int(6)) {
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
          f.scheme = static_cast<PatchScheme>(random.Int(5));
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
    ASSERT_EQ(joined.model.patches.size(), n.faces.size());
    for (const Patch& patch : joined.model.patches) {
      EXPECT_TRUE(Position(patch.shape, 0.3, 0.3).allFinite()) << "round " << round;
    }
  }
  EXPECT_GT(refused, 500);
  EXPECT_GT(made, 100);
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
