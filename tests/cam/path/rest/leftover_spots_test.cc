#include "cam/path/rest/leftover_spots.h"

#include <cmath>

#include <gtest/gtest.h>

#include "cam/limits/reach_tolerance.h"
#include "core/diffgeo/forms.h"
#include "core/surface/closest.h"
#include "tests/support/joined_surface.h"
#include "tests/support/random.h"
#include "tests/support/shapes.h"

namespace patchmill {
namespace {

using namespace patchmill::testing;

constexpr double kTolerance = 0.01, kReachTolerance = ReachTolerance(kTolerance);

RestPassParams Coverage() {
  RestPassParams params;
  params.pass.scallop = 0.02;
  params.tolerance = kTolerance;
  params.limit = params.pass.scallop + 0.75 * kTolerance;
  return params;
}

// z = x^2 (k0 + k2 y^2) / 2 over [-2,2]^2: a valley that is widest at y = 0. One patch, exact.
PatchModel NarrowingValley(double k0, double k2) {
  BezierPatch patch;
  patch.degree_u = patch.degree_v = 2;
  // Bernstein coefficients of x^2 over [-2,2] are 4, -4, 4.
  const std::array<double, 3> square = {4.0, -4.0, 4.0};
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      patch.points.emplace_back(
          2.0 * (i - 1), 2.0 * (j - 1),
          0.5 * square[static_cast<std::size_t>(i)] * (k0 + k2 * square[static_cast<std::size_t>(j)]));
    }
  }
  return Single(std::move(patch));
}

// How deep a ball of this radius over the bottom of the valley z = k x^2 / 2 lies in its flanks.
double DepthInValley(double radius, double k) { return radius - std::sqrt(2.0 * radius / k - 1.0 / (k * k)); }
// Its inverse: the curvature that is this much too tight.
double CurvatureOfDepth(double radius, double depth) {
  const double s = 1.0 - depth / radius;  // s^2 = 1 - (1 - 1 / (k R))^2
  return 1.0 / (radius * (1.0 - std::sqrt(1.0 - s * s)));
}

std::vector<LeftoverSpot> SpotsAlongBottom(double depth) {
  const double radius = 3.0, k = CurvatureOfDepth(radius, depth);
  EXPECT_NEAR(DepthInValley(radius, k), depth, 1e-12);
  const Surface surface = JoinedSurface(NarrowingValley(k, 0.05 * k));
  const Locator locator(surface, radius);
  const RestPassParams params = Coverage();
  const Locator reach = *ReachLocator(locator, params, RunContext());
  // A strip along the bottom, 0.02 mm wide, and nothing cut yet.
  auto spots =
      FindSpots({locator, reach}, {}, {{PieceId(0), 0.4975, 0.5025, 0.0, 1.0}}, params, RunContext(1));
  EXPECT_TRUE(spots.ok()) << spots.status();
  return std::move(*spots);
}

// Only the bottom's widest place can be reached: an island of a thousandth of a square millimetre.
TEST(FindSpots, FindsSmallIslandsOfReach) {
  const std::vector<LeftoverSpot> spots = SpotsAlongBottom(0.9999 * kReachTolerance);
  ASSERT_FALSE(spots.empty());
  for (const LeftoverSpot& s : spots) EXPECT_LT(std::abs(s.at.p.y()), 0.3);
}

TEST(FindSpots, FindsNothingInAStripWithoutReach) {
  EXPECT_TRUE(SpotsAlongBottom((1.0 + 1.1 * kReachMargin) * kReachTolerance).empty());
}

// What is said to be out of reach has no free ball anywhere.
void ExpectNoFreeBall(const Surface& surface, double radius, int rects, int least) {
  const CellReachParams params{radius, kReachTolerance, -kInfinity};
  Random random(7);
  int out_of_reach = 0;
  for (int i = 0; i < rects; ++i) {
    const PieceId piece(random.Int(static_cast<int>(surface.pieces.size())));
    const double w = 0.5 * std::exp(random.Uniform(-6.0, 0.0));
    const double u = random.Uniform(0.0, 1.0 - w), v = random.Uniform(0.0, 1.0 - w);
    const SurfaceRect rect{piece, u, u + w, v, v + w};
    auto places = PlacesOn(surface, rect, 0.0);
    if (!places) continue;
    for (const Vec3& p : places->p) places->size = std::max(places->size, (p - places->p[8]).norm());
    Blockers blockers;
    if (!OutOfReach(surface, *places, params, blockers)) continue;
    ++out_of_reach;
    for (int k = 0; k < 100; ++k) {
      const SurfaceJet jet = Evaluate(surface, piece, u + w * random.Unit(), v + w * random.Unit());
      const auto e = UpwardNormal(jet);
      if (!e) continue;
      EXPECT_TRUE(AnythingNearUpwardRay(surface, jet.p + radius * *e, radius - kReachTolerance, 1e-9))
          << "a ball is free over " << jet.p.transpose();
    }
  }
  EXPECT_GE(out_of_reach, least);
}

TEST(OutOfReach, IsTrueOnlyWithoutAFreeBall) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    ExpectNoFreeBall(JoinedSurface(RandomBspline(seed, {.spans = 4, .size = 14, .folds = true})), 2.0, 1500,
                     100);
  }
  ExpectNoFreeBall(JoinedSurface(RandomBspline(4, {.spans = 5, .size = 20, .rational = true})), 4.0, 1500,
                   100);
  ExpectNoFreeBall(JoinedSurface(Torus({0, 0, 0}, 12, 5)), 3.0, 1500, 100);
}

}  // namespace
}  // namespace patchmill
