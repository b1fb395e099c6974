// What the files of Locator share.
#pragma once

#include <atomic>
#include <optional>
#include <span>
#include <vector>

#include "cam/location/local_search.h"
#include "cam/location/locator.h"
#include "cam/location/search_tree.h"
#include "cam/location/tree_walk.h"

namespace patchmill {

struct Locator::Impl {
  Impl(const Surface& surface, double radius, internal::SearchTree tree);

  // For floats of centres and boxes as large as `reach`, which are off by 6e-8 of it each.
  internal::WalkLimits Limits() const {
    return {static_cast<float>(radius * radius + 1e-6 * radius * (radius + reach)),
            static_cast<float>(radius + 1e-6 * (radius + reach))};
  }

  // What a search is for: the highest contact, or any, as good as the highest where only a free ball counts.
  enum class Aim { kHighest, kAny };

  internal::Ball BallAt(const Vec2& q) const { return {q, radius, rounding}; }
  double ProofF() const { return radius * (0.5 * radius - slack); }  // f a proof accepts as outside
  // A centre height below every contact: c = (q, lowest) makes the upward ray a vertical line.
  double Lowest() const { return surface.box.min.z() - radius - 1.0; }

  // Leaves a search could not prove: their bounds rest on a few local searches, which may miss a maximum.
  using OpenLeaves = std::vector<std::int32_t>;

  // Raises best.z to h(q) by branch and bound over the leaves, but for what `open` receives. best.z >=
  // Lowest(); stops at the first contact above `enough`.
  void Search(const internal::Ball& ball, double enough, Aim aim, internal::Contact& best,
              OpenLeaves& open) const;
  // The whole search: what it leaves open is divided until proven. Returns the gap, see Certify.
  double SearchAll(const internal::Ball& ball, double eps, internal::Contact& best, OpenLeaves& open) const;
  // A contact of the ball at height z; nullopt where it is free, with how far it has to be lifted at most to
  // be proven so.
  struct FreeBall {
    std::optional<internal::Contact> contact;
    double lift = 0.0;  // mm
  };
  FreeBall TryFree(const internal::Ball& ball, double z, double eps, OpenLeaves& open) const;
  // The rest of it, when no contact was found and `open` is what was left.
  FreeBall ProveFree(const internal::Ball& ball, double z, double eps,
                     std::span<const std::int32_t> open) const;
  // A contact above the height found before by more than rounding explains.
  bool Raised(double before, const internal::Contact& c) const;
  // Whether the best contact lies on this part of a piece and is proven to be all of it that a ball at best.z
  // meets. `low` as BoundBelow gives it for that ball.
  bool IsOnlyContact(const internal::Contact& best, std::int32_t piece, const internal::Rect& rect,
                     const internal::LeafModel& model, const internal::LowerModel& low,
                     const internal::Ball& ball) const;
  void VisitLeaf(std::int32_t leaf, const internal::Ball& ball, Aim aim, internal::Contact& best,
                 OpenLeaves& open) const;
  void StartFromHint(const internal::Ball& ball, const SurfacePoint& hint, internal::Contact& best) const;

  // Proves the open leaves of a finished search, or improves `best`, by subdividing their nets. Returns the
  // gap: h <= best.z + gap. At most eps unless the budget of parts ran out; then the honest rest. For any
  // contact it stops at the first that is no rounding, and proves nothing then.
  double Certify(const internal::Ball& ball, std::span<const std::int32_t> open, double eps, Aim aim,
                 internal::Contact& best) const;

  SurfacePoint PointOf(const internal::Contact& c) const { return {PieceId(c.piece), c.u, c.v, c.p}; }

  const Surface& surface;
  double radius = 0.0;
  double rounding = 0.0;  // mm, of coordinates: 1e-14 of the scale, what a search tells apart
  double slack = 0.0;     // mm: 1e-12 of the scale, what a proof allows itself
  double reach = 0.0;     // mm: largest coordinate of a centre that touches anything
  internal::SearchTree tree;
  mutable std::atomic<std::uint64_t> defects{0};
};

}  // namespace patchmill
