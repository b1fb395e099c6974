#include "core/surface/distance_form.h"

#include <algorithm>
#include <cmath>

#include "core/math/bernstein.h"

namespace patchmill {
namespace {

using Binomials = std::array<std::array<double, kMaxFormDegree + 1>, kMaxFormDegree + 1>;

const Binomials& BinomialTable() {
  static const Binomials table = [] {
    Binomials t{};
    for (int n = 0; n <= kMaxFormDegree; ++n) {
      for (int k = 0; k <= n; ++k)
        t[static_cast<std::size_t>(n)][static_cast<std::size_t>(k)] = Binomial(n, k);
    }
    return t;
  }();
  return table;
}

// Adds the convolution of two rows of scaled coefficients, times 1 or 2, to out[0..2m].
template <int kM, int kComponents>
inline void AddRowProduct(int degree, double factor, const double (*a)[kMaxDegree + 1],
                          const double (*b)[kMaxDegree + 1], double* out) {
  const int m = kM < 0 ? degree : kM;
  for (int j = 0; j <= m; ++j) {
    double s[kComponents];
    for (int k = 0; k < kComponents; ++k) s[k] = factor * a[k][j];
    for (int l = 0; l <= m; ++l) {
      double sum = s[0] * b[0][l];
      for (int k = 1; k < kComponents; ++k) sum += s[k] * b[k][l];
      out[j + l] += sum;
    }
  }
}

// kM is the degree along v, a constant for the common degrees. The components are x and y, z unless
// horizontal, and r w if rational (with a negative sign).
template <int kM, int kPositive, bool kRational>
void Multiply(NetShape shape, const Vec4* points, double radius, DistanceForm& form) {
  constexpr int kComponents = kPositive + (kRational ? 1 : 0);
  const int n = shape.degree_u, m = kM < 0 ? shape.degree_v : kM;
  const Binomials& binomial = BinomialTable();
  const auto& row_n = binomial[static_cast<std::size_t>(n)];
  const auto& row_m = binomial[static_cast<std::size_t>(m)];
  double a[kMaxDegree + 1][kComponents][kMaxDegree + 1];
  double b[kMaxDegree + 1][kComponents][kMaxDegree + 1];  // the last component with its sign
  for (int i = 0; i <= n; ++i) {
    for (int j = 0; j <= m; ++j) {
      const double s = row_n[static_cast<std::size_t>(i)] * row_m[static_cast<std::size_t>(j)];
      const Vec4& p = points[i * (m + 1) + j];
      for (int k = 0; k < kPositive; ++k) b[i][k][j] = a[i][k][j] = s * p[k];
      if constexpr (kRational) {
        a[i][kPositive][j] = s * radius * p[3];
        b[i][kPositive][j] = -a[i][kPositive][j];
      }
    }
  }
  const int width = 2 * m + 1;
  std::fill_n(form.c.begin(), (2 * n + 1) * width, 0.0);
  for (int i = 0; i <= n; ++i) {
    AddRowProduct<kM, kComponents>(m, 1.0, a[i], b[i], form.c.data() + 2 * i * width);
    for (int k = i + 1; k <= n; ++k) {
      AddRowProduct<kM, kComponents>(m, 2.0, a[i], b[k], form.c.data() + (i + k) * width);
    }
  }
  const auto& row_2n = binomial[static_cast<std::size_t>(2 * n)];
  const auto& row_2m = binomial[static_cast<std::size_t>(2 * m)];
  const double constant = kRational ? 0.0 : radius * radius;
  for (int i = 0; i <= 2 * n; ++i) {
    for (int j = 0; j <= 2 * m; ++j) {
      double& c = form.c[static_cast<std::size_t>(i * width + j)];
      c = c / (row_2n[static_cast<std::size_t>(i)] * row_2m[static_cast<std::size_t>(j)]) - constant;
    }
  }
}

// Chooses the loop for the flags of MakeDistanceForm. It has all parameters of that function.
template <int kM>
void MultiplyKind(NetShape shape, const Vec4* points, bool rational, bool horizontal, double radius,
                  DistanceForm& form) {
  if (rational) {
    horizontal ? Multiply<kM, 2, true>(shape, points, radius, form)
               : Multiply<kM, 3, true>(shape, points, radius, form);
  } else {
    horizontal ? Multiply<kM, 2, false>(shape, points, radius, form)
               : Multiply<kM, 3, false>(shape, points, radius, form);
  }
}

struct Range {
  double low = kInfinity, high = -kInfinity;
  void Add(double x) {
    low = std::min(low, x);
    high = std::max(high, x);
  }
  double Magnitude() const { return std::max(std::abs(low), std::abs(high)); }
};

// Values and two derivatives of the Bernstein basis of degree n <= 30.
struct Basis {
  double f[kMaxFormDegree + 1], d[kMaxFormDegree + 1], dd[kMaxFormDegree + 1];

  Basis(int n, double t) {
    double lower[kMaxFormDegree + 1];
    lower[0] = 1.0;
    for (int k = 1; k <= n - 2; ++k) RaiseBernstein(k, t, lower);
    const double c = static_cast<double>(n) * (n - 1);
    for (int i = 0; i <= n; ++i) {
      const double a = i >= 2 ? lower[i - 2] : 0.0;
      const double b = i >= 1 && i < n ? lower[i - 1] : 0.0;
      const double e = i <= n - 2 ? lower[i] : 0.0;
      dd[i] = c * (a - 2.0 * b + e);
    }
    RaiseBernstein(n - 1, t, lower);
    for (int i = 0; i <= n; ++i) {
      const double a = i >= 1 ? lower[i - 1] : 0.0;
      const double b = i < n ? lower[i] : 0.0;
      d[i] = n * (a - b);
    }
    RaiseBernstein(n, t, lower);
    std::copy_n(lower, n + 1, f);
  }
};

}  // namespace

void MakeDistanceForm(NetShape shape, const Vec4* points, bool rational, bool horizontal, double radius,
                      DistanceForm& form) {
  form.degree_u = 2 * shape.degree_u;
  form.degree_v = 2 * shape.degree_v;
  if (shape.degree_v == 3) {
    MultiplyKind<3>(shape, points, rational, horizontal, radius, form);
  } else if (shape.degree_v == 7) {
    MultiplyKind<7>(shape, points, rational, horizontal, radius, form);
  } else {
    MultiplyKind<-1>(shape, points, rational, horizontal, radius, form);
  }
}

FormMinimum SmallestCoefficient(const DistanceForm& form) {
  const auto smallest = std::min_element(form.c.begin(), form.c.begin() + form.count());
  const auto k = static_cast<int>(smallest - form.c.begin());
  const int i = k / (form.degree_v + 1), j = k % (form.degree_v + 1);
  return {*smallest, Vec2(static_cast<double>(i) / form.degree_u, static_cast<double>(j) / form.degree_v)};
}

FormBend BoundSecondDerivatives(const DistanceForm& form) {
  const int n = form.degree_u, m = form.degree_v;
  Range uu, uv, vv;
  for (int i = 0; i <= n; ++i) {
    for (int j = 0; j <= m; ++j) {
      if (i + 2 <= n) uu.Add(form.At(i, j) - 2.0 * form.At(i + 1, j) + form.At(i + 2, j));
      if (j + 2 <= m) vv.Add(form.At(i, j) - 2.0 * form.At(i, j + 1) + form.At(i, j + 2));
      if (i < n && j < m)
        uv.Add(form.At(i, j) - form.At(i + 1, j) - form.At(i, j + 1) + form.At(i + 1, j + 1));
    }
  }
  const double su = static_cast<double>(n) * (n - 1), sv = static_cast<double>(m) * (m - 1);
  const double suv = static_cast<double>(n) * m;
  FormBend bend;
  bend.max_uu = su * uu.Magnitude();
  bend.max_vv = sv * vv.Magnitude();
  const double mixed = suv * uv.Magnitude();
  bend.convex = uu.low > 0.0 && vv.low > 0.0 && (su * uu.low) * (sv * vv.low) > mixed * mixed;
  return bend;
}

FormJet Evaluate(const DistanceForm& form, double u, double v) {
  const Basis bu(form.degree_u, u), bv(form.degree_v, v);
  FormJet jet;
  const double* c = form.c.data();
  for (int i = 0; i <= form.degree_u; ++i, c += form.degree_v + 1) {
    double f = 0.0, d = 0.0, dd = 0.0;
    for (int j = 0; j <= form.degree_v; ++j) {
      f += bv.f[j] * c[j];
      d += bv.d[j] * c[j];
      dd += bv.dd[j] * c[j];
    }
    jet.f += bu.f[i] * f;
    jet.gradient.x() += bu.d[i] * f;
    jet.gradient.y() += bu.f[i] * d;
    jet.hessian.uu += bu.dd[i] * f;
    jet.hessian.uv += bu.d[i] * d;
    jet.hessian.vv += bu.f[i] * dd;
  }
  return jet;
}

ConvexVerdict DecideConvex(const DistanceForm& form, const Vec2& start) {
  constexpr int kMaxSteps = 12;  // converges quadratically from the first or second step on
  Vec2 x = start;
  for (int step = 0; step < kMaxSteps; ++step) {
    const FormJet jet = Evaluate(form, x.x(), x.y());
    if (jet.f < 0.0) return {false, x};
    // The form q is convex: q(y) >= q(x) + g.(y - x). The right side is smallest at a corner of the square.
    const Vec2& g = jet.gradient;
    const double below =
        std::min(-g.x() * x.x(), g.x() * (1.0 - x.x())) + std::min(-g.y() * x.y(), g.y() * (1.0 - x.y()));
    if (jet.f + below >= 0.0) return {true, std::nullopt};
    const Vec2 d = MinimizeInBox(g, jet.hessian, -x, Vec2::Ones() - x);
    x = (x + d).cwiseMax(0.0).cwiseMin(1.0);
  }
  return {};
}

}  // namespace patchmill
