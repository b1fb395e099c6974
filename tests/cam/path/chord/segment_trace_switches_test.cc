// Contact switches of a traced line: solved, kept, real, none missed, and the same however the part is cut.
#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "cam/path/chord/scan_line.h"
#include "cam/path/chord/segment_trace.h"
#include "core/joining/join_network.h"
#include "tests/support/files.h"
#include "tests/support/random.h"
#include "tests/support/same_part.h"
#include "tests/support/shapes.h"
#include "tests/support/surface_of.h"

namespace patchmill {
namespace {

using testing::Random;
using testing::SurfaceOf;
using Runs = std::vector<std::vector<TraceStation>>;

constexpr double kTolerance = 0.01;

bool IsSwitch(const TraceStation& s, double radius) {
  return s.keep && s.left && s.right && (s.left->p - s.right->p).norm() > 1e-3 * radius;
}

std::vector<TraceStation> Switches(const Runs& runs, double radius) {
  std::vector<TraceStation> found;
  for (const auto& run : runs) {
    std::copy_if(run.begin(), run.end(), std::back_inserter(found),
                 [&](const TraceStation& s) { return IsSwitch(s, radius); });
  }
  return found;
}

XyLine RandomLine(const Surface& surface, Random& random) {
  const Box3& box = surface.box;
  const auto place = [&] {
    const double x = random.Uniform(box.min.x(), box.max.x());
    return Vec2(x, random.Uniform(box.min.y(), box.max.y()));
  };
  const Vec2 a = place();
  return XyLine::Through(a, place());
}

struct Tally {
  int switches = 0, jumps = 0;
  int passed = 0;  // jumps that a chord passes over within the tolerance
};

void Judge(const PatchModel& model, double radius, std::uint64_t seed, int lines, Tally& tally) {
  const Surface surface = SurfaceOf(model);
  const Locator locator(surface, radius), larger(surface, radius + kTolerance + 1e-7);
  Random random(seed);
  for (int i = 0; i < lines; ++i) {
    SCOPED_TRACE(::testing::Message() << "seed " << seed << " line " << i);
    const XyLine line = RandomLine(surface, random);
    const Runs runs = TraceSegment(locator, line, {.chord_tolerance = kTolerance});
    const std::vector<TraceStation> switches = Switches(runs, radius);
    for (const TraceStation& s : switches) {
      ++tally.switches;
      const Vec3 c = Lift(s.q, s.z);
      // Both contacts carry the ball there: solved.
      EXPECT_NEAR((c - s.left->p).norm(), radius, 1e-9) << s.t;
      EXPECT_NEAR((c - s.right->p).norm(), radius, 1e-9) << s.t;
      // Real: a micron before, the left one is in force, a micron after, the right one.
      const auto before = locator.Height(line.At(s.t - 1e-6)), after = locator.Height(line.At(s.t + 1e-6));
      ASSERT_TRUE(before && after);
      EXPECT_LT((before->contact.p - s.left->p).norm(), 1e-3 * radius) << s.t;
      EXPECT_LT((after->contact.p - s.right->p).norm(), 1e-3 * radius) << s.t;
    }
    // None missed: where the contact of neighbouring samples jumps, h does not, and the branch before is
    // lower than the one behind, a switch (or more) lies between, or a chord that passes it within the
    // tolerance.
    const int samples = static_cast<int>(line.length / (2e-3 * radius));
    std::optional<CenterPoint> last;
    for (int k = 0; k <= samples; ++k, last = std::nullopt) {
      const double t0 = line.length * (k - 1) / samples, t = line.length * k / samples;
      if (k > 0) last = locator.Height(line.At(t0));
      const auto h = locator.Height(line.At(t));
      if (!h || !last || (h->contact.p - last->contact.p).norm() < 0.1 * radius) continue;
      const auto followed = locator.Follow(last->contact, line.At(t));
      if (!followed || followed->z > h->z - 1e-7) continue;
      ++tally.jumps;
      const bool solved = std::any_of(switches.begin(), switches.end(), [&](const TraceStation& s) {
        return s.t > t0 - 1e-9 && s.t < t + 1e-9;
      });
      if (solved) continue;
      ++tally.passed;
      for (const auto& run : runs) {
        for (std::size_t n = 0; n + 1 < run.size(); ++n) {
          const TraceStation &a = run[n], &b = run[n + 1];
          if (t < a.t || t > b.t) continue;
          const double z = a.z + (t - a.t) / (b.t - a.t) * (b.z - a.z);
          EXPECT_FALSE(larger.Free(Lift(line.At(t), z), -1e-9)) << "no switch in " << t0 << " " << t;
        }
      }
    }
    // Kept: each is a vertex of the line.
    PassParams params;
    params.chord_tolerance = kTolerance;
    const auto scanned = ScanLine(locator, line.At(0.0), line.At(line.length), params);
    std::vector<Vec2> vertices;
    for (const ScanRun& run : scanned) {
      for (const CutterPoint& p : run.points) {
        if (p.contact && p.other_contact) vertices.push_back(Xy(p.center));
      }
    }
    const SegmentTraceParams same{.chord_tolerance = kTolerance - 1e-4, .certificate_gap = 1e-4};
    for (const TraceStation& s : Switches(TraceSegment(locator, line, same), radius)) {
      EXPECT_TRUE(std::any_of(vertices.begin(), vertices.end(), [&](const Vec2& v) {
        return (v - s.q).norm() < 1e-9;
      })) << s.t;
    }
  }
}

TEST(LineSwitches, AreSolvedRealKeptAndNoneIsMissed) {
  Tally tally;
  for (std::uint64_t seed = 0; seed < 6; ++seed) {
    Judge(testing::RandomBspline(seed, {.spans = 12, .size = 30, .amplitude = 6, .rational = seed % 2 == 1}),
          3.0, seed, 4, tally);
  }
  Judge(testing::TwoSpheres(6.0, 10.0), 3.0, 10, 10, tally);
  Judge(testing::TwoPlanes(Radians(35), 15.0), 3.0, 11, 10, tally);
  Placement ring;
  ring.scale = 40.0;
  Judge(Place(ring, testing::LoadModel("tests/models/toroidal_tet.patches")), 3.0, 12, 10, tally);
  EXPECT_GT(tally.switches, 50);
  EXPECT_GT(tally.jumps, 50);
  EXPECT_LT(tally.passed, tally.jumps / 4);
}

TEST(LineSwitches, AreTheSameHoweverThePartIsCut) {
  const double radius = 3.0;
  std::size_t count = 0;
  for (std::uint64_t seed = 20; seed < 22; ++seed) {
    const PatchModel model = testing::RandomBspline(seed, {.spans = 12, .size = 30, .amplitude = 8});
    std::vector<std::vector<double>> first;
    for (const testing::SamePart& part : testing::ManyWays(model)) {
      SCOPED_TRACE(part.name);
      const Surface surface = SurfaceOf(part.model);
      const Locator locator(surface, radius);
      Random random(seed);
      const Vec2 shift = Xy(part.shift);
      std::vector<std::vector<double>> all;
      for (int i = 0; i < 4; ++i) {
        const Vec2 a(random.Uniform(1, 29), random.Uniform(1, 29)),
            b(random.Uniform(1, 29), random.Uniform(1, 29));
        const XyLine line = XyLine::Through(a + shift, b + shift);
        std::vector<double> t;
        for (const TraceStation& s :
             Switches(TraceSegment(locator, line, {.chord_tolerance = kTolerance}), radius)) {
          t.push_back(s.t);
        }
        all.push_back(t);
      }
      if (first.empty()) first = all;
      for (std::size_t i = 0; i < all.size(); ++i) {
        ASSERT_EQ(all[i].size(), first[i].size()) << "seed " << seed << " line " << i;
        count += all[i].size();
        for (std::size_t k = 0; k < all[i].size(); ++k) EXPECT_NEAR(all[i][k], first[i][k], 1e-7);
      }
    }
  }
  EXPECT_GT(count, 70u);
}

// Surfaces that the ball follows everywhere. Joints of patches that it crosses are no contact switches.
class NoneOnSmoothSheet {
 public:
  explicit NoneOnSmoothSheet(PatchModel model) : surface_(SurfaceOf(std::move(model))) {}

  // Lines within `middle` +- `reach`, each way.
  void Cross(const Vec2& middle, double reach, int lines, std::uint64_t seed) {
    const Locator locator(surface_, kRadius);
    Random random(seed);
    const auto place = [&]() -> Vec2 {
      const double x = random.Uniform(-reach, reach);
      return middle + Vec2(x, random.Uniform(-reach, reach));
    };
    for (int i = 0; i < lines; ++i) {
      SCOPED_TRACE(::testing::Message() << "line " << i);
      const Vec2 a = place();
      const XyLine line = XyLine::Through(a, place());
      const Runs runs = TraceSegment(locator, line, {.chord_tolerance = kTolerance});
      EXPECT_TRUE(Switches(runs, kRadius).empty());
      for (const auto& run : runs) CountJoints(run);
    }
  }

  int joints() const { return joints_; }  // crossed so far

 private:
  void CountJoints(const std::vector<TraceStation>& run) {
    for (std::size_t n = 0; n + 1 < run.size(); ++n) {
      ASSERT_TRUE(run[n].hint && run[n + 1].hint);
      joints_ += surface_.piece(run[n].hint->piece).patch != surface_.piece(run[n + 1].hint->piece).patch;
    }
    // Nothing but its ends is kept.
    for (std::size_t n = 1; n + 1 < run.size(); ++n) EXPECT_FALSE(run[n].keep) << run[n].t;
  }

  static constexpr double kRadius = 3.0;
  Surface surface_;
  int joints_ = 0;
};

TEST(LineSwitches, NoneOnSmoothSheetCutIntoAThousandPatches) {
  const PatchModel model = testing::AsBezierPatches(testing::TwoHills());
  ASSERT_GT(model.patches.size(), 1000u);
  NoneOnSmoothSheet sheet(model);
  sheet.Cross({50, 50}, 50, 20, 5);
  EXPECT_GT(sheet.joints(), 200);
}

// A gentle sheet of 8 x 8 fields joined with equal tangent planes: Gregory quads, and where `triangles` says
// so, two triangles. It bends by 1/20 mm at most.
PatchModel GentleSheet(PatchScheme quads, PatchScheme triangles, int triangles_every) {
  constexpr int kFields = 8;
  constexpr double kField = 6.0, kHeight = 2.0, kWave = 2.0 * kPi / 40.0;
  CurveNetwork network;
  Random random(3);
  for (int i = 0; i <= kFields; ++i) {
    for (int k = 0; k <= kFields; ++k) {
      const Vec2 q = kField * Vec2(i, k) + Vec2(random.Uniform(-1, 1), random.Uniform(-1, 1));
      const double x = kWave * q.x(), y = kWave * q.y();
      NetworkVertex vertex;
      vertex.position = Lift(q, kHeight * std::sin(x) * std::cos(y));
      vertex.normals = {{Vec3(-kHeight * kWave * std::cos(x) * std::cos(y),
                              kHeight * kWave * std::sin(x) * std::sin(y), 1.0),
                         {}}};
      network.vertices.push_back(vertex);
    }
  }
  const auto at = [&](int i, int k) { return i * (kFields + 1) + k; };
  for (int i = 0; i < kFields; ++i) {
    for (int k = 0; k < kFields; ++k) {
      const auto add = [&](std::vector<int> vertices, PatchScheme scheme) {
        network.faces.push_back({"", std::move(vertices), scheme});
      };
      if ((i + k) % triangles_every == 0) {
        add({at(i, k), at(i + 1, k), at(i + 1, k + 1)}, triangles);
        add({at(i, k), at(i + 1, k + 1), at(i, k + 1)}, triangles);
      } else {
        add({at(i, k), at(i + 1, k), at(i + 1, k + 1), at(i, k + 1)}, quads);
      }
    }
  }
  JoinedNetwork joined = JoinNetwork(network);
  EXPECT_TRUE(joined.findings.empty());
  return std::move(joined.model);
}

TEST(LineSwitches, NoneOnJoinedQuadsAndTriangles) {
  using enum PatchScheme;
  for (const auto& [quads, triangles, every] :
       {std::tuple(kGregory, kGregoryTriangle, 1000), std::tuple(kGregory, kGregoryTriangle, 2),
        std::tuple(kBrown, kLoftTriangle, 3), std::tuple(kGregory, kGregoryTriangle, 1)}) {
    SCOPED_TRACE(::testing::Message() << "one in " << every << " as triangles");
    NoneOnSmoothSheet sheet(GentleSheet(quads, triangles, every));
    sheet.Cross({24, 24}, 22, 20, 6);
    EXPECT_GT(sheet.joints(), 80);
  }
}

// Made by others: patches of a limit surface, about whose irregular points are Gregory patches.
TEST(LineSwitches, NoneOnGregoryPatchesOfSubdivisionSurfaces) {
  Placement placement;
  placement.up = UpAxis::kY;
  placement.scale = 40.0;  // the top of the ring, up to its nearest corners
  NoneOnSmoothSheet ring(Place(placement, testing::LoadModel("tests/models/toroidal_tet.patches")));
  ring.Cross({0, 0}, 7, 40, 7);
  EXPECT_GT(ring.joints(), 30);
  placement.scale = 60.0;  // a ball of triangles
  NoneOnSmoothSheet ball(Place(placement, testing::LoadModel("tests/models/icosahedron.patches")));
  ball.Cross({0, 0}, 42, 30, 8);
  EXPECT_GT(ball.joints(), 100);
  NoneOnSmoothSheet saddle(Place(placement, testing::LoadModel("tests/models/saddle.patches")));
  saddle.Cross({0, 0}, 60, 30, 9);
  EXPECT_GT(saddle.joints(), 30);
}

}  // namespace
}  // namespace patchmill
