#include <optional>

#include "core/base/segment.h"
#include "core/lines/zero_mesh.h"
#include "core/lines/zero_root.h"

namespace patchmill {
namespace {

constexpr int kMostHalvings = 12;

class Refiner {
 public:
  Refiner(const Piece& piece, const ZeroField& field, double tolerance)
      : piece_(piece), field_(field), tolerance_(tolerance) {}

  // The first chord is looked at in three places: an arc of two bends may cross it in the middle.
  void AddFirst(const Vec2& from, const Vec2& to, std::vector<Vec2>& out) const {
    const Vec3 a = At(from), b = At(to);
    if ((b - a).norm() <= tolerance_) return;
    const std::optional<Vec2> root = OnPerpendicular(from, to, (b - a).norm());
    if (!root) return;
    std::vector<Vec2> halves;
    Add(from, *root, kMostHalvings, halves);
    const std::size_t middle = halves.size();
    halves.push_back(*root);
    Add(*root, to, kMostHalvings, halves);
    const bool straight = halves.size() == 1 && Near(*root, a, b) && NearAtQuarter(from, *root, a, b) &&
                          NearAtQuarter(*root, to, a, b);
    if (straight) halves.erase(halves.begin() + static_cast<std::ptrdiff_t>(middle));
    out.insert(out.end(), halves.begin(), halves.end());
  }

 private:
  Vec3 At(const Vec2& q) const { return Position(piece_, q.x(), q.y()); }
  bool Near(const Vec2& q, const Vec3& a, const Vec3& b) const {
    return SegmentDistance(At(q), a, b) <= tolerance_;
  }
  bool NearAtQuarter(const Vec2& from, const Vec2& to, const Vec3& a, const Vec3& b) const {
    const std::optional<Vec2> root = OnPerpendicular(from, to, (At(to) - At(from)).norm());
    return !root || Near(*root, a, b);
  }

  void Add(const Vec2& from, const Vec2& to, int depth, std::vector<Vec2>& out) const {
    const Vec3 a = At(from), b = At(to);
    if (depth == 0 || (b - a).norm() <= tolerance_) return;
    const std::optional<Vec2> root = OnPerpendicular(from, to, (b - a).norm());
    if (!root || Near(*root, a, b)) return;
    Add(from, *root, depth - 1, out);
    out.push_back(*root);
    Add(*root, to, depth - 1, out);
  }

  // The root on the perpendicular through the chord's middle, at most half a chord away, inside the piece.
  std::optional<Vec2> OnPerpendicular(const Vec2& from, const Vec2& to, double length) const {
    const Vec2 mid = 0.5 * (from + to), across(-(to - from).y(), (to - from).x());
    const double at_mid = Value(field_, piece_, mid);
    if (at_mid == 0.0) return mid;
    for (const double reach : {0.05, 0.15, 0.5}) {
      for (const double side : {reach, -reach}) {
        const Vec2 q = mid + Inside(mid, side * across) * side * across;
        const double at_q = Value(field_, piece_, q);
        if ((at_q > 0.0) == (at_mid > 0.0)) continue;
        const double stop = field_.resolution / std::max(length * reach, 1e-9);
        return Vec2(mid + ZeroBetween(field_, piece_, mid, q, at_mid, at_q, stop) * (q - mid));
      }
    }
    return std::nullopt;
  }

  // The largest part of `step` from `at` that stays in the piece.
  static double Inside(const Vec2& at, const Vec2& step) {
    double part = 1.0;
    for (int c = 0; c < 2; ++c) {
      if (at[c] + step[c] > 1.0) part = std::min(part, (1.0 - at[c]) / step[c]);
      if (at[c] + step[c] < 0.0) part = std::min(part, -at[c] / step[c]);
    }
    return part;
  }

  const Piece& piece_;
  const ZeroField& field_;
  double tolerance_;
};

}  // namespace

std::vector<Vec2> RefineZeroArc(const Piece& piece, const ZeroField& field, const Vec2& from, const Vec2& to,
                                double tolerance) {
  std::vector<Vec2> out;
  Refiner(piece, field, tolerance).AddFirst(from, to, out);
  return out;
}

}  // namespace patchmill
