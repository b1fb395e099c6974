// One part given in many ways gets the same lines, levels and region areas, and
// a verified program.
#include <map>

#include <gtest/gtest.h>

#include "tests/support/jobs/jobs.h"
#include "tests/support/same_part.h"

namespace patchmill {
namespace {

using namespace testing;  // NOLINT: the support folder's

// The centre of the circular lines of a job.
std::optional<Vec2> Around(const JobResult& result) {
  for (const RegionChoice& choice : result.report.choices)
    if (!choice.around.empty()) return choice.around.front().lines.center;
  return std::nullopt;
}

// Places of the passes of one kind, each once: heights of levels, offsets of lines across the feed, or radii
// of circular lines, whose corners lie on the circle.
std::vector<double> Places(const JobResult& result, PassKind kind, double angle) {
  const Vec3 across(-std::sin(angle), std::cos(angle), 0.0);
  const std::optional<Vec2> around = Around(result);
  std::vector<double> all;
  for (const CutterPath& path : result.motion.passes) {
    if (path.kind != kind) continue;
    const Vec3& c = path.points.front().center;
    double place = across.dot(c);
    if (around) {
      place = 0.0;
      for (const CutterPoint& p : path.points) place = std::max(place, (Xy(p.center) - *around).norm());
    }
    all.push_back(kind == PassKind::kContour ? c.z() : place);
  }
  std::sort(all.begin(), all.end());
  std::vector<double> places;
  for (const double x : all) {
    if (places.empty() || x > places.back() + 1e-6) places.push_back(x);
  }
  return places;
}

void ExpectSamePlaces(const JobResult& first, const JobResult& other, PassKind kind, double angle,
                      double shift) {
  const std::vector<double> a = Places(first, kind, angle), b = Places(other, kind, angle);
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) EXPECT_NEAR(a[i] + shift, b[i], 1e-6) << i;
}

std::map<std::pair<RegionKind, SlopeClass>, double> AreasByKind(const JobResult& result) {
  std::map<std::pair<RegionKind, SlopeClass>, double> areas;
  for (const Region& region : result.report.regions) areas[{region.kind, region.slope}] += region.area;
  return areas;
}

void ExpectSameJob(const PatchModel& model, const Job& job) {
  std::optional<JobResult> first;
  for (const SamePart& way : ManyWays(model)) {
    SCOPED_TRACE(way.name);
    const Surface surface = PlacedSurface(way.model);
    JobResult result = Mill(surface, job);
    EXPECT_TRUE(result.report.verify.ok()) << Describe(result);
    ASSERT_FALSE(result.program.empty());
    if (!first) {
      first = std::move(result);
      continue;
    }
    const double angle = job.operation.zigzag_angle;
    ExpectSamePlaces(*first, result, PassKind::kContour, angle, way.shift.z());
    ExpectSamePlaces(*first, result, PassKind::kZigzag, angle,
                     Around(*first) ? 0.0 : Vec3(-std::sin(angle), std::cos(angle), 0.0).dot(way.shift));
    double total = 0.0;
    for (const auto& [kind, area] : AreasByKind(*first)) total += area;
    const auto areas = AreasByKind(result);
    for (const auto& [kind, area] : AreasByKind(*first)) {
      const auto at = areas.find(kind);
      EXPECT_NEAR(at == areas.end() ? 0.0 : at->second, area, 1e-3 * total)
          << Name(kind.first) << ' ' << Name(kind.second);
    }
    EXPECT_EQ(result.report.outcome, first->report.outcome);
    if (kSanitized) break;
  }
}

// Straight lines only, because their places are exact to rounding. Bends follow from samples, and a sample at
// the limit of the selection may count or not.
TEST(SameJob, SmoothPart) {
  Job job = BallJob(3.0);
  job.operation.zigzag_bend = 0.0;
  job.operation.scallop = 0.03;
  job.operation.steep_angle = Radians(30);
  ExpectSameJob(RandomBspline(21, {.spans = 4, .size = 22, .amplitude = 3}), job);
}

TEST(SameJob, Torus) {
  Job job = BallJob(2.0);
  job.operation.zigzag_bend = 0.0;
  job.operation.scallop = 0.03;
  for (const bool round : {false, true}) {
    SCOPED_TRACE(round);
    job.operation.round_lines = round;
    ExpectSameJob(Torus({0, 0, 0}, 10, 4, Half::kUpper), job);
  }
}

TEST(SameJob, BentLinesAreAsLong) {
  Job job = BallJob(3.0);
  job.operation.scallop = 0.03;
  double first = 0.0;
  for (const SamePart& way : ManyWays(RandomBspline(21, {.spans = 4, .size = 22, .amplitude = 3}))) {
    SCOPED_TRACE(way.name);
    const JobResult result = Mill(PlacedSurface(way.model), job);
    EXPECT_TRUE(result.report.verify.ok()) << Describe(result);
    const double length = result.report.verify.cut_length;
    if (first == 0.0) first = length;
    EXPECT_NEAR(length, first, 0.02 * first);
    if (kSanitized && length != first) break;
  }
}

}  // namespace
}  // namespace patchmill
