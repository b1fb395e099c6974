// A patch model that a command writes.
#pragma once

#include <string>

#include "clients/cli/output_file.h"
#include "patchmill/v1/model.pb.h"

namespace patchmill::cli {

// An output file for a model: .json (JSON of the contract) or .pb (its bytes). Empty path: no file is wanted.
OutputFile ModelFile(const std::string& path);
void SetModel(const v1::PatchModel& model, OutputFile& file);

}  // namespace patchmill::cli
