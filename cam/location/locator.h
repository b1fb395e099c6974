// Exact cutter location for a ball ([location]): the lowest centre height without gouge over a whole Surface.
//
//   h(q) = max { p_z + sqrt(R^2 - |p_xy - q|^2) : p on the surface, |p_xy - q| <= R }
//
// What a certificate proves, and why it holds near the ball's equator, too. (There h changes by the square
// root of a rounding of the surface.) Let U(z) be the ball at height z with everything above it, and f(p)
// half the squared distance of p from the upward ray of its centre. p is outside U(z) iff f >= R^2 / 2.
//   - U(z) shrinks as z grows. So a part of the surface proven outside U(z') for one z' <= z + gap is outside
//     U(z + gap). If every part is, h <= z + gap ([location T1]). No derivative of h is used, so nothing
//     fails where h is steep or jumps. The gap is one of heights, not one of f turned into heights.
//   - Above the centre f measures in plan: f = 1/2 |p - c|^2 below its level, 1/2 |p_xy - c_xy|^2 above. f is
//     once differentiable across the level. On a part where both forms have positive definite Hessians f is
//     convex. A point that satisfies the KKT conditions is then its only minimum ([location T6]), wherever
//     the level runs.
//   - Every search, lanes included, divides the leaves that no such proof has closed. It ends when a proof
//     closes them or the gap is at most the requested one (kProofGap). Local searches alone would miss
//     maxima; heights_certificate_fuzz_test.cc has examples.
//   - Proofs count f >= R (R/2 - d), d = 1e-12 of the scale, as outside. So [z, z + gap] holds for the
//     surface up to d. In heights this is d R / b, at most sqrt(2 R d), where b is the height of the centre
//     above the contact.
//
// The whole surface counts: all kinds of patches, open edges, vertical walls, layers ([location T1]).
// Thread-safe: const methods only, scratch memory is thread-local.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include <absl/status/statusor.h>

#include "core/base/run_context.h"
#include "core/surface/surface.h"

namespace patchmill {

// mm, the default gap to which heights and free balls are proven. Where a ball fits a hollow exactly, this
// takes half a millisecond. Callers that need less should pass a larger gap (tests/bench/README.md says what
// it saves).
inline constexpr double kProofGap = 1e-6;

struct CenterPoint {
  double z = 0.0;  // mm, centre height
  SurfacePoint contact;
};

// Value of a certified query: the true height lies in [z, z + gap].
struct CertifiedCenter {
  double z = 0.0;
  double gap = 0.0;
  SurfacePoint contact;
};

class Locator {
 public:
  struct Impl;  // for use within cam/location only
  const Impl& impl() const { return *impl_; }

  // Keeps a reference to `surface`. radius > 0, mm (tool radius + stock to leave). Cuts the pieces into
  // leaves that suit the radius, with second-order models. Parallel, deterministic. Cost: about 4 us and 170
  // bytes per leaf. CANCELLED and DEADLINE_EXCEEDED from `run`, within 0.2 s.
  static absl::StatusOr<Locator> Make(const Surface& surface, double radius, const RunContext& run);
  Locator(const Surface& surface, double radius);  // the same, never cancelled
  ~Locator();
  Locator(Locator&&) noexcept;
  Locator(const Locator&) = delete;

  const Surface& surface() const;
  double radius() const;

  // h(q); nullopt if no surface point lies within R of q in plan. It is proven to `gap` as CertifiedHeight
  // is, but the gap is not returned (20,000 parts may not suffice). The error is <= 1e-9 mm against closed
  // forms where the branch and bound closes. For a contact near the equator, heights change by the square
  // root of roundings of the surface. With the height b = z - p_z of the centre above the contact and a
  // rounding d of the surface (4e-14 of the scale), the error is then sqrt(b^2 + 2 R d) - b. That is about
  // R d / b, and at most 5e-6 mm for R = 3 on a part of 100 mm. `hint` is a contact nearby. It is only for
  // speed and changes the value within these errors.
  std::optional<CenterPoint> Height(const Vec2& q, const SurfacePoint* hint = nullptr,
                                    double gap = kProofGap) const;

  // The same with proof: bounds are subdivided until the gap is at most eps (mm, >= 1e-7), or eps / 2 plus
  // the slack of a proof, 1e-12 of the scale. (The slack exceeds that half only beyond 250 m for eps 1e-6.)
  // If 20,000 parts do not suffice, the gap says what is left.
  std::optional<CertifiedCenter> CertifiedHeight(const Vec2& q, double eps,
                                                 const SurfacePoint* hint = nullptr) const;

  // Returns the place to which the contact `from` moves when the tool moves to q: the local maximum of g_p(q)
  // = p_z + sqrt(R^2 - |p_xy - q|^2) over the surface points p of the same branch of the surface, across
  // borders of patches. nullopt if the branch ends, because the contact leaves the disc |p_xy - q| <= R.
  std::optional<CenterPoint> Follow(const SurfacePoint& from, const Vec2& q) const;

  // True iff the ball at the centre c is free with its upward sweep: h(c_xy) <= c_z + slack (mm). It ends at
  // the first contact, so it costs less than Height. Proven like Height: up to `gap` (mm) and rounding,
  // except for the rare place where 20,000 parts do not suffice.
  bool Free(const Vec3& c, double slack = 0.0, double gap = kProofGap) const;

  // Free with proof. Returns the height (mm) by which the ball must be lifted to be proven free: at most
  // `eps` as for CertifiedHeight, or more if 20,000 parts do not suffice. nullopt if the ball is not free.
  std::optional<double> CertifiedFree(const Vec3& c, double eps) const;

  // Returns an upper bound (mm) of h over a rectangle in plan with opposite corners a and b and sides along x
  // and y, widened by `half_width` (mm, >= 0). It exceeds the true maximum by about `slack` (mm) at most.
  // -infinity if there is no surface. At this height of the centre a control may move from a to b one axis
  // after the other.
  double MaxHeight(const Vec2& a, const Vec2& b, double half_width, double slack = 0.1) const;

  // Returns the gouge (mm) of the straight move from a to b: the largest value, over the surface points p, of
  // R - distance(p, K), positive part, where K is the segment a b with everything above it. A proven upper
  // bound, exact to `eps` (mm).
  double SweptGouge(const Vec3& a, const Vec3& b, double eps) const;

  // True proves that SweptGouge is at most `limit` (mm); false means that it is above limit - eps. Much
  // cheaper than SweptGouge, because parts of the surface that stay well below the limit are never divided.
  bool GougeWithin(const Vec3& a, const Vec3& b, double limit, double eps) const;

  // Checks a centre c that was found without this class, along a contour. nullopt if c is proven free to
  // `gap` (CertifiedFree) and to 1e-9 mm, the accuracy of such centres, or if the ball and its upward sweep
  // are proven to gouge by at most `gap` (GougeWithin). Otherwise returns the certified height over c_xy,
  // which is above c_z, and counts a defect.
  std::optional<CertifiedCenter> Correction(const Vec3& c, double gap,
                                            const SurfacePoint* hint = nullptr) const;
  // The number of centres that Correction had to raise. Tests demand 0.
  std::uint64_t defect_count() const;

 private:
  explicit Locator(std::unique_ptr<Impl> impl);

  std::unique_ptr<Impl> impl_;
};

}  // namespace patchmill
