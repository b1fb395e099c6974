#include "clients/render/canvas.h"

namespace patchmill::render {
namespace {

// The part of the line between shares `from` and `to` that lies within [low, high] of a coordinate; false
// if none.
bool Clip(double begin, double end, double low, double high, double& from, double& to) {
  const double step = end - begin;
  if (step == 0.0) return begin >= low && begin <= high;
  const double a = (low - begin) / step, b = (high - begin) / step;
  from = std::max(from, std::min(a, b));
  to = std::min(to, std::max(a, b));
  return from <= to;
}

}  // namespace

void Canvas::DrawLine(const Seen& from, const Seen& to, const LineStyle& style) {
  const PixelSize size = image_.size;
  double first = 0.0, last = 1.0;
  const double beyond = style.width;
  if (!Clip(from.x, to.x, -beyond, size.width + beyond, first, last) ||
      !Clip(from.y, to.y, -beyond, size.height + beyond, first, last))
    return;
  const bool flat = std::abs(to.x - from.x) >= std::abs(to.y - from.y);
  const auto along = [&](const Seen& p) { return flat ? p.x : p.y; };
  const double begin = along(from) + first * (along(to) - along(from));
  const double end = along(from) + last * (along(to) - along(from));
  const double length = along(to) - along(from);
  const int low = static_cast<int>(std::floor(std::min(begin, end)));
  const int high = static_cast<int>(std::floor(std::max(begin, end)));
  for (int k = low; k <= high; ++k) {
    const double share = length == 0.0 ? 0.0 : std::clamp((k + 0.5 - along(from)) / length, 0.0, 1.0);
    const double across = flat ? from.y + share * (to.y - from.y) : from.x + share * (to.x - from.x);
    const auto depth = static_cast<float>(from.depth + share * (to.depth - from.depth) + style.nearer_mm);
    const int side = static_cast<int>(std::floor(across - 0.5 * (style.width - 1)));
    for (int w = side; w < side + style.width; ++w) {
      const int x = flat ? k : w, y = flat ? w : k;
      if (x < 0 || y < 0 || x >= size.width || y >= size.height) continue;
      const std::size_t at = PixelAt(x, y);
      if (depth < depth_[at]) continue;
      depth_[at] = depth;
      image_.pixels[at] = style.color;
    }
  }
}

void Canvas::DrawPolygon(const std::vector<Seen>& corners, Rgb color, double opacity) {
  // The plane of the polygon: its normal by Newell's sum.
  double nx = 0.0, ny = 0.0, nz = 0.0;
  Seen middle;
  for (std::size_t k = 0; k < corners.size(); ++k) {
    const Seen& p = corners[k];
    const Seen& q = corners[(k + 1) % corners.size()];
    nx += (p.y - q.y) * (p.depth + q.depth);
    ny += (p.depth - q.depth) * (p.x + q.x);
    nz += (p.x - q.x) * (p.y + q.y);
    middle.x += p.x / static_cast<double>(corners.size());
    middle.y += p.y / static_cast<double>(corners.size());
    middle.depth += p.depth / static_cast<double>(corners.size());
  }
  if (nz == 0.0 || !std::isfinite(nx / nz) || !std::isfinite(ny / nz)) return;  // seen along its plane
  const auto pixel_of = [](double at, int most) {  // the first one whose middle is not before `at`
    return static_cast<int>(std::clamp(std::ceil(at - 0.5), 0.0, static_cast<double>(most)));
  };
  double top = corners.front().y, bottom = top;
  for (const Seen& p : corners) {
    top = std::min(top, p.y);
    bottom = std::max(bottom, p.y);
  }
  std::vector<double> crossings;
  for (int y = pixel_of(top, image_.size.height); y < pixel_of(bottom, image_.size.height); ++y) {
    const double my = y + 0.5;
    crossings.clear();
    for (std::size_t k = 0; k < corners.size(); ++k) {
      const Seen& p = corners[k];
      const Seen& q = corners[(k + 1) % corners.size()];
      if ((p.y <= my) != (q.y <= my)) crossings.push_back(p.x + (my - p.y) / (q.y - p.y) * (q.x - p.x));
    }
    std::sort(crossings.begin(), crossings.end());
    for (std::size_t k = 0; k + 1 < crossings.size(); k += 2) {
      const int last = pixel_of(crossings[k + 1], image_.size.width);
      for (int x = pixel_of(crossings[k], image_.size.width); x < last; ++x) {
        const std::size_t at = PixelAt(x, y);
        const auto depth =
            static_cast<float>(middle.depth - (nx * (x + 0.5 - middle.x) + ny * (my - middle.y)) / nz);
        if (depth <= depth_[at]) continue;
        image_.pixels[at] = Mixed(image_.pixels[at], color, opacity);
        if (opacity >= 1.0) depth_[at] = depth;
      }
    }
  }
}

Image Canvas::Halved() const {
  Image half = MakeImage({image_.size.width / 2, image_.size.height / 2}, {});
  for (int y = 0; y < half.size.height; ++y) {
    for (int x = 0; x < half.size.width; ++x) {
      int red = 2, green = 2, blue = 2;  // halves are rounded up
      for (const auto& [dx, dy] : {std::pair(0, 0), std::pair(1, 0), std::pair(0, 1), std::pair(1, 1)}) {
        const Rgb& pixel = image_.At(2 * x + dx, 2 * y + dy);
        red += pixel.red;
        green += pixel.green;
        blue += pixel.blue;
      }
      half.At(x, y) = {static_cast<std::uint8_t>(red / 4), static_cast<std::uint8_t>(green / 4),
                       static_cast<std::uint8_t>(blue / 4)};
    }
  }
  return half;
}

}  // namespace patchmill::render
