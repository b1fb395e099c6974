// The verifier against dense sampling that shares nothing with it but the evaluation of the surface.
#include <cmath>

#include "cam/limits/reach_tolerance.h"
#include "cam/toolpath/segment_metric.h"
#include "cam/verify/reach.h"
#include "core/surface/closest.h"
#include "tests/cam/verify/verify_models.h"
#include "tests/support/random.h"

namespace patchmill {
namespace {

using namespace testing;  // NOLINT: the support folder's

// Passes over a random surface, guided only roughly: some gouge, some leave material.
std::string RandomProgram(Random& random, double size, double top) {
  ProgramText text(top + 10.0);
  for (double y = 0.0; y <= size; y += random.Uniform(0.6, 1.4)) {
    std::vector<Vec3> points;
    for (double x = 0.0; x <= size; x += random.Uniform(0.3, 2.0)) {
      points.emplace_back(x, y, random.Uniform(-1.0, 1.5));
    }
    text.Pass(points);
  }
  return text.End();
}

TEST(VerifyRandom, MaximaBoundDenseSamples) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    Random random(seed);
    const double size = 12.0, r = random.Uniform(0.7, 3.0);
    const Surface surface = SurfaceOf(RandomBspline(
        seed,
        {.spans = 4, .size = size, .amplitude = 1.5, .folds = seed % 3 == 0, .rational = seed % 2 == 0}));
    const std::string program = RandomProgram(random, size, surface.box.max.z());
    VerifyParams params;
    params.tolerance = 0.01;
    params.certainty = 2e-3;
    params.stock_top_z = surface.box.max.z() + 1.0;
    const VerifyReport report = Judged(surface, Ball(r), program, params);

    std::vector<PathSegment> cut, swept;
    for (const ProgramMove& m : Motion(program).moves) {
      if (m.from_above && m.to_above) continue;
      PathSegment s{m.from + Vec3(0, 0, r), m.to + Vec3(0, 0, r), 0};
      if (m.from_above) s.a.z() = s.b.z();
      if (m.to_above) s.b.z() = s.a.z();
      swept.push_back(s);
      if (m.kind == ProgramMove::Kind::kFeed) cut.push_back(s);
    }
    double gouge = 0.0, leftover = 0.0, reachable = 0.0, total = 0.0;
    for (const Piece& piece : surface.pieces) {
      const int n = 14;
      for (int i = 0; i < n; ++i) {
        for (int j = 0; j < n; ++j) {
          const SurfaceJet jet = Evaluate(piece, (i + 0.5) / n, (j + 0.5) / n);
          const auto facing = FacingAt(jet);
          ASSERT_TRUE(facing.has_value());
          double d_swept = kInfinity, d_cut = kInfinity;
          for (const PathSegment& s : swept) d_swept = std::min(d_swept, SweptDistance(s, jet.p));
          for (const PathSegment& s : cut) d_cut = std::min(d_cut, PathDistance(s, jet.p));
          gouge = std::max(gouge, r - d_swept);
          const double area = jet.du.cross(jet.dv).norm() / (n * n);
          total += area;
          if (ReachAt(surface, jet.p, *facing, {r, ReachTolerance(params.tolerance)}) !=
              ReachClass::kReachable)
            continue;
          reachable += area;
          leftover = std::max(leftover, d_cut - r);
        }
      }
    }
    EXPECT_LE(gouge, report.max_gouge + params.certainty) << seed;
    EXPECT_LE(leftover, report.max_leftover + params.certainty) << seed;
    EXPECT_NEAR(report.total_area, total, 0.005 * total) << seed;
    EXPECT_NEAR(report.reachable_area, reachable, 0.01 * total) << seed;
    // The maxima are attained where the report says, and the leftover's place is reachable.
    const auto distance = [](const std::vector<PathSegment>& segments, const Vec3& p, auto metric) {
      double least = kInfinity;
      for (const PathSegment& s : segments) least = std::min(least, metric(s, p));
      return least;
    };
    EXPECT_NEAR(r - distance(swept, report.max_gouge_at.point, SweptDistance), report.max_gouge, 1e-9)
        << seed;
    EXPECT_NEAR(distance(cut, report.max_leftover_at.point, PathDistance) - r, report.max_leftover, 1e-9)
        << seed;
    const auto at = ClosestToPoint(surface, report.max_leftover_at.point, kInfinity, 1e-9);
    ASSERT_TRUE(at.has_value());
    EXPECT_LE(at->distance, 1e-8);
    const auto facing = FacingAt(Evaluate(surface, at->at.piece, at->at.u, at->at.v));
    ASSERT_TRUE(facing.has_value());
    EXPECT_EQ(ReachAt(surface, at->at.p, *facing, {r, ReachTolerance(params.tolerance) * 1.001}),
              ReachClass::kReachable)
        << seed;
  }
}

TEST(VerifyRandom, SameReportForOneAndTwoThreads) {
  Random random(3);
  const Surface surface = SurfaceOf(RandomBspline(3, {.spans = 4, .size = 12.0, .amplitude = 1.5}));
  const std::string program = RandomProgram(random, 12.0, surface.box.max.z());
  VerifyParams params;
  params.finish.scallop = 0.02;
  params.stock_top_z = surface.box.max.z() + 1.0;
  const VerifyReport one = Judged(surface, Ball(1.5), program, params, 1);
  const VerifyReport two = Judged(surface, Ball(1.5), program, params, 2);
  EXPECT_EQ(one.max_gouge, two.max_gouge);
  EXPECT_EQ(one.max_leftover, two.max_leftover);
  EXPECT_EQ(one.max_gouge_at.point, two.max_gouge_at.point);
  EXPECT_EQ(one.max_leftover_at.line, two.max_leftover_at.line);
  EXPECT_EQ(one.reachable_area, two.reachable_area);
  EXPECT_EQ(one.unreachable_area, two.unreachable_area);
  EXPECT_EQ(Findings(one), Findings(two));
}

}  // namespace
}  // namespace patchmill
