#include "cam/path/parallel/circular_lines.h"

#include <gtest/gtest.h>

#include "tests/support/random.h"

namespace patchmill {
namespace {

using testing::Random;

constexpr double kOnce = 100.0, kEnd = 112.0;

std::vector<std::pair<double, double>> Once(std::vector<Interval> keep, double end = kEnd) {
  std::vector<std::pair<double, double>> out;
  for (const Interval& i : RemoveOverlapTurn(keep, {end > kOnce ? 0.0 : end - kOnce, end}, kOnce))
    out.emplace_back(i.begin, i.end);
  return out;
}
using Stretches = std::vector<std::pair<double, double>>;

TEST(RemoveOverlapTurn, EveryStretchOnceAndWholeOverTheBeginning) {
  EXPECT_EQ(Once({}), Stretches());
  EXPECT_EQ(Once({{20, 30}}), (Stretches{{20, 30}}));
  EXPECT_EQ(Once({{3, 9}, {103, 109}}), (Stretches{{103, 109}}));  // seen twice
  EXPECT_EQ(Once({{0, 8}, {95, 108}}), (Stretches{{95, 108}}));    // over the beginning
  EXPECT_EQ(Once({{0, 5}, {40, 50}, {90, 105}}), (Stretches{{40, 50}, {90, 105}}));
  EXPECT_EQ(Once({{0, 112}}), (Stretches{{0, 100}}));             // all of it
  EXPECT_EQ(Once({{0, 60}, {61, 112}}), (Stretches{{61, 160}}));  // all but a gap
  EXPECT_EQ(Once({{12.1, 30}, {111.8, 112}}), (Stretches{{12.1, 30}, {111.8, 112}}));
  EXPECT_EQ(Once({{12.0, 30}, {111.8, 112}}), (Stretches{{111.8, 130}}));  // the two sights differ
}

TEST(RemoveOverlapTurn, OfOneTurnWhatIsThere) {
  EXPECT_EQ(Once({{0, 8}, {95, 100}}, kOnce), (Stretches{{0, 8}, {95, 100}}));
  EXPECT_EQ(Once({{0, 100}}, kOnce), (Stretches{{0, 100}}));
}

// Random stretches on the circle, from 0 to the end. The result covers the same part of the circle once.
TEST(RemoveOverlapTurn, CoversWhatWasSeen) {
  Random random(5);
  for (int k = 0; k < 2000; ++k) {
    std::vector<Interval> truth;  // begins in [0, once), may run over
    double at = random.Uniform(0, 30);
    const double first = at;
    while (at < kOnce) {
      const double end = std::min(at + random.Uniform(1, 40), first + kOnce - 0.5);
      if (end <= at) break;
      truth.push_back({at, end});
      at = end + random.Uniform(0.6, 20);
    }
    std::vector<Interval> seen;
    for (const Interval& i : truth) {
      for (const double turn : {-kOnce, 0.0, kOnce}) {
        const Interval cut{std::max(0.0, i.begin + turn), std::min(kEnd, i.end + turn)};
        if (cut.begin < cut.end) seen.push_back(cut);
      }
    }
    std::sort(seen.begin(), seen.end(),
              [](const Interval& a, const Interval& b) { return a.begin < b.begin; });
    double was = 0.0, is = 0.0;
    for (const Interval& i : truth) was += i.end - i.begin;
    for (const auto& [begin, end] : Once(seen)) is += end - begin;
    ASSERT_NEAR(is, was, 1e-9) << k;
    ASSERT_EQ(Once(seen).size(), truth.size()) << k;
  }
}

TEST(ArcPlaces, LieOnTheCircleWithShortChords) {
  const LineFrame frame = LineFrame::Around({3, 4}, 20.0);
  const double y = 8.0, sagitta = 0.004;
  const auto whole = ArcPlaces(frame, y, {0.0, frame.period()}, sagitta);
  EXPECT_EQ(whole.front(), whole.back());
  for (const auto& places : {whole, ArcPlaces(frame, y, {10.0, 60.0}, sagitta)}) {
    ASSERT_GT(places.size(), 3u);
    for (std::size_t i = 1; i < places.size(); ++i) {
      EXPECT_NEAR((places[i] - Vec2(3, 4)).norm(), y, 1e-12);
      EXPECT_GE((0.5 * (places[i] + places[i - 1]) - Vec2(3, 4)).norm(), y - sagitta - 1e-12);
    }
  }
}

}  // namespace
}  // namespace patchmill
