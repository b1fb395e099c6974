#include "clients/cli/model_file.h"

#include "clients/cli/text.h"

namespace patchmill::cli {

OutputFile ModelFile(const std::string& path) { return OutputFile(path, {".json", ".pb"}); }

void SetModel(const v1::PatchModel& model, OutputFile& file) {
  file.Set(file.EndsIn(".pb") ? model.SerializeAsString() : ShortJson(model));
}

}  // namespace patchmill::cli
