// Whole networks: the end-to-end vector, tangent continuity on random closed networks, creases, general
// edges, invariance.
#include "core/joining/join_network.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <gtest/gtest.h>

#include "core/diffgeo/forms.h"
#include "core/joining/continuity.h"
#include "tests/core/joining/networks.h"
#include "tests/support/json.h"

namespace patchmill {
namespace {

using testing::Json;
using testing::Random;
using testing::Text;

ContinuityReport Continuity(const PatchModel& model, int steps = 200) {
  auto network = BuildNetwork(model);
  EXPECT_TRUE(network.ok()) << network.status();
  return *MeasureContinuity(*network, steps, RunContext());
}

std::size_t SmoothCount(const JoinedNetwork& joined) {
  return static_cast<std::size_t>(
      std::ranges::count_if(joined.edges, [](const JoinedEdge& e) { return e.kind == EdgeKind::kSmooth; }));
}

void ExpectSmooth(const JoinedNetwork& joined, double angle = 1e-11) {
  ASSERT_TRUE(joined.findings.empty()) << Text(joined.findings);
  const ContinuityReport report = Continuity(joined.model);
  EXPECT_EQ(report.edges.size(), SmoothCount(joined));
  for (const EdgeContinuity& e : report.edges) {
    EXPECT_LE(e.max_gap, 1e-13 * 20);
    EXPECT_LE(e.max_angle, angle) << e.a.patch.value << "/" << e.a.edge << " at " << e.angle_at;
  }
}

TEST(JoinNetwork, EndToEndVector) {
  const Json data = testing::LoadJson(PATCHMILL_SOURCE_DIR "/tests/vectors/pipeline_g1.json");
  CurveNetwork network;
  for (std::size_t i = 0; i < data["vertices"].Items().size(); ++i) {
    NetworkVertex v;
    v.position = data["vertices"][static_cast<int>(i)].Vector();
    v.normals = {{data["normals"][static_cast<int>(i)].Vector(), {}}};
    network.vertices.push_back(v);
  }
  for (const Json& face : data["faces"].Items()) {
    NetworkFace f;
    for (const Json& v : face.Items()) f.vertices.push_back(static_cast<int>(v.Number()));
    network.faces.push_back(f);
  }
  const JoinedNetwork joined = JoinNetwork(network);
  ASSERT_TRUE(joined.findings.empty()) << Text(joined.findings);

  // Tangent of the face into itself along p -> q.
  const auto tangent = [&](int face, int p, int q) {
    for (const JoinedEdge& e : joined.edges) {
      for (std::size_t k = 0; k < e.topology.faces.size(); ++k) {
        if (e.topology.faces[k].face != face) continue;
        if (e.topology.start == p && e.topology.end == q) return std::pair(&e, e.tangents[k]);
        if (e.topology.start == q && e.topology.end == p) return std::pair(&e, Reversed(e.tangents[k]));
      }
    }
    ADD_FAILURE() << "no edge " << p << "-" << q;
    return std::pair(&joined.edges[0], joined.edges[0].tangents[0]);
  };
  ASSERT_GE(data["cbt"].Items().size(), 11u);
  for (const Json& cbt : data["cbt"].Items()) {
    const auto number = [&](const char* key) { return static_cast<int>(cbt[key].Number()); };
    const BezierChain b = tangent(number("face"), number("p"), number("q")).second;
    EXPECT_LE((Evaluate(b, 0).p - cbt["a0"].Vector()).norm(), 1e-12);
    EXPECT_LE((Evaluate(b, 1).p - cbt["a1"].Vector()).norm(), 1e-12);
    EXPECT_LE((Evaluate(b, 0).d - cbt["W0"].Vector()).norm(), 1e-11);
    EXPECT_LE((Evaluate(b, 1).d + cbt["W1"].Vector()).norm(), 1e-11);
  }
  for (const Json& sample : data["edge_samples"].Items()) {
    const int p = static_cast<int>(sample["edge"][0].Number()),
              q = static_cast<int>(sample["edge"][1].Number());
    const double t = sample["t"].Number();
    for (int face = 0; face < 3; ++face) {
      const auto& loop = network.faces[static_cast<std::size_t>(face)].vertices;
      if (!std::ranges::count(loop, p) || !std::ranges::count(loop, q)) continue;
      const auto [edge, b] = tangent(face, p, q);
      const CurveJet c = Evaluate(edge->curve, edge->topology.start == p ? t : 1 - t);
      const Vec3 n = c.d.cross(Evaluate(b, t).p).normalized();
      EXPECT_LE((c.p - sample["point"].Vector()).norm(), 1e-12);
      EXPECT_LE(n.cross(sample["normal"].Vector()).norm(), 1e-12);
    }
  }
  for (const Json& sample : data["face_samples"].Items()) {
    const auto face = static_cast<std::size_t>(sample["face"].Number());
    const bool triangle = sample.Has("u2");
    const Vec3 s = Position(joined.model.patches[face].shape, sample[triangle ? "u2" : "u"].Number(),
                            sample[triangle ? "u3" : "v"].Number());
    EXPECT_LE((s - sample["S"].Vector()).norm(), 1e-12);
  }
  ExpectSmooth(joined);
}

TEST(JoinNetwork, EveryMixOfQuadsAndTrianglesIsSmooth) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    CurveNetwork network = testing::Cuboctahedron(seed);
    ExpectSmooth(JoinNetwork(network));
    for (NetworkFace& face : network.faces) {
      face.scheme = face.vertices.size() == 3 ? PatchScheme::kGregoryTriangle : PatchScheme::kBrown;
    }
    ExpectSmooth(JoinNetwork(network));
  }
}

TEST(JoinNetwork, GeneralEdgesAreSmoothToo) {
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    CurveNetwork network = testing::Cuboctahedron(seed);
    const JoinedNetwork plain = JoinNetwork(network);
    Random random(seed);
    // Every third edge given, of degree 4: the cubic with its middle moved.
    for (std::size_t e = 0; e < plain.edges.size(); e += 3) {
      const JoinedEdge& edge = plain.edges[e];
      BezierCurve curve = SpanOf(Elevated(edge.curve, 4), 0);
      curve.points[2] += random.Point(-1, 1);
      network.edges.push_back({"", edge.topology.start, edge.topology.end, CurveEdge{curve}, false});
    }
    ExpectSmooth(JoinNetwork(network));
  }
}

TEST(JoinNetwork, HighDegreesBetweenQuads) {
  // A bent sheet of 3 x 3 quads whose inner edges are degree 7.
  Random random(5);
  CurveNetwork network;
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) {
      NetworkVertex v;
      v.position = Vec3(10 * i, 10 * j, i * j + random.Uniform(-1, 1));
      network.vertices.push_back(v);
    }
  }
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      NetworkFace f;
      f.vertices = {4 * i + j, 4 * i + 4 + j, 4 * i + 5 + j, 4 * i + 1 + j};
      network.faces.push_back(f);
    }
  }
  const JoinedNetwork plain = JoinNetwork(network);
  ExpectSmooth(plain);
  for (std::size_t v = 0; v < network.vertices.size(); ++v) {  // keep the normals that were found
    for (const JoinedEdge& edge : plain.edges) {
      if (edge.topology.start != static_cast<int>(v)) continue;
      const Vec3 n = Evaluate(edge.curve, 0).d.cross(Evaluate(edge.tangents[0], 0).p);
      network.vertices[v].normals = {{n, {}}};
    }
  }
  for (const JoinedEdge& edge : plain.edges) {
    if (edge.kind != EdgeKind::kSmooth) continue;
    BezierCurve curve = SpanOf(Elevated(edge.curve, 7), 0);
    for (std::size_t k = 2; k <= 5; ++k) curve.points[k] += random.Point(-1, 1);
    network.edges.push_back({"", edge.topology.start, edge.topology.end, CurveEdge{curve}, false});
  }
  ExpectSmooth(JoinNetwork(network));
}

TEST(JoinNetwork, CreasesStayCreasesAndTheRestSmooth) {
  CurveNetwork network = testing::Cuboctahedron(3, 0.05);
  for (NetworkVertex& v : network.vertices) v.normals.clear();
  // Around the quad of the positive z axis: a cap that meets the rest in a crease.
  const auto& cap = network.faces[5].vertices;
  for (std::size_t k = 0; k < 4; ++k) {
    network.edges.push_back({"", cap[k], cap[(k + 1) % 4], NormalsEdge{}, true});
  }
  const JoinedNetwork joined = JoinNetwork(network);
  ASSERT_TRUE(joined.findings.empty()) << Text(joined.findings);
  const ContinuityReport report = Continuity(joined.model);
  int creases = 0;
  for (const EdgeContinuity& e : report.edges) {
    EXPECT_LE(e.max_gap, 1e-12);
    if (e.max_angle > 1e-11) {
      ++creases;
      EXPECT_TRUE(e.a.patch == PatchId(5) || e.b.patch == PatchId(5));
      EXPECT_GT(e.max_angle, 0.1);
    }
  }
  EXPECT_EQ(creases, 4);
  EXPECT_EQ(report.edges.size(), 24u);
}

// A push moves the face to its anticlockwise side, in proportion, and smoothly; its corners and edges stay,
// and faces without an edge in common are the same to the bit.
TEST(JoinNetwork, PushedFacesBulgeAndNeighboursFollow) {
  for (const std::size_t pushed : {std::size_t{5}, std::size_t{9}}) {  // a quad, a triangle
    CurveNetwork network = testing::Cuboctahedron(4);
    const JoinedNetwork flat = JoinNetwork(network);
    const auto with = [&](double amount) {
      network.faces[pushed].pushes = {{0.4, 0.35, 0.75 * amount}, {0.4, 0.35, 0.25 * amount}};
      JoinedNetwork joined = JoinNetwork(network);
      ExpectSmooth(joined);
      return joined;
    };
    const JoinedNetwork none = with(0.0), once = with(0.02), twice = with(0.04);
    const auto at = [](const JoinedNetwork& joined, std::size_t face, double u, double v) {
      return Position(joined.model.patches[face].shape, u, v);
    };
    const auto& loop = network.faces[pushed].vertices;
    const auto corner = [&](std::size_t k) {
      return network.vertices[static_cast<std::size_t>(loop[k])].position;
    };
    const Vec3 side = (corner(1) - corner(0)).cross(corner(2) - corner(0)).normalized();
    const Vec3 moved = at(once, pushed, 0.4, 0.35) - at(flat, pushed, 0.4, 0.35);
    EXPECT_GT(moved.norm(), 0.01);
    EXPECT_GT(moved.dot(side), 0.9 * moved.norm());
    for (std::size_t f = 0; f < network.faces.size(); ++f) {
      int common = 0;
      for (const int v : network.faces[f].vertices) common += static_cast<int>(std::ranges::count(loop, v));
      for (const Vec2& q : {Vec2(0.2, 0.3), Vec2(0.5, 0.25), Vec2(0.3, 0), Vec2(0, 0.6)}) {
        const Vec3 p = at(flat, f, q.x(), q.y()), p1 = at(once, f, q.x(), q.y()),
                   p2 = at(twice, f, q.x(), q.y());
        EXPECT_LE((at(none, f, q.x(), q.y()) - p).norm(), 1e-14);
        EXPECT_LE((p2 - p - 2 * (p1 - p)).norm(), 1e-12);
        if (q.x() == 0 || q.y() == 0) {
          EXPECT_LE((p1 - p).norm(), 1e-13);
        }
        if (common < 2) {
          EXPECT_EQ(p1, p);
        }
      }
    }
  }
}

TEST(JoinNetwork, FollowsRigidMotions) {
  const CurveNetwork network = testing::Cuboctahedron(7);
  const Eigen::Affine3d motion =
      Eigen::Translation3d(30, -7, 11) * Eigen::AngleAxisd(1.1, Vec3(1, 2, -2).normalized());
  CurveNetwork moved = network;
  for (NetworkVertex& v : moved.vertices) {
    v.position = motion * v.position;
    for (auto& n : v.normals) n.direction = motion.linear() * n.direction;
  }
  const JoinedNetwork a = JoinNetwork(network), b = JoinNetwork(moved);
  ASSERT_EQ(a.model.patches.size(), b.model.patches.size());
  for (std::size_t f = 0; f < a.model.patches.size(); ++f) {
    for (const Vec2& q : {Vec2(0.2, 0.3), Vec2(0.6, 0.1), Vec2(0, 0.7)}) {
      EXPECT_LE((motion * Position(a.model.patches[f].shape, q.x(), q.y()) -
                 Position(b.model.patches[f].shape, q.x(), q.y()))
                    .norm(),
                1e-11);
    }
  }
}

// Naming the vertices of a face from another corner or the other way round leaves the surface alone.
TEST(JoinNetwork, FaceOrderDoesNotMatter) {
  const CurveNetwork network = testing::Cuboctahedron(8);
  CurveNetwork turned = network;
  for (std::size_t f = 0; f < turned.faces.size(); ++f) {
    auto& loop = turned.faces[f].vertices;
    std::rotate(loop.begin(), loop.begin() + static_cast<long>(f % loop.size()), loop.end());
    if (f % 2 == 1) std::reverse(loop.begin(), loop.end());
  }
  const JoinedNetwork a = JoinNetwork(network), b = JoinNetwork(turned);
  ASSERT_TRUE(b.findings.empty());
  for (std::size_t f = 0; f < network.faces.size(); ++f) {
    // The middle has the same parameters however the corners are numbered.
    const double m = network.faces[f].vertices.size() == 3 ? 1.0 / 3 : 0.5;
    EXPECT_LE((Position(a.model.patches[f].shape, m, m) - Position(b.model.patches[f].shape, m, m)).norm(),
              1e-12);
  }
  ExpectSmooth(b);
}

TEST(JoinNetwork, EdgeThroughAPoint) {
  CurveNetwork network = testing::Cuboctahedron(9);
  const JoinedNetwork plain = JoinNetwork(network);
  const JoinedEdge& edge = plain.edges[2];
  HermiteCurve wished = HermiteOf(edge.curve);
  wished.d0 *= 1.3;
  wished.d1 *= 0.8;
  const Vec3 point = Evaluate(wished, 0.4).p;
  network.edges.push_back({"", edge.topology.start, edge.topology.end, ThroughPointEdge{point}, false});
  const JoinedNetwork joined = JoinNetwork(network);
  ASSERT_TRUE(joined.findings.empty()) << Text(joined.findings);
  EXPECT_LE((Evaluate(joined.edges[0].curve, 0.4).p - point).norm(), 1e-10);
  ExpectSmooth(joined);
}

// On a sphere, normals radial, edges 60 degrees long: the tangents across the middle of every edge of a quad
// rise R / sqrt(6) towards the quad's axis, which puts its middle R (1/sqrt(2) + 1/(2 sqrt(6))) from the
// center. The correction of the twists is along the edge there, by symmetry.
TEST(JoinNetwork, MiddlesOfQuadsOnASphereHaveTheirClosedForm) {
  const JoinedNetwork joined = JoinNetwork(testing::Cuboctahedron(1, 0.0));
  const double radius = 10 * std::sqrt(2.0),
               middle = radius * (1 / std::sqrt(2.0) + 1 / (2 * std::sqrt(6.0)));
  int quads = 0;
  for (const Patch& patch : joined.model.patches) {
    if (IsTriangle(patch.shape)) continue;
    ++quads;
    EXPECT_NEAR(Position(patch.shape, 0.5, 0.5).norm(), middle, 1e-12);
  }
  EXPECT_EQ(quads, 6);
}

// A wavy sheet of n x n cells, some of them cut into triangles along either diagonal, moved at random.
CurveNetwork Sheet(std::uint64_t seed, int n) {
  Random random(seed);
  CurveNetwork network;
  for (int i = 0; i <= n; ++i) {
    for (int j = 0; j <= n; ++j) {
      NetworkVertex v;
      v.position = Vec3(10 * i, 10 * j, 4 * std::sin(0.9 * i) * std::cos(0.7 * j)) + random.Point(-1.5, 1.5);
      network.vertices.push_back(v);
    }
  }
  const auto add = [&](std::vector<int> loop) {
    if (random.Int(2) == 0) std::reverse(loop.begin(), loop.end());
    network.faces.push_back({"", std::move(loop), PatchScheme::kAuto, {}});
  };
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      const int a = i * (n + 1) + j, b = a + n + 1, c = b + 1, d = a + 1;
      switch (random.Int(4)) {
        case 0:
          add({a, b, c}), add({a, c, d});
          break;
        case 1:
          add({a, b, d}), add({b, c, d});
          break;
        default:
          add({a, b, c, d});
      }
    }
  }
  return network;
}

// Without any normal given: every interior edge is smooth, and every corner has one normal.
TEST(JoinNetwork, SheetsOfAnyMixWithoutNormalsAreSmooth) {
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    const JoinedNetwork joined = JoinNetwork(Sheet(seed, 8));
    ASSERT_TRUE(joined.findings.empty()) << Text(joined.findings);
    EXPECT_GT(SmoothCount(joined), 112u);  // of 8 x 8 cells alone
    ExpectSmooth(joined);
  }
}

// The measure itself: a roof has its angle all along, and a gap its width where it is widest.
TEST(Continuity, MeasuresAKnownAngleAndGap) {
  const auto flat = [](const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
    BezierPatch patch;
    patch.degree_u = patch.degree_v = 1;
    patch.points = {a, b, c, d};  // (0,0) (0,1) (1,0) (1,1)
    return Patch{"", patch};
  };
  const double slope = 0.3;
  PatchModel roof;
  roof.join_tolerance = 0.01;
  roof.patches = {flat({0, 0, 0}, {0, 10, 0}, {10, 0, 0}, {10, 10, 0}),
                  flat({10, 10, 0.004}, {10, 0, 0}, {20, 10, 10 * std::tan(slope) + 0.004},
                       {20, 0, 10 * std::tan(slope)})};
  const ContinuityReport report = Continuity(roof, 64);
  ASSERT_EQ(report.edges.size(), 1u);
  const EdgeContinuity& joint = report.edges[0];
  EXPECT_NEAR(joint.max_gap, 0.004, 1e-6);
  EXPECT_EQ(joint.gap_at, 1.0);
  EXPECT_NEAR(joint.max_angle, slope, 1e-3);  // the second plane is tilted by 0.004 in 10 along the edge
  EXPECT_EQ(report.samples, 65);
}

// Two cylinders of radius 20 and 30 that share a straight edge and a tangent plane: across the edge their
// curvatures differ by 1/20 - 1/30, and no direction differs more.
TEST(Continuity, MeasuresAKnownDifferenceOfCurvature) {
  const auto cylinder = [](double radius, double angle, bool left) {
    BezierPatch patch;  // quarter and less, rational, above the line x = 0, z = 0
    patch.degree_u = 2, patch.degree_v = 1;
    const double s = (left ? -1 : 1) * radius * std::sin(angle),
                 t = (left ? -1 : 1) * radius * std::tan(angle / 2);
    const double drop = radius * (1 - std::cos(angle));
    patch.points = {{0, 0, 0}, {0, 10, 0}, {t, 0, 0}, {t, 10, 0}, {s, 0, -drop}, {s, 10, -drop}};
    patch.weights = {1, 1, std::cos(angle / 2), std::cos(angle / 2), 1, 1};
    return Patch{"", patch};
  };
  PatchModel model;
  model.patches = {cylinder(20, 0.7, false), cylinder(30, 0.5, true)};
  const ContinuityReport report = Continuity(model, 16);
  ASSERT_EQ(report.edges.size(), 1u);
  EXPECT_LE(report.edges[0].max_angle, 1e-15);
  EXPECT_NEAR(report.edges[0].max_curvature_gap, 1.0 / 20 - 1.0 / 30, 1e-14);
  EXPECT_NEAR(report.edges[0].max_curvature, 1.0 / 20, 1e-14);
}

TEST(Continuity, DoesNotDependOnThreads) {
  auto network = BuildNetwork(JoinNetwork(Sheet(9, 6)).model);
  ASSERT_TRUE(network.ok());
  const ContinuityReport one = *MeasureContinuity(*network, 50, RunContext(1)),
                         two = *MeasureContinuity(*network, 50, RunContext(2));
  ASSERT_EQ(one.edges.size(), two.edges.size());
  for (std::size_t k = 0; k < one.edges.size(); ++k) {
    EXPECT_EQ(one.edges[k].max_gap, two.edges[k].max_gap);
    EXPECT_EQ(one.edges[k].max_angle, two.edges[k].max_angle);
  }
}

TEST(Continuity, ACancelledReportIsNone) {
  auto network = BuildNetwork(JoinNetwork(Sheet(4, 4)).model);
  ASSERT_TRUE(network.ok());
  RunContext run;
  run.Cancel();
  EXPECT_EQ(MeasureContinuity(*network, 50, run).status().code(), absl::StatusCode::kCancelled);
}

}  // namespace
}  // namespace patchmill
