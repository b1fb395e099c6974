#include "core/io/bpt.h"

#include <iterator>
#include <utility>

#include <fmt/format.h>

#include "core/base/status.h"
#include "core/io/model_builder.h"
#include "core/io/text_scanner.h"

namespace patchmill {
namespace {
constexpr std::size_t kLeastPatchBytes = sizeof("1 1 0 0 0 0 0 0 0 0 0 0 0 0") - 1;
}

absl::StatusOr<PatchModel> ReadBpt(std::string_view text) {
  TextScanner scanner(text);
  PM_ASSIGN_OR_RETURN(const int count, ReadPatchCount(scanner, kLeastPatchBytes));
  ModelBuilder builder;
  for (int i = 0; i < count; ++i) {
    scanner.AtEnd();
    const int line = scanner.line();
    BezierPatch patch;
    PM_ASSIGN_OR_RETURN(patch.degree_u, ReadDegree(scanner, "degree in u"));
    PM_ASSIGN_OR_RETURN(patch.degree_v, ReadDegree(scanner, "degree in v"));
    PM_ASSIGN_OR_RETURN(patch.points, ReadPoints(scanner, (patch.degree_u + 1) * (patch.degree_v + 1)));
    PM_RETURN_IF_ERROR(builder.Add(scanner, line, std::move(patch)));
  }
  return builder.Finish(scanner);
}

absl::StatusOr<std::string> WriteBpt(const PatchModel& model, int digits) {
  std::string out = fmt::format("{}\n", model.patches.size());
  for (std::size_t i = 0; i < model.patches.size(); ++i) {
    const auto* patch = std::get_if<BezierPatch>(&model.patches[i].shape);
    if (patch == nullptr || !patch->weights.empty()) {
      return absl::InvalidArgumentError(
          fmt::format("patches[{}] is no polynomial tensor Bezier patch; .bpt holds nothing else", i));
    }
    fmt::format_to(std::back_inserter(out), "{} {}\n", patch->degree_u, patch->degree_v);
    for (const Vec3& p : patch->points) {
      fmt::format_to(std::back_inserter(out), "{:.{}g} {:.{}g} {:.{}g}\n", p.x(), digits, p.y(), digits,
                     p.z(), digits);
    }
  }
  return out;
}

}  // namespace patchmill
