// The bounds every proof rests on: the lower model really is below, on random parts of random patches.
#include "cam/location/leaf_model.h"

#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "cam/location/ray_distance.h"
#include "tests/support/random.h"
#include "tests/support/shapes.h"

namespace patchmill {
namespace {

using internal::BoundBelow;
using internal::LeafModel;
using internal::LowerModel;
using internal::MakeLeafModel;
using internal::Rect;
using testing::Random;

std::vector<Piece> SomePieces() {
  std::vector<PatchShape> shapes;
  for (std::uint64_t seed = 0; seed < 3; ++seed) {
    testing::RandomBsplineParams params;
    params.spans = 3;
    params.size = 12.0;
    for (const bool rational : {false, true}) {
      params.rational = rational;
      params.folds = rational;
      shapes.push_back(testing::RandomBspline(seed, params).patches[0].shape);
    }
    shapes.push_back(testing::RandomGregory(seed, GregoryPatch::Blend::kCorner, 8.0));
    shapes.push_back(testing::RandomGregory(seed, GregoryPatch::Blend::kEdge, 8.0));
    for (int degree = 1; degree <= 5; ++degree) {
      shapes.push_back(testing::RandomTriangle(seed, degree, seed % 2 == 0, 8.0));
    }
  }
  for (const Patch& patch : testing::Sphere(Vec3(1, 2, 3), 5.0).patches) shapes.push_back(patch.shape);
  for (const Patch& patch : testing::Torus(Vec3(1, 2, 3), 8.0, 3.0).patches) shapes.push_back(patch.shape);
  shapes.push_back(testing::Bilinear({0, 0, 0}, {5, 0, 1}, {0, 6, 2}, {7, 8, -1}));
  std::vector<Piece> pieces;
  for (const PatchShape& shape : shapes) {
    for (Piece& piece : SplitIntoPieces(PatchId(0), shape)) pieces.push_back(std::move(piece));
  }
  return pieces;
}

struct Part {
  LeafModel model;
  Rect rect;
  RectBounds bounds;
};

Part RandomPart(const Piece& piece, Random& random) {
  const double size = std::exp2(-random.Int(6));
  Part part;
  part.rect.u0 = random.Uniform(0.0, 1.0 - size);
  part.rect.u1 = part.rect.u0 + size;
  part.rect.v0 = random.Uniform(0.0, 1.0 - size);
  part.rect.v1 = part.rect.v0 + size;
  const Rect& r = part.rect;
  const BernsteinNet net = SubNet(piece.net, r.u0, r.u1, r.v0, r.v1);
  const NetShape shape{net.degree_u, net.degree_v};
  std::array<Vec3, kMaxNetPoints> hull;
  const int count = HullPoints(shape, net.points.data(), hull.data());
  part.model = MakeLeafModel(shape, net.points.data(), net.rational, hull.data(), count,
                             Evaluate(piece, 0.5 * (r.u0 + r.u1), 0.5 * (r.v0 + r.v1)), r);
  part.bounds = BoundNet(net);
  return part;
}

TEST(LeafModel, LowerModelIsBelowAndConvexMeansConvex) {
  const std::vector<Piece> pieces = SomePieces();
  Random random(7);
  int minorants = 0, convex = 0, above = 0;
  for (int i = 0; i < 60000; ++i) {
    const Piece& piece = pieces[static_cast<std::size_t>(random.Int(static_cast<int>(pieces.size())))];
    const Part part = RandomPart(piece, random);
    const Rect& r = part.rect;
    const Vec3 c = part.model.s + random.Point(-4, 4);
    const LowerModel low = BoundBelow(part.model, c);
    const auto f = [&](double x, double y) {
      const Vec3 p = Position(piece, r.u0 + (0.5 + x) * (r.u1 - r.u0), r.v0 + (0.5 + y) * (r.v1 - r.v0));
      return 0.5 * internal::ToRay(p, c).squaredNorm();
    };
    const auto local = [&] { return random.Uniform(-0.5, 0.5); };
    if (low.minorant && std::isfinite(low.q.a)) {
      ++minorants;
      for (int k = 0; k < 6; ++k) {
        const double x = local(), y = local();
        ASSERT_LE(low.f0 + low.q(x, y), f(x, y) + 1e-10);
      }
    }
    if (low.convex) {
      ++convex;
      above += !low.minorant;
      for (int k = 0; k < 6; ++k) {
        const double x0 = local(), y0 = local(), x1 = local(), y1 = local(), t = random.Unit();
        ASSERT_LE(f(x0 + t * (x1 - x0), y0 + t * (y1 - y0)), (1 - t) * f(x0, y0) + t * f(x1, y1) + 1e-10);
      }
    }
  }
  // Not vacuous.
  EXPECT_GT(minorants, 1000);
  EXPECT_GT(convex, 10000);
  EXPECT_GT(above, 1000);
}

TEST(LeafModel, SmallPartsOfSmoothPatchesAreProvenConvexUnderARestingBall) {
  // On a convex surface the distance to a centre resting on it is convex: the bounds must see it.
  for (const Patch& patch : testing::Sphere(Vec3(0, 0, 0), 10.0, testing::Half::kUpper).patches) {
    for (const Piece& piece : SplitIntoPieces(PatchId(0), patch.shape)) {
      const Rect r{0.5, 0.5625, 0.5, 0.5625};
      const BernsteinNet net = SubNet(piece.net, r.u0, r.u1, r.v0, r.v1);
      const NetShape shape{net.degree_u, net.degree_v};
      std::array<Vec3, kMaxNetPoints> hull;
      const int count = HullPoints(shape, net.points.data(), hull.data());
      const LeafModel m = MakeLeafModel(shape, net.points.data(), net.rational, hull.data(), count,
                                        Evaluate(piece, 0.53125, 0.53125), r);
      EXPECT_TRUE(BoundBelow(m, 1.3 * m.s).convex);
    }
  }
}

TEST(RayDistance, BoxesSaidToBeOutsideAre) {
  Random random(11);
  int outside = 0;
  for (int i = 0; i < 30000; ++i) {
    const Vec3 center = random.Point(-3, 3), half = random.Point(0.0, 2.0), c = random.Point(-6, 6);
    const Eigen::Matrix3d axis = Eigen::Quaterniond(random.Uniform(-1, 1), random.Uniform(-1, 1),
                                                    random.Uniform(-1, 1), random.Uniform(-1, 1))
                                     .normalized()
                                     .toRotationMatrix();
    const double limit = random.Uniform(0.1, 4.0);
    const bool out = internal::OrientedBoxOutside(center, axis, half, c, limit * limit);
    outside += out;
    Box3 box;
    for (int k = 0; k < 40; ++k) {
      const Vec3 p = center + axis * half.cwiseProduct(random.Point(-1, 1));
      if (out) {
        ASSERT_GE(internal::ToRay(p, c).norm(), limit - 1e-12);
      }
      box.Add(p);
    }
    if (internal::BoxOutside(box, c, limit * limit)) {
      const Vec3 p = box.min + (box.max - box.min).cwiseProduct(random.Point(0, 1));
      ASSERT_GE(internal::ToRay(p, c).norm(), limit - 1e-12);
    }
  }
  EXPECT_GT(outside, 3000);
}

}  // namespace
}  // namespace patchmill
