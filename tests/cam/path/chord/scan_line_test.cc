#include "cam/path/chord/scan_line.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "tests/support/random.h"
#include "tests/support/shapes.h"
#include "tests/support/surface_of.h"

namespace patchmill {
namespace {

using namespace patchmill::testing;

std::size_t CountPoints(const std::vector<ScanRun>& runs) {
  std::size_t n = 0;
  for (const auto& r : runs) n += r.points.size();
  return n;
}

// Everything a run promises, measured densely against the exact heights of slightly smaller and larger
// balls: the gouge is below the tolerance iff the ball of R - tolerance is free, the excess iff the ball of
// R + tolerance is not. Vertices are free where chords may leave as much as they take.
void ExpectCertified(const Surface& surface, double radius, const std::vector<ScanRun>& runs,
                     const PassParams& params, int probes_per_chord = 7) {
  const double slack = 1e-7;
  const Locator smaller(surface, radius - params.chord_tolerance - slack);
  const Locator larger(surface, radius + ExcessTolerance(params) + slack);
  const double deepest = ExcessTolerance(params) < params.chord_tolerance ? params.chord_tolerance : 0.0;
  const Locator exact(surface, radius);
  int bad_gouge = 0, bad_excess = 0;
  for (const auto& run : runs) {
    ASSERT_GE(run.points.size(), 2u);
    for (std::size_t i = 0; i + 1 < run.points.size(); ++i) {
      const Vec3 &a = run.points[i].center, &b = run.points[i + 1].center;
      const bool vertical = (Xy(a) - Xy(b)).norm() < 1e-6;
      for (int k = 0; k <= probes_per_chord; ++k) {
        const Vec3 x = a + (static_cast<double>(k) / probes_per_chord) * (b - a);
        bad_gouge += !smaller.Free(x, 1e-9);
        if (!vertical && k > 0 && k < probes_per_chord &&
            x.z() > params.floor_z + radius + ExcessTolerance(params)) {
          bad_excess += larger.Free(x, -1e-9);
        }
      }
      const auto h = exact.Height(Xy(a));
      if (h && !vertical && (i == 0 || (Xy(run.points[i - 1].center) - Xy(a)).norm() > 1e-6)) {
        EXPECT_GE(a.z() - h->z, -1e-8 - deepest / std::max(0.05, a.z() - h->contact.p.z()) * radius);
      }
    }
  }
  EXPECT_EQ(bad_gouge, 0);
  EXPECT_EQ(bad_excess, 0);
}

TEST(ScanLine, PlaneIsOneChord) {
  for (double slope : {0.0, 0.3, 2.0}) {
    const Surface surface = SurfaceOf(Plane(30, 1.0, slope, 0.2));
    const Locator locator(surface, 3.0);
    const auto runs = ScanLine(locator, {-20, 3}, {20, -5}, {});
    ASSERT_EQ(runs.size(), 1u);
    EXPECT_EQ(runs[0].points.size(), 2u) << slope;
    const double nz = 1.0 / std::sqrt(1 + slope * slope + 0.04);
    for (const auto& p : runs[0].points) {
      const double truth = 1.0 + slope * p.center.x() + 0.2 * p.center.y() + 3.0 / nz;
      EXPECT_GE(p.center.z(), truth - 1e-9);
      EXPECT_LE(p.center.z(), truth + 1.1e-4);
      ASSERT_TRUE(p.contact);
    }
  }
}

TEST(ScanLine, ValleyKinkIsAVertexWithBothContacts) {
  const double radius = 3.0;
  for (double degrees : {5.0, 30.0, 60.0, 80.0}) {
    const double angle = Radians(degrees);
    const Surface surface = SurfaceOf(TwoPlanes(angle, 40));
    const Locator locator(surface, radius);
    for (double heading : {0.0, 0.4, 1.2}) {
      const Vec2 d(std::cos(heading), std::sin(heading));
      const Vec2 from = Vec2(0.0, 1.7) - 8.123 * d, to = Vec2(0.0, 1.7) + 7.71 * d;
      const auto runs = ScanLine(locator, from, to, {});
      ASSERT_EQ(runs.size(), 1u);
      EXPECT_EQ(runs[0].points.size(), 3u) << degrees << " " << heading;
      const CutterPoint& kink = runs[0].points[1];
      EXPECT_NEAR(kink.center.x(), 0.0, 1e-9) << degrees;
      EXPECT_NEAR(kink.center.y(), 1.7, 1e-9) << degrees;
      EXPECT_GE(kink.center.z(), radius / std::cos(angle) - 1e-9);
      EXPECT_LE(kink.center.z(), radius / std::cos(angle) + 1.1e-4);
      ASSERT_TRUE(kink.contact && kink.other_contact);
      EXPECT_NEAR(kink.contact->p.x(), -radius * std::sin(angle), 1e-6);
      EXPECT_NEAR(kink.other_contact->p.x(), radius * std::sin(angle), 1e-6);
    }
  }
}

TEST(ScanLine, WallOfABlockIsADropInItsPlace) {
  const double radius = 3.0;
  const Surface surface = SurfaceOf(Block(10, 8, 40));
  const Locator locator(surface, radius);
  for (double heading : {0.0, 0.3}) {
    const Vec2 d(std::cos(heading), std::sin(heading));
    const auto runs = ScanLine(locator, -25.0 * d, 25.3 * d, {});
    ASSERT_EQ(runs.size(), 1u);
    const auto& points = runs[0].points;
    int drops = 0;
    for (std::size_t i = 0; i + 1 < points.size(); ++i) {
      const Vec3 &a = points[i].center, &b = points[i + 1].center;
      if ((Xy(a) - Xy(b)).norm() > 0.0 || std::abs(a.z() - b.z()) < 1.0) continue;
      ++drops;
      EXPECT_NEAR(std::abs(a.x()), 10 + radius, 1e-7);
      EXPECT_NEAR(std::max(a.z(), b.z()), 8.0, 4e-4);
      EXPECT_GE(std::max(a.z(), b.z()), 8.0 - 1e-9);
      EXPECT_NEAR(std::min(a.z(), b.z()), radius, 1.1e-4);
    }
    EXPECT_EQ(drops, 2);
    EXPECT_LT(points.size(), 60u);  // two quarter circles of 14 chords or so, no micro segments
    for (std::size_t i = 0; i + 1 < points.size(); ++i) {
      EXPECT_GT((points[i + 1].center - points[i].center).norm(), 1e-3) << i;
    }
    ExpectCertified(surface, radius, runs, {});
  }
}

// An upright tube, exact: quarters of a rational cylinder; with `lid`, closed by a flat disc.
PatchModel Boss(const Vec2& axis, double radius, double height, bool lid) {
  Eigen::Affine3d up = Eigen::Affine3d::Identity();
  up.translate(Lift(axis, 0.5 * height)).rotate(Eigen::AngleAxisd(0.5 * kPi, Vec3::UnitX()));
  PatchModel boss = Transformed(Cylinder(Vec3::Zero(), radius, 0.5 * height), up);
  for (int k = 0; lid && k < 4; ++k) {
    const double from = 0.5 * kPi * k;
    const Vec2 a(std::cos(from), std::sin(from)), b(-a.y(), a.x());
    BezierPatch sector;
    sector.degree_u = 2;
    sector.degree_v = 1;
    for (const Vec2& rim : {a, Vec2(a + b), b}) {
      sector.points.push_back(Lift(axis, height));
      sector.points.push_back(Lift(axis + radius * rim, height));
    }
    const double w = std::sqrt(0.5);
    sector.weights = {1.0, 1.0, w, w, 1.0, 1.0};
    boss.patches.push_back({"", std::move(sector)});
  }
  return boss;
}

// Where the ball leaves a round wall it falls from the wall's upper rim, just beside it, to the plane. A
// tube is a wall on its inside as well.
TEST(ScanLine, RoundWallIsADropInItsPlaceAtAnyHeading) {
  const double radius = 3.0, boss = 5.0, height = 10.0;
  const Vec2 axis(1.3, -0.7);
  for (const bool lid : {true, false}) {
    const Surface surface = SurfaceOf(Join({Plane(40), Boss(axis, boss, height, lid)}));
    const Locator locator(surface, radius);
    for (const double heading : {0.0, 0.4, 2.5}) {
      for (const double off : {0.0, 1.2, 4.5, 7.7, 7.99}) {
        SCOPED_TRACE(::testing::Message() << "lid " << lid << " heading " << heading << " off " << off);
        const Vec2 d(std::cos(heading), std::sin(heading)), middle = axis + off * Vec2(-d.y(), d.x());
        const Vec2 from = middle - 25.0 * d;
        const auto runs = ScanLine(locator, from, middle + 25.3 * d, {});
        ASSERT_EQ(runs.size(), 1u);
        ExpectCertified(surface, radius, runs, {});
        std::vector<double> truth;  // where the walls are left or met, along the line from its middle
        for (const double reach : {boss + radius, lid ? 0.0 : boss - radius}) {
          if (reach <= off) continue;
          truth.push_back(std::sqrt(reach * reach - off * off));
          truth.push_back(-truth.back());
        }
        std::sort(truth.begin(), truth.end());
        std::vector<double> found;
        const auto& points = runs[0].points;
        for (std::size_t i = 0; i < points.size(); ++i) {
          const Vec3& c = points[i].center;
          if (i + 1 < points.size() && (Xy(points[i + 1].center) - Xy(c)).norm() == 0.0) {
            found.push_back((Xy(c) - middle).dot(d));
            EXPECT_NEAR(Cross(d, Xy(c) - middle), 0.0, 1e-12);
            const double top = std::max(c.z(), points[i + 1].center.z()),
                         foot = std::min(c.z(), points[i + 1].center.z());
            // The top stands where the ball's side still holds the rim, 1e-8 mm inside.
            EXPECT_GE(top, height);
            EXPECT_LE(top, height + 2.5e-4);
            EXPECT_NEAR(foot, radius, 1e-9);
            continue;
          }
          if (i > 0 && (Xy(points[i - 1].center) - Xy(c)).norm() == 0.0) continue;
          // Between the drops: on the lid, around the rim or on the plane.
          const double beside = (Xy(c) - axis).norm() - boss;
          const double on_rim = height + std::sqrt(std::max(0.0, radius * radius - beside * beside));
          const double h = lid && beside < 0.0         ? height + radius
                           : std::abs(beside) < radius ? on_rim
                                                       : radius;
          EXPECT_GE(c.z(), h - 1e-8);
          EXPECT_LE(c.z(), h + 1.1e-4);
        }
        ASSERT_EQ(found.size(), truth.size());
        for (std::size_t k = 0; k < truth.size(); ++k) EXPECT_NEAR(found[k], truth[k], 1.1e-8);
      }
    }
  }
}

TEST(ScanLine, BreaksWhereNothingIsAndEndsExactly) {
  const double radius = 2.0;
  // Two plates 6 mm apart: the ball of 2 mm hangs over each border by its radius.
  const Surface surface =
      SurfaceOf(Join({Single(Bilinear({-20, -9, 0}, {-3, -9, 0}, {-20, 9, 0}, {-3, 9, 0})),
                      Single(Bilinear({3, -9, 1}, {20, -9, 1}, {3, 9, 1}, {20, 9, 1}))}));
  const Locator locator(surface, radius);
  const auto runs = ScanLine(locator, {-30, 0}, {30, 0}, {});
  ASSERT_EQ(runs.size(), 2u);
  const double ends[4] = {-22, -1, 1, 22};
  EXPECT_NEAR(runs[0].points.front().center.x(), ends[0], 1e-7);
  EXPECT_NEAR(runs[0].points.back().center.x(), ends[1], 1e-7);
  EXPECT_NEAR(runs[1].points.front().center.x(), ends[2], 1e-7);
  EXPECT_NEAR(runs[1].points.back().center.x(), ends[3], 1e-7);
  EXPECT_NEAR(runs[0].points.back().center.z(), 0.0, 4e-4);
  EXPECT_NEAR(runs[1].points.front().center.z(), 1.0, 4e-4);
  ExpectCertified(surface, radius, runs, {});
}

TEST(ScanLine, FloorCarriesTheBallAndTheSwitchIsSolved) {
  const double radius = 3.0, ball = 10.0, floor_z = 2.0;
  const Surface surface = SurfaceOf(Sphere(Vec3::Zero(), ball, Half::kUpper));
  const Locator locator(surface, radius);
  PassParams params;
  params.floor_z = floor_z;
  const double off = 1.0;
  const auto runs = ScanLine(locator, {-20, off}, {20, off}, params);
  ASSERT_EQ(runs.size(), 1u);
  const double where =
      std::sqrt((ball + radius) * (ball + radius) - (floor_z + radius) * (floor_z + radius) - off * off);
  int found = 0;
  for (const auto& p : runs[0].points) {
    EXPECT_GE(p.center.z(), floor_z + radius);
    const double d2 = Xy(p.center).squaredNorm();
    if (!p.contact || !p.other_contact) {
      if (std::abs(std::abs(p.center.x()) - where) < 1e-9) ++found;
    }
    const double sphere = std::sqrt(std::max(0.0, (ball + radius) * (ball + radius) - d2));
    EXPECT_NEAR(p.center.z(), std::max(sphere, floor_z + radius), 2e-4);
  }
  EXPECT_EQ(found, 2);
  ExpectCertified(surface, radius, runs, params);
}

TEST(ScanLine, SphereHoldsBothTolerances) {
  const Surface surface = SurfaceOf(Sphere(Vec3::Zero(), 10.0, Half::kUpper));
  const Locator locator(surface, 3.0);
  for (double tolerance : {0.02, 0.005, 0.001}) {
    PassParams params;
    params.chord_tolerance = tolerance;
    const auto runs = ScanLine(locator, {-20, 2.5}, {20, 4.0}, params);
    ASSERT_EQ(runs.size(), 1u);
    ExpectCertified(surface, 3.0, runs, params, 11);
    // Chords of a circle of radius 13 with as much sagitta; within a factor 3 of the fewest there can be.
    const double fewest = kPi * 12.5 / std::sqrt(8 * 13.0 * 2 * tolerance);
    EXPECT_LT(static_cast<double>(CountPoints(runs)), 3 * fewest + 10) << tolerance;
  }
}

// Across the square of RandomBspline.
std::vector<ScanRun> ScanRandomLines(const Locator& locator, const PassParams& params, std::uint64_t seed,
                                     int lines) {
  Random random(seed);
  std::vector<ScanRun> runs;
  for (int i = 0; i < lines; ++i) {
    const Vec2 a(random.Uniform(0, 40), random.Uniform(0, 40)),
        b(random.Uniform(0, 40), random.Uniform(0, 40));
    for (auto& r : ScanLine(locator, a, b, params)) runs.push_back(std::move(r));
  }
  return runs;
}

TEST(ScanLine, RandomSplinesHoldBothTolerances) {
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    const bool folds = seed > 4;
    const Surface surface = SurfaceOf(RandomBspline(seed, {.folds = folds, .rational = seed % 2 == 0}));
    for (double radius : {3.0, 1.1}) {
      const Locator locator(surface, radius);
      PassParams params;
      params.chord_tolerance = seed % 3 == 0 ? 0.002 : 0.005;
      const std::vector<ScanRun> runs = ScanRandomLines(locator, params, seed, 3);
      SCOPED_TRACE(::testing::Message() << "seed " << seed << " radius " << radius);
      ExpectCertified(surface, radius, runs, params);
      for (const auto& run : runs) {
        for (const auto& p : run.points) {
          if (!p.contact) continue;
          EXPECT_NEAR((p.center - p.contact->p).norm(), radius, 3e-4);
          if (p.other_contact) {
            EXPECT_NEAR((p.center - p.other_contact->p).norm(), radius, 3e-4);
          }
        }
      }
    }
  }
}

// For each chord the smallest distance to the surface (negative: all of it is below); the largest of these
// values.
double DeepestChord(const Locator& locator, const std::vector<ScanRun>& runs) {
  double deepest = 0.0;
  for (const auto& run : runs) {
    for (std::size_t i = 0; i + 1 < run.points.size(); ++i) {
      const Vec3 &a = run.points[i].center, &b = run.points[i + 1].center;
      double highest = -kInfinity;
      constexpr int kProbes = 32;
      for (int k = 0; k <= kProbes; ++k) {
        const Vec3 x = a + (static_cast<double>(k) / kProbes) * (b - a);
        const auto h = locator.Height(Xy(x));
        if (h) highest = std::max(highest, x.z() - h->z);
      }
      deepest = std::max(deepest, -highest);
    }
  }
  return deepest;
}

PatchModel Bowl(double radius) {
  const Eigen::Affine3d over(Eigen::AngleAxisd(kPi, Vec3::UnitX()));
  return Transformed(Sphere(Vec3::Zero(), radius, Half::kUpper), over);
}

PassParams Fine(double scallop) {
  PassParams params;
  params.scallop = params.chord_tolerance = scallop;
  return WithFineChords(params);
}

// In a bowl of radius 12 the ball of 3 goes along a circle of radius 9. Chords between places on it would
// leave what they may with 1 / sqrt(0.1 / 0.6) times as many points as chords whose ends are below it by
// half of what they may take.
TEST(ScanLine, FineChordsGoDownIntoABowl) {
  const double bowl = 12.0, radius = 3.0;
  const Surface surface = SurfaceOf(Bowl(bowl));
  const Locator locator(surface, radius);
  for (const double scallop : {0.005, 0.01, 0.04}) {
    const PassParams params = Fine(scallop);
    const double reach = 0.7 * (bowl - radius);
    const auto runs = ScanLine(locator, {-reach, 0}, {reach, 0}, params);
    ASSERT_EQ(runs.size(), 1u);
    ExpectCertified(surface, radius, runs, params, 11);
    const double arc = 2.0 * std::asin(0.7) * (bowl - radius);
    const double share = 0.5 * params.chord_tolerance + ExcessTolerance(params);
    const double fewest = arc / std::sqrt(8.0 * (bowl - radius) * share);
    EXPECT_LT(static_cast<double>(CountPoints(runs)), 1.7 * fewest + 4.0) << scallop;
    EXPECT_LT(DeepestChord(locator, runs), 0.05 * params.chord_tolerance) << scallop;
    for (const CutterPoint* end : {&runs[0].points.front(), &runs[0].points.back()}) {
      EXPECT_LE(end->center.norm(), bowl - radius + 1e-9);
      EXPECT_GE(end->center.norm(), bowl - radius - 1.1 * params.certificate_gap);
    }
  }
}

TEST(ScanLine, FineChordsHoldBothTolerancesAnywhere) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    const Surface surface = SurfaceOf(RandomBspline(seed, {.folds = seed > 2, .rational = seed % 2 == 0}));
    const Locator locator(surface, 2.0);
    const PassParams params = Fine(0.01);
    const std::vector<ScanRun> runs = ScanRandomLines(locator, params, seed, 2);
    SCOPED_TRACE(::testing::Message() << "seed " << seed);
    ExpectCertified(surface, 2.0, runs, params);
    EXPECT_LT(DeepestChord(locator, runs), 0.1 * params.chord_tolerance);
  }
}

// On the floor and beside it nothing goes below it.
TEST(ScanLine, FineChordsStayAboveTheFloor) {
  const Surface surface = SurfaceOf(Bowl(12.0));
  const Locator locator(surface, 3.0);
  PassParams params = Fine(0.01);
  params.floor_z = -11.9995;
  const auto runs = ScanLine(locator, {-6, 1}, {6, -1}, params);
  ASSERT_EQ(runs.size(), 1u);
  bool below = false;
  for (const CutterPoint& p : runs[0].points) {
    EXPECT_GE(p.center.z(), params.floor_z + 3.0);
    const auto h = locator.Height(Xy(p.center));
    below |= h && p.center.z() < h->z - 1e-5;
  }
  EXPECT_TRUE(below);
  ExpectCertified(surface, 3.0, runs, params);
}

TEST(ScanLine, ACancelledLineIsCutShort) {
  const Surface surface = SurfaceOf(Bumpy());
  const Locator locator(surface, 3.0);
  const Vec2 a(surface.box.min.x(), 10), b(surface.box.max.x(), 40);
  RunContext run(1);
  const std::size_t whole = CountPoints(ScanLine(locator, a, b, {}, &run));
  EXPECT_EQ(whole, CountPoints(ScanLine(locator, a, b, {})));
  run.Cancel();
  EXPECT_GT(whole, 20u);
  EXPECT_LE(CountPoints(ScanLine(locator, a, b, {}, &run)), 1u);
}

TEST(ScanLine, DegenerateLineIsOnePointOrNothing) {
  const Surface surface = SurfaceOf(Plane(10));
  const Locator locator(surface, 3.0);
  EXPECT_LE(CountPoints(ScanLine(locator, {1, 1}, {1, 1}, {})), 1u);
  EXPECT_TRUE(ScanLine(locator, {20, 20}, {30, 20}, {}).empty());
}

TEST(ScanPolyline, GoesOnOverCornersAndKeepsThemAsVertices) {
  const Surface surface = SurfaceOf(TwoHills());
  const Locator locator(surface, 3.0);
  PassParams params;
  const std::vector<Vec2> corners = {{20, 30}, {40, 32}, {61, 29}, {80, 36}};
  const auto runs = ScanPolyline(locator, corners, params);
  ASSERT_EQ(runs.size(), 1u);
  ExpectCertified(surface, 3.0, runs, params);
  std::size_t next = 0;
  for (const CutterPoint& p : runs[0].points) {
    if (next < corners.size() && (Xy(p.center) - corners[next]).norm() < 1e-9) ++next;
  }
  EXPECT_EQ(next, corners.size());
  EXPECT_EQ(Xy(runs[0].points.front().center), corners.front());
}

TEST(ScanPolyline, BreaksWhereThereIsNothingBelow) {
  const Surface surface = SurfaceOf(Plane(5));
  const Locator locator(surface, 1.0);
  // Out over the border and back in: two runs.
  const std::vector<Vec2> corners = {{0, 0}, {9, 1}, {0, 2}};
  const auto runs = ScanPolyline(locator, corners, PassParams());
  ASSERT_EQ(runs.size(), 2u);
  EXPECT_EQ(Xy(runs[0].points.front().center), corners.front());
  EXPECT_EQ(Xy(runs[1].points.back().center), corners.back());
}

}  // namespace
}  // namespace patchmill
