#include "core/surface/highest.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "core/surface/net_kernel.h"
#include "core/surface/node_walk.h"

namespace patchmill {
namespace {

// A cell is halved at most this often below its leaf; the sides are then below rounding.
constexpr int kMaxHalvings = 90;

// Two nets per halving, reused by every query of a thread.
Vec4* CellBuffer(int halving, int count) {
  thread_local std::array<std::vector<Vec4>, kMaxHalvings + 1> buffers;
  std::vector<Vec4>& buffer = buffers[static_cast<std::size_t>(halving)];
  if (buffer.size() < 2 * static_cast<std::size_t>(count)) buffer.resize(2 * static_cast<std::size_t>(count));
  return buffer.data();
}

Vec2 NearestOnSegment(const Vec2& a, const Vec2& b, const Vec2& p) {
  const Vec2 d = b - a;
  const double length2 = d.squaredNorm();
  return length2 > 0.0 ? Vec2(a + std::clamp((p - a).dot(d) / length2, 0.0, 1.0) * d) : a;
}

class Search {
 public:
  Search(const Surface& surface, const Column& column, double above, double tolerance, bool any)
      : surface_(surface), column_(column), any_(any), known_(above), middle_(0.5 * (column.a + column.b)) {
    const double extent = std::max(column.a.cwiseAbs().maxCoeff(), column.b.cwiseAbs().maxCoeff());
    tolerance_ = std::max(tolerance, 1e-12 * (surface.scale + extent));
    reach_ = column.radius - tolerance_;
    half_ = 0.5 * (column.a - column.b).cwiseAbs();
  }

  std::optional<SurfacePoint> Run() {
    if (!(reach_ > 0.0) || !middle_.allFinite() || !half_.allFinite()) return std::nullopt;
    WalkNearestFirst(
        surface_.box_nodes, [&](const BoxNode& node) { return Depths(node); },
        [&](double depth) { return TooLow(-depth); },
        [&](std::int32_t leaf, double max_z) {
          VisitLeaf(surface_.leaves[static_cast<std::size_t>(leaf)], max_z);
          return Done();
        });
    return best_;
  }

 private:
  struct Cell {
    const Vec4* points;
    double u0, u1, v0, v1;
    int halvings;
  };

  bool TooLow(double z) const { return !(z > known_ + tolerance_); }
  bool Done() const { return any_ && best_.has_value(); }

  // Minus the top of each box, the highest first; infinite where it stands beside the column.
  std::array<double, 4> Depths(const BoxNode& node) const {
    std::array<double, 4> depths;
    for (int k = 0; k < 4; ++k) {
      const Vec2 low(static_cast<double>(node.min_x[k]), static_cast<double>(node.min_y[k]));
      const Vec2 high(static_cast<double>(node.max_x[k]), static_cast<double>(node.max_y[k]));
      // To the segment's own box: never more than to the segment.
      const Vec2 gap = (low - middle_ - half_).cwiseMax(middle_ - half_ - high).cwiseMax(Vec2::Zero());
      depths[static_cast<std::size_t>(k)] =
          gap.squaredNorm() >= reach_ * reach_ ? kInfinity : -static_cast<double>(node.max_z[k]);
    }
    return depths;
  }

  // Nothing of the cell is in the column and higher than what is known. `top`: a bound of its height, made
  // tighter; `along_u`: the longer way.
  bool Excluded(const Cell& cell, double& top, bool& along_u) const {
    std::array<Vec3, kMaxNetPoints> hull;
    const int count = HullPoints(shape_, cell.points, hull.data());
    if (count == 0) return true;
    Box3 box;
    for (int i = 0; i < count; ++i) box.Add(hull[static_cast<std::size_t>(i)]);
    top = std::min(top, box.max.z());
    if (TooLow(top)) return true;
    const Vec2 center = Plan(Vec3(0.5 * (box.min + box.max)));
    const Vec2 nearest = NearestOnSegment(column_.a, column_.b, center);
    const Vec2 away = center - nearest;
    const double distance = away.norm();
    // The half plane behind `nearest` holds the segment: the distance to it is never more.
    if (distance > 0.0) {
      double least = kInfinity;
      for (int i = 0; i < count; ++i) {
        least = std::min(least, (Plan(hull[static_cast<std::size_t>(i)]) - nearest).dot(away));
      }
      if (least >= reach_ * distance) return true;
    }
    const NetBend bend = MeasureBend(shape_, cell.points, Vec3::UnitZ(), kInfinity);
    along_u = bend.length_u >= bend.length_v;
    return false;
  }

  // Corners of a net are on the surface.
  void TakeCorners(const Cell& cell) {
    const int row = shape_.degree_v + 1;
    for (int k = 0; k < 4; ++k) {
      const Vec4& corner =
          cell.points[(k / 2 == 0 ? 0 : shape_.degree_u * row) + (k % 2 == 0 ? 0 : shape_.degree_v)];
      if (!(corner.w() > 0.0)) continue;
      const Vec3 p = corner.head<3>() / corner.w();
      if (!(p.z() > known_)) continue;
      const Vec2 plan = Plan(p);
      if ((plan - NearestOnSegment(column_.a, column_.b, plan)).norm() >= column_.radius) continue;
      known_ = p.z();
      best_ = SurfacePoint{piece_, k / 2 == 0 ? cell.u0 : cell.u1, k % 2 == 0 ? cell.v0 : cell.v1, p};
    }
  }

  void VisitLeaf(const SurfaceLeaf& leaf, double max_z) {
    piece_ = leaf.piece;
    const BernsteinNet& net = surface_.piece(leaf.piece).net;
    shape_ = {net.degree_u, net.degree_v};
    Vec4* points = CellBuffer(0, shape_.count());
    std::copy_n(net.points.begin(), shape_.count(), points);
    RestrictNet(shape_, points, leaf.u0, leaf.u1, leaf.v0, leaf.v1);
    const Cell cell{points, leaf.u0, leaf.u1, leaf.v0, leaf.v1, 0};
    bool along_u = true;
    if (!Excluded(cell, max_z, along_u)) Visit(cell, max_z, along_u);
  }

  // The cell is not excluded.
  void Visit(const Cell& cell, double top, bool along_u) {
    TakeCorners(cell);
    if (Done() || TooLow(top) || cell.halvings >= kMaxHalvings) return;
    const int halvings = cell.halvings + 1, count = shape_.count();
    std::array<Cell, 2> part{cell, cell};
    Vec4* low = CellBuffer(halvings, count);
    Vec4* high = low + count;
    HalveNet(shape_, cell.points, along_u, low, high);
    part[0].points = low;
    part[1].points = high;
    (along_u ? part[0].u1 : part[0].v1) = (along_u ? part[1].u0 : part[1].v0) =
        along_u ? 0.5 * (cell.u0 + cell.u1) : 0.5 * (cell.v0 + cell.v1);
    std::array<double, 2> tops{top, top};
    std::array<bool, 2> ways{true, true}, open{};
    for (std::size_t k = 0; k < 2; ++k) {
      part[k].halvings = halvings;
      open[k] = !Excluded(part[k], tops[k], ways[k]);
    }
    const std::size_t first = tops[1] > tops[0] ? 1 : 0;
    for (const std::size_t k : {first, 1 - first}) {
      if (open[k] && !Done() && !TooLow(tops[k])) Visit(part[k], tops[k], ways[k]);
    }
  }

  const Surface& surface_;
  const Column column_;
  const bool any_;
  double known_;  // mm: what is not higher does not count
  const Vec2 middle_;
  Vec2 half_;
  double tolerance_ = 0.0, reach_ = 0.0;
  std::optional<SurfacePoint> best_;
  // Of the leaf at hand.
  PieceId piece_;
  NetShape shape_;
};

}  // namespace

std::optional<SurfacePoint> HighestInColumn(const Surface& surface, const Column& column, double above,
                                            double tolerance) {
  return Search(surface, column, above, tolerance, false).Run();
}

std::optional<SurfacePoint> AnyInColumn(const Surface& surface, const Column& column, double above,
                                        double tolerance) {
  return Search(surface, column, above, tolerance, true).Run();
}

}  // namespace patchmill
