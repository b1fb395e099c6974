#include "core/io/patches.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include <fmt/format.h>

#include "core/base/status.h"
#include "core/io/model_builder.h"
#include "core/io/text_scanner.h"

namespace patchmill {
namespace {

constexpr std::size_t kLeastPatchBytes = sizeof("triangle 1 0 0 0 0 0 0 0 0 0") - 1;

template <class Gregory>
absl::StatusOr<PatchShape> ReadGregory(TextScanner& scanner) {
  Gregory patch;
  patch.blend = GregoryPatch::Blend::kCorner;
  for (Vec3& p : patch.points) {
    PM_ASSIGN_OR_RETURN(p, scanner.Point());
  }
  return patch;
}

absl::StatusOr<PatchShape> ReadPatch(TextScanner& scanner) {
  PM_ASSIGN_OR_RETURN(const std::string_view key, scanner.Word("the key of a patch"));
  if (key == "bezier") {
    BezierPatch patch;
    PM_ASSIGN_OR_RETURN(patch.degree_u, ReadDegree(scanner, "degree in u"));
    PM_ASSIGN_OR_RETURN(patch.degree_v, ReadDegree(scanner, "degree in v"));
    PM_ASSIGN_OR_RETURN(patch.points, ReadPoints(scanner, (patch.degree_u + 1) * (patch.degree_v + 1)));
    patch.points = SecondFastest(patch.points, patch.degree_v + 1, patch.degree_u + 1);
    return patch;
  }
  if (key == "triangle") {
    BezierTriangle patch;
    PM_ASSIGN_OR_RETURN(patch.degree, ReadDegree(scanner, "degree of the triangle"));
    PM_ASSIGN_OR_RETURN(patch.points, ReadPoints(scanner, (patch.degree + 1) * (patch.degree + 2) / 2));
    return patch;
  }
  if (key == "gregory4") return ReadGregory<GregoryPatch>(scanner);
  if (key == "gregory3") return ReadGregory<GregoryTriangle>(scanner);
  return scanner.Fail(fmt::format(
      "{} is no known key of a patch; known are bezier, triangle, gregory4 and gregory3", Quoted(key)));
}

}  // namespace

absl::StatusOr<PatchModel> ReadPatches(std::string_view text) {
  TextScanner scanner(text);
  PM_ASSIGN_OR_RETURN(const std::string_view key, scanner.Word("\"patches\""));
  if (key != "patches")
    return scanner.Fail(fmt::format("{} stands where \"patches\" is expected", Quoted(key)));
  PM_ASSIGN_OR_RETURN(const int count, ReadPatchCount(scanner, kLeastPatchBytes));
  ModelBuilder builder;
  for (int i = 0; i < count; ++i) {
    scanner.AtEnd();
    const int line = scanner.line();
    PM_ASSIGN_OR_RETURN(PatchShape shape, ReadPatch(scanner));
    PM_RETURN_IF_ERROR(builder.Add(scanner, line, std::move(shape)));
  }
  return builder.Finish(scanner);
}

absl::StatusOr<std::string> WritePatches(const PatchModel& model, int digits) {
  std::string out = fmt::format("patches {}\n", model.patches.size());
  const auto put_points = [&](const auto& points) {
    for (const Vec3& p : points) {
      fmt::format_to(std::back_inserter(out), "{:.{}g} {:.{}g} {:.{}g}\n", p.x(), digits, p.y(), digits,
                     p.z(), digits);
    }
  };
  for (std::size_t k = 0; k < model.patches.size(); ++k) {
    const PatchShape& shape = model.patches[k].shape;
    if (const auto* b = std::get_if<BezierPatch>(&shape); b != nullptr && b->weights.empty()) {
      out += fmt::format("bezier {} {}\n", b->degree_u, b->degree_v);
      put_points(SecondFastest(b->points, b->degree_u + 1, b->degree_v + 1));
    } else if (const auto* t = std::get_if<BezierTriangle>(&shape); t != nullptr && t->weights.empty()) {
      out += fmt::format("triangle {}\n", t->degree);
      put_points(t->points);
    } else if (const auto* g = std::get_if<GregoryPatch>(&shape);
               g != nullptr && g->blend == GregoryPatch::Blend::kCorner) {
      out += "gregory4\n";
      put_points(g->points);
    } else if (const auto* h = std::get_if<GregoryTriangle>(&shape);
               h != nullptr && h->blend == GregoryPatch::Blend::kCorner) {
      out += "gregory3\n";
      put_points(h->points);
    } else {
      return absl::InvalidArgumentError(fmt::format("patches[{}] has a form that .patches cannot hold", k));
    }
  }
  return out;
}

}  // namespace patchmill
