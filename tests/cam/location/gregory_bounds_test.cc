// Gregory quads have proven models everywhere, up to their corners.
#include "cam/location/gregory_bounds.h"

#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "cam/location/ray_distance.h"
#include "tests/support/random.h"
#include "tests/support/shapes.h"

namespace patchmill {
namespace {

using internal::BlendedTerm;
using internal::LeafModel;
using internal::LowerModel;
using internal::Rect;
using testing::Random;

Rect RandomRect(Random& random) {
  const double size = std::exp2(-random.Int(7));
  const auto start = [&] {
    const int where = random.Int(4);  // often at a border, hence at corners too
    return where == 0 ? 0.0 : where == 1 ? 1.0 - size : random.Uniform(0.0, 1.0 - size);
  };
  Rect r;
  r.u0 = start();
  r.u1 = r.u0 + size;
  r.v0 = start();
  r.v1 = r.v0 + size;
  return r;
}

// With three of the four differences zero, the blended terms of a patch without bicubic part are the patch.
TEST(GregoryBounds, HoldTheDerivativesOfEachTerm) {
  constexpr std::array<std::size_t, 4> kFirst = {3, 9, 13, 19};
  Random random(11);
  for (int i = 0; i < 4000; ++i) {
    GregoryPatch patch;
    patch.points.fill(Vec3::Zero());
    const auto corner = static_cast<std::size_t>(random.Int(4));
    patch.points[kFirst[corner]] = Vec3(0, 0, 1);
    patch.blend = random.Int(2) == 0 ? GregoryPatch::Blend::kCorner : GregoryPatch::Blend::kEdge;
    const Rect r = RandomRect(random);
    const BlendedTerm term = internal::BoundBlend(patch, r)[corner];
    ASSERT_EQ(term.d, Vec3(0, 0, 1));
    const double lu = r.u1 - r.u0, lv = r.v1 - r.v0;
    for (int k = 0; k < 20; ++k) {
      const SurfaceJet j =
          Evaluate(PatchShape(patch), random.Uniform(r.u0, r.u1), random.Uniform(r.v0, r.v1));
      const auto inside = [](double x, const internal::Interval& range) {
        return x >= range.lo - 1e-9 && x <= range.hi + 1e-9;
      };
      ASSERT_TRUE(inside(lu * j.du.z(), term.u));
      ASSERT_TRUE(inside(lv * j.dv.z(), term.v));
      ASSERT_TRUE(inside(lu * lu * j.duu.z(), term.uu));
      ASSERT_TRUE(inside(lu * lv * j.duv.z(), term.uv));
      ASSERT_TRUE(inside(lv * lv * j.dvv.z(), term.vv));
    }
  }
}

TEST(GregoryBounds, ModelsAreBelowAndConvexMeansConvexUpToTheCorners) {
  Random random(12);
  int convex = 0, minorants = 0, corners = 0;
  for (int i = 0; i < 20000; ++i) {
    const auto blend = random.Int(2) == 0 ? GregoryPatch::Blend::kCorner : GregoryPatch::Blend::kEdge;
    const PatchShape shape = testing::RandomGregory(static_cast<std::uint64_t>(random.Int(6)), blend);
    const Piece piece = SplitIntoPieces(PatchId(0), shape).front();
    const Rect r = RandomRect(random);
    const BernsteinNet net = SubNet(piece.net, r.u0, r.u1, r.v0, r.v1);
    std::array<Vec3, kMaxNetPoints> hull;
    const int count = HullPoints({net.degree_u, net.degree_v}, net.points.data(), hull.data());
    const LeafModel m =
        internal::MakeLeafModel(piece, net.points.data(), {hull.data(), hull.data() + count}, r);
    ASSERT_LT(m.gram_uu, 1e30);  // no corner without a model
    const Vec3 c = m.s + random.Point(-4, 4);
    const LowerModel low = BoundBelow(m, c);
    const auto f = [&](double x, double y) {
      const Vec3 p = Position(piece, r.u0 + (0.5 + x) * (r.u1 - r.u0), r.v0 + (0.5 + y) * (r.v1 - r.v0));
      return 0.5 * internal::ToRay(p, c).squaredNorm();
    };
    const auto local = [&] { return random.Uniform(-0.5, 0.5); };
    for (int k = 0; k < 6; ++k) {
      const double x0 = local(), y0 = local(), x1 = local(), y1 = local(), t = random.Unit();
      if (low.minorant) {
        ++minorants;
        ASSERT_LE(low.f0 + low.q(x0, y0), f(x0, y0) + 1e-10);
      }
      if (low.convex) {
        ++convex;
        corners += (r.u0 == 0.0 || r.u1 == 1.0) && (r.v0 == 0.0 || r.v1 == 1.0);
        ASSERT_LE(f(x0 + t * (x1 - x0), y0 + t * (y1 - y0)), (1 - t) * f(x0, y0) + t * f(x1, y1) + 1e-10);
      }
    }
  }
  // Not vacuous.
  EXPECT_GT(minorants, 1000);
  EXPECT_GT(convex, 10000);
  EXPECT_GT(corners, 500);
}

}  // namespace
}  // namespace patchmill
