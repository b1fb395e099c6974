#include "core/lines/line_forms.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/math/tensor_bernstein.h"

namespace patchmill {
namespace {

using Form = ScaledBernstein<double>;

constexpr double kNegligible = 1e-6;                   // in units of the field
constexpr double kRounding = 64 * 2.2e-16;             // of a chain of products and differences
constexpr int kMaxDegreeOfForm = 2 * kMaxBasisDegree;  // the largest degree for which Binomial works

Form operator*(const Form& a, const Form& b) {
  Form product(a.m + b.m, a.n + b.n, 0.0);
  const int width = b.n + 1, row = product.n + 1;
  for (int i = 0; i <= a.m; ++i) {
    for (int j = 0; j <= a.n; ++j) {
      const double x = a(i, j);
      for (int k = 0; k <= b.m; ++k) {
        const double* from = &b.c[static_cast<std::size_t>(k * width)];
        double* to = &product.c[static_cast<std::size_t>((i + k) * row + j)];
        for (int l = 0; l < width; ++l) to[l] += x * from[l];
      }
    }
  }
  return product;
}

// The operands must have equal degrees.
Form operator+(Form a, const Form& b) {
  for (std::size_t k = 0; k < a.c.size(); ++k) a.c[k] += b.c[k];
  return a;
}
Form operator-(Form a, const Form& b) {
  for (std::size_t k = 0; k < a.c.size(); ++k) a.c[k] -= b.c[k];
  return a;
}
Form operator*(double s, Form a) {
  for (double& x : a.c) x *= s;
  return a;
}

double Largest(const Form& f) {
  double most = 0.0;
  for (const double x : f.Unscaled()) most = std::max(most, std::abs(x));
  return most;
}

// `unit` is the largest possible value of the form where its field is 1 (1/mm for curvatures).
BernsteinForm Finished(const Form& f, double noise, double unit) {
  return {f.m, f.n, f.Unscaled(), noise * unit, kNegligible * unit};
}

// One coordinate of the homogeneous net and its derivatives.
struct Coordinate {
  Form f, u, v, uu, uv, vv;
};

Form Scaled(int m, int n, const std::vector<double>& c) {
  Form f(m, n, 0.0);
  for (int i = 0; i <= m; ++i) {
    for (int j = 0; j <= n; ++j)
      f(i, j) = Binomial(m, i) * Binomial(n, j) * c[static_cast<std::size_t>(i * (n + 1) + j)];
  }
  return f;
}

// Derivative along u (or v) of plain coefficients. A constant has the derivative zero of degree 0.
std::vector<double> Differences(int& m, int n, const std::vector<double>& c, bool along_u) {
  const int rows = along_u ? m : n, width = n + 1;
  if (rows == 0) return std::vector<double>(c.size(), 0.0);
  std::vector<double> d;
  if (along_u) {
    for (int i = 0; i < m; ++i) {
      for (int j = 0; j <= n; ++j)
        d.push_back(m * (c[static_cast<std::size_t>((i + 1) * width + j)] -
                         c[static_cast<std::size_t>(i * width + j)]));
    }
    return d;
  }
  for (int i = 0; i <= m; ++i) {
    for (int j = 0; j < n; ++j)
      d.push_back(
          n * (c[static_cast<std::size_t>(i * width + j + 1)] - c[static_cast<std::size_t>(i * width + j)]));
  }
  return d;
}

Form Derivative(int m, int n, const std::vector<double>& c, int du, int dv) {
  std::vector<double> d = c;
  for (; du > 0; --du) {
    d = Differences(m, n, d, true);
    m = std::max(0, m - 1);
  }
  for (; dv > 0; --dv) {
    d = Differences(m, n, d, false);
    n = std::max(0, n - 1);
  }
  return Scaled(m, n, d);
}

// `second`: whether to compute the second derivatives, too.
Coordinate CoordinateOf(const BernsteinNet& net, int k, bool second) {
  std::vector<double> c;
  c.reserve(net.points.size());
  for (const Vec4& p : net.points) c.push_back(p[k]);
  const int m = net.degree_u, n = net.degree_v;
  const Form none(0, 0, 0.0);
  return {Scaled(m, n, c),
          Derivative(m, n, c, 1, 0),
          Derivative(m, n, c, 0, 1),
          second ? Derivative(m, n, c, 2, 0) : none,
          second ? Derivative(m, n, c, 1, 1) : none,
          second ? Derivative(m, n, c, 0, 2) : none};
}

// True if the degree of a form is too high to be worth its cost. The degree is a n + b for a polynomial net
// and rational_a n + rational_b for a rational one.
bool TooHigh(const BernsteinNet& net, int a, int b, int rational_a, int rational_b) {
  const int n = std::max(net.degree_u, net.degree_v);
  return (net.rational ? rational_a * n + rational_b : a * n + b) > kMaxDegreeOfForm;
}

// Determinant of the rows f, u, v of three coordinates.
Form Triple(const Coordinate& a, const Coordinate& b, const Coordinate& c) {
  return a.f * (b.u * c.v - b.v * c.u) + b.f * (c.u * a.v - c.v * a.u) + c.f * (a.u * b.v - a.v * b.u);
}

// The net's coordinates and its normal w^3 S_u x S_v. The fourth entry of the normal completes a plane.
struct Parts {
  bool rational = false;
  std::vector<Coordinate> x;  // X Y Z, and W if rational
  std::vector<Form> normal;
};

Parts MakeParts(const BernsteinNet& net, bool second = false) {
  Parts parts;
  parts.rational = net.rational;
  for (int k = 0; k < (net.rational ? 4 : 3); ++k) parts.x.push_back(CoordinateOf(net, k, second));
  for (std::size_t k = 0; k < 3; ++k) {
    const Coordinate &b = parts.x[(k + 1) % 3], &c = parts.x[(k + 2) % 3];
    parts.normal.push_back(net.rational ? Triple(b, c, parts.x[3]) : b.u * c.v - b.v * c.u);
  }
  if (net.rational) parts.normal.push_back(-1.0 * Triple(parts.x[0], parts.x[1], parts.x[2]));
  return parts;
}

// Relative error of a form. Differences of points far from the origin have fewer digits left.
double Noise(const BernsteinNet& net) {
  double reach = 0.0, extent = 0.0;
  for (const Vec4& p : net.points) {
    reach = std::max(reach, p.head<3>().norm());
    extent = std::max(extent, (p - net.points.front()).head<3>().norm());
  }
  return extent > 0.0 ? kRounding * (1.0 + reach / extent) : 0.0;
}

double LargestNormal(const Parts& parts) {
  return std::max({Largest(parts.normal[0]), Largest(parts.normal[1]), Largest(parts.normal[2])});
}

// w^4 (S_u x S_v) . S_ij, or w^0 times it for a polynomial net.
Form SecondForm(const Parts& parts, Form Coordinate::*derivative) {
  Form sum = parts.normal[0] * (parts.x[0].*derivative);
  for (std::size_t k = 1; k < parts.x.size(); ++k) sum = sum + parts.normal[k] * (parts.x[k].*derivative);
  return sum;
}

// w^2 z_u (or w^2 z_v).
Form Rise(const Parts& parts, Form Coordinate::*derivative) {
  const Coordinate& z = parts.x[2];
  if (!parts.rational) return z.*derivative;
  const Coordinate& w = parts.x[3];
  return (z.*derivative) * w.f - z.f * (w.*derivative);
}

// The derivative of a polynomial that is given as a form.
Form Derived(const Form& f, bool along_u) {
  int m = f.m, n = f.n;
  const std::vector<double> d = Differences(m, n, f.Unscaled(), along_u);
  if (along_u) m = std::max(0, m - 1);
  if (!along_u) n = std::max(0, n - 1);
  return Scaled(m, n, d);
}

Form Dot(const Parts& parts, const Form (&other)[3]) {
  return parts.normal[0] * other[0] + parts.normal[1] * other[1] + parts.normal[2] * other[2];
}

}  // namespace

std::optional<BernsteinForm> TurnForm(const BernsteinNet& net) {
  if (TooHigh(net, 2, -1, 3, -1)) return std::nullopt;
  const Parts parts = MakeParts(net);
  return Finished(parts.normal[2], Noise(net), LargestNormal(parts));
}

std::optional<BernsteinForm> SlopeForm(const BernsteinNet& net, double cosine) {
  if (TooHigh(net, 4, -2, 6, -2)) return std::nullopt;
  const Parts parts = MakeParts(net);
  const double c2 = cosine * cosine, largest = LargestNormal(parts);
  const auto& n = parts.normal;
  return Finished((1.0 - c2) * (n[2] * n[2]) - c2 * (n[0] * n[0] + n[1] * n[1]), Noise(net),
                  largest * largest);
}

std::optional<BernsteinForm> EyeForm(const BernsteinNet& net, const Vec3& eye) {
  if (TooHigh(net, 3, -1, 3, -1)) return std::nullopt;
  BernsteinNet moved = net;
  double reach = 0.0;
  for (Vec4& p : moved.points) {
    p.head<3>() -= p.w() * eye;
    reach = std::max(reach, p.head<3>().norm());
  }
  const Parts parts = MakeParts(moved);
  // w^3 (S - eye) . (S_u x S_v) is the determinant of the moved net and its derivatives.
  const Form form = Triple(parts.x[0], parts.x[1], parts.x[2]);
  return Finished(form, Noise(moved), LargestNormal(parts) * reach);
}

std::optional<BernsteinForm> ContourCurvatureForm(const BernsteinNet& net) {
  if (TooHigh(net, 5, -3, 8, -3)) return std::nullopt;
  const Parts parts = MakeParts(net, true);
  const Form zu = Rise(parts, &Coordinate::u), zv = Rise(parts, &Coordinate::v);
  const auto degree = [&](int n) { return net.rational ? 8 * n - 3 : 5 * n - 3; };
  // A coordinate of degree 1 has no second derivative. Its term is left out.
  Form sum(degree(net.degree_u), degree(net.degree_v), 0.0);
  if (net.degree_u > 1) sum = sum + SecondForm(parts, &Coordinate::uu) * (zv * zv);
  sum = sum - 2.0 * (SecondForm(parts, &Coordinate::uv) * (zu * zv));
  if (net.degree_v > 1) sum = sum + SecondForm(parts, &Coordinate::vv) * (zu * zu);
  const double largest = LargestNormal(parts);
  return Finished(sum, Noise(net), largest * largest * largest);
}

std::optional<BernsteinForm> SlopeExtremumForm(const BernsteinNet& net) {
  if (TooHigh(net, 7, -4, 11, -4)) return std::nullopt;
  const Parts parts = MakeParts(net);
  const Form zu = Rise(parts, &Coordinate::u), zv = Rise(parts, &Coordinate::v);
  // With N along the normal, the form is |N|^3 times the derivative of N_z / |N| along the contour: (N . N)
  // dN_z - N_z (N . dN), d = z_v d/du - z_u d/dv. It equals [lines (10)] up to a positive factor.
  Form along[3] = {Form(0, 0, 0.0), Form(0, 0, 0.0), Form(0, 0, 0.0)};
  for (std::size_t k = 0; k < 3; ++k)
    along[k] = zv * Derived(parts.normal[k], true) - zu * Derived(parts.normal[k], false);
  const Form squared = parts.normal[0] * parts.normal[0] + parts.normal[1] * parts.normal[1] +
                       parts.normal[2] * parts.normal[2];
  const Form form = squared * along[2] - parts.normal[2] * Dot(parts, along);
  const double largest = LargestNormal(parts);
  return Finished(form, Noise(net), largest * largest * largest * std::max(Largest(zu), Largest(zv)));
}

std::optional<BernsteinForm> LevelForm(const BernsteinNet& net, const Vec3& axis, double level) {
  BernsteinForm form{net.degree_u, net.degree_v, {}, 0.0, 0.0};
  for (const Vec4& p : net.points) {
    const double height = axis.dot(p.head<3>());
    form.c.push_back(height - level * p.w());
    form.slack = std::max(form.slack, 1e-12 * (std::abs(height) + std::abs(level * p.w())));
  }
  return form;
}

}  // namespace patchmill
