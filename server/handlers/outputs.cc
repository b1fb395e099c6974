#include "server/handlers/outputs.h"

#include <fmt/format.h>

#include "server/errors.h"

namespace patchmill {

absl::StatusOr<Outputs> ReadOutputs(const google::protobuf::RepeatedField<int>& asked,
                                    const Outputs& possible, const Outputs& defaults) {
  if (asked.empty()) return defaults;
  FieldErrors errors;
  Outputs outputs;
  for (int i = 0; i < asked.size() && i < 100; ++i) {
    const std::string field = fmt::format("outputs[{}]", i);
    if (possible.contains(asked[i])) {
      outputs.insert(asked[i]);
    } else {
      errors.Add(field, fmt::format("= {}; this call does not have that output", asked[i]));
    }
  }
  if (!errors.empty()) return errors.ToStatus();
  return outputs;
}

}  // namespace patchmill
