// Chooses the colours of the part in a picture, and their legend: the shadings are those of the 3-D page.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include <absl/status/statusor.h>

#include "clients/cli/scene.h"
#include "clients/render/color.h"

namespace patchmill::cli {

// A colour of the legend and what it means.
struct Swatch {
  render::Rgb color;
  std::string text;
};

enum class ShadedValue { kSlope, kCurvature, kLeftover, kGouge };

struct Tick {
  double value = 0.0;
  std::string text;
};

// Colours by a value of each vertex.
struct ScaleShading {
  ShadedValue value = ShadedValue::kSlope;
  render::ColorScale scale;
  std::string unit;
  std::vector<Tick> ticks;
  std::optional<double> mark;  // a value that the part shows as a line
};

struct Shading {
  std::string name;                      // "Leftover"
  std::optional<ScaleShading> scale;     // absent: by region
  std::map<int, render::Rgb> of_region;  // by Region.id, -1 in none
  std::vector<Swatch> swatches;          // of the legend, below the scale if there is one
};

// "region", "slope", "curvature", "leftover", "gouge", "unreachable", "plain".
std::vector<std::string> ShadingNames();

// INVALID_ARGUMENT if the scene has no data for it: leftover and gouge need a verified program.
absl::StatusOr<Shading> MakeShading(const Scene& scene, const std::string& name);

// The values of a block's vertices, as the scale counts them; NaN where there is none.
std::vector<float> ValuesOf(const v1::MeshBlock& block, ShadedValue value);

// A number with three digits that matter: "0.0125", "1200".
std::string ShortNumber(double value);
// The next of 1, 2, 5, 10, 20, ... times a power of ten that is not below `value`; 1 if it is not above 0.
double RoundUp(double value);

}  // namespace patchmill::cli
