// Chords that closed forms accept, judged by the swept query, which knows nothing of stations or contacts.
#include <vector>

#include <gtest/gtest.h>

#include "cam/path/chord/chord_bounds.h"
#include "cam/path/chord/segment_trace.h"
#include "tests/support/random.h"
#include "tests/support/shapes.h"
#include "tests/support/surface_of.h"

namespace patchmill {
namespace {

using testing::Random;
using testing::SurfaceOf;

struct Tally {
  int chords = 0;
  int accepted = 0;  // of more than one step
  int longest = 0;   // steps
};

// Random lines; on each, chords from station to station, as far as certified stations prove them.
void Judge(const PatchModel& model, double radius, std::uint64_t seed, Tally& tally) {
  const Surface surface = SurfaceOf(model);
  const Locator locator(surface, radius);
  Random random(seed);
  const Box3& box = surface.box;
  const double tolerance = 0.01;
  const auto place = [&] {
    const double x = random.Uniform(box.min.x(), box.max.x());
    return Vec2(x, random.Uniform(box.min.y(), box.max.y()));
  };
  for (int line = 0; line < 4; ++line) {
    const SegmentTraceParams trace{.chord_tolerance = tolerance * random.Uniform(0.2, 1.0),
                                   .certificate_gap = 1e-5};
    const Vec2 from = place(), to = place();
    for (const auto& stations : TraceSegment(locator, XyLine::Through(from, to), trace)) {
      std::vector<Vec3> free;
      for (const TraceStation& s : stations) {
        ASSERT_LT(s.ceiling, kInfinity);
        ASSERT_GE(s.ceiling, s.z);
        ASSERT_LE(s.ceiling, s.z + 1.1e-5);
        free.push_back(Lift(s.q, s.ceiling));
      }
      for (std::size_t i = 0; i + 1 < free.size(); i += 3) {
        for (std::size_t j = i + 1; j < free.size() && j <= i + 24; j += 1 + (j - i) / 2) {
          ++tally.chords;
          const Vec3 &a = free[i], &b = free[j];
          const double bound = ChordGouge(radius, a, b, {free.data() + i, j - i + 1});
          if (bound > tolerance) continue;
          if (j > i + 1) ++tally.accepted;
          tally.longest = std::max(tally.longest, static_cast<int>(j - i));
          ASSERT_LE(locator.SweptGouge(a, b, 1e-6), bound + 1.1e-6) << seed << " " << i << " " << j;
          ASSERT_TRUE(locator.GougeWithin(a, b, tolerance, 0.05 * tolerance)) << seed << " " << i << " " << j;
        }
      }
    }
  }
}

TEST(ChordProof, WhatStationsAcceptTheSurfaceAccepts) {
  Tally splines, others;
  for (std::uint64_t seed = 0; seed < 8; ++seed) {
    Judge(testing::RandomBspline(seed, {.folds = seed % 4 == 3, .rational = seed % 2 == 1}), 3.0, seed,
          splines);
    Judge(testing::Single(testing::RandomGregory(seed, GregoryPatch::Blend::kEdge)), 1.5, seed, others);
    Judge(testing::Single(testing::RandomKnots(seed, 3, 3, seed % 2 == 0)), 1.0, seed, others);
  }
  Judge(testing::Block(8.0, 6.0, 20.0), 3.0, 20, others);
  Judge(testing::TwoPlanes(Radians(50), 15.0), 3.0, 21, others);
  Judge(testing::TwoPlanes(Radians(-40), 15.0), 3.0, 22, others);
  Judge(testing::Torus(Vec3(0, 0, 0), 10.0, 4.0), 3.0, 23, others);
  Judge(testing::ParabolicValley(0.1, 10.0), 3.0, 24, others);
  EXPECT_GT(splines.accepted, 500) << "of " << splines.chords;
  EXPECT_GT(others.accepted, 500) << "of " << others.chords;
  EXPECT_GE(std::max(splines.longest, others.longest), 16);
}

}  // namespace
}  // namespace patchmill
