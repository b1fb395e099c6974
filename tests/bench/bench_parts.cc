#include "tests/bench/bench_parts.h"

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <map>
#include <memory>
#include <string>

#include "core/io/model_text.h"
#include "tests/support/shapes.h"

namespace patchmill::bench {
namespace {

template <class T>
T OrExit(absl::StatusOr<T> value, const char* what) {
  if (!value.ok()) {
    std::fprintf(stderr, "%s: %s\n", what, std::string(value.status().message()).c_str());
    std::exit(2);
  }
  return *std::move(value);
}

PatchModel ReadModel(const std::string& path) {
  std::ifstream in(PATCHMILL_SOURCE_DIR "/" + path, std::ios::binary);
  const std::string text(std::istreambuf_iterator<char>(in), {});
  return OrExit(ReadModelText(path.substr(path.rfind('.') + 1), text), path.c_str());
}

PatchModel MakeModel(Part part) {
  switch (part) {
    case Part::kTwoHills:
      return testing::TwoHills();
    case Part::kBumpy:
      return testing::Bumpy();
    case Part::kTeapot:
      return ReadModel("examples/teapot.bpt");
    case Part::kToroidalTet:
      return ReadModel("tests/models/toroidal_tet.patches");
  }
  std::abort();
}

}  // namespace

const PatchModel& ModelOf(Part part) {
  static std::map<Part, PatchModel> models;
  const auto [at, is_new] = models.try_emplace(part);
  if (is_new) at->second = MakeModel(part);
  return at->second;
}

Placement PlacementOf(Part part) {
  if (part == Part::kTeapot) return {.scale = 54.8, .up = UpAxis::kY};
  if (part == Part::kToroidalTet) return {.scale = 40.0};
  return {};
}

const Surface& SurfaceOf(Part part) {
  static std::map<Part, std::unique_ptr<Surface>> surfaces;
  std::unique_ptr<Surface>& surface = surfaces[part];
  if (!surface) {
    Setup setup;
    setup.placement = PlacementOf(part);
    surface = std::make_unique<Surface>(
        OrExit(BuildPlacedSurface(ModelOf(part), setup, RunContext()), "BuildPlacedSurface"));
  }
  return *surface;
}

Job JobOf(Part part) {
  Job job;
  job.setup.placement = PlacementOf(part);
  job.operation.tool.cutter = BallEnd{3.0};
  job.operation.tool.spindle_rpm = 12000;
  job.operation.tool.feed = 1200;
  job.operation.tool.plunge_feed = 400;
  job.operation.scallop = part == Part::kTeapot ? 0.02 : 0.01;
  job.operation.tolerance = part == Part::kTwoHills ? 0.005 : 0.01;
  return job;
}

void ResetPeakMemory() { std::ofstream("/proc/self/clear_refs") << "5"; }

double PeakMemory() {
  std::ifstream status("/proc/self/status");
  std::string word;
  double kilobytes = 0.0;
  while (status >> word) {
    if (word == "VmHWM:" && status >> kilobytes) return kilobytes * 1024e-6;
  }
  return 0.0;
}

}  // namespace patchmill::bench
