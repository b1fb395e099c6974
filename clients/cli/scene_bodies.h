// What stands around the part in pages and pictures: stock, clamps and the tool.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "clients/cli/scene.h"
#include "clients/render/camera.h"

namespace patchmill::cli {

// An upright body.
struct Prism {
  std::string name;
  std::vector<std::array<double, 2>> outline;  // x y, mm
  double bottom = 0.0, top = 0.0;              // z, mm
};

// Of all triangles. Without any, its min is above its max.
render::Box BoxOf(const std::vector<v1::MeshBlock>& mesh);

// The stock has no lower end: it is drawn down to the lowest point of the part. A stock with a model of its
// own is drawn as the box of that, up to its top. Absent if none is stated.
std::optional<Prism> StockOf(const Scene& scene, const render::Box& part);

// Clamps are drawn down to `bottom`, mm, or to their own top where that is lower.
std::vector<Prism> ClampsOf(const v1::Setup& setup, double bottom);

// Height above the tip and radius, mm, from below.
using Profile = std::vector<std::pair<double, double>>;
struct ToolProfiles {
  Profile flutes, shank, holder;  // the holder is empty if there is none
};
// Without a stated flute length the flutes are as long as the ball is wide, and without a holder the shank
// is four times its width.
ToolProfiles ProfilesOf(const v1::Tool& tool);

}  // namespace patchmill::cli
