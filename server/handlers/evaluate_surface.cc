#include <utility>

#include <fmt/format.h>

#include "cam/plan/plan.h"
#include "cam/plan/resolve.h"
#include "core/base/status.h"
#include "core/diffgeo/principal_directions.h"
#include "server/convert/fields.h"
#include "server/convert/setup.h"
#include "server/handlers/handlers.h"
#include "server/handlers/prepare.h"
#include "server/limits.h"
#include "server/placed_surface.h"

namespace patchmill {
namespace {

void Add(std::initializer_list<double> values, google::protobuf::RepeatedField<double>* to) {
  for (const double x : values) to->Add(x);
}

void Add(const Vec3& v, google::protobuf::RepeatedField<double>* to) { Add({v.x(), v.y(), v.z()}, to); }

void AddPoint(const SurfaceJet& jet, const Vec3& zero, v1::EvaluateSurfaceResponse* response) {
  Add(jet.p - zero, response->mutable_points_mm());
  Add(jet.du, response->mutable_du_mm());
  Add(jet.dv, response->mutable_dv_mm());
  const auto normal = UnitNormal(jet);
  FundamentalForms forms;
  PrincipalCurvatures principal;
  PrincipalDirections directions;
  double determinant = 0.0, contour = 0.0;
  if (normal) {
    forms = Forms(jet, *normal);
    principal = Principal(forms);
    directions = DirectionsOf(jet, forms).value_or(PrincipalDirections());
    // D and kappa_c are those of the normal that points up.
    const double up = normal->z() < 0.0 ? -1.0 : 1.0;
    determinant = up * ContourDeterminant(jet, forms);
    contour = up * ContourCurvature(jet, forms);
  }
  Add(normal.value_or(Vec3::Zero()), response->mutable_normals());
  Add({forms.E, forms.F, forms.G}, response->mutable_first_form_mm2());
  Add({forms.L, forms.M, forms.N}, response->mutable_second_form_mm());
  Add({principal.k_min, principal.k_max}, response->mutable_principal_curvatures_per_mm());
  Add(directions.min, response->mutable_principal_directions());
  Add(directions.max, response->mutable_principal_directions());
  Add({contour}, response->mutable_contour_curvatures_per_mm());
  Add({determinant}, response->mutable_contour_determinants_mm3());
}

// Checks index and parameters of every point against the model.
absl::Status CheckPoints(const v1::EvaluateSurfaceRequest& request, const PatchModel& model) {
  FieldErrors errors;
  for (int k = 0; k < request.patch_index_size(); ++k) {
    const int index = request.patch_index(k);
    if (index < 0 || index >= static_cast<int>(model.patches.size())) {
      errors.Add(fmt::format("patch_index[{}]", k),
                 fmt::format("= {}; must be in [0, {}]", index, model.patches.size() - 1));
      continue;
    }
    const bool triangle = IsTriangle(model.patches[static_cast<std::size_t>(index)].shape);
    const Vec2 uv(request.uv(2 * k), request.uv(2 * k + 1));
    if (uv.minCoeff() >= 0.0 && (triangle ? uv.sum() : uv.maxCoeff()) <= 1.0) continue;
    errors.Add(fmt::format("uv[{}]", 2 * k),
               fmt::format("and the next = ({:g}, {:g}); must be {}", uv.x(), uv.y(),
                           triangle ? ">= 0 with a sum <= 1" : "in [0, 1] x [0, 1]"));
  }
  return errors.ToStatus();
}

}  // namespace

absl::Status HandleEvaluateSurface(const Call& call, const v1::EvaluateSurfaceRequest& request,
                                   v1::EvaluateSurfaceResponse* response) {
  PM_RETURN_IF_ERROR(RefuseUnknownFields(request));
  PM_RETURN_IF_ERROR(CheckThreads(request.max_threads(), "max_threads"));
  FieldErrors errors;
  Job job;
  job.setup = FromProto(request.setup(), "setup", errors);
  const int count = request.patch_index_size();
  if (count == 0) errors.Missing("patch_index");
  if (count > limits::kMaxEvaluations) {
    errors.Add("patch_index",
               fmt::format("has {} elements; must have at most {}", count, limits::kMaxEvaluations));
  }
  if (request.uv_size() != 2 * count) {
    errors.Add("uv",
               fmt::format("has {} numbers; must have two for each of {} points", request.uv_size(), count));
  }
  PM_RETURN_IF_ERROR(errors.ToStatus());
  return RunQuickCall(
      call, {.max_threads = request.max_threads()}, [&](const RunContext& run) -> absl::Status {
        PM_ASSIGN_OR_RETURN(LoadedModel model, LoadModel(request.source(), "source", run, ModelsOf(call)));
        PM_RETURN_IF_ERROR(RequireSound(model));
        PM_RETURN_IF_ERROR(CheckPoints(request, model.model));
        PM_ASSIGN_OR_RETURN(UprightModel upright, MakeUpright(std::move(model), job.setup, run));
        job.setup = std::move(upright.setup);
        PM_ASSIGN_OR_RETURN(const std::shared_ptr<const Surface> built,
                            PlacedSurface(std::move(upright.model.model), upright.model.digest, job.setup,
                                          run, ModelsOf(call)));
        const Surface& surface = *built;
        PM_ASSIGN_OR_RETURN(const Resolved resolved, Resolve(surface, job, run));
        for (int k = 0; k < count; ++k) {
          const PatchId patch(request.patch_index(k));
          AddPoint(Evaluate(surface, patch, request.uv(2 * k), request.uv(2 * k + 1)), resolved.program_zero,
                   response);
        }
        return run.Check();
      });
}

}  // namespace patchmill
