// Tangent-plane joins along one edge: vectors of [joining, section 4], general edges, rank-deficient cases.
#include "core/joining/tangent_plane.h"

#include <cmath>

#include <Eigen/SVD>
#include <gtest/gtest.h>

#include "core/joining/face_push.h"
#include "tests/support/eigen_matchers.h"
#include "tests/support/json.h"
#include "tests/support/random.h"

namespace patchmill {
namespace {

using testing::IsNear;
using testing::Json;
using testing::LoadJson;
using testing::Random;

#define VECTORS PATCHMILL_SOURCE_DIR "/tests/vectors/"

struct VectorData {
  const Json data = LoadJson(VECTORS "twist_tangent_plane.json");
  CrossTangents tangents{At("a0"), At("a1"), At("b0"), At("b1")};
  HermiteCurve edge{At("P0"), At("c0"), At("P1"), -At("c1")};
  Vec3 At(const char* key) const { return data[key].Vector(); }
};

EdgeTwists TwistsOf(const Json& rows) {
  return {rows[0].Vector(), rows[1].Vector(), rows[2].Vector(), rows[3].Vector()};
}
void ExpectTwists(const EdgeTwists& a, const EdgeTwists& b) {
  EXPECT_THAT(a.a0, IsNear(b.a0, 1e-12));
  EXPECT_THAT(a.a1, IsNear(b.a1, 1e-12));
  EXPECT_THAT(a.b0, IsNear(b.b0, 1e-12));
  EXPECT_THAT(a.b1, IsNear(b.b1, 1e-12));
}

// Largest sine of the angle at which C' leaves the plane of both CBTs, over the edge.
double WorstDefect(const BezierCurve& curve, const BezierCurve& a, const BezierCurve& b) {
  double worst = 0;
  for (int k = 0; k <= 200; ++k) {
    const double u = k / 200.0;
    const Vec3 c = Evaluate(curve, u).d.normalized();
    const Vec3 na = c.cross(Evaluate(a, u).p).normalized(), nb = c.cross(Evaluate(b, u).p).normalized();
    worst = std::max(worst, na.cross(nb).norm());
  }
  return worst;
}

double WorstDefect(const HermiteCurve& edge, const CrossTangents& t, const EdgeTwists& w) {
  return WorstDefect(ToBezier(edge), CrossBoundaryTangent(t.a0, w.a0, t.a1, w.a1),
                     CrossBoundaryTangent(t.b0, w.b0, t.b1, w.b1));
}

// Tangents of both sides in given planes.
struct RandomEdge {
  Vec3 n0, n1;
  HermiteCurve edge;
  CrossTangents tangents;
  explicit RandomEdge(Random& random) {
    n0 = (Vec3(0, 0, 1) + random.Point(-0.4, 0.4)).normalized();
    n1 = (Vec3(0, 0, 1) + random.Point(-0.4, 0.4)).normalized();
    const auto flat = [&](const Vec3& v, const Vec3& n) { return Vec3(v - n * n.dot(v)); };
    const auto draw = [&](const Vec3& v, const Vec3& n) { return flat(v + random.Point(-0.4, 0.4), n); };
    edge = {random.Point(-0.2, 0.2), draw(Vec3(1, 0, 0), n0), Vec3(1, 0, 0) + random.Point(-0.2, 0.2),
            draw(Vec3(1, 0, 0), n1)};
    tangents = {draw(Vec3(0, 1, 0), n0), draw(Vec3(0, 1, 0), n1), draw(Vec3(0, -1, 0), n0),
                draw(Vec3(0, -1, 0), n1)};
  }
};

TEST(TangentPlane, Vector) {
  const VectorData in;
  const auto found = FactorsAlong(in.edge.d0, in.edge.d1, in.tangents, in.At("n0"), in.At("n1"));
  ASSERT_TRUE(std::holds_alternative<JoinFactors>(found));
  const JoinFactors factors = std::get<JoinFactors>(found);
  for (int i = 0; i < 2; ++i) {
    const auto k = static_cast<std::size_t>(i);
    EXPECT_NEAR(factors.l[k], in.data["l"][i].Number(), 1e-12);
    EXPECT_NEAR(factors.h[k], in.data["h"][i].Number(), 1e-12);
    EXPECT_NEAR(factors.k[k], in.data["k"][i].Number(), 1e-12);
  }
  const TwistConditions conditions = ConditionsFor(in.edge, in.tangents, factors);
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 4; ++c) EXPECT_NEAR(conditions.matrix(r, c), in.data["A"][r][c].Number(), 1e-12);
    EXPECT_THAT(conditions.right.row(r).transpose(), IsNear(in.data["R"][r].Vector(), 1e-12));
  }
  const EdgeTwists wished = WishedTwists(in.tangents);
  ExpectTwists(wished, TwistsOf(in.data["Wstar"]));
  const EdgeTwists twists = NearestTwists(in.edge, in.tangents, factors, wished);
  ExpectTwists(twists, TwistsOf(in.data["W"]));
  EXPECT_LE(WorstDefect(in.edge, in.tangents, twists), 1e-14);

  const Json edited = LoadJson(VECTORS "twist_modification.json");
  EdgeTwists pushed = wished;
  const EndVectors added = PushTwists({in.edge.d0, in.edge.d1}, {in.tangents.b0, in.tangents.b1},
                                      {edited["u"].Number(), edited["v"].Number()}, edited["r"].Number());
  pushed.b0 += added.start;
  pushed.b1 += added.end;
  ExpectTwists(pushed, TwistsOf(edited["Wstar"]));
  EXPECT_LE((pushed.b0 - wished.b0).normalized().cross(edited["N"].Vector()).norm(), 1e-12);
  ExpectTwists(NearestTwists(in.edge, in.tangents, factors, pushed), TwistsOf(edited["W"]));
}

// One side given all along, linear or cubic, on edges of any degree: the other follows.
TEST(TangentPlane, FollowingTangentHoldsAlongRandomEdges) {
  Random random(6);
  for (int k = 0; k < 300; ++k) {
    const RandomEdge e(random);
    const auto found = FactorsAlong(e.edge.d0, e.edge.d1, e.tangents, e.n0, e.n1);
    if (!std::holds_alternative<JoinFactors>(found)) continue;
    BezierCurve leading{{e.tangents.a0, e.tangents.a1}};
    if (k % 2 == 0) {
      leading = Elevated(leading, 3);
      leading.points[1] += random.Point(-0.2, 0.2), leading.points[2] += random.Point(-0.2, 0.2);
    }
    BezierCurve curve = Elevated(ToBezier(e.edge), 4 + k % 4);
    if (k % 3 == 0) curve.points[2] += random.Point(-0.1, 0.1);
    const BezierChain b = FollowingTangent(AsChain(curve), AsChain(leading), std::get<JoinFactors>(found),
                                           e.tangents.b0, e.tangents.b1);
    EXPECT_EQ(b.degree, curve.degree());
    EXPECT_EQ(b.spans(), 1);
    EXPECT_THAT(Evaluate(b, 0).p, IsNear(e.tangents.b0, 1e-15));
    EXPECT_THAT(Evaluate(b, 1).p, IsNear(e.tangents.b1, 1e-15));
    // Coplanar along the edge, whatever the size of b there.
    for (double u = 0; u <= 1; u += 0.0625) {
      const Vec3 c = Evaluate(curve, u).d, a = Evaluate(leading, u).p, at = Evaluate(b, u).p;
      EXPECT_LE(std::abs(c.cross(a).dot(at)), 1e-14 * std::max(1.0, c.norm() * a.norm() * at.norm()));
    }
  }
}

// Crossing edges that run on in line with the leading side: Hosaka's rule [joining (13)], one factor all
// along.
TEST(TangentPlane, FollowingTangentIsHosakasWhereEdgesRunOn) {
  Random random(7);
  const RandomEdge e(random);
  const double k = 0.7;
  const CrossTangents t{e.tangents.a0, e.tangents.a1, -k * e.tangents.a0, -k * e.tangents.a1};
  const JoinFactors factors = std::get<JoinFactors>(FactorsAlong(e.edge.d0, e.edge.d1, t, e.n0, e.n1));
  const BezierCurve leading{{t.a0, t.a1}};
  const BezierChain b = FollowingTangent(AsChain(ToBezier(e.edge)), AsChain(leading), factors, t.b0, t.b1);
  for (double u = 0; u <= 1; u += 0.125)
    EXPECT_THAT(Evaluate(b, u).p, IsNear(-k * Evaluate(leading, u).p, 1e-14));
}

TEST(TangentPlane, HoldsAlongRandomEdges) {
  Random random(1);
  for (int k = 0; k < 300; ++k) {
    const RandomEdge e(random);
    const auto found = FactorsAlong(e.edge.d0, e.edge.d1, e.tangents, e.n0, -e.n1);  // senses do not matter
    ASSERT_TRUE(std::holds_alternative<JoinFactors>(found));
    const JoinFactors f = std::get<JoinFactors>(found);
    EXPECT_NEAR(f.h[0] + f.k[0], 2, 1e-15);
    EXPECT_NEAR(f.h[1] + f.k[1], 2, 1e-15);
    const EdgeTwists wished = WishedTwists(e.tangents), got = NearestTwists(e.edge, e.tangents, f, wished);
    EXPECT_LE(WorstDefect(e.edge, e.tangents, got), 1e-12);

    // No other solution is nearer: the step is perpendicular to the null space of the conditions.
    const TwistConditions conditions = ConditionsFor(e.edge, e.tangents, f);
    const Eigen::FullPivLU<Eigen::Matrix<double, 3, 4>> lu(conditions.matrix);
    const Eigen::Vector4d null = lu.kernel().col(0).normalized();
    const Vec3 along = null[0] * (got.a0 - wished.a0) + null[1] * (got.a1 - wished.a1) +
                       null[2] * (got.b0 - wished.b0) + null[3] * (got.b1 - wished.b1);
    EXPECT_LE(along.norm(), 1e-12);

    // Run the other way with the sides exchanged: the same twists.
    const CrossTangents back{e.tangents.b1, e.tangents.b0, e.tangents.a1, e.tangents.a0};
    const HermiteCurve reversed = Reversed(e.edge);
    const auto other = std::get<JoinFactors>(FactorsAlong(reversed.d0, reversed.d1, back, e.n1, e.n0));
    const EdgeTwists again = NearestTwists(reversed, back, other, WishedTwists(back));
    // Rounding is amplified by the condition of [joining (7)], which is large near rank 2.
    const Eigen::Vector3d sigma = Eigen::MatrixXd(conditions.matrix).jacobiSvd().singularValues();
    const double tolerance = 1e-14 * sigma[0] / sigma[2];
    EXPECT_THAT(again.a0, IsNear(got.b1, tolerance));
    EXPECT_THAT(again.b1, IsNear(got.a0, tolerance));
  }
}

TEST(TangentPlane, RankTwoIsSolvedToo) {
  Random random(2);
  for (int k = 0; k < 50; ++k) {
    RandomEdge e(random);
    e.tangents.b0 = -e.tangents.a0;  // h = k at both ends
    e.tangents.b1 = -e.tangents.a1;
    const auto f = std::get<JoinFactors>(FactorsAlong(e.edge.d0, e.edge.d1, e.tangents, e.n0, e.n1));
    EXPECT_NEAR(f.l[0], 0, 1e-15);
    const EdgeTwists got = NearestTwists(e.edge, e.tangents, f, WishedTwists(e.tangents));
    EXPECT_LE(WorstDefect(e.edge, e.tangents, got), 1e-12);
    EXPECT_THAT(got.a0, IsNear(-got.b0, 1e-12));
  }
}

TEST(TangentPlane, GeneralEdgesNeedTheirCorrection) {
  Random random(3);
  for (int degree = 3; degree <= 11; ++degree) {
    const RandomEdge e(random);
    const auto f = std::get<JoinFactors>(FactorsAlong(e.edge.d0, e.edge.d1, e.tangents, e.n0, e.n1));
    BezierCurve curve = Elevated(ToBezier(e.edge), degree);
    for (int i = 2; i <= degree - 2; ++i)
      curve.points[static_cast<std::size_t>(i)] += random.Point(-0.3, 0.3);
    const EdgeTwists w = NearestTwists(e.edge, e.tangents, f, WishedTwists(e.tangents));
    BezierCurve a = Elevated(CrossBoundaryTangent(e.tangents.a0, w.a0, e.tangents.a1, w.a1), degree);
    BezierCurve b = Elevated(CrossBoundaryTangent(e.tangents.b0, w.b0, e.tangents.b1, w.b1), degree);
    if (degree > 3) {
      EXPECT_GT(WorstDefect(curve, a, b), 1e-6);
    }
    const BezierChain more = CorrectionFor(AsChain(curve), f);
    ASSERT_EQ(more.degree, degree);
    for (std::size_t i = 0; i < more.points.size(); ++i)
      a.points[i] += more.points[i], b.points[i] += more.points[i];
    EXPECT_LE(WorstDefect(curve, a, b), 1e-12);
    EXPECT_THAT(Evaluate(a, 0).p, IsNear(e.tangents.a0, 1e-15));
    EXPECT_THAT(Evaluate(b, 1).p, IsNear(e.tangents.b1, 1e-15));
  }
}

TEST(TangentPlane, FoldsAndParallelTangentsAreFaults) {
  const Vec3 n(0, 0, 1), c(1, 0, 0), up(0.2, 1, 0), down(0.1, -1, 0);
  EXPECT_TRUE(std::holds_alternative<JoinFactors>(FactorsAlong(c, c, {up, up, down, down}, n, n)));
  EXPECT_EQ(std::get<JoinFault>(FactorsAlong(c, c, {up, up, up, down}, n, n)), JoinFault::kFolded);
  EXPECT_EQ(std::get<JoinFault>(FactorsAlong(c, c, {up, up, down, Vec3(0.5, 2, 0)}, n, n)),
            JoinFault::kFolded);
  EXPECT_EQ(std::get<JoinFault>(FactorsAlong(c, c, {up, Vec3(-1, 0, 0), down, down}, n, n)),
            JoinFault::kParallel);
}

}  // namespace
}  // namespace patchmill
