#include "clients/cli/scene_words.h"

#include <algorithm>
#include <map>

#include <absl/strings/ascii.h>
#include <absl/strings/str_replace.h>
#include <fmt/format.h>

#include "clients/cli/text.h"

namespace patchmill::cli {

bool IsUnreached(const v1::Region& region) { return region.kind() == v1::REGION_KIND_UNREACHABLE; }

std::string RegionName(const v1::Region& region) {
  if (IsUnreached(region)) {
    return fmt::format("{} {}: {:.1f} mm2, {:.2f} mm stays", region.id(), Short(region.unreachable_reason()),
                       region.area_mm2(), region.deepest_leftover_mm());
  }
  return fmt::format("{} {}, {}: {:.1f} mm2", region.id(), absl::AsciiStrToLower(Short(region.kind())),
                     absl::AsciiStrToLower(Short(region.slope())), region.area_mm2());
}

std::string RegionColor(const v1::Region& region) {
  using Rgb = std::array<int, 3>;
  const bool steep = region.slope() == v1::SLOPE_STEEP;
  Rgb rgb{120, 120, 120};
  switch (region.kind()) {
    case v1::REGION_KIND_MOUNTAIN:
      rgb = steep ? Rgb{230, 120, 95} : Rgb{250, 205, 175};
      break;
    case v1::REGION_KIND_BASIN:
      rgb = steep ? Rgb{95, 145, 225} : Rgb{180, 212, 250};
      break;
    case v1::REGION_KIND_NEUTRAL:
      rgb = steep ? Rgb{120, 185, 110} : Rgb{205, 232, 195};
      break;
    default: {
      static const std::map<v1::UnreachableReason, Rgb> kOfReason = {
          {v1::UNREACHABLE_REASON_CONCAVE, {150, 120, 165}},
          {v1::UNREACHABLE_REASON_FLOOR, {165, 150, 105}},
          {v1::UNREACHABLE_REASON_SHANK, {95, 145, 140}},
          {v1::UNREACHABLE_REASON_HOLDER, {70, 110, 150}},
          {v1::UNREACHABLE_REASON_OUTSIDE, {175, 175, 180}}};
      if (const auto found = kOfReason.find(region.unreachable_reason()); found != kOfReason.end())
        rgb = found->second;
    }
  }
  if (region.unreachable_reason() == v1::UNREACHABLE_REASON_STRATEGY) rgb = {245, 220, 90};
  const int shift = (region.id() % 3 - 1) * 9;
  for (int& c : rgb) c = std::clamp(c + shift, 0, 255);
  return fmt::format("#{:02x}{:02x}{:02x}", rgb[0], rgb[1], rgb[2]);
}

std::string BorderName(v1::BorderKind kind) {
  return absl::StrReplaceAll(absl::AsciiStrToLower(Short(kind)), {{"_", " "}});
}

const char* BorderColor(v1::BorderKind kind) {
  switch (kind) {
    case v1::BORDER_KIND_SLOPE:
      return "#c2410c";
    case v1::BORDER_KIND_CURVATURE:
      return "#0f766e";
    case v1::BORDER_KIND_SILHOUETTE:
      return "#7c3aed";
    case v1::BORDER_KIND_WATERSHED:
      return "#1d4ed8";
    case v1::BORDER_KIND_SEAM:
      return "#be185d";
    case v1::BORDER_KIND_STRATEGY:
      return "#854d0e";
    case v1::BORDER_KIND_OPEN_EDGE:
      return "#808080";
    default:
      return "#303030";
  }
}

}  // namespace patchmill::cli
