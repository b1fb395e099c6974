// A picture of a job in 3-D as PNG: a view of the 3-D page, without a browser and without a GPU.
#pragma once

#include <string>
#include <vector>

#include <absl/status/statusor.h>

#include "clients/cli/output_file.h"
#include "clients/cli/scene.h"
#include "clients/render/camera.h"
#include "clients/render/image.h"

namespace patchmill::cli {

struct PictureOptions {
  render::StandardView view = render::StandardView::kIso;
  std::string shading;  // of ShadingNames(); empty: by region, or leftover where the scene has no regions
  std::vector<std::string> layers = {"passes", "links", "borders", "stock", "clamps"};  // of LayerNames()
  render::PixelSize size{1600, 1200};                                                   // 320 to 4096 each
};

// "passes", "links", "rapids", "borders", "stock", "clamps", "tool". "links" are leads, approaches and
// retracts, too.
std::vector<std::string> LayerNames();

// The bytes of the file. The same scene and options give the same bytes. Time and memory grow with the
// pixels: at most 0.7 GB. INVALID_ARGUMENT if the scene has no data for the shading; DATA_LOSS if it has no
// triangles or its arrays are damaged.
absl::StatusOr<std::string> MakePicture(const Scene& scene, const PictureOptions& options);

// A page or a picture, by the ending of the file: .html, or .png.
absl::StatusOr<std::string> MakePreview(const Scene& scene, const OutputFile& file,
                                        const PictureOptions& options);

}  // namespace patchmill::cli
