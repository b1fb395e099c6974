#include "server/convert/first_surface.h"

#include <fmt/format.h>

#include "core/base/error_details.h"
#include "core/base/status.h"
#include "core/patch/outline_surface.h"
#include "server/convert/fields.h"
#include "server/limits.h"

namespace patchmill {
namespace {

using Curves = google::protobuf::RepeatedPtrField<v1::OutlineCurve>;

absl::Status CheckLimits(const Curves& curves) {
  std::size_t points = 0, knots = 0;
  for (const v1::OutlineCurve& curve : curves) {
    points += static_cast<std::size_t>(curve.bezier().points_size() + curve.bspline().points_size()) / 3;
    knots += static_cast<std::size_t>(curve.bspline().knots_size());
  }
  if (points > limits::kMaxControlPoints) {
    return LimitError("outline.point_count", limits::kMaxControlPoints, static_cast<double>(points));
  }
  if (knots > limits::kMaxKnots)
    return LimitError("outline.knot_count", limits::kMaxKnots, static_cast<double>(knots));
  return absl::OkStatus();
}

std::vector<Vec3> Points(const google::protobuf::RepeatedField<double>& numbers, double unit,
                         const std::string& field, FieldErrors& errors) {
  if (numbers.size() % 3 != 0 || numbers.size() < 6) {
    errors.Add(field,
               fmt::format("has {} numbers; must be packed x y z of 2 points or more", numbers.size()));
    return {};
  }
  std::vector<Vec3> points(static_cast<std::size_t>(numbers.size() / 3));
  for (int i = 0; i < numbers.size(); ++i) points[static_cast<std::size_t>(i / 3)][i % 3] = unit * numbers[i];
  return points;
}

absl::StatusOr<std::vector<Curve>> CurvesOf(const Curves& curves, double unit, const std::string& at) {
  PM_RETURN_IF_ERROR(CheckLimits(curves));
  FieldErrors errors;
  std::vector<Curve> list;
  for (int k = 0; k < curves.size(); ++k) {
    const std::string field = fmt::format("{}.curves[{}]", at, k);
    switch (curves[k].curve_case()) {
      case v1::OutlineCurve::kBezier:
        list.push_back(
            BezierCurve{Points(curves[k].bezier().points(), unit, field + ".bezier.points", errors)});
        break;
      case v1::OutlineCurve::kBspline: {
        const v1::BsplineCurve& from = curves[k].bspline();
        list.push_back(BsplineCurve{from.degree(),
                                    {from.knots().begin(), from.knots().end()},
                                    Points(from.points(), unit, field + ".bspline.points", errors)});
        break;
      }
      case v1::OutlineCurve::CURVE_NOT_SET:
        errors.Missing(field);
    }
  }
  PM_RETURN_IF_ERROR(errors.ToStatus());
  return list;
}

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

}  // namespace

absl::StatusOr<PatchShape> OutlineSurface(const v1::BuildModelRequest& request, double unit) {
  switch (request.outline_case()) {
    case v1::BuildModelRequest::kSections: {
      PM_ASSIGN_OR_RETURN(const std::vector<Curve> sections,
                          CurvesOf(request.sections().curves(), unit, "sections"));
      return Made(SkinSurface(sections), "sections.");
    }
    case v1::BuildModelRequest::kBoundary:
      return Between(request.boundary(), unit);
    case v1::BuildModelRequest::OUTLINE_NOT_SET:
      break;
  }
  FieldErrors errors;
  errors.Missing("outline");
  return errors.ToStatus();
}

}  // namespace patchmill
