// Distances from a point to a straight move and to what its tool sweeps upwards. All are convex functions of
// the point, with slope at most 1.
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
  kSwept,  // to the half strip {c + s e_z : c on the segment, s >= 0}: ball and the shank above it
  // To everything above the lower end's height over the rectangle with the ends as corners and sides along x
  // and y: where a rapid may go, for controls need not drive its axes together.
  kSweptBox,
  kShank,     // max(plan distance, shank radius - height above the segment), smallest over the segment:
              // shank radius minus this is how deep the point sits in a cylinder that begins at the segment
  kShankBox,  // the same over the rectangle of kSweptBox, at the lower end's height
};

// Value and a subgradient: nowhere is the value below distance + gradient . (q - p). For all but the
// shank the unit vector in which it grows.
struct MetricValue {
  double distance = 0.0;
  Vec3 gradient = Vec3::Zero();  // zero where the distance is zero
};

double PathDistance(const PathSegment& s, const Vec3& p);

// The same to many points of one segment.
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

// Upper bound of the distance to the nearer of two segments all over the convex hull of up to kMaxNetPoints
// points. The distance to one is convex, and so is every mean of both: over the hull it is nowhere above its
// largest value at the points, and never below the distance to the nearer one. Of all means the one that
// makes it least, or the first that makes it `enough`. One segment from each side of a crest between two
// passes makes the bound second-order there.
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
