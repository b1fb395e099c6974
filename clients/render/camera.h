// From where a picture shows the part: a parallel projection, so that one scale holds for all of the picture.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "clients/render/image.h"

namespace patchmill::render {

using Point = std::array<double, 3>;  // mm, or a unit vector

struct Box {
  Point min, max;
};

// The views of the 3-D page. From the front one looks along +Y, from the right along -X.
enum class StandardView { kIso, kTop, kFront, kBack, kLeft, kRight };
std::vector<std::string> ViewNames();  // "iso", ..., in the order of the enum
std::string ViewName(StandardView view);
std::optional<StandardView> ViewOf(std::string_view name);

struct Camera {
  Point right, up, back;  // unit vectors: to the right of the picture, to its top, and to the eye
  Point target;           // mm, in the middle of the picture
  double pixel_mm = 1.0;  // size of a pixel
  PixelSize size;
};

// A point as it is seen.
struct Seen {
  double x = 0.0, y = 0.0;  // px, from the upper left corner
  double depth = 0.0;       // mm, from the target to the eye
};

// All the points, as large as the picture holds them with a margin of 4 % on each side. `points` must have
// one.
Camera FitPoints(StandardView view, const std::vector<Point>& points, PixelSize size);

Seen Project(const Camera& camera, const Point& point);

}  // namespace patchmill::render
