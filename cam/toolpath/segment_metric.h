// Distances from a point to a straight move, and to the volume that its tool sweeps upwards. All are convex
// functions of the point with slope at most 1.
#pragma once

#include <algorithm>

#include "core/base/vec.h"

namespace patchmill {

struct PathSegment {
  Vec3 a = Vec3::Zero(), b = Vec3::Zero();  // ball centres, placed frame, mm
  int move = 0;                             // index into ProgramMotion::moves
};

enum class Metric {
  kPath,   // to the segment
  kSwept,  // to the half strip {c + s e_z : c on the segment, s >= 0}: the ball and the shank above it
  // To everything above the height of the lower end, over the rectangle with the ends as corners and sides
  // along x and y. A rapid may pass any place of it, because a control need not drive its axes together.
  kSweptBox,
  kShank,     // max(plan distance, shank radius - height above the segment), the smallest over the segment.
              // The shank radius minus this is the depth of the point in a cylinder from there up
  kShankBox,  // the same over the rectangle of kSweptBox, at the lower end's height
};

// The value and a subgradient: nowhere is the value below distance + gradient . (q - p). Except for the
// shank, the gradient is the unit vector in which the value grows.
struct MetricValue {
  double distance = 0.0;
  Vec3 gradient = Vec3::Zero();  // zero where the distance is zero
};

double PathDistance(const PathSegment& s, const Vec3& p);

// The same for many points and one segment.
class PathRuler {
 public:
  explicit PathRuler(const PathSegment& s) : a_(s.a), d_(s.b - s.a) {
    const double length2 = d_.squaredNorm();
    scale_ = length2 > 0.0 ? 1.0 / length2 : 0.0;
  }
  double Distance2(const Vec3& p) const {
    const Vec3 r = p - a_;
    return (r - std::clamp(r.dot(d_) * scale_, 0.0, 1.0) * d_).squaredNorm();
  }

 private:
  Vec3 a_, d_;
  double scale_ = 0.0;
};

// An upper bound, over the convex hull of up to kMaxNetPoints points, of the distance to the nearer of two
// segments. The distance to one segment is convex, and so is every weighted mean of both. Over the hull such
// a mean is nowhere above its largest value at the points, and it is never below the distance to the nearer
// segment. The mean with the smallest bound is used, or the first whose bound is `enough`. With one segment
// from each side of a crest between two passes, the bound is exact to second order there.
double DistanceToEither(const PathSegment& a, const PathSegment& b, const Vec3* hull, int count,
                        double enough);

double SweptDistance(const PathSegment& s, const Vec3& p);
double SweptBoxDistance(const PathSegment& s, const Vec3& p);
double ShankDistance(const PathSegment& s, const Vec3& p, double shank_radius);
double ShankBoxDistance(const PathSegment& s, const Vec3& p, double shank_radius);
MetricValue PathDistanceAndGradient(const PathSegment& s, const Vec3& p);
MetricValue SweptDistanceAndGradient(const PathSegment& s, const Vec3& p);
MetricValue SweptBoxDistanceAndGradient(const PathSegment& s, const Vec3& p);
MetricValue ShankDistanceAndGradient(const PathSegment& s, const Vec3& p, double shank_radius);
MetricValue ShankBoxDistanceAndGradient(const PathSegment& s, const Vec3& p, double shank_radius);

}  // namespace patchmill
