#include "core/surface/closest.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/status.h"
#include "core/surface/box_distance.h"
#include "core/surface/distance_form.h"
#include "core/surface/net_cell.h"
#include "core/surface/node_walk.h"

namespace patchmill {
namespace {

// A net with more points than this gets the distance polynomial only after so many halvings, because the cost
// of the polynomial grows with the square of the number of points.
constexpr int kLargeNet = 40;
constexpr int kHalvingsBeforeLargeForm = 1;

// Sets the distance of boxes that do not rise above c to infinity.
void LeaveBelow(const BoxNode& node, const Vec3& c, std::array<double, 4>& squared) {
  for (int k = 0; k < 4; ++k) {
    if (static_cast<double>(node.max_z[k]) <= c.z()) squared[static_cast<std::size_t>(k)] = kInfinity;
  }
}

enum class Wanted { kNearest, kAny, kNearestAbove };

template <Reach kReach>
class Search {
 public:
  Search(const Surface& surface, const Vec3& c, double limit, double tolerance, Wanted wanted)
      : surface_(surface), c_(c), wanted_(wanted), limit_(limit) {
    rounding_ = 1e-12 * (surface.scale + c.cwiseAbs().maxCoeff());
    tolerance_ = std::max(tolerance, rounding_);
  }

  std::optional<ClosestPoint> Run() {
    if (!c_.allFinite()) return std::nullopt;
    WalkNearestFirst(
        surface_.box_nodes,
        [&](const BoxNode& node) {
          std::array<double, 4> squared = SquaredDistances<kReach>(node, c_);
          if (wanted_ == Wanted::kNearestAbove) LeaveBelow(node, c_, squared);
          return squared;
        },
        [&](double squared) { return Excluded(squared); },
        [&](std::int32_t leaf, double max_z) {
          VisitLeaf(surface_.leaves[static_cast<std::size_t>(leaf)], max_z);
          return Done();
        });
    return best_;
  }

 private:
  // A point that is not nearer than this is of no interest.
  double Target() const { return std::min(limit_, best_ ? best_->distance : kInfinity) - tolerance_; }
  bool Excluded(double squared) const {
    const double target = Target();
    return target <= 0.0 || squared >= target * target;
  }
  bool Done() const { return Target() <= 0.0 || (wanted_ == Wanted::kAny && best_.has_value()); }

  static double OrientedSquared(const Vec3& center, const Eigen::Matrix3d& axis, const Vec3& half,
                                const Vec3& c, double max_z) {
    // If a box lies below the start of the ray, the distance to the ray is that to its start.
    return kReach == Reach::kPoint || max_z <= c.z() ? SquaredDistanceToPoint(center, axis, half, c)
                                                     : SquaredDistanceToUpwardRay(center, axis, half, c);
  }

  void VisitLeaf(const SurfaceLeaf& leaf, double max_z) {
    const double squared = OrientedSquared(leaf.center(), leaf.axis(), leaf.half(), c_, max_z);
    if (Excluded(squared)) return;
    piece_ = leaf.piece;
    const BernsteinNet& net = surface_.piece(leaf.piece).net;
    shape_ = {net.degree_u, net.degree_v};
    rational_ = net.rational;
    // A ray that passes through a leaf's box mostly meets the leaf. Then no polynomial is needed.
    if (!(Target() < kInfinity) || squared <= 0.0) {
      Improve(0.5 * (leaf.u0 + leaf.u1), 0.5 * (leaf.v0 + leaf.v1));
      if (Done()) return;
    }
    VisitCell(LeafCell(net, leaf, c_), max_z - c_.z());
  }

  // The cell's boxes have not excluded it. z_max is an upper bound of its height relative to c.
  void VisitCell(const NetCell& cell, double z_max) {
    bool along_u = true;
    if (shape_.count() > kLargeNet && cell.halvings < kHalvingsBeforeLargeForm) {
      const NetBend bend = MeasureBend(shape_, cell.points, Vec3::UnitZ(), kInfinity);
      along_u = bend.length_u >= bend.length_v;
    } else if (ExcludedByForm(cell, z_max, along_u)) {
      return;
    }
    if (Done() || cell.halvings >= kMaxHalvings) return;
    VisitHalves(cell, along_u);
  }

  // Returns true if the distance polynomial proves that the cell holds no nearer point. It may find a nearer
  // point first. Otherwise sets `along_u`: whether to halve along u.
  bool ExcludedByForm(const NetCell& cell, double z_max, bool& along_u) {
    // Above its start the ray is a vertical line, and the line is never farther than the ray. (A rim at
    // exactly the height of the start counts as below: the two distances differ by less than the rounding
    // slack.)
    const bool horizontal = kReach == Reach::kUpwardRay && z_max > 0.5 * rounding_;
    DistanceForm form;
    for (int attempt = 0; attempt < 8; ++attempt) {
      if (Done()) return true;
      MakeDistanceForm(shape_, cell.points, rational_, horizontal, Target(), form);
      const FormMinimum minimum = SmallestCoefficient(form);
      if (minimum.value >= 0.0) return true;
      const FormBend bend = BoundSecondDerivatives(form);
      along_u = bend.max_uu >= bend.max_vv;
      std::optional<Vec2> nearer;
      if (bend.convex) {
        const ConvexVerdict verdict = DecideConvex(form, minimum.place);
        if (verdict.nonnegative) return true;
        nearer = verdict.negative_at;
      } else if (Evaluate(form, minimum.place.x(), minimum.place.y()).f < 0.0) {
        nearer = minimum.place;
      }
      // With the vertical line (`horizontal`), a point nearer to the line need not be nearer to the ray.
      if (!nearer || !Improve(cell.u0 + nearer->x() * (cell.u1 - cell.u0),
                              cell.v0 + nearer->y() * (cell.v1 - cell.v0))) {
        break;
      }
    }
    return false;
  }

  void VisitHalves(const NetCell& cell, bool along_u) {
    const std::array<NetCell, 2> part = Halves(shape_, cell, along_u);
    std::array<double, 2> squared;
    std::array<Box3, 2> box;
    for (std::size_t k = 0; k < 2; ++k) {
      std::array<Vec3, kMaxNetPoints> hull;
      const int hull_count = HullPoints(shape_, part[k].points, hull.data());
      const RectBounds bounds = BoundPoints(shape_, part[k].points, hull.data(), hull_count);
      box[k] = bounds.box;
      squared[k] =
          std::max(SquaredDistance<kReach>(box[k], Vec3::Zero()),
                   OrientedSquared(bounds.center, bounds.axis, bounds.half, Vec3::Zero(), box[k].max.z()));
    }
    const std::size_t first = squared[1] < squared[0] ? 1 : 0;
    for (const std::size_t k : {first, 1 - first}) {
      if (!Excluded(squared[k])) VisitCell(part[k], box[k].max.z());
    }
  }

  // Descends from (u,v) over the whole piece. If the point found is nearer than the best one, keeps it and
  // returns true.
  bool Improve(double u, double v) {
    constexpr int kMaxSteps = 40;
    const Piece& piece = surface_.piece(piece_);
    SurfaceJet jet = Evaluate(piece, u, v);
    Vec3 d = FromSet<kReach>(jet.p - c_);
    double f = 0.5 * d.squaredNorm();
    for (int step = 0; step < kMaxSteps; ++step) {
      const Vec2 g(d.dot(jet.du), d.dot(jet.dv));
      // Above the start of the ray, height does not count.
      const double kz = kReach == Reach::kUpwardRay && jet.p.z() > c_.z() ? 0.0 : 1.0;
      const Vec3 du(jet.du.x(), jet.du.y(), kz * jet.du.z()), dv(jet.dv.x(), jet.dv.y(), kz * jet.dv.z());
      const Sym2 first{du.dot(jet.du), du.dot(jet.dv), dv.dot(jet.dv)};
      Sym2 h{first.uu + d.dot(jet.duu), first.uv + d.dot(jet.duv), first.vv + d.dot(jet.dvv)};
      if (!h.PositiveDefinite()) h = first;
      const double ridge = 1e-14 * (h.uu + h.vv);
      h.uu += ridge;
      h.vv += ridge;
      const Vec2 full = MinimizeInBox(g, h, Vec2(-u, -v), Vec2(1.0 - u, 1.0 - v));
      double scale = 1.0, new_f = f;
      double new_u = u, new_v = v;
      for (; scale > 1e-3; scale *= 0.5) {
        new_u = std::clamp(u + scale * full.x(), 0.0, 1.0);
        new_v = std::clamp(v + scale * full.y(), 0.0, 1.0);
        new_f = 0.5 * FromSet<kReach>(Position(piece, new_u, new_v) - c_).squaredNorm();
        if (new_f < f) break;
      }
      if (!(new_f < f)) break;
      const double gain = f - new_f;
      u = new_u;
      v = new_v;
      jet = Evaluate(piece, u, v);
      d = FromSet<kReach>(jet.p - c_);
      f = 0.5 * d.squaredNorm();
      // distance^2 / 2 changes by distance * change, so the distance changes by far less than the tolerance.
      if (gain < 1e-3 * tolerance_ * std::sqrt(f)) break;
    }
    const double distance = d.norm();
    const double known = std::min(limit_, best_ ? best_->distance : kInfinity);
    if (!(distance < known)) return false;
    best_ = ClosestPoint{{piece_, u, v, jet.p}, distance};
    return true;
  }

  const Surface& surface_;
  const Vec3 c_;
  const Wanted wanted_;
  const double limit_;
  double rounding_;
  double tolerance_;
  std::optional<ClosestPoint> best_;
  // The leaf at hand. Cells are relative to c_.
  PieceId piece_;
  NetShape shape_;
  bool rational_ = false;
};

}  // namespace

std::optional<ClosestPoint> ClosestToUpwardRay(const Surface& surface, const Vec3& c, double limit,
                                               double tolerance) {
  return Search<Reach::kUpwardRay>(surface, c, limit, tolerance, Wanted::kNearest).Run();
}

std::optional<ClosestPoint> ClosestAbove(const Surface& surface, const Vec3& c, double limit,
                                         double tolerance) {
  return Search<Reach::kUpwardRay>(surface, c, limit, tolerance, Wanted::kNearestAbove).Run();
}

bool MayRiseAbove(const Surface& surface, const Vec3& c, double limit) {
  bool found = false;
  WalkNearestFirst(
      surface.box_nodes,
      [&](const BoxNode& node) {
        std::array<double, 4> squared = SquaredDistances<Reach::kUpwardRay>(node, c);
        LeaveBelow(node, c, squared);
        return squared;
      },
      [&](double squared) { return squared >= limit * limit; },
      [&](std::int32_t, double) { return found = true; });
  return found;
}

std::optional<ClosestPoint> ClosestToPoint(const Surface& surface, const Vec3& c, double limit,
                                           double tolerance) {
  return Search<Reach::kPoint>(surface, c, limit, tolerance, Wanted::kNearest).Run();
}

std::optional<ClosestPoint> FirstNearPoint(const Surface& surface, const Vec3& c, double limit,
                                           double tolerance) {
  return Search<Reach::kPoint>(surface, c, limit, tolerance, Wanted::kAny).Run();
}

std::optional<ClosestPoint> FirstNearUpwardRay(const Surface& surface, const Vec3& c, double limit,
                                               double tolerance) {
  return Search<Reach::kUpwardRay>(surface, c, limit, tolerance, Wanted::kAny).Run();
}

bool AnythingNearUpwardRay(const Surface& surface, const Vec3& c, double limit, double tolerance) {
  return FirstNearUpwardRay(surface, c, limit, tolerance).has_value();
}

}  // namespace patchmill
