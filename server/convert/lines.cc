#include "server/convert/lines.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "server/convert/fields.h"
#include "server/convert/setup.h"
#include "server/limits.h"

namespace patchmill {
namespace {

// The unit vector along a direction.
Vec3 ReadDirection(const v1::Point3& proto, const std::string& field, FieldErrors& errors) {
  const Vec3 d = FromProto(proto);
  if (!d.allFinite() || !(d.norm() > 0.0) || !std::isfinite(d.norm())) {
    errors.Add(field,
               fmt::format("= ({:g}, {:g}, {:g}); must be finite and longer than 0", d.x(), d.y(), d.z()));
    return Vec3::UnitZ();
  }
  return d.normalized();
}

Vec3 ReadAcross(const v1::LineFamily& proto, const Vec3& direction, const std::string& field,
                FieldErrors& errors) {
  constexpr double kAlong = 1e-6;
  Vec3 across = proto.has_across() ? ReadDirection(proto.across(), field, errors) : Vec3(Vec3::UnitX());
  Vec3 beside = across - across.dot(direction) * direction;
  if (beside.norm() < kAlong && !proto.has_across()) {
    across = Vec3::UnitY();
    beside = across - across.dot(direction) * direction;
  }
  if (beside.norm() < kAlong) {
    errors.Add(field, "runs along the direction; must run across it");
    return Vec3::UnitX();
  }
  return beside.normalized();
}

// The level in the unit of the domain. Errors state the range on the wire.
double ReadLevel(v1::LineKind kind, double level, const std::string& field, FieldErrors& errors) {
  constexpr double kMost = limits::kMaxCoordinateMm;
  switch (kind) {
    case v1::LINE_KIND_CONTOUR:
      Require(errors, field, level, std::abs(level) <= kMost, fmt::format("in [{}, {}]", -kMost, kMost));
      return level;
    case v1::LINE_KIND_EQUI_SLOPE:
      Require(errors, field, level, level > 0.0 && level < 90.0, "in (0, 90)");
      return Radians(level);
    case v1::LINE_KIND_BRIGHTNESS:
      Require(errors, field, level, level > -1.0 && level < 1.0, "in (-1, 1)");
      return level;
    case v1::LINE_KIND_HIGHLIGHT:
      Require(errors, field, level, level >= 0.0 && level < 360.0, "in [0, 360)");
      return Radians(level);
    default:
      errors.Add(field, "is set; must be empty, because lines of this kind have no levels");
      return 0.0;
  }
}

}  // namespace

LineOrder FromProto(const v1::LineFamily& proto, const std::string& at, FieldErrors& errors) {
  LineOrder order;
  order.kind = proto.kind();
  const Vec3 direction = proto.has_direction() ? ReadDirection(proto.direction(), At(at, "direction"), errors)
                                               : Vec3(Vec3::UnitZ());
  switch (proto.kind()) {
    case v1::LINE_KIND_UNSPECIFIED:
      errors.Missing(At(at, "kind"));
      return order;
    case v1::LINE_KIND_CONTOUR:
      order.family = ContourLines{direction};
      break;
    case v1::LINE_KIND_EQUI_SLOPE:
      order.family = EquiSlopeLines{direction};
      break;
    case v1::LINE_KIND_BRIGHTNESS:
      order.family = BrightnessLines{direction};
      break;
    case v1::LINE_KIND_SILHOUETTE:
      order.family = SilhouetteLines{direction};
      break;
    case v1::LINE_KIND_EYE_SILHOUETTE: {
      if (!proto.has_eye()) errors.Missing(At(at, "eye"));
      const Vec3 eye = FromProto(proto.eye());
      Require(errors, At(at, "eye"), eye.norm(), eye.allFinite() && eye.norm() <= limits::kMaxCoordinateMm,
              fmt::format("finite and within {} mm", limits::kMaxCoordinateMm));
      order.family = EyeSilhouetteLines{eye};
      break;
    }
    case v1::LINE_KIND_HIGHLIGHT:
      order.family = HighlightLines{direction, ReadAcross(proto, direction, At(at, "across"), errors)};
      break;
    case v1::LINE_KIND_CONTOUR_INFLECTION:
      order.family = ContourInflectionLines{direction};
      break;
    case v1::LINE_KIND_SLOPE_EXTREMUM:
      order.family = SlopeExtremumLines{direction};
      break;
    case v1::LINE_KIND_FLOW:
    case v1::LINE_KIND_SLOPE_FLOW:
    case v1::LINE_KIND_CURVATURE: {
      FlowParams flow;
      flow.kind = proto.kind() == v1::LINE_KIND_FLOW        ? FlowKind::kAlongHeight
                  : proto.kind() == v1::LINE_KIND_CURVATURE ? FlowKind::kAlongCurvature
                                                            : FlowKind::kAlongSlope;
      flow.axis = direction;
      flow.spacing = proto.spacing_mm();
      if (proto.has_spacing_mm()) {
        Require(errors, At(at, "spacing_mm"), flow.spacing, flow.spacing > 0.0 && flow.spacing <= 1000.0,
                "in (0, 1000]");
      }
      order.flow = flow;
      break;
    }
    case v1::LINE_KIND_INTERSECTION:
      order.crossings = true;
      break;
    default:
      errors.Add(At(at, "kind"),
                 fmt::format("= {} is not known to this version", static_cast<int>(proto.kind())));
      return order;
  }
  if (proto.levels_size() > limits::kMaxLineLevels) {
    errors.Add(At(at, "levels"), fmt::format("has {} elements; must have at most {}", proto.levels_size(),
                                             limits::kMaxLineLevels));
    return order;
  }
  for (int k = 0; k < proto.levels_size(); ++k) {
    order.levels.push_back(
        ReadLevel(proto.kind(), proto.levels(k), fmt::format("{}[{}]", At(at, "levels"), k), errors));
  }
  order.from_normals = proto.from_normals();
  order.has_direction = proto.has_direction();
  if (order.from_normals && order.kind != v1::LINE_KIND_HIGHLIGHT && order.kind != v1::LINE_KIND_BRIGHTNESS) {
    errors.Add(At(at, "from_normals"),
               "is set; only HIGHLIGHT and BRIGHTNESS can be chosen from the normals");
  }
  if (order.from_normals && proto.has_across() && !proto.has_direction()) {
    errors.Add(At(at, "across"), "is set, but no direction that it runs across; set both or none");
  }
  if (proto.has_count()) {
    order.count = proto.count();
    if (order.count < 1 || order.count > limits::kMaxLineLevels) {
      errors.Add(At(at, "count"),
                 fmt::format("= {}; must be in [1, {}]", order.count, limits::kMaxLineLevels));
    }
  }
  return order;
}

bool HasLevels(const LineOrder& order) { return !order.flow && !order.crossings && HasLevels(order.family); }

LineOrder Chosen(LineOrder order, const OccurringNormals& normals) {
  if (!order.from_normals) return order;
  if (!order.has_direction && std::holds_alternative<HighlightLines>(order.family)) {
    order.family = ChooseHighlights(normals);
  } else if (!order.has_direction) {
    order.family = ChooseBrightness(normals);
  }
  if (order.levels.empty()) {
    order.levels = LevelsOfNormals(normals, order.family, order.count);
    order.count = static_cast<int>(order.levels.size());
  }
  return order;
}

bool NeedsNormals(const std::vector<LineOrder>& orders) {
  return std::any_of(orders.begin(), orders.end(), [](const LineOrder& order) { return order.from_normals; });
}

void AddChosen(const LineOrder& chosen, v1::LineSet& set) {
  if (!chosen.from_normals) return;
  if (const auto* highlights = std::get_if<HighlightLines>(&chosen.family)) {
    *set.mutable_direction() = ToProto(highlights->plane);
    *set.mutable_across() = ToProto(highlights->across);
  } else if (const auto* brightness = std::get_if<BrightnessLines>(&chosen.family)) {
    *set.mutable_direction() = ToProto(brightness->light);
  }
}

LineOrder Placed(LineOrder order, const Vec3& zero) {
  if (auto* eye = std::get_if<EyeSilhouetteLines>(&order.family)) eye->eye += zero;
  if (const auto* contour = std::get_if<ContourLines>(&order.family)) {
    for (double& level : order.levels) level += contour->axis.dot(zero);
  }
  return order;
}

double WireLevel(const LineOrder& placed, double level, const Vec3& zero) {
  if (const auto* contour = std::get_if<ContourLines>(&placed.family)) return level - contour->axis.dot(zero);
  const bool angle = placed.kind == v1::LINE_KIND_EQUI_SLOPE || placed.kind == v1::LINE_KIND_HIGHLIGHT;
  return angle ? Degrees(level) : level;
}

std::string Describe(v1::LineKind kind, double wire_level) {
  switch (kind) {
    case v1::LINE_KIND_CONTOUR:
      return fmt::format("contour {:.6g} mm", wire_level);
    case v1::LINE_KIND_EQUI_SLOPE:
      return fmt::format("slope {:.6g} degrees", wire_level);
    case v1::LINE_KIND_BRIGHTNESS:
      return fmt::format("brightness {:.4g}", wire_level);
    case v1::LINE_KIND_SILHOUETTE:
      return "silhouette";
    case v1::LINE_KIND_EYE_SILHOUETTE:
      return "silhouette from the eye";
    case v1::LINE_KIND_HIGHLIGHT:
      return fmt::format("highlight {:.6g} degrees", wire_level);
    case v1::LINE_KIND_CONTOUR_INFLECTION:
      return "contour inflections";
    case v1::LINE_KIND_SLOPE_EXTREMUM:
      return "slope extrema";
    case v1::LINE_KIND_FLOW:
      return "flow";
    case v1::LINE_KIND_SLOPE_FLOW:
      return "flow of slopes";
    case v1::LINE_KIND_INTERSECTION:
      return "intersections";
    case v1::LINE_KIND_CURVATURE:
      return "lines of curvature";
    default:
      return "";
  }
}

v1::SurfaceLine ToProto(const Surface& surface, const ZeroCurve& curve, const Vec3& zero) {
  v1::SurfaceLine line;
  line.set_closed(curve.closed);
  for (const SurfacePoint& point : curve.points) {
    const Piece& piece = surface.piece(point.piece);
    const Vec3 p = point.p - zero;
    for (const double x : {p.x(), p.y(), p.z()}) line.add_points_mm(x);
    line.add_patch_index(piece.patch.value);
    const Vec2 uv = NativeParameters(piece, point.u, point.v);
    line.add_uv(uv.x());
    line.add_uv(uv.y());
  }
  return line;
}

double LengthOf(const ZeroCurve& curve) {
  double length = 0.0;
  const std::size_t n = curve.points.size();
  for (std::size_t i = 0; i + (curve.closed ? 0 : 1) < n; ++i) {
    length += (curve.points[(i + 1) % n].p - curve.points[i].p).norm();
  }
  return length;
}

}  // namespace patchmill
