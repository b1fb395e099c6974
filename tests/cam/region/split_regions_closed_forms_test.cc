// Regions of shapes whose borders are known in closed form: areas, borders and counts to 1e-6, nothing
// merged.
#include <cmath>

#include <gtest/gtest.h>

#include "cam/limits/reach_tolerance.h"
#include "cam/region/split_regions.h"
#include "tests/support/shapes.h"
#include "tests/support/surface_of.h"

namespace patchmill {
namespace {

using namespace testing;  // NOLINT: the support folder's

constexpr double kChord = 1e-7;  // mm, of borders

RegionParams Exact(double radius = 0.5) {
  RegionParams p;
  p.radius = radius;
  p.tolerance = 0.001;
  p.detail = 1.0;
  p.border_tolerance = kChord;
  return p;
}

RegionMap Split(const PatchModel& model, const RegionParams& params) {
  const Surface surface = SurfaceOf(model);
  auto map = SplitRegions(surface, params, RunContext());
  EXPECT_TRUE(map.ok()) << map.status();
  return *std::move(map);
}

double Area(const RegionMap& map, RegionKind kind, SlopeClass slope) {
  double sum = 0.0;
  for (const Region& r : map.regions) sum += r.kind == kind && r.slope == slope ? r.area : 0.0;
  return sum;
}
int Count(const RegionMap& map, RegionKind kind) {
  int count = 0;
  for (const Region& r : map.regions) count += r.kind == kind;
  return count;
}
void ExpectArea(double area, double truth) { EXPECT_NEAR(area, truth, 1e-6 * truth); }

double Hill(double x, double y) { return 12 * std::exp(-(x * x + y * y) / 200); }

TEST(RegionClosedForms, TorusBands) {
  // Tube angle t from the outer equator (0) over the crest (90 degrees) to the inner one: a band from t0 to
  // t1 has the area 2 pi r (R (t1 - t0) + r (sin t1 - sin t0)).
  const double major = 20, minor = 6;
  const RegionMap map = Split(Torus(Vec3::Zero(), major, minor, Half::kUpper), Exact());
  const auto band = [&](double t0, double t1) {
    return 2 * kPi * minor * (major * (t1 - t0) + minor * (std::sin(t1) - std::sin(t0)));
  };
  ASSERT_EQ(map.regions.size(), 4u);
  ExpectArea(Area(map, RegionKind::kMountain, SlopeClass::kSteep), band(0, Radians(45)));
  ExpectArea(Area(map, RegionKind::kMountain, SlopeClass::kGentle), band(Radians(45), Radians(90)));
  ExpectArea(Area(map, RegionKind::kBasin, SlopeClass::kGentle), band(Radians(90), Radians(135)));
  ExpectArea(Area(map, RegionKind::kBasin, SlopeClass::kSteep), band(Radians(135), Radians(180)));
  for (const Region& r : map.regions) {
    EXPECT_EQ(r.border.size(), 2u) << r.id.value;
    for (const auto& loop : r.border) {
      for (const Vec3& p : loop) {
        // Every border is a circle: equators, 45 degrees, crest.
        const double rho = std::hypot(p.x(), p.y()) - major, s = minor * std::sqrt(0.5);
        const double off = std::min({std::abs(p.z()), std::abs(p.z() - minor), std::abs(p.z() - s)});
        EXPECT_NEAR(std::hypot(rho, p.z()), minor, 1e-9);
        EXPECT_LT(off, 1e-6);
      }
    }
  }
}

TEST(RegionClosedForms, ParaboloidIsOneMountainWithASteepRim) {
  // z = -a (x^2 + y^2): steeper than the angle beyond the radius tan(angle) / (2 a).
  const double a = 0.05, half = 8, angle = Radians(30);
  RegionParams params = Exact();
  params.steep_angle = angle;
  const RegionMap map = Split(Paraboloid(-a, half), params);
  const double rho = std::tan(angle) / (2 * a);  // 5.77: inside the square
  const double cap = kPi / (6 * a * a) * (std::pow(1 + 4 * a * a * rho * rho, 1.5) - 1);
  EXPECT_EQ(Count(map, RegionKind::kMountain), 2);
  EXPECT_EQ(map.regions.size(), 2u);
  ExpectArea(Area(map, RegionKind::kMountain, SlopeClass::kGentle), cap);
  for (const Region& r : map.regions) {
    if (r.slope != SlopeClass::kGentle) continue;
    ASSERT_EQ(r.border.size(), 1u);
    for (const Vec3& p : r.border[0]) EXPECT_NEAR(std::hypot(p.x(), p.y()), rho, 1e-6);
  }
}

TEST(RegionClosedForms, SaddleSectorsMeetInTheNode) {
  // z = a x^2 - b y^2: borders y = +-sqrt(a/b) x, both signs of each kind, meeting at the origin.
  const double a = 0.05, b = 0.03, half = 8, k = std::sqrt(a / b);
  RegionParams params = Exact();
  params.steep_angle = Radians(85);
  const RegionMap map = Split(Saddle(a, b, half), params);
  EXPECT_EQ(Count(map, RegionKind::kMountain), 2);
  EXPECT_EQ(Count(map, RegionKind::kBasin), 2);
  EXPECT_EQ(map.regions.size(), 4u);
  // Area over |y| > k |x| by Simpson's rule in polar strips: integral over x of the y range up to `half`.
  const auto element = [&](double x, double y) {
    return std::sqrt(1 + 4 * a * a * x * x + 4 * b * b * y * y);
  };
  const auto simpson = [](double from, double to, int n, const auto& f) {
    double sum = f(from) + f(to);
    const double h = (to - from) / n;
    for (int i = 1; i < n; ++i) sum += (i % 2 == 0 ? 2.0 : 4.0) * f(from + i * h);
    return sum * h / 3.0;
  };
  const double over = 4 * simpson(0, half / k, 200, [&](double x) {
                        return simpson(k * x, half, 200, [&](double y) { return element(x, y); });
                      });
  const double all = 4 * simpson(0, half, 200, [&](double x) {
                       return simpson(0, half, 200, [&](double y) { return element(x, y); });
                     });
  // D = 8ab (b y^2 - a x^2): basins where |y| > k |x|.
  ExpectArea(Area(map, RegionKind::kBasin, SlopeClass::kGentle), over);
  ExpectArea(Area(map, RegionKind::kMountain, SlopeClass::kGentle), all - over);
  for (const Region& r : map.regions) {
    ASSERT_EQ(r.border.size(), 1u);
    bool node = false;
    for (const Vec3& p : r.border[0]) {
      const bool outer = std::max(std::abs(p.x()), std::abs(p.y())) > half - 1e-9;
      node = node || p.norm() < 1e-9;
      EXPECT_TRUE(outer || std::abs(std::abs(p.y()) - k * std::abs(p.x())) < 1e-6) << p.transpose();
    }
    EXPECT_TRUE(node) << r.id.value;
  }
}

TEST(RegionClosedForms, SaddleNodeAnywhereInThePatch) {
  // The same saddle moved off the quadtree's grid, as a part of a larger one: still four sectors.
  const double a = 0.05, b = 0.03;
  for (const Vec2& shift : {Vec2(1.3, -0.7), Vec2(2.71, 3.14)}) {
    PatchModel model = Saddle(a, b, 8);
    // z of a x^2 - b y^2 about `shift`: subtract the linear part, which a shear does.
    auto& patch = std::get<BezierPatch>(model.patches[0].shape);
    for (Vec3& p : patch.points) p.z() += -2 * a * shift.x() * p.x() + 2 * b * shift.y() * p.y();
    RegionParams params = Exact();
    params.steep_angle = Radians(85);
    const RegionMap map = Split(model, params);
    EXPECT_EQ(Count(map, RegionKind::kMountain), 2);
    EXPECT_EQ(Count(map, RegionKind::kBasin), 2);
    bool node = false;
    for (const Region& r : map.regions) {
      for (const auto& loop : r.border) {
        for (const Vec3& p : loop) node = node || (Xy(p) - shift).norm() < 1e-9;
      }
    }
    EXPECT_TRUE(node);
  }
}

TEST(RegionClosedForms, SaddleSlopeLinesCrossItsInflections) {
  // |grad|^2 = 4 a^2 x^2 + 4 b^2 y^2 = 1 along y = sqrt(a / b) x. The sheet is not symmetric, so that no
  // crossing is where a mesh would have a vertex anyway.
  const double a = 0.03, b = 0.04;
  const auto height = [&](double x, double y) { return a * x * x - b * y * y; };
  const RegionMap map = Split(Single(InterpolatedHeights(height, -15, 15, -14, 15.5, 4, 4)), Exact());
  const double x = std::sqrt(1 / (4 * a * (a + b))), y = std::sqrt(a / b) * x;
  for (const double side_x : {-1.0, 1.0}) {
    for (const double side_y : {-1.0, 1.0}) {
      const Vec3 crossing(side_x * x, side_y * y, height(x, y));
      double least = kInfinity;
      for (const Vec3& node : map.nodes) least = std::min(least, (node - crossing).norm());
      EXPECT_LT(least, 1e-9) << crossing.transpose();
    }
  }
}

TEST(RegionClosedForms, HemisphereOnAPlane) {
  const double r = 8, radius = 3, tolerance = 0.01, half = 20;
  RegionParams params = Exact(radius);
  params.tolerance = tolerance;
  const RegionMap map = Split(Join({Plane(half), Sphere(Vec3::Zero(), r, Half::kUpper)}), params);
  double total = 0, unreachable = 0;
  for (const Region& region : map.regions) {
    total += region.area;
    if (region.kind == RegionKind::kUnreachable) unreachable += region.area;
  }
  ExpectArea(total, 4 * half * half + 2 * kPi * r * r);
  // Plane: within the circle where a ball of R - g that stands R high touches the sphere. Sphere: below
  // the circle where a ball that touches it comes down to R - g.
  const double reach = radius - ReachTolerance(tolerance);
  const double disc = kPi * ((r + reach) * (r + reach) - radius * radius);
  const double band = 2 * kPi * r * r * reach / (r + radius);
  ExpectArea(unreachable, disc + band);
  const double cap = 2 * kPi * r * r * (1 - std::cos(params.steep_angle));
  ExpectArea(Area(map, RegionKind::kMountain, SlopeClass::kGentle), cap);
  ExpectArea(Area(map, RegionKind::kMountain, SlopeClass::kSteep), 2 * kPi * r * r - cap - band);
  // Plane, cap and steep band above the limit; below it the rest of the sphere, what surrounds it on the
  // plane and what it covers.
  EXPECT_EQ(Count(map, RegionKind::kNeutral), 1);
  EXPECT_EQ(Count(map, RegionKind::kMountain), 2);
  EXPECT_EQ(Count(map, RegionKind::kUnreachable), 3);
  // Limits of reach lie on these circles.
  const double limit = std::sqrt((r + reach) * (r + reach) - radius * radius);
  const double height = r * reach / (r + radius);
  for (const Region& region : map.regions) {
    if (region.kind != RegionKind::kUnreachable || region.reason != UnreachableReason::kConcave) continue;
    for (const auto& loop : region.border) {
      for (const Vec3& p : loop) {
        const double rho = std::hypot(p.x(), p.y());
        // Outer limit on the plane, upper limit on the sphere; the rest borders on UNDERCUT or is the rim.
        if (p.z() < 1e-9 && rho > r + 0.5) {
          EXPECT_NEAR(rho, limit, 1e-6);
        }
        if (p.z() > 0.5 * height) {
          EXPECT_NEAR(p.z(), height, 1e-6);
        }
      }
    }
  }
}

TEST(RegionClosedForms, GaussianHillIsOneMountain) {
  // Contours of exp(-r^2/2s^2) are circles: convex at every height, whatever the slope.
  PatchModel model = Single(InterpolatedHeights(Hill, -15, 15, -15, 15, 20, 20));
  RegionParams params = Exact();
  params.steep_angle = Radians(80);
  const RegionMap map = Split(model, params);
  EXPECT_EQ(map.regions.size(), 1u);
  EXPECT_EQ(map.regions[0].kind, RegionKind::kMountain);
}

TEST(RegionClosedForms, GaussianHillIsSteepInARing) {
  // Steeper than 30 degrees from where |dz/dr| = tan 30 first to where it is so again. Border and area of the
  // spline itself, its radii at 720 angles by halving, its slope by differences.
  const BsplinePatch spline = InterpolatedHeights(Hill, -18, 18, -18, 18, 16, 16);
  const auto height = [&](double x, double y) {
    return Position(PatchShape(spline), (x + 18) / 36, (y + 18) / 36).z();
  };
  const auto tangent = [&](double x, double y) {
    constexpr double h = 1e-4;
    return std::hypot(height(x + h, y) - height(x - h, y), height(x, y + h) - height(x, y - h)) / (2 * h);
  };
  const double steep = std::tan(Radians(30));
  const auto crossing = [&](double angle, double from, double to) {
    const bool steep_at_from = tangent(from * std::cos(angle), from * std::sin(angle)) > steep;
    for (int i = 0; i < 50; ++i) {
      const double r = 0.5 * (from + to);
      (tangent(r * std::cos(angle), r * std::sin(angle)) > steep) == steep_at_from ? from = r : to = r;
    }
    return from;
  };
  constexpr int kAngles = 720, kRadii = 120;
  double ring = 0.0;
  for (int i = 0; i < kAngles; ++i) {
    const double angle = 2 * kPi * i / kAngles, c = std::cos(angle), s = std::sin(angle);
    const double inner = crossing(angle, 0.5, 10), outer = crossing(angle, 10, 17.5);
    for (int k = 0; k <= kRadii; ++k) {
      const double r = inner + (outer - inner) * k / kRadii, t = tangent(r * c, r * s);
      const double weight = (k == 0 || k == kRadii ? 1.0 : k % 2 == 1 ? 4.0 : 2.0) / 3.0;
      ring += weight * r * std::sqrt(1 + t * t) * (outer - inner) / kRadii * 2 * kPi / kAngles;
    }
  }
  RegionParams params = Exact();
  params.steep_angle = Radians(30);
  const RegionMap map = Split(Single(spline), params);
  EXPECT_EQ(Count(map, RegionKind::kMountain), static_cast<int>(map.regions.size()));
  ASSERT_EQ(map.regions.size(), 3u);
  ExpectArea(Area(map, RegionKind::kMountain, SlopeClass::kSteep), ring);
  for (const Region& r : map.regions) {
    if (r.slope != SlopeClass::kSteep) continue;
    ASSERT_EQ(r.border.size(), 2u);
    for (const auto& loop : r.border) {
      for (std::size_t i = 0; i < loop.size(); i += 37) {
        const double t = tangent(loop[i].x(), loop[i].y());
        EXPECT_NEAR(t, steep, 1e-6) << loop[i].transpose();
      }
    }
  }
}

TEST(RegionClosedForms, WavySheet) {
  // A ruled wave z = f(y) sheared to a slope along x: level lines are graphs x = -f(y)/s, whose inflections
  // are the zeros of f''. Cubic f per patch: f'' is linear, so the border is the straight line y = 0.
  const double slope = 0.5, c = 0.004, half = 10;
  const auto height = [&](double x, double y) { return slope * x + c * y * y * y; };
  PatchModel model = Single(InterpolatedHeights(height, -half, half, -half, half, 3, 3));
  RegionParams params = Exact();
  params.steep_angle = Radians(80);
  const RegionMap map = Split(model, params);
  ASSERT_EQ(map.regions.size(), 2u);
  EXPECT_EQ(Count(map, RegionKind::kMountain), 1);
  EXPECT_EQ(Count(map, RegionKind::kBasin), 1);
  EXPECT_NEAR(map.regions[0].area, map.regions[1].area, 1e-6 * map.regions[0].area);
  for (const Region& r : map.regions) {
    ASSERT_EQ(r.border.size(), 1u);
    for (const Vec3& p : r.border[0]) {
      const bool outer = std::max(std::abs(p.x()), std::abs(p.y())) > half - 1e-9;
      EXPECT_TRUE(outer || std::abs(p.y()) < 1e-6) << p.transpose();
    }
  }
}

TEST(RegionClosedForms, SheetOfManyWaves) {
  // As above, with the uniform cubic spline of coefficients A, -A, A, ... for f: f'' is +-4 A / h^2 at its
  // knots and linear between them, so every span has a border in its middle.
  constexpr int kSpans = 6;
  const double slope = 0.5, h = 10.0, a = 3.0, width = 20.0;
  BsplinePatch sheet;
  sheet.degree_u = 1;
  sheet.degree_v = 3;
  sheet.knots_u = {0, 0, 1, 1};
  for (int k = -3; k <= kSpans + 3; ++k) sheet.knots_v.push_back(k);
  for (const double x : {0.0, width}) {
    for (int j = 0; j < kSpans + 3; ++j)
      sheet.points.emplace_back(x, (j - 1) * h, slope * x + (j % 2 == 0 ? a : -a));
  }
  RegionParams params = Exact();
  params.steep_angle = Radians(80);
  const RegionMap map = Split(Single(sheet), params);
  ASSERT_EQ(map.regions.size(), kSpans + 1u);
  // f' = 4 A / h (s - s^2) over a span: half a span by Simpson's rule, exact to 1e-12.
  const auto half_span = [&](double from) {
    constexpr int kSteps = 200;
    double sum = 0.0;
    for (int k = 0; k <= kSteps; ++k) {
      const double t = from + 0.5 * k / kSteps, rise = 4.0 * a / h * (t - t * t);
      sum += (k == 0 || k == kSteps ? 1.0
              : k % 2 == 1          ? 4.0
                                    : 2.0) *
             std::sqrt(1.0 + slope * slope + rise * rise);
    }
    return sum * 0.5 * h / (3.0 * kSteps) * width;
  };
  std::vector<int> seen(kSpans + 1);
  for (const Region& r : map.regions) {
    // Strip k lies around the knot k, and half of it beyond either end.
    const int k = static_cast<int>(std::lround(r.inside.y() / h));
    ASSERT_TRUE(k >= 0 && k <= kSpans);
    ++seen[static_cast<std::size_t>(k)];
    EXPECT_EQ(r.kind, k % 2 == 0 ? RegionKind::kBasin : RegionKind::kMountain) << k;
    ExpectArea(r.area, (k > 0 ? half_span(0.5) : 0.0) + (k < kSpans ? half_span(0.0) : 0.0));
    ASSERT_EQ(r.border.size(), 1u);
    for (const Vec3& p : r.border[0]) {
      const bool side = p.x() < 1e-9 || p.x() > width - 1e-9;
      const double off = std::min({std::abs(p.y() - std::max(0.0, (k - 0.5) * h)),
                                   std::abs(p.y() - std::min(kSpans * h, (k + 0.5) * h))});
      EXPECT_TRUE(side || off < 1e-6) << p.transpose();
    }
  }
  EXPECT_EQ(seen, std::vector<int>(kSpans + 1, 1));
}

TEST(RegionClosedForms, TheToolForAParabolicGroove) {
  // z = x^2 / (2 q) bends by 1 / q at its bottom: a ball of q reaches all of it, and with the tolerance one a
  // little larger, the largest r whose distance from the groove is nowhere below r - ReachTolerance.
  const double half = 6.0, length = 30.0;
  for (const double q : {1.0, 2.0, 2.5}) {
    SCOPED_TRACE(q);
    BezierPatch groove{2, 1, {}, {}};
    for (const double x : {-half, 0.0, half}) {
      for (const double y : {0.0, length})
        groove.points.emplace_back(x, y, (x == 0.0 ? -1 : 1) * half * half / (2 * q));
    }
    RegionParams params = Exact(3.0);
    const auto free = [&](double r, double x) {
      const double s = std::hypot(1.0, x / q), cx = x - r * x / (q * s), cz = x * x / (2 * q) + r / s;
      double nearest = kInfinity;
      for (double t = -1.5 * q; t < 1.5 * q; t += 0.002 * q)
        nearest = std::min(nearest, std::hypot(t - cx, t * t / (2 * q) - cz));
      return nearest >= r - ReachTolerance(params.tolerance);
    };
    double largest = 3.0;
    for (double x = 0.0; x < q; x += 0.005 * q) {
      while (!free(largest, x)) largest -= 0.0005 * q;
    }
    const RegionMap map = Split(Single(groove), params);
    int grooves = 0;
    for (const Region& r : map.regions) {
      if (r.kind != RegionKind::kUnreachable) continue;
      ++grooves;
      EXPECT_EQ(r.reason, UnreachableReason::kConcave);
      EXPECT_NEAR(r.largest_tool_diameter, 2 * largest, 0.01 * largest);
    }
    EXPECT_EQ(grooves, 1);
  }
}

}  // namespace
}  // namespace patchmill
