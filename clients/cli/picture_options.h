// The options of pictures in 3-D (.png).
#pragma once

#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <absl/status/statusor.h>

#include "clients/cli/scene_picture.h"

namespace patchmill::cli {

// The options as they are given.
struct PictureFlags {
  std::string view = "iso", shading, layers, size;
};

// Whether the command has a program, so that leftover and gouge can be shown.
enum class PictureOf { kProgram, kRegions };

void AddPictureOptions(CLI::App& app, PictureOf what, PictureFlags& flags);

// INVALID_ARGUMENT names the option, its value and what is allowed.
absl::StatusOr<PictureOptions> MakePictureOptions(const PictureFlags& flags);

}  // namespace patchmill::cli
