// Kinds with singular corners: first derivatives right up to them, finite second ones with the limits along
// the edges, hulls that hold and shrink.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "core/patch/piece.h"
#include "tests/support/random.h"
#include "tests/support/shapes.h"

namespace patchmill {
namespace {

using testing::Random;

std::vector<Vec2> Corners(const PatchShape& shape) {
  std::vector<Vec2> corners = {Vec2(0, 0), Vec2(1, 0), Vec2(0, 1)};
  if (!IsTriangle(shape)) corners.push_back(Vec2(1, 1));
  return corners;
}
// Directions into the patch at a corner: the two edges and between them.
std::vector<Vec2> Inward(const PatchShape& shape, const Vec2& corner) {
  Vec2 a(corner.x() == 0 ? 1 : -1, 0), b(0, corner.y() == 0 ? 1 : -1);
  if (IsTriangle(shape) && corner.x() == 1) a = Vec2(-1, 1), b = Vec2(-1, 0);
  if (IsTriangle(shape) && corner.y() == 1) a = Vec2(0, -1), b = Vec2(1, -1);
  return {a, b, 0.5 * (a + b), 0.9 * a + 0.1 * b};
}

TEST(BlendedCorners, AreC1AndFinite) {
  for (const PatchShape& shape : testing::SingularKinds(1.0)) {
    for (const Vec2& corner : Corners(shape)) {
      const SurfaceJet limit = Evaluate(shape, corner.x(), corner.y());
      for (const double r : {1e-3, 1e-6, 1e-9, 1e-15, 1e-300}) {
        for (const Vec2& d : Inward(shape, corner)) {
          const Vec2 at = corner + r * d;
          const SurfaceJet s = Evaluate(shape, at.x(), at.y());
          EXPECT_LE((s.p - limit.p).norm(), 1e-14 + 100 * r) << shape.index();
          EXPECT_LE((s.du - limit.du).norm(), 1e-12 + 2000 * r) << shape.index();
          EXPECT_LE((s.dv - limit.dv).norm(), 1e-12 + 2000 * r) << shape.index();
          EXPECT_TRUE(s.duu.allFinite() && s.duv.allFinite() && s.dvv.allFinite());
        }
      }
    }
  }
}

// Along an edge the second derivative of the surface is that of the edge curve, right into the corner: just
// outside the radius of fixed values and inside it they agree.
TEST(BlendedCorners, PureSecondDerivativesAreTheEdgeCurves) {
  for (const PatchShape& shape : testing::SingularKinds(1.0)) {
    for (const Vec2& corner : Corners(shape)) {
      const auto inward = Inward(shape, corner);
      for (const Vec2& d : {inward[0], inward[1]}) {
        const auto along = [&](double r) -> Vec3 {
          const Vec2 at = corner + r * d;
          const SurfaceJet s = Evaluate(shape, at.x(), at.y());
          return d.x() * d.x() * s.duu + 2 * d.x() * d.y() * s.duv + d.y() * d.y() * s.dvv;
        };
        EXPECT_LE((along(0) - along(2e-6)).norm(), 0.01) << shape.index();
        EXPECT_LE((along(1e-7) - along(2e-6)).norm(), 0.01) << shape.index();
      }
    }
  }
}

// The mixed one is the mean of its two limits along the edges: for cubic data the two twists.
TEST(BlendedCorners, MixedSecondDerivativeIsTheMeanOfBothEdges) {
  for (const PatchShape& shape : testing::SingularKinds(1.0)) {
    for (const Vec2& corner : Corners(shape)) {
      const auto inward = Inward(shape, corner);
      const Vec2 &a = inward[0], &b = inward[1];
      const auto mixed = [&](const Vec2& at) -> Vec3 {
        const SurfaceJet s = Evaluate(shape, at.x(), at.y());
        return a.x() * b.x() * s.duu + (a.x() * b.y() + a.y() * b.x()) * s.duv + a.y() * b.y() * s.dvv;
      };
      const Vec3 mean = 0.5 * (mixed(corner + 2e-6 * a) + mixed(corner + 2e-6 * b));
      EXPECT_LE((mixed(corner) - mean).norm(), 0.01) << shape.index();
    }
  }
}

// Weights are positive or the point is zero altogether; every part's box holds its part of the surface; parts
// that touch a corner shrink to it.
TEST(BlendedNets, HullsHoldDownToTheCorners) {
  Random random(7);
  for (const PatchShape& shape : testing::SingularKinds()) {
    for (const Piece& piece : SplitIntoPieces(PatchId(0), shape)) {
      for (int corner = 0; corner < 4; ++corner) {
        double previous = 0;
        for (int depth = 0; depth <= 30; depth += 2) {
          const double size = std::ldexp(1.0, -depth);
          const double u0 = corner % 2 ? 1 - size : 0, v0 = corner / 2 ? 1 - size : 0;
          const BernsteinNet sub = SubNet(piece.net, u0, u0 + size, v0, v0 + size);
          Box3 box;
          for (const Vec4& p : sub.points) {
            if (p.w() == 0.0) {
              ASSERT_EQ(p, Vec4(Vec4::Zero())) << shape.index();
            } else {
              ASSERT_GT(p.w(), 0.0) << shape.index();
              box.Add(Vec3(p.head<3>() / p.w()));
            }
          }
          for (int k = 0; k < 20; ++k) {
            const Vec3 s = Position(piece, u0 + size * random.Unit(), v0 + size * random.Unit());
            const double slack = 1e-12 * 20;
            EXPECT_TRUE((s.array() >= box.min.array() - slack).all() &&
                        (s.array() <= box.max.array() + slack).all())
                << shape.index() << " depth " << depth;
          }
          if (depth >= 8 && depth <= 24) {
            EXPECT_NEAR(box.Diagonal() / previous, 0.25, 0.05) << shape.index() << " depth " << depth;
          }
          previous = box.Diagonal();
        }
      }
    }
  }
}

}  // namespace
}  // namespace patchmill
