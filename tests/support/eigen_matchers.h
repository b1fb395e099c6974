// Comparison of points, vectors and matrices that says what differs:
//
//   EXPECT_THAT(jet.du, IsNear(expected, 1e-12)) << "at u = " << u;
#pragma once

#include <cmath>
#include <limits>
#include <ostream>
#include <string>
#include <utility>

#include <Eigen/Core>
#include <fmt/format.h>
#include <gmock/gmock.h>

namespace patchmill::testing {

// "(1, 2.5, 3)"; matrices row by row: "(1, 2; 3, 4)". Every digit that tells two numbers apart.
template <class Derived>
std::string TextOf(const Eigen::MatrixBase<Derived>& m) {
  std::string text = "(";
  const bool is_row_of_its_own = m.cols() == 1;
  for (Eigen::Index i = 0; i < m.rows(); ++i) {
    if (i > 0) text += is_row_of_its_own ? ", " : "; ";
    for (Eigen::Index j = 0; j < m.cols(); ++j) {
      text += fmt::format("{}{}", j > 0 ? ", " : "", static_cast<double>(m(i, j)));
    }
  }
  return text + ")";
}

// Matches what has the same size and lies within `tolerance`, the norm of the difference (0: equal). A number
// that is not finite matches nothing.
template <class Plain>
class NearMatcher {
 public:
  using is_gtest_matcher = void;

  NearMatcher(Plain expected, double tolerance) : expected_(std::move(expected)), tolerance_(tolerance) {}

  template <class Derived>
  bool MatchAndExplain(const Eigen::MatrixBase<Derived>& value, std::ostream* os) const {
    const typename Derived::PlainObject actual = value;
    if (actual.rows() != expected_.rows() || actual.cols() != expected_.cols()) {
      if (os != nullptr) *os << "which has " << actual.rows() << " x " << actual.cols() << " entries";
      return false;
    }
    // The entry that differs most, one that is not finite before all others.
    double largest = -1.0, squares = 0.0;
    Eigen::Index row = 0, column = 0;
    for (Eigen::Index i = 0; i < actual.rows(); ++i) {
      for (Eigen::Index j = 0; j < actual.cols(); ++j) {
        const double off = std::abs(static_cast<double>(actual(i, j)) - static_cast<double>(expected_(i, j)));
        const double known = std::isfinite(off) ? off : std::numeric_limits<double>::infinity();
        squares += known * known;
        if (known > largest) largest = known, row = i, column = j;
      }
    }
    const double distance = std::sqrt(squares);
    if (distance <= tolerance_) return true;
    if (os != nullptr) {
      *os << fmt::format("which is off by {:.3g}, most in {}: {} instead of {}; all of it: {}", distance,
                         NameOf(row, column), static_cast<double>(actual(row, column)),
                         static_cast<double>(expected_(row, column)), TextOf(actual));
    }
    return false;
  }
  void DescribeTo(std::ostream* os) const { *os << Description("is within"); }
  void DescribeNegationTo(std::ostream* os) const { *os << Description("is not within"); }

 private:
  std::string Description(const char* verb) const {
    return fmt::format("{} {:.3g} of {}", verb, tolerance_, TextOf(expected_));
  }
  std::string NameOf(Eigen::Index row, Eigen::Index column) const {
    if (expected_.cols() > 1) return fmt::format("({},{})", row, column);
    return expected_.rows() <= 4 ? std::string(1, "xyzw"[row]) : fmt::format("entry {}", row);
  }

  Plain expected_;
  double tolerance_;
};

template <class Derived>
auto IsNear(const Eigen::MatrixBase<Derived>& expected, double tolerance) {
  return NearMatcher<typename Derived::PlainObject>(expected, tolerance);
}

}  // namespace patchmill::testing
