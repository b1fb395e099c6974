// Polynomials of two variables in scaled tensor Bernstein form, for composing and multiplying patches.
//
// The coefficient c(i,j) of u^i (1-u)^(m-i) v^j (1-v)^(n-j) contains the binomials. So a product is a plain
// convolution, and a convex combination of non-negative forms has no cancellation.
#pragma once

#include <cstddef>
#include <vector>

#include "core/math/bernstein.h"

namespace patchmill {

template <class T>
struct ScaledBernstein {
  int m = 0, n = 0;  // degrees in u and v
  std::vector<T> c;  // c[i * (n + 1) + j]

  ScaledBernstein(int degree_u, int degree_v, const T& zero)
      : m(degree_u), n(degree_v), c(static_cast<std::size_t>((degree_u + 1) * (degree_v + 1)), zero) {}
  T& operator()(int i, int j) { return c[static_cast<std::size_t>(i * (n + 1) + j)]; }
  const T& operator()(int i, int j) const { return c[static_cast<std::size_t>(i * (n + 1) + j)]; }

  // to += this * factor. `to` has the summed degrees.
  void MultiplyInto(const ScaledBernstein<double>& factor, ScaledBernstein<T>& to) const {
    for (int i = 0; i <= m; ++i) {
      for (int j = 0; j <= n; ++j) {
        for (int k = 0; k <= factor.m; ++k) {
          for (int l = 0; l <= factor.n; ++l) to(i + k, j + l) += factor(k, l) * (*this)(i, j);
        }
      }
    }
  }

  // Ordinary Bernstein coefficients: those without the binomials.
  std::vector<T> Unscaled() const {
    std::vector<T> out = c;
    for (int i = 0; i <= m; ++i) {
      for (int j = 0; j <= n; ++j) {
        out[static_cast<std::size_t>(i * (n + 1) + j)] /= Binomial(m, i) * Binomial(n, j);
      }
    }
    return out;
  }
};

}  // namespace patchmill
