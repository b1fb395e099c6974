#include "clients/cli/picture_legend.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "clients/cli/text.h"
#include "clients/render/label.h"

namespace patchmill::cli {
namespace {

using render::FromHex;
using render::Image;
using render::PixelSize;
using render::Rgb;

const Rgb kInk = FromHex("#14181d");
const Rgb kFaint = FromHex("#56606b");

// Writes the rows of the column, one below the other.
class Column {
 public:
  Column(Image& image, LegendPlace place, double text_px)
      : image_(image),
        left_(place.left_px + static_cast<int>(text_px)),
        width_(place.width_px - 2 * static_cast<int>(text_px)),
        text_(text_px),
        y_(text_px) {}

  void Text(const std::string& text, double size = 1.0, Rgb color = kInk) {
    const double height = size * text_;
    DrawText(image_, left_, y_, render::Shortened(text, height, width_), {height, color});
    y_ += 1.35 * height;
  }
  void Gap() { y_ += 0.8 * text_; }

  void Scale(const ScaleShading& scale) {
    const int height = static_cast<int>(text_), top = static_cast<int>(y_);
    const auto x_of = [&](double value) {
      return (value - scale.scale.low) / (scale.scale.high - scale.scale.low) * (width_ - 1);
    };
    for (int x = 0; x < width_; ++x) {
      const double value = scale.scale.low + (scale.scale.high - scale.scale.low) * x / (width_ - 1);
      FillRectangle(image_, left_ + x, top, {1, height}, ColorAt(scale.scale, value));
    }
    if (scale.mark && *scale.mark > scale.scale.low && *scale.mark < scale.scale.high)
      FillRectangle(image_, left_ + static_cast<int>(x_of(*scale.mark)), top - 2, {2, height + 4}, kInk);
    for (const Tick& tick : scale.ticks) {
      const double width = render::TextWidth(tick.text, text_);
      const double x = std::clamp(x_of(tick.value) - 0.5 * width, 0.0, std::max(0.0, width_ - width));
      DrawText(image_, left_ + x, top + height + 2.0, tick.text, {text_, kInk});
    }
    y_ += 2.6 * text_;
  }

  // As many rows as leave `below` rows free.
  void Swatches(const std::vector<Swatch>& swatches, int below, bool lines) {
    const double row = 1.35 * text_;
    const auto room = std::max(1, static_cast<int>((image_.size.height - y_) / row) - below);
    const auto shown = swatches.size() <= static_cast<std::size_t>(room) ? swatches.size()
                                                                         : static_cast<std::size_t>(room - 1);
    for (std::size_t k = 0; k < shown; ++k) {
      const int chip = static_cast<int>(text_), height = lines ? 3 : chip;
      FillRectangle(image_, left_, static_cast<int>(y_) + (chip - height) / 2 + 1, {chip, height},
                    swatches[k].color);
      DrawText(image_, left_ + 1.5 * text_, y_,
               render::Shortened(swatches[k].text, text_, width_ - 1.5 * text_), {text_, kInk});
      y_ += row;
    }
    if (shown < swatches.size()) Text(fmt::format("and {} more", swatches.size() - shown), 1.0, kFaint);
  }

 private:
  Image& image_;
  int left_, width_;  // px
  double text_, y_;   // px
};

// The longest of 1, 2, 5, 10, 20, ... mm that takes at most `most` px.
double ScaleLength(double pixel_mm, double most) {
  const double longest = most * pixel_mm, power = std::pow(10.0, std::floor(std::log10(longest)));
  for (const double step : {5.0, 2.0})
    if (step * power <= longest) return step * power;
  return power;
}

void DrawScale(Image& image, const render::Camera& camera, double text) {
  const double length = ScaleLength(camera.pixel_mm, 0.2 * camera.size.width);
  const int width = static_cast<int>(std::lround(length / camera.pixel_mm));
  const int x = static_cast<int>(1.5 * text), y = camera.size.height - static_cast<int>(1.5 * text);
  FillRectangle(image, x, y, {width, 2}, kInk);
  for (const int end : {x, x + width - 2}) FillRectangle(image, end, y - 5, {2, 7}, kInk);
  DrawText(image, x + 6.0, y - 1.2 * text, fmt::format("{:g} mm", length), {text, kInk});
}

void DrawStroke(Image& image, double x0, double y0, double x1, double y1, Rgb color) {
  const int steps = 2 * static_cast<int>(std::ceil(std::max(std::abs(x1 - x0), std::abs(y1 - y0)))) + 1;
  for (int k = 0; k <= steps; ++k) {
    const double share = static_cast<double>(k) / steps;
    FillRectangle(image, static_cast<int>(std::lround(x0 + share * (x1 - x0))),
                  static_cast<int>(std::lround(y0 + share * (y1 - y0))), {2, 2}, color);
  }
}

// The axes that are not seen from their ends.
void DrawAxes(Image& image, const render::Camera& camera, double text) {
  const double length = 2.6 * text, x = 4.0 * text, y = camera.size.height - 6.5 * text;
  const std::array<std::pair<const char*, Rgb>, 3> axes = {
      {{"X", FromHex("#c02434")}, {"Y", FromHex("#1d7f43")}, {"Z", FromHex("#1f5fbf")}}};
  for (std::size_t k = 0; k < axes.size(); ++k) {
    const double dx = camera.right[k] * length, dy = -camera.up[k] * length;
    if (std::hypot(dx, dy) < 0.05 * length) continue;
    const auto& [name, color] = axes[k];
    DrawStroke(image, x, y, x + dx, y + dy, color);
    const double half = 0.5 * render::TextWidth(name, text);
    DrawText(image, x + 1.3 * dx - half, y + 1.3 * dy - 0.5 * text, name, {text, color});
  }
}

std::string SizeOf(const render::Box& box) {
  return fmt::format("{:.2f} x {:.2f} x {:.2f} mm", box.max[0] - box.min[0], box.max[1] - box.min[1],
                     box.max[2] - box.min[2]);
}

}  // namespace

LegendPlace PlaceOfLegend(PixelSize picture) {
  const int width = std::clamp(picture.width * 27 / 100, std::min(220, picture.width / 2), 640);
  return {picture.width - width, width};
}

Image WithLegend(const Image& drawing, const render::Camera& camera, const Legend& legend, PixelSize size) {
  Image image = render::MakeImage(size, {255, 255, 255});
  for (int y = 0; y < std::min(size.height, drawing.size.height); ++y)
    for (int x = 0; x < std::min(size.width, drawing.size.width); ++x) image.At(x, y) = drawing.At(x, y);
  const LegendPlace place = PlaceOfLegend(size);
  const double text = std::clamp(0.045 * place.width_px, 11.0, 26.0);
  DrawScale(image, camera, text);
  DrawAxes(image, camera, text);

  Column column(image, place, text);
  column.Text(legend.title, 1.3);
  if (legend.outcome != v1::OUTCOME_UNSPECIFIED) column.Text(Short(legend.outcome));
  column.Text(SizeOf(legend.part), 1.0, kFaint);
  if (legend.tool.ball_end().diameter_mm() > 0.0)
    column.Text(fmt::format("ball D {:g} mm", legend.tool.ball_end().diameter_mm()), 1.0, kFaint);
  column.Text(fmt::format("view: {}, parallel", legend.view), 1.0, kFaint);
  column.Gap();
  column.Text(fmt::format("Part: {}", legend.shading.name), 1.1);
  if (legend.shading.scale) {
    column.Text(fmt::format("in {}", legend.shading.scale->unit), 1.0, kFaint);
    column.Scale(*legend.shading.scale);
  }
  const int rows_below = legend.lines.empty() ? 0 : static_cast<int>(legend.lines.size()) + 2;
  column.Swatches(legend.shading.swatches, rows_below, false);
  if (!legend.lines.empty()) {
    column.Gap();
    column.Swatches(legend.lines, 0, true);
  }
  return image;
}

}  // namespace patchmill::cli
