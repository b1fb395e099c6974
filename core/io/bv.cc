#include "core/io/bv.h"

#include <iterator>
#include <utility>

#include <fmt/format.h>

#include "core/base/status.h"
#include "core/io/model_builder.h"
#include "core/io/text_scanner.h"

namespace patchmill {
namespace {

absl::StatusOr<PatchShape> ReadTriangle(TextScanner& scanner) {
  BezierTriangle patch;
  PM_ASSIGN_OR_RETURN(patch.degree, ReadDegree(scanner, "degree of the triangle"));
  PM_ASSIGN_OR_RETURN(patch.points, ReadPoints(scanner, (patch.degree + 1) * (patch.degree + 2) / 2));
  return patch;
}

absl::StatusOr<PatchShape> ReadTensor(TextScanner& scanner, bool one_degree) {
  BezierPatch patch;
  PM_ASSIGN_OR_RETURN(patch.degree_u,
                      ReadDegree(scanner, one_degree ? "degree of the patch" : "degree in u"));
  patch.degree_v = patch.degree_u;
  if (!one_degree) {
    PM_ASSIGN_OR_RETURN(patch.degree_v, ReadDegree(scanner, "degree in v"));
  }
  PM_ASSIGN_OR_RETURN(patch.points, ReadPoints(scanner, (patch.degree_u + 1) * (patch.degree_v + 1)));
  return patch;
}

absl::StatusOr<PatchShape> ReadRational(TextScanner& scanner) {
  BezierPatch patch;
  PM_ASSIGN_OR_RETURN(patch.degree_u, ReadDegree(scanner, "degree in u"));
  PM_ASSIGN_OR_RETURN(patch.degree_v, ReadDegree(scanner, "degree in v"));
  PM_ASSIGN_OR_RETURN(RationalPoints net,
                      ReadRationalPoints(scanner, (patch.degree_u + 1) * (patch.degree_v + 1)));
  patch.points = std::move(net.points);
  patch.weights = std::move(net.weights);
  return patch;
}

absl::StatusOr<PatchShape> ReadPatch(TextScanner& scanner) {
  PM_ASSIGN_OR_RETURN(const std::string_view kind, scanner.Word("the kind of a patch"));
  if (kind == "3") return ReadTriangle(scanner);
  if (kind == "4") return ReadTensor(scanner, true);
  if (kind == "5") return ReadTensor(scanner, false);
  if (kind == "8") return ReadRational(scanner);
  constexpr std::string_view kKnown =
      "3 (Bezier triangle), 4 and 5 (tensor Bezier) and 8 (rational) are read";
  if (kind == "1")
    return scanner.Fail(fmt::format("kind 1 is a polygon mesh, not a patch; kinds {}", kKnown));
  return scanner.Fail(fmt::format("{} is no known kind of patch; kinds {}", Quoted(kind), kKnown));
}

}  // namespace

absl::StatusOr<PatchModel> ReadBv(std::string_view text) {
  TextScanner scanner(text);
  ModelBuilder builder;
  while (!scanner.AtEnd()) {
    if (scanner.Peek() == "Group" || scanner.Peek() == "group") {
      scanner.SkipLine();
      continue;
    }
    const int line = scanner.line();
    PM_ASSIGN_OR_RETURN(PatchShape shape, ReadPatch(scanner));
    PM_RETURN_IF_ERROR(builder.Add(scanner, line, std::move(shape)));
  }
  if (builder.empty()) return scanner.Fail("the text holds no patch");
  return builder.Finish(scanner);
}

absl::StatusOr<std::string> WriteBv(const PatchModel& model, int digits) {
  std::string out;
  const auto put = std::back_inserter(out);
  const auto put_point = [&](const Vec3& p, double w, bool rational) {
    const Vec3 q = rational ? Vec3(w * p) : p;
    fmt::format_to(put, "{:.{}g} {:.{}g} {:.{}g}", q.x(), digits, q.y(), digits, q.z(), digits);
    if (rational) fmt::format_to(put, " {:.{}g}", w, digits);
    out += '\n';
  };
  for (std::size_t k = 0; k < model.patches.size(); ++k) {
    const PatchShape& shape = model.patches[k].shape;
    if (const auto* b = std::get_if<BezierPatch>(&shape)) {
      const bool rational = !b->weights.empty();
      fmt::format_to(put, "{}\n{} {}\n", rational ? 8 : 5, b->degree_u, b->degree_v);
      for (std::size_t i = 0; i < b->points.size(); ++i) {
        put_point(b->points[i], rational ? b->weights[i] : 1.0, rational);
      }
    } else if (const auto* t = std::get_if<BezierTriangle>(&shape); t != nullptr && t->weights.empty()) {
      fmt::format_to(put, "3 {}\n", t->degree);
      for (const Vec3& p : t->points) put_point(p, 1.0, false);
    } else {
      return absl::InvalidArgumentError(
          fmt::format("patches[{}] is neither a tensor Bezier patch nor a polynomial Bezier triangle; .bv "
                      "holds no others",
                      k));
    }
  }
  return out;
}

}  // namespace patchmill
