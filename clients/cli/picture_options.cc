#include "clients/cli/picture_options.h"

#include <algorithm>
#include <string_view>

#include <absl/strings/numbers.h>
#include <absl/strings/str_join.h>
#include <absl/strings/str_split.h>
#include <fmt/format.h>

#include "clients/cli/picture_shading.h"

namespace patchmill::cli {
namespace {

constexpr int kLeastPx = 320, kMostPx = 4096;

absl::StatusOr<render::PixelSize> SizeOf(const std::string& text) {
  const std::vector<std::string> parts = absl::StrSplit(text, 'x');
  render::PixelSize size;
  const auto fits = [](int px) { return px >= kLeastPx && px <= kMostPx; };
  if (parts.size() != 2 || !absl::SimpleAtoi(parts[0], &size.width) ||
      !absl::SimpleAtoi(parts[1], &size.height) || !fits(size.width) || !fits(size.height)) {
    return absl::InvalidArgumentError(
        fmt::format("--picture-size {}: must be WIDTHxHEIGHT, each {} to {} pixels, for example 1600x1200",
                    text, kLeastPx, kMostPx));
  }
  return size;
}

absl::StatusOr<std::vector<std::string>> LayersOf(const std::string& text) {
  if (text == "none") return std::vector<std::string>();
  const std::vector<std::string> known = LayerNames();
  std::vector<std::string> layers = absl::StrSplit(text, ',');
  for (const std::string& layer : layers) {
    if (std::find(known.begin(), known.end(), layer) != known.end()) continue;
    return absl::InvalidArgumentError(
        fmt::format("--picture-layers {}: there is no layer '{}'; there are {}, or none", text, layer,
                    absl::StrJoin(known, ", ")));
  }
  return layers;
}

}  // namespace

void AddPictureOptions(CLI::App& app, PictureOf what, PictureFlags& flags) {
  std::vector<std::string> shadings = ShadingNames();
  if (what == PictureOf::kRegions) {
    std::erase_if(shadings, [](const std::string& name) { return name == "leftover" || name == "gouge"; });
  }
  app.add_option("--picture-view", flags.view, "of a .png: from where it shows the part")
      ->check(CLI::IsMember(render::ViewNames()))
      ->capture_default_str();
  app.add_option(
         "--picture-shading", flags.shading,
         "of a .png: what gives the part its colours; default region, or leftover where there are no regions")
      ->check(CLI::IsMember(shadings));
  app.add_option(
      "--picture-layers", flags.layers,
      fmt::format("of a .png: what it shows beside the part, of {}, with commas, or none;\ndefault {}",
                  absl::StrJoin(LayerNames(), ", "), absl::StrJoin(PictureOptions().layers, ",")));
  app.add_option("--picture-size", flags.size,
                 "of a .png: its width and height in pixels; default 1600x1200");
}

absl::StatusOr<PictureOptions> MakePictureOptions(const PictureFlags& flags) {
  PictureOptions options;
  options.view = render::ViewOf(flags.view).value_or(options.view);
  options.shading = flags.shading;
  if (!flags.layers.empty()) {
    absl::StatusOr<std::vector<std::string>> layers = LayersOf(flags.layers);
    if (!layers.ok()) return layers.status();
    options.layers = *std::move(layers);
  }
  if (!flags.size.empty()) {
    absl::StatusOr<render::PixelSize> size = SizeOf(flags.size);
    if (!size.ok()) return size.status();
    options.size = *size;
  }
  return options;
}

}  // namespace patchmill::cli
