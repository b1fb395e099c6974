// What the files of Locator share.
#pragma once

#include <atomic>
#include <optional>
#include <span>
#include <vector>

#include "cam/location/local_search.h"
#include "cam/location/locator.h"
#include "cam/location/search_tree.h"

namespace patchmill {

struct Locator::Impl {
  Impl(const Surface& surface, double radius, internal::SearchTree tree);

  // Leaves a search could not prove, for the certificate. Where the ball nearly touches one of them elsewhere
  // than at its contact, other maxima of about the same height are likely: they are divided at once.
  struct OpenLeaves {
    std::vector<std::int32_t> all;
    double tie = -kInfinity;  // the highest centre at which one of them is touched besides the contact
    // Of a search for any contact: one of them stands near the equator of the ball, or it nearly touches two
    // places of them.
    bool doubtful = false;
    std::optional<Vec3> nearly;  // touched
    void Clear() {
      all.clear();
      tie = -kInfinity;
      doubtful = false;
      nearly.reset();
    }
  };
  // What a search is for: the highest contact, or any, as good as the highest where only a free ball counts.
  enum class Aim { kHighest, kAny };
  // Centre heights differ by less than kNearly radii: where a ball touches two places of an unproven leaf so
  // nearly at once, a few starts may have missed a third.
  static constexpr double kNearly = 1e-5;
  bool IsTie(double z, const internal::Contact& best) const { return z > best.z - kNearly * radius; }

  internal::Ball BallAt(const Vec2& q) const { return {q, radius, rounding}; }
  double ProofF() const { return radius * (0.5 * radius - slack); }  // f a proof accepts as outside
  // A centre height below every contact: c = (q, lowest) makes the upward ray a vertical line.
  double Lowest() const { return surface.box.min.z() - radius - 1.0; }

  // Raises best.z to h(q) by branch and bound over the leaves. best.z >= Lowest(); stops at the first contact
  // above `enough`. open receives the leaves whose bound rests on local searches alone.
  void Search(const internal::Ball& ball, double enough, Aim aim, internal::Contact& best,
              OpenLeaves& open) const;
  // The whole search: where it ends with a contact near the ball's equator, upright ground has too many local
  // maxima for a few starts, and its open leaves are divided until proven, to 1e-6 mm; so they
  // are, to 1e-8 mm, where two contacts tie.
  void SearchAll(const internal::Ball& ball, internal::Contact& best, OpenLeaves& open) const;
  // Radii below the centre: contacts above are near the equator. Ten million heights found a maximum missed
  // at 0.13, none lower.
  static constexpr double kEquator = 0.2;
  bool Grazes(const internal::Contact& c) const { return c.piece >= 0 && NearEquator(c.z, c.p); }
  bool NearEquator(double z, const Vec3& p) const { return z - p.z() < kEquator * radius; }
  // A contact of the ball at height z, none where it is free: with the same divisions as SearchAll where
  // nothing is found.
  internal::Contact AnyContact(const internal::Ball& ball, double z, OpenLeaves& open) const;
  // A contact above the height found before by more than rounding explains.
  bool Raised(double before, const internal::Contact& c) const;
  // Centre height at which the ball touches where the search ended, if more than kNearly radii away from its
  // best contact; -infinity: nowhere.
  double RunnerUp(const internal::SearchResult& ended, const internal::Ball& ball,
                  const internal::Contact& best) const;
  // Whether the best contact lies on this part of a piece and is proven to be all of it that a ball at best.z
  // meets. `low` as BoundBelow gives it for that ball.
  bool IsOnlyContact(const internal::Contact& best, std::int32_t piece, const internal::Rect& rect,
                     const internal::LeafModel& model, const internal::LowerModel& low,
                     const internal::Ball& ball) const;
  void VisitLeaf(std::int32_t leaf, const internal::Ball& ball, Aim aim, internal::Contact& best,
                 OpenLeaves& open) const;
  // What a search for any contact leaves of an unproven leaf: where it ended, none of it in the ball's way.
  void NoteMissed(std::span<const internal::SearchResult> ended, const internal::Ball& ball, double z,
                  OpenLeaves& open) const;
  void StartFromHint(const internal::Ball& ball, const SurfacePoint& hint, internal::Contact& best) const;

  // Proves the open leaves of a finished search, or improves `best`, by subdividing their nets. Returns the
  // gap: h <= best.z + gap. At most eps unless the budget of parts ran out; then the honest rest.
  double Certify(const internal::Ball& ball, const std::vector<std::int32_t>& open, double eps,
                 internal::Contact& best) const;

  SurfacePoint PointOf(const internal::Contact& c) const { return {PieceId(c.piece), c.u, c.v, c.p}; }

  const Surface& surface;
  double radius = 0.0;
  double rounding = 0.0;  // mm, of coordinates: 1e-14 of the scale, what a search tells apart
  double slack = 0.0;     // mm: 1e-12 of the scale, what a proof allows itself
  double reach = 0.0;     // mm: largest coordinate of a centre that touches anything
  internal::SearchTree tree;
  mutable std::atomic<std::uint64_t> defects{0}, equator_raises{0};
};

}  // namespace patchmill
