#include "clients/cli/picture_shading.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "clients/cli/scene_words.h"
#include "clients/cli/text.h"

namespace patchmill::cli {
namespace {

using render::FromHex;
using render::Rgb;

// The colours of clients/viewer/src/shading.ts.
const Rgb kPlain = FromHex("#b4bac2");
const Rgb kUnknown = FromHex("#8b9099");
const Rgb kAlarm = FromHex("#d7191c");
const Rgb kTooLow = FromHex("#f4e3b5");
const Rgb kGouged = FromHex("#8e0152");

std::vector<Rgb> Stops(std::initializer_list<const char*> colors) {
  std::vector<Rgb> stops;
  for (const char* color : colors) stops.push_back(FromHex(color));
  return stops;
}

std::vector<Tick> EvenTicks(double low, double high, int parts) {
  std::vector<Tick> ticks;
  for (int k = 0; k <= parts; ++k) {
    const double value = low + (high - low) * k / parts;
    ticks.push_back({value, ShortNumber(std::abs(value) < 1e-9 * (high - low) ? 0.0 : value)});
  }
  return ticks;
}

// The absolute value below which `share` of the known values lie; 0 if there is none.
double Quantile(const Scene& scene, ShadedValue value, double share) {
  std::vector<float> known;
  for (const v1::MeshBlock& block : scene.mesh) {
    for (const float v : ValuesOf(block, value))
      if (!std::isnan(v)) known.push_back(std::abs(v));
  }
  if (known.empty()) return 0.0;
  const auto at =
      std::min(known.size() - 1, static_cast<std::size_t>(share * static_cast<double>(known.size())));
  std::nth_element(known.begin(), known.begin() + static_cast<std::ptrdiff_t>(at), known.end());
  return known[at];
}

Shading SlopeShading(const Scene& scene) {
  float most = 0.0F;
  for (const v1::MeshBlock& block : scene.mesh)
    for (const float slope : block.slope_deg()) most = std::max(most, slope);
  const double high = most > 90.5F ? 180.0 : 90.0;
  const std::vector<Rgb> stops =
      Stops({"#fde725", "#a0da39", "#4ac16d", "#1fa187", "#277f8e", "#365c8d", "#46327e"});
  ScaleShading scale{ShadedValue::kSlope,
                     {0.0, high, stops, stops.front(), stops.back(), kUnknown},
                     "degrees",
                     EvenTicks(0.0, high, high > 90.0 ? 4 : 6),
                     scene.steep_angle};
  return {
      "Slope",
      std::move(scale),
      {},
      {{FromHex("#111111"), fmt::format("line: steep from {} degrees on", ShortNumber(scene.steep_angle))}}};
}

Shading CurvatureShading(const Scene& scene) {
  const double high = RoundUp(Quantile(scene, ShadedValue::kCurvature, 0.98));
  const std::vector<Rgb> stops =
      Stops({"#2166ac", "#6ba3cf", "#c3d8e8", "#f2f0ec", "#f2c3a4", "#d9765a", "#b2182b"});
  ScaleShading scale{ShadedValue::kCurvature,
                     {-high, high, stops, FromHex("#0b3c73"), FromHex("#6d0a18"), kUnknown},
                     "1/mm",
                     EvenTicks(-high, high, 4),
                     std::nullopt};
  return {"Contour curvature",
          std::move(scale),
          {},
          {{stops[5], "above 0: bends outward"},
           {stops[1], "below 0: bends inward"},
           {kUnknown, "level: no contour"}}};
}

Shading LeftoverShading(const Scene& scene) {
  const double high = scene.scallop ? *scene.scallop + scene.tolerance
                                    : RoundUp(Quantile(scene, ShadedValue::kLeftover, 0.98));
  ScaleShading scale{ShadedValue::kLeftover,
                     {0.0, high, Stops({"#f7fbff", "#d2e3f3", "#9ac8e0", "#529dcc", "#1c6cb1", "#08306b"}),
                      kTooLow, kAlarm, kUnknown},
                     "mm",
                     EvenTicks(0.0, high, 3),
                     std::nullopt};
  return {"Leftover",
          std::move(scale),
          {},
          {{kAlarm, scene.scallop ? std::string("above scallop + tolerance")
                                  : fmt::format("above {} mm", ShortNumber(high))},
           {kTooLow, "below 0"}}};
}

Shading GougeShading(const Scene& scene) {
  const std::vector<Rgb> stops = Stops({"#e9eef2", "#f6dfa0", "#eeb04e", "#e0812c"});
  ScaleShading scale{ShadedValue::kGouge,
                     {0.0, scene.tolerance, stops, stops.front(), kGouged, kUnknown},
                     "mm",
                     EvenTicks(0.0, scene.tolerance, 2),
                     std::nullopt};
  return {"Gouge", std::move(scale), {}, {{kGouged, "above the tolerance"}}};
}

bool HasTrianglesInNoRegion(const Scene& scene) {
  return std::any_of(scene.mesh.begin(), scene.mesh.end(), [](const v1::MeshBlock& block) {
    return std::find(block.region_id().begin(), block.region_id().end(), -1) != block.region_id().end();
  });
}

Shading RegionShading(const Scene& scene) {
  Shading shading{"Region", std::nullopt, {{-1, kUnknown}}, {}};
  for (const v1::Region& region : scene.regions.regions()) {
    const Rgb color = FromHex(RegionColor(region));
    shading.of_region[region.id()] = color;
    shading.swatches.push_back({color, RegionName(region)});
  }
  if (HasTrianglesInNoRegion(scene)) shading.swatches.push_back({kUnknown, "no region"});
  return shading;
}

Shading UnreachableShading(const Scene& scene) {
  const std::vector<Rgb> colors =
      Stops({"#d7191c", "#e88f1a", "#7b3fa0", "#1b7fb8", "#b5367a", "#6b7a1e", "#3c3c99", "#00877a"});
  Shading shading{"Unreachable", std::nullopt, {{-1, kUnknown}}, {}};
  std::vector<std::string> reasons;
  for (const v1::Region& region : scene.regions.regions()) {
    shading.of_region[region.id()] = kPlain;
    if (!IsUnreached(region)) continue;
    const std::string reason = Short(region.unreachable_reason());
    const auto found = std::find(reasons.begin(), reasons.end(), reason);
    const auto k = static_cast<std::size_t>(found - reasons.begin());
    const Rgb color = colors[k % colors.size()];
    shading.of_region[region.id()] = color;
    if (found != reasons.end()) continue;
    reasons.push_back(reason);
    shading.swatches.push_back({color, reason});
  }
  shading.swatches.push_back({kPlain, "reachable"});
  if (HasTrianglesInNoRegion(scene)) shading.swatches.push_back({kUnknown, "no region"});
  return shading;
}

bool HasValues(const Scene& scene, ShadedValue value) {
  return std::any_of(scene.mesh.begin(), scene.mesh.end(),
                     [&](const v1::MeshBlock& block) { return !ValuesOf(block, value).empty(); });
}

}  // namespace

std::vector<std::string> ShadingNames() {
  return {"region", "slope", "curvature", "leftover", "gouge", "unreachable", "plain"};
}

absl::StatusOr<Shading> MakeShading(const Scene& scene, const std::string& name) {
  if ((name == "leftover" && !HasValues(scene, ShadedValue::kLeftover)) ||
      (name == "gouge" && !HasValues(scene, ShadedValue::kGouge))) {
    return absl::InvalidArgumentError(
        fmt::format("a picture shaded by {} needs a verified program: take it from mill or verify", name));
  }
  if (name == "region") return RegionShading(scene);
  if (name == "slope") return SlopeShading(scene);
  if (name == "curvature") return CurvatureShading(scene);
  if (name == "leftover") return LeftoverShading(scene);
  if (name == "gouge") return GougeShading(scene);
  if (name == "unreachable") return UnreachableShading(scene);
  return Shading{"Plain", std::nullopt, {{-1, kPlain}}, {{kPlain, "surface"}}};
}

std::vector<float> ValuesOf(const v1::MeshBlock& block, ShadedValue value) {
  const auto copy = [](const auto& values) { return std::vector<float>(values.begin(), values.end()); };
  switch (value) {
    case ShadedValue::kSlope:
      return copy(block.slope_deg());
    case ShadedValue::kLeftover:
      return copy(block.leftover_mm());
    case ShadedValue::kGouge:
      return copy(block.gouge_mm());
    case ShadedValue::kCurvature:
      break;
  }
  std::vector<float> outward = copy(block.contour_curvature_per_mm());
  for (float& curvature : outward) curvature = -curvature;
  return outward;
}

std::string ShortNumber(double value) { return fmt::format("{:.3g}", value); }

double RoundUp(double value) {
  if (!(value > 0.0)) return 1.0;
  const double power = std::pow(10.0, std::floor(std::log10(value) + 1e-9));
  for (const double step : {1.0, 2.0, 5.0})
    if (value <= step * power * (1.0 + 1e-9)) return step * power;
  return 10.0 * power;
}

}  // namespace patchmill::cli
