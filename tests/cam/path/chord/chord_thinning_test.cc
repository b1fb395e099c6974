// Contours with as few points as their chords allow: what they promise, by h alone, and how few there are.
#include "cam/path/chord/chord_thinning.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "cam/path/contour/contour_paths.h"
#include "cam/path/contour/spiral_paths.h"
#include "tests/cam/path/zlevel/level_checks.h"
#include "tests/support/random.h"
#include "tests/support/shapes.h"

namespace patchmill {
namespace {

using namespace patchmill::testing;

constexpr double kR = 3.0;
const ThinWhich kAll = [](const CutterPath&) { return true; };

struct Thinned {
  Thinned(PatchModel model, double scallop, SlopeWindow window = {Radians(45), Radians(90)})
      : surface(MakeSurface(std::move(model))), locator(surface, kR) {
    params.pass.scallop = params.pass.chord_tolerance = scallop;
    params.pass = WithFineChords(params.pass);
    params.pass.window = window;
    auto contours = ContourPaths(locator, params, RunContext(2));
    if (!contours.ok()) {
      ADD_FAILURE() << contours.status();
      return;
    }
    before = after = std::move(contours->paths);
    EXPECT_TRUE(ThinContours(locator, params.pass, kAll, RunContext(2), after).ok());
  }
  ContourParams params;
  Surface surface;
  Locator locator;
  std::vector<CutterPath> before, after;
};

std::size_t PointsOf(const std::vector<CutterPath>& paths) {
  std::size_t n = 0;
  for (const CutterPath& path : paths) n += path.points.size();
  return n;
}

struct Chords {
  int probes = 0, gouges = 0, excesses = 0;
  double longest = 0.0;
  int buried = 0;  // chords that lie below the surface all along
};

// Every chord, judged densely: a ball smaller by what it may take is free, one larger by what it may leave
// is not; and somewhere one smaller by twice that is free.
Chords Judge(const Thinned& t, const std::vector<CutterPath>& paths, int per_chord = 9) {
  const double gouge = t.params.pass.chord_tolerance, excess = ExcessTolerance(t.params.pass);
  const Locator smaller(t.surface, kR - gouge - 1e-7), larger(t.surface, kR + excess + 1e-7);
  const Locator touching(t.surface, kR - 2.0 * excess);
  Chords all;
  for (const CutterPath& path : paths) {
    const std::size_t n = path.points.size();
    for (std::size_t i = 0; i + (path.closed ? 0 : 1) < n; ++i) {
      const Vec3 &a = path.points[i].center, &b = path.points[(i + 1) % n].center;
      all.longest = std::max(all.longest, (b - a).norm());
      bool touches = false;
      for (int k = 0; k <= per_chord; ++k) {
        const Vec3 x = a + (static_cast<double>(k) / per_chord) * (b - a);
        ++all.probes;
        all.gouges += !smaller.Free(x, 1e-9);
        all.excesses += larger.Free(x, -1e-9);
        touches |= touching.Free(x, 1e-9);
      }
      all.buried += !touches;
    }
  }
  return all;
}

// Of splines some cells are below the resolution: there contours themselves leave more ([contours T8d]).
enum class Cells { kResolved, kSomeTooSmall };

void ExpectPromises(const Thinned& t, Cells cells = Cells::kResolved) {
  ASSERT_FALSE(t.after.empty());
  ASSERT_EQ(t.after.size(), t.before.size());
  const Chords chords = Judge(t, t.after);
  EXPECT_EQ(chords.gouges, 0) << "of " << chords.probes;
  EXPECT_LE(chords.excesses, cells == Cells::kResolved ? 0 : Judge(t, t.before).excesses)
      << "of " << chords.probes;
  EXPECT_EQ(chords.buried, 0);
  EXPECT_LE(chords.longest, kR * (1.0 + 1e-9));
  for (std::size_t i = 0; i < t.after.size(); ++i) {
    const CutterPath &before = t.before[i], &after = t.after[i];
    EXPECT_EQ(before.closed, after.closed);
    EXPECT_EQ(before.order_key, after.order_key);
    // Ends and corners stay as they are.
    EXPECT_EQ(before.points.front().center, after.points.front().center);
    if (!before.closed) {
      EXPECT_EQ(before.points.back().center, after.points.back().center);
    }
    const auto corners = [](const CutterPath& path) {
      std::vector<Vec3> centers;
      for (const CutterPoint& p : path.points) {
        if (p.other_contact) centers.push_back(p.center);
      }
      return centers;
    };
    EXPECT_EQ(corners(before), corners(after));
    for (const CutterPoint& p : after.points) {
      EXPECT_NEAR(p.center.z(), before.points.front().center.z(), 2e-4);
      ASSERT_TRUE(p.contact);
    }
  }
}

// Walls that are planes need points at their corners, and every radius in between.
TEST(ThinContours, PlanesNeedNoPoints) {
  const Thinned t(TwoPlanes(Radians(60), 20), 0.01);
  ExpectPromises(t);
  for (const CutterPath& path : t.after) {
    EXPECT_LE(static_cast<double>(path.points.size()), std::ceil(Length(path) / kR) * 1.34 + 3.0);
    // Nothing is hollow along them, and rounding must not make it so.
    for (const CutterPoint& p : path.points) EXPECT_TRUE(t.locator.Free(p.center, 1e-8));
  }
  EXPECT_LT(8 * PointsOf(t.after), PointsOf(t.before));
}

// Around an upright tube of radius 9 the ball's centre goes along circles, outside of radius 12 and inside
// of 6. A chord of a circle of radius r may be off by `share` in all: length sqrt(8 r share).
TEST(ThinContours, CirclesTakeAboutTheFewestChords) {
  Eigen::Affine3d up = Eigen::Affine3d::Identity();
  up.rotate(Eigen::AngleAxisd(0.5 * kPi, Vec3::UnitX()));
  const double radius = 9.0;
  for (const double scallop : {0.01, 0.04}) {
    const Thinned t(Transformed(Cylinder(Vec3::Zero(), radius, 0.4), up), scallop);
    ExpectPromises(t);
    bool inside = false, outside = false;
    for (const CutterPath& path : t.after) {
      if (!path.closed) continue;
      const double r = Length(path) / (2.0 * kPi);
      const double gouge = t.params.pass.chord_tolerance, excess = ExcessTolerance(t.params.pass);
      const bool in = r < radius;
      (in ? inside : outside) = true;
      const double share = in ? 0.5 * gouge + excess : 0.9 * gouge;
      const double fewest = 2.0 * kPi * r / std::sqrt(8.0 * r * share);
      EXPECT_LT(static_cast<double>(path.points.size()), 1.7 * fewest + 4.0) << "radius " << r;
    }
    EXPECT_TRUE(inside);
    EXPECT_TRUE(outside);
  }
}

TEST(ThinContours, CurvedSurfaceKeepsThePromises) {
  ExpectPromises(Thinned(Sphere(Vec3::Zero(), 8.0, Half::kUpper), 0.01));
  ExpectPromises(Thinned(Torus(Vec3::Zero(), 12.0, 5.0, Half::kUpper), 0.01));
  ExpectPromises(Thinned(TwoHills(), 0.01, {Radians(20), Radians(90)}));
}

TEST(ThinContours, RandomSplinesKeepThePromises) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    SCOPED_TRACE(::testing::Message() << "seed " << seed);
    ExpectPromises(Thinned(RandomBspline(seed, {.folds = seed > 2, .rational = seed % 2 == 0}), 0.02),
                   Cells::kSomeTooSmall);
  }
}

// Turns of a spiral fall, and their joins bend in z.
TEST(ThinContours, SpiralsKeepThePromises) {
  const Eigen::Affine3d over(Eigen::AngleAxisd(kPi, Vec3::UnitX()));
  for (const double radius : {8.0, 14.0}) {
    Thinned t(Transformed(Sphere(Vec3::Zero(), radius, Half::kUpper), over), 0.03, {0.0, Radians(90)});
    auto spirals = SpiralPaths(t.locator, t.before, t.params.pass, false, RunContext(2));
    ASSERT_TRUE(spirals.ok()) << spirals.status();
    t.before = t.after = *std::move(spirals);
    ASSERT_TRUE(ThinContours(t.locator, t.params.pass, kAll, RunContext(2), t.after).ok());
    EXPECT_TRUE(std::any_of(t.after.begin(), t.after.end(),
                            [](const CutterPath& p) { return p.traversal == Traversal::kSpiral; }));
    EXPECT_LT(PointsOf(t.after), PointsOf(t.before));
    const Chords chords = Judge(t, t.after);
    EXPECT_EQ(chords.gouges, 0) << "of " << chords.probes;
    EXPECT_EQ(chords.excesses, 0) << "of " << chords.probes;
    EXPECT_EQ(chords.buried, 0);
  }
}

TEST(ThinContours, LeavesOtherPassesAndIsCancelled) {
  Thinned t(TwoPlanes(Radians(60), 20), 0.01);
  std::vector<CutterPath> lines = t.before;
  for (CutterPath& path : lines) path.kind = PassKind::kZigzag;
  ASSERT_TRUE(ThinContours(t.locator, t.params.pass, kAll, RunContext(1), lines).ok());
  EXPECT_EQ(PointsOf(lines), PointsOf(t.before));
  RunContext run(1);
  run.Cancel();
  EXPECT_EQ(ThinContours(t.locator, t.params.pass, kAll, run, t.before).code(), absl::StatusCode::kCancelled);
}

}  // namespace
}  // namespace patchmill
