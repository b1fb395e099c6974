#include "server/convert/first_surface.h"

#include <algorithm>

#include <fmt/format.h>

#include "core/base/error_details.h"
#include "core/base/status.h"
#include "core/curve/mean_breaks.h"
#include "core/patch/outline_surface.h"
#include "server/convert/curve_in_file.h"
#include "server/convert/fields.h"
#include "server/convert/outline_curves.h"
#include "server/convert/patches.h"
#include "server/limits.h"

namespace patchmill {
namespace {

// `at` is the path of the curves in the request.
template <class Shape>
absl::StatusOr<PatchShape> Made(absl::StatusOr<Shape> shape, std::string_view at) {
  if (!shape.ok()) return WithFieldPrefix(at, shape.status());
  return *std::move(shape);
}

absl::StatusOr<PatchShape> Between(const v1::BoundaryCurves& boundary, double unit) {
  FieldErrors errors;
  if (boundary.curves_size() != 4) {
    errors.Add("boundary.curves", fmt::format("are {}; must be 4", boundary.curves_size()));
  }
  if (!v1::BoundarySpan_IsValid(boundary.span())) {
    errors.Add("boundary.span",
               fmt::format("= {}; this server does not know that value", static_cast<int>(boundary.span())));
  }
  PM_RETURN_IF_ERROR(errors.ToStatus());
  PM_ASSIGN_OR_RETURN(std::vector<Curve> curves, CurvesOf(boundary.curves(), unit, "boundary"));
  const BoundaryCurves outline = {curves[0], curves[1], curves[2], curves[3]};
  if (boundary.span() == v1::BOUNDARY_SPAN_HOSAKA) return Made(HosakaSurface(outline), "boundary.");
  return Made(CoonsSurface(outline), "boundary.");
}

// Sections of measured points share their knots where they can.
absl::StatusOr<std::vector<Curve>> SectionsOf(const v1::SectionCurves& from, double unit) {
  PM_ASSIGN_OR_RETURN(std::vector<Curve> curves, CurvesOf(from.curves(), unit, "sections"));
  const auto measured = [](const v1::OutlineCurve& c) { return c.has_points() || c.has_file(); };
  const bool wish =
      from.has_common_knots() ? from.common_knots() : std::ranges::all_of(from.curves(), measured);
  if (!wish) return curves;
  std::vector<BezierChain> chains;
  for (const Curve& curve : curves) {
    absl::StatusOr<BezierChain> chain = ChainOf(curve);
    if (!chain.ok()) return curves;  // SkinSurface names it
    chains.push_back(*std::move(chain));
  }
  const absl::StatusOr<std::vector<BezierChain>> common = WithMeanBreaks(chains);
  if (!common.ok()) {
    if (!from.has_common_knots()) return curves;
    return FieldError("sections.common_knots",
                      fmt::format("is true, and {}; give each section as many points",
                                  std::string(common.status().message())));
  }
  for (std::size_t k = 0; k < curves.size(); ++k) curves[k] = AsBspline((*common)[k]);
  return curves;
}

absl::StatusOr<PatchShape> FromSurface(const v1::BsplinePatch& surface, double unit) {
  const std::size_t knots = static_cast<std::size_t>(surface.knots_u_size() + surface.knots_v_size());
  const std::size_t points = static_cast<std::size_t>(surface.points_size()) / 3;
  if (points > limits::kMaxControlPoints) {
    return LimitError("surface.point_count", limits::kMaxControlPoints, static_cast<double>(points));
  }
  if (knots > limits::kMaxKnots) {
    return LimitError("surface.knot_count", limits::kMaxKnots, static_cast<double>(knots));
  }
  v1::Patch patch;
  *patch.mutable_bspline() = surface;
  Diagnostics faults;
  Patch made = FromProto(patch, unit, 0, faults);
  if (faults.empty()) return std::move(made.shape);
  FieldErrors errors;
  errors.Add("surface", faults.front().message);
  return errors.ToStatus();
}

}  // namespace

absl::StatusOr<PatchShape> OutlineSurface(const v1::BuildModelRequest& request, double unit) {
  switch (request.outline_case()) {
    case v1::BuildModelRequest::kSections: {
      PM_ASSIGN_OR_RETURN(const std::vector<Curve> sections, SectionsOf(request.sections(), unit));
      return Made(SkinSurface(sections), "sections.");
    }
    case v1::BuildModelRequest::kBoundary:
      return Between(request.boundary(), unit);
    case v1::BuildModelRequest::kSurface:
      return FromSurface(request.surface(), unit);
    default:
      break;
  }
  FieldErrors errors;
  errors.Missing("outline");
  return errors.ToStatus();
}

}  // namespace patchmill
