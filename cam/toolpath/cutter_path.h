// A pass: a polyline of ball centres with their contacts on the surface.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "cam/toolpath/segment_metric.h"
#include "core/base/typed_id.h"
#include "core/surface/surface.h"

namespace patchmill {

// kBorder runs along the border of the area that lines cover.
enum class PassKind { kZigzag, kContour, kBorder, kPencil, kRest };
constexpr PassKind LastOf(PassKind) { return PassKind::kRest; }

// In which direction a pass may be cut. A closed pass that is kAny may start at any of its points.
enum class Traversal {
  kAny,
  kDirected,  // from the first point to the last; linked like any pass
  kOneWay,    // from the first point to the last; the ball approaches the first point from above
  kSpiral,  // a helical pass: winds down from the first point to the last, whatever the direction of contours
};

// A ball centre and its contacts. The ball is free, or penetrates the surface by less than its chords may
// (fewest_chords.h).
struct CutterPoint {
  Vec3 center = Vec3::Zero();
  std::optional<SurfacePoint> contact;        // none where the floor holds the ball
  std::optional<SurfacePoint> other_contact;  // the second contact at a contact switch or a corner
};

// Straight moves join consecutive centres. Each is certified: gouge and excess are within the path's chord
// tolerance.
struct CutterPath {
  PassKind kind = PassKind::kZigzag;
  bool closed = false;  // the last point joins the first, which is not repeated
  Traversal traversal = Traversal::kAny;
  RegionId region = kNoRegion;  // region of most of its length
  int order_key = 0;            // index of the scan line or level it came from; orders passes within a region
  std::vector<CutterPoint> points;
};

double Length(const CutterPath& path);  // mm, closing move included
double Length(std::span<const CutterPoint> open_path);

// Makes the closed path start at its vertex `start`.
void RotateClosed(CutterPath& path, std::size_t start);
void Reverse(CutterPath& path);

// All straight moves of the passes, in their order. A pass of one point is a move of length 0.
std::vector<PathSegment> MovesOf(const std::vector<CutterPath>& paths);

}  // namespace patchmill
