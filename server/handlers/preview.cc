#include "server/convert/preview.h"

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "core/base/index.h"
#include "core/base/status.h"
#include "core/editing/changed_faces.h"
#include "core/editing/edit_network.h"
#include "core/joining/network_findings.h"
#include "core/lines/zero_curves.h"
#include "server/convert/editing.h"
#include "server/convert/fields.h"
#include "server/convert/lines.h"
#include "server/convert/report.h"
#include "server/handlers/handlers.h"
#include "server/handlers/prepare.h"
#include "server/joined_base.h"
#include "server/limits.h"
#include "server/trace_levels.h"

namespace patchmill {
namespace {

struct PreviewOrder {
  PreviewDetail detail;
  std::vector<LineOrder> lines;
  double tolerance = 0.05, min_loop = 0.5;  // mm
};

// A family has to look the same on the faces of the answer as on the whole surface.
void CheckFamily(const v1::LineFamily& family, const std::string& at, FieldErrors& errors) {
  switch (family.kind()) {
    case v1::LINE_KIND_FLOW:
    case v1::LINE_KIND_SLOPE_FLOW:
    case v1::LINE_KIND_CURVATURE:
    case v1::LINE_KIND_INTERSECTION:
      errors.Add(At(at, "kind"), fmt::format("= {}; its lines do not end at faces: use TraceLines",
                                             v1::LineKind_Name(family.kind())));
      break;
    case v1::LINE_KIND_CONTOUR:
    case v1::LINE_KIND_EQUI_SLOPE:
      if (family.levels().empty()) {
        errors.Add(At(at, "levels"), "is missing; required, so that all faces have the same levels");
      }
      break;
    default:
      break;
  }
}

absl::StatusOr<PreviewOrder> ReadPreviewOrder(const v1::PreviewRequest& request) {
  constexpr int kMostCells = 64;
  FieldErrors errors;
  PreviewOrder order;
  order.detail.controls = request.with_controls();
  order.detail.combs = request.with_combs();
  if (request.has_cells()) order.detail.cells = request.cells();
  if (const int cells = order.detail.cells; cells < 1 || cells > kMostCells) {
    errors.Add("cells", fmt::format("= {}; must be in [1, {}]", cells, kMostCells));
  }
  if (request.families_size() > limits::kMaxLineFamilies) {
    errors.Add("families", fmt::format("has {} elements; must have at most {}", request.families_size(),
                                       limits::kMaxLineFamilies));
    return errors.ToStatus();
  }
  for (int k = 0; k < request.families_size(); ++k) {
    const std::string at = fmt::format("families[{}]", k);
    order.lines.push_back(FromProto(request.families(k), at, errors));
    CheckFamily(request.families(k), at, errors);
  }
  if (request.has_tolerance_mm()) order.tolerance = request.tolerance_mm();
  Require(errors, "tolerance_mm", order.tolerance, order.tolerance >= 1e-6 && order.tolerance <= 100.0,
          "in [1e-06, 100]");
  if (request.has_min_loop_mm()) order.min_loop = request.min_loop_mm();
  Require(errors, "min_loop_mm", order.min_loop, order.min_loop >= 1e-3 && order.min_loop <= 1000.0,
          "in [0.001, 1000]");
  PM_RETURN_IF_ERROR(errors.ToStatus());
  return order;
}

// A surface of some patches of the network, in their order.
absl::StatusOr<Surface> SurfaceOf(const JoinedNetwork& joined, const std::vector<int>& patches,
                                  const RunContext& run) {
  PatchModel model;
  model.join_tolerance = joined.model.join_tolerance;
  for (const int p : patches) model.patches.push_back({"", joined.model.patches[At(p)].shape});
  PM_ASSIGN_OR_RETURN(PatchNetwork network, BuildNetwork(std::move(model), run));
  SurfaceParams params;
  params.max_depth = 0;  // lines need pieces, not bounds
  return BuildSurface(std::move(network), params, run);
}

absl::Status AddLines(const Surface& surface, const std::vector<int>& patches, const PreviewOrder& order,
                      const RunContext& run, v1::PreviewResponse* response) {
  TraceParams params{{}, order.tolerance, Vec3::Zero()};
  params.mesh.min_cell = order.min_loop;
  params.mesh.max_cell = std::max(8.0 * order.min_loop, 1.0);
  PM_ASSIGN_OR_RETURN(const std::vector<TracedLevel> levels, TraceLevels(surface, order.lines, params, run));
  for (const TracedLevel& level : levels) {
    v1::LineSet& set = *response->add_sets() = SetOf(level, order.lines[At(level.family)], params.zero);
    for (const ZeroCurve& curve : level.curves) {
      v1::SurfaceLine& made = *set.add_lines() = ToProto(surface, curve, params.zero);
      for (int& index : *made.mutable_patch_index()) index = patches[At(index)];
    }
  }
  return absl::OkStatus();
}

// The patches and the edges beside them.
absl::Status AddPicture(const JoinedNetwork& joined, const std::vector<int>& patches,
                        const PreviewDetail& detail, const RunContext& run, v1::PreviewResponse* response) {
  const double side = detail.cells + 1.0;
  const double vertices = side * side * static_cast<double>(patches.size());
  if (vertices > limits::kMaxPolylinePoints) {
    return LimitError("preview_vertices", limits::kMaxPolylinePoints, vertices);
  }
  std::vector<int> place(joined.model.patches.size(), -1);
  for (std::size_t k = 0; k < patches.size(); ++k) place[At(patches[k])] = static_cast<int>(k);
  std::vector<std::array<const JoinedEdge*, 4>> sides(patches.size(), {nullptr, nullptr, nullptr, nullptr});
  for (const JoinedEdge& edge : joined.edges) {
    bool beside = false;
    for (const FaceSide& s : edge.topology.faces) {
      if (place[At(s.face)] < 0) continue;
      sides[At(place[At(s.face)])][At(s.side)] = &edge;
      beside = true;
    }
    if (beside) *response->add_edges() = ToPreview(joined, edge, detail);
  }
  for (std::size_t k = 0; k < patches.size(); ++k) {
    PM_RETURN_IF_ERROR(run.Check());
    v1::PreviewPatch& made = *response->add_patches() = ToPreview(joined, patches[k], detail);
    const PatchShape& shape = joined.model.patches[At(patches[k])].shape;
    if (!detail.controls || !std::holds_alternative<G2GregoryPatch>(shape)) continue;
    for (int s = 0; s < 4; ++s) {
      if (const JoinedEdge* edge = sides[k][At(s)]) *made.add_middles() = ToMiddle(shape, s, *edge);
    }
  }
  return absl::OkStatus();
}

absl::Status MakePreview(const Call& call, const v1::PreviewRequest& request, const PreviewOrder& order,
                         const RunContext& run, v1::PreviewResponse* response) {
  PM_ASSIGN_OR_RETURN(const std::shared_ptr<const JoinedBase> base,
                      FindJoinedBase(request.source(), "source", run, ModelsOf(call)));
  const auto findings = [response](const Diagnostics& list) {
    AddDiagnostics(list, Vec3::Zero(), response->mutable_diagnostics());
  };
  if (!base->checked.faults.empty()) {
    findings(base->checked.faults);
    return absl::OkStatus();
  }
  PM_ASSIGN_OR_RETURN(const std::vector<NetworkEdit> edits, FromProto(request.edits(), base->checked.unit));
  auto edited = EditNetwork(base->checked.network, base->joined, edits, run);
  if (!edited.ok()) return WithFieldPath(edited.status(), request.edits());
  findings(GoalFindings(*edited, request.edits()));
  AddReached(*edited, base->checked.unit, response->mutable_goals());
  response->set_face_count(static_cast<int>(edited->network.faces.size()));
  JoinedNetwork made;
  if (!edits.empty()) {
    PM_ASSIGN_OR_RETURN(made, JoinNetwork(edited->network, run));
  }
  const JoinedNetwork& joined = edits.empty() ? base->joined : made;
  findings(joined.findings);
  if (HasError(joined.findings)) return absl::OkStatus();
  const std::vector<int> changed = ChangedFaces(base->joined, joined);
  std::vector<int> patches;
  PatchModel shown;
  for (int p = 0; p < static_cast<int>(joined.model.patches.size()); ++p) {
    if (!request.all_faces() && !std::ranges::binary_search(changed, joined.face_of[At(p)])) continue;
    patches.push_back(p);
    shown.patches.push_back({"", joined.model.patches[At(p)].shape});
  }
  if (!patches.empty()) {
    if (const Diagnostics faults = ValidateModel(shown); !faults.empty()) {
      findings(faults);
      return absl::OkStatus();
    }
  }
  response->mutable_changed_faces()->Add(changed.begin(), changed.end());
  PM_RETURN_IF_ERROR(AddPicture(joined, patches, order.detail, run, response));
  if (order.lines.empty() || patches.empty()) return absl::OkStatus();
  // Of the network before the edits, so that families stay what they are while a hand drags.
  const OccurringNormals normals =
      NeedsNormals(order.lines) ? NormalsOf(base->joined.model.patches) : OccurringNormals();
  PreviewOrder chosen = order;
  for (LineOrder& line : chosen.lines) line = Chosen(std::move(line), normals);
  PM_ASSIGN_OR_RETURN(const Surface surface, SurfaceOf(joined, patches, run));
  return AddLines(surface, patches, chosen, run, response);
}

}  // namespace

absl::Status HandlePreview(const Call& call, const v1::PreviewRequest& request,
                           v1::PreviewResponse* response) {
  PM_RETURN_IF_ERROR(RefuseUnknownFields(request));
  PM_RETURN_IF_ERROR(CheckThreads(request.max_threads(), "max_threads"));
  PM_ASSIGN_OR_RETURN(const PreviewOrder order, ReadPreviewOrder(request));
  return RunQuickCall(call, {.max_threads = request.max_threads()}, [&](const RunContext& run) {
    return MakePreview(call, request, order, run, response);
  });
}

}  // namespace patchmill
