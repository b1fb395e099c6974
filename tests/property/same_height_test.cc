// One part given in many ways has one centre height.
#include <gtest/gtest.h>

#include "cam/location/locator.h"
#include "tests/support/jobs/jobs.h"
#include "tests/support/random.h"
#include "tests/support/same_part.h"

namespace patchmill {
namespace {

using namespace testing;  // NOLINT: the support folder's

void ExpectSameHeights(const PatchModel& model, double radius, std::uint64_t seed) {
  const int kPoints = kSanitized ? 200 : 3500;
  std::vector<Vec2> places;
  std::vector<std::optional<double>> heights;
  for (const SamePart& way : ManyWays(model)) {
    SCOPED_TRACE(way.name);
    const Surface surface = PlacedSurface(way.model);
    const Locator locator(surface, radius);
    if (places.empty()) {
      Random random(seed);
      for (int i = 0; i < kPoints; ++i) {
        places.emplace_back(random.Uniform(surface.box.min.x() - radius, surface.box.max.x() + radius),
                            random.Uniform(surface.box.min.y() - radius, surface.box.max.y() + radius));
        const auto h = locator.Height(places.back());
        heights.push_back(h ? std::optional(h->z) : std::nullopt);
      }
      continue;
    }
    for (std::size_t i = 0; i < places.size(); ++i) {
      const auto h = locator.Height(places[i] + Xy(way.shift));
      ASSERT_EQ(h.has_value(), heights[i].has_value()) << places[i].transpose();
      if (h) {
        EXPECT_NEAR(h->z - way.shift.z(), *heights[i], 1e-9) << places[i].transpose();
      }
    }
  }
}

TEST(SameHeight, Smooth) { ExpectSameHeights(RandomBspline(11, {.spans = 4, .size = 25}), 3.0, 1); }
TEST(SameHeight, Folded) {
  ExpectSameHeights(RandomBspline(12, {.spans = 4, .size = 25, .folds = true}), 2.0, 2);
}
TEST(SameHeight, Rational) {
  ExpectSameHeights(RandomBspline(13, {.spans = 5, .size = 25, .rational = true}), 4.0, 3);
}
TEST(SameHeight, Torus) { ExpectSameHeights(Torus({0, 0, 0}, 12, 5), 3.0, 4); }
TEST(SameHeight, Block) { ExpectSameHeights(Block(6, 5, 15), 2.5, 5); }

}  // namespace
}  // namespace patchmill
