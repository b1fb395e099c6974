#include "cam/plan/unused_settings.h"

#include <algorithm>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "cam/limits/upper_cylinders.h"

namespace patchmill {
namespace {

Diagnostic Unused(std::string field, const char* setting, const char* why) {
  return MakeWarning("SETTING_WITHOUT_EFFECT", fmt::format("{} has no effect: {}", setting, why),
                     {.field = std::move(field)});
}

constexpr char kAllContours[] = "everything is cut by contours";
constexpr char kAllLines[] = "everything is cut by lines";

}  // namespace

Diagnostics UnusedSettings(const Operation& op) {
  Diagnostics idle;
  const auto strategy_of = [&](const RegionOverride& change) {
    return change.strategy.value_or(op.strategy);
  };
  const auto all = [&](Strategy strategy) {
    return op.strategy == strategy &&
           std::all_of(op.overrides.begin(), op.overrides.end(), [&](const RegionOverride& change) {
             return change.skip || strategy_of(change) == strategy;
           });
  };
  const std::vector<UpperCylinder> uppers = UpperCylindersOf(op.tool);
  if (op.tool.flute_length && (uppers.empty() || uppers.front().part != UpperPart::kShank))
    idle.push_back(
        Unused("tool.flute_length_mm", "a length of flutes", "the shank is no wider than the ball"));
  if (all(Strategy::kContour)) {
    if (op.zigzag_angle != 0.0) idle.push_back(Unused("zigzag_angle_deg", "an angle of lines", kAllContours));
    if (op.angle_auto)
      idle.push_back(Unused("zigzag_angle_auto", "the quickest angle of lines", kAllContours));
    if (op.one_way) idle.push_back(Unused("one_way_lines", "one way", kAllContours));
    if (op.zigzag_bend != Operation().zigzag_bend)
      idle.push_back(Unused("zigzag_bend_deg", "a bend of lines", kAllContours));
    if (!op.round_lines) idle.push_back(Unused("round_lines", "no circular lines", kAllContours));
    if (!op.border_passes) idle.push_back(Unused("border_passes", "no border passes", kAllContours));
  }
  if (all(Strategy::kZigzag)) {
    if (op.spirals) idle.push_back(Unused("contour_spirals", "spirals", kAllLines));
    if (op.contour_direction != CutDirection::kClimb)
      idle.push_back(Unused("contour_direction", "a direction of contours", kAllLines));
  }
  for (std::size_t k = 0; k < op.overrides.size(); ++k) {
    const RegionOverride& change = op.overrides[k];
    if (change.skip || strategy_of(change) != Strategy::kContour) continue;
    const auto field = [&](const char* name) { return fmt::format("region_overrides[{}].{}", k, name); };
    constexpr char kContours[] = "the region is cut by contours";
    if (change.zigzag_angle)
      idle.push_back(Unused(field("zigzag_angle_deg"), "a region's angle of lines", kContours));
    if (change.one_way.value_or(false))
      idle.push_back(Unused(field("one_way_lines"), "a region's one way", kContours));
  }
  return idle;
}

Diagnostics UnusedSpirals(const Operation& op, const std::vector<CutterPath>& passes) {
  const bool wound = std::any_of(passes.begin(), passes.end(),
                                 [](const CutterPath& pass) { return pass.traversal == Traversal::kSpiral; });
  if (!op.spirals || wound) return {};
  return {Unused("contour_spirals", "spirals", "no closed contour runs all around beside the next one")};
}

}  // namespace patchmill
