#include "core/math/bspline_basis.h"

#include <algorithm>

namespace patchmill {

int FindSpan(std::span<const double> knots, int degree, double t) {
  const int n = static_cast<int>(knots.size()) - degree - 1;
  // Finds the first knot > t among those that may end a span. This skips empty spans, except at the ends.
  int k =
      static_cast<int>(std::upper_bound(knots.begin() + degree, knots.begin() + n + 1, t) - knots.begin()) -
      1;
  k = std::clamp(k, degree, n - 1);
  while (k > degree && !(knots[k] < knots[k + 1])) --k;
  while (k < n - 1 && !(knots[k] < knots[k + 1])) ++k;
  return k;
}

std::vector<int> NonEmptySpans(std::span<const double> knots, int degree) {
  const int n = static_cast<int>(knots.size()) - degree - 1;
  std::vector<int> spans;
  for (int k = degree; k < n; ++k) {
    if (knots[k] < knots[k + 1]) spans.push_back(k);
  }
  return spans;
}

void BsplineBasisJet(std::span<const double> knots, int degree, int k, double t, BasisJet& out) {
  // Rows p-2, p-1 and p of the Cox-de Boor triangle. Derivatives are differences of the lower rows.
  const int p = degree;
  double row[kMaxBasisDegree + 1];
  double minus1[kMaxBasisDegree + 1];
  double minus2[kMaxBasisDegree + 1];
  const auto knot = [&](int i) { return knots[static_cast<std::size_t>(i)]; };
  row[0] = 1.0;
  for (int r = 1; r <= p; ++r) {  // row r-1 (r entries) -> row r; entry i is the function k-r+i
    if (r == p - 1) std::copy_n(row, r, minus2);
    if (r == p) std::copy_n(row, r, minus1);
    double left = 0.0;
    for (int i = 0; i < r; ++i) {
      const double hi = knot(k + 1 + i), lo = knot(k + 1 + i - r);
      const double x = row[i] / (hi - lo);
      row[i] = left + (hi - t) * x;
      left = (t - lo) * x;
    }
    row[r] = left;
  }
  std::copy_n(row, p + 1, out.f);
  // x(r, i): function of degree r that starts at entry i of its row, divided by its support.
  double first[kMaxBasisDegree + 2];
  if (p == 0) {
    out.d[0] = out.dd[0] = 0.0;
    return;
  }
  for (int i = 0; i < p; ++i) first[i] = minus1[i] / (knot(k + 1 + i) - knot(k + 1 + i - p));
  for (int i = 0; i <= p; ++i) out.d[i] = p * ((i > 0 ? first[i - 1] : 0.0) - (i < p ? first[i] : 0.0));
  if (p == 1) {
    out.dd[0] = out.dd[1] = 0.0;
    return;
  }
  double second[kMaxBasisDegree + 1];  // first derivatives of row p-1
  for (int i = 0; i < p - 1; ++i) second[i] = minus2[i] / (knot(k + 1 + i) - knot(k + 2 + i - p));
  for (int i = 0; i < p; ++i) {
    const double slope = (p - 1) * ((i > 0 ? second[i - 1] : 0.0) - (i < p - 1 ? second[i] : 0.0));
    first[i] = slope / (knot(k + 1 + i) - knot(k + 1 + i - p));
  }
  for (int i = 0; i <= p; ++i) out.dd[i] = p * ((i > 0 ? first[i - 1] : 0.0) - (i < p ? first[i] : 0.0));
}

}  // namespace patchmill
