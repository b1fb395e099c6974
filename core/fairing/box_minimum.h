// The least of a convex quadratic within a box, by guessing which bounds hold (primal-dual active set).
#pragma once

#include <functional>
#include <vector>

namespace patchmill {

// 1/2 x.Hx - g.x over lower <= x <= upper, H symmetric positive definite without positive entries beside the
// diagonal, as the systems of fairing are. lower <= 0 <= upper; equal ones hold a variable where it is.
struct BoxQuadratic {
  enum class Hold : signed char { kFree, kLower, kUpper };
  std::vector<double> lower, upper, diagonal;
  // The least with the held variables at their bounds, the others without bounds.
  std::function<std::vector<double>(const std::vector<Hold>&)> solve;
  // (Hx - g)_i.
  std::function<double(const std::vector<double>& x, std::size_t i)> slope;
};

struct BoxStep {
  std::vector<double> x;
  int solves = 0;      // at most kMaxBoxSolves
  bool exact = false;  // the least itself; else some x with no larger value than 0 has
};

inline constexpr int kMaxBoxSolves = 30;
inline constexpr int kBoxSweeps = 20;  // of Gauss-Seidel, cut back to the box, when the guesses do not settle

// One solve where no bound holds. Cost: solves of `solve`, as many passes over `slope`; at worst kBoxSweeps
// passes more.
BoxStep MinimizeInBox(const BoxQuadratic& f);

}  // namespace patchmill
