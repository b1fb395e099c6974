#include "server/convert/outline_curves.h"

#include <fmt/format.h>

#include "core/base/status.h"
#include "core/io/strokes.h"
#include "server/convert/curve_in_file.h"
#include "server/convert/fields.h"
#include "server/limits.h"

namespace patchmill {
namespace {

using Curves = google::protobuf::RepeatedPtrField<v1::OutlineCurve>;

absl::Status CheckCurveLimits(const Curves& curves) {
  std::size_t points = 0, knots = 0;
  for (const v1::OutlineCurve& curve : curves) {
    points += static_cast<std::size_t>(curve.bezier().points_size() + curve.bspline().points_size() +
                                       curve.points().points_size()) /
              3;
    // A line of a file has a point of at least four bytes.
    points += curve.file().content().size() / 4;
    knots += static_cast<std::size_t>(curve.bspline().knots_size());
  }
  if (points > limits::kMaxControlPoints) {
    return LimitError("outline.point_count", limits::kMaxControlPoints, static_cast<double>(points));
  }
  if (knots > limits::kMaxKnots)
    return LimitError("outline.knot_count", limits::kMaxKnots, static_cast<double>(knots));
  return absl::OkStatus();
}

std::vector<Vec3> OutlinePoints(const google::protobuf::RepeatedField<double>& numbers, double unit,
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

}  // namespace

absl::StatusOr<std::vector<Curve>> CurvesOf(const Curves& curves, double unit, const std::string& at) {
  PM_RETURN_IF_ERROR(CheckCurveLimits(curves));
  FieldErrors errors;
  std::vector<Curve> list;
  for (int k = 0; k < curves.size(); ++k) {
    const std::string field = fmt::format("{}.curves[{}]", at, k);
    switch (curves[k].curve_case()) {
      case v1::OutlineCurve::kBezier:
        list.push_back(
            BezierCurve{OutlinePoints(curves[k].bezier().points(), unit, field + ".bezier.points", errors)});
        break;
      case v1::OutlineCurve::kBspline: {
        const v1::BsplineCurve& from = curves[k].bspline();
        list.push_back(BsplineCurve{from.degree(),
                                    {from.knots().begin(), from.knots().end()},
                                    OutlinePoints(from.points(), unit, field + ".bspline.points", errors)});
        break;
      }
      case v1::OutlineCurve::kPoints: {
        const absl::StatusOr<BezierChain> chain =
            ChainThrough(OutlinePoints(curves[k].points().points(), unit, field + ".points.points", errors));
        if (chain.ok()) {
          list.push_back(AsBspline(*chain));
        } else if (curves[k].points().points_size() >= 6) {
          errors.Add(field + ".points", std::string(chain.status().message()));
        }
        break;
      }
      case v1::OutlineCurve::kFile: {
        const absl::StatusOr<BezierChain> chain = CurveIn(curves[k].file(), unit);
        if (chain.ok()) {
          list.push_back(AsBspline(*chain));
        } else {
          errors.Add(field + ".file", std::string(chain.status().message()));
        }
        break;
      }
      case v1::OutlineCurve::CURVE_NOT_SET:
        errors.Missing(field);
    }
  }
  PM_RETURN_IF_ERROR(errors.ToStatus());
  return list;
}

absl::StatusOr<DrawnCurves> DrawnCurvesOf(const v1::CrossingCurves& crossing, double unit) {
  PM_ASSIGN_OR_RETURN(const std::vector<Curve> curves, CurvesOf(crossing.curves(), unit, "crossing"));
  FieldErrors errors;
  DrawnCurves drawn;
  std::vector<DrawnCurve>& list = drawn.curves;
  for (std::size_t k = 0; k < curves.size(); ++k) {
    const std::string& id = crossing.curves(static_cast<int>(k)).id();
    RequireBytes(errors, fmt::format("crossing.curves[{}].id", k), id, limits::kMaxIdBytes);
    absl::StatusOr<BezierChain> chain = ChainOf(curves[k]);
    if (!chain.ok()) {
      errors.Add(fmt::format("crossing.curves[{}]", k),
                 fmt::format("is none: {}", std::string(chain.status().message())));
      continue;
    }
    for (const Vec3& p : chain->points) {
      if (p.allFinite() && p.cwiseAbs().maxCoeff() <= limits::kMaxCoordinateMm) continue;
      errors.Add(
          fmt::format("crossing.curves[{}]", k),
          fmt::format("has a point beyond {:g} mm or one that is not finite", limits::kMaxCoordinateMm));
      break;
    }
    list.push_back({id, *std::move(chain)});
  }
  if (!crossing.strokes().empty()) {
    const auto strokes = ReadStrokes(crossing.strokes());
    if (!strokes.ok()) {
      errors.Add("crossing.strokes",
                 fmt::format("cannot be read: {}", std::string(strokes.status().message())));
      return errors.ToStatus();
    }
    for (std::size_t k = 0; k < strokes->size(); ++k) {
      std::vector<Vec3> points = (*strokes)[k];
      for (Vec3& p : points) p *= unit;
      absl::StatusOr<BezierChain> chain = ChainThrough(points);
      if (chain.ok()) {
        list.push_back({fmt::format("stroke {}", k + 1), *std::move(chain)});
      } else {
        Where where;
        where.point = points.front();
        where.field = fmt::format("crossing.strokes[{}]", k);
        drawn.findings.push_back(MakeWarning(
            "STROKE_OF_ONE_POINT",
            fmt::format("stroke {} {}; it is left out", k + 1, std::string(chain.status().message())),
            std::move(where)));
      }
    }
  }
  PM_RETURN_IF_ERROR(errors.ToStatus());
  if (list.empty() && !drawn.findings.empty()) {
    errors.Add("crossing.strokes", fmt::format("have one point each: {} of them", drawn.findings.size()));
    return errors.ToStatus();
  }
  if (list.empty() || list.size() > kMaxDrawnCurves) {
    errors.Add("crossing.curves", fmt::format("are {}; must be 1 to {}", list.size(), kMaxDrawnCurves));
  }
  PM_RETURN_IF_ERROR(errors.ToStatus());
  return drawn;
}

}  // namespace patchmill
