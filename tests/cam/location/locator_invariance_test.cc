// h depends on the surface only: not on how it is cut, parametrised, ordered or shifted, nor on the hint.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "cam/location/locator.h"
#include "tests/support/random.h"
#include "tests/support/same_part.h"
#include "tests/support/sanitized.h"
#include "tests/support/shapes.h"
#include "tests/support/surface_of.h"

namespace patchmill {
namespace {

// Sanitizers take ten times as long.
constexpr int Queries(int usual) { return testing::kSanitized ? usual / 5 : usual; }

using testing::Random;
using testing::SurfaceOf;

// u and v exchanged, one of them reversed.
PatchModel TurnedAndShuffled(const PatchModel& bezier, std::uint64_t seed) {
  PatchModel out = testing::Reparametrised(bezier, /*swap=*/true, /*reverse_u=*/false, /*reverse_v=*/true);
  Random random(seed);
  for (std::size_t k = out.patches.size(); k > 1; --k) {
    std::swap(out.patches[k - 1], out.patches[static_cast<std::size_t>(random.Int(static_cast<int>(k)))]);
  }
  return out;
}

// Each Bezier patch cut at an uneven place.
PatchModel Cut(const PatchModel& bezier, double at) {
  PatchModel out;
  for (const Patch& patch : bezier.patches) {
    for (const Piece& piece : SplitIntoPieces(PatchId(0), patch.shape)) {
      for (const auto& [u0, u1] : {std::pair(0.0, at), std::pair(at, 1.0)}) {
        const BernsteinNet net = SubNet(piece.net, u0, u1, 0.0, 1.0);
        BezierPatch b;
        b.degree_u = net.degree_u;
        b.degree_v = net.degree_v;
        for (const Vec4& p : net.points) {
          b.points.push_back(p.head<3>() / p.w());
          if (net.rational) b.weights.push_back(p.w());
        }
        out.patches.push_back({"", b});
      }
    }
  }
  return out;
}

void ExpectSameHeights(const Locator& one, const Locator& other, const Vec2& shift, double rise,
                       std::uint64_t seed) {
  Random random(seed);
  const Box3& box = one.surface().box;
  int both = 0;
  for (int i = 0; i < Queries(1500); ++i) {
    const Vec2 q(random.Uniform(box.min.x() - 2, box.max.x() + 2),
                 random.Uniform(box.min.y() - 2, box.max.y() + 2));
    const auto a = one.Height(q), b = other.Height(q + shift);
    ASSERT_EQ(a.has_value(), b.has_value()) << q.transpose();
    if (!a) continue;
    ++both;
    ASSERT_NEAR(a->z + rise, b->z, 1e-9) << q.transpose();
  }
  EXPECT_GT(both, Queries(500));
}

std::vector<PatchModel> Models() {
  testing::RandomBsplineParams folded;
  folded.folds = true;
  folded.rational = true;
  return {testing::RandomBspline(1), testing::RandomBspline(2, folded), testing::Torus(Vec3(0, 0, 0), 12, 4),
          testing::TwoPlanes(Radians(30), 12)};
}

TEST(Invariance, LayoutOrderAndParametrisation) {
  for (const PatchModel& model : Models()) {
    const PatchModel bezier = testing::AsBezierPatches(model);
    const Surface surface = SurfaceOf(model);
    const Locator locator(surface, 2.5);
    for (const PatchModel& variant : {bezier, TurnedAndShuffled(bezier, 5), Cut(bezier, 0.37)}) {
      const Surface other = SurfaceOf(variant);
      ExpectSameHeights(locator, Locator(other, 2.5), Vec2::Zero(), 0.0, 3);
    }
  }
}

// Questions about moves walk the surface's own leaves; their size must not be seen.
TEST(Invariance, CoarserAndFinerLeaves) {
  constexpr double kRadius = 2.5, kEps = 1e-4;
  for (const PatchModel& model : Models()) {
    const Surface surface = SurfaceOf(model);
    const Locator locator(surface, kRadius);
    for (const double thickness : {0.2, 0.002}) {
      SurfaceParams params;
      params.leaf_thickness = thickness;
      const Surface other_surface = SurfaceOf(model, params);
      const bool flat = surface.leaves.size() == surface.network.model.patches.size();
      ASSERT_NE(flat, other_surface.leaves.size() != surface.leaves.size());
      const Locator other(other_surface, kRadius);
      Random random(4);
      const Box3& box = surface.box;
      int gouges = 0;
      for (int i = 0; i < Queries(150); ++i) {
        const Vec2 p(random.Uniform(box.min.x(), box.max.x()), random.Uniform(box.min.y(), box.max.y()));
        const Vec2 q = p + Vec2(random.Uniform(-1, 1), random.Uniform(-1, 1));
        const auto a = locator.Height(p), b = locator.Height(q);
        if (!a || !b) continue;
        const Vec3 from = Lift(p, a->z - random.Uniform(0, 0.1)), to = Lift(q, b->z);
        const double gouge = locator.SweptGouge(from, to, kEps);
        gouges += gouge > 0.01;
        ASSERT_NEAR(gouge, other.SweptGouge(from, to, kEps), kEps);
        if (i % 4 != 0) continue;
        ASSERT_NEAR(locator.MaxHeight(p, q, 0.3, 0.002), other.MaxHeight(p, q, 0.3, 0.002), 0.002);
      }
      EXPECT_GT(gouges, Queries(50));
    }
  }
}

TEST(Invariance, TranslationAndRotationAboutZ) {
  for (const PatchModel& model : Models()) {
    const Surface surface = SurfaceOf(model);
    const Locator locator(surface, 2.5);
    const Vec3 shift(137.25, -41.5, 12.75);
    const Surface moved =
        SurfaceOf(testing::Transformed(model, Eigen::Affine3d(Eigen::Translation3d(shift))));
    ExpectSameHeights(locator, Locator(moved, 2.5), Xy(shift), shift.z(), 6);

    const double angle = 0.7;
    const Surface turned =
        SurfaceOf(testing::Transformed(model, Eigen::Affine3d(Eigen::AngleAxisd(angle, Vec3::UnitZ()))));
    const Locator other(turned, 2.5);
    const Eigen::Rotation2Dd rotation(angle);
    Random random(9);
    const Box3& box = surface.box;
    for (int i = 0; i < Queries(800); ++i) {
      const Vec2 q(random.Uniform(box.min.x(), box.max.x()), random.Uniform(box.min.y(), box.max.y()));
      const auto a = locator.Height(q), b = other.Height(rotation * q);
      ASSERT_EQ(a.has_value(), b.has_value());
      if (a) {
        ASSERT_NEAR(a->z, b->z, 1e-9);
      }
    }
  }
}

TEST(Invariance, AnyHintGivesTheSameValue) {
  for (const PatchModel& model : Models()) {
    const Surface surface = SurfaceOf(model);
    const Locator locator(surface, 2.5);
    Random random(12);
    const Box3& box = surface.box;
    for (int i = 0; i < Queries(1500); ++i) {
      const Vec2 q(random.Uniform(box.min.x() - 2, box.max.x() + 2),
                   random.Uniform(box.min.y() - 2, box.max.y() + 2));
      const auto plain = locator.Height(q);
      SurfacePoint hint;
      hint.piece = PieceId(static_cast<std::size_t>(random.Int(static_cast<int>(surface.pieces.size()))));
      hint.u = random.Unit();
      hint.v = random.Unit();
      hint.p = Lift(q, 0.0);  // pretends to be near, so that it is used
      const auto hinted = locator.Height(q, &hint);
      ASSERT_EQ(plain.has_value(), hinted.has_value());
      if (!plain) continue;
      ASSERT_NEAR(plain->z, hinted->z, 1e-9);
      const auto again = locator.Height(q, &plain->contact);
      ASSERT_NEAR(plain->z, again->z, 1e-9);
      // The same call gives the same bits.
      ASSERT_EQ(locator.Height(q, &hint)->z, hinted->z);
    }
  }
}

TEST(Invariance, LargerBallsRideHigher) {
  for (const PatchModel& model : Models()) {
    const Surface surface = SurfaceOf(model);
    const double r1 = 1.5, r2 = 2.5;
    const Locator small(surface, r1), large(surface, r2);
    Random random(13);
    const Box3& box = surface.box;
    for (int i = 0; i < Queries(1500); ++i) {
      const Vec2 q(random.Uniform(box.min.x(), box.max.x()), random.Uniform(box.min.y(), box.max.y()));
      const auto a = small.Height(q), b = large.Height(q);
      if (!a) continue;
      ASSERT_TRUE(b.has_value());
      // Centres and tips both: R - sqrt(R^2 - d^2) falls with R.
      ASSERT_GE(b->z, a->z - 1e-9);
      ASSERT_GE(b->z - r2, a->z - r1 - 1e-9);
    }
  }
}

TEST(Invariance, FreeIsTheSignOfHeight) {
  for (const PatchModel& model : Models()) {
    const Surface surface = SurfaceOf(model);
    const Locator locator(surface, 2.5);
    Random random(14);
    const Box3& box = surface.box;
    int free = 0, blocked = 0;
    for (int i = 0; i < Queries(4000); ++i) {
      const Vec2 q(random.Uniform(box.min.x() - 3, box.max.x() + 3),
                   random.Uniform(box.min.y() - 3, box.max.y() + 3));
      const auto h = locator.Height(q);
      const double near = h ? h->z : 0.0;
      const double offset = std::pow(10.0, random.Uniform(-8.0, 1.0)) * (i % 2 == 0 ? 1 : -1);
      const bool got = locator.Free(Lift(q, near + offset));
      ASSERT_EQ(got, !h || offset > 0) << q.transpose() << " offset " << offset;
      (got ? free : blocked)++;
      if (h && offset < 0) {
        ASSERT_TRUE(locator.Free(Lift(q, near + offset), -offset + 1e-9));
      }
    }
    EXPECT_GT(free, Queries(1000));
    EXPECT_GT(blocked, Queries(1000));
  }
}

}  // namespace
}  // namespace patchmill
