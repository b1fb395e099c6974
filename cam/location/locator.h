// Exact cutter location for a ball ([location]): the lowest centre height without gouge over a whole
// Surface.
//
//   h(q) = max { p_z + sqrt(R^2 - |p_xy - q|^2) : p on the surface, |p_xy - q| <= R }
//
// What a certificate proves, and why it holds near the ball's equator too, where h answers a rounding of the
// surface by its square root. Let U(z) be the ball at height z with everything above it, f(p) half the
// squared distance of p from the upward ray of its centre; p is outside U(z) iff f >= R^2 / 2.
//   - U(z) shrinks as z grows. A part of the surface proven outside U(z') for one z' <= z + gap is therefore
// outside U(z + gap); when every part is, h <= z + gap ([location T1]). No derivative of h is used, so
// nothing fails
//     where h is steep or jumps, and the gap is one of heights, not one of f turned into heights.
//   - Above the centre f measures in plan: f = 1/2 |p - c|^2 below its level, 1/2 |p_xy - c_xy|^2 above, once
//     differentiable across it. On a part where both forms have positive definite Hessians f is convex, and a
//     point that satisfies the KKT conditions is its only minimum ([location T6]), wherever the level runs.
//   - Every search, lanes included, divides the leaves that no such proof has closed until one does, or the
//     gap is what was asked for (kProofGap): starts alone miss maxima (certificate_fuzz_test has them).
//   - Proofs take f >= R (R/2 - d), d = 1e-12 of the scale, for outside: [z, z + gap] holds for the
//     surface up to d, in heights up to d R / b, at most sqrt(2 R d), b the height of the centre above the
//     contact.
//
// The whole surface counts: all kinds of patches, open edges, vertical walls, layers ([location T1]).
// Thread-safe: const methods only, scratch is thread-local.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include <absl/status/statusor.h>

#include "core/base/run_context.h"
#include "core/surface/surface.h"

namespace patchmill {

// mm: what heights and free balls are proven to where nothing else is asked for. Where a ball fits a hollow
// exactly that takes half a millisecond: who needs less should say so (tests/bench/README.md has what it
// saves).
inline constexpr double kProofGap = 1e-6;

struct CenterPoint {
  double z = 0.0;  // mm, centre height
  SurfacePoint contact;
};

// Value of a certified query: truth lies in [z, z + gap].
struct CertifiedCenter {
  double z = 0.0;
  double gap = 0.0;
  SurfacePoint contact;
};

class Locator {
 public:
  struct Impl;  // known to cam/location only
  const Impl& impl() const { return *impl_; }

  // Keeps a reference to `surface`. radius > 0, mm (tool radius + stock to leave). Cuts its pieces
  // into leaves that suit the radius, with second-order models, in parallel, deterministic: about 4 us and
  // 170 bytes a leaf. CANCELLED and DEADLINE_EXCEEDED from `run`, within 0.2 s.
  static absl::StatusOr<Locator> Make(const Surface& surface, double radius, const RunContext& run);
  Locator(const Surface& surface, double radius);  // the same, never cancelled
  ~Locator();
  Locator(Locator&&) noexcept;
  Locator(const Locator&) = delete;

  const Surface& surface() const;
  double radius() const;

  // h(q); nullopt where no surface point lies within R of q in plan. Proven to `gap` as CertifiedHeight is,
  // without saying so (20,000 parts may not suffice); error <= 1e-9 mm against closed forms where the branch
  // and bound closes; with a contact near the equator, where heights answer roundings of the surface by their
  // square root, what those explain: with b = z - p_z the height of the centre above the contact, sqrt(b^2 +
  // 2 R d) - b for a rounding d of the surface (4e-14 of the scale), that is R d / b, but 5e-6 mm at most for
  // R = 3 on a part of 100 mm. `hint`: a contact nearby, only for speed; changes the value within these
  // errors only.
  std::optional<CenterPoint> Height(const Vec2& q, const SurfacePoint* hint = nullptr,
                                    double gap = kProofGap) const;

  // The same with proof: bounds subdivided until the gap is at most eps (mm, >= 1e-7), or eps / 2 and what a
  // proof allows itself, 1e-12 of the scale (more than that half only beyond 250 m for eps 1e-6). Should
  // 20,000 parts not suffice, the gap says what is left.
  std::optional<CertifiedCenter> CertifiedHeight(const Vec2& q, double eps,
                                                 const SurfacePoint* hint = nullptr) const;

  // The local maximum of g over the neighbourhood of `from` (same smooth branch, across patch borders): what
  // the contact becomes when the tool moves to q. nullopt when the branch ends (contact leaves the disc |p_xy
  // - q| <= R).
  std::optional<CenterPoint> Follow(const SurfacePoint& from, const Vec2& q) const;

  // True iff a ball (and everything above it) centred at c is free: h(c_xy) <= c_z + slack. Early-out,
  // cheaper than Height. Proven as Height is: to `gap` and what rounding explains, but for the rare place
  // where 20,000 parts do not suffice.
  bool Free(const Vec3& c, double slack = 0.0, double gap = kProofGap) const;

  // The same with proof: how far the ball has to be lifted at most to be proven free (mm; at most eps as for
  // CertifiedHeight, or what is left); nullopt where it is not free.
  std::optional<double> CertifiedFree(const Vec3& c, double eps) const;

  // Upper bound of h over the places within `half_width` (>= 0) of the rectangle with corners a and b and
  // sides along x and y, within about `slack` of the true maximum; -infinity where there is nothing: how high
  // the ball must be for a control to go from a to b one axis before the other.
  double MaxHeight(const Vec2& a, const Vec2& b, double half_width, double slack = 0.1) const;

  // Largest penetration of the surface into the ball of radius R moving straight from a to b, swept upward:
  // max over surface points p of R - distance(p, swept set), positive part; certified upper bound within
  // `eps`. For merging flat runs.
  double SweptGouge(const Vec3& a, const Vec3& b, double eps) const;

  // True when that gouge is proven to be at most `limit`, false when it is above limit - eps. Much cheaper
  // than the value: parts well below the limit are never divided.
  bool GougeWithin(const Vec3& a, const Vec3& b, double limit, double eps) const;

  // The certificate of a centre that was found otherwise, along a contour: nullopt where it is free as it is,
  // proven to `gap` (CertifiedFree) and the 1e-9 mm to which such centres are known; else the height that it
  // should have had. That one is above it, and counts as a defect.
  std::optional<CertifiedCenter> Correction(const Vec3& c, double gap,
                                            const SurfacePoint* hint = nullptr) const;
  // Centres whose certificate improved them; tests demand 0.
  std::uint64_t defect_count() const;

 private:
  explicit Locator(std::unique_ptr<Impl> impl);

  std::unique_ptr<Impl> impl_;
};

}  // namespace patchmill
