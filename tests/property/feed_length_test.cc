// Length of feed, compared with the lower bound for the finish and with plain parallel lines at a fixed
// step-over.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

#include <gtest/gtest.h>

#include "cam/path/chord/scan_line.h"
#include "cam/path/stepover/across_feed.h"
#include "cam/path/stepover/step_over.h"
#include "core/diffgeo/forms.h"
#include "tests/support/files.h"
#include "tests/support/jobs/jobs.h"
#include "tests/support/shapes.h"

namespace patchmill {
namespace {

using namespace testing;  // NOLINT: the support folder's

// Lines along x, one step-over everywhere: the one that the worst spot needs for the scallop.
double PlainParallel(const Surface& surface, double radius, double scallop, double size) {
  double step = kInfinity;
  constexpr int kPlaces = 12;  // of each patch, both ways
  for (std::size_t i = 0; i < surface.pieces.size(); ++i) {
    for (int k = 0; k < kPlaces * kPlaces; ++k) {
      const SurfaceJet jet =
          Evaluate(surface.pieces[i], (k / kPlaces + 0.5) / kPlaces, (k % kPlaces + 0.5) / kPlaces);
      const Vec3 e = *UpwardNormal(jet);
      const Vec3 across = *AcrossLines(e, 0.0);
      step = std::min(step, std::abs(across.y()) *
                                CenterStep(radius, scallop, NormalCurvature(Forms(jet, e), jet, across)));
    }
  }
  const Locator locator(surface, radius);
  PassParams params;
  params.scallop = scallop;
  double length = 0.0;
  const int lines = static_cast<int>(std::ceil(size / step));
  for (int i = 0; i <= lines; ++i) {
    const double y = size * i / lines;
    for (const ScanRun& run : ScanLine(locator, {0.0, y}, {size, y}, params)) {
      for (std::size_t k = 1; k < run.points.size(); ++k)
        length += (run.points[k].center - run.points[k - 1].center).norm();
    }
  }
  return length;
}

TEST(FeedLength, TwoHillsBetweenTheLeastAndPlainLines) {
  const Surface surface = PlacedSurface(TwoHills());
  Job job = BallJob(3.0, /*deep=*/false);
  job.operation.tolerance = 0.005;
  const JobResult result = Mill(surface, job);
  ASSERT_TRUE(result.report.verify.ok()) << Describe(result);
  const double least = result.report.least_cut_length, cut = result.report.verify.cut_length;
  const double plain = PlainParallel(surface, 3.0, job.operation.scallop, 100.0);
  RecordProperty("least_mm", std::to_string(least));
  RecordProperty("cut_mm", std::to_string(cut));
  RecordProperty("plain_mm", std::to_string(plain));
  std::printf("least %.0f mm, feed %.0f mm, plain parallel lines %.0f mm\n", least, cut, plain);
  EXPECT_GT(cut, least);
  EXPECT_LT(cut, 1.1 * least);
  // Bending lines, whose steps vary along them, save more than two thirds of what plain lines waste.
  EXPECT_LT(cut - least, 0.33 * (plain - least));
}

// The teapot, 183 mm long, at the default finish. Contours are cut in both directions: for climb milling
// each open one would need an approach and a retract, which are no pass.
TEST(FeedLength, TeapotNearTheLeast) {
  if (kSanitized) GTEST_SKIP() << "too slow under sanitizers";
  Job job = BallJob(3.0, /*deep=*/false);
  job.setup.placement.scale = 100.0;
  job.setup.placement.up = UpAxis::kY;
  job.operation.contour_direction = CutDirection::kEither;
  const JobResult result = Mill(PlacedSurface(LoadModel("examples/teapot.bpt"), job.setup), job);
  ASSERT_TRUE(result.report.verify.ok()) << Describe(result);
  const double least = result.report.least_cut_length, cut = result.report.verify.cut_length;
  std::printf("least %.0f mm, feed %.0f mm\n", least, cut);
  EXPECT_GT(cut, least);
  EXPECT_LT(cut, 1.1 * least);
}

}  // namespace
}  // namespace patchmill
