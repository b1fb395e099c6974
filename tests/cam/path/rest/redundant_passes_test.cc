#include "cam/path/rest/redundant_passes.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "cam/path/contour/contour_paths.h"
#include "cam/path/parallel/zigzag_paths.h"
#include "cam/path/rest/leftover_spots.h"
#include "cam/path/stepover/step_over.h"
#include "core/diffgeo/forms.h"
#include "tests/support/joined_surface.h"
#include "tests/support/leftover.h"
#include "tests/support/random.h"
#include "tests/support/shapes.h"

namespace patchmill {
namespace {

using namespace patchmill::testing;

constexpr double kRadius = 3.0, kScallop = 0.01, kTolerance = 0.01, kHalf = 20.0, kVertexStep = 0.5;
const double kStep = CenterStep(kRadius, kScallop, 0.0);

RestPassParams Coverage() {
  RestPassParams params;
  params.pass.scallop = kScallop;
  params.pass.chord_tolerance = 0.1 * kScallop;
  params.tolerance = kTolerance;
  params.limit = kScallop + 0.75 * kTolerance;
  return params;
}

std::vector<CutterPath> Without(const Locator& locator, std::vector<CutterPath> paths, int threads = 1) {
  const Locator reach = *ReachLocator(locator, Coverage(), RunContext());
  auto kept = RemoveRedundantPasses(locator, reach, std::move(paths), {Coverage()}, RunContext(threads));
  EXPECT_TRUE(kept.ok()) << kept.status();
  return std::move(*kept);
}

// A pass over a flat at z = 0, with a vertex every kVertexStep or, in one chord, at the ends alone.
CutterPath Row(double y, double from, double to, bool one_chord = false) {
  const int count = one_chord ? 1 : static_cast<int>(std::lround((to - from) / kVertexStep));
  CutterPath path;
  for (int k = 0; k <= count; ++k)
    path.points.push_back({{from + k * (to - from) / count, y, kRadius}, {}, {}});
  return path;
}

// Full rows up to y = 0, the others only as long as `from` and `to` say.
std::vector<CutterPath> Rows(double from, double to) {
  std::vector<CutterPath> rows;
  const int most = static_cast<int>(kHalf / kStep) + 1;
  for (int k = -most; k <= most; ++k)
    rows.push_back(k <= 0 ? Row(k * kStep, -kHalf, kHalf) : Row(k * kStep, from, to));
  return rows;
}

void Append(std::vector<CutterPath>& to, const std::vector<CutterPath>& from) {
  to.insert(to.end(), from.begin(), from.end());
}

void ExpectSame(const std::vector<CutterPath>& a, const std::vector<CutterPath>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    ASSERT_EQ(a[i].points.size(), b[i].points.size()) << i;
    for (std::size_t k = 0; k < a[i].points.size(); ++k)
      EXPECT_EQ(a[i].points[k].center, b[i].points[k].center) << i;
  }
}

TEST(RemoveRedundantPasses, EvenRowsStay) {
  const Surface surface = JoinedSurface(Plane(kHalf));
  const Locator locator(surface, kRadius);
  const std::vector<CutterPath> rows = Rows(-kHalf, kHalf);
  ExpectSame(Without(locator, rows), rows);
}

TEST(RemoveRedundantPasses, RowsBetweenOthersGo) {
  const Surface surface = JoinedSurface(Plane(kHalf));
  const Locator locator(surface, kRadius);
  const std::vector<CutterPath> rows = Rows(-kHalf, kHalf);
  std::vector<CutterPath> more = rows;
  for (const double at : {0.5, 3.3, -7.8})
    more.insert(more.begin() + 5, Row(at * kStep, -0.8 * kHalf, 0.7 * kHalf));
  more.push_back(Row(2.6 * kStep, 1.0, 1.5));
  ExpectSame(Without(locator, more), rows);
}

TEST(RemoveRedundantPasses, OfWhatIsNeededInPartTheRestGoes) {
  const Surface surface = JoinedSurface(Plane(kHalf));
  const Locator locator(surface, kRadius);
  const std::vector<CutterPath> rows = Rows(-kHalf, 0.0);
  std::vector<CutterPath> more = rows;
  more.push_back(Row(0.5 * kStep, -kHalf, kHalf));
  const std::vector<CutterPath> kept = Without(locator, more);
  ASSERT_EQ(kept.size(), more.size());
  const CutterPath& last = kept.back();
  EXPECT_EQ(last.points.back().center, more.back().points.back().center);
  // Beyond the ends of the rows it is needed; these finish half a step more.
  EXPECT_LE(last.points.front().center.x(), 0.5 * kStep);
  EXPECT_GT(last.points.front().center.x(), -2.0 * kVertexStep);
  // Chords stay whole.
  more.back() = Row(0.5 * kStep, -kHalf, kHalf, true);
  ExpectSame(Without(locator, more), more);
}

TEST(RemoveRedundantPasses, ADoubledVertexIsNoPass) {
  const Surface surface = JoinedSurface(Plane(kHalf));
  const Locator locator(surface, kRadius);
  const std::vector<CutterPath> rows = Rows(-kHalf, kHalf);
  std::vector<CutterPath> more = rows;
  more.push_back(Row(0.5 * kStep, -kHalf, kHalf));
  const std::ptrdiff_t middle = 40;
  more.back().points.insert(more.back().points.begin() + middle, more.back().points[middle]);
  ExpectSame(Without(locator, more), rows);
}

// A finer finish than the tolerance: what was taken must have left less by a share of the scallop, not of
// the tolerance. Rows too far apart, with others beside them that make up for it.
TEST(RemoveRedundantPasses, AFineFinishAtALooseToleranceIsKept) {
  const Surface surface = JoinedSurface(Plane(10.0));
  const Locator locator(surface, kRadius);
  RestPassParams params = Coverage();
  params.pass.scallop = 0.002;
  params.tolerance = 0.05;
  params.limit = params.pass.scallop + 0.75 * params.tolerance;
  const double step = CenterStep(kRadius, params.pass.scallop, 0.0);
  std::vector<CutterPath> rows;
  for (double y = -10.0; y < 10.0; y += 1.19 * step) {
    rows.push_back(Row(y, -10.0, 10.0));
    rows.push_back(Row(y + 0.19 * step, -10.0, 10.0));
  }
  const Locator reach = *ReachLocator(locator, params, RunContext());
  const auto kept = RemoveRedundantPasses(locator, reach, rows, {params}, RunContext());
  ASSERT_TRUE(kept.ok()) << kept.status();
  const DistanceToPaths after(*kept);
  Random random(7);
  for (int k = 0; k < 20000; ++k) {
    const Vec3 p(random.Uniform(-9.0, 9.0), random.Uniform(-9.0, 9.0), 0.0);
    EXPECT_LE(after.At(p, kRadius + 1.0) - kRadius, 1.07 * params.pass.scallop) << p.transpose();
  }
}

TEST(RemoveRedundantPasses, LongMiddlesAndArcsOfLoopsGo) {
  const Surface surface = JoinedSurface(Plane(kHalf));
  const Locator locator(surface, kRadius);
  const double worth = 0.5 * kMinRemovedBetween * kRadius;
  for (const double half : {worth - 1.0, worth + 2.0}) {
    std::vector<CutterPath> more = Rows(-half, half);
    more.push_back(Row(0.5 * kStep, -kHalf, kHalf));
    const std::vector<CutterPath> kept = Without(locator, more);
    if (half < worth) {
      ExpectSame(kept, more);
      continue;
    }
    ASSERT_EQ(kept.size(), more.size() + 1);
    const double gap = kept.back().points.front().center.x() - kept[kept.size() - 2].points.back().center.x();
    EXPECT_NEAR(gap, 2.0 * half, 3.0 * kVertexStep);
  }
  // A loop whose left half lies among the rows.
  std::vector<CutterPath> more;
  for (int k = -40; k <= 40; ++k) more.push_back(Row(k * kStep, -kHalf, 0.0));
  CutterPath loop;
  loop.kind = PassKind::kContour;
  loop.closed = true;
  const double r = 15.0;
  const int count = 188;
  for (int k = 0; k < count; ++k) {
    const double a = 2.0 * kPi * k / count;
    loop.points.push_back({{r * std::cos(a), r * std::sin(a), kRadius}, {}, {}});
  }
  more.push_back(loop);
  const std::vector<CutterPath> kept = Without(locator, more);
  ASSERT_EQ(kept.size(), more.size());
  EXPECT_FALSE(kept.back().closed);
  EXPECT_NEAR(Length(kept.back()), kPi * r, 3.0 * kVertexStep);
  for (const CutterPoint& p : kept.back().points) EXPECT_GT(p.center.x(), -2.0 * kVertexStep);
  // A spiral keeps its way down.
  more.back().closed = false;
  more.back().traversal = Traversal::kSpiral;
  ExpectSame(Without(locator, more), more);
}

// Lines over contours, and both over creases: half of the passes are redundant. After their removal no place
// has more left than two neighbours may leave, or than it had before.
TEST(RemoveRedundantPasses, NowhereDoesMoreRemain) {
  const std::vector<PatchModel> models = {Sphere(Vec3::Zero(), 9.0, Half::kUpper),
                                          TwoPlanes(Radians(40), 8.0), Saddle(0.04, 0.05, 8.0),
                                          RandomBspline(5, {.spans = 5, .size = 20, .amplitude = 2.5})};
  for (const PatchModel& model : models) {
    const Surface surface = JoinedSurface(model);
    const Locator locator(surface, kRadius);
    const Locator reach = *ReachLocator(locator, Coverage(), RunContext());
    ZigzagParams lines;
    ContourParams contours;
    for (PassParams* params : {&lines.pass, &contours.pass}) {
      params->scallop = kScallop;
      params->chord_tolerance = 0.1 * kScallop;
    }
    lines.angle = 0.3;
    lines.pass.window.max = Radians(45);
    contours.pass.window.min = Radians(35);
    std::vector<CutterPath> paths = *ZigzagPaths(locator, lines, RunContext());
    Append(paths, ContourPaths(locator, contours, RunContext())->paths);
    lines.angle = 1.6;
    lines.pass.window.max = Radians(10);
    Append(paths, *ZigzagPaths(locator, lines, RunContext()));
    Append(paths, *RestPaths(locator, reach, paths, Coverage(), RunContext()));
    const std::vector<CutterPath> kept = Without(locator, paths);
    EXPECT_LT(TotalLength(kept), TotalLength(paths));
    const DistanceToPaths before(paths), after(kept);
    Random random(3);
    for (int k = 0; k < 60000; ++k) {
      const PieceId piece(random.Int(static_cast<int>(surface.pieces.size())));
      const SurfaceJet jet = Evaluate(surface, piece, random.Unit(), random.Unit());
      const auto e = UpwardNormal(jet);
      if (!e || !reach.Free(jet.p + kRadius * *e)) continue;
      const double left = after.At(jet.p, kRadius + 1.0) - kRadius;
      if (left <= 1.06 * kScallop) continue;
      EXPECT_LE(left, before.At(jet.p, kRadius + 1.0) - kRadius + 0.05 * kTolerance + 1e-9)
          << jet.p.transpose();
    }
    ExpectSame(Without(locator, paths, 2), kept);
  }
}

}  // namespace
}  // namespace patchmill
