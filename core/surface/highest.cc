#include "core/surface/highest.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/surface/net_cell.h"
#include "core/surface/node_walk.h"

namespace patchmill {
namespace {

constexpr int kMostSlopes = 6;  // slopes that are tried to bound the height of a hull inside the column

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
    rounding_ = 1e-12 * (surface.scale + extent);
    tolerance_ = std::max(tolerance, rounding_);
    reach_ = column.radius - tolerance_;
    half_ = 0.5 * (column.a - column.b).cwiseAbs();
  }

  // True if this point lies in the column of radius - tolerance and higher than above + tolerance. No search
  // can miss such a point.
  bool IsSure(const Vec3& p) const {
    return !TooLow(p.z() - rounding_) &&
           (Xy(p) - NearestOnSegment(column_.a, column_.b, Xy(p))).norm() < reach_ - rounding_;
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
  bool TooLow(double z) const { return !(z > known_ + tolerance_); }
  bool Done() const { return any_ && best_.has_value(); }

  // Minus the top of each box, so that the highest comes first. Infinite if the box stands beside the column.
  std::array<double, 4> Depths(const BoxNode& node) const {
    std::array<double, 4> depths;
    for (int k = 0; k < 4; ++k) {
      const Vec2 low(static_cast<double>(node.min_x[k]), static_cast<double>(node.min_y[k]));
      const Vec2 high(static_cast<double>(node.max_x[k]), static_cast<double>(node.max_y[k]));
      // The distance to the segment's own box is never more than the distance to the segment.
      const Vec2 gap = (low - middle_ - half_).cwiseMax(middle_ - half_ - high).cwiseMax(Vec2::Zero());
      depths[static_cast<std::size_t>(k)] =
          gap.squaredNorm() >= reach_ * reach_ ? kInfinity : -static_cast<double>(node.max_z[k]);
    }
    return depths;
  }

  // Compares the summed steps of the net. These are large even for a net that closes upon itself.
  bool LongerAlongU(const NetCell& cell, const Vec3* hull, int count) const {
    if (count < shape_.count()) {
      const NetBend bend = MeasureBend(shape_, cell.points, Vec3::UnitZ(), kInfinity);
      return bend.length_u >= bend.length_v;
    }
    const int row = shape_.degree_v + 1;
    double steps_u = 0.0, steps_v = 0.0;
    for (int i = row; i < count; ++i) steps_u += (hull[i] - hull[i - row]).lpNorm<1>();
    for (int i = 1; i < count; ++i) {
      if (i % row != 0) steps_v += (hull[i] - hull[i - 1]).lpNorm<1>();
    }
    // Compares means per line: there are `row` lines along u.
    return steps_u * (shape_.degree_u + 1) >= steps_v * row;
  }

  // An upper bound of the heights of a hull inside the column, and about where in the net the bound is
  // reached.
  struct Top {
    double z = kInfinity;
    Vec2 at = Vec2(0.5, 0.5);  // in the cell's own parameters [0,1]^2
  };

  // x[k] is how far the point k lies outside the column, by the linearised distance. Inside the column z is
  // at most the largest z - slope x, for any slope >= 0. The best slope is that of the edge over x = 0 of the
  // points' upper hull. It is exact to second order where the surface leaves the column.
  Top TopInside(const double* x, const Vec3* hull, int count) const {
    const auto highest = [&](double slope) {
      int best = 0;
      for (int k = 1; k < count; ++k) {
        if (hull[k].z() - slope * x[k] > hull[best].z() - slope * x[best]) best = k;
      }
      return best;
    };
    int out = highest(0.0), in = -1;
    Top top{hull[out].z(), At(out, count)};
    if (TooLow(top.z) || x[out] <= 0.0) return top;
    for (int k = 0; k < count; ++k) {
      if (x[k] < 0.0 && (in < 0 || hull[k].z() > hull[in].z())) in = k;
    }
    if (in < 0) return {-kInfinity, top.at};
    for (int step = 0; step < kMostSlopes && !TooLow(top.z); ++step) {
      const double slope = (hull[out].z() - hull[in].z()) / (x[out] - x[in]);
      const int best = highest(slope);
      const double z = hull[best].z() - slope * x[best];
      if (z < top.z) {
        const double inside = x[out] / (x[out] - x[in]);
        top = {z, inside * At(in, count) + (1.0 - inside) * At(out, count)};
      }
      if (best == out || best == in) break;
      (x[best] < 0.0 ? in : out) = best;
    }
    return top;
  }

  // The parameters of a point of the net. If some points were left out, the middle.
  Vec2 At(int point, int count) const {
    const int row = shape_.degree_v + 1;
    if (count < shape_.count() || shape_.degree_u == 0 || shape_.degree_v == 0) return Vec2(0.5, 0.5);
    return Vec2(static_cast<double>(point / row) / shape_.degree_u,
                static_cast<double>(point % row) / shape_.degree_v);
  }

  // True if the cell has no point in the column that is higher than the known one. Otherwise tightens `top`,
  // a bound of the cell's height, and sets `along_u`: whether the cell is longer along u.
  bool Excluded(const NetCell& cell, Top& top, bool& along_u) const {
    std::array<Vec3, kMaxNetPoints> hull;
    std::array<double, kMaxNetPoints> x;
    const int count = HullPoints(shape_, cell.points, hull.data());
    if (count == 0) return true;
    Box3 box;
    for (int i = 0; i < count; ++i) box.Add(hull[static_cast<std::size_t>(i)]);
    if (TooLow(box.max.z())) return true;
    const Vec2 center = Xy(Vec3(0.5 * (box.min + box.max)));
    const Vec2 nearest = NearestOnSegment(column_.a, column_.b, center);
    const double distance = (center - nearest).norm();
    // The half plane behind `nearest` holds the segment, so the distance to it is never more than the
    // distance to the segment.
    const Vec2 away = distance > 0.0 ? Vec2((center - nearest) / distance) : Vec2::Zero();
    for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
      x[i] = (Xy(hull[i]) - nearest).dot(away) - reach_;
    }
    const Top inside = TopInside(x.data(), hull.data(), count);
    top = {std::min(top.z, inside.z), inside.at};
    if (TooLow(top.z)) return true;
    along_u = LongerAlongU(cell, hull.data(), count);
    return false;
  }

  // The corners of a net lie on the surface.
  void TakeCorners(const NetCell& cell) {
    const int row = shape_.degree_v + 1;
    for (int k = 0; k < 4; ++k) {
      const Vec4& corner =
          cell.points[(k / 2 == 0 ? 0 : shape_.degree_u * row) + (k % 2 == 0 ? 0 : shape_.degree_v)];
      if (!(corner.w() > 0.0)) continue;
      Take({piece_, k / 2 == 0 ? cell.u0 : cell.u1, k % 2 == 0 ? cell.v0 : cell.v1,
            corner.head<3>() / corner.w()});
    }
  }

  void Take(const SurfacePoint& at) {
    if (!(at.p.z() > known_)) return;
    const Vec2 plan = Xy(at.p);
    if ((plan - NearestOnSegment(column_.a, column_.b, plan)).norm() >= column_.radius) return;
    known_ = at.p.z();
    best_ = at;
  }

  // As TopInside, for the leaf's oriented box. The slopes tried are those along which one side of the box
  // drops out.
  double TopOfBox(const SurfaceLeaf& leaf) const {
    const Vec3 center = leaf.center(), half = leaf.half();
    const Eigen::Matrix3d axis = leaf.axis();
    const Vec2 nearest = NearestOnSegment(column_.a, column_.b, Xy(center));
    const double distance = (Xy(center) - nearest).norm();
    if (distance == 0.0) return kInfinity;
    const Vec2 away = (Xy(center) - nearest) / distance;
    const Vec3 rises = axis.row(2).transpose(), leaves = axis.transpose() * Lift(away, 0.0);
    const double x = distance - reach_;
    if (x - leaves.cwiseAbs().dot(half) >= 0.0) return -kInfinity;
    double top = center.z() + rises.cwiseAbs().dot(half);
    for (int k = 0; k < 3; ++k) {
      const double slope = rises[k] / leaves[k];
      if (!(slope > 0.0) || !std::isfinite(slope)) continue;
      top = std::min(top, center.z() - slope * x + (rises - slope * leaves).cwiseAbs().dot(half));
    }
    return top;
  }

  void VisitLeaf(const SurfaceLeaf& leaf, double max_z) {
    if (TooLow(TopOfBox(leaf))) return;
    piece_ = leaf.piece;
    const BernsteinNet& net = surface_.piece(leaf.piece).net;
    shape_ = {net.degree_u, net.degree_v};
    const NetCell cell = LeafCell(net, leaf);
    Top top{max_z};
    bool along_u = true;
    if (!Excluded(cell, top, along_u)) Visit(cell, top, along_u);
  }

  // Searches a cell that is not excluded.
  void Visit(const NetCell& cell, const Top& top, bool along_u) {
    TakeCorners(cell);
    if (Done() || TooLow(top.z)) return;
    const double u = cell.u0 + top.at.x() * (cell.u1 - cell.u0),
                 v = cell.v0 + top.at.y() * (cell.v1 - cell.v0);
    Take({piece_, u, v, Position(surface_.piece(piece_), u, v)});
    if (Done() || TooLow(top.z) || cell.halvings >= kMaxHalvings) return;
    const std::array<NetCell, 2> part = Halves(shape_, cell, along_u);
    std::array<Top, 2> tops{top, top};
    std::array<bool, 2> ways{true, true}, open{};
    for (std::size_t k = 0; k < 2; ++k) {
      open[k] = !Excluded(part[k], tops[k], ways[k]);
    }
    const std::size_t first = tops[1].z > tops[0].z ? 1 : 0;
    for (const std::size_t k : {first, 1 - first}) {
      if (open[k] && !Done() && !TooLow(tops[k].z)) Visit(part[k], tops[k], ways[k]);
    }
  }

  const Surface& surface_;
  const Column column_;
  const bool any_;
  double known_;  // mm; only points higher than this count
  const Vec2 middle_;
  Vec2 half_;
  double rounding_ = 0.0, tolerance_ = 0.0, reach_ = 0.0;
  std::optional<SurfacePoint> best_;
  // The leaf at hand.
  PieceId piece_;
  NetShape shape_;
};

}  // namespace

std::optional<SurfacePoint> HighestInColumn(const Surface& surface, const Column& column, double above,
                                            double tolerance) {
  return Search(surface, column, above, tolerance, false).Run();
}

bool AnyInColumn(const Surface& surface, const Column& column, double above, double tolerance) {
  // The points found last mostly stand in the way of neighbouring columns, too. They may come from another
  // surface. So a kept place counts only if this surface's point at that place lies in the column.
  constexpr std::size_t kKept = 8;
  thread_local std::array<SurfacePoint, kKept> kept;
  thread_local std::size_t found_count = 0;
  Search search(surface, column, above, tolerance, true);
  for (std::size_t k = 0; k < std::min(found_count, kKept); ++k) {
    const SurfacePoint& at = kept[k];
    if (at.piece.index() < surface.pieces.size() && search.IsSure(at.p) &&
        search.IsSure(Position(surface.piece(at.piece), at.u, at.v))) {
      return true;
    }
  }
  const auto found = search.Run();
  if (found) kept[found_count++ % kKept] = *found;
  return found.has_value();
}

}  // namespace patchmill
