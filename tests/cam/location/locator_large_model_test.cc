// A model of a hundred thousand patches, joined, with all that heights on it need: memory and time.
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "cam/location/locator.h"
#include "cam/plan/plan.h"
#include "tests/support/clock.h"
#include "tests/support/peak_memory.h"
#include "tests/support/random.h"
#include "tests/support/sanitized.h"

namespace patchmill {
namespace {

constexpr double kSide = 2.0;  // mm, of a patch
constexpr int kAcross = 316;

PatchModel Waves() {
  PatchModel model;
  for (int i = 0; i < kAcross; ++i) {
    for (int j = 0; j < kAcross; ++j) {
      BezierPatch patch{3, 3, {}, {}};
      for (int k = 0; k < 16; ++k) {
        const double x = kSide * (i + (k / 4) / 3.0), y = kSide * (j + (k % 4) / 3.0);
        patch.points.emplace_back(x, y, 3.0 * std::sin(0.31 * x) * std::cos(0.27 * y));
      }
      model.patches.push_back({"", std::move(patch)});
    }
  }
  return model;
}

TEST(LargeModel, AHundredThousandPatchesStayBelowAGigabyte) {
  [[maybe_unused]] const double before = testing::PeakMemory();
  ASSERT_GT(before, 0.0);
  const double start = testing::ClockSeconds(CLOCK_PROCESS_CPUTIME_ID);
  const auto surface = BuildPlacedSurface(Waves(), {}, RunContext(2));
  ASSERT_TRUE(surface.ok()) << surface.status();
  ASSERT_EQ(surface->network.model.patches.size(), 99'856u);
  const Locator locator(*surface, 3.0);
  testing::Random random(1);
  for (int i = 0; i < 1000; ++i) {
    const double x = random.Uniform(0.0, kSide * kAcross);
    const auto h = locator.CertifiedHeight({x, random.Uniform(0.0, kSide * kAcross)}, 1e-6);
    ASSERT_TRUE(h.has_value());
    EXPECT_LE(h->gap, 1.1e-6);
  }
  const double seconds = testing::ClockSeconds(CLOCK_PROCESS_CPUTIME_ID) - start;
  EXPECT_LT(seconds, testing::kSanitized ? 400.0 : 30.0);            // of all threads
#if !defined(__SANITIZE_THREAD__) && !defined(__SANITIZE_ADDRESS__)  // which keep shadows of all memory
  EXPECT_LT(testing::PeakMemory() - before, 1000.0);
#endif
  RecordProperty("seconds", std::to_string(seconds));
  RecordProperty("megabytes", std::to_string(testing::PeakMemory() - before));
}

}  // namespace
}  // namespace patchmill
