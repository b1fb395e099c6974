#include "core/surface/distance_form.h"

#include <gtest/gtest.h>

#include "tests/support/random.h"
#include "tests/support/shapes.h"

namespace patchmill {
namespace {

using testing::Random;

// Homogeneous point of a net by de Casteljau: the part of the net that has shrunk to (u,v).
Vec4 PointOf(const BernsteinNet& net, double u, double v) { return SubNet(net, u, u, v, v).points.front(); }

BernsteinNet RandomNet(std::uint64_t seed, int degree_u, int degree_v, bool rational) {
  const PatchShape shape = testing::RandomBezier(seed, degree_u, degree_v, rational);
  BernsteinNet net = SplitIntoPieces(PatchId(0), shape).front().net;
  for (Vec4& p : net.points) p.head<3>() -= p.w() * Vec3(8, 9, 3);  // centre of the ball
  return net;
}

TEST(DistanceForm, IsTheSquaredDistanceOfEveryDegree) {
  Random random(1);
  for (const auto& [m, n] :
       {std::pair(1, 1), std::pair(2, 5), std::pair(3, 3), std::pair(7, 7), std::pair(15, 15)}) {
    for (const bool rational : {false, true}) {
      const BernsteinNet net = RandomNet(7, m, n, rational);
      for (const bool horizontal : {false, true}) {
        const double radius = 3.0;
        DistanceForm form;
        MakeDistanceForm({m, n}, net.points.data(), rational, horizontal, radius, form);
        for (int i = 0; i < 20; ++i) {
          const double u = random.Unit(), v = random.Unit();
          const Vec4 p = PointOf(net, u, v);
          const double height = horizontal ? 0.0 : p.z() * p.z();
          const double q = p.x() * p.x() + p.y() * p.y() + height - radius * radius * p.w() * p.w();
          const FormJet jet = Evaluate(form, u, v);
          EXPECT_NEAR(jet.f, q, 1e-10);
          EXPECT_GE(jet.f, SmallestCoefficient(form).value - 1e-10);
          const double h = 1e-4, slack = 1e-3 * (1.0 + jet.gradient.norm());
          if (u < h || v < h || u > 1.0 - h || v > 1.0 - h) continue;
          EXPECT_NEAR(jet.gradient.x(), (Evaluate(form, u + h, v).f - Evaluate(form, u - h, v).f) / (2 * h),
                      slack);
          EXPECT_NEAR(jet.gradient.y(), (Evaluate(form, u, v + h).f - Evaluate(form, u, v - h).f) / (2 * h),
                      slack);
          const Vec2 along_u =
              (Evaluate(form, u + h, v).gradient - Evaluate(form, u - h, v).gradient) / (2 * h);
          const Vec2 along_v =
              (Evaluate(form, u, v + h).gradient - Evaluate(form, u, v - h).gradient) / (2 * h);
          const double loose = 1e-3 * (1.0 + along_u.norm() + along_v.norm());
          EXPECT_NEAR(jet.hessian.uu, along_u.x(), loose);
          EXPECT_NEAR(jet.hessian.uv, along_u.y(), loose);
          EXPECT_NEAR(jet.hessian.vv, along_v.y(), loose);
        }
      }
    }
  }
}

TEST(DistanceForm, IsConstantOnASphereAroundTheCentre) {
  const PatchModel sphere = testing::Sphere(Vec3::Zero(), 10.0);
  for (const Patch& patch : sphere.patches) {
    const BernsteinNet net = SplitIntoPieces(PatchId(0), patch.shape).front().net;
    DistanceForm form;
    MakeDistanceForm({net.degree_u, net.degree_v}, net.points.data(), true, false, 10.0, form);
    for (int i = 0; i < form.count(); ++i) EXPECT_NEAR(form.c[static_cast<std::size_t>(i)], 0.0, 1e-12);
  }
}

TEST(DistanceForm, ConvexityIsProvenOnlyWhereItHolds) {
  Random random(2);
  int proven = 0;
  for (int i = 0; i < 400; ++i) {
    BernsteinNet net = RandomNet(static_cast<std::uint64_t>(i), 3, 3, i % 2 == 0);
    const double size = std::pow(0.5, random.Int(5)), u0 = (1 - size) * random.Unit(),
                 v0 = (1 - size) * random.Unit();
    net = SubNet(net, u0, u0 + size, v0, v0 + size);
    DistanceForm form;
    MakeDistanceForm({3, 3}, net.points.data(), net.rational, false, 2.0, form);
    if (!BoundSecondDerivatives(form).convex) continue;
    ++proven;
    for (int k = 0; k <= 10; ++k) {
      for (int l = 0; l <= 10; ++l) {
        const Sym2 h = Evaluate(form, k / 10.0, l / 10.0).hessian;
        EXPECT_GT(h.uu, 0.0);
        EXPECT_GT(h.uu * h.vv, h.uv * h.uv);
      }
    }
    // The verdict: no sample is negative where it says so, and what it names is negative.
    const ConvexVerdict verdict = DecideConvex(form, SmallestCoefficient(form).place);
    if (verdict.negative_at) {
      EXPECT_LT(Evaluate(form, verdict.negative_at->x(), verdict.negative_at->y()).f, 0.0);
    }
    for (int k = 0; verdict.nonnegative && k <= 100; ++k) {
      EXPECT_GE(Evaluate(form, random.Unit(), random.Unit()).f, -1e-9);
    }
    EXPECT_TRUE(verdict.nonnegative || verdict.negative_at);
  }
  EXPECT_GT(proven, 50);
  EXPECT_LT(proven, 390);
}

TEST(MinimizeInBox, NothingOnAGridIsLower) {
  Random random(3);
  for (int i = 0; i < 500; ++i) {
    const Vec2 g(random.Uniform(-2, 2), random.Uniform(-2, 2));
    const Sym2 h{random.Uniform(-2, 4), random.Uniform(-2, 2), random.Uniform(-2, 4)};
    const Vec2 low(-random.Unit(), -random.Unit()), high(random.Unit(), random.Unit());
    const auto value = [&](const Vec2& d) {
      return g.dot(d) + 0.5 * (h.uu * d.x() * d.x() + h.vv * d.y() * d.y()) + h.uv * d.x() * d.y();
    };
    const Vec2 best = MinimizeInBox(g, h, low, high);
    EXPECT_TRUE((best.array() >= low.array()).all() && (best.array() <= high.array()).all());
    for (int k = 0; k <= 30; ++k) {
      for (int l = 0; l <= 30; ++l) {
        const Vec2 d(low.x() + (high.x() - low.x()) * k / 30.0, low.y() + (high.y() - low.y()) * l / 30.0);
        EXPECT_LE(value(best), value(d) + 1e-12);
      }
    }
  }
}

}  // namespace
}  // namespace patchmill
