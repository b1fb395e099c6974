// Exact cutter location for a ball (ALGORITHMS 2): the lowest centre height without gouge over a whole
// Surface.
//
//   h(q) = max { p_z + sqrt(R^2 - |p_xy - q|^2) : p on the surface, |p_xy - q| <= R }
//
// The whole surface counts: all kinds of patches, open edges, vertical walls, layers (T1). Thread-safe: const
// methods only, scratch is thread-local.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include <absl/status/statusor.h>

#include "core/base/run_context.h"
#include "core/surface/surface.h"

namespace patchmill {

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

  // h(q); nullopt where no surface point lies within R of q in plan. Error <= 1e-9 mm against closed forms
  // where the branch and bound closes, always <= 1e-6 mm. `hint`: a contact nearby, only for speed; never
  // changes the value beyond 1e-9.
  std::optional<CenterPoint> Height(const Vec2& q, const SurfacePoint* hint = nullptr) const;

  // The same with proof: bounds subdivided until the gap is at most eps (mm, >= 1e-7).
  std::optional<CertifiedCenter> CertifiedHeight(const Vec2& q, double eps,
                                                 const SurfacePoint* hint = nullptr) const;

  // The local maximum of g over the neighbourhood of `from` (same smooth branch, across patch borders): what
  // the contact becomes when the tool moves to q. nullopt when the branch ends (contact leaves the disc |p_xy
  // - q| <= R).
  std::optional<CenterPoint> Follow(const SurfacePoint& from, const Vec2& q) const;

  // True iff a ball (and everything above it) centred at c is free: h(c_xy) <= c_z + slack. Early-out,
  // cheaper than Height.
  bool Free(const Vec3& c, double slack = 0.0) const;

  // Upper bound of h over the stadium of points within `half_width` (>= 0) of the segment a b in plan, within
  // about `slack` of the true maximum; -infinity where there is nothing. For retract heights.
  double MaxHeight(const Vec2& a, const Vec2& b, double half_width, double slack = 0.1) const;

  // Largest penetration of the surface into the ball of radius R moving straight from a to b, swept upward:
  // max over surface points p of R - distance(p, swept set), positive part; certified upper bound within
  // `eps`. For merging flat runs.
  double SweptGouge(const Vec3& a, const Vec3& b, double eps) const;

  // True when that gouge is proven to be at most `limit`, false when it is above limit - eps. Much cheaper
  // than the value: parts well below the limit are never divided.
  bool GougeWithin(const Vec3& a, const Vec3& b, double limit, double eps) const;

  // Certificates that improved the value found by search by more than 1e-9 mm and what rounding explains (an
  // internal defect; tests demand 0).
  std::uint64_t defect_count() const;

 private:
  explicit Locator(std::unique_ptr<Impl> impl);

  std::unique_ptr<Impl> impl_;
};

}  // namespace patchmill
