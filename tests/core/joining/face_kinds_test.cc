// Hosaka faces in networks, alone and beside others, along whole edges and parts; faces cut into pieces.
#include <algorithm>
#include <cmath>
#include <set>

#include <gtest/gtest.h>

#include "core/base/index.h"
#include "tests/core/joining/expect_smooth.h"
#include "tests/core/joining/networks.h"

namespace patchmill {
namespace {

using testing::ExpectSmooth;
using testing::Text;

// [shapes (23)] by hand, S0 = 0: at (u, v), from the four edges of the patch itself.
TEST(HosakaFaces, AreTheFormulaOfTheirEdges) {
  CurveNetwork network = testing::Cuboctahedron(4);
  for (NetworkFace& face : network.faces) {
    if (face.vertices.size() == 4) face.scheme = PatchScheme::kHosaka;
  }
  const JoinedNetwork joined = JoinNetwork(network);
  ExpectSmooth(joined, 24);  // quads lead, triangles follow
  for (int f = 0; f < 6; ++f) {
    const PatchShape& shape = joined.model.patches[At(f)].shape;
    ASSERT_TRUE(std::holds_alternative<HosakaPatch>(shape));
    const auto edge = [&](double u, double v) { return Position(shape, u, v); };
    const auto step = [](double t) { return t * t * (3 - 2 * t); };
    for (const Vec2& q : {Vec2(0.3, 0.6), Vec2(0.9, 0.2)}) {
      const double u = q.x(), v = q.y();
      const Vec3 r1 = edge(u, 0) - edge(0, 0), r3 = edge(u, 1) - edge(0, 1), r2 = edge(0, v) - edge(0, 0),
                 r4 = edge(1, v) - edge(1, 0), gap = (edge(1, 0) - edge(0, 0)) - (edge(1, 1) - edge(0, 1));
      const Vec3 want =
          edge(0, 0) + r1 + (r3 - r1) * step(v) + r2 + (r4 - r2) * step(u) + gap * step(u) * step(v);
      EXPECT_LE((edge(u, v) - want).norm(), 1e-13 * 20);
    }
    // Its sides run along the joined edges.
    for (const JoinedEdge& e : joined.edges) {
      for (const FaceSide& s : e.topology.faces) {
        if (s.face != f) continue;
        const bool forward = e.topology.start == network.faces[At(f)].vertices[At(s.side)];
        const double t = forward ? 0.3 : 0.7;
        const Vec2 at[4] = {{0.3, 0}, {1, 0.3}, {0.7, 1}, {0, 0.7}};
        EXPECT_LE((edge(at[s.side].x(), at[s.side].y()) - Evaluate(e.curve, t).p).norm(), 1e-12 * 20);
      }
    }
  }
}

// Two faces of the kind, and one along halves of the other: end tangents run on with one ratio.
struct Pair {
  CurveNetwork network;
  Vec3 left_low{-9, 1, 2}, left_high{-10, 0, -3};
};
Pair TwoBeside(double ratio_low, double ratio_high) {
  Pair pair;
  CurveNetwork& n = pair.network;
  for (const Vec3& p :
       {Vec3(-12, 0, 1), Vec3(0, 0, 0), Vec3(9, -1, -2), Vec3(-11, 14, 2), Vec3(0, 15, 3), Vec3(10, 14, 5)}) {
    n.vertices.push_back({"", p, {}});
  }
  n.faces = {{"", {0, 1, 4, 3}, PatchScheme::kHosaka, {}}, {"", {1, 2, 5, 4}, PatchScheme::kHosaka, {}}};
  n.edges = {{"", 1, 0, TangentsEdge{pair.left_low, Vec3(9, 0, 1)}, false},
             {"", 4, 3, TangentsEdge{pair.left_high, Vec3(9, 0, 1)}, false},
             {"", 1, 2, TangentsEdge{-ratio_low * pair.left_low, Vec3(-9, 0, 1)}, false},
             {"", 4, 5, TangentsEdge{-ratio_high * pair.left_high, Vec3(-9, 0, 1)}, false},
             {"", 1, 4, TangentsEdge{Vec3(1, 13, 4), Vec3(1, -14, 2)}, false}};
  return pair;
}

TEST(HosakaFaces, ShareTheirPlaneInOneRatio) {
  ExpectSmooth(JoinNetwork(TwoBeside(0.8, 0.8).network), 1);
  const Diagnostics findings = JoinNetwork(TwoBeside(0.8, 1.3).network).findings;
  ASSERT_EQ(findings.size(), 1u) << Text(findings);
  EXPECT_EQ(findings[0].code, "HOSAKA_RATIO");
  EXPECT_EQ(findings[0].where.field, "network.edges[4]");
  // A Brown quad beside it follows in any ratio; on a crease neither need.
  Pair follows = TwoBeside(0.8, 1.3);
  follows.network.faces[1].scheme = PatchScheme::kBrown;
  ExpectSmooth(JoinNetwork(follows.network), 1);
  Pair crease = TwoBeside(0.8, 1.3);
  crease.network.edges[4].crease = true;
  EXPECT_TRUE(JoinNetwork(crease.network).findings.empty());
}

// [joining (14)]: the long face's blending function has a break f(v) = v at the junction; faces along the
// parts share its plane, of the same kind in its ratio or of another in any.
TEST(HosakaFaces, MeetAlongPartsOfAnEdge) {
  for (const auto scheme : {PatchScheme::kHosaka, PatchScheme::kBrown}) {
    Pair pair = TwoBeside(0.8, 0.8);
    CurveNetwork& n = pair.network;
    const double at = 0.37;
    const Vec3 there = pair.left_low + at * (pair.left_high - pair.left_low);
    n.vertices.push_back({});
    n.vertices[6].on_edge = {4, 1, 1.0 - at};
    n.vertices.push_back({"", Vec3(9, 7, 2), {}});
    n.faces[1] = {"", {1, 2, 7, 6}, scheme, {}};
    n.faces.push_back({"", {5, 7, 6, 4}, scheme, {}});
    // Between the two: the parts at 6, and what leaves 7, in one ratio too.
    const Vec3 along(0.5, 14, 5);
    n.edges.push_back({"", 7, 2, TangentsEdge{-at * along, Vec3(0, 7, 3)}, false});
    n.edges.push_back({"", 7, 5, TangentsEdge{(1 - at) * along, Vec3(0, -7, -2)}, false});
    n.edges.push_back({"", 6, 7, TangentsEdge{-0.8 * there, Vec3(-9, 1, 1)}, false});
    const JoinedNetwork joined = JoinNetwork(n);
    ExpectSmooth(joined, 3);
    const auto& leader = std::get<HosakaPatch>(joined.model.patches[0].shape);
    ASSERT_EQ(leader.breaks[3].size(), 1u);  // u = 1
    EXPECT_NEAR(leader.breaks[3][0].at, at, 1e-15);
    EXPECT_EQ(leader.breaks[3][0].value, leader.breaks[3][0].at);
    if (scheme == PatchScheme::kBrown) continue;
    n.edges.back().shape = TangentsEdge{-1.2 * there, Vec3(-9, 1, 1)};
    EXPECT_EQ(std::ranges::count(JoinNetwork(n).findings, "HOSAKA_RATIO", &Diagnostic::code), 2);
  }
}

TEST(HosakaFaces, SayWhatTheyAreNotFor) {
  const auto expect = [](CurveNetwork n, const std::string& text) {
    const Diagnostics findings = JoinNetwork(n).findings;
    ASSERT_FALSE(findings.empty());
    EXPECT_EQ(findings[0].code, "UNSUPPORTED_SCHEME") << Text(findings);
    EXPECT_NE(findings[0].message.find(text), std::string::npos) << findings[0].message;
  };
  CurveNetwork n = TwoBeside(0.8, 0.8).network;
  n.faces[0].pushes.push_back({0.5, 0.5, 0.1});
  expect(n, "no twists at its corners");
  n = TwoBeside(0.8, 1.3).network;
  n.faces[1].scheme = PatchScheme::kBrown;
  n.faces[1].twists.push_back({4, 1, Vec3(0, 0, 1), {}});
  const Diagnostics follows = JoinNetwork(n).findings;
  ASSERT_EQ(follows.size(), 1u) << Text(follows);
  EXPECT_EQ(follows[0].code, "INVALID_TWIST");
  EXPECT_NE(follows[0].message.find("where it follows faces[0]"), std::string::npos) << follows[0].message;
  n = TwoBeside(0.8, 0.8).network;
  n.faces[1].vertices = {1, 2, 4};
  n.vertices.pop_back();
  n.edges.erase(n.edges.begin() + 3);
  expect(n, "for 4 sides, the face has 3");
}

// --- Cuts ---

CurveNetwork Ring(int sides) {
  CurveNetwork n;
  for (int k = 0; k < sides; ++k) {
    const double a = 2 * kPi * k / sides;
    n.vertices.push_back({"", Vec3(10 * std::cos(a), 10 * std::sin(a), std::sin(2 * a)), {}});
  }
  n.faces.resize(1);
  n.faces[0].id = "face";
  for (int k = 0; k < sides; ++k) n.faces[0].vertices.push_back(k);
  return n;
}

TEST(Cuts, MakeThePiecesThatFacesWouldBe) {
  CurveNetwork cut = Ring(5), faces = Ring(5);
  cut.faces[0].cuts = {{3, 1}};
  faces.faces = {{"face", {1, 2, 3}, PatchScheme::kAuto, {}},
                 {"face/2", {3, 4, 0, 1}, PatchScheme::kAuto, {}}};
  // The inserted edge may say what curve it is.
  for (const bool given : {false, true}) {
    if (given) {
      for (CurveNetwork* n : {&cut, &faces}) n->edges.push_back({"", 1, 3, NormalsEdge{1.3}, false});
    }
    const JoinedNetwork a = JoinNetwork(cut), b = JoinNetwork(faces);
    ExpectSmooth(a, 1);
    ASSERT_EQ(a.model.patches.size(), 2u);
    for (int f = 0; f < 2; ++f) {
      EXPECT_EQ(a.model.patches[At(f)].id, b.model.patches[At(f)].id);
      EXPECT_EQ(a.model.patches[At(f)].shape.index(), b.model.patches[At(f)].shape.index());
      EXPECT_EQ(Position(a.model.patches[At(f)].shape, 0.3, 0.4),
                Position(b.model.patches[At(f)].shape, 0.3, 0.4));
    }
  }
}

// Twelve sides into five quads; further pieces come after the other faces, which keep their numbers.
TEST(Cuts, OfManySides) {
  CurveNetwork n = Ring(12);
  n.faces[0].cuts = {{0, 3}, {0, 9}, {3, 6}, {6, 9}};
  n.faces[0].scheme = PatchScheme::kBrown;
  n.vertices.push_back({"", Vec3(14, 3, 2), {}});
  n.vertices[0].normals = {{Vec3(0.1, 0, 1), {0}}, {Vec3(0.1, 0, 1), {1}}};
  n.faces.push_back({"other", {0, 12, 1}, PatchScheme::kAuto, {}});
  const JoinedNetwork joined = JoinNetwork(n);
  ExpectSmooth(joined, 5);
  ASSERT_EQ(joined.model.patches.size(), 6u);
  EXPECT_EQ(joined.model.patches[1].id, "other");
  std::set<std::string> ids;
  for (const Patch& patch : joined.model.patches) ids.insert(patch.id);
  EXPECT_EQ(ids, (std::set<std::string>{"face", "face/2", "face/3", "face/4", "face/5", "other"}));
  for (const JoinedEdge& edge : joined.edges) {
    if (edge.topology.start != 0 && edge.topology.end != 0) continue;
    const CurveJet jet = Evaluate(edge.curve, edge.topology.start == 0 ? 0.0 : 1.0);
    EXPECT_NEAR(jet.d.normalized().dot(Vec3(0.1, 0, 1).normalized()), 0, 1e-12);
  }
}

TEST(Cuts, BadOnesAreOneFinding) {
  const auto expect = [](const CurveNetwork& n, const std::string& code, const std::string& text) {
    const Diagnostics findings = JoinNetwork(n).findings;
    ASSERT_EQ(findings.size(), 1u) << Text(findings);
    EXPECT_EQ(findings[0].code, code);
    EXPECT_EQ(findings[0].where.patch_id, "face");
    EXPECT_NE(findings[0].message.find(text), std::string::npos) << findings[0].message;
  };
  const auto cut = [](int sides, std::vector<std::array<int, 2>> cuts) {
    CurveNetwork n = Ring(sides);
    n.faces[0].cuts = std::move(cuts);
    return n;
  };
  expect(cut(5, {{0, 1}}), "INVALID_CUT", "from vertex 0 to 1");
  expect(cut(5, {{0, 0}}), "INVALID_CUT", "from vertex 0 to 0");
  expect(cut(5, {{0, 77}}), "INVALID_CUT", "from vertex 0 to 77");
  expect(cut(6, {{0, 3}, {1, 4}}), "INVALID_CUT", "from vertex 1 to 4");  // they cross
  expect(cut(7, {{0, 2}}), "FACE_SIDES", "has 6 sides");
  CurveNetwork pushed = cut(5, {{0, 2}});
  pushed.faces[0].pushes.push_back({0.2, 0.2, 0.1});
  expect(pushed, "INVALID_CUT", "is pushed");
  CurveNetwork twisted = cut(5, {{0, 2}});
  twisted.faces[0].twists.push_back({2, 0, {}, {}});
  EXPECT_TRUE(JoinNetwork(twisted).findings.empty());  // of the inserted edge, on the first piece
}

}  // namespace
}  // namespace patchmill
