// The part of Locator that its source files share.
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

  // Limits for floats of centres and boxes as large as `reach`. Each such float is off by 6e-8 of it.
  internal::WalkLimits Limits() const {
    return {static_cast<float>(radius * radius + 1e-6 * radius * (radius + reach)),
            static_cast<float>(radius + 1e-6 * (radius + reach))};
  }

  // The aim of a search: the highest contact, or any contact, which suffices to know whether a ball is free.
  enum class Aim { kHighest, kAny };

  internal::Ball BallAt(const Vec2& q) const { return {q, radius, rounding}; }
  double ProofF() const { return radius * (0.5 * radius - slack); }  // f that a proof accepts as outside
  // A centre height below every contact: c = (q, lowest) makes the upward ray a vertical line.
  double Lowest() const { return surface.box.min.z() - radius - 1.0; }

  // Leaves that a search could not prove. Their bounds rest on a few local searches, which may miss a
  // maximum.
  using OpenLeaves = std::vector<std::int32_t>;

  // Raises best.z to h(q) by branch and bound over the leaves, except for those added to `open`. Requires
  // best.z >= Lowest(). Stops at the first contact above `enough`.
  void Search(const internal::Ball& ball, double enough, Aim aim, internal::Contact& best,
              OpenLeaves& open) const;
  // The whole search: leaves that it leaves open are divided until proven. Returns the gap, see Certify.
  double SearchAll(const internal::Ball& ball, double eps, internal::Contact& best, OpenLeaves& open) const;
  // A contact of the ball at height z. If there is none, the ball is free: it is proven to be after a lift of
  // at most `lift`.
  struct FreeBall {
    std::optional<internal::Contact> contact;
    double lift = 0.0;  // mm
  };
  FreeBall TryFree(const internal::Ball& ball, double z, double eps, OpenLeaves& open) const;
  // The second part of TryFree, for a search that found no contact and left `open`.
  FreeBall ProveFree(const internal::Ball& ball, double z, double eps,
                     std::span<const std::int32_t> open) const;
  // True if a contact is above the height `before` by more than rounding explains.
  bool Raised(double before, const internal::Contact& c) const;
  // True if the best contact lies on this part of a piece and is proven to be the only contact of the part
  // with a ball at best.z. `low` is BoundBelow for that ball.
  bool IsOnlyContact(const internal::Contact& best, const internal::PiecePart& part,
                     const internal::LeafModel& model, const internal::LowerModel& low,
                     const internal::Ball& ball) const;
  void VisitLeaf(std::int32_t leaf, const internal::Ball& ball, Aim aim, internal::Contact& best,
                 OpenLeaves& open) const;
  void StartFromHint(const internal::Ball& ball, const SurfacePoint& hint, internal::Contact& best) const;

  // Proves the open leaves of a finished search, or improves `best`, by subdividing their nets. Returns the
  // gap: h <= best.z + gap. It is at most eps unless the budget of parts was used up; then it says what is
  // left. With Aim::kAny it stops at the first contact that is more than rounding, and proves nothing then.
  double Certify(const internal::Ball& ball, std::span<const std::int32_t> open, double eps, Aim aim,
                 internal::Contact& best) const;

  SurfacePoint PointOf(const internal::Contact& c) const { return {PieceId(c.piece), c.u, c.v, c.p}; }

  const Surface& surface;
  double radius = 0.0;
  double rounding = 0.0;  // mm, 1e-14 of the scale: rounding of coordinates in a search
  double slack = 0.0;     // mm, 1e-12 of the scale: the slack of a proof
  double reach = 0.0;     // mm, largest coordinate of a centre that touches anything
  internal::SearchTree tree;
  mutable std::atomic<std::uint64_t> defects{0};
};

}  // namespace patchmill
