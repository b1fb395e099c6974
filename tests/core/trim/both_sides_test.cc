// Random closed curves on every kind of surface, with both sides kept: together they are the surface again.
#include <cmath>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "core/base/status.h"
#include "core/trim/trim_model.h"
#include "tests/support/brep_parts.h"
#include "tests/support/fuzz.h"

namespace patchmill {
namespace {

using namespace testing;  // NOLINT: the support folder's

struct Kind {
  std::string name;
  BrepSurface surface;
  std::function<Vec3(const Vec2&)> at;
  Vec2 low, high;  // parameters of the outer border
};

BsplinePatch Sheet() {
  BsplinePatch sheet;
  sheet.degree_u = 3;
  sheet.degree_v = 2;
  sheet.knots_u = {0, 0, 0, 0, 0.4, 1, 1, 1, 1};
  sheet.knots_v = {0, 0, 0, 0.3, 0.7, 1, 1, 1};
  std::mt19937 random(11);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  for (int i = 0; i < 5; ++i) {
    for (int j = 0; j < 5; ++j) {
      sheet.points.push_back({15.0 * i, 14.0 * j, 10.0 * unit(random)});
      sheet.weights.push_back(0.7 + 0.6 * unit(random));
    }
  }
  return sheet;
}

std::vector<Kind> Kinds() {
  const BrepFrame f = TiltedFrame();
  const auto ring = [f](double u, double r, double h) {
    return Vec3(f.origin + r * (std::cos(u) * f.x + std::sin(u) * f.y) + h * f.z);
  };
  const double a = 0.5;
  const PatchShape sheet = Sheet();
  return {
      {"plane",
       BrepPlane{f},
       [f](const Vec2& p) { return Vec3(f.origin + p.x() * f.x + p.y() * f.y); },
       {0, 0},
       {40, 30}},
      {"cylinder",
       BrepCylinder{f, 12},
       [=](const Vec2& p) { return ring(p.x(), 12, p.y()); },
       {0.2, 0},
       {3.9, 25}},
      {"cone",
       BrepCone{f, 9, a},
       [=](const Vec2& p) { return ring(p.x(), 9 + p.y() * std::sin(a), p.y() * std::cos(a)); },
       {-0.7, 0},
       {2.9, 18}},
      {"sphere",
       BrepSphere{f, 15},
       [=](const Vec2& p) { return ring(p.x(), 15 * std::cos(p.y()), 15 * std::sin(p.y())); },
       {0.3, -0.8},
       {3.3, 1.1}},
      {"torus",
       BrepTorus{f, 20, 6},
       [=](const Vec2& p) { return ring(p.x(), 20 + 6 * std::cos(p.y()), 6 * std::sin(p.y())); },
       {0.1, 0.4},
       {2.2, 4.1}},
      {"spline",
       BrepSpline{Sheet()},
       [sheet](const Vec2& p) { return Position(sheet, p.x(), p.y()); },
       {0, 0},
       {1, 1}},
  };
}

// The image of a way in the parameters, in pieces short enough to be followed to about 1e-9 mm.
void AddWay(PartMaker& maker, const Kind& kind, const std::function<Vec2(double)>& way, int pieces,
            BrepLoop& loop) {
  for (int k = 0; k < pieces; ++k) {
    const auto part = [=](double t) { return way((k + t) / pieces); };
    const int edge = maker.Edge(PolynomialCurve(12, [&](double t) { return kind.at(part(t)); }));
    loop.push_back(UseOf(edge, true, 0, 1, part));
  }
}

BrepLoop Reversed(const BrepLoop& loop) {
  BrepLoop back(loop.rbegin(), loop.rend());
  for (BrepEdgeUse& use : back) use.forward = !use.forward;
  return back;
}

TEST(BothSides, AreTheSurfaceAgain) {
  // Ten thousand loops in all in the long tests (scripts/long_tests.sh random).
  const int rounds = FromEnvironment("PATCHMILL_FUZZ_JOBS", 25);
  const auto seed = static_cast<unsigned>(FromEnvironment("PATCHMILL_FUZZ_SEED", 0));
  for (const Kind& kind : Kinds()) {
    for (int round = 0; round < rounds; ++round) {
      SCOPED_TRACE(kind.name + " " + std::to_string(round));
      std::mt19937 random(seed + 1000U * static_cast<unsigned>(round) + 7U);
      std::uniform_real_distribution<double> unit(0.0, 1.0);
      PartMaker maker;
      BrepLoop border;
      const Vec2 corner[5] = {
          kind.low, {kind.high.x(), kind.low.y()}, kind.high, {kind.low.x(), kind.high.y()}, kind.low};
      for (int k = 0; k < 4; ++k) {
        // Splines have knots along the border; pieces end at them.
        const std::vector<double> knots = kind.name != "spline" ? std::vector<double>{0, 0.25, 0.5, 0.75, 1}
                                          : k % 2 == 0          ? std::vector<double>{0, 0.4, 1}
                                                                : std::vector<double>{0, 0.3, 0.7, 1};
        for (std::size_t i = 0; i + 1 < knots.size(); ++i) {
          const bool back = k >= 2;
          const double t0 = back ? 1 - knots[knots.size() - 1 - i] : knots[i];
          const double t1 = back ? 1 - knots[knots.size() - 2 - i] : knots[i + 1];
          const Vec2 a = corner[k] + t0 * (corner[k + 1] - corner[k]),
                     b = corner[k] + t1 * (corner[k + 1] - corner[k]);
          AddWay(
              maker, kind, [=](double t) { return Vec2(a + t * (b - a)); }, 1, border);
        }
      }
      // A smooth closed curve around a random place, now a circle, now with lobes.
      const Vec2 size = kind.high - kind.low;
      const Vec2 middle =
          kind.low + Vec2(0.35 + 0.3 * unit(random), 0.35 + 0.3 * unit(random)).cwiseProduct(size);
      const double radius = 0.04 + 0.2 * unit(random), lobe = 0.4 * unit(random),
                   turn = 2 * kPi * unit(random);
      const int lobes = static_cast<int>(unit(random) * 5);
      const auto around = [=](double t) {
        const double phi = turn + 2 * kPi * t, rho = radius * (1 + lobe * std::cos(lobes * phi));
        return Vec2(middle + rho * Vec2(std::cos(phi), std::sin(phi)).cwiseProduct(size));
      };
      BrepLoop loop;
      AddWay(maker, kind, around, kind.name == "spline" ? 48 : 24, loop);
      maker.Face(kind.surface, {border});
      maker.Face(kind.surface, {border, Reversed(loop)});
      maker.Face(kind.surface, {loop});
      const auto trimmed = TrimFaces(maker.part(), {}, RunContext());
      ASSERT_TRUE(trimmed.ok()) << trimmed.status();
      for (const Diagnostic& finding : trimmed->findings) {
        EXPECT_EQ(finding.severity == Severity::kError, false) << finding.code << " " << finding.message;
      }
      const double whole = trimmed->faces[0].area, outside = trimmed->faces[1].area,
                   inside = trimmed->faces[2].area;
      // Both sides follow the loop with the same graphs. On one side a graph may be turned within half of the
      // border tolerance, now to the left and now to the right of the other: 200 mm of border, 1e-6 mm in the
      // mean.
      EXPECT_NEAR(outside + inside, whole, 200.0 * 1e-6);
      EXPECT_GT(inside, 0.0);
      EXPECT_LE(trimmed->border_error, 1e-4);
    }
  }
}

}  // namespace
}  // namespace patchmill
