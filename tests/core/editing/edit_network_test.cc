// Edits: each does what it says, the faces beside follow smoothly, the rest stays to the bit.
#include "core/editing/edit_network.h"

#include <algorithm>
#include <cmath>
#include <set>

#include <gtest/gtest.h>

#include "core/base/index.h"
#include "core/editing/section_points.h"
#include "core/joining/continuity.h"
#include "core/joining/join_network.h"
#include "core/network/control_points.h"
#include "tests/core/joining/networks.h"
#include "tests/support/known_surfaces.h"

namespace patchmill {
namespace {

JoinedNetwork Join(const CurveNetwork& network) {
  JoinedNetwork joined = JoinNetwork(network);
  EXPECT_TRUE(joined.findings.empty()) << joined.findings[0].message;
  return joined;
}

CurveNetwork Edited(const CurveNetwork& network, const std::vector<NetworkEdit>& edits) {
  const auto edited = EditNetwork(network, edits);
  EXPECT_TRUE(edited.ok()) << edited.status();
  return edited->network;
}

// Faces whose patches differ in any bit.
std::set<int> Changed(const JoinedNetwork& a, const JoinedNetwork& b) {
  std::set<int> changed;
  for (std::size_t f = 0; f < a.model.patches.size(); ++f) {
    const auto p = ControlPoints(std::as_const(a.model.patches[f].shape)),
               q = ControlPoints(std::as_const(b.model.patches[f].shape));
    if (!std::ranges::equal(p, q)) changed.insert(static_cast<int>(f));
  }
  return changed;
}

// Equal tangent planes everywhere; with `curvature` equal curvatures, too.
void ExpectSmooth(const JoinedNetwork& joined, bool curvature) {
  auto network = BuildNetwork(joined.model);
  ASSERT_TRUE(network.ok());
  const auto continuity = MeasureContinuity(*network, 50, RunContext(1));
  EXPECT_TRUE(continuity.ok());
  for (const EdgeContinuity& e : continuity->edges) {
    EXPECT_LE(e.max_gap, 1e-12);
    EXPECT_LE(e.max_angle, 1e-11);
    if (curvature) {
      EXPECT_LE(e.max_curvature_gap, 1e-9 * e.max_curvature);
    }
  }
}

int SideOf(const CurveNetwork& network, const EdgeOfFace& e) {
  const auto& loop = network.faces[At(e.face)].vertices;
  for (int s = 0; s < 4; ++s) {
    if (std::minmax(loop[At(s)], loop[At((s + 1) % 4)]) == std::minmax(e.start, e.end)) return s;
  }
  return -1;
}
MiddleCross Cross(const CurveNetwork& network, const JoinedNetwork& joined, const EdgeOfFace& e) {
  return AcrossMiddle(joined.model.patches[At(e.face)].shape, SideOf(network, e));
}

// 4 x 4 vertices; the edge 5-6 lies between the faces 1 and 4, whose far edges are 1-2 and 9-10.
constexpr EdgeOfFace kHere{5, 6, 4}, kAcross{6, 5, 1};

TEST(EditNetwork, NoEditChangesNothing) {
  const CurveNetwork network = testing::LineSheet(1, 4, 4);
  EXPECT_TRUE(Changed(Join(network), Join(Edited(network, {}))).empty());
}

TEST(EditNetwork, PushesAddUpAndReachOnlyNeighbours) {
  const CurveNetwork network = testing::Cuboctahedron(4);
  const JoinedNetwork plain = Join(network);
  const auto pushed = [&](double amount) { return PushEdit{5, {0.4, 0.35, amount}}; };
  const JoinedNetwork twice = Join(Edited(network, {pushed(0.02), pushed(0.02)})),
                      once = Join(Edited(network, {pushed(0.04)}));
  std::set<int> near = {5};  // faces that share an edge with it
  for (const JoinedEdge& edge : plain.edges) {
    const int a = edge.topology.faces[0].face, b = edge.topology.faces[1].face;
    if (a == 5) near.insert(b);
    if (b == 5) near.insert(a);
  }
  EXPECT_EQ(near.size(), 5u);
  EXPECT_EQ(Changed(plain, once), near);
  ExpectSmooth(twice, false);
  const Vec3 p = Position(plain.model.patches[5].shape, 0.4, 0.35),
             q = Position(once.model.patches[5].shape, 0.4, 0.35);
  EXPECT_GT((q - p).norm(), 0.01);
  EXPECT_LE((Position(twice.model.patches[5].shape, 0.4, 0.35) - q).norm(), 1e-13);
}

TEST(EditNetwork, ANormalTurnsTheTangentPlaneAtItsVertex) {
  const CurveNetwork network = testing::Cuboctahedron(6);
  const JoinedNetwork plain = Join(network);
  const Vec3 wanted = network.vertices[3].normals[0].direction + Vec3(0.2, -0.1, 0.15);
  const CurveNetwork edited = Edited(network, {NormalEdit{3, {}, 2.5 * wanted}});
  const JoinedNetwork joined = Join(edited);
  ExpectSmooth(joined, false);
  for (const JoinedEdge& edge : joined.edges) {
    if (edge.topology.start != 3 && edge.topology.end != 3) continue;
    const Vec3 tangent = Evaluate(edge.curve, edge.topology.start == 3 ? 0 : 1).d;
    EXPECT_LE(std::abs(tangent.normalized().dot(wanted.normalized())), 1e-14);
  }
  // The edges at the vertex change, and with them the faces around it and the tangents across their far
  // edges.
  for (const int f : Changed(plain, joined)) {
    int distance = 9;
    for (const int v : network.faces[At(f)].vertices) {
      for (std::size_t g = 0; g < network.faces.size(); ++g) {
        const auto& loop = network.faces[g].vertices;
        if (std::ranges::count(loop, v) && std::ranges::count(loop, 3)) distance = 1;
      }
    }
    EXPECT_EQ(distance, 1);
  }
  EXPECT_LT(Changed(plain, joined).size(), network.faces.size());
}

// A cap that meets the rest in creases: the normal of the cap's side turns, that of the other side stays.
TEST(EditNetwork, ANormalOfOneSideOfACrease) {
  CurveNetwork network = testing::Cuboctahedron(3, 0.05);
  for (NetworkVertex& v : network.vertices) v.normals.clear();
  const auto cap = network.faces[5].vertices;
  for (std::size_t k = 0; k < 4; ++k)
    network.edges.push_back({"", cap[k], cap[(k + 1) % 4], NormalsEdge{}, true});
  const int face = static_cast<int>(std::ranges::find_if(network.faces,
                                                         [&](const NetworkFace& f) {
                                                           return &f != &network.faces[5] &&
                                                                  std::ranges::count(f.vertices, cap[0]) > 0;
                                                         }) -
                                    network.faces.begin());
  const CurveNetwork edited = Edited(network, {NormalEdit{cap[0], face, Vec3(1, 0.1, 0.2)}});
  const auto& normals = edited.vertices[At(cap[0])].normals;
  ASSERT_EQ(normals.size(), 1u);
  EXPECT_EQ(std::ranges::count(normals[0].faces, face), 1);
  EXPECT_EQ(std::ranges::count(normals[0].faces, 5), 0);
  EXPECT_EQ(normals[0].faces.size(), 3u);  // four faces meet there
  // Naming another face of the group turns the same normal.
  const CurveNetwork again = Edited(edited, {NormalEdit{cap[0], normals[0].faces[1], Vec3(0, 1, 0)}});
  ASSERT_EQ(again.vertices[At(cap[0])].normals.size(), 1u);
  EXPECT_EQ(again.vertices[At(cap[0])].normals[0].direction, Vec3(0, 1, 0));
}

// Faces along parts of an edge belong to the group of the face along the whole of it.
TEST(EditNetwork, ANormalAtATJunctionReachesAllItsFaces) {
  CurveNetwork n;
  for (const Vec3& p : {Vec3(-10, 0, 0), Vec3(0, 0, 2), Vec3(0, 30, 2), Vec3(-10, 30, 0), Vec3(12, 0, 0),
                        Vec3(12, 30, 0), Vec3(12, 14, 1)}) {
    n.vertices.push_back({"", p, {}});
  }
  n.vertices.emplace_back().on_edge = {1, 2, 0.5};
  for (const std::vector<int>& loop :
       std::vector<std::vector<int>>{{0, 1, 2, 3}, {1, 4, 6, 7}, {7, 6, 5, 2}}) {
    n.faces.push_back({"", loop, PatchScheme::kAuto, {}});
  }
  const JoinedNetwork before = Join(n);
  const CurveNetwork turned = Edited(n, {NormalEdit{1, 0, Vec3(0.1, -0.2, 1)}});
  ASSERT_EQ(turned.vertices[1].normals.size(), 1u);
  EXPECT_EQ(turned.vertices[1].normals[0].faces, (std::vector<int>{0, 1}));
  const JoinedNetwork after = Join(turned);
  ExpectSmooth(after, false);
  EXPECT_EQ(Changed(before, after), (std::set<int>{0, 1, 2}));
  const CurveNetwork pushed = Edited(n, {PushEdit{0, {0.8, 0.5, 0.05}}});
  ExpectSmooth(Join(pushed), false);
  EXPECT_EQ(Changed(before, Join(pushed)), (std::set<int>{0, 1, 2}));
}

TEST(EditNetwork, ControlPointsMoveWhereTheyAreToldAndTheNeighbourFollows) {
  const CurveNetwork network = testing::LineSheet(2, 4, 4);
  const JoinedNetwork plain = Join(network);
  const SectionPoints old = SectionPointsOf(Cross(network, plain, kHere));
  const Vec3 q1 = old.q1 + Vec3(0.2, -0.3, 0.5);
  const CurveNetwork first = Edited(network, {ControlPointEdit{kHere, 1, q1}});
  const JoinedNetwork moved = Join(first);
  EXPECT_LE((SectionPointsOf(Cross(first, moved, kHere)).q1 - q1).norm(), 1e-12);
  ExpectSmooth(moved, true);
  EXPECT_EQ(Changed(plain, moved), (std::set<int>{1, 4}));
  const Vec3 here = Cross(first, moved, kHere).first, across = Cross(first, moved, kAcross).first;
  EXPECT_LE(here.cross(across).norm(), 1e-12 * here.squaredNorm());

  const Vec3 q2 = SectionPointsOf(Cross(first, moved, kHere)).q2 + Vec3(0.1, 0.1, -0.4);
  const CurveNetwork second = Edited(first, {ControlPointEdit{kHere, 2, q2}});
  const JoinedNetwork both = Join(second);
  const SectionPoints made = SectionPointsOf(Cross(second, both, kHere));
  EXPECT_LE((made.q2 - q2).norm(), 1e-12);
  EXPECT_LE((made.q1 - q1).norm(), 1e-12);
  ExpectSmooth(both, true);
  EXPECT_EQ(Changed(plain, both), (std::set<int>{1, 4}));
  // In one list they do the same as one after the other.
  const JoinedNetwork list =
      Join(Edited(network, {ControlPointEdit{kHere, 1, q1}, ControlPointEdit{kHere, 2, q2}}));
  EXPECT_TRUE(Changed(both, list).empty());
}

TEST(EditNetwork, CurvatureOfASectionIsPrescribed) {
  const CurveNetwork network = testing::LineSheet(3, 4, 4);
  for (const double wanted : {0.05, -0.02, 0.0}) {
    const CurveNetwork edited = Edited(network, {CurvatureEdit{kHere, wanted}});
    const JoinedNetwork joined = Join(edited);
    const MiddleCross before = Cross(network, Join(network), kHere), after = Cross(edited, joined, kHere);
    EXPECT_LE((after.first - before.first).norm(), 1e-12);
    const Vec3 bend = SectionCurvature(after.first, after.second);
    EXPECT_NEAR(bend.norm(), std::abs(wanted), 1e-13);
    EXPECT_GE(bend.dot(before.normal) * wanted, 0.0);
    ExpectSmooth(joined, true);
  }
}

// A control of one face replaces the one that the face across had.
TEST(EditNetwork, ControlVectorsOfOneSideReplaceThoseOfTheOther) {
  const CurveNetwork network = testing::LineSheet(4, 4, 4);
  const MiddleCross a = Cross(network, Join(network), kHere);
  const Vec3 first = 1.1 * a.first + Vec3(0, 0, 0.4);
  CurveNetwork edited = Edited(
      network, {ControlEdit{{6, 5, 1, -1.3 * a.first, Vec3(0, 0, 2)}}, ControlEdit{{5, 6, 4, first, {}}}});
  ASSERT_EQ(edited.controls.size(), 2u);
  EXPECT_FALSE(edited.controls[0].first);
  EXPECT_TRUE(edited.controls[0].second);
  const JoinedNetwork joined = Join(edited);
  EXPECT_LE((Cross(edited, joined, kHere).first - first).norm(), 1e-12);
  EXPECT_LE((Cross(edited, joined, kAcross).second - Vec3(0, 0, 2)).norm(), 1e-11);
  ExpectSmooth(joined, true);
}

// The guide through the middles of a row of edges: the row's sections have its derivatives at every edge, and
// so its curvature; other rows only follow beside it, faces farther away do not move.
TEST(EditNetwork, AGuideCurveCorrectsARowOfFaces) {
  const CurveNetwork network = testing::LineSheet(5, 5, 4);
  const GuideEdit guide{{{1, 2}, {5, 6}, {10, 9}, {13, 14}, {17, 18}}, false, {}, Vec3(1, 0, 0)};
  const CurveNetwork edited = Edited(network, {guide});
  const JoinedNetwork plain = Join(network), joined = Join(edited);
  ExpectSmooth(joined, true);
  EXPECT_EQ(Changed(plain, joined),
            (std::set<int>{1, 4, 7, 10}));  // the row; its long edges keep their strips
  // The tangent of the surface at the start, the given one at the end, curvature continuous between.
  const MiddleCross start = Cross(edited, joined, {1, 2, 1}), end = Cross(edited, joined, {17, 18, 10});
  EXPECT_LE((start.first - Cross(network, plain, {1, 2, 1}).first).norm(), 1e-12);
  EXPECT_LE(end.first.normalized().cross(Vec3(1, 0, 0)).norm(), 1e-12);
  const int faces[4] = {1, 4, 7, 10};
  for (std::size_t k = 1; k < 4; ++k) {
    const auto& [a, b] = guide.edges[k];
    const MiddleCross back = Cross(edited, joined, {a, b, faces[k - 1]}),
                      on = Cross(edited, joined, {a, b, faces[k]});
    EXPECT_LE((back.first.normalized() + on.first.normalized()).norm(), 1e-12);
    EXPECT_LE((SectionCurvature(back.first, back.second) - SectionCurvature(on.first, on.second)).norm(),
              1e-12);
  }
}

// The row of faces that begins at the side of a face, as far as it goes.
GuideEdit RowFrom(const CurveNetwork& network, int face, int side) {
  GuideEdit guide;
  const auto ends = [&](int f, int s) {
    const auto& loop = network.faces[At(f)].vertices;
    return std::array{loop[At(s % 4)], loop[At((s + 1) % 4)]};
  };
  guide.edges.push_back(ends(face, side));
  while (true) {
    guide.edges.push_back(ends(face, side + 2));
    const int before = face;
    for (int f = 0; f < static_cast<int>(network.faces.size()) && face == before; ++f) {
      for (int s = 0; s < 4 && f != before; ++s) {
        const auto [a, b] = ends(f, s);
        if (std::minmax(a, b) == std::minmax(guide.edges.back()[0], guide.edges.back()[1]))
          face = f, side = s;
      }
    }
    if (face == before) return guide;
  }
}

// A guide through a row of a known surface leaves it where it is, as far as its edges have it.
TEST(EditNetwork, AGuideCurveKeepsAKnownSurface) {
  std::vector<testing::KnownNetwork> list = testing::KnownSurfaces();
  list.push_back(testing::KnownBicubic());
  for (const testing::KnownNetwork& known : list) {
    if (known.name.find("vertex") != std::string::npos) continue;  // no grid
    const double before = LargestError(known, Join(known.network));
    for (const int side : {3, 0}) {  // the rows of the first face in both directions
      const GuideEdit row = RowFrom(known.network, 0, side);
      ASSERT_GE(row.edges.size(), 3u);
      const CurveNetwork edited = Edited(known.network, {row});
      EXPECT_LE(LargestError(known, Join(edited)), 1.01 * before + 1e-8) << known.name << " " << side;
    }
  }
}

TEST(EditNetwork, RefusesWithThePathOfTheEdit) {
  const CurveNetwork network = testing::LineSheet(6, 4, 4);
  const auto refused = [&](const NetworkEdit& edit, const std::string& text) {
    const auto edited = EditNetwork(network, {PushEdit{0, {0.5, 0.5, 0}}, edit});
    EXPECT_EQ(edited.status().code(), absl::StatusCode::kInvalidArgument);
    EXPECT_NE(std::string(edited.status().message()).find(text), std::string::npos) << edited.status();
  };
  refused(PushEdit{9, {}}, "edits[1].face = 9; must be in [0, 8]");
  refused(NormalEdit{16, {}, Vec3(0, 0, 1)}, "edits[1].vertex = 16; must be in [0, 15]");
  refused(NormalEdit{1, {}, Vec3::Zero()}, "edits[1].direction");
  refused(ControlEdit{{0, 5, 0, Vec3(1, 0, 0), {}}},
          "edits[1] names the edge 0 5, which is not beside face 0");
  refused(ControlPointEdit{kHere, 3, Vec3::Zero()}, "edits[1].point = 3; must be 1 or 2");
  refused(CurvatureEdit{kHere, std::nan("")}, "edits[1].curvature");
  refused(GuideEdit{{{5, 6}}, false, {}, {}}, "edits[1].edges are 1; must be at least 2");
  // A pushed G2-Gregory face cannot be joined, and these ask for the surface.
  refused(CurvatureEdit{kHere, 0.1}, "edits[1] asks for the surface before it");
  refused(GuideEdit{{{5, 6}, {9, 10}}, false, {}, {}}, "edits[1] asks for the surface before it");
  const auto guide = [&](std::vector<std::array<int, 2>> edges) {
    return std::string(EditNetwork(network, {GuideEdit{std::move(edges), false, {}, {}}}).status().message());
  };
  EXPECT_NE(guide({{5, 6}, {5, 10}}).find("edits[0].edges[1] = 5 10; there is no such edge"),
            std::string::npos);
  EXPECT_NE(guide({{5, 6}, {13, 14}}).find("edits[0].edges[0] = 5 6; must lie opposite"), std::string::npos);
  EXPECT_FALSE(EditNetwork(network, std::vector<NetworkEdit>(1001, PushEdit{})).ok());
  RunContext cancelled(1);
  cancelled.Cancel();
  EXPECT_EQ(EditNetwork(network, {PushEdit{}}, cancelled).status().code(), absl::StatusCode::kCancelled);
}

}  // namespace
}  // namespace patchmill
