#include "core/trim/lower_degree.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include <absl/status/status.h>
#include <absl/strings/str_format.h>

#include "core/base/index.h"
#include "core/math/bernstein.h"
#include "core/trim/strip_net.h"

namespace patchmill {
namespace {

constexpr int kMostHalvings = 8;

// Lowers a row of control points of a degree to kLoweredDegree, and compares both.
struct RowMaps {
  Eigen::MatrixXd lower;  // (kLoweredDegree + 1) x (degree + 1)
  Eigen::MatrixXd
      differ;  // (degree + 1) x (degree + 1): the row less the lowered one, in the row's own degree
};

RowMaps MapsOf(int degree) {
  const int q = degree, d = kLoweredDegree, samples = 4 * q;
  const double slope = static_cast<double>(q) / d;
  Eigen::MatrixXd high(samples + 1, q + 1), low(samples + 1, d + 1);
  for (int k = 0; k <= samples; ++k) {
    double f[kMaxBasisDegree + 1];
    const double t = 0.5 - 0.5 * std::cos(kPi * k / samples);
    AllBernstein(q, t, f);
    for (int i = 0; i <= q; ++i) high(k, i) = f[i];
    AllBernstein(d, t, f);
    for (int i = 0; i <= d; ++i) low(k, i) = f[i];
  }
  RowMaps maps;
  maps.lower = Eigen::MatrixXd::Zero(d + 1, q + 1);
  maps.lower(0, 0) = maps.lower(d, q) = 1.0;
  maps.lower(1, 0) = maps.lower(d - 1, q) = 1.0 - slope;
  maps.lower(1, 1) = maps.lower(d - 1, q - 1) = slope;
  const Eigen::MatrixXd rest = high - low * maps.lower;
  maps.lower.middleRows(2, d - 3) = low.middleCols(2, d - 3).colPivHouseholderQr().solve(rest);
  // The lowered row in the degree q: both agree at all samples.
  maps.differ = Eigen::MatrixXd::Identity(q + 1, q + 1) - high.colPivHouseholderQr().solve(low * maps.lower);
  return maps;
}

struct LoweredNet {
  BernsteinNet net;
  double error = 0.0;  // mm; infinite if the weights say nothing
};

// Lowers the degree of v.
LoweredNet LowerV(const BernsteinNet& net, const RowMaps& maps) {
  const int p = net.degree_u, q = net.degree_v;
  Vec3 middle = Vec3::Zero();
  for (const Vec4& h : net.points) middle += h.head<3>() / h.w();
  middle /= static_cast<double>(net.points.size());
  LoweredNet lowered;
  lowered.net = {p, kLoweredDegree, net.rational, {}};
  double off = 0.0, weight_off = 0.0, reach = 0.0, least_weight = kInfinity;
  for (int i = 0; i <= p; ++i) {
    Eigen::MatrixXd row(q + 1, 4);  // about the middle
    for (int j = 0; j <= q; ++j) {
      const Vec4& h = net.points[At(i * (q + 1) + j)];
      row.row(j) << (h.head<3>() - h.w() * middle).transpose(), h.w();
      reach = std::max(reach, (h.head<3>() / h.w() - middle).norm());
      least_weight = std::min(least_weight, h.w());
    }
    const Eigen::MatrixXd difference = maps.differ * row, low = maps.lower * row;
    off = std::max(off, difference.leftCols<3>().rowwise().norm().maxCoeff());
    weight_off = std::max(weight_off, difference.col(3).cwiseAbs().maxCoeff());
    for (int j = 0; j <= kLoweredDegree; ++j) {
      const double w = low(j, 3);
      least_weight = std::min(least_weight, w);
      const Vec3 x = low.row(j).head<3>().transpose() + w * middle;
      lowered.net.points.push_back({x.x(), x.y(), x.z(), net.rational ? w : 1.0});
    }
  }
  // n / w - n' / w' = ((n - n') - (n / w) (w - w')) / w'
  lowered.error = least_weight > 0.0 ? (off + reach * weight_off) / least_weight : kInfinity;
  return lowered;
}

// The parts of a column of carriers with one v range, each lowered: [part][carrier].
struct LoweredColumn {
  std::vector<std::vector<BernsteinNet>> parts;
  double error = 0.0;
};

std::optional<LoweredColumn> LowerColumn(const std::vector<BernsteinNet>& column, const RowMaps& maps,
                                         double tolerance) {
  for (int halvings = 0; halvings <= kMostHalvings; ++halvings) {
    const int count = 1 << halvings;
    LoweredColumn lowered;
    for (int part = 0; part < count && lowered.error <= tolerance; ++part) {
      const double from = static_cast<double>(part) / count, to = static_cast<double>(part + 1) / count;
      std::vector<BernsteinNet>& nets = lowered.parts.emplace_back();
      for (const BernsteinNet& net : column) {
        LoweredNet low = LowerV(SubNet(net, 0.0, 1.0, from, to), maps);
        lowered.error = std::max(lowered.error, low.error);
        nets.push_back(std::move(low.net));
      }
    }
    if (lowered.error <= tolerance) return lowered;
  }
  return std::nullopt;
}

// Lowers the degree of v of all carriers, or of u if `turned`.
absl::StatusOr<LoweredGrid> LowerAxis(const CarrierGrid& grid, bool turned, double tolerance) {
  const GridAxis &along = turned ? grid.u : grid.v, &across = turned ? grid.v : grid.u;
  const auto net_at = [&](int i, int j) {  // j along the axis whose degree is lowered
    return turned ? Transposed(grid.carrier(j, i).net) : grid.carrier(i, j).net;
  };
  const RowMaps maps = MapsOf(net_at(0, 0).degree_v);
  LoweredGrid lowered;
  GridAxis axis{{along.breaks.front()}, false};
  std::vector<std::vector<BernsteinNet>> columns;  // [part along][carrier across]
  for (int j = 0; j < along.count(); ++j) {
    std::vector<BernsteinNet> column;
    for (int i = 0; i < across.count(); ++i) column.push_back(net_at(i, j));
    std::optional<LoweredColumn> low = LowerColumn(column, maps, tolerance);
    if (!low) {
      return absl::FailedPreconditionError(
          absl::StrFormat("the degree %d of its surface could not be lowered within %g mm",
                          maps.differ.rows() - 1, tolerance));
    }
    lowered.error = std::max(lowered.error, low->error);
    const double from = along.breaks[At(j)], to = along.breaks[At(j + 1)];
    const auto count = static_cast<int>(low->parts.size());
    for (int k = 1; k < count; ++k) axis.breaks.push_back(from + (to - from) * k / count);
    axis.breaks.push_back(to);
    for (std::vector<BernsteinNet>& part : low->parts) columns.push_back(std::move(part));
  }
  lowered.grid.size = grid.size;
  (turned ? lowered.grid.u : lowered.grid.v) = axis;
  (turned ? lowered.grid.v : lowered.grid.u) = across;
  for (int i = 0; i < lowered.grid.u.count(); ++i) {
    for (int j = 0; j < lowered.grid.v.count(); ++j) {
      Piece piece;
      piece.net = turned ? Transposed(columns[At(i)][At(j)]) : std::move(columns[At(j)][At(i)]);
      lowered.grid.carriers.push_back(std::move(piece));
    }
  }
  return lowered;
}

}  // namespace

absl::StatusOr<LoweredGrid> WithLowerDegrees(const CarrierGrid& grid, double tolerance) {
  LoweredGrid lowered{grid, 0.0};
  for (const bool turned : {false, true}) {
    const BernsteinNet& net = lowered.grid.carriers.front().net;
    if ((turned ? net.degree_u : net.degree_v) <= kLoweredDegree) continue;
    absl::StatusOr<LoweredGrid> next = LowerAxis(lowered.grid, turned, 0.5 * tolerance);
    if (!next.ok()) return next.status();
    next->error += lowered.error;
    lowered = *std::move(next);
  }
  return lowered;
}

}  // namespace patchmill
