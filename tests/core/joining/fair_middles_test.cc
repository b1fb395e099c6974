// The estimated middles of G2 networks against known surfaces: the table of docs/theory/joining.md, section
// 10.
#include "core/joining/fair_middles.h"

#include <algorithm>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "core/base/index.h"
#include "tests/core/joining/networks.h"
#include "tests/support/known_surfaces.h"

namespace patchmill {
namespace {

using testing::KnownGrid;
using testing::KnownNetwork;
using testing::LargestError;
using testing::WithMeans;
using testing::WithTruth;

// The largest difference of the control points of two joined networks.
double Difference(const JoinedNetwork& a, const JoinedNetwork& b) {
  EXPECT_EQ(a.model.patches.size(), b.model.patches.size());
  double largest = 0.0;
  for (std::size_t f = 0; f < a.model.patches.size(); ++f) {
    const auto& p = std::get<G2GregoryPatch>(a.model.patches[f].shape).points;
    const auto& q = std::get<G2GregoryPatch>(b.model.patches[f].shape).points;
    for (std::size_t i = 0; i < p.size(); ++i) largest = std::max(largest, (p[i] - q[i]).norm());
  }
  return largest;
}

// Prints the table. Among the surfaces are some whose error is that of their edge curves alone: translation
// surfaces and cylinders are met by the means already.
TEST(FairMiddles, KnownSurfacesAreNearer) {
  std::vector<double> shares;
  fmt::print("{:<26}{:>10}{:>10}{:>14}\n", "surface (mm)", "means", "now", "true vectors");
  for (const KnownNetwork& known : testing::KnownSurfaces()) {
    const JoinedNetwork joined = JoinNetwork(known.network);
    ASSERT_EQ(joined.model.patches.size(), known.corners.size()) << testing::Text(joined.findings);
    const double means = LargestError(known, JoinNetwork(WithMeans(known))),
                 now = LargestError(known, joined);
    const bool grid = known.name.find("vertex") == std::string::npos;
    fmt::print("{:<26}{:>10.5f}{:>10.5f}{:>14}\n", known.name, means, now,
               grid ? fmt::format("{:.5f}", LargestError(known, JoinNetwork(WithTruth(known)))) : "-");
    EXPECT_LE(now, means * (1 + 1e-6) + 1e-9) << known.name;
    shares.push_back(means > 1e-9 ? now / means : 1.0);
  }
  ASSERT_EQ(shares.size(), 20u);
  std::ranges::sort(shares);
  fmt::print("median of the shares: {:.3f}\n", 0.5 * (shares[9] + shares[10]));
  EXPECT_LE(0.5 * (shares[9] + shares[10]), 1.0 / 3.0);
}

TEST(FairMiddles, ABicubicOfTwoByTwoFaces) {
  const KnownNetwork known = testing::KnownBicubic();
  const double means = LargestError(known, JoinNetwork(WithMeans(known)), 17),
               now = LargestError(known, JoinNetwork(known.network), 17),
               truth = LargestError(known, JoinNetwork(WithTruth(known)), 17);
  fmt::print("means {:.4f}, now {:.4f}, true vectors {:.4f}\n", means, now, truth);
  EXPECT_GE(means, 0.3);
  EXPECT_LE(now, 0.01);
  EXPECT_NEAR(now, truth, 1e-5);
}

// Theorem: from three faces in one direction and two in the other on, the vectors are those of the bicubic.
TEST(FairMiddles, BicubicsAreReproduced) {
  for (unsigned seed = 10; seed < 14; ++seed) {
    testing::Random random(seed);
    const auto knots = [&](int spans) {
      std::vector<double> at = {0.0};
      for (int i = 0; i < spans; ++i) at.push_back(at.back() + random.Uniform(0.5, 1.5));
      for (double& t : at) t /= at.back();
      return at;
    };
    const KnownNetwork known =
        KnownGrid("", testing::RandomBicubic(seed, 12.0), knots(2 + static_cast<int>(seed % 3)),
                  knots(3 + static_cast<int>(seed % 2)));
    EXPECT_LE(Difference(JoinNetwork(known.network), JoinNetwork(WithTruth(known))), 1e-5) << seed;
    EXPECT_GE(Difference(JoinNetwork(WithMeans(known)), JoinNetwork(WithTruth(known))), 0.05) << seed;
  }
}

// What 2 x 2 faces cannot tell: two surfaces that differ by the hidden part have the same curves.
TEST(FairMiddles, TheHiddenPartLeavesTheCurvesAlone) {
  const testing::KnownSurface s = testing::RandomBicubic(5, 6.0);
  const KnownNetwork plain = KnownGrid("", s, {0, 0.5, 1}, {0, 0.5, 1});
  const KnownNetwork other = KnownGrid(
      "", [&](double u, double v) { return Vec3(s(u, v) + testing::HiddenPart(u, v) * Vec3(50, 90, 400)); },
      {0, 0.5, 1}, {0, 0.5, 1});
  EXPECT_GE(Difference(JoinNetwork(WithTruth(plain)), JoinNetwork(WithTruth(other))), 0.5);
  EXPECT_LE(Difference(JoinNetwork(plain.network), JoinNetwork(other.network)), 1e-8);
}

// The order of corners and of edges is of no importance.
TEST(FairMiddles, TurnedFacesAreTheSame) {
  const KnownNetwork known = testing::KnownSurfaces()[1];
  KnownNetwork turned = known;
  testing::Random random(3);
  for (std::size_t f = 0; f < turned.corners.size(); ++f) {
    auto& loop = turned.network.faces[f].vertices;
    auto& corners = turned.corners[f];
    const int by = random.Int(4);
    std::rotate(loop.begin(), loop.begin() + by, loop.end());
    std::rotate(corners.begin(), corners.begin() + by, corners.end());
    if (random.Int(2) == 0) continue;
    std::ranges::reverse(loop);
    std::ranges::reverse(corners);
  }
  std::ranges::reverse(turned.network.edges);
  EXPECT_NEAR(LargestError(turned, JoinNetwork(turned.network)),
              LargestError(known, JoinNetwork(known.network)), 1e-6);
}

// Moved, turned and scaled, the surface is moved, turned and scaled.
TEST(FairMiddles, FollowsAMotion) {
  const CurveNetwork network = testing::LineSheet(9, 5, 4);
  CurveNetwork moved = network;
  const Eigen::Affine3d motion = Eigen::Translation3d(30, -20, 7) *
                                 Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()) * Eigen::Scaling(2.5);
  for (NetworkVertex& v : moved.vertices) v.position = motion * v.position;
  JoinedNetwork joined = JoinNetwork(network);
  ASSERT_FALSE(joined.model.patches.empty());
  for (Patch& patch : joined.model.patches) {
    for (Vec3& p : std::get<G2GregoryPatch>(patch.shape).points) p = motion * p;
  }
  EXPECT_LE(Difference(joined, JoinNetwork(moved)), 1e-9);
}

// Where the network leaves nothing to estimate, the means stay: faces without a joint of equal curvature, and
// faces beside a smooth edge that is no such joint.
TEST(FairMiddles, NothingToEstimateKeepsTheMeans) {
  const auto estimated = [](const CurveNetwork& network) {
    const JoinedNetwork joined = JoinNetwork(network);
    EXPECT_FALSE(joined.edges.empty()) << testing::Text(joined.findings);
    EdgeTable table;
    Diagnostics findings;
    CurveNetwork edges = network;
    edges.lines.clear();
    for (const JoinedEdge& edge : joined.edges) {
      const TableEdge& t = edge.topology;
      std::erase_if(edges.edges, [&](const NetworkEdge& e) {
        return std::minmax(e.start, e.end) == std::minmax(t.start, t.end);
      });
      edges.edges.push_back({"", t.start, t.end, CurveEdge{SpanOf(edge.curve, 0)}, t.crease, {}});
    }
    table = BuildEdgeTable(edges, findings);
    const FairMiddles middles = EstimateMiddles({network, table, joined.edges});
    return std::ranges::count_if(middles, [](const auto& m) { return m[0].has_value(); });
  };
  CurveNetwork network = testing::LineSheet(5, 4, 4);
  EXPECT_EQ(estimated(network), 24);
  network.faces[4].scheme = PatchScheme::kGregory;  // the middle one: four faces beside it keep their means
  EXPECT_EQ(estimated(network), 0);                 // and the corner faces have no joint left
  CurveNetwork one = testing::LineSheet(5, 2, 2);
  EXPECT_EQ(estimated(one), 0);
}

}  // namespace
}  // namespace patchmill
