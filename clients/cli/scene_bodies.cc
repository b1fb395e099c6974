#include "clients/cli/scene_bodies.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>

#include <fmt/format.h>

namespace patchmill::cli {
namespace {

std::vector<std::array<double, 2>> OutlineOf(const google::protobuf::RepeatedField<double>& xy) {
  std::vector<std::array<double, 2>> outline;
  for (int i = 0; i + 1 < xy.size(); i += 2) outline.push_back({xy[i], xy[i + 1]});
  return outline;
}

double ShankRadius(const v1::Tool& tool) {
  return 0.5 * (tool.has_shank_diameter_mm() ? tool.shank_diameter_mm() : tool.ball_end().diameter_mm());
}

}  // namespace

render::Box BoxOf(const std::vector<v1::MeshBlock>& mesh) {
  render::Box box;
  box.min.fill(std::numeric_limits<double>::infinity());
  box.max.fill(-std::numeric_limits<double>::infinity());
  for (const v1::MeshBlock& block : mesh) {
    for (int i = 0; i < block.position_mm_size(); ++i) {
      const auto k = static_cast<std::size_t>(i % 3);
      box.min[k] = std::min(box.min[k], static_cast<double>(block.position_mm(i)));
      box.max[k] = std::max(box.max[k], static_cast<double>(block.position_mm(i)));
    }
  }
  return box;
}

std::optional<Prism> StockOf(const Scene& scene, const render::Box& part) {
  const v1::Stock& stock = scene.setup.stock();
  const v1::SetupSheet& sheet = scene.report.setup_sheet();
  if (stock.body_case() == v1::Stock::BODY_NOT_SET) return std::nullopt;
  if (stock.has_model() && !sheet.has_stock_model_box()) return std::nullopt;
  Prism prism{"stock", {}, part.min[2], stock.has_top_z_mm() ? stock.top_z_mm() : part.max[2]};
  if (scene.report.has_setup_sheet()) prism.top = sheet.stock_top_z_mm();
  if (stock.has_model()) {
    prism.name = "stock (box of its model)";
    const v1::Point3 &low = sheet.stock_model_box().min(), &high = sheet.stock_model_box().max();
    prism.outline = {{low.x_mm(), low.y_mm()},
                     {high.x_mm(), low.y_mm()},
                     {high.x_mm(), high.y_mm()},
                     {low.x_mm(), high.y_mm()}};
  } else if (stock.has_block()) {
    const double margin = stock.block().margin_mm();
    const double x0 = part.min[0] - margin, x1 = part.max[0] + margin;
    const double y0 = part.min[1] - margin, y1 = part.max[1] + margin;
    prism.outline = {{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}};
  } else if (stock.has_outline()) {
    prism.outline = OutlineOf(stock.outline().outline_xy_mm());
  } else {
    const auto& center = stock.cylinder().center_xy_mm();
    const double x = center.size() == 2 ? center[0] : 0.5 * (part.min[0] + part.max[0]);
    const double y = center.size() == 2 ? center[1] : 0.5 * (part.min[1] + part.max[1]);
    constexpr int kCorners = 96;
    for (int k = 0; k < kCorners; ++k) {
      const double angle = 2.0 * std::numbers::pi * k / kCorners, r = 0.5 * stock.cylinder().diameter_mm();
      prism.outline.push_back({x + r * std::cos(angle), y + r * std::sin(angle)});
    }
  }
  return prism;
}

std::vector<Prism> ClampsOf(const v1::Setup& setup, double bottom) {
  std::vector<Prism> clamps;
  for (const v1::Obstacle& obstacle : setup.obstacles()) {
    clamps.push_back({obstacle.id().empty() ? fmt::format("obstacle #{}", clamps.size()) : obstacle.id(),
                      OutlineOf(obstacle.outline_xy_mm()), std::min(bottom, obstacle.top_z_mm()),
                      obstacle.top_z_mm()});
  }
  return clamps;
}

ToolProfiles ProfilesOf(const v1::Tool& tool) {
  const double radius = 0.5 * tool.ball_end().diameter_mm(), shank = ShankRadius(tool);
  const double flute_top =
      std::max(radius, tool.has_flute_length_mm() ? tool.flute_length_mm() : 2.0 * radius);
  ToolProfiles profiles;
  constexpr int kSteps = 16;
  for (int k = 0; k <= kSteps; ++k) {
    const double angle = 0.5 * std::numbers::pi * k / kSteps;
    profiles.flutes.emplace_back(radius * (1.0 - std::cos(angle)), radius * std::sin(angle));
  }
  if (flute_top > radius) profiles.flutes.emplace_back(flute_top, radius);
  const double top =
      std::max(flute_top, tool.holder().empty() ? flute_top + 8.0 * shank : tool.stickout_mm());
  profiles.shank = {{flute_top, radius}, {flute_top, shank}, {top, shank}, {top, 0.0}};
  if (tool.holder().empty()) return profiles;
  double height = tool.stickout_mm();
  profiles.holder.emplace_back(height, 0.0);
  for (const v1::HolderSegment& segment : tool.holder()) {
    profiles.holder.emplace_back(height, 0.5 * segment.lower_diameter_mm());
    height += segment.length_mm();
    profiles.holder.emplace_back(height, 0.5 * segment.upper_diameter_mm());
  }
  profiles.holder.emplace_back(height, 0.0);
  return profiles;
}

}  // namespace patchmill::cli
