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

absl::StatusOr<PatchShape> ReadRationalTriangle(TextScanner& scanner) {
  BezierTriangle patch;
  PM_ASSIGN_OR_RETURN(patch.degree, ReadDegree(scanner, "degree of the triangle"));
  PM_ASSIGN_OR_RETURN(RationalPoints net,
                      ReadRationalPoints(scanner, (patch.degree + 1) * (patch.degree + 2) / 2));
  patch.points = std::move(net.points);
  patch.weights = std::move(net.weights);
  return patch;
}

constexpr std::string_view kKnown =
    "3 (Bezier triangle), 4 and 5 (tensor Bezier), 8 (rational tensor Bezier) and 11 (rational Bezier "
    "triangle) are read";

absl::StatusOr<PatchShape> ReadPatch(TextScanner& scanner) {
  PM_ASSIGN_OR_RETURN(const std::string_view kind, scanner.Word("the kind of a patch"));
  if (kind == "3") return ReadTriangle(scanner);
  if (kind == "4") return ReadTensor(scanner, true);
  if (kind == "5") return ReadTensor(scanner, false);
  if (kind == "8") return ReadRational(scanner);
  if (kind == "11") return ReadRationalTriangle(scanner);
  return scanner.Fail(fmt::format("{} is no known kind of patch; kinds {}", Quoted(kind), kKnown));
}

// The polygon meshes of a text: how many, how many polygons, and where the first one starts.
struct Meshes {
  int count = 0, polygons = 0, first_line = 0;
};

// Reads over one: its kind, the counts of vertices and polygons, the vertices, and for each polygon the
// count of its vertices and their numbers from 0.
absl::Status SkipMesh(TextScanner& scanner, Meshes& meshes) {
  PM_RETURN_IF_ERROR(scanner.Word("the kind of a patch").status());
  if (meshes.count++ == 0) meshes.first_line = scanner.line();
  PM_ASSIGN_OR_RETURN(const int vertices,
                      scanner.Integer("number of vertices of the mesh", 1, kMaxControlPoints));
  PM_ASSIGN_OR_RETURN(const int polygons,
                      scanner.Integer("number of polygons of the mesh", 0, kMaxControlPoints));
  for (int k = 0; k < vertices; ++k) PM_RETURN_IF_ERROR(scanner.Point().status());
  for (int k = 0; k < polygons; ++k) {
    PM_ASSIGN_OR_RETURN(const int sides,
                        scanner.Integer("number of vertices of a polygon", 3, kMaxControlPoints));
    for (int i = 0; i < sides; ++i) {
      PM_RETURN_IF_ERROR(scanner.Integer("vertex of a polygon", 0, vertices - 1).status());
    }
  }
  if (meshes.polygons <= kMaxControlPoints) meshes.polygons += polygons;
  return absl::OkStatus();
}

absl::Status MeshError(const Meshes& meshes) {
  return absl::InvalidArgumentError(
      fmt::format("line {}: kind 1 is a polygon mesh, not a patch; kinds {}", meshes.first_line, kKnown));
}

}  // namespace

absl::StatusOr<PatchModel> ReadBv(std::string_view text, Diagnostics* remarks) {
  TextScanner scanner(text);
  ModelBuilder builder;
  Meshes meshes;
  while (!scanner.AtEnd()) {
    if (scanner.Peek() == "Group" || scanner.Peek() == "group") {
      scanner.SkipLine();
      continue;
    }
    if (scanner.Peek() == "1") {
      const absl::Status skipped = SkipMesh(scanner, meshes);
      if (!skipped.ok()) return builder.empty() ? MeshError(meshes) : skipped;
      continue;
    }
    const int line = scanner.line();
    PM_ASSIGN_OR_RETURN(PatchShape shape, ReadPatch(scanner));
    PM_RETURN_IF_ERROR(builder.Add(scanner, line, std::move(shape)));
  }
  if (builder.empty()) return meshes.count > 0 ? MeshError(meshes) : scanner.Fail("the text holds no patch");
  if (meshes.count > 0 && remarks != nullptr) {
    remarks->push_back(MakeWarning(
        "MESH_LEFT_OUT",
        fmt::format(
            "line {}: {} of the file's parts {} of kind 1, with {} polygons together, and left out; the "
            "patches alone are read",
            meshes.first_line, meshes.count, meshes.count == 1 ? "is a mesh" : "are meshes", meshes.polygons),
        {.line = meshes.first_line}));
  }
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
    } else if (const auto* t = std::get_if<BezierTriangle>(&shape)) {
      const bool rational = !t->weights.empty();
      fmt::format_to(put, "{} {}\n", rational ? 11 : 3, t->degree);
      for (std::size_t i = 0; i < t->points.size(); ++i) {
        put_point(t->points[i], rational ? t->weights[i] : 1.0, rational);
      }
    } else {
      return absl::InvalidArgumentError(fmt::format(
          "patches[{}] is neither a tensor Bezier patch nor a Bezier triangle; .bv holds no others", k));
    }
  }
  return out;
}

}  // namespace patchmill
