#include "core/io/model_text.h"

#include <fmt/format.h>

#include "core/io/bez.h"
#include "core/io/bpt.h"
#include "core/io/bv.h"
#include "core/io/patches.h"
#include "core/io/text_scanner.h"

namespace patchmill {

absl::StatusOr<PatchModel> ReadModelText(std::string_view format, std::string_view text,
                                         Diagnostics* remarks) {
  if (format == "bpt") return ReadBpt(text);
  if (format == "bv") return ReadBv(text, remarks);
  if (format == "bez") return ReadBez(text);
  if (format == "patches") return ReadPatches(text);
  return absl::InvalidArgumentError(fmt::format(
      "{} is no known format of a model text; known are bpt, bv, bez and patches", Quoted(format)));
}

}  // namespace patchmill
