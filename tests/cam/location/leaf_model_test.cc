// The bounds every proof rests on: the lower model really is below, on random parts of random patches.
#include "cam/location/leaf_model.h"

#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "cam/location/local_search.h"
#include "cam/location/ray_distance.h"
#include "cam/location/search_leaf.h"
#include "tests/support/random.h"
#include "tests/support/shapes.h"

namespace patchmill {
namespace {

using internal::BoundBelow;
using internal::LeafGrid;
using internal::LeafModel;
using internal::LowerModel;
using internal::MakeLeafModel;
using internal::Rect;
using internal::SearchLeaf;
using internal::UpperBound;
using testing::Random;

std::vector<PatchShape> SomeShapes() {
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
  return shapes;
}

std::vector<Piece> SomePieces() {
  static const std::vector<PatchShape> shapes = SomeShapes();  // what pieces point to
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
  std::vector<Vec3> hull;
};

Part PartOf(const Piece& piece, const Rect& r) {
  Part part;
  part.rect = r;
  const BernsteinNet net = SubNet(piece.net, r.u0, r.u1, r.v0, r.v1);
  const NetShape shape{net.degree_u, net.degree_v};
  std::array<Vec3, kMaxNetPoints> hull;
  const int count = HullPoints(shape, net.points.data(), hull.data());
  part.model = MakeLeafModel({shape, net.points.data(), net.rational, {hull.data(), hull.data() + count}},
                             Evaluate(piece, 0.5 * (r.u0 + r.u1), 0.5 * (r.v0 + r.v1)), r);
  part.bounds = BoundNet(net);
  part.hull.assign(hull.begin(), hull.begin() + count);
  return part;
}

Part RandomPart(const Piece& piece, Random& random) {
  const double size = std::exp2(-random.Int(6));
  const double u0 = random.Uniform(0.0, 1.0 - size), v0 = random.Uniform(0.0, 1.0 - size);
  return PartOf(piece, {u0, u0 + size, v0, v0 + size});
}

// As the search tree halves pieces.
Part DyadicPart(const Piece& piece, Random& random) {
  const auto side = [&](double& low, double& high) {
    const int parts = 1 << random.Int(7);
    low = static_cast<double>(random.Int(parts)) / parts;
    high = low + 1.0 / parts;
  };
  Rect r;
  side(r.u0, r.u1);
  side(r.v0, r.v1);
  return PartOf(piece, r);
}

// How often each claim was made.
struct Claims {
  int minorants = 0, convex = 0, above = 0, beside = 0, tight = 0, tight_from = 0;
};

// Whatever `model` claims about a piece's part for a centre c holds at random places of it.
void CheckClaims(const Piece& piece, const Rect& r, const LeafModel& model, const Vec3& c, Random& random,
                 Claims& claims) {
  const LowerModel low = BoundBelow(model, c);
  const auto f = [&](double x, double y) {
    const Vec3 p = Position(piece, r.u0 + (0.5 + x) * (r.u1 - r.u0), r.v0 + (0.5 + y) * (r.v1 - r.v0));
    return 0.5 * internal::ToRay(p, c).squaredNorm();
  };
  const auto local = [&] { return random.Uniform(-0.5, 0.5); };
  if (low.minorant && std::isfinite(low.q.a)) {
    ++claims.minorants;
    for (int k = 0; k < 6; ++k) {
      const double x = local(), y = local();
      ASSERT_LE(low.f0 + low.q(x, y), f(x, y) + 1e-10);
    }
  }
  const LowerModel beside = internal::BoundBelowAtDepth(model, c, std::max(0.0, random.Uniform(-1.0, 5.0)));
  const double least = internal::LeastOn(model, low, c);
  if (std::isfinite(beside.q.a)) {
    claims.beside += !low.minorant;
    for (int k = 0; k < 6; ++k) {
      const double x = local(), y = local();
      ASSERT_LE(beside.f0 + beside.q(x, y), f(x, y) + 1e-10);
      ASSERT_LE(least, f(x, y) + 1e-10);
      claims.tight += !low.minorant && least > 0.95 * f(x, y);
    }
  }
  if (std::isfinite(beside.q.a)) {
    const double x0 = local(), y0 = local();
    const double u = r.u0 + (0.5 + x0) * (r.u1 - r.u0), v = r.v0 + (0.5 + y0) * (r.v1 - r.v0);
    const SurfaceJet jet = Evaluate(piece, u, v);
    const Vec3 d = internal::ToRay(jet.p, c);
    const internal::LocalJet at = internal::LocalJetAt(r, u, v, d, Vec2(d.dot(jet.du), d.dot(jet.dv)));
    EXPECT_NEAR(at.x, x0, 1e-9);
    EXPECT_NEAR(at.f, f(x0, y0), 1e-9);
    const double from = internal::LeastFrom(model, low, c, at);
    for (int k = 0; k < 6; ++k) {
      const double x = local(), y = local();
      ASSERT_LE(from, f(x, y) + 1e-10);
      claims.tight_from += from > 0.98 * f(x, y);
    }
  }
  if (low.convex) {
    ++claims.convex;
    claims.above += !low.minorant;
    for (int k = 0; k < 6; ++k) {
      const double x0 = local(), y0 = local(), x1 = local(), y1 = local(), t = random.Unit();
      ASSERT_LE(f(x0 + t * (x1 - x0), y0 + t * (y1 - y0)), (1 - t) * f(x0, y0) + t * f(x1, y1) + 1e-10);
    }
  }
}

void ExpectNotVacuous(const Claims& claims) {
  EXPECT_GT(claims.minorants, 1000);
  EXPECT_GT(claims.convex, 5000);
  EXPECT_GT(claims.above, 1000);
  EXPECT_GT(claims.beside, 1000);
  EXPECT_GT(claims.tight, 1000);
  EXPECT_GT(claims.tight_from, 1000);
}

TEST(LeafModel, LowerModelIsBelowAndConvexMeansConvex) {
  const std::vector<Piece> pieces = SomePieces();
  Random random(7);
  Claims claims;
  for (int i = 0; i < 60000; ++i) {
    const Piece& piece = pieces[static_cast<std::size_t>(random.Int(static_cast<int>(pieces.size())))];
    const Part part = RandomPart(piece, random);
    CheckClaims(piece, part.rect, part.model, part.model.s + random.Point(-4, 4), random, claims);
    if (HasFatalFailure()) return;
  }
  ExpectNotVacuous(claims);
}

// Stored leaves of models small and large, near the origin and far from it: from fine grids of places to
// grids so coarse that every rounding shows.
TEST(SearchLeaf, ClaimsHoldAfterRounding) {
  const std::vector<Piece> pieces = SomePieces();
  Random random(13);
  Claims claims;
  for (int i = 0; i < 60000; ++i) {
    const Piece& piece = pieces[static_cast<std::size_t>(random.Int(static_cast<int>(pieces.size())))];
    const Part part = DyadicPart(piece, random);
    const double size = 10.0 * std::pow(10.0, random.Uniform(0.0, 7.0));
    const Vec3 corner = part.model.s - size * random.Point(0, 1);
    const LeafGrid grid(Box3{corner, corner + Vec3::Constant(size)});
    const SearchLeaf leaf(grid, 17, part.rect, part.model, {part.bounds.axis, part.hull});
    EXPECT_EQ(leaf.piece(), 17);
    const Rect r = leaf.rect();
    ASSERT_TRUE(r.u0 == part.rect.u0 && r.u1 == part.rect.u1 && r.v0 == part.rect.v0 && r.v1 == part.rect.v1);
    CheckClaims(piece, r, leaf.Model(grid), part.model.s + random.Point(-4, 4), random, claims);
    if (HasFatalFailure()) return;
    const internal::LeafBox box = leaf.Box(grid);
    ASSERT_LT((box.axis.transpose() * box.axis - Eigen::Matrix3d::Identity()).norm(), 1e-14);
    for (const Vec3& p : part.hull) {
      const Vec3 y = box.axis.transpose() * (p - box.center);
      ASSERT_TRUE((y.cwiseAbs().array() <= box.half.array()).all());
    }
    // Not much larger than the box before rounding.
    ASSERT_LT(box.half.norm(), 1.01 * part.bounds.half.norm() + 4.0 * grid.step);
  }
  ExpectNotVacuous(claims);
}

TEST(SearchLeaf, BoundsAreRoundedUp) {
  Random random(17);
  for (int i = 0; i < 10000; ++i) {
    const double x = std::pow(10.0, random.Uniform(-30.0, 30.0));
    const double up = UpperBound(x).value();
    ASSERT_GE(up, x);
    ASSERT_LE(up, x * (1.0 + 1.0 / 255.0));
    ASSERT_GT(UpperBound(x).Next().value(), up);
  }
  EXPECT_GT(UpperBound(0.0).value(), 0.0F);
  EXPECT_EQ(UpperBound(HUGE_VAL).value(), HUGE_VALF);
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
      const LeafModel m =
          MakeLeafModel({shape, net.points.data(), net.rational, {hull.data(), hull.data() + count}},
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
