#include <utility>

#include <fmt/format.h>

#include "cam/plan/plan.h"
#include "core/base/error_details.h"
#include "core/base/status.h"
#include "core/crossing/network_of_curves.h"
#include "core/division/divide_surface.h"
#include "core/division/mesh_network.h"
#include "core/editing/surface_normals.h"
#include "core/io/obj.h"
#include "core/joining/join_network.h"
#include "core/joining/network_findings.h"
#include "server/convert/fields.h"
#include "server/convert/first_surface.h"
#include "server/convert/model.h"
#include "server/convert/network.h"
#include "server/convert/network_message.h"
#include "server/convert/outline_curves.h"
#include "server/convert/report.h"
#include "server/convert/write_edited.h"
#include "server/handlers/handlers.h"
#include "server/handlers/prepare.h"

namespace patchmill {
namespace {

absl::Status TakeNormals(const v1::BuildModelRequest& request, double unit, PatchModel model,
                         const RunContext& run, v1::BuildModelResponse* response) {
  const auto findings = [response](const Diagnostics& list) {
    AddDiagnostics(list, Vec3::Zero(), response->mutable_diagnostics());
  };
  Diagnostics faults;
  const CurveNetwork before = FromProto(request.network(), unit, faults);
  if (!faults.empty()) {
    findings(faults);
    return absl::OkStatus();
  }
  PM_ASSIGN_OR_RETURN(const Surface surface, BuildPlacedSurface(std::move(model), Setup(), run));
  PM_ASSIGN_OR_RETURN(const NetworkOnSurface made, WithNormalsOf(surface, before, run));
  v1::PatchModel& to = *response->mutable_network_model();
  to.set_length_unit(request.length_unit());
  *to.mutable_network() = request.network();
  WriteEdited(before, made.network, {unit}, to.mutable_network());
  response->set_max_distance_mm(made.max_distance);
  response->set_farthest_vertex(made.farthest_vertex);
  PM_ASSIGN_OR_RETURN(const JoinedNetwork joined, JoinNetwork(made.network, run));
  findings(joined.findings);
  return absl::OkStatus();
}

void SetNetwork(const CurveNetwork& network, v1::BuildModelResponse* response) {
  response->mutable_network_model()->set_length_unit(v1::LENGTH_UNIT_MILLIMETER);
  *response->mutable_network_model()->mutable_network() = ToProto(network);
}

// The patches of a network and the network itself, unless a finding is an error.
void Answer(const CurveNetwork& network, const JoinedNetwork& joined, v1::BuildModelResponse* response) {
  if (joined.model.patches.empty()) return;
  *response->mutable_model() = ToProto(joined.model);
  SetNetwork(network, response);
}

absl::StatusOr<CrossingOptions> OptionsOf(const v1::CrossingCurves& crossing,
                                          const std::vector<DrawnCurve>& curves, double unit) {
  FieldErrors errors;
  Box3 box;
  for (const DrawnCurve& curve : curves) {
    for (const Vec3& p : curve.chain.points) box.Add(p);
  }
  // Many curves lie near to each other, and neighbours must not count as one.
  const double default_share =
      std::min(1e-3, 0.25 / static_cast<double>(std::max<std::size_t>(1, curves.size())));
  constexpr double kMostShare = 0.1, kLeastMm = 1e-6;
  CrossingOptions options;
  options.tolerance = crossing.has_tolerance_mm() ? crossing.tolerance_mm() : default_share * box.Diagonal();
  Require(errors, "crossing.tolerance_mm", options.tolerance,
          options.tolerance >= kLeastMm && options.tolerance <= kMostShare * box.Diagonal(),
          fmt::format("in [{:g}, {:.4g}], a tenth of the diagonal of the curves' box", kLeastMm,
                      kMostShare * box.Diagonal()));
  options.free_ends = crossing.refuse_free_ends() ? FreeEnds::kRefuse : FreeEnds::kTrim;
  if (crossing.direction_size() > 0) {
    if (crossing.direction_size() != 3) {
      errors.Add("crossing.direction",
                 fmt::format("has {} numbers; must have x y z", crossing.direction_size()));
    } else {
      const Vec3 d = unit * Vec3(crossing.direction(0), crossing.direction(1), crossing.direction(2));
      Require(errors, "crossing.direction", d.norm(), d.norm() > 0.0, "of a length above 0");
      options.direction = d;
    }
  }
  if (crossing.has_crease_angle_deg()) {
    const double angle = crossing.crease_angle_deg();
    Require(errors, "crossing.crease_angle_deg", angle, angle >= 0.0 && angle <= 180.0, "in [0, 180]");
    options.crease_angle = Radians(angle);
  }
  PM_RETURN_IF_ERROR(errors.ToStatus());
  return options;
}

absl::Status BuildCrossing(const v1::BuildModelRequest& request, double unit, const RunContext& run,
                           v1::BuildModelResponse* response) {
  PM_ASSIGN_OR_RETURN(DrawnCurves drawn, DrawnCurvesOf(request.crossing(), unit));
  const std::vector<DrawnCurve>& curves = drawn.curves;
  PM_ASSIGN_OR_RETURN(const CrossingOptions options, OptionsOf(request.crossing(), curves, unit));
  absl::StatusOr<NetworkOfCurves> made = MakeNetworkOfCurves(curves, options, run);
  if (!made.ok()) return WithFieldPrefix("crossing.", made.status());
  Diagnostics findings = std::move(drawn.findings);
  findings.insert(findings.end(), made->findings.begin(), made->findings.end());
  if (!HasError(findings)) {
    findings.insert(findings.end(), made->joined.findings.begin(), made->joined.findings.end());
    Answer(made->network, made->joined, response);
    response->set_max_distance_mm(made->max_moved);
  }
  AddDiagnostics(findings, Vec3::Zero(), response->mutable_diagnostics());
  return absl::OkStatus();
}

absl::StatusOr<Division> DivisionOf(const v1::SurfaceDivision& from) {
  FieldErrors errors;
  const auto parts = [&](const char* field, int count) {
    Require(errors, fmt::format("division.{}", field), count, count >= 0 && count <= kMaxDivisionParts,
            fmt::format("in [1, {}]", kMaxDivisionParts));
    return std::max(1, count);
  };
  Division division{parts("parts_u", from.parts_u()), parts("parts_v", from.parts_v())};
  if (from.has_tolerance_mm()) {
    division.tolerance = from.tolerance_mm();
    Require(errors, "division.tolerance_mm", division.tolerance,
            division.tolerance >= 1e-9 && division.tolerance <= 10.0, "in [1e-9, 10]");
  }
  if (!v1::DivisionLines_IsValid(from.lines())) {
    errors.Add("division.lines",
               fmt::format("= {}; this server does not know that value", static_cast<int>(from.lines())));
  }
  if (from.lines() == v1::DIVISION_LINES_FEWEST) division.lines = DivisionLines::kFewest;
  PM_RETURN_IF_ERROR(errors.ToStatus());
  return division;
}

absl::Status Divide(const v1::BuildModelRequest& request, const PatchShape& shape, const RunContext& run,
                    v1::BuildModelResponse* response) {
  PM_ASSIGN_OR_RETURN(const Division division, DivisionOf(request.division()));
  const auto* surface = std::get_if<BsplinePatch>(&shape);
  if (!surface)
    return FieldError("division", "is set for a Hosaka surface; it is made for B-spline surfaces");
  PM_ASSIGN_OR_RETURN(const DividedSurface divided, DivideSurface(*surface, division, run));
  response->clear_model();
  Answer(divided.network, divided.joined, response);
  response->set_max_distance_mm(divided.max_distance);
  AddDiagnostics(divided.findings, Vec3::Zero(), response->mutable_diagnostics());
  return absl::OkStatus();
}

absl::Status BuildMesh(const v1::ControlMesh& from, double unit, const RunContext& run,
                       v1::BuildModelResponse* response) {
  FieldErrors errors;
  double angle = 180.0;
  if (from.has_crease_angle_deg()) {
    angle = from.crease_angle_deg();
    Require(errors, "mesh.crease_angle_deg", angle, angle >= 0.0 && angle <= 180.0, "in [0, 180]");
  }
  const absl::StatusOr<ObjMesh> read = ReadObj(from.content());
  if (!read.ok()) {
    errors.Add("mesh.content", fmt::format("cannot be read: {}", std::string(read.status().message())));
  }
  PM_RETURN_IF_ERROR(errors.ToStatus());
  PolygonMesh mesh{read->points, read->faces};
  for (Vec3& p : mesh.points) p *= unit;
  Diagnostics findings;
  const CurveNetwork network = MeshNetwork(mesh, Radians(angle), findings);
  PM_ASSIGN_OR_RETURN(const JoinedNetwork joined, JoinNetwork(network, run));
  findings.insert(findings.end(), joined.findings.begin(), joined.findings.end());
  Answer(network, joined, response);
  AddDiagnostics(findings, Vec3::Zero(), response->mutable_diagnostics());
  return absl::OkStatus();
}

// A network alone: its curves of files are put in their places.
absl::Status BuildNetworkAlone(const v1::BuildModelRequest& request, double unit, const RunContext& run,
                               v1::BuildModelResponse* response) {
  Diagnostics findings;
  const CurveNetwork network = FromProto(request.network(), unit, findings);
  if (findings.empty()) {
    PM_ASSIGN_OR_RETURN(const JoinedNetwork joined, JoinNetwork(network, run));
    findings = joined.findings;
    if (!joined.model.patches.empty()) {
      *response->mutable_model() = ToProto(joined.model);
      v1::PatchModel& to = *response->mutable_network_model();
      to.set_length_unit(request.length_unit());
      *to.mutable_network() = request.network();
      PutCurvesInPlace(network, unit, to.mutable_network());
    }
  }
  AddDiagnostics(findings, Vec3::Zero(), response->mutable_diagnostics());
  return absl::OkStatus();
}

absl::Status CheckTogether(const v1::BuildModelRequest& request) {
  FieldErrors errors;
  const bool made =
      request.has_crossing() || request.has_mesh() || request.has_surface() || request.has_division();
  if (request.has_network() && made) {
    errors.Add("network",
               "is set together with curves, a surface or a mesh that become a network of their own; "
               "send it with sections or a boundary, or alone");
  }
  if (request.has_division() && !request.has_sections() && !request.has_boundary() &&
      !request.has_surface()) {
    errors.Add("division",
               "is set, and there is no surface to divide; it belongs to sections, boundary or surface");
  }
  return errors.ToStatus();
}

}  // namespace

absl::Status HandleBuildModel(const Call& call, const v1::BuildModelRequest& request,
                              v1::BuildModelResponse* response) {
  PM_RETURN_IF_ERROR(RefuseUnknownFields(request));
  PM_RETURN_IF_ERROR(CheckThreads(request.max_threads(), "max_threads"));
  const std::optional<double> unit = MillimetersPer(request.length_unit());
  if (!unit) {
    FieldErrors errors;
    errors.Add("length_unit", UnitFault(request.length_unit()));
    return errors.ToStatus();
  }
  PM_RETURN_IF_ERROR(CheckNetworkLimits(request.network()));
  PM_RETURN_IF_ERROR(CheckTogether(request));
  response->set_farthest_vertex(-1);
  return RunQuickCall(
      call, {.max_threads = request.max_threads()}, [&](const RunContext& run) -> absl::Status {
        if (request.has_crossing()) return BuildCrossing(request, *unit, run, response);
        if (request.has_mesh()) return BuildMesh(request.mesh(), *unit, run, response);
        if (request.outline_case() == v1::BuildModelRequest::OUTLINE_NOT_SET && request.has_network()) {
          return BuildNetworkAlone(request, *unit, run, response);
        }
        PatchModel model;
        PM_ASSIGN_OR_RETURN(PatchShape shape, OutlineSurface(request, *unit));
        model.patches.push_back({"outline", std::move(shape)});
        if (const Diagnostics faults = ValidateModel(model); !faults.empty()) {
          AddDiagnostics(faults, Vec3::Zero(), response->mutable_diagnostics());
          return absl::OkStatus();
        }
        PM_RETURN_IF_ERROR(run.Check());
        if (request.has_division() || request.has_surface()) {
          return Divide(request, model.patches[0].shape, run, response);
        }
        *response->mutable_model() = ToProto(model);
        return request.has_network() ? TakeNormals(request, *unit, std::move(model), run, response)
                                     : absl::OkStatus();
      });
}

}  // namespace patchmill
