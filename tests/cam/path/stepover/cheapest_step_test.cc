#include "cam/path/stepover/cheapest_step.h"

#include <algorithm>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "cam/path/stepover/step_over.h"
#include "core/base/vec.h"

namespace patchmill {
namespace {

double LengthAt(const std::vector<StepNeed>& needs, double step, double least) {
  double sum = 0.0;
  for (const StepNeed& need : needs) sum += need.weight * PartsOfGap(step, need.step, least) / step;
  return sum;
}

TEST(PartsOfGap, AsFewAsTheNeedAllows) {
  EXPECT_EQ(PartsOfGap(1.0, 2.0, 0.1), 1);
  EXPECT_EQ(PartsOfGap(1.0, 1.0, 0.1), 1);
  EXPECT_EQ(PartsOfGap(1.0, 0.99, 0.1), 2);
  EXPECT_EQ(PartsOfGap(1.0, 0.5, 0.1), 2);
  EXPECT_EQ(PartsOfGap(1.0, 0.48, 0.1), 3);
  EXPECT_EQ(PartsOfGap(1.0, 0.34, 0.1), 3);
  EXPECT_EQ(PartsOfGap(1.0, 1.0 / 3.0, 0.1), 3);
  EXPECT_EQ(PartsOfGap(1.0, kInfinity, 0.1), 1);
}

// A need that is no less than the least is met, though two parts of a gap may be narrower than the least.
TEST(PartsOfGap, ANeedBelowTheLeastGetsTheLeast) {
  EXPECT_EQ(PartsOfGap(1.9, 1.2, 1.0), 2);
  EXPECT_EQ(PartsOfGap(1.9, 1.0, 1.0), 2);
  EXPECT_EQ(PartsOfGap(1.9, 0.9, 1.0), 1);
  EXPECT_EQ(PartsOfGap(1.0, 0.01, 0.1), 10);
  EXPECT_EQ(PartsOfGap(1.0, 0.0, 0.3), 3);
  EXPECT_EQ(PartsOfGap(1.0, 0.5, 2.0), 1);
}

TEST(CheapestStep, OfTwoNeedsTheOneThatCostsLess) {
  // Nine tenths could do with 1.0: a tenth gets two lines.
  std::vector<StepNeed> mostly_wide = {{1.0, 9.0}, {0.6, 1.0}};
  EXPECT_EQ(CheapestStep(mostly_wide, 0.1, 4.0), 1.0);
  // 0.6 for all: 1 / 0.6 < (0.1 + 0.9 * 2) / 1.
  std::vector<StepNeed> mostly_narrow = {{1.0, 1.0}, {0.6, 9.0}};
  EXPECT_EQ(CheapestStep(mostly_narrow, 0.1, 4.0), 0.6);
  std::vector<StepNeed> none;
  EXPECT_EQ(CheapestStep(none, 0.1, 4.0), 4.0);
  std::vector<StepNeed> anything = {{kInfinity, 1.0}};
  EXPECT_EQ(CheapestStep(anything, 0.1, 4.0), 4.0);
}

RC_GTEST_PROP(CheapestStep, NoOtherNeedIsCheaperAmongAFew, ()) {
  const auto count = *rc::gen::inRange<std::size_t>(1, 12);
  std::vector<StepNeed> needs;
  for (std::size_t i = 0; i < count; ++i)
    needs.push_back({0.01 * *rc::gen::inRange(10, 300), 0.1 * *rc::gen::inRange(9, 12)});
  const std::vector<StepNeed> given = needs;
  const double least = 0.2, most = 2.0;
  const double step = CheapestStep(needs, least, most);
  RC_ASSERT(step >= least && step <= most);
  // Twelve needs of about the same weight: each of them is one of the 17 that are looked at.
  for (const StepNeed& need : given) {
    const double other = std::clamp(need.step, least, most);
    RC_ASSERT(LengthAt(given, step, least) <= LengthAt(given, other, least) * (1 + 1e-12));
  }
}

}  // namespace
}  // namespace patchmill
