// Draws triangles and lines with a depth for each pixel: what lies nearer to the eye hides what lies behind.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

#include "clients/render/camera.h"
#include "clients/render/image.h"

namespace patchmill::render {

using Triangle = std::array<Seen, 3>;

struct LineStyle {
  Rgb color;
  int width = 1;           // px
  double nearer_mm = 0.0;  // how far a line is moved to the eye, so that the surface below does not hide it
};

class Canvas {
 public:
  Canvas(PixelSize size, Rgb background)
      : image_(MakeImage(size, background)),
        depth_(image_.pixels.size(), -std::numeric_limits<float>::infinity()) {}

  // Draws a triangle seen from either side. `paint(a, b, c)` is the colour at a point with these shares of
  // the corners; they add up to 1. A pixel on a side that two triangles share belongs to one of them.
  template <class Paint>
  void FillTriangle(const Triangle& corners, const Paint& paint) {
    VisitPixels(corners, [&](std::size_t at, float depth, double a, double b, double c) {
      if (depth <= depth_[at]) return;
      depth_[at] = depth;
      image_.pixels[at] = paint(a, b, c);
    });
  }

  // Lets what lies behind show through: `opacity` in (0, 1). It hides nothing, so it comes after what is
  // solid.
  void BlendTriangle(const Triangle& corners, Rgb color, double opacity) {
    VisitPixels(corners, [&](std::size_t at, float depth, double, double, double) {
      if (depth > depth_[at]) image_.pixels[at] = Mixed(image_.pixels[at], color, opacity);
    });
  }

  // Draws a flat polygon of any shape, seen from either side. Where it crosses itself, what lies inside
  // twice is left out. With an opacity below 1 it hides nothing, and what lies behind shows through.
  void DrawPolygon(const std::vector<Seen>& corners, Rgb color, double opacity = 1.0);

  void DrawLine(const Seen& from, const Seen& to, const LineStyle& style);

  // The picture at half its width and height: each pixel is the mean of four.
  Image Halved() const;

 private:
  template <class Visit>
  void VisitPixels(Triangle corners, const Visit& visit) const;
  std::size_t PixelAt(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(image_.size.width) +
           static_cast<std::size_t>(x);
  }

  Image image_;
  std::vector<float> depth_;  // mm to the eye, of each pixel
};

template <class Visit>
void Canvas::VisitPixels(Triangle corners, const Visit& visit) const {
  // Both triangles of a side compute it from the same end, so that rounding leaves no pixel to neither.
  const auto twice_area = [](const Seen& p, const Seen& q, double x, double y) {
    const bool turned = q.x < p.x || (q.x == p.x && q.y < p.y);
    const Seen& a = turned ? q : p;
    const Seen& b = turned ? p : q;
    const double twice = (b.x - a.x) * (y - a.y) - (b.y - a.y) * (x - a.x);
    return turned ? -twice : twice;
  };
  double area = twice_area(corners[0], corners[1], corners[2].x, corners[2].y);
  const bool turned = area < 0.0;
  if (turned) std::swap(corners[1], corners[2]);
  area = std::abs(area);
  if (!(area > 0.0) || !std::isfinite(area)) return;
  const auto [left, right] = std::minmax({corners[0].x, corners[1].x, corners[2].x});
  const auto [top, bottom] = std::minmax({corners[0].y, corners[1].y, corners[2].y});
  const int first_x = static_cast<int>(std::clamp(std::floor(left), 0.0, double(image_.size.width)));
  const int last_x = static_cast<int>(std::clamp(std::ceil(right), 0.0, double(image_.size.width)));
  const int first_y = static_cast<int>(std::clamp(std::floor(top), 0.0, double(image_.size.height)));
  const int last_y = static_cast<int>(std::clamp(std::ceil(bottom), 0.0, double(image_.size.height)));
  // A pixel whose middle lies on a side belongs to the triangle that has the side above it or to its left.
  const auto owns = [](const Seen& p, const Seen& q) { return q.y < p.y || (q.y == p.y && q.x > p.x); };
  const std::array<bool, 3> owned = {owns(corners[1], corners[2]), owns(corners[2], corners[0]),
                                     owns(corners[0], corners[1])};
  for (int y = first_y; y < last_y; ++y) {
    for (int x = first_x; x < last_x; ++x) {
      const double mx = x + 0.5, my = y + 0.5;
      const std::array<double, 3> w = {twice_area(corners[1], corners[2], mx, my),
                                       twice_area(corners[2], corners[0], mx, my),
                                       twice_area(corners[0], corners[1], mx, my)};
      bool inside = true;
      for (std::size_t k = 0; k < 3; ++k) inside = inside && (w[k] > 0.0 || (w[k] == 0.0 && owned[k]));
      if (!inside) continue;
      const double a = w[0] / area, b = w[1] / area, c = w[2] / area;
      const auto depth =
          static_cast<float>(a * corners[0].depth + b * corners[1].depth + c * corners[2].depth);
      const std::size_t at = PixelAt(x, y);
      if (turned) {
        visit(at, depth, a, c, b);
      } else {
        visit(at, depth, a, b, c);
      }
    }
  }
}

}  // namespace patchmill::render
