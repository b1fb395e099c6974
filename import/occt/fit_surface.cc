#include "import/occt/fit_surface.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include <absl/status/status.h>
#include <absl/strings/str_format.h>

#include "core/base/index.h"
#include "core/math/bernstein.h"
#include "import/occt/convert.h"

namespace patchmill {
namespace {

constexpr int kDegree = 5, kNodes = kDegree + 1;
constexpr std::size_t kMostParts = 200;

using Breaks = std::vector<double>;
using Basis = Eigen::Matrix<double, Eigen::Dynamic, kNodes>;  // Bernstein polynomials by place

// Chebyshev's places of [0, 1] with both ends, and those halfway between them.
std::array<double, kNodes> Nodes() {
  std::array<double, kNodes> at{};
  for (int k = 0; k < kNodes; ++k) at[At(k)] = 0.5 - 0.5 * std::cos(kPi * k / kDegree);
  return at;
}
std::array<double, kDegree> Between() {
  std::array<double, kDegree> at{};
  for (int k = 0; k < kDegree; ++k) at[At(k)] = 0.5 - 0.5 * std::cos(kPi * (k + 0.5) / kDegree);
  return at;
}

template <std::size_t kCount>
Basis BasisAt(const std::array<double, kCount>& places) {
  Basis basis(kCount, kNodes);
  for (std::size_t k = 0; k < kCount; ++k) {
    double b[kMaxBasisDegree + 1];
    AllBernstein(kDegree, places[k], b);
    for (int i = 0; i < kNodes; ++i) basis(static_cast<Eigen::Index>(k), i) = b[i];
  }
  return basis;
}

// One rectangle between breaks.
struct Cell {
  std::array<std::array<Vec3, kNodes>, kNodes> points;  // [u][v]
  double off_u = 0.0, off_v = 0.0;  // mm, largest distances found between the places of u, of v
};

class Fitter {
 public:
  explicit Fitter(const Geom_Surface& surface) : surface_(surface) {}

  Cell Fit(const ParameterRange& u, const ParameterRange& v) const {
    Cell cell;
    std::array<Square, 3> values;
    for (int i = 0; i < kNodes; ++i) {
      for (int j = 0; j < kNodes; ++j) {
        const Vec3 p = Place(u, v, nodes_[At(i)], nodes_[At(j)]);
        for (int axis = 0; axis < 3; ++axis) values[At(axis)](i, j) = p[axis];
      }
    }
    std::array<Square, 3> control;
    for (int axis = 0; axis < 3; ++axis)
      control[At(axis)] = inverse_ * values[At(axis)] * inverse_.transpose();
    for (int i = 0; i < kNodes; ++i) {
      for (int j = 0; j < kNodes; ++j)
        cell.points[At(i)][At(j)] = {control[0](i, j), control[1](i, j), control[2](i, j)};
    }
    const auto off = [&](double s, double t, const auto& along_u, const auto& along_v) {
      const Vec3 p(along_u * control[0] * along_v.transpose(), along_u * control[1] * along_v.transpose(),
                   along_u * control[2] * along_v.transpose());
      return (p - Place(u, v, s, t)).norm();
    };
    for (int i = 0; i < kDegree; ++i) {
      for (int j = 0; j < kNodes; ++j) {
        cell.off_u =
            std::max(cell.off_u, off(between_[At(i)], nodes_[At(j)], at_between_.row(i), at_nodes_.row(j)));
        cell.off_v =
            std::max(cell.off_v, off(nodes_[At(j)], between_[At(i)], at_nodes_.row(j), at_between_.row(i)));
      }
      for (int j = 0; j < kDegree; ++j) {
        const double both = off(between_[At(i)], between_[At(j)], at_between_.row(i), at_between_.row(j));
        // A distance between the places of both u and v counts for the direction that is worse already.
        (cell.off_u >= cell.off_v ? cell.off_u : cell.off_v) =
            std::max(std::max(cell.off_u, cell.off_v), both);
      }
    }
    return cell;
  }

 private:
  using Square = Eigen::Matrix<double, kNodes, kNodes>;

  Vec3 Place(const ParameterRange& u, const ParameterRange& v, double s, double t) const {
    // Both cells beside a line ask for the same parameters there.
    const double a = s == 1.0 ? u.high : u.low + s * (u.high - u.low);
    const double b = t == 1.0 ? v.high : v.low + t * (v.high - v.low);
    return ToVec3(surface_.Value(a, b));
  }

  const Geom_Surface& surface_;
  const std::array<double, kNodes> nodes_ = Nodes();
  const std::array<double, kDegree> between_ = Between();
  const Basis at_nodes_ = BasisAt(nodes_), at_between_ = BasisAt(between_);
  const Square inverse_ = Square(at_nodes_).inverse();
};

// The breaks with the spans halved that are not good enough.
Breaks Halved(const Breaks& breaks, const std::vector<bool>& coarse) {
  Breaks halved = {breaks.front()};
  for (std::size_t k = 0; k + 1 < breaks.size(); ++k) {
    if (coarse[k]) halved.push_back(0.5 * (breaks[k] + breaks[k + 1]));
    halved.push_back(breaks[k + 1]);
  }
  return halved;
}

std::vector<double> KnotVector(const Breaks& breaks) {
  std::vector<double> knots(At(kDegree + 1), breaks.front());
  for (std::size_t k = 1; k + 1 < breaks.size(); ++k) knots.insert(knots.end(), At(kDegree), breaks[k]);
  knots.insert(knots.end(), At(kDegree + 1), breaks.back());
  return knots;
}

BsplinePatch Assembled(const Breaks& u, const Breaks& v, const std::vector<Cell>& cells) {
  BsplinePatch patch;
  patch.degree_u = patch.degree_v = kDegree;
  patch.knots_u = KnotVector(u);
  patch.knots_v = KnotVector(v);
  const auto count_u = static_cast<int>(u.size()) - 1, count_v = static_cast<int>(v.size()) - 1;
  for (int i = 0; i <= count_u * kDegree; ++i) {
    for (int j = 0; j <= count_v * kDegree; ++j) {
      const int a = std::min(i / kDegree, count_u - 1), b = std::min(j / kDegree, count_v - 1);
      patch.points.push_back(cells[At(a * count_v + b)].points[At(i - a * kDegree)][At(j - b * kDegree)]);
    }
  }
  return patch;
}

}  // namespace

absl::StatusOr<FittedSurface> FitSurface(const Handle(Geom_Surface) & surface, const ParameterRange& u_range,
                                         const ParameterRange& v_range, double tolerance) {
  Breaks u = KnotsWithin(surface, u_range, true), v = KnotsWithin(surface, v_range, false);
  const Fitter fitter(*surface);
  for (;;) {
    if (u.size() > kMostParts + 1 || v.size() > kMostParts + 1) {
      return absl::InvalidArgumentError(
          absl::StrFormat("a surface could not be approximated within %g mm", tolerance));
    }
    std::vector<Cell> cells;
    std::vector<bool> coarse_u(u.size() - 1, false), coarse_v(v.size() - 1, false);
    double most = 0.0;
    bool good = true;
    for (std::size_t i = 0; i + 1 < u.size(); ++i) {
      for (std::size_t j = 0; j + 1 < v.size(); ++j) {
        cells.push_back(fitter.Fit({u[i], u[i + 1]}, {v[j], v[j + 1]}));
        const Cell& cell = cells.back();
        const bool bad_u = !(2.0 * cell.off_u <= tolerance), bad_v = !(2.0 * cell.off_v <= tolerance);
        coarse_u[i] = coarse_u[i] || bad_u;
        coarse_v[j] = coarse_v[j] || bad_v;
        good = good && !bad_u && !bad_v;
        most = std::max({most, cell.off_u, cell.off_v});
      }
    }
    if (good) return FittedSurface{Assembled(u, v, cells), 2.0 * most};
    u = Halved(u, coarse_u);
    v = Halved(v, coarse_v);
  }
}

}  // namespace patchmill
