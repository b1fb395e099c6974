#include "cam/toolpath/segment_tree.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "cam/toolpath/cutter_path.h"
#include "tests/support/random.h"

namespace patchmill {
namespace {

using testing::Random;

constexpr double kShankRadius = 2.0;

double PathBySampling(const PathSegment& s, const Vec3& p, int n) {
  double least = kInfinity;
  for (int i = 0; i <= n; ++i) least = std::min(least, (s.a + (s.b - s.a) * (double(i) / n) - p).norm());
  return least;
}

double SweptBySampling(const PathSegment& s, const Vec3& p, int n) {
  double least = kInfinity;
  for (int i = 0; i <= n; ++i) {
    const Vec3 c = s.a + (s.b - s.a) * (double(i) / n);
    const Vec3 d(c.x() - p.x(), c.y() - p.y(), std::max(0.0, c.z() - p.z()));
    least = std::min(least, d.norm());
  }
  return least;
}

double SweptBoxBySampling(const PathSegment& s, const Vec3& p, int n) {
  double least = kInfinity;
  const double z = std::min(s.a.z(), s.b.z());
  for (int i = 0; i <= n; ++i) {
    for (int j = 0; j <= n; ++j) {
      const double x = s.a.x() + (s.b.x() - s.a.x()) * i / n, y = s.a.y() + (s.b.y() - s.a.y()) * j / n;
      least = std::min(least, Vec3(x - p.x(), y - p.y(), std::max(0.0, z - p.z())).norm());
    }
  }
  return least;
}

double ShankBySampling(const PathSegment& s, const Vec3& p, double r, int n) {
  double least = kInfinity;
  for (int i = 0; i <= n; ++i) {
    const Vec3 c = s.a + (s.b - s.a) * (double(i) / n);
    least = std::min(least, std::max(Xy(Vec3(c - p)).norm(), r - (p.z() - c.z())));
  }
  return least;
}

std::vector<PathSegment> RandomSegments(Random& random, int n) {
  std::vector<PathSegment> segments;
  for (int i = 0; i < n; ++i) {
    PathSegment s;
    s.a = random.Point(-10, 10);
    s.b = s.a + random.Point(-3, 3);
    if (i % 7 == 0) s.b = s.a;
    if (i % 7 == 1) s.b = s.a + Vec3(0, 0, random.Uniform(-3, 3));
    if (i % 7 == 2) s.b.z() = s.a.z();
    s.move = i;
    segments.push_back(s);
  }
  return segments;
}

TEST(SegmentMetric, EqualsSampling) {
  Random random(11);
  for (const PathSegment& s : RandomSegments(random, 400)) {
    const Vec3 p = s.a + random.Point(-5, 5);
    const double step = 2.0 * (s.b - s.a).norm() / 4000.0;
    EXPECT_NEAR(PathDistance(s, p), PathBySampling(s, p, 4000), step);
    EXPECT_NEAR(SweptDistance(s, p), SweptBySampling(s, p, 4000), step);
    EXPECT_NEAR(SweptBoxDistance(s, p), SweptBoxBySampling(s, p, 60), 4000.0 / 60.0 * step);
    EXPECT_LE(SweptBoxDistance(s, p), SweptDistance(s, p) + 1e-12);
    EXPECT_NEAR(ShankDistance(s, p, 2.0), ShankBySampling(s, p, 2.0, 4000), step);
    EXPECT_LE(SweptDistance(s, p), PathDistance(s, p) + 1e-12);
    // The gradients support the convex functions from below.
    for (int k = 0; k < 20; ++k) {
      const Vec3 q = p + random.Point(-4, 4);
      const MetricValue f = PathDistanceAndGradient(s, p), g = SweptDistanceAndGradient(s, p);
      const MetricValue b = SweptBoxDistanceAndGradient(s, p);
      EXPECT_GE(SweptBoxDistance(s, q), b.distance + b.gradient.dot(q - p) - 1e-9);
      const MetricValue h = ShankDistanceAndGradient(s, p, 2.0);
      const MetricValue m = ShankBoxDistanceAndGradient(s, p, 2.0);
      EXPECT_GE(ShankBoxDistance(s, q, 2.0), m.distance + m.gradient.dot(q - p) - 1e-9);
      // Over the rectangle is nowhere farther than over the move, and the same over one along an axis.
      EXPECT_LE(m.distance, h.distance + 1e-12);
      const PathSegment level{s.a, Vec3(s.b.x(), s.a.y(), s.a.z()), 0};
      EXPECT_NEAR(ShankBoxDistance(level, p, 2.0), ShankDistance(level, p, 2.0), 1e-9);
      EXPECT_GE(PathDistance(s, q), f.distance + f.gradient.dot(q - p) - 1e-9);
      EXPECT_GE(SweptDistance(s, q), g.distance + g.gradient.dot(q - p) - 1e-9);
      EXPECT_GE(ShankDistance(s, q, 2.0), h.distance + h.gradient.dot(q - p) - 1e-9);
    }
  }
}

double Measure(Metric metric, const PathSegment& s, const Vec3& p) {
  return metric == Metric::kPath       ? PathDistance(s, p)
         : metric == Metric::kSwept    ? SweptDistance(s, p)
         : metric == Metric::kSweptBox ? SweptBoxDistance(s, p)
         : metric == Metric::kShankBox ? ShankBoxDistance(s, p, kShankRadius)
                                       : ShankDistance(s, p, kShankRadius);
}

// Single precision, in which boxes are compared, is coarse far from the origin.
class SegmentTreeAt : public ::testing::TestWithParam<double> {};

TEST_P(SegmentTreeAt, EqualsBruteForce) {
  Random random(12);
  const Vec3 far(GetParam(), -0.7 * GetParam(), 0.3 * GetParam());
  for (const Metric metric :
       {Metric::kPath, Metric::kSwept, Metric::kSweptBox, Metric::kShank, Metric::kShankBox}) {
    for (const int n : {1, 2, 3, 4, 5, 8, 9, 16, 17, 63, 300, 2000}) {
      std::vector<PathSegment> segments = RandomSegments(random, n);
      if (n == 63) std::fill(segments.begin() + 20, segments.end(), segments[5]);  // one move many times
      for (PathSegment& s : segments) {
        s.a += far;
        s.b += far;
      }
      const SegmentTree tree(segments, metric, kInfinity, RunContext(1), kShankRadius);
      int hint = -1;
      for (int i = 0; i < 200; ++i) {
        SCOPED_TRACE(::testing::Message()
                     << "metric " << int(metric) << ", " << n << " segments, query " << i);
        // Some on a segment, where rounding is all there is.
        const PathSegment& own = segments[static_cast<std::size_t>(i % n)];
        const Vec3 p = i % 5 == 0 ? Vec3(0.25 * own.a + 0.75 * own.b) : far + random.Point(-14, 14);
        std::vector<double> all;
        for (const PathSegment& s : segments) all.push_back(Measure(metric, s, p));
        const double least = *std::min_element(all.begin(), all.end());
        const double rounding = 1e-15 * (30.0 + far.norm());
        const auto nearest = tree.FindNearest(p, kInfinity, i % 3 == 0 ? hint : -1);
        ASSERT_GE(nearest.segment, 0);
        ASSERT_NEAR(nearest.distance, least, rounding);
        EXPECT_EQ(nearest.distance, tree.Distance(nearest.segment, p));
        EXPECT_EQ(nearest.distance, Measure(metric, tree.segment(nearest.segment), p));
        EXPECT_EQ(tree.FindNearest(p, least - rounding, -1).segment, -1);
        EXPECT_LE(tree.FindNearest(p, kInfinity, -1, 0.02).distance * 0.98, least + rounding);
        hint = nearest.segment;

        std::vector<int> within, expected, moves;
        const double limit = least + (i % 2 == 0 ? 1.0 : 1e-3);
        tree.FindWithin(p, limit, within);
        for (const int k : within) moves.push_back(tree.segment(k).move);
        for (std::size_t k = 0; k < all.size(); ++k) {
          if (all[k] < limit) expected.push_back(segments[k].move);
        }
        std::sort(moves.begin(), moves.end());
        std::sort(expected.begin(), expected.end());
        EXPECT_EQ(moves, expected);
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(FromTheOrigin, SegmentTreeAt, ::testing::Values(0.0, 1e3, 1e6));

TEST(SegmentTree, CutsLongSegmentsAndIsRightWithoutAnOrder) {
  Random random(13);
  const std::vector<PathSegment> segments = RandomSegments(random, 200);
  RunContext cancelled(1);
  cancelled.Cancel();
  const SegmentTree cut(segments, Metric::kPath, 0.5, RunContext(1));
  const SegmentTree unsorted(segments, Metric::kPath, 0.5, cancelled);
  std::vector<int> all;
  cut.FindWithin(Vec3::Zero(), 1e9, all);
  EXPECT_GT(all.size(), 400U);
  for (const int k : all) EXPECT_LE((cut.segment(k).b - cut.segment(k).a).norm(), 0.5 + 1e-12);
  for (int i = 0; i < 500; ++i) {
    const Vec3 p = random.Point(-14, 14);
    double least = kInfinity;
    for (const PathSegment& s : segments) least = std::min(least, PathDistance(s, p));
    EXPECT_NEAR(cut.FindNearest(p, kInfinity).distance, least, 1e-13);
    EXPECT_NEAR(unsorted.FindNearest(p, kInfinity).distance, least, 1e-13);
  }
}

TEST(SegmentTree, OfNothingHasNothing) {
  const SegmentTree tree({}, Metric::kPath, 1.0, RunContext(1));
  EXPECT_TRUE(tree.empty());
  EXPECT_EQ(tree.FindNearest(Vec3::Zero(), kInfinity).segment, -1);
  std::vector<int> found = {7};
  tree.FindWithin(Vec3::Zero(), 10.0, found);
  EXPECT_TRUE(found.empty());
}

TEST(MovesOf, JoinsThePointsOfEachPass) {
  const Vec3 a(0, 0, 0), b(1, 0, 0), c(1, 1, 0);
  const auto pass = [](std::initializer_list<Vec3> centers, bool closed) {
    CutterPath path;
    path.closed = closed;
    for (const Vec3& center : centers) path.points.push_back({center, {}, {}});
    return path;
  };
  const auto moves =
      MovesOf({pass({a, b, c}, false), pass({}, false), pass({c}, true), pass({a, b, c}, true)});
  const std::vector<std::pair<Vec3, Vec3>> expected = {{a, b}, {b, c}, {c, c}, {a, b}, {b, c}, {c, a}};
  ASSERT_EQ(moves.size(), expected.size());
  for (std::size_t i = 0; i < moves.size(); ++i) {
    EXPECT_EQ(moves[i].a, expected[i].first) << i;
    EXPECT_EQ(moves[i].b, expected[i].second) << i;
  }
}

}  // namespace
}  // namespace patchmill
