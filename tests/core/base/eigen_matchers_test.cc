// The comparison of vectors itself: what it lets pass, and what it says of the rest.
#include "tests/support/eigen_matchers.h"

#include <limits>
#include <string>

#include <gtest/gtest.h>

#include "core/base/vec.h"

namespace patchmill {
namespace {

using ::testing::HasSubstr;
using testing::IsNear;
using ::testing::Not;

template <class Value, class Matcher>
std::string Explained(const Value& value, const Matcher& matcher) {
  ::testing::StringMatchResultListener listener;
  ::testing::ExplainMatchResult(matcher, value, &listener);
  return listener.str();
}

TEST(IsNear, TakesTheDistanceNotTheEntries) {
  const Vec3 p(1, 2, 3);
  EXPECT_THAT(p, IsNear(p, 0.0));
  EXPECT_THAT(Vec3(1.3, 2.4, 3), IsNear(p, 0.5 + 1e-12));
  EXPECT_THAT(Vec3(1.3, 2.4, 3), Not(IsNear(p, 0.5 - 1e-12)));
  EXPECT_THAT(2.0 * p - p, IsNear(p, 1e-15));  // expressions, too
}

TEST(IsNear, SaysWhichEntryDiffersAndByHowMuch) {
  const std::string said = Explained(Vec3(1, 2.25, 3.1), IsNear(Vec3(1, 2, 3), 1e-9));
  EXPECT_THAT(said, HasSubstr("off by 0.269, most in y: 2.25 instead of 2"));
  EXPECT_THAT(said, HasSubstr("(1, 2.25, 3.1)"));
  Eigen::Matrix2d m = Eigen::Matrix2d::Identity();
  m(1, 0) = 7;
  EXPECT_THAT(Explained(m, IsNear(Eigen::Matrix2d::Identity(), 1.0)),
              HasSubstr("most in (1,0): 7 instead of 0; all of it: (1, 0; 7, 1)"));
}

TEST(IsNear, NothingIsNearToWhatIsNoNumber) {
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  EXPECT_THAT(Vec3(1, nan, 3), Not(IsNear(Vec3(1, 2, 3), 1e9)));
  EXPECT_THAT(Vec3(1, 2, 3), Not(IsNear(Vec3(nan, 2, 3), 1e9)));
  EXPECT_THAT(Vec3(inf, 2, 3), Not(IsNear(Vec3(inf, 2, 3), 1e9)));
  EXPECT_THAT(Explained(Vec3(1, nan, 30), IsNear(Vec3(1, 2, 3), 1e-9)),
              HasSubstr("most in y: nan instead of 2"));
}

TEST(IsNear, SizesMustBeEqual) {
  const Eigen::VectorXd two = Eigen::VectorXd::Zero(2), three = Eigen::VectorXd::Zero(3);
  EXPECT_THAT(two, Not(IsNear(three, 1.0)));
  EXPECT_THAT(Explained(two, IsNear(three, 1.0)), HasSubstr("2 x 1"));
}

}  // namespace
}  // namespace patchmill
