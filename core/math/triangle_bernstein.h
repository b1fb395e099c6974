// Homogeneous polynomials of area coordinates (u0,u1,u2), u0 + u1 + u2 = 1, in scaled Bernstein form.
//
// The coefficient of u0^a u1^b u2^c contains the multinomial, so a product is a plain convolution. The layout
// is that of BezierTriangle: row c (exponent of u2 = t), place b in it (exponent of u1 = s).
#pragma once

#include <cstddef>
#include <vector>

#include "core/math/bernstein.h"

namespace patchmill {

// Index of point b of row c of a triangle of degree n. Each row is one point shorter than the one before.
constexpr int TriangleIndex(int n, int c, int b) { return c * (n + 1) - c * (c - 1) / 2 + b; }
constexpr int TriangleCount(int n) { return (n + 1) * (n + 2) / 2; }

// n! / (a! b! c!), n = a + b + c <= 2 kMaxBasisDegree.
inline double Multinomial(int a, int b, int c) { return Binomial(a + b + c, a) * Binomial(b + c, b); }

template <class T>
struct ScaledTriangle {
  int n = 0;
  std::vector<T> c;

  ScaledTriangle(int degree, const T& zero)
      : n(degree), c(static_cast<std::size_t>(TriangleCount(degree)), zero) {}

  // The coefficient of u0^e[0] u1^e[1] u2^e[2]; the exponents sum to n.
  T& at(int e0, int e1, int e2) {
    (void)e0;
    return c[static_cast<std::size_t>(TriangleIndex(n, e2, e1))];
  }
  const T& at(int e0, int e1, int e2) const { return const_cast<ScaledTriangle*>(this)->at(e0, e1, e2); }

  // to += this * factor. `to` has the summed degree.
  void MultiplyInto(const ScaledTriangle<double>& factor, ScaledTriangle<T>& to) const {
    for (int r = 0; r <= n; ++r) {
      for (int k = 0; k <= n - r; ++k) {
        const T& own = at(n - r - k, k, r);
        for (int fr = 0; fr <= factor.n; ++fr) {
          for (int fk = 0; fk <= factor.n - fr; ++fk) {
            const int a = n - r - k + factor.n - fr - fk;
            to.at(a, k + fk, r + fr) += factor.at(factor.n - fr - fk, fk, fr) * own;
          }
        }
      }
    }
  }

  // Ordinary Bernstein coefficients: those without the multinomials.
  std::vector<T> Unscaled() const {
    std::vector<T> out = c;
    for (int r = 0; r <= n; ++r) {
      for (int k = 0; k <= n - r; ++k) {
        out[static_cast<std::size_t>(TriangleIndex(n, r, k))] /= Multinomial(n - r - k, k, r);
      }
    }
    return out;
  }
};

inline ScaledTriangle<double> operator*(const ScaledTriangle<double>& a, const ScaledTriangle<double>& b) {
  ScaledTriangle<double> product(a.n + b.n, 0.0);
  a.MultiplyInto(b, product);
  return product;
}

}  // namespace patchmill
