// Polynomials over a rectangle of parameters in Bernstein form. Their signs are certain, and halving is
// exact.
#pragma once

#include <array>
#include <vector>

namespace patchmill {

// c[i * (n + 1) + j] is the coefficient of B_i^m(u) B_j^n(v). The values over the rectangle lie between the
// smallest and the largest coefficient. Coefficients up to `slack` are rounding. If all coefficients are at
// most `negligible`, the sign does not matter (for instance walls that are vertical, and plates that are
// flat, except for the digits of a file).
struct BernsteinForm {
  int m = 0, n = 0;
  std::vector<double> c;
  double slack = 0.0;
  double negligible = 0.0;
};

enum class FormSign { kNegative, kZero, kPositive, kOpen };
// kZero: all coefficients are rounding or negligible. kOpen: the coefficients have both signs, or one of them
// is within the slack.
FormSign SignOf(const BernsteinForm& form);
// True if all coefficients are rounding.
bool IsRounding(const BernsteinForm& form);

// True if the zero set in the rectangle is at most one arc. The arc is a graph over u or v and meets each
// side at most once. Proof: a partial derivative has one sign, and the coefficients of no side change sign
// twice (Descartes).
bool IsGraph(const BernsteinForm& form);

// False proves that no point of the closed rectangle has two vanishing partial derivatives.
bool MayBeFlat(const BernsteinForm& form);

// The form over the four quarters. In [2 a + b], u lies in half a and v in half b. Cost O(m n (m + n)).
std::array<BernsteinForm, 4> Quarters(const BernsteinForm& form);

}  // namespace patchmill
