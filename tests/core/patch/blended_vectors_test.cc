// Vectors of [shapes, section 3] to [shapes, section 6]: Brown quad, both triangles, G2-Gregory patch, Hosaka
// patch.
#include <cmath>

#include <gtest/gtest.h>

#include "core/patch/piece.h"
#include "tests/support/eigen_matchers.h"
#include "tests/support/json.h"

namespace patchmill {
namespace {

using testing::IsNear;
using testing::Json;
using testing::LoadJson;

#define VECTORS PATCHMILL_SOURCE_DIR "/tests/vectors/"

// Natively and from the rational net; second derivatives are of order 10.
void ExpectJets(const PatchShape& shape, const Json& points, const char* u, const char* v,
                const std::array<const char*, 6>& keys) {
  ASSERT_GE(points.Items().size(), 3u);
  for (const Json& at : points.Items()) {
    const double x = at[u].Number(), y = at[v].Number();
    const SurfaceJet s = Evaluate(shape, x, y);
    const Vec3 own[6] = {s.p, s.du, s.dv, s.duu, s.duv, s.dvv};
    for (int k = 0; k < 6; ++k) {
      const auto i = static_cast<std::size_t>(k);
      EXPECT_THAT(own[k], IsNear(at[keys[i]].Vector(), k < 3 ? 2e-12 : 1e-11)) << keys[i];
    }
    EXPECT_THAT(Position(shape, x, y), IsNear(at[keys[0]].Vector(), 1e-12)) << "position";
  }
}
constexpr std::array<const char*, 6> kUv = {"S", "Su", "Sv", "Suu", "Suv", "Svv"};
constexpr std::array<const char*, 6> kArea = {"S", "S2", "S3", "S22", "S23", "S33"};

TEST(BrownPatch, Vector) {
  const Json data = LoadJson(VECTORS "brown_quad.json");
  const auto at = [&](const char* key, int i, int j) { return data[key][i][j].Vector(); };
  // Bezier points of a Hermite cubic; vectors and points alike.
  const auto cubic = [](const Vec3& p0, const Vec3& d0, const Vec3& p1, const Vec3& d1) {
    return std::array<Vec3, 4>{p0, p0 + d0 / 3, p1 - d1 / 3, p1};
  };
  std::array<std::array<Vec3, 4>, 4> curve, across;  // v=0, v=1, u=0, u=1; true cross derivatives
  for (int side = 0; side < 2; ++side) {
    const auto i = static_cast<std::size_t>(side);
    curve[i] = cubic(at("P", 0, side), at("Pu", 0, side), at("P", 1, side), at("Pu", 1, side));
    across[i] = cubic(at("Pv", 0, side), at("W1", 0, side), at("Pv", 1, side), at("W1", 1, side));
    curve[2 + i] = cubic(at("P", side, 0), at("Pv", side, 0), at("P", side, 1), at("Pv", side, 1));
    across[2 + i] = cubic(at("Pu", side, 0), at("W2", side, 0), at("Pu", side, 1), at("W2", side, 1));
  }
  // Columns of degree 4: u=0 carries v^2 (1-v)^2 dC, its tangent v^2 (1-v)^2 db; that is 1/6 of B_2^4.
  const auto quartic = [](const std::array<Vec3, 4>& c, const Vec3& extra) {
    return std::array<Vec3, 5>{c[0], c[0] / 4 + 3 * c[1] / 4, (c[1] + c[2]) / 2 + extra / 6,
                               3 * c[2] / 4 + c[3] / 4, c[3]};
  };
  BrownPatch patch;
  patch.degree_u = 3;
  patch.degree_v = 4;
  for (const int e : {0, 1}) patch.points.insert(patch.points.end(), curve[e].begin(), curve[e].end());
  std::array<std::array<Vec3, 5>, 2> column, column_across;
  for (int e = 0; e < 2; ++e) {
    column[e] = quartic(curve[2 + e], e == 0 ? data["dC"].Vector() : Vec3::Zero());
    column_across[e] = quartic(across[2 + e], e == 0 ? data["db"].Vector() : Vec3::Zero());
    for (int k = 1; k < 4; ++k) patch.points.push_back(column[e][k]);
  }
  for (int e = 0; e < 2; ++e) {
    for (int k = 1; k < 3; ++k) patch.points.push_back(curve[e][k] + (e == 0 ? 1 : -1) * across[e][k] / 3);
  }
  for (int e = 0; e < 2; ++e) {
    for (int k = 1; k < 4; ++k) {
      patch.points.push_back(column[e][k] + (e == 0 ? 1 : -1) * column_across[e][k] / 3);
    }
  }
  ExpectJets(patch, data["points"], "u", "v", kUv);
  for (int i = 0; i < 2; ++i) {
    for (int j = 0; j < 2; ++j) {
      const SurfaceJet s = Evaluate(PatchShape(patch), i, j);
      EXPECT_THAT(s.p, IsNear(at("P", i, j), 1e-15)) << "P";
      EXPECT_THAT(s.du, IsNear(at("Pu", i, j), 1e-14)) << "Pu";
      EXPECT_THAT(s.dv, IsNear(at("Pv", i, j), 1e-14)) << "Pv";
      EXPECT_THAT(s.duv, IsNear(0.5 * (at("W1", i, j) + at("W2", i, j)), 1e-12)) << "Suv";
    }
  }
}

struct TriangleData {
  const Json data = LoadJson(VECTORS "gregory_triangle.json");
  // The vector's vertices 0, 1, 2 as ours: (s,t) = (u2,u3), so vertex k is ours too; edge e there runs from
  // vertex e+1 to e+2.
  Vec3 P(int i) const { return data["P"][i % 3].Vector(); }
  Vec3 T(int from, int to) const { return data["T"][from % 3][to % 3].Vector(); }
  // Twists, in the convention of [joining (3)], of the edge from vertex e to e+1.
  Vec3 StartTwist(int e) const { return data["Ws"][(e + 2) % 3].Vector(); }
  Vec3 EndTwist(int e) const { return data["We"][(e + 2) % 3].Vector(); }
};

TEST(LoftTriangle, Vectors) {
  const TriangleData in;
  LoftTriangle patch;
  for (int e = 0; e < 3; ++e) {
    patch.points.push_back(in.P(e));
    patch.points.push_back(in.P(e) + in.T(e, e + 1) / 3);
    patch.points.push_back(in.P(e + 1) + in.T(e + 1, e) / 3);
  }
  for (int e = 0; e < 3; ++e) {
    patch.points.push_back(in.P(e) + in.T(e, e + 1) / 3 + (in.T(e, e + 2) + in.StartTwist(e) / 3) / 3);
    patch.points.push_back(in.P(e + 1) + in.T(e + 1, e) / 3 + (in.T(e + 1, e + 2) + in.EndTwist(e) / 3) / 3);
  }
  const Json data = LoadJson(VECTORS "degenerate_triangle.json");
  ExpectJets(patch, data["points"], "u2", "u3", kArea);
  patch.squared = true;
  ExpectJets(patch, data["points_squared"], "u2", "u3", kArea);

  // The same triangle written with degree 4 (squared weights).
  LoftTriangle high;
  high.degree = 4;
  high.squared = true;
  const auto raised = [](const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
    return std::array<Vec3, 5>{a, a / 4 + 3 * b / 4, (b + c) / 2, 3 * c / 4 + d / 4, d};
  };
  const auto& p = patch.points;
  std::vector<Vec3> rails;
  for (std::size_t e = 0; e < 3; ++e) {
    const auto row = raised(p[3 * e], p[3 * e + 1], p[3 * e + 2], p[(3 * e + 3) % 9]);
    for (int k = 0; k < 4; ++k) high.points.push_back(row[static_cast<std::size_t>(k)]);
    const auto rail = raised(p[(3 * e + 8) % 9], p[9 + 2 * e], p[10 + 2 * e], p[(3 * e + 4) % 9]);
    rails.insert(rails.end(), rail.begin() + 1, rail.begin() + 4);
  }
  high.points.insert(high.points.end(), rails.begin(), rails.end());
  ExpectJets(high, data["points_squared"], "u2", "u3", kArea);
}

TEST(GregoryTriangle, Vector) {
  const TriangleData in;
  GregoryTriangle patch;
  patch.blend = GregoryPatch::Blend::kEdge;
  for (int e = 0; e < 3; ++e) {
    const auto k = static_cast<std::size_t>(5 * e);
    const int next = e + 1, last = e + 2;
    patch.points[k] = in.P(e);
    patch.points[k + 1] = in.P(e) + in.T(e, next) / 4;
    patch.points[k + 2] = in.P(e) + in.T(e, last) / 4;
    // [shapes (14)]: from the edge that leaves, and from the one that arrives.
    patch.points[k + 3] = in.P(e) + in.T(e, next) / 3 + in.T(e, last) / 4 + in.StartTwist(e) / 12;
    patch.points[k + 4] = in.P(e) + in.T(e, last) / 3 + in.T(e, next) / 4 + in.EndTwist(e + 2) / 12;
    patch.points[static_cast<std::size_t>(15 + e)] =
        (in.P(e) + in.P(next) + in.T(e, next) / 3 + in.T(next, e) / 3) / 2;
  }
  ExpectJets(patch, in.data["points"], "u2", "u3", kArea);
  // The net of each sub-patch, keyed by the powers of u1 u2 u3; for edge e, from vertex a to b.
  for (int e = 0; e < 3; ++e) {
    const int a = (e + 1) % 3, b = (e + 2) % 3;
    const auto expect = [&](int at_e, int at_a, int at_b, const Vec3& point) {
      std::string key = "000";
      key[static_cast<std::size_t>(e)] = static_cast<char>('0' + at_e);
      key[static_cast<std::size_t>(a)] = static_cast<char>('0' + at_a);
      key[static_cast<std::size_t>(b)] = static_cast<char>('0' + at_b);
      EXPECT_THAT(point, IsNear(in.data["nets"][e][key].Vector(), 1e-12)) << key.c_str();
    };
    const auto own = [&](int k) { return patch.points[static_cast<std::size_t>(k)]; };
    expect(4, 0, 0, own(5 * e));
    expect(3, 1, 0, own(5 * e + 1));
    expect(3, 0, 1, own(5 * e + 2));
    expect(0, 2, 2, own(15 + a));
    expect(0, 3, 1, own(5 * a + 1));
    expect(0, 1, 3, own(5 * b + 2));
    expect(1, 2, 1, own(5 * a + 3));
    expect(1, 1, 2, own(5 * b + 4));
    expect(2, 1, 1, 0.5 * (own(5 * e + 3) + own(5 * e + 4)));
    const SurfaceJet s = Evaluate(PatchShape(patch), e == 1 ? 1.0 : 0.0, e == 2 ? 1.0 : 0.0);
    EXPECT_THAT(s.du.cross(s.dv).normalized(), IsNear(in.data["N"][e].Vector(), 1e-12)) << "N";
  }
  // Tangents across the edges, straight to the opposite vertex.
  for (const Json& check : in.data["edge_checks"].Items()) {
    const int o = static_cast<int>(check["edge"].Number());
    const double t = check["t"].Number();
    double area[3] = {};
    area[(o + 1) % 3] = 1 - t;
    area[(o + 2) % 3] = t;
    const SurfaceJet s = Evaluate(PatchShape(patch), area[1], area[2]);
    double direction[3] = {};
    for (int k = 0; k < 3; ++k) direction[k] = (k == o) - area[k];
    EXPECT_THAT(s.p, IsNear(check["point"].Vector(), 1e-12)) << "point";
    EXPECT_THAT(direction[1] * s.du + direction[2] * s.dv, IsNear(check["cbt"].Vector(), 1e-12)) << "cbt";
  }
}

TEST(G2GregoryPatch, Vector) {
  const Json data = LoadJson(VECTORS "g2gregory_patch.json");
  G2GregoryPatch patch;
  patch.degree = static_cast<int>(data["n"].Number());
  for (int i = 0; i <= 6; ++i) {
    for (int j = 0; j <= 6; ++j) patch.points.push_back(data["P0"][i][j].Vector());
  }
  for (const int i : {1, 2, 4, 5}) {
    for (const int j : {1, 2, 4, 5}) patch.points.push_back(data["P1"][i][j].Vector());
  }
  ExpectJets(patch, data["points"], "u", "v", kUv);
  const SurfaceJet corner = Evaluate(PatchShape(patch), 0, 0);
  EXPECT_THAT(corner.duu, IsNear(data["corner00"]["Suu"].Vector(), 1e-12)) << "Suu";
  EXPECT_THAT(corner.dvv, IsNear(data["corner00"]["Svv"].Vector(), 1e-12)) << "Svv";
  EXPECT_THAT(corner.duv, IsNear(data["corner00"]["Suv_mean"].Vector(), 1e-12)) << "Suv";
  const double r = 1e-5;  // outside the radius of fixed values; the limit is reached linearly
  EXPECT_THAT(Evaluate(PatchShape(patch), r, 0).duv, IsNear(data["corner00"]["Suv_along_v0"].Vector(), 1e-3))
      << "v0";
  EXPECT_THAT(Evaluate(PatchShape(patch), 0, r).duv, IsNear(data["corner00"]["Suv_along_u0"].Vector(), 1e-3))
      << "u0";
}

// Curves A, B, C relative to their own starts -> our points.
HosakaPatch FromCurves(const Json& curves, const Vec3& origin) {
  const auto row = [&](const char* key, const Vec3& start) {
    const Vec3 a = curves[key][0].Vector(), b = curves[key][1].Vector(), c = curves[key][2].Vector();
    return std::array<Vec3, 4>{start, start + b / 3, start + a - c / 3, start + a};
  };
  const auto bottom = row("1", origin), left = row("2", origin);
  const auto top = row("3", left[3]), right = row("4", bottom[3]);
  HosakaPatch patch;
  patch.points = {bottom[0], bottom[1], bottom[2], bottom[3], top[0],   top[1],
                  top[2],    top[3],    left[1],   left[2],   right[1], right[2]};
  return patch;
}

TEST(HosakaPatch, Vectors) {
  const Json data = LoadJson(VECTORS "hosaka_patch.json");
  HosakaPatch patch = FromCurves(data["curves"], Vec3::Zero());
  ExpectJets(patch, data["smooth"], "u", "v", kUv);
  HosakaPatch linear = patch;
  linear.blend = HosakaPatch::Blend::kLinear;
  ExpectJets(linear, data["linear"], "u", "v", kUv);
  HosakaPatch inner = patch;
  inner.inner_u = inner.inner_v = 1;
  for (const Vec3& s : {Vec3(0, 0, .8), Vec3(0, 0, 0), Vec3(.1, 0, -.5), Vec3(0, .2, .3)}) {
    inner.points.push_back(patch.points[0] + s);
  }
  ExpectJets(inner, data["inner"], "u", "v", kUv);
  const double v1 = data["v1"].Number(), v2 = data["v2"].Number();
  HosakaPatch t_side = patch;
  t_side.breaks[3] = {{v1, v1}, {v2, v2}};
  ExpectJets(t_side, data["t_side"], "u", "v", kUv);
}

TEST(HosakaPatch, JoinsAlongAWholeEdgeAndAlongAPartOfOne) {
  const Json data = LoadJson(VECTORS "hosaka_patch.json");
  const HosakaPatch whole = FromCurves(data["curves"], Vec3::Zero());
  const HosakaPatch beside = FromCurves(data["connect"]["curves_B"], data["connect"]["origin_B"].Vector());
  const double v1 = data["v1"].Number(), v2 = data["v2"].Number();
  HosakaPatch side = whole;
  side.breaks[3] = {{v1, v1}, {v2, v2}};
  const HosakaPatch part =
      FromCurves(data["t_junction"]["curves_B"], data["t_junction"]["origin_B"].Vector());
  for (int k = 0; k <= 100; ++k) {
    const double v = k / 100.0, at = v1 + v * (v2 - v1);
    const SurfaceJet a = Evaluate(PatchShape(whole), 1, v), b = Evaluate(PatchShape(beside), 0, v);
    EXPECT_THAT(a.p, IsNear(b.p, 1e-14)) << "edge";
    EXPECT_THAT(data["connect"]["k"].Number() * a.du, IsNear(b.du, 1e-13)) << "tangent";
    const SurfaceJet c = Evaluate(PatchShape(side), 1, at), d = Evaluate(PatchShape(part), 0, v);
    EXPECT_THAT(c.p, IsNear(d.p, 1e-14)) << "part";
    EXPECT_THAT(data["t_junction"]["k"].Number() * c.du, IsNear(d.du, 1e-13)) << "tangent at the part";
  }
  EXPECT_THAT(Evaluate(PatchShape(side), 1, v1).du, IsNear(data["t_junction"]["Su_v1"].Vector(), 1e-12))
      << "Su at v1";
  EXPECT_THAT(Evaluate(PatchShape(side), 1, v2).du, IsNear(data["t_junction"]["Su_v2"].Vector(), 1e-12))
      << "Su at v2";
}

}  // namespace
}  // namespace patchmill
