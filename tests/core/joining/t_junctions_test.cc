// Vertices on edges: faces along parts of an edge follow the one along the whole of it.
#include <algorithm>
#include <cmath>
#include <set>

#include <gtest/gtest.h>

#include "core/base/index.h"
#include "core/joining/continuity.h"
#include "core/joining/join_network.h"
#include "core/joining/network_findings.h"
#include "tests/core/joining/networks.h"

namespace patchmill {
namespace {

using testing::Text;

NetworkVertex OnEdge(int start, int end, double parameter) {
  NetworkVertex v;
  v.on_edge = {start, end, parameter};
  return v;
}

NetworkVertex Free(const Vec3& p) { return {"", p, {}}; }

// A wavy sheet over [-10, 20] x [0, 30]: one long face to the left of the line x = 0, `parts` quads of
// unequal width to its right, a triangle in place of the last of them.
CurveNetwork Sheet(int parts, bool triangle, std::uint64_t seed) {
  testing::Random random(seed);
  const auto wave = [&](double x, double y) -> Vec3 {
    return Vec3(x, y, 4 * std::sin(0.15 * x + 0.1 * y) + 2 * std::cos(0.12 * y)) + random.Point(-0.5, 0.5);
  };
  CurveNetwork n;
  n.vertices = {Free(wave(-10, 0)),  Free(wave(0, 0)),  Free(wave(0, 30)),
                Free(wave(-10, 30)), Free(wave(20, 0)), Free(wave(20, 30))};
  n.faces.push_back({"long", {0, 1, 2, 3}, PatchScheme::kAuto, {}});
  int from = 1, far = 4;
  for (int k = 1; k <= parts; ++k) {
    const double at = k * (0.6 + 0.4 * k / parts) / parts;
    int to = 2, next = 5;
    if (k < parts) {
      to = static_cast<int>(n.vertices.size());
      // Named from either end.
      n.vertices.push_back(k % 2 == 1 ? OnEdge(1, 2, at) : OnEdge(2, 1, 1.0 - at));
      const bool last = triangle && k + 1 == parts;
      next = last ? 5 : static_cast<int>(n.vertices.size());
      if (!last) n.vertices.push_back(Free(wave(20, 30 * at)));
    }
    std::vector<int> loop = {from, far, next, to};
    if (far == next) loop = {from, far, to};
    std::rotate(loop.begin(), loop.begin() + random.Int(static_cast<int>(loop.size())), loop.end());
    if (random.Int(2) == 0) std::reverse(loop.begin(), loop.end());
    n.faces.push_back({"", loop, PatchScheme::kAuto, {}});
    from = to, far = next;
  }
  return n;
}

// All joints of the patches, those at T-junctions as many as `parts`, and all of one plane where `smooth`.
void ExpectJoined(const CurveNetwork& network, std::size_t parts, bool smooth = true) {
  const JoinedNetwork joined = JoinNetwork(network);
  ASSERT_FALSE(HasError(joined.findings)) << Text(joined.findings);
  const auto patches = BuildNetwork(joined.model);
  ASSERT_TRUE(patches.ok());
  EXPECT_EQ(patches->part_links.size(), parts);
  const auto report = MeasureContinuity(*patches, 200, RunContext(1));
  ASSERT_TRUE(report.ok());
  std::size_t seen = 0;
  for (const EdgeContinuity& joint : report->edges) {
    EXPECT_LE(joint.max_gap, 1e-11);  // places on a long edge are found to about 1e-13 of it
    seen += joint.part;
    if (joint.part && !smooth) {
      EXPECT_GT(joint.max_angle, 1e-2);
    } else {
      EXPECT_LE(joint.max_angle, 1e-11) << joint.a.patch.value << "/" << joint.b.patch.value;
    }
  }
  EXPECT_EQ(seen, parts);
}

TEST(TJunctions, FacesAlongPartsShareTheTangentPlane) {
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    for (const int parts : {2, 3, 5}) {
      for (const bool triangle : {false, true}) {
        SCOPED_TRACE(::testing::Message() << seed << " " << parts << " " << triangle);
        ExpectJoined(Sheet(parts, triangle, seed), At(parts));
      }
    }
  }
}

// The long face stays as it is without the others: it leads.
TEST(TJunctions, LeadingFaceIsNotMoved) {
  CurveNetwork whole = Sheet(3, false, 7);
  for (int v : {0, 1, 2, 3}) whole.vertices[At(v)].normals = {{Vec3(0.1 * v, -0.1, 1), {}}};
  CurveNetwork alone = whole;
  alone.faces.resize(1);
  alone.vertices.resize(4);
  const JoinedNetwork joined = JoinNetwork(whole), by_itself = JoinNetwork(alone);
  ASSERT_TRUE(joined.findings.empty()) << Text(joined.findings);
  ASSERT_EQ(by_itself.model.patches.size(), 1u);
  for (const Vec2& uv : {Vec2(0.2, 0.3), Vec2(0.9, 0.5), Vec2(1, 0.7)}) {
    EXPECT_EQ(Position(joined.model.patches[0].shape, uv.x(), uv.y()),
              Position(by_itself.model.patches[0].shape, uv.x(), uv.y()));
  }
}

// The vertex lies on the curve at its parameter, and an inner break value of the curve is the part's end.
TEST(TJunctions, VertexLiesOnTheCurveAtItsParameter) {
  CurveNetwork n = Sheet(2, false, 3);
  n.vertices[6].on_edge->parameter = 0.3;
  const JoinedNetwork joined = JoinNetwork(n);
  ASSERT_TRUE(joined.findings.empty()) << Text(joined.findings);
  const auto edge = [&](int a, int b) {
    const auto it = std::ranges::find_if(joined.edges, [&](const JoinedEdge& e) {
      return std::minmax(e.topology.start, e.topology.end) == std::minmax(a, b);
    });
    EXPECT_NE(it, joined.edges.end());
    return it->topology.start == a ? it->curve : Reversed(it->curve);
  };
  const BezierChain whole = edge(1, 2), first = edge(1, 6), second = edge(6, 2);
  for (const double t : {0.0, 0.3, 0.7, 1.0}) {
    EXPECT_LE((Evaluate(first, t).p - Evaluate(whole, 0.3 * t).p).norm(), 1e-13 * 30);
    EXPECT_LE((Evaluate(second, t).p - Evaluate(whole, 0.3 + 0.7 * t).p).norm(), 1e-13 * 30);
  }
}

// Pushes, curves of higher degree, other schemes on either side.
TEST(TJunctions, HoldsForPushedFacesGivenCurvesAndOtherSchemes) {
  CurveNetwork n = Sheet(3, true, 5);
  n.faces[0].pushes = {{0.7, 0.4, 0.2}};
  ExpectJoined(n, 3);
  n.faces[1].pushes = {{0.5, 0.5, -0.1}};
  ExpectJoined(n, 3);

  n = Sheet(3, false, 6);
  const Vec3 a = n.vertices[1].position, b = n.vertices[2].position;
  n.edges.push_back({"", 2, 1,
                     CurveEdge{BezierCurve{{b, b + Vec3(2, -6, 1), b + Vec3(3, -12, 3), a + Vec3(-1, 9, 2),
                                            a + Vec3(2, 5, -1), a}}},
                     false});
  ExpectJoined(n, 3);
  n.faces[0].scheme = n.faces[2].scheme = PatchScheme::kBrown;
  ExpectJoined(n, 3);

  n = Sheet(3, true, 8);
  n.faces[3].scheme = PatchScheme::kGregoryTriangle;
  ExpectJoined(n, 3);
  n.faces[0].scheme = n.faces[1].scheme = PatchScheme::kG2Gregory;
  ExpectJoined(n, 3);
  EXPECT_GE(std::ranges::count(JoinNetwork(n).findings, "TANGENT_PLANE_ONLY", &Diagnostic::code), 2);
}

TEST(TJunctions, ACreaseNeedsNoCommonPlane) {
  CurveNetwork n = Sheet(2, false, 2);
  for (const int v : {0, 3}) n.vertices[At(v)].position.z() += 9;
  n.edges.push_back({"", 1, 2, NormalsEdge{}, true});
  ExpectJoined(n, 2, false);
  // Normals on both sides: the curve leaves its ends in both planes.
  const int right = n.vertices[6].on_edge ? 6 : 7;
  n.vertices[1].normals = {{Vec3(-0.8, 0.1, 1), {0}}, {Vec3(0.2, -0.1, 1), {1}}};
  n.vertices[2].normals = {{Vec3(-0.9, 0, 1), {0}}, {Vec3(0.1, 0.2, 1), {2}}};
  ExpectJoined(n, 2, false);
  // And on the edge: a normal across the curve there, which only a curve that is known allows.
  n.edges[0].shape = CurveEdge{BezierCurve{{n.vertices[1].position, n.vertices[2].position}}};
  n.vertices[1].normals.clear(), n.vertices[2].normals.clear();
  const Vec3 along = n.vertices[2].position - n.vertices[1].position;
  n.vertices[At(right)].normals = {{along.cross(Vec3(-1, 0.2, 0.1)), {}}};
  ExpectJoined(n, 2, false);
  n.vertices[At(right)].normals = {{along.cross(Vec3(-1, 0.2, 0.1)) + 0.1 * along, {}}};
  EXPECT_TRUE(HasError(JoinNetwork(n).findings));
}

// One place only of the faces beyond: a side on a part of the edge, the rest of it is a border
// [joining, section 6].
TEST(TJunctions, AFaceMayLieAlongAnInnerPartOnly) {
  CurveNetwork n = Sheet(3, false, 4);
  n.faces.erase(n.faces.begin() + 3);
  n.faces.erase(n.faces.begin() + 1);
  std::set<int> used;
  for (const NetworkFace& f : n.faces) used.insert(f.vertices.begin(), f.vertices.end());
  std::vector<int> renamed(n.vertices.size(), -1);
  CurveNetwork left;
  for (const int v : used) {
    renamed[At(v)] = static_cast<int>(left.vertices.size());
    left.vertices.push_back(n.vertices[At(v)]);
  }
  for (NetworkVertex& v : left.vertices) {
    if (v.on_edge)
      v.on_edge->start = renamed[At(v.on_edge->start)], v.on_edge->end = renamed[At(v.on_edge->end)];
  }
  for (NetworkFace f : n.faces) {
    for (int& v : f.vertices) v = renamed[At(v)];
    left.faces.push_back(f);
  }
  ExpectJoined(left, 1);
}

// A face beside one junction leads at the next: places wait for each other in a chain.
TEST(TJunctions, AChainIsFoundInItsOrder) {
  CurveNetwork n = Sheet(2, false, 9);
  // Faces 1 and 2 meet in the edge from vertex 6, on the long edge, to vertex 7. Its second half: two faces.
  const int a = 6, b = 7;
  NetworkFace& split = *std::ranges::find_if(
      n.faces, [](const NetworkFace& f) { return std::ranges::count(f.vertices, 5) > 0 && f.id.empty(); });
  split.vertices = {a, 8, 9, 2};
  n.vertices.push_back(OnEdge(a, b, 0.4));
  n.vertices.push_back(Free(0.5 * (n.vertices[2].position + n.vertices[5].position) + Vec3(0.3, 0.2, 0.8)));
  n.faces.push_back({"", {8, b, 5, 9}, PatchScheme::kAuto, {}});
  ExpectJoined(n, 4);
  // The vertices in another order: the same patches.
  CurveNetwork swapped = n;
  std::swap(swapped.vertices[6], swapped.vertices[8]);
  const auto rename = [](int& v) { v = v == 6 ? 8 : v == 8 ? 6 : v; };
  for (NetworkFace& f : swapped.faces) std::ranges::for_each(f.vertices, rename);
  for (NetworkVertex& v : swapped.vertices) {
    if (v.on_edge) rename(v.on_edge->start), rename(v.on_edge->end);
  }
  const JoinedNetwork first = JoinNetwork(n), second = JoinNetwork(swapped);
  ASSERT_EQ(second.model.patches.size(), first.model.patches.size()) << Text(second.findings);
  for (std::size_t k = 0; k < first.model.patches.size(); ++k) {
    EXPECT_LE(
        (Position(first.model.patches[k].shape, 0.3, 0.4) - Position(second.model.patches[k].shape, 0.3, 0.4))
            .norm(),
        1e-12);
  }
}

TEST(TJunctions, LengthsScaleWithTheNetwork) {
  CurveNetwork n = Sheet(3, true, 12), big = n;
  for (NetworkVertex& v : big.vertices) v.position *= 8.0;
  const JoinedNetwork a = JoinNetwork(n), b = JoinNetwork(big);
  ASSERT_EQ(b.model.patches.size(), 4u);
  for (std::size_t k = 0; k < 4; ++k) {
    EXPECT_LE(
        (8.0 * Position(a.model.patches[k].shape, 0.3, 0.4) - Position(b.model.patches[k].shape, 0.3, 0.4))
            .norm(),
        1e-12 * 240);
  }
}

Diagnostic OnlyFinding(const CurveNetwork& network) {
  const JoinedNetwork joined = JoinNetwork(network);
  EXPECT_EQ(joined.findings.size(), 1u) << Text(joined.findings);
  EXPECT_TRUE(joined.model.patches.empty());
  return joined.findings.empty() ? Diagnostic{} : joined.findings[0];
}

TEST(TJunctions, BadOnesAreOneFindingEach) {
  const auto expect = [](const CurveNetwork& n, const std::string& code, const std::string& text) {
    const Diagnostic d = OnlyFinding(n);
    EXPECT_EQ(d.code, code) << d.message;
    EXPECT_NE(d.message.find(text), std::string::npos) << d.message;
  };
  const std::string bad = "INVALID_T_VERTEX";
  CurveNetwork n = Sheet(2, false, 1);
  for (const double at : {0.0, 1.0, -1.0, 1e-4, std::nan("")}) {
    n.vertices[6].on_edge->parameter = at;
    expect(n, bad, "must be in [0.001, 0.999]");
  }
  n = Sheet(2, false, 1);
  n.vertices[6].on_edge->end = 99;
  expect(n, "INVALID_REFERENCE", "lies on an edge of vertex 99");
  n.vertices[6].on_edge->end = 1;
  expect(n, bad, "must be two others");
  n.vertices[6].on_edge->end = 6;
  expect(n, bad, "must be two others");
  n.vertices[6].on_edge->end = 5;
  expect(n, bad, "which is a side of 0 faces");

  n = Sheet(2, false, 1);
  n.vertices[6].normals = {{Vec3(0, 0, 1), {}}};
  expect(n, bad, "has a normal, but lies on a smooth edge");

  n = Sheet(2, false, 1);
  n.edges.push_back({"", 1, 6, NormalsEdge{}, false});
  expect(n, bad, "that part is listed");

  n = Sheet(3, false, 1);
  n.vertices[8].on_edge = n.vertices[6].on_edge;
  n.vertices[8].on_edge->parameter += 1e-5;
  expect(n, bad, "on their edge; must be at least");

  n = Sheet(2, false, 1);
  n.lines.push_back({{0, 6}, false, false});
  expect(n, "INVALID_LINE", "lies on an edge and has no place");

  // The long face takes the place as a corner of its own.
  n = Sheet(2, false, 1);
  n.faces[0].vertices = {6, 1, 2};
  n.vertices.erase(n.vertices.begin() + 3);
  n.vertices.erase(n.vertices.begin());
  for (NetworkFace& f : n.faces) {
    for (int& v : f.vertices) v -= v > 3 ? 2 : 1;
  }
  for (NetworkVertex& v : n.vertices) {
    if (v.on_edge) v.on_edge->start -= 1, v.on_edge->end -= 1;
  }
  expect(n, bad, "and is a corner of it");

  // Two faces along one part.
  n = Sheet(2, false, 1);
  n.vertices.push_back(Free(Vec3(10, 5, 20)));
  n.faces.push_back({"", {1, 6, 8}, PatchScheme::kAuto, {}});
  expect(n, "NON_MANIFOLD_EDGE", "a part");

  // A side past a place.
  n = Sheet(3, false, 1);
  n.faces.back() = {"", {6, 9, 5, 2}, PatchScheme::kAuto, {}};
  EXPECT_EQ(std::ranges::count(JoinNetwork(n).findings, bad, &Diagnostic::code), 1)
      << Text(JoinNetwork(n).findings);
}

// Four long faces around a square, each beside a side of it and of the next one: no place is known first.
TEST(TJunctions, AWheelWaitsForItself) {
  CurveNetwork n;
  for (const Vec3& p : {Vec3(10, -1, 0), Vec3(1, 10, 1), Vec3(-10, 1, 0), Vec3(-1, -10, 1), Vec3(10, -10, 0),
                        Vec3(10, 10, 0), Vec3(-10, 10, 0), Vec3(-10, -10, 0)}) {
    n.vertices.push_back(Free(p));
  }
  for (int k = 0; k < 4; ++k) n.vertices.push_back(OnEdge(8 + (k + 3) % 4, (k + 3) % 4, 0.2));
  n.faces.push_back({"", {8, 9, 10, 11}, PatchScheme::kAuto, {}});
  for (int k = 0; k < 4; ++k) {
    n.faces.push_back({"", {8 + k, k, 4 + k, (k + 3) % 4}, PatchScheme::kAuto, {}});
  }
  EXPECT_EQ(OnlyFinding(n).code, "T_VERTEX_CYCLE");
}

TEST(TJunctions, ACancelEndsTheJoining) {
  RunContext run(1);
  run.Cancel();
  EXPECT_EQ(JoinNetwork(Sheet(3, true, 2), run).status().code(), absl::StatusCode::kCancelled);
}

}  // namespace
}  // namespace patchmill
