// Bernstein polynomials of one variable on [0,1]: bases with derivatives, products, degree elevation,
// subdivision.
//
// B_i^n(t) = C(n,i) (1-t)^(n-i) t^i, degree n <= kMaxBasisDegree. All are computed by recurrences whose terms
// are non-negative on [0,1], so values carry a relative error of about n * 1e-16. Outside [0,1] they
// extrapolate.
#pragma once

#include <cstddef>
#include <vector>

namespace patchmill {

inline constexpr int kMaxBasisDegree = 15;

// Values and first two derivatives of the basis functions 0..n at one parameter. Entries beyond n are unset.
struct BasisJet {
  double f[kMaxBasisDegree + 1];
  double d[kMaxBasisDegree + 1];
  double dd[kMaxBasisDegree + 1];
};

// One step of the recurrence, in place.
inline void RaiseBernstein(int n, double t, double* b) {  // B^(n-1) in b[0..n-1] -> B^n in b[0..n]
  const double s = 1.0 - t;
  double left = 0.0;
  for (int i = 0; i < n; ++i) {
    const double here = b[i];
    b[i] = s * here + left;
    left = t * here;
  }
  b[n] = left;
}

// b[0..n] = B_i^n(t). Cost O(n^2), no allocation.
inline void AllBernstein(int n, double t, double* b) {
  b[0] = 1.0;
  for (int k = 1; k <= n; ++k) RaiseBernstein(k, t, b);
}

// Computes f and d from lower[0..n-1] = B^(n-1), and raises `lower` to B^n. For n = 0, lower[0] must be 1.
inline void SlopesFromLower(int n, double t, double* lower, BasisJet& out) {
  for (int i = 0; i <= n; ++i) {
    const double a = i >= 1 ? lower[i - 1] : 0.0;
    const double b = i <= n - 1 ? lower[i] : 0.0;
    out.d[i] = n * (a - b);
  }
  if (n >= 1) RaiseBernstein(n, t, lower);
  for (int i = 0; i <= n; ++i) out.f[i] = lower[i];
}

// B' = n (B_{i-1}^{n-1} - B_i^{n-1}), B'' = n(n-1) (B_{i-2}^{n-2} - 2 B_{i-1}^{n-2} + B_i^{n-2}). The
// function is inline so that a constant n unrolls.
inline void AllBernsteinJet(int n, double t, BasisJet& out) {
  double lower[kMaxBasisDegree + 1];
  lower[0] = 1.0;
  for (int k = 1; k <= n - 2; ++k) RaiseBernstein(k, t, lower);
  if (n >= 2) {
    const double c = static_cast<double>(n) * (n - 1);
    for (int i = 0; i <= n; ++i) {
      const double a = i >= 2 ? lower[i - 2] : 0.0;
      const double b = i >= 1 && i <= n - 1 ? lower[i - 1] : 0.0;
      const double e = i <= n - 2 ? lower[i] : 0.0;
      out.dd[i] = c * (a - 2.0 * b + e);
    }
    RaiseBernstein(n - 1, t, lower);
  } else {
    for (int i = 0; i <= n; ++i) out.dd[i] = 0.0;
  }
  SlopesFromLower(n, t, lower, out);
}

// AllBernsteinJet without second derivatives: `dd` is unset.
inline void AllBernsteinSlopes(int n, double t, BasisJet& out) {
  double lower[kMaxBasisDegree + 1];
  AllBernstein(n - 1, t, lower);
  SlopesFromLower(n, t, lower, out);
}

// C(n,k), 0 <= k <= n; exact for n <= 2 * kMaxBasisDegree.
double Binomial(int n, int k);

// Coefficients of the product of two polynomials. Its degree is the sum of their degrees. Neither argument
// may be empty.
std::vector<double> BernsteinProduct(const std::vector<double>& a, const std::vector<double>& b);

// The same polynomial with degree one higher.
std::vector<double> BernsteinElevate(const std::vector<double>& a);

// De Casteljau in place on the n+1 points p[0], p[stride], ... Afterwards they describe the part [0,t]
// (KeepLeft) or [t,1] (KeepRight) of the curve. For t in [0,1] every step is a convex combination. A t of
// exactly 0 or 1 copies points without rounding, and non-negative coordinates stay non-negative.
template <class Point>
void KeepLeft(Point* p, int n, std::ptrdiff_t stride, double t) {
  const double s = 1.0 - t;
  for (int r = 1; r <= n; ++r) {
    for (int i = n; i >= r; --i) p[i * stride] = s * p[(i - 1) * stride] + t * p[i * stride];
  }
}

template <class Point>
void KeepRight(Point* p, int n, std::ptrdiff_t stride, double t) {
  const double s = 1.0 - t;
  for (int r = n; r >= 1; --r) {
    for (int i = 0; i < r; ++i) p[i * stride] = s * p[i * stride] + t * p[(i + 1) * stride];
  }
}

}  // namespace patchmill
