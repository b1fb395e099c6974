// The 3-D page of a job: the part, the regions, the program and the tool, in one HTML file that needs no
// network.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <absl/status/statusor.h>

#include "patchmill/v1/region.pb.h"
#include "patchmill/v1/report.pb.h"
#include "patchmill/v1/setup.pb.h"
#include "patchmill/v1/tool.pb.h"
#include "patchmill/v1/toolpath.pb.h"

namespace patchmill::cli {

// The contents of a page. A page leaves out whatever is absent here.
struct Scene {
  std::string title;
  v1::Setup setup;
  v1::Tool tool;                  // of several tools, the first
  double tolerance = 0.0;         // mm
  std::optional<double> scallop;  // mm
  double steep_angle = 45.0;      // degrees
  v1::RegionMap regions;
  v1::Report report;
  std::vector<v1::MeshBlock> mesh;
  std::vector<v1::PathBlock> paths;
  std::string program;
};

// OK if the arrays of the scene can be drawn, else DATA_LOSS (scene_arrays.h).
absl::Status CheckArrays(const Scene& scene);

// The page as HTML. FAILED_PRECONDITION if this program was built without it; DATA_LOSS if the scene has no
// triangles or its arrays are damaged.
absl::StatusOr<std::string> MakePage(const Scene& scene);

// OK if MakePage can make a page.
absl::Status CheckPage();

}  // namespace patchmill::cli
