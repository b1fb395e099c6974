// The minimum of a convex quadratic function within a box, by guessing which bounds hold (primal-dual active
// set).
#pragma once

#include <functional>
#include <vector>

namespace patchmill {

// The function 1/2 x.Hx - g.x over the box lower <= x <= upper with lower <= 0 <= upper. H is symmetric
// positive definite and has no positive entry off its diagonal, as in the systems of fairing. A variable
// whose two bounds are equal stays where it is.
struct BoxQuadratic {
  enum class Hold : signed char { kFree, kLower, kUpper };
  std::vector<double> lower, upper, diagonal;
  // Returns the minimum with the held variables at their bounds; the other variables have no bounds.
  std::function<std::vector<double>(const std::vector<Hold>&)> solve;
  // Returns (Hx - g)_i.
  std::function<double(const std::vector<double>& x, std::size_t i)> slope;
};

struct BoxStep {
  std::vector<double> x;
  int solves = 0;      // at most kMaxBoxSolves
  bool exact = false;  // x is the minimum; otherwise the value at x is no larger than at 0
};

inline constexpr int kMaxBoxSolves = 30;
inline constexpr int kBoxSweeps = 20;  // of Gauss-Seidel, cut back to the box; used if the guesses do not
                                       // settle

// Where no bound holds, one call of `solve` suffices. Cost: BoxStep::solves calls of `solve` and as many
// passes over `slope`; in the worst case kBoxSweeps more passes.
BoxStep MinimizeInBox(const BoxQuadratic& f);

}  // namespace patchmill
