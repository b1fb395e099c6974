#include "cam/path/parallel/zigzag_paths.h"

#include <algorithm>
#include <cmath>
#include <set>

#include <gtest/gtest.h>

#include "cam/path/stepover/step_over.h"
#include "core/diffgeo/forms.h"
#include "tests/support/joined_surface.h"
#include "tests/support/leftover.h"
#include "tests/support/random.h"
#include "tests/support/shapes.h"

namespace patchmill {
namespace {

using namespace patchmill::testing;

std::vector<CutterPath> Zigzag(const Locator& locator, const ZigzagParams& params, int threads = 1) {
  auto paths = ZigzagPaths(locator, params, RunContext(threads));
  EXPECT_TRUE(paths.ok()) << paths.status();
  return std::move(*paths);
}

ZigzagParams Params(double scallop, double max_slope_degrees, double angle = 0.0) {
  ZigzagParams params;
  params.pass.scallop = scallop;
  params.pass.chord_tolerance = 0.002;
  params.pass.window = {0.0, Radians(max_slope_degrees)};
  params.angle = angle;
  return params;
}

struct Leftover {
  double worst = 0.0;
  Vec3 where = Vec3::Zero();
  int samples = 0;
};

// Largest leftover over random points of the surface in the slope window that a ball touches from above
// without being in anything's way; points nearer than `margin` to a piece's border in parameters are left
// out.
Leftover Measure(const Surface& surface, const Locator& locator, const std::vector<CutterPath>& paths,
                 const SlopeWindow& window, int samples, double margin = 0.0) {
  const DistanceToPaths distance(paths);
  const double radius = locator.radius();
  Random random(7);
  Leftover out;
  for (int k = 0; k < samples; ++k) {
    const PieceId piece(random.Int(static_cast<int>(surface.pieces.size())));
    const double u = random.Uniform(margin, 1 - margin), v = random.Uniform(margin, 1 - margin);
    const SurfaceJet jet = Evaluate(surface, piece, u, v);
    const auto e = UpwardNormal(jet);
    if (!e) continue;
    const double slope = std::acos(std::min(1.0, e->z()));
    if (slope < window.min || slope > window.max) continue;
    if (!locator.Free(jet.p + radius * *e, 1e-7)) continue;
    ++out.samples;
    const double left = distance.At(jet.p, radius + 1.0) - radius;
    if (left > out.worst) {
      out.worst = left;
      out.where = jet.p;
    }
  }
  return out;
}

TEST(ZigzagPaths, PlaneHasLinesAtItsBordersAndTheFlatStep) {
  const double radius = 3.0, scallop = 0.01, half = 10.0;
  const Surface surface = JoinedSurface(Plane(half));
  const Locator locator(surface, radius);
  const auto paths = Zigzag(locator, Params(scallop, 45));
  const double flat = CenterStep(radius, scallop, 0.0);
  ASSERT_EQ(paths.size(), static_cast<std::size_t>(std::ceil(2 * half / flat)) + 1);
  EXPECT_NEAR(paths.front().points.front().center.y(), -half, 2e-3 * flat);
  EXPECT_NEAR(paths.back().points.front().center.y(), half, 2e-3 * flat);
  for (std::size_t i = 0; i < paths.size(); ++i) {
    EXPECT_EQ(paths[i].order_key, static_cast<int>(i));
    EXPECT_EQ(paths[i].points.size(), 2u);
    EXPECT_NEAR(paths[i].points.front().center.x(), -half, 1e-4);
    EXPECT_NEAR(paths[i].points.back().center.x(), half, 1e-4);
  }
  const Leftover left = Measure(surface, locator, paths, {0, Radians(45)}, 20000);
  EXPECT_GT(left.samples, 19000);
  EXPECT_LE(left.worst, scallop + 0.002);
  EXPECT_GE(left.worst, 0.8 * scallop);  // not finer than asked
}

TEST(ZigzagPaths, TiltedPlaneStopsAtLowBordersAndCrownsHighOnes) {
  const double radius = 3.0, half = 8.0;
  const Vec3 n = Vec3(-0.5, 0.3, 1).normalized();  // falls towards -x and +y
  const Surface surface = JoinedSurface(Plane(half, 0, 0.5, -0.3));
  const Locator locator(surface, radius);
  for (double angle : {0.0, 0.5, kPi / 2}) {
    const auto paths = Zigzag(locator, Params(0.02, 45, angle));
    ASSERT_FALSE(paths.empty());
    double low_x = kInfinity, high_x = -kInfinity, low_y = kInfinity, high_y = -kInfinity;
    for (const auto& path : paths) {
      for (const auto& p : path.points) {
        ASSERT_TRUE(p.contact);
        const Vec3& c = p.contact->p;
        const bool rim = c.x() > half - 1e-9 || c.y() < -half + 1e-9;
        if (!rim) {
          EXPECT_LT((p.center - c - radius * n).norm(), 3e-4);
        }
        low_x = std::min(low_x, p.center.x());
        high_x = std::max(high_x, p.center.x());
        low_y = std::min(low_y, p.center.y());
        high_y = std::max(high_y, p.center.y());
      }
    }
    // Stops on the surface normal below; at the corners it may lean along the rim as far as the rim's own
    // fall.
    EXPECT_LE(low_x, -half + radius * n.x() + 1e-3);
    EXPECT_GE(low_x, -half - radius * 0.5 / std::sqrt(1.25) - 1e-3);
    EXPECT_GE(high_y, half + radius * n.y() - 1e-3);
    EXPECT_LE(high_y, half + radius * 0.3 / std::sqrt(1.09) + 1e-3);
    // Stands right above the edge on top.
    EXPECT_LE(high_x, half + 1e-3);
    EXPECT_LE(-low_y, half + 1e-3);
    if (angle == 0.0) {
      EXPECT_NEAR(high_x, half, 1e-3);
    }
  }
}

TEST(ZigzagPaths, EveryPathRunsAlongTheAngleInOrderOfLines) {
  const Surface surface = JoinedSurface(Saddle(0.02, 0.02, 12));
  const Locator locator(surface, 3.0);
  for (double angle : {0.0, 0.7, kPi / 2, 3.0}) {
    const auto paths = Zigzag(locator, Params(0.02, 45, angle));
    ASSERT_GT(paths.size(), 20u);
    const Vec2 along(std::cos(angle), std::sin(angle)), across(-along.y(), along.x());
    double last_y = -kInfinity;
    int last_line = -1;
    for (const auto& path : paths) {
      const double y = Xy(path.points.front().center).dot(across);
      EXPECT_GE(y, last_y - 1e-9);
      EXPECT_GE(path.order_key, last_line);
      last_y = y;
      last_line = path.order_key;
      EXPECT_EQ(path.kind, PassKind::kZigzag);
      for (std::size_t i = 0; i < path.points.size(); ++i) {
        EXPECT_NEAR(Xy(path.points[i].center).dot(across), y, 1e-9);
        if (i > 0) {
          EXPECT_GE(Xy(path.points[i].center - path.points[i - 1].center).dot(along), -1e-12);
        }
      }
    }
    const Leftover left = Measure(surface, locator, paths, {0, Radians(45)}, 20000, 0.05);
    EXPECT_GT(left.samples, 15000);
    EXPECT_LE(left.worst, 0.02 + 0.003) << angle << " at " << left.where.transpose();
    EXPECT_GE(left.worst, 0.01);
  }
}

TEST(ZigzagPaths, CurvedSurfaceKeepsTheScallop) {
  const double scallop = 0.02;
  struct Case {
    const char* name;
    PatchModel model;
    double radius;
  };
  const Case cases[] = {{"dome", Sphere(Vec3::Zero(), 9, Half::kUpper), 3.0},
                        {"roof", Cylinder(Vec3::Zero(), 7, 12, Half::kUpper), 3.0},
                        {"ring", Torus(Vec3::Zero(), 14, 4, Half::kUpper), 2.0},
                        {"dish", Paraboloid(0.03, 10), 3.0},
                        {"valley 1.2 R", ParabolicValley(0.5 / 3.6, 8), 3.0}};
  for (const Case& c : cases) {
    const Surface surface = JoinedSurface(c.model);
    const Locator locator(surface, c.radius);
    for (double angle : {0.0, 0.9}) {
      const auto paths = Zigzag(locator, Params(scallop, 45, angle));
      const Leftover left = Measure(surface, locator, paths, {0, Radians(45)}, 20000, 0.08);
      EXPECT_GT(left.samples, 1500) << c.name;
      EXPECT_LE(left.worst, 1.25 * scallop + 0.002)
          << c.name << " " << angle << " at " << left.where.transpose();
      EXPECT_GE(left.worst, 0.6 * scallop) << c.name << " " << angle;
    }
  }
}

TEST(ZigzagPaths, WindowIsDilatedByHalfAStepAndNoMore) {
  const double radius = 3.0, ball = 10.0, scallop = 0.01;
  const Surface surface = JoinedSurface(Sphere(Vec3::Zero(), ball, Half::kUpper));
  const Locator locator(surface, radius);
  const ZigzagParams params = Params(scallop, 30);
  const auto paths = Zigzag(locator, params);
  const double step = CenterStep(radius, scallop, -1.0 / ball);
  const double limit = Radians(30);
  double steepest = 0;
  for (const auto& path : paths) {
    for (const auto& p : path.points) {
      const double slope = std::acos(p.center.z() / p.center.norm());
      steepest = std::max(steepest, slope);
    }
  }
  // Along the line by half a step, beside it by the next line at most.
  EXPECT_GE(steepest, limit + 0.45 * step / (ball + radius));
  EXPECT_LE(steepest, limit + 1.1 * step / (ball + radius));
}

TEST(ZigzagPaths, DomeStopsDishRollsToVertical) {
  const double radius = 2.0, half = 8.0;
  for (double a : {0.03, -0.03}) {
    const Surface surface = JoinedSurface(Paraboloid(a, half));
    const Locator locator(surface, radius);
    const auto paths = Zigzag(locator, Params(0.02, 60));
    // The line nearest to y = 0.
    const CutterPath* middle = nullptr;
    for (const auto& p : paths) {
      if (!middle || std::abs(p.points[0].center.y()) < std::abs(middle->points[0].center.y())) middle = &p;
    }
    ASSERT_TRUE(middle);
    const CutterPoint& end = middle->points.back();
    ASSERT_TRUE(end.contact);
    EXPECT_NEAR(end.contact->p.x(), half, 1e-6);
    if (a > 0) {
      EXPECT_NEAR(end.center.x(), half, 1e-3);  // stands right above the rim
    } else {
      const double slope = std::atan(2 * -a * half);  // stops on the surface normal, leaning outwards
      EXPECT_NEAR(end.center.x(), half + radius * std::sin(slope), 2e-3);
    }
  }
}

// A ball that rolls over an edge finishes nothing there.
TEST(ZigzagPaths, NothingButAnEdgeIsNoPass) {
  const auto lines_over = [](double degrees, double angle) {
    const Surface surface = JoinedSurface(TwoPlanes(-Radians(degrees), 12));
    const Locator locator(surface, 3.0);
    return Zigzag(locator, Params(0.01, 45.0, angle));
  };
  for (const double angle : {0.0, 0.7, 0.5 * kPi}) {
    EXPECT_TRUE(lines_over(60.0, angle).empty()) << angle;
    EXPECT_TRUE(lines_over(46.0, angle).empty()) << angle;
  }
  EXPECT_GT(lines_over(44.0, 0.0).size(), 20u);
}

// The top of a rib between two edges is a tenth of a millimetre wide. It counts as surface, however few
// probes fall on it: all lines that cross it have a piece there.
TEST(ZigzagPaths, SurfaceBetweenTwoEdgesKeepsItsLines) {
  const std::vector<Vec2> profile = {{-1.05, 0}, {-0.05, 2}, {0.05, 2}, {1.05, 0}};
  PatchModel rib;
  for (std::size_t k = 0; k + 1 < profile.size(); ++k) {
    const Vec2 &a = profile[k], &b = profile[k + 1];
    rib = Join({rib, Single(Bilinear({a.x(), -9, a.y()}, {b.x(), -9, b.y()}, {a.x(), 9, a.y()},
                                     {b.x(), 9, b.y()}))});
  }
  for (const double turned : {0.0, 0.3}) {
    const Eigen::Affine3d turn(Eigen::AngleAxisd(turned, Vec3::UnitZ()));
    const Surface surface = JoinedSurface(Transformed(rib, turn));
    const Locator locator(surface, 3.0);
    std::set<int> lines;
    for (const CutterPath& path : Zigzag(locator, Params(0.01, 45.0))) {
      const bool over_top = std::any_of(path.points.begin(), path.points.end(), [](const CutterPoint& p) {
        return p.contact && p.contact->p.z() > 2.0 - 1e-9;
      });
      if (over_top) lines.insert(path.order_key);
    }
    const double across = 18.0 * std::cos(turned) / CenterStep(3.0, 0.01, 0.0);
    EXPECT_GE(static_cast<double>(lines.size()), 0.9 * across) << turned;
  }
}

TEST(ZigzagPaths, NarrowSpotsGetPartialLines) {
  // A tilted gutter in a flat: only on the flanks of the gutter the step of the flat is too wide.
  const auto height = [](double x, double y) {
    return -4.0 * std::exp(-((x - 15) * (x - 15) + (y - 15) * (y - 15)) / 18);
  };
  const Surface surface = JoinedSurface(Single(InterpolatedHeights(height, 0, 30, 0, 30, 30, 30)));
  const Locator locator(surface, 2.0);
  const ZigzagParams params = Params(0.005, 60);
  const auto paths = Zigzag(locator, params);
  const double flat = CenterStep(2.0, 0.005, 0.0);
  std::size_t full = 0, partial = 0;
  for (std::size_t i = 0; i < paths.size(); ++i) {
    const Vec3 &from = paths[i].points.front().center, &to = paths[i].points.back().center;
    ++(to.x() - from.x() > 29 ? full : partial);
    for (std::size_t k = 0; k < i; ++k) {  // those beside it, of other lines
      const Vec3 &a = paths[k].points.front().center, &b = paths[k].points.back().center;
      if (paths[k].order_key == paths[i].order_key || a.x() >= to.x() || b.x() <= from.x()) continue;
      EXPECT_GE(from.y() - a.y(), 0.999 * params.pass.min_step_fraction * flat);
    }
  }
  EXPECT_GT(full, 20u);
  EXPECT_GT(partial, 5u);
  const Leftover left = Measure(surface, locator, paths, params.pass.window, 30000);
  EXPECT_LE(left.worst, 0.005 * 1.3 + 0.002) << left.where.transpose();
}

TEST(ZigzagPaths, FloorHeldPlacesAreNoPasses) {
  const Surface surface = JoinedSurface(Sphere(Vec3::Zero(), 10, Half::kUpper));
  const Locator locator(surface, 3.0);
  ZigzagParams params = Params(0.01, 90);
  params.pass.floor_z = 4.0;
  for (const auto& path : Zigzag(locator, params)) {
    for (const auto& p : path.points) {
      EXPECT_GE(p.center.z(), 7.0);
      if (p.contact) continue;
      // Within half a step of the circle where the sphere takes over.
      EXPECT_LE(Xy(p.center).norm(), std::sqrt(13.0 * 13 - 49) + 0.6);
    }
  }
}

TEST(ZigzagPaths, SameBytesForAnyThreadCount) {
  const Surface surface = JoinedSurface(RandomBspline(3));
  const Locator locator(surface, 2.0);
  const auto one = Zigzag(locator, Params(0.02, 45, 0.3), 1), two = Zigzag(locator, Params(0.02, 45, 0.3), 2);
  ASSERT_EQ(one.size(), two.size());
  for (std::size_t i = 0; i < one.size(); ++i) {
    ASSERT_EQ(one[i].points.size(), two[i].points.size());
    EXPECT_EQ(one[i].order_key, two[i].order_key);
    for (std::size_t k = 0; k < one[i].points.size(); ++k) {
      EXPECT_EQ(one[i].points[k].center, two[i].points[k].center);
    }
  }
}

TEST(ZigzagPaths, CancelIsObeyedAndEmptyWindowsGiveNothing) {
  const Surface surface = JoinedSurface(Plane(10));
  const Locator locator(surface, 3.0);
  RunContext run(1);
  run.Cancel();
  EXPECT_EQ(ZigzagPaths(locator, Params(0.01, 45), run).status().code(), absl::StatusCode::kCancelled);
  ZigzagParams steep = Params(0.01, 90);
  steep.pass.window.min = Radians(45);
  EXPECT_TRUE(Zigzag(locator, steep).empty());
}

// A rim: the upper part of a torus, of tube radius kTube, its axis at kAxis.
constexpr double kRim = 12.0, kTube = 5.0;
const Vec3 kAxis(4, -3, 0);

ZigzagParams AroundRim(double scallop) {
  ZigzagParams params = Params(scallop, 45);
  const double reach = kTube * std::sqrt(0.5);
  params.around = CircularLines{Xy(kAxis), kRim - reach, kRim + reach};
  return params;
}

TEST(ZigzagPaths, RoundLinesLieOnARimAtTheStepItNeeds) {
  const double radius = 3.0, scallop = 0.01, tube = kTube + radius;
  const Surface surface = JoinedSurface(Torus(kAxis, kRim, kTube, Half::kUpper));
  const Locator locator(surface, radius);
  const auto paths = Zigzag(locator, AroundRim(scallop));
  const double step = CenterStep(radius, scallop, -1.0 / kTube);  // on the circle of centres, radius `tube`
  const double gaps = std::ceil(tube * kPi / 2.0 / step);
  EXPECT_GE(paths.size(), static_cast<std::size_t>(gaps));
  EXPECT_LE(paths.size(), static_cast<std::size_t>(gaps) + 2);
  double last = -kPi / 4.0 - 1e-2;
  for (const CutterPath& path : paths) {
    EXPECT_TRUE(path.closed);
    EXPECT_EQ(path.kind, PassKind::kZigzag);
    double inner = kInfinity, outer = 0.0;
    for (const CutterPoint& p : path.points) {
      const double r = (Xy(p.center) - Xy(kAxis)).norm();
      inner = std::min(inner, r);
      outer = std::max(outer, r);
      EXPECT_NEAR(p.center.z(), std::sqrt(tube * tube - (r - kRim) * (r - kRim)), 2e-4 + 1e-6);
    }
    EXPECT_LE(outer - inner, 0.002);  // the chord tolerance
    const double angle = std::asin((outer - kRim) / tube);
    EXPECT_GT(angle, last);
    EXPECT_LE(tube * (angle - last), 1.02 * step + 0.002);
    last = angle;
  }
  EXPECT_NEAR(last, kPi / 4.0, 1e-2);
  const Leftover left = Measure(surface, locator, paths, {0, Radians(44)}, 20000);
  EXPECT_GT(left.samples, 5000);
  EXPECT_LE(left.worst, scallop + 0.002);
  EXPECT_GE(left.worst, 0.8 * scallop);
}

// Passes that run beside both limits of the rim finish the surface up to half a step from the limit.
TEST(ZigzagPaths, RoundLinesKeepAStepFromPassesBesideThem) {
  const double radius = 3.0, scallop = 0.01, tube = kTube + radius;
  const Surface surface = JoinedSurface(Torus(kAxis, kRim, kTube, Half::kUpper));
  const Locator locator(surface, radius);
  const double step = CenterStep(radius, scallop, -1.0 / kTube);
  const auto beside = [&](double gap) {  // mm from the limits, outside
    std::vector<CutterPath> circles;
    for (const double side : {-1.0, 1.0}) {
      const double angle = side * (kPi / 4.0 + gap / tube), across = kRim + tube * std::sin(angle);
      CutterPath& circle = circles.emplace_back();
      circle.closed = true;
      for (int k = 0; k < 720; ++k) {
        const double a = kPi * k / 360;
        circle.points.push_back(
            {kAxis + Vec3(across * std::cos(a), across * std::sin(a), tube * std::cos(angle)), {}, {}});
      }
    }
    return circles;
  };
  ZigzagParams params = AroundRim(scallop);
  const std::size_t alone = Zigzag(locator, params).size();
  for (const double gap : {0.1, 0.5}) {
    const std::vector<CutterPath> known = beside(gap * step);
    const SegmentTree tree(MovesOf(known), Metric::kPath, radius, RunContext());
    params.beside = &tree;
    const auto paths = Zigzag(locator, params);
    EXPECT_LT(paths.size(), alone) << gap;
    EXPECT_GE(paths.size() + 2, alone) << gap;
    const auto angle_of = [&](const CutterPath& path) {
      return std::asin(((Xy(path.points.front().center) - Xy(kAxis)).norm() - kRim) / tube);
    };
    const double from = tube * (angle_of(paths.front()) + kPi / 4.0) + gap * step,
                 to = tube * (kPi / 4.0 - angle_of(paths.back())) + gap * step;
    EXPECT_LE(std::max(from, to), step) << gap;
    EXPECT_GE(std::min(from, to), 0.9 * step) << gap;
    std::vector<CutterPath> all = paths;
    all.insert(all.end(), known.begin(), known.end());
    const Leftover left = Measure(surface, locator, all, {0, Radians(45)}, 20000);
    EXPECT_LE(left.worst, scallop + 0.002) << gap;
  }
  // Too far away to help.
  const std::vector<CutterPath> far = beside(1.1 * step);
  const SegmentTree tree(MovesOf(far), Metric::kPath, radius, RunContext());
  params.beside = &tree;
  EXPECT_EQ(Zigzag(locator, params).size(), alone);
}

// Three quarters of the rim, turned: where angles begin again is no place of the part.
TEST(ZigzagPaths, RoundLinesDoNotSeeWhereTheyBegin) {
  PatchModel sector = Torus(Vec3::Zero(), kRim, kTube, Half::kUpper);
  std::erase_if(sector.patches, [](const Patch& patch) {
    const auto& points = std::get<BezierPatch>(patch.shape).points;
    return std::all_of(points.begin(), points.end(),
                       [](const Vec3& p) { return p.x() > -1e-9 && p.y() > -1e-9; });
  });
  ASSERT_EQ(sector.patches.size(), 6u);
  std::vector<double> lengths;
  for (const double turn : {0.0, 0.7, 2.2, 4.0}) {
    Eigen::Affine3d motion(Eigen::AngleAxisd(turn, Vec3::UnitZ()));
    motion.pretranslate(kAxis);
    const Surface surface = JoinedSurface(Transformed(sector, motion));
    const Locator locator(surface, 3.0);
    std::vector<double> now;
    for (const CutterPath& path : Zigzag(locator, AroundRim(0.02))) {
      EXPECT_FALSE(path.closed);
      now.push_back(Length(path));
    }
    ASSERT_GT(now.size(), 8u);
    if (lengths.empty()) lengths = now;
    ASSERT_EQ(now.size(), lengths.size()) << turn;
    // Corners lie elsewhere on the circles: up to one chord's difference at an end.
    for (std::size_t i = 0; i < now.size(); ++i) EXPECT_NEAR(now[i], lengths[i], 2e-2) << turn;
  }
}

// A rim that is narrower in one place: partial lines there, each once, wherever angles begin.
TEST(ZigzagPaths, PartialRoundLinesAreCutOnce) {
  std::vector<double> lengths;
  for (const double turn : {0.0, 0.15, 2.0, -0.15}) {
    const auto height = [&](double x, double y) {
      const double r = std::hypot(x, y), d = std::remainder(std::atan2(y, x) - turn, 2.0 * kPi);
      const double bump = std::exp(-d * d / 0.08);
      return -0.5 * (0.02 + 0.3 * bump) * (r - 12.0) * (r - 12.0);
    };
    const Surface surface = JoinedSurface(Single(InterpolatedHeights(height, -18, 18, -18, 18, 60, 60)));
    const Locator locator(surface, 3.0);
    ZigzagParams params = Params(0.01, 45);
    params.around = CircularLines{{0, 0}, 9, 15};
    double length = 0.0;
    std::size_t partial = 0;
    std::vector<std::pair<Vec2, Vec2>> ends;
    for (const CutterPath& path : Zigzag(locator, params)) {
      length += Length(path);
      if (path.closed) continue;
      ++partial;
      ends.emplace_back(Xy(path.points.front().center), Xy(path.points.back().center));
    }
    for (std::size_t i = 0; i < ends.size(); ++i) {
      for (std::size_t k = 0; k < i; ++k)
        EXPECT_GT((ends[i].first - ends[k].first).norm() + (ends[i].second - ends[k].second).norm(), 0.05)
            << turn;
    }
    EXPECT_GT(partial, 2u) << turn;
    lengths.push_back(length);
  }
  for (const double length : lengths) EXPECT_NEAR(length, lengths[0], 0.03 * lengths[0]);
}

}  // namespace
}  // namespace patchmill
