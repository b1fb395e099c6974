#include "core/surface/form_sign.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace patchmill {
namespace {

constexpr int kMostHalvings = 40;
// Share of the largest coefficient; covers sums of a few dozen products.
constexpr double kRounding = 64.0 * std::numeric_limits<double>::epsilon();

struct Halver {
  const int rows, columns;  // numbers of coefficients
  const double rounding;
  int parts;
  std::vector<double>& buffer;  // two parts for each halving

  double At(const double* c, int i, int j) const { return c[i * columns + j]; }

  // Whether the form bends more along u than along v.
  bool BendsMostAlongU(const double* c) const {
    double u = 0.0, v = 0.0;
    for (int i = 0; i < rows; ++i) {
      for (int j = 0; j < columns; ++j) {
        if (i + 2 < rows) u = std::max(u, std::abs(At(c, i, j) - 2.0 * At(c, i + 1, j) + At(c, i + 2, j)));
        if (j + 2 < columns) v = std::max(v, std::abs(At(c, i, j) - 2.0 * At(c, i, j + 1) + At(c, i, j + 2)));
      }
    }
    return u >= v;
  }

  // De Casteljau's algorithm at the middle, for `count` rows of coefficients. Coefficients of a row are
  // `step` apart, rows are `stride` apart. This is the innermost loop of the proof, so sizes and strides are
  // parameters of their own.
  static void Halve(const double* c, double* low, double* high, int size, int count, int step, int stride) {
    std::copy_n(c, size, high);
    const int along = size / count;
    for (int row = 0; row < count; ++row) {
      double* h = high + row * stride;
      double* l = low + row * stride;
      for (int k = 0; k < along; ++k) {
        l[k * step] = h[0];
        for (int i = 0; i + k + 1 < along; ++i) h[i * step] = 0.5 * (h[i * step] + h[(i + 1) * step]);
      }
    }
  }

  bool Prove(const double* c, int halvings) {
    const int size = rows * columns;
    if (*std::min_element(c, c + size) >= rounding) return true;
    // The corner coefficients are values of the form.
    const double corner = std::min({c[0], c[columns - 1], c[size - columns], c[size - 1]});
    if (corner < rounding || --parts < 0 || halvings >= kMostHalvings) return false;
    double* low = buffer.data() + 2 * halvings * size;
    double* high = low + size;
    if (BendsMostAlongU(c)) {
      Halve(c, low, high, size, columns, columns, 1);
    } else {
      Halve(c, low, high, size, rows, 1, columns);
    }
    return Prove(low, halvings + 1) && Prove(high, halvings + 1);
  }
};

}  // namespace

bool NowhereNegative(const DistanceForm& form, int most_parts) {
  double largest = 0.0;
  for (int k = 0; k < form.count(); ++k)
    largest = std::max(largest, std::abs(form.c[static_cast<std::size_t>(k)]));
  if (!(largest > 0.0 && largest < std::numeric_limits<double>::infinity())) return false;
  thread_local std::vector<double> buffer;
  buffer.resize(std::max(buffer.size(), static_cast<std::size_t>(2 * kMostHalvings * form.count())));
  Halver halver{form.degree_u + 1, form.degree_v + 1, kRounding * largest, most_parts, buffer};
  return halver.Prove(form.c.data(), 0);
}

}  // namespace patchmill
