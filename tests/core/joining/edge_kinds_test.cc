// Edges of every kind in a network: they do what they say, and the faces beside them stay joined.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "core/base/index.h"
#include "tests/core/joining/expect_smooth.h"
#include "tests/core/joining/networks.h"

namespace patchmill {
namespace {

using testing::ExpectSmooth;
using testing::Random;
using testing::Text;

// n x n quads over a ball's cap, normals radial, so that the edges through its middle are plane curves.
CurveNetwork Cap(int n) {
  CurveNetwork network;
  for (int i = 0; i <= n; ++i) {
    for (int j = 0; j <= n; ++j) {
      const Vec3 p = Vec3(2.0 * i / n - 1, 2.0 * j / n - 1, 2.0).normalized() * 30;
      network.vertices.push_back({"", p, {{p, {}}}});
    }
  }
  const int m = n + 1;
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      network.faces.push_back(
          {"", {i * m + j, (i + 1) * m + j, (i + 1) * m + j + 1, i * m + j + 1}, PatchScheme::kAuto, {}});
    }
  }
  return network;
}

const JoinedEdge& EdgeOf(const JoinedNetwork& joined, int a, int b) {
  return *std::ranges::find_if(joined.edges, [&](const JoinedEdge& e) {
    return std::minmax(e.topology.start, e.topology.end) == std::minmax(a, b);
  });
}

// The cubic of an edge from vertex a to b.
HermiteCurve CubicFrom(const JoinedNetwork& joined, int a, int b) {
  const JoinedEdge& edge = EdgeOf(joined, a, b);
  const HermiteCurve cubic = HermiteOf(edge.curve);
  return edge.topology.start == a ? cubic : Reversed(cubic);
}

JoinedNetwork With(CurveNetwork network, int a, int b, EdgeShape shape) {
  network.edges.push_back({"", a, b, std::move(shape), false});
  return JoinNetwork(network);
}

// Great circles: an arc's tangents leave the ball by the error of the cubic only, and meet it in the middle.
TEST(EdgeKinds, ArcsOfGreatCircles) {
  const JoinedNetwork joined = With(Cap(2), 4, 5, NormalsEdge{1.0, TangentLength::kArc});
  ExpectSmooth(joined, 4);
  const JoinedEdge& edge = EdgeOf(joined, 4, 5);
  EXPECT_NEAR(Evaluate(edge.curve, 0.5).p.norm(), 30, 1e-12);
  const double angle = std::acos(edge.curve.points.front().dot(edge.curve.points.back()) / 900);
  EXPECT_NEAR(HermiteOf(edge.curve).d0.norm(), 4 * 30 * std::tan(angle / 4), 1e-12);
  const JoinedNetwork longer = With(Cap(2), 4, 5, NormalsEdge{2.0, TangentLength::kArc});
  EXPECT_NEAR(HermiteOf(EdgeOf(longer, 4, 5).curve).d0.norm(), 2 * 4 * 30 * std::tan(angle / 4), 1e-12);
  // Tangents that meet in one point: the way to it.
  const JoinedNetwork ellipse = With(Cap(2), 4, 5, NormalsEdge{1.0, TangentLength::kQuarterEllipse});
  ExpectSmooth(ellipse, 4);
  EXPECT_NEAR(HermiteOf(EdgeOf(ellipse, 4, 5).curve).d0.norm(),
              4 * (std::sqrt(2.0) - 1) * 30 * std::tan(angle / 2), 1e-12);
}

TEST(EdgeKinds, SlopesExtremaPeaksAndExtraTerms) {
  const CurveNetwork cap = Cap(2);
  const JoinedNetwork plain = JoinNetwork(cap);
  HermiteCurve wished = HermiteOf(EdgeOf(plain, 4, 5).curve);
  wished.d0 *= 1.2, wished.d1 *= 0.9;
  const CurveJet there = Evaluate(wished, 0.4);
  const JoinedNetwork slope = With(cap, 4, 5, SlopeEdge{there.p, there.d});
  ExpectSmooth(slope, 4);
  EXPECT_LE((Evaluate(EdgeOf(slope, 4, 5).curve, 0.4).p - there.p).norm(), 1e-10);

  const Vec3 chord = wished.p1 - wished.p0,
             up = (cap.vertices[4].position + cap.vertices[5].position).normalized();
  // A plane edge is farthest from its chord where its tangent runs along it.
  const Vec3 away = (up - chord * chord.dot(up) / chord.squaredNorm()).normalized();
  double low = 0, high = 1;
  for (int i = 0; i < 60; ++i) {
    const double t = 0.5 * (low + high);
    (Evaluate(wished, t).d.dot(away) > 0 ? low : high) = t;
  }
  const JoinedNetwork extremum = With(cap, 4, 5, SlopeEdge{Evaluate(wished, low).p, {}});
  ExpectSmooth(extremum, 4);
  EXPECT_LE((Evaluate(EdgeOf(extremum, 4, 5).curve, low).p - Evaluate(wished, low).p).norm(), 1e-9);

  // Twisted: vertices 0 and 5 of a network moved at random.
  const CurveNetwork net = testing::Cuboctahedron(9);
  const JoinedNetwork twisted = JoinNetwork(net);
  const JoinedEdge& old = twisted.edges[2];
  HermiteCurve longer = HermiteOf(old.curve);
  longer.d0 *= 1.3, longer.d1 *= 0.8;
  const int a = old.topology.start, b = old.topology.end;
  const JoinedNetwork peak = With(net, a, b, PeakEdge{Evaluate(longer, 2.0 / 3.0).p});
  ExpectSmooth(peak, 24);
  EXPECT_LE((Evaluate(EdgeOf(peak, a, b).curve, 0.5).p - Evaluate(longer, 0.5).p).norm(), 1e-9);

  // Degree 4 beside triangles, 5 between quads.
  for (const bool with_derivative : {false, true}) {
    const CurveNetwork& network = with_derivative ? cap : net;
    const int from = with_derivative ? 4 : a, to = with_derivative ? 5 : b;
    const HermiteCurve before = CubicFrom(with_derivative ? plain : twisted, from, to);
    const CurveJet at = Evaluate(before, 0.3);
    LedEdge led{{}, 0.3, at.p + Vec3(0.3, -0.2, 0.4), {}};
    const Vec3 turned = 1.1 * at.d + Vec3(0.5, 0, -0.5);
    if (with_derivative) led.derivative = turned;
    const JoinedNetwork joined = With(network, from, to, led);
    ExpectSmooth(joined, with_derivative ? 4 : 24);
    ASSERT_FALSE(joined.edges.empty());
    const BezierChain& curve = joined.edges[0].curve;  // listed edges come first
    EXPECT_EQ(curve.degree, with_derivative ? 5 : 4);
    EXPECT_LE((Evaluate(curve, 0.3).p - led.point).norm(), 1e-11);
    if (with_derivative) {
      EXPECT_LE((Evaluate(curve, 0.3).d - turned).norm(), 1e-10);
    }
    EXPECT_LE((HermiteOf(curve).d0 - before.d0).norm(), 1e-11);
  }
}

// A warning: such an edge may be meant.
TEST(EdgeKinds, LoopsAreWarnedOf) {
  CurveNetwork cap = Cap(2);
  const JoinedNetwork plain = JoinNetwork(cap);
  const HermiteCurve edge = HermiteOf(EdgeOf(plain, 4, 5).curve);
  const JoinedNetwork looped = With(cap, 4, 5, TangentsEdge{12.0 * edge.d0, -12.0 * edge.d1});
  EXPECT_EQ(std::ranges::count(looped.findings, "LOOPED_EDGE", &Diagnostic::code), 1)
      << Text(looped.findings);
  EXPECT_FALSE(HasError(looped.findings));
  EXPECT_TRUE(plain.findings.empty());
}

TEST(EdgeKinds, WhatCannotBeIsOneFinding) {
  const auto expect = [](const EdgeShape& shape, const std::string& code, const std::string& text) {
    const Diagnostics findings = With(Cap(2), 4, 5, shape).findings;
    ASSERT_EQ(findings.size(), 1u) << Text(findings);
    EXPECT_EQ(findings[0].code, code);
    EXPECT_EQ(findings[0].where.field, "network.edges[0]");
    EXPECT_NE(findings[0].message.find(text), std::string::npos) << findings[0].message;
  };
  const double nan = std::nan("");
  expect(SlopeEdge{Vec3(0, 0, 90), Vec3(1, 2, 3)}, "NO_FIT", "leave their plane");
  expect(SlopeEdge{Vec3(0, 0, 90), Vec3::Zero()}, "ZERO_TANGENT", "without direction");
  expect(SlopeEdge{Vec3(0, nan, 90), {}}, "NOT_FINITE", "not finite");
  expect(PeakEdge{Vec3(0, 0, 90)}, "NO_FIT", "out of the start plane");
  expect(PeakEdge{Vec3(0, 0, nan)}, "NOT_FINITE", "not finite");
  expect(LedEdge{{}, 0.01, Vec3(0, 0, 30), {}}, "INVALID_PARAMETER", "[0.05, 0.95]");
  expect(LedEdge{{0.0}, 0.5, Vec3(0, 0, 30), {}}, "INVALID_GAMMA", "gamma");
  expect(LedEdge{{}, 0.5, Vec3(0, 0, 30), Vec3(nan, 0, 0)}, "NOT_FINITE", "not finite");
  CurveNetwork skew = testing::Cuboctahedron(9);  // tangents that pass each other
  const JoinedNetwork joined = JoinNetwork(skew);
  const int a = joined.edges[2].topology.start, b = joined.edges[2].topology.end;
  const Diagnostics findings = With(skew, a, b, NormalsEdge{1.0, TangentLength::kQuarterEllipse}).findings;
  ASSERT_EQ(findings.size(), 1u) << Text(findings);
  EXPECT_EQ(findings[0].code, "NO_FIT");
}

// The twists that were found, given as wishes, are found again; moved ones move the surface, and the
// neighbour follows. On a border they are taken as they are.
TEST(Twists, GivenOnesAreWishes) {
  const CurveNetwork network = Cap(2);
  const JoinedNetwork plain = JoinNetwork(network);
  const auto twisted = [&](const Vec3& more) {
    CurveNetwork given = network;
    for (int f = 0; f < 4; ++f) {
      for (const JoinedEdge& edge : plain.edges) {
        for (std::size_t k = 0; k < edge.topology.faces.size(); ++k) {
          if (edge.topology.faces[k].face != f) continue;
          const BezierChain& b = edge.tangents[k];
          given.faces[At(f)].twists.push_back({edge.topology.start, edge.topology.end,
                                               Evaluate(b, 0).d + more, Vec3(-Evaluate(b, 1).d + more)});
        }
      }
    }
    // Named from the other end: the same twists.
    auto& first = given.faces[0].twists[0];
    first = {first.end, first.start, first.at_end, first.at_start};
    return JoinNetwork(given);
  };
  const JoinedNetwork again = twisted(Vec3::Zero()), moved = twisted(Vec3(3, -2, 9));
  ExpectSmooth(again, 4);
  ExpectSmooth(moved, 4);
  double most = 0.0;
  for (int f = 0; f < 4; ++f) {
    for (const Vec2& q : {Vec2(0.3, 0.6), Vec2(0.8, 0.1)}) {
      const Vec3 p = Position(plain.model.patches[At(f)].shape, q.x(), q.y());
      EXPECT_LE((Position(again.model.patches[At(f)].shape, q.x(), q.y()) - p).norm(), 1e-11);
      most = std::max(most, (Position(moved.model.patches[At(f)].shape, q.x(), q.y()) - p).norm());
    }
  }
  EXPECT_GT(most, 0.05);
  for (const JoinedEdge& edge : moved.edges) {
    const BezierChain& old = EdgeOf(plain, edge.topology.start, edge.topology.end).tangents[0];
    if (edge.kind != EdgeKind::kFree) continue;
    EXPECT_LE((Evaluate(edge.tangents[0], 0).d - Evaluate(old, 0).d - Vec3(3, -2, 9)).norm(), 1e-10);
  }
}

TEST(Twists, BadOnesAreOneFinding) {
  const auto expect = [](CurveNetwork n, const SideTwists& twists, const std::string& code,
                         const std::string& text) {
    n.faces[0].twists.push_back(twists);
    const Diagnostics findings = JoinNetwork(n).findings;
    ASSERT_EQ(findings.size(), 1u) << Text(findings);
    EXPECT_EQ(findings[0].code, code);
    EXPECT_NE(findings[0].message.find(text), std::string::npos) << findings[0].message;
  };
  const CurveNetwork cap = Cap(2);
  expect(cap, {0, 4, {}, {}}, "INVALID_TWIST", "no side of it");
  expect(cap, {0, 99, {}, {}}, "INVALID_TWIST", "no side of it");
  expect(cap, {0, 3, Vec3(0, std::nan(""), 0), {}}, "INVALID_TWIST", "not finite");
  CurveNetwork twice = cap;
  twice.faces[0].twists.push_back({3, 0, {}, {}});
  expect(twice, {0, 3, {}, {}}, "INVALID_TWIST", "twice");
  CurveNetwork g2 = cap;
  g2.faces[0].scheme = PatchScheme::kG2Gregory;
  expect(g2, {0, 3, {}, {}}, "UNSUPPORTED_SCHEME", "not shaped by twists");
}

// --- Edges of several spans ---

// The cap's middle line, all in one edge: cubic spans with continuous second derivative, off the ball.
BsplineCurve Wave(const HermiteCurve& like, int spans, int degree, std::uint64_t seed) {
  Random random(seed);
  BsplineCurve curve;
  curve.degree = degree;
  for (int k = 0; k <= degree; ++k) curve.knots.push_back(0);
  for (int k = 1; k < spans; ++k) curve.knots.push_back(k + random.Uniform(-0.2, 0.2));
  for (int k = 0; k <= degree; ++k) curve.knots.push_back(spans);
  const int count = spans + degree;
  for (int i = 0; i < count; ++i) {
    double greville = 0.0;
    for (int k = 1; k <= degree; ++k) greville += curve.knots[At(i + k)] / (degree * spans);
    curve.points.push_back(Evaluate(like, greville).p);
    if (i > 1 && i + 2 < count) curve.points.back() += random.Point(-0.4, 0.4);
  }
  // The ends leave as the edge it stands for does.
  curve.points.front() = like.p0, curve.points.back() = like.p1;
  curve.points[1] = like.p0 + like.d0 * (curve.knots[At(degree + 1)] / (degree * spans));
  curve.points[At(count - 2)] = like.p1 - like.d1 * ((spans - curve.knots[At(count - 1)]) / (degree * spans));
  return curve;
}

// Every edge of a sheet a spline with knots of its own: joined, smooth, and each patch one surface.
TEST(SplineEdges, OfSeveralSpansBoundBrownQuads) {
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    CurveNetwork network = Cap(3);
    Random random(seed);
    for (NetworkVertex& v : network.vertices) v.position += random.Point(-1, 1);
    const JoinedNetwork plain = JoinNetwork(network);
    ASSERT_TRUE(plain.findings.empty()) << Text(plain.findings);
    for (std::size_t e = 0; e < plain.edges.size(); ++e) {
      const JoinedEdge& edge = plain.edges[e];
      const int spans = 1 + static_cast<int>(e % 4), degree = 3 + static_cast<int>(e % 3);
      network.edges.push_back({"", edge.topology.start, edge.topology.end,
                               CurveEdge{Wave(HermiteOf(edge.curve), spans, degree, seed + e)}, false});
    }
    const JoinedNetwork joined = JoinNetwork(network);
    ExpectSmooth(joined, 12);
    ASSERT_EQ(joined.model.patches.size(), 9u);
    for (const Patch& patch : joined.model.patches) {
      const auto& brown = std::get<BrownPatch>(patch.shape);
      // One tangent plane across every inner break.
      for (const bool along_u : {true, false}) {
        for (const double at : along_u ? brown.breaks_u : brown.breaks_v) {
          for (double t = 0.0; t <= 1.0; t += 0.1) {
            const auto jet = [&](double x) {
              return along_u ? Evaluate(brown, x, t) : Evaluate(brown, t, x);
            };
            const SurfaceJet a = jet(at - 1e-13), b = jet(at);
            EXPECT_LE(a.du.cross(a.dv).normalized().cross(b.du.cross(b.dv).normalized()).norm(), 1e-9);
          }
        }
      }
    }
    // The curve is the edge of its faces.
    for (const NetworkEdge& given : network.edges) {
      const JoinedEdge& edge = EdgeOf(joined, given.start, given.end);
      for (double t = 0.0; t <= 1.0; t += 0.0625) {
        const CurveJet want = Evaluate(std::get<CurveEdge>(given.shape).curve, t),
                       got = Evaluate(edge.curve, t);
        EXPECT_LE((got.p - want.p).norm(), 1e-12 * 30);
        const Vec3 n = got.d.cross(Evaluate(edge.tangents[0], t).p);
        EXPECT_GT(n.norm(), 1.0);
      }
    }
  }
}

TEST(SplineEdges, TJunctionsLieOnThemToo) {
  CurveNetwork n;
  const auto wave = [](double x, double y) { return Vec3(x, y, 3 * std::sin(0.12 * x + 0.1 * y)); };
  for (const auto& [x, y] : {std::pair(-10, 0), {0, 0}, {0, 30}, {-10, 30}, {20, 0}, {20, 30}, {20, 13}}) {
    n.vertices.push_back({"", wave(x, y), {}});
  }
  n.vertices.push_back({});
  n.vertices[7].on_edge = {1, 2, 0.43};
  n.faces = {{"", {0, 1, 2, 3}, PatchScheme::kAuto, {}},
             {"", {1, 4, 6, 7}, PatchScheme::kAuto, {}},
             {"", {7, 6, 5, 2}, PatchScheme::kAuto, {}}};
  const JoinedNetwork plain = JoinNetwork(n);
  ASSERT_TRUE(plain.findings.empty()) << Text(plain.findings);
  n.edges.push_back({"", 1, 2, CurveEdge{Wave(HermiteOf(EdgeOf(plain, 1, 2).curve), 5, 3, 4)}, false});
  const JoinedNetwork joined = JoinNetwork(n);
  ExpectSmooth(joined, 3);
  EXPECT_LE((Position(joined.model.patches[1].shape, 0, 0) - n.vertices[1].position).norm(), 1e-12);
}

TEST(SplineEdges, WhatTheyCannotBeIsSaidWithThePlace) {
  CurveNetwork cap = Cap(2);
  cap.vertices[4].position += Vec3(3, 2, 1);  // crossing edges out of line: l of [joining (4)] is not zero
  const JoinedNetwork plain = JoinNetwork(cap);
  const HermiteCurve inner = CubicFrom(plain, 4, 5), border = CubicFrom(plain, 0, 1);
  const auto expect = [](const JoinedNetwork& joined, const std::string& code, const std::string& text) {
    ASSERT_EQ(joined.findings.size(), 1u) << Text(joined.findings);
    EXPECT_EQ(joined.findings[0].code, code);
    EXPECT_NE(joined.findings[0].message.find(text), std::string::npos) << joined.findings[0].message;
  };
  // A second derivative that jumps: refused where two faces must agree across it, fine on a border.
  BsplineCurve parabolas = Wave(inner, 3, 2, 5);
  parabolas.points[2] += Vec3(2, 3, 2);
  expect(With(cap, 4, 5, CurveEdge{parabolas}), "UNSUPPORTED_CURVE", "second derivative jumps");
  ExpectSmooth(With(cap, 0, 1, CurveEdge{Wave(border, 3, 2, 5)}), 4);
  // A corner.
  BsplineCurve bent = Wave(inner, 2, 3, 6);
  bent.knots = {0, 0, 0, 0, 1, 1, 1, 2, 2, 2, 2};
  bent.points.insert(bent.points.begin() + 2, {inner.p0 + Vec3(1, 2, 0), inner.p0 + Vec3(1, 3, 1)});
  expect(With(cap, 4, 5, CurveEdge{bent}), "UNSUPPORTED_CURVE", "first derivative jumps at (");
  CurveNetwork gregory = cap;
  gregory.faces[0].scheme = PatchScheme::kGregory;
  const auto& loop = gregory.faces[0].vertices;
  expect(With(gregory, loop[0], loop[1], CurveEdge{Wave(CubicFrom(plain, loop[0], loop[1]), 2, 3, 7)}),
         "UNSUPPORTED_SCHEME", "only a Brown quad takes");
  CurveNetwork triangle = cap;
  triangle.faces.resize(1);
  triangle.faces[0].vertices = {0, 1, 4};
  triangle.vertices.resize(5);
  triangle.vertices.erase(triangle.vertices.begin() + 2, triangle.vertices.begin() + 4);
  triangle.faces[0].vertices = {0, 1, 2};
  expect(With(triangle, 0, 1, CurveEdge{Wave(border, 2, 3, 7)}), "UNSUPPORTED_SCHEME",
         "to the corner opposite");
}

}  // namespace
}  // namespace patchmill
