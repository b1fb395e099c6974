// Polynomials over a rectangle of parameters in Bernstein form: certain about signs, halved exactly.
#pragma once

#include <array>
#include <vector>

namespace patchmill {

// c[i * (n + 1) + j]: coefficient of B_i^m(u) B_j^n(v); its values over the rectangle lie in the hull of its
// coefficients. `slack`: coefficients this small are rounding. `negligible`: where all are this small nobody
// asks for the sign (walls that are vertical, plates that are flat, but for the digits of a file).
struct BernsteinForm {
  int m = 0, n = 0;
  std::vector<double> c;
  double slack = 0.0;
  double negligible = 0.0;
};

enum class FormSign { kNegative, kZero, kPositive, kOpen };
// kZero: rounding or negligible everywhere. kOpen: the coefficients have both signs, or one of them is within
// the slack.
FormSign SignOf(const BernsteinForm& form);
// All coefficients are rounding.
bool IsRounding(const BernsteinForm& form);

// The zero set in the rectangle is one arc at most, a graph over u or v, and each side is met once at most: a
// partial derivative has one sign, and no side's coefficients change sign twice (Descartes).
bool IsGraph(const BernsteinForm& form);

// Not excluded: a point of the closed rectangle where both partial derivatives vanish.
bool MayBeFlat(const BernsteinForm& form);

// The form over the four quarters: [2 a + b] has u in the a-th half, v in the b-th. Cost O(m n (m + n)).
std::array<BernsteinForm, 4> Quarters(const BernsteinForm& form);

}  // namespace patchmill
