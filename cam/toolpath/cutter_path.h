// A pass: the polyline of ball centres with the contacts under it.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "cam/toolpath/segment_metric.h"
#include "core/surface/surface.h"

namespace patchmill {

// kBorder: along the border of what lines cover.
enum class PassKind { kZigzag, kContour, kBorder, kPencil, kRest };
constexpr PassKind LastOf(PassKind) { return PassKind::kRest; }

// A ball centre and what it touches: free, or in the ground by less than its chords may be (fewest_chords.h).
struct CutterPoint {
  Vec3 center = Vec3::Zero();
  std::optional<SurfacePoint> contact;        // absent where the floor holds the ball
  std::optional<SurfacePoint> other_contact;  // the second one at a switch or corner vertex
};

// Consecutive centres are joined by straight moves, each certified: gouge and excess within the path's chord
// tolerance.
struct CutterPath {
  PassKind kind = PassKind::kZigzag;
  bool closed = false;  // the last point joins the first (not repeated)
  // Is cut from its first point to its last, never back, and the ball comes to it from above.
  bool one_way = false;
  // Is cut from its first point to its last, but for that linked as any.
  bool directed = false;
  // Winds down from its first point to its last and is cut like that, whatever the direction of contours: it
  // was made for it.
  bool spiral = false;
  int region = -1;    // RegionMap id of most of its length, -1: none
  int order_key = 0;  // index of the scan line or level it came from; orders passes within a region
  std::vector<CutterPoint> points;
};

double Length(const CutterPath& path);  // mm, closing move included
double Length(std::span<const CutterPoint> open_path);

// The same closed path started at its vertex `start`.
void RotateClosed(CutterPath& path, std::size_t start);
void Reverse(CutterPath& path);

// All straight moves of passes, in their order; a pass of one point is a move of no length.
std::vector<PathSegment> MovesOf(const std::vector<CutterPath>& paths);

}  // namespace patchmill
