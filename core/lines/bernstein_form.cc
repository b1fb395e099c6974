#include "core/lines/bernstein_form.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "core/base/vec.h"

namespace patchmill {
namespace {

int ChangesOfSign(const BernsteinForm& form, int first, int stride, int count) {
  int changes = 0;
  double last = 0.0;
  for (int k = 0; k < count; ++k) {
    const double x = form.c[static_cast<std::size_t>(first + k * stride)];
    if (std::abs(x) <= form.slack) continue;
    if (last * x < 0.0) ++changes;
    last = x;
  }
  return changes;
}

struct Range {
  double low = kInfinity, high = -kInfinity;
};

// The range of the differences of neighbours along u (stride n + 1) or v (stride 1).
Range Differences(const BernsteinForm& form, bool along_u) {
  Range range;
  const int stride = along_u ? form.n + 1 : 1;
  for (int i = 0; i + (along_u ? 1 : 0) <= form.m; ++i) {
    for (int j = 0; j + (along_u ? 0 : 1) <= form.n; ++j) {
      const int k = i * (form.n + 1) + j;
      const double d = form.c[static_cast<std::size_t>(k + stride)] - form.c[static_cast<std::size_t>(k)];
      range.low = std::min(range.low, d);
      range.high = std::max(range.high, d);
    }
  }
  return range;
}

// True if the differences have one sign, apart from rounding, and are not all zero.
bool Monotone(const BernsteinForm& form, bool along_u) {
  const Range d = Differences(form, along_u);
  return (d.low >= -form.slack && d.high > form.slack) || (d.low < -form.slack && d.high <= form.slack);
}

}  // namespace

FormSign SignOf(const BernsteinForm& form) {
  const auto [low, high] = std::minmax_element(form.c.begin(), form.c.end());
  if (*low > form.slack) return FormSign::kPositive;
  if (*high < -form.slack) return FormSign::kNegative;
  const double nothing = std::max(form.slack, form.negligible);
  return *low >= -nothing && *high <= nothing ? FormSign::kZero : FormSign::kOpen;
}

bool IsRounding(const BernsteinForm& form) {
  return std::all_of(form.c.begin(), form.c.end(), [&](double c) { return std::abs(c) <= form.slack; });
}

bool IsGraph(const BernsteinForm& form) {
  if (!Monotone(form, true) && !Monotone(form, false)) return false;
  const int row = form.n + 1;
  return ChangesOfSign(form, 0, 1, row) <= 1 && ChangesOfSign(form, form.m * row, 1, row) <= 1 &&
         ChangesOfSign(form, 0, row, form.m + 1) <= 1 && ChangesOfSign(form, form.n, row, form.m + 1) <= 1;
}

bool MayBeFlat(const BernsteinForm& form) {
  for (const bool along_u : {true, false}) {
    const Range d = Differences(form, along_u);
    if (d.low > form.slack || d.high < -form.slack) return false;
  }
  return true;
}

namespace {

// De Casteljau's algorithm at the middle, for n + 1 rows of `width` numbers, `stride` apart. On entry `low`
// holds the rows. On return `low` holds the first half and `high` the second half, the same bits as KeepLeft
// and KeepRight give.
void Halve(double* low, double* high, int n, int stride, int width) {
  for (int r = 0;; ++r) {
    std::copy_n(low + n * stride, width, high + (n - r) * stride);
    if (r == n) return;
    for (int i = n; i > r; --i) {
      const double* before = low + (i - 1) * stride;
      double* at = low + i * stride;
      for (int k = 0; k < width; ++k) at[k] = 0.5 * before[k] + 0.5 * at[k];
    }
  }
}

}  // namespace

std::array<BernsteinForm, 4> Quarters(const BernsteinForm& form) {
  const int row = form.n + 1;
  const auto halve_v = [&](BernsteinForm& low, BernsteinForm& high) {
    for (int i = 0; i <= form.m; ++i) Halve(low.c.data() + i * row, high.c.data() + i * row, form.n, 1, 1);
  };
  std::array<BernsteinForm, 4> quarters = {form, form, form, form};
  Halve(quarters[0].c.data(), quarters[2].c.data(), form.m, row, row);
  halve_v(quarters[0], quarters[1]);
  halve_v(quarters[2], quarters[3]);
  return quarters;
}

}  // namespace patchmill
