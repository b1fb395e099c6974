#include "cam/path/rest/rest_passes.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "cam/limits/reach_tolerance.h"
#include "cam/path/contour/contour_paths.h"
#include "cam/path/parallel/zigzag_paths.h"
#include "cam/path/rest/leftover_spots.h"
#include "core/diffgeo/forms.h"
#include "tests/support/joined_surface.h"
#include "tests/support/leftover.h"
#include "tests/support/random.h"
#include "tests/support/shapes.h"

namespace patchmill {
namespace {

using namespace patchmill::testing;

constexpr double kScallop = 0.01, kTolerance = 0.01, kChordTolerance = 0.4 * kTolerance;

RestPassParams Coverage() {
  RestPassParams params;
  params.pass.scallop = kScallop;
  params.pass.chord_tolerance = kChordTolerance;
  params.tolerance = kTolerance;
  params.limit = kScallop + 0.5 * kTolerance;
  return params;
}

std::vector<CutterPath> Zigzag(const Locator& locator, double angle, double max_slope = kPi / 2) {
  ZigzagParams params;
  params.pass.scallop = kScallop;
  params.pass.chord_tolerance = kChordTolerance;
  params.angle = angle;
  params.pass.window.max = max_slope;
  auto paths = ZigzagPaths(locator, params, RunContext(1));
  EXPECT_TRUE(paths.ok()) << paths.status();
  return std::move(*paths);
}

std::vector<CutterPath> Rest(const Locator& locator, const std::vector<CutterPath>& paths, int threads = 1) {
  const Locator reach = *ReachLocator(locator, Coverage(), RunContext());
  auto rest = RestPaths(locator, reach, paths, Coverage(), RunContext(threads));
  EXPECT_TRUE(rest.ok()) << rest.status();
  return std::move(*rest);
}

std::vector<CutterPath> Joined(std::vector<CutterPath> a, const std::vector<CutterPath>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

struct Leftover {
  double worst = 0.0;
  Vec3 where = Vec3::Zero();
  int reachable = 0;
};

// Largest leftover over random surface points that are reachable as [regions (6)] defines it.
Leftover Measure(const Surface& surface, double radius, const std::vector<CutterPath>& paths, int samples,
                 double floor_z = -kInfinity, double max_slope = kPi / 2) {
  const Locator reach(surface, radius - ReachTolerance(kTolerance));
  const DistanceToPaths distance(paths);
  Random random(11);
  Leftover out;
  for (int k = 0; k < samples; ++k) {
    const PieceId piece(random.Int(static_cast<int>(surface.pieces.size())));
    const SurfaceJet jet = Evaluate(surface, piece, random.Unit(), random.Unit());
    const auto e = UpwardNormal(jet);
    if (!e || std::acos(std::min(1.0, e->z())) > max_slope) continue;
    const Vec3 c = jet.p + radius * *e;
    if (c.z() < floor_z + radius || !reach.Free(c)) continue;
    ++out.reachable;
    const double left = distance.At(jet.p, radius + 2.0) - radius;
    if (left > out.worst) {
      out.worst = left;
      out.where = jet.p;
    }
  }
  return out;
}

// Certified chords of the added passes: dense probes with smaller balls. Rest passes stay straight, so they
// may use the share of arcs, too.
int Gouges(const Surface& surface, double radius, const std::vector<CutterPath>& paths) {
  const Locator pencils(surface, radius - kChordTolerance - 1e-7);
  const Locator rests(surface, radius - ReachTolerance(kTolerance) - 1e-7);
  int bad = 0;
  for (const auto& path : paths) {
    const Locator& smaller = path.kind == PassKind::kRest ? rests : pencils;
    for (std::size_t i = 0; i + 1 < path.points.size(); ++i) {
      for (int k = 0; k <= 4; ++k) {
        const Vec3 x = path.points[i].center + 0.25 * k * (path.points[i + 1].center - path.points[i].center);
        bad += !smaller.Free(x, 1e-9);
      }
    }
  }
  return bad;
}

// A valley of 30 degrees on both sides, under lines at every angle to it: plain passes leave up to 4
// scallops beside the crease when they run along it.
TEST(RestPaths, ValleyAtEveryAngleToTheFeed) {
  const double radius = 3.0, slope = Radians(30);
  const Surface surface = JoinedSurface(TwoPlanes(slope, 8));
  const Locator locator(surface, radius);
  bool plain_failed = false;
  for (double degrees = 0; degrees <= 90; degrees += 7.5) {
    // The valley runs along y, the lines at `degrees` from it.
    const auto plain = Zigzag(locator, Radians(90 - degrees));
    const auto rest = Rest(locator, plain);
    plain_failed |= Measure(surface, radius, plain, 4000).worst > kScallop + kTolerance;
    const Leftover left = Measure(surface, radius, Joined(plain, rest), 40000);
    EXPECT_GT(left.reachable, 20000);
    EXPECT_LE(left.worst, kScallop + kTolerance) << degrees << " at " << left.where.transpose();
    EXPECT_EQ(Gouges(surface, radius, rest), 0) << degrees;
    double length = 0;
    for (const auto& p : rest) length += Length(p);
    EXPECT_LT(length, 100.0) << degrees;  // one pencil pass and rest passes at the borders, no second zig-zag
  }
  EXPECT_TRUE(plain_failed);
}

TEST(RestPaths, CreasePassIsTheExactTwoContactLine) {
  const double radius = 3.0, slope = Radians(50);
  const Surface surface = JoinedSurface(TwoPlanes(slope, 10));
  const Locator locator(surface, radius);
  // Passes along the valley, none in it.
  std::vector<CutterPath> plain;
  for (double x = 0.2; x < 8; x += 0.25) {
    for (double side : {-1.0, 1.0}) {
      const double z = radius / std::cos(slope) + x * std::tan(slope);
      plain.push_back({.points = {{{side * x, -10, z}, {}, {}}, {{side * x, 10, z}, {}, {}}}});
    }
  }
  const auto rest = Rest(locator, plain);
  double crease_length = 0;
  for (const auto& path : rest) {
    if (path.kind != PassKind::kPencil) continue;
    crease_length += Length(path);
    for (const auto& p : path.points) {
      EXPECT_NEAR(p.center.x(), 0.0, 1e-9);
      EXPECT_GE(p.center.z(), radius / std::cos(slope) - 1e-9);
      EXPECT_LE(p.center.z(), radius / std::cos(slope) + 2e-4);
      EXPECT_TRUE(p.contact && p.other_contact);
    }
  }
  EXPECT_NEAR(crease_length, 20.0, 1.0);
}

// The crease around the foot of a hemisphere is a ring. The pass makes one full turn.
void ExpectOneRing(double r) {
  const double radius = 3.0, half = r + 8.0;
  const Surface surface = JoinedSurface(Join({Plane(half), Sphere(Vec3::Zero(), r, Half::kUpper)}));
  const Locator locator(surface, radius);
  const double reached = r + radius, ring = std::sqrt(reached * reached - radius * radius);
  // Circles from half a mm outside the foot on, and above it.
  std::vector<CutterPath> plain;
  const auto circle = [&](double across, double z) {
    CutterPath path;
    path.closed = true;
    for (int k = 0; k < 720; ++k) {
      const double angle = kPi * k / 360;
      path.points.push_back({{across * std::cos(angle), across * std::sin(angle), z}, {}, {}});
    }
    plain.push_back(std::move(path));
  };
  for (double out = 0.5; ring + out < half - 1.0; out += 0.2) circle(ring + out, radius);
  for (double up = 0.5; radius + up < reached; up += 0.1)
    circle(std::sqrt(reached * reached - (radius + up) * (radius + up)), radius + up);
  const auto rest = Rest(locator, plain);
  double crease_length = 0;
  for (const auto& path : rest) {
    if (path.kind != PassKind::kPencil) continue;
    crease_length += Length(path);
    for (const auto& p : path.points) EXPECT_NEAR(Xy(p.center).norm(), ring, 2e-4);
  }
  EXPECT_NEAR(crease_length, 2 * kPi * ring, 0.5);
}

TEST(RestPaths, ACreaseThatIsARingIsCutOnce) {
  for (const double r : {6.0, 6.1, 7.0, 8.0}) {  // wherever the last step ends
    SCOPED_TRACE(r);
    ExpectOneRing(r);
  }
}

TEST(RestPaths, NothingIsAddedWhereNothingIsMissing) {
  const double radius = 3.0;
  const Surface surface = JoinedSurface(Plane(10));
  const Locator locator(surface, radius);
  EXPECT_TRUE(Rest(locator, Zigzag(locator, 0.0)).empty());
}

TEST(RestPaths, AMissingLineIsPutBack) {
  const double radius = 3.0;
  const Surface surface = JoinedSurface(Saddle(0.02, 0.01, 10));
  const Locator locator(surface, radius);
  auto plain = Zigzag(locator, 0.0);
  plain.erase(plain.begin() + static_cast<std::ptrdiff_t>(plain.size() / 2));
  const auto rest = Rest(locator, plain);
  ASSERT_FALSE(rest.empty());
  const Leftover left = Measure(surface, radius, Joined(plain, rest), 60000);
  EXPECT_LE(left.worst, kScallop + kTolerance) << left.where.transpose();
  EXPECT_EQ(Gouges(surface, radius, rest), 0);
}

TEST(RestPaths, WallsAreMendedByLevels) {
  // Upright walls 4 mm high that no pass has touched: only the top and the floor are done.
  const double radius = 1.5;
  const Surface surface = JoinedSurface(Block(4, 4, 9));
  const Locator locator(surface, radius);
  const auto plain = Zigzag(locator, 0.0, Radians(45));
  const auto rest = Rest(locator, plain);
  const Leftover left = Measure(surface, radius, Joined(plain, rest), 40000);
  EXPECT_GT(left.reachable, 20000);
  EXPECT_LE(left.worst, kScallop + kTolerance) << left.where.transpose();
  EXPECT_EQ(Gouges(surface, radius, rest), 0);
}

TEST(RestPaths, CurvedBordersAndTightSpotsOfRandomSurfaces) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    const Surface surface = JoinedSurface(RandomBspline(seed, {.spans = 5, .size = 20, .amplitude = 2.5}));
    const double radius = 2.0;
    const Locator locator(surface, radius);
    const auto plain = Zigzag(locator, 0.3, kPi / 2);
    const auto rest = Rest(locator, plain);
    const Leftover left = Measure(surface, radius, Joined(plain, rest), 40000);
    EXPECT_GT(left.reachable, 5000);
    EXPECT_LE(left.worst, kScallop + kTolerance) << seed << " at " << left.where.transpose();
    EXPECT_EQ(Gouges(surface, radius, rest), 0) << seed;
    double plain_length = 0, rest_length = 0;
    for (const auto& p : plain) plain_length += Length(p);
    for (const auto& p : rest) rest_length += Length(p);
    EXPECT_LT(rest_length, 0.35 * plain_length) << seed;
  }
}

TEST(RestPaths, FloorAndWindowLimitWhatIsMended) {
  const double radius = 3.0;
  const Surface surface = JoinedSurface(Sphere(Vec3::Zero(), 8, Half::kUpper));
  const Locator locator(surface, radius);
  RestPassParams params = Coverage();
  params.pass.floor_z = 3.0;
  params.pass.window.max = Radians(60);
  const auto plain = Zigzag(locator, 0.0, Radians(30));
  const Locator reach = *ReachLocator(locator, params, RunContext());
  auto rest = RestPaths(locator, reach, plain, params, RunContext(1));
  ASSERT_TRUE(rest.ok());
  for (const auto& path : *rest) {
    for (const auto& p : path.points) EXPECT_GE(p.center.z(), 6.0 - 1e-9);
  }
  const Leftover left = Measure(surface, radius, Joined(plain, *rest), 20000, 3.0, Radians(60));
  EXPECT_LE(left.worst, kScallop + kTolerance) << left.where.transpose();
}

TEST(RestPaths, SameBytesForAnyThreadCountAndCancel) {
  const Surface surface = JoinedSurface(RandomBspline(5, {.spans = 5, .size = 20, .amplitude = 2.5}));
  const Locator locator(surface, 2.0);
  const auto plain = Zigzag(locator, 0.3);
  const auto one = Rest(locator, plain, 1), two = Rest(locator, plain, 2);
  ASSERT_EQ(one.size(), two.size());
  for (std::size_t i = 0; i < one.size(); ++i) {
    ASSERT_EQ(one[i].points.size(), two[i].points.size());
    for (std::size_t k = 0; k < one[i].points.size(); ++k) {
      EXPECT_EQ(one[i].points[k].center, two[i].points[k].center);
    }
  }
  const Locator reach = *ReachLocator(locator, Coverage(), RunContext());
  RunContext run(1);
  run.Cancel();
  EXPECT_EQ(RestPaths(locator, reach, plain, Coverage(), run).status().code(), absl::StatusCode::kCancelled);
}

}  // namespace
}  // namespace patchmill
