#include "cam/location/search_tree.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <span>

#include "cam/location/half_spaces.h"
#include "cam/location/upright_sheet.h"
#include "core/base/parallel.h"
#include "core/base/status.h"
#include "core/surface/leaf_tree.h"
#include "core/surface/write_nodes.h"

namespace patchmill::internal {
namespace {

constexpr int kMaxLevel = 24;  // halvings of one piece, in both directions together
// Limits of a leaf, in radii. Where convexity is proven, models are tight and leaves may be thick. Where the
// ball is only kept off (the surface is too concave), boxes must be tight. Where nothing is proven, leaves
// are small.
constexpr double kConvexThickness = 1.0 / 15.0, kHollowThickness = 1.0 / 150.0;
constexpr double kOpenReach = 1.0 / 9.0;
// Rad from the vertical. Walls that lean less have high leaves: low leaves above a contact are hardly farther
// from the ball than the contact itself. Walls that lean more are quicker with low leaves.
constexpr double kWallSlope = 1e-4;
// Bounds the memory. If a piece needs more leaves, its limits are doubled until it does not.
constexpr std::size_t kMaxLeaves = 1'000'000, kMinLeavesPerPiece = 16;
constexpr std::size_t kBatch = 2048;  // pieces per batch

// The leaves of one piece and their boxes.
struct PieceLeaves {
  std::vector<SearchLeaf> leaves;
  std::vector<Box3> boxes;
};

enum class Proof { kConvex, kHollow, kOpen };

// The entries of a symmetric matrix, or their errors.
struct Entries {
  double uu, uv, vv;
};

// True if the matrix is positive definite for all errors of its entries up to these.
bool SurelyPositive(const Entries& m, const Entries& errors) {
  const double low_a = m.uu - errors.uu - errors.uv, low_c = m.vv - errors.vv - errors.uv;
  return low_a > 0.0 && low_c > 0.0 && low_a * low_c > m.uv * m.uv;
}

// Says whether the distance to a centre that rests on this side of the leaf (n: unit normal) is proven
// convex, or the ball can nowhere rest inside. The centre is not exactly above the leaf's middle: it is off
// by up to twice the leaf's reach, along the leaf.
Proof ProofOf(const LeafModel& m, const Vec3& n, double radius) {
  const double size = radius + m.reach, reach = m.reach;
  double e_uu = m.gram_uu + size * m.drift_uu, e_uv = m.gram_uv + size * m.drift_uv,
         e_vv = m.gram_vv + size * m.drift_vv;
  const double a = m.a.squaredNorm() - radius * n.dot(m.uu), b = m.a.dot(m.b) - radius * n.dot(m.uv),
               c = m.b.squaredNorm() - radius * n.dot(m.vv);
  // All of it is too concave for the ball: there is no contact inside, and other tests exclude it.
  if (!SurelyPositive({a + 2.0 * (e_uu + e_uv), b, c + 2.0 * (e_vv + e_uv)}, {e_uu, e_uv, e_vv})) {
    return Proof::kHollow;
  }
  const auto offset = [&](const Vec3& second) {
    const double across = n.dot(second);
    return 2.0 * reach * (second - across * n).norm() + reach * reach / radius * std::abs(across);
  };
  e_uu += offset(m.uu);
  e_uv += offset(m.uv);
  e_vv += offset(m.vv);
  if (!SurelyPositive({a, b, c}, {e_uu, e_uv, e_vv})) return Proof::kOpen;
  const double rise = m.z_max - m.s.z();
  if (radius * n.z() > 2.0 * rise) return Proof::kConvex;
  // A ball may rest on it with its centre below the leaf's top, see BoundBelow.
  const double az = std::abs(m.a.z()), bz = std::abs(m.b.z());
  const double h_uu = e_uu + 2.0 * az * m.drift_a + m.drift_a * m.drift_a + 2.0 * rise * m.drift_uu +
                      reach * std::abs(m.uu.z());
  const double h_vv = e_vv + 2.0 * bz * m.drift_b + m.drift_b * m.drift_b + 2.0 * rise * m.drift_vv +
                      reach * std::abs(m.vv.z());
  const double h_uv = e_uv + az * m.drift_b + bz * m.drift_a + m.drift_a * m.drift_b +
                      2.0 * rise * m.drift_uv + reach * std::abs(m.uv.z());
  const auto plan = [](const Vec3& x, const Vec3& y) { return x.x() * y.x() + x.y() * y.y(); };
  const bool flat_enough =
      SurelyPositive({plan(m.a, m.a) - radius * plan(n, m.uu), plan(m.a, m.b) - radius * plan(n, m.uv),
                      plan(m.b, m.b) - radius * plan(n, m.vv)},
                     {h_uu, h_uv, h_vv});
  return flat_enough ? Proof::kConvex : Proof::kOpen;
}

// Whether the distance is proven convex to balls beside a leaf that is nearly vertical, at any height and on
// both sides. Such a leaf need not be low.
bool IsConvexBeside(const LeafModel& m, const Vec2& n, double radius) {
  for (const double side : {radius, -radius}) {
    const Vec2 q = Xy(m.s) + side * n;
    for (const double z : {m.z_max, m.s.z(), m.s.z() - m.reach}) {
      if (!BoundBelow(m, Lift(q, z)).convex) return false;
    }
  }
  return true;
}

// The proof for all sides on which the ball may rest: both sides if the leaf may be vertical somewhere.
Proof ProofOf(const LeafModel& m, double radius) {
  Vec3 n = m.a.cross(m.b);
  const double length = n.norm();
  if (!(length > 0.0)) return Proof::kOpen;
  const bool wall = std::abs(n.z()) < kWallSlope * length;
  if (wall && m.plan && IsConvexBeside(m, Xy(n).normalized(), radius)) return Proof::kConvex;
  const double turn = m.drift_a * (m.b.norm() + m.drift_b) + m.drift_b * m.a.norm();  // turn of S_u x S_v
  const bool upright = !(std::abs(n.z()) > turn);
  n *= (n.z() < 0.0 ? -1.0 : 1.0) / length;
  const Proof up = ProofOf(m, n, radius);
  if (!upright || up == Proof::kOpen) return up;
  const Proof down = ProofOf(m, -n, radius);
  return down == Proof::kOpen || down == up ? down : Proof::kHollow;
}

std::size_t MostLeavesPerPiece(const Surface& surface) {
  return std::max(kMinLeavesPerPiece, kMaxLeaves / surface.pieces.size());
}

class PieceSplitter {
 public:
  // Splits the piece with this index.
  PieceSplitter(const Surface& surface, std::size_t piece, const LeafGrid& grid, double radius,
                const RunContext& run)
      : piece_(surface.pieces[piece]),
        piece_index_(static_cast<int>(piece)),
        grid_(grid),
        shape_{piece_.net.degree_u, piece_.net.degree_v},
        radius_(radius),
        upright_(UprightLinesOf(shape_, piece_.net.points.data(), 4e-14 * surface.scale)),
        max_leaves_(MostLeavesPerPiece(surface)),
        run_(run),
        buffer_(static_cast<std::size_t>(2 * kMaxLevel * shape_.count())) {}

  PieceLeaves Take() {
    for (;; coarseness_ *= 2.0) {
      out_ = {};
      Split(piece_.net.points.data(), Rect{}, 0);
      if (out_.leaves.size() <= max_leaves_ || stopped_) return std::move(out_);
    }
  }

 private:
  // The largest half thickness (mm) of a leaf of this model. Negative: it is too large, however thin it is.
  double MostThickness(const LeafModel& model, const Rect& r) const {
    const bool small = model.reach <= kOpenReach * radius_ * coarseness_;
    switch (ProofOf(model, radius_)) {
      case Proof::kConvex:
        return kConvexThickness * radius_ * coarseness_;
      case Proof::kHollow:
        // The ball cannot rest inside, but it may rest on the border of the piece.
        if (!small && (r.u0 == 0.0 || r.u1 == 1.0 || r.v0 == 0.0 || r.v1 == 1.0)) return -1.0;
        return kHollowThickness * radius_ * coarseness_;
      case Proof::kOpen:
        break;
    }
    return small ? kInfinity : -1.0;
  }

  // The upper edge of a wall decides alone where the ball may be. The tree keeps the lower edge, too:
  // contacts that wander over the surface (Locator::Follow) come onto the wall there.
  bool InsideWall(const Rect& r) const {
    return (upright_ == Upright::kAlongV && r.v0 > 0.0 && r.v1 < 1.0) ||
           (upright_ == Upright::kAlongU && r.u0 > 0.0 && r.u1 < 1.0);
  }

  void Split(const Vec4* points, const Rect& rect, int level) {
    if (out_.leaves.size() > max_leaves_ || stopped_ || InsideWall(rect)) return;
    std::array<Vec3, kMaxNetPoints> hull;
    const int hull_count = HullPoints(shape_, points, hull.data());
    const std::span<const Vec3> hull_points(hull.data(), static_cast<std::size_t>(hull_count));
    const LeafModel model = MakeLeafModel(piece_, points, hull_points, rect);
    const double thickness = level == kMaxLevel ? kInfinity : MostThickness(model, rect);
    if (thickness >= 0.0) {
      const RectBounds bounds = BoundPoints(shape_, points, hull.data(), hull_count);
      if (!(bounds.half.z() > thickness)) {
        out_.boxes.push_back(bounds.box);
        out_.leaves.emplace_back(grid_, piece_index_, rect, model, FramedHull{bounds.axis, hull_points});
        stopped_ = out_.leaves.size() % 256 == 0 && run_.Cancelled();
        return;
      }
    }
    const bool along_u = IsLongerAlongU(model);
    Vec4* low = buffer_.data() + 2 * level * shape_.count();
    Vec4* high = low + shape_.count();
    HalveNet(shape_, points, along_u, low, high);
    Rect first = rect, second = rect;
    (along_u ? first.u1 : first.v1) = along_u ? 0.5 * (rect.u0 + rect.u1) : 0.5 * (rect.v0 + rect.v1);
    (along_u ? second.u0 : second.v0) = along_u ? first.u1 : first.v1;
    Split(low, first, level + 1);
    Split(high, second, level + 1);
  }

  const Piece& piece_;
  int piece_index_;
  const LeafGrid& grid_;
  NetShape shape_;
  double radius_;
  Upright upright_;
  std::size_t max_leaves_;
  const RunContext& run_;
  std::vector<Vec4> buffer_;  // two halves per level
  double coarseness_ = 1.0;
  bool stopped_ = false;  // cancelled
  PieceLeaves out_;
};

}  // namespace

void SearchLeaves::Append(const std::vector<SearchLeaf>& leaves) {
  for (const SearchLeaf& leaf : leaves) {
    if (blocks_.empty() || blocks_.back().size() == kBlock) {
      blocks_.emplace_back();
      blocks_.back().reserve(kBlock);
    }
    blocks_.back().push_back(leaf);
  }
}

absl::StatusOr<SearchTree> BuildSearchTree(const Surface& surface, double radius, const RunContext& run) {
  const std::size_t count = surface.pieces.size();
  std::atomic<std::size_t> done{0};
  const auto report = [&] {
    const std::size_t n = done.fetch_add(1, std::memory_order_relaxed) + 1;
    if (n % (count / 64 + 1) == 0)
      run.Progress("location", static_cast<double>(n) / static_cast<double>(count));
  };
  SearchTree tree{{}, LeafGrid(surface.box), {}};
  std::vector<Box3> boxes;
  // Pieces are handled in batches, so that little memory is held twice.
  std::vector<PieceLeaves> parts(std::min(count, kBatch));
  for (std::size_t begin = 0; begin < count; begin += kBatch) {
    const std::size_t end = std::min(count, begin + kBatch);
    PM_RETURN_IF_ERROR(ParallelFor(run, nullptr, end - begin, [&](std::size_t k) {
      const std::size_t i = begin + k;
      parts[k] = PieceSplitter(surface, i, tree.grid, radius, run).Take();
      report();
    }));
    for (std::size_t k = 0; k < end - begin; ++k) {
      if (k % 64 == 0) PM_RETURN_IF_ERROR(run.Check());
      tree.leaves.Append(parts[k].leaves);
      boxes.insert(boxes.end(), parts[k].boxes.begin(), parts[k].boxes.end());
    }
  }
  parts = {};
  {
    const std::vector<SurfaceNode> binary = BuildLeafTree(boxes, run);
    PM_RETURN_IF_ERROR(run.Check());
    boxes = {};
    PM_RETURN_IF_ERROR(WriteNodes(binary, run, tree.nodes));
  }
  PM_RETURN_IF_ERROR(BoundByHalfSpaces(run, tree));
  return tree;
}

}  // namespace patchmill::internal
