// B-spline basis on a knot vector (Piegl and Tiller, The NURBS Book, A2.1-A2.3) and exact Bezier extraction.
//
// A knot vector of degree p has n = knots.size() - p - 1 functions; its domain is [knots[p], knots[n]].
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/math/bernstein.h"

namespace patchmill {

// Index k in [p, n-1] with knots[k] < knots[k+1] and knots[k] <= t < knots[k+1]. For a t before or after the
// domain it is the first or last non-empty span (t == knots[n] belongs to the last). Cost O(log n). The
// domain must not be empty.
int FindSpan(std::span<const double> knots, int degree, double t);

// Indices k of all non-empty spans of the domain, in order.
std::vector<int> NonEmptySpans(std::span<const double> knots, int degree);

// The degree+1 functions that do not vanish on span k (numbers k-p .. k), with two derivatives with respect
// to t. No allocation; relative error about p * 1e-16.
void BsplineBasisJet(std::span<const double> knots, int degree, int k, double t, BasisJet& out);

// Bezier point `j` (0..p) of span k by blossoming: the polar form at (a,..,a,b,..,b) with p-j times a =
// knots[k] and j times b = knots[k+1]. The p+1 control points k-p .. k are d[0], d[stride], .. The result is
// that of inserting both knots p times (Boehm). Every step is a convex combination. It is a kernel for the
// rows and the columns of any net, so degree, span and stride are parameters of their own.
template <class Point>
Point BezierPointOfSpan(std::span<const double> knots, int p, int k, int j, const Point* d,
                        std::ptrdiff_t stride) {
  Point q[kMaxBasisDegree + 1];
  for (int i = 0; i <= p; ++i) q[i] = d[i * stride];
  for (int r = 1; r <= p; ++r) {
    const double arg = knots[static_cast<std::size_t>(r <= p - j ? k : k + 1)];
    for (int i = p; i >= r; --i) {
      const double lo = knots[static_cast<std::size_t>(k - p + i)];
      const double hi = knots[static_cast<std::size_t>(k + i - r + 1)];
      const double a = (arg - lo) / (hi - lo);
      q[i] = (1.0 - a) * q[i - 1] + a * q[i];
    }
  }
  return q[p];
}

}  // namespace patchmill
