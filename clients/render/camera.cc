#include "clients/render/camera.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace patchmill::render {
namespace {

struct NamedView {
  const char* name;
  double yaw, pitch;  // degrees: of the direction to the eye about Z from +X, and above the XY plane
};

constexpr std::array<NamedView, 6> kViews = {{{"iso", -60.0, 35.264},
                                              {"top", -90.0, 90.0},
                                              {"front", -90.0, 0.0},
                                              {"back", 90.0, 0.0},
                                              {"left", 180.0, 0.0},
                                              {"right", 0.0, 0.0}}};

double Dot(const Point& a, const Point& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

Point Cross(const Point& a, const Point& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

}  // namespace

std::vector<std::string> ViewNames() {
  std::vector<std::string> names;
  for (const NamedView& view : kViews) names.emplace_back(view.name);
  return names;
}

std::string ViewName(StandardView view) { return kViews[static_cast<std::size_t>(view)].name; }

std::optional<StandardView> ViewOf(std::string_view name) {
  for (std::size_t k = 0; k < kViews.size(); ++k)
    if (name == kViews[k].name) return static_cast<StandardView>(k);
  return std::nullopt;
}

Camera FitPoints(StandardView view, const std::vector<Point>& points, PixelSize size) {
  const NamedView& named = kViews[static_cast<std::size_t>(view)];
  const double yaw = named.yaw * std::numbers::pi / 180.0, pitch = named.pitch * std::numbers::pi / 180.0;
  Camera camera;
  camera.size = size;
  camera.back = {std::cos(pitch) * std::cos(yaw), std::cos(pitch) * std::sin(yaw), std::sin(pitch)};
  camera.right = {-std::sin(yaw), std::cos(yaw), 0.0};
  camera.up = Cross(camera.back, camera.right);
  const std::array<const Point*, 3> axes = {&camera.right, &camera.up, &camera.back};
  Point low, high;  // along these axes, mm
  for (std::size_t k = 0; k < 3; ++k) low[k] = high[k] = Dot(points.front(), *axes[k]);
  for (const Point& point : points) {
    for (std::size_t k = 0; k < 3; ++k) {
      const double at = Dot(point, *axes[k]);
      low[k] = std::min(low[k], at);
      high[k] = std::max(high[k], at);
    }
  }
  camera.target.fill(0.0);
  for (std::size_t k = 0; k < 3; ++k) {
    for (std::size_t i = 0; i < 3; ++i) camera.target[i] += 0.5 * (low[k] + high[k]) * (*axes[k])[i];
  }
  const double pixel = 1.08 * std::max((high[0] - low[0]) / size.width, (high[1] - low[1]) / size.height);
  camera.pixel_mm = pixel > 0.0 ? pixel : 1.0;
  return camera;
}

Seen Project(const Camera& camera, const Point& point) {
  const Point from_target = {point[0] - camera.target[0], point[1] - camera.target[1],
                             point[2] - camera.target[2]};
  return {0.5 * camera.size.width + Dot(from_target, camera.right) / camera.pixel_mm,
          0.5 * camera.size.height - Dot(from_target, camera.up) / camera.pixel_mm,
          Dot(from_target, camera.back)};
}

}  // namespace patchmill::render
