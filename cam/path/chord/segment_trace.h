// Traces the centre height h over a straight segment in plan, as stations so dense that chords between them
// keep the tolerances [location, section 11]. Contact switches that no chord may pass over, and vertical
// drops, are solved exactly. Everything else is sampled.
#pragma once

#include <optional>
#include <vector>

#include "cam/location/locator.h"
#include "core/base/run_context.h"

namespace patchmill {

// A centre of the trace. `left` and `right` are what the ball touches on the chord before and after; they
// differ at a contact switch. An absent one means that the floor carries the ball.
struct TraceStation {
  double t = 0.0;              // mm: arc length in plan along the segment (or along another curve in plan)
  Vec2 q = Vec2::Zero();       // the place in plan
  double z = 0.0;              // mm, centre height
  double ceiling = kInfinity;  // mm: proven upper bound of h at `at`; infinite: not certified
  // The place where z is the value of h. It is q, except at the top of a drop, where it is just inside the
  // wall.
  Vec2 at = Vec2::Zero();
  std::optional<SurfacePoint> left, right;
  std::optional<SurfacePoint>
      hint;           // contact with the surface of a ball at h, also where the floor is higher
  bool keep = false;  // true at ends, switches and both ends of a drop
};

struct SegmentTraceParams {
  double chord_tolerance = 0.005;       // mm, [location T2] and T3 between neighbouring stations
  double excess_tolerance = kInfinity;  // mm, [location T3] between them, if below chord_tolerance
  double floor_center = -kInfinity;     // mm, lowest centre height
  double certificate_gap = 0.0;         // mm: heights are certified to this gap; 0: not certified
  const RunContext* run = nullptr;      // polled when set: a cancelled trace is cut short
};

// The segment in plan, by arc length.
struct XyLine {
  Vec2 start = Vec2::Zero();
  Vec2 direction = Vec2::UnitX();
  double length = 0.0;

  static XyLine Through(const Vec2& a, const Vec2& b);
  Vec2 At(double t) const { return start + t * direction; }
};

// Returns the runs where h exists, in order of t. Neighbouring stations are joined by a chord with
// [location T2] gouge and T3 excess within their tolerances, or are the two ends of a vertical drop (same t).
// Switches are placed to 1e-10 mm in t, drops and ends of runs to 1e-8 mm. Cost: one exact height per station
// (certified when requested) and a few branch followings per switch.
std::vector<std::vector<TraceStation>> TraceSegment(const Locator& locator, const XyLine& line,
                                                    const SegmentTraceParams& params);

}  // namespace patchmill
