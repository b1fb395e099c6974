#include "server/convert/model.h"

#include <algorithm>
#include <set>

#include "core/base/status.h"
#include "core/joining/join_network.h"
#include "core/joining/network_findings.h"
#include "server/convert/fields.h"
#include "server/convert/network.h"
#include "server/limits.h"

namespace patchmill {
namespace {

using Numbers = google::protobuf::RepeatedField<double>;

std::size_t Count(const Numbers& numbers) { return static_cast<std::size_t>(numbers.size()); }

struct Sizes {
  std::size_t points = 0, knots = 0;
};

// Few breaks cut a patch into many pieces, so it counts with the points of these.
std::size_t HosakaPoints(const v1::HosakaPatch& patch) {
  std::size_t columns = 1, rows = 1;
  for (const v1::HosakaBreak& b : patch.breaks()) ++(b.side() % 2 == 0 ? columns : rows);
  const auto across = static_cast<std::size_t>(std::clamp(patch.degree() + 4, 7, kMaxDegree + 1));
  return std::max(Count(patch.points()) / 3, columns * rows * across * across);
}

// So do those of a Brown quad.
std::size_t BrownPoints(const v1::BrownPatch& patch) {
  const std::size_t pieces = (Count(patch.breaks_u()) + 1) * (Count(patch.breaks_v()) + 1);
  if (pieces == 1) return Count(patch.points()) / 3;
  const auto across = [](int degree) {
    return static_cast<std::size_t>(std::clamp(degree, 3, kMaxBrownDegree) + 5);
  };
  return std::max(Count(patch.points()) / 3, pieces * across(patch.degree_u()) * across(patch.degree_v()));
}

Sizes SizesOf(const v1::Patch& patch) {
  switch (patch.shape_case()) {
    case v1::Patch::kBezier:
      return {Count(patch.bezier().points()) / 3, 0};
    case v1::Patch::kBspline:
      return {Count(patch.bspline().points()) / 3,
              Count(patch.bspline().knots_u()) + Count(patch.bspline().knots_v())};
    case v1::Patch::kGregory:
      return {Count(patch.gregory().points()) / 3, 0};
    case v1::Patch::kTriangle:
      return {Count(patch.triangle().points()) / 3, 0};
    case v1::Patch::kBrown:
      return {BrownPoints(patch.brown()), Count(patch.brown().breaks_u()) + Count(patch.brown().breaks_v())};
    case v1::Patch::kGregoryTriangle:
      return {Count(patch.gregory_triangle().points()) / 3, 0};
    case v1::Patch::kLoftTriangle:
      return {Count(patch.loft_triangle().points()) / 3, 0};
    case v1::Patch::kG2Gregory:
      return {Count(patch.g2_gregory().points()) / 3, 0};
    case v1::Patch::kHosaka:
      return {HosakaPoints(patch.hosaka()), static_cast<std::size_t>(patch.hosaka().breaks_size())};
    case v1::Patch::SHAPE_NOT_SET:
      break;
  }
  return {};
}

absl::Status CheckLimits(const v1::PatchModel& proto) {
  const auto patches = static_cast<std::size_t>(proto.patches_size());
  if (patches > limits::kMaxPatches) {
    return LimitError("model.patch_count", limits::kMaxPatches, static_cast<double>(patches));
  }
  PM_RETURN_IF_ERROR(CheckNetworkLimits(proto.network()));
  Sizes all;
  for (const v1::Patch& patch : proto.patches()) {
    const Sizes sizes = SizesOf(patch);
    all.points += sizes.points;
    all.knots += sizes.knots;
  }
  if (all.points > limits::kMaxControlPoints) {
    return LimitError("model.control_point_count", limits::kMaxControlPoints,
                      static_cast<double>(all.points));
  }
  if (all.knots > limits::kMaxKnots) {
    return LimitError("model.knot_count", limits::kMaxKnots, static_cast<double>(all.knots));
  }
  return absl::OkStatus();
}

// Converts one patch; what only the wire can get wrong is a fault here, the rest is ValidateModel's.
class PatchReader {
 public:
  PatchReader(double unit, int index, Diagnostics& faults) : unit_(unit), index_(index), faults_(faults) {}

  Patch Read(const v1::Patch& proto) {
    Patch patch;
    patch.id = id_ = proto.id();
    if (proto.id().size() > limits::kMaxIdBytes) {
      Fault("INVALID_ID", "id",
            fmt::format("has {} bytes; must have at most {}", proto.id().size(), limits::kMaxIdBytes));
    }
    switch (proto.shape_case()) {
      case v1::Patch::kBezier: {
        const v1::BezierPatch& from = proto.bezier();
        patch.shape = BezierPatch{from.degree_u(),
                                  from.degree_v(),
                                  Points("bezier.points", from.points()),
                                  {from.weights().begin(), from.weights().end()}};
        break;
      }
      case v1::Patch::kBspline: {
        const v1::BsplinePatch& from = proto.bspline();
        patch.shape = BsplinePatch{from.degree_u(),
                                   from.degree_v(),
                                   {from.knots_u().begin(), from.knots_u().end()},
                                   {from.knots_v().begin(), from.knots_v().end()},
                                   Points("bspline.points", from.points()),
                                   {from.weights().begin(), from.weights().end()}};
        break;
      }
      case v1::Patch::kGregory:
        patch.shape = Gregory<GregoryPatch>("gregory", proto.gregory());
        break;
      case v1::Patch::kGregoryTriangle:
        patch.shape = Gregory<GregoryTriangle>("gregory_triangle", proto.gregory_triangle());
        break;
      case v1::Patch::kBrown: {
        const v1::BrownPatch& from = proto.brown();
        patch.shape = BrownPatch{from.degree_u(),
                                 from.degree_v(),
                                 Points("brown.points", from.points()),
                                 {from.breaks_u().begin(), from.breaks_u().end()},
                                 {from.breaks_v().begin(), from.breaks_v().end()}};
        break;
      }
      case v1::Patch::kLoftTriangle: {
        const v1::LoftTriangle& from = proto.loft_triangle();
        patch.shape =
            LoftTriangle{from.degree(), from.squared(), Points("loft_triangle.points", from.points())};
        break;
      }
      case v1::Patch::kG2Gregory: {
        const v1::G2GregoryPatch& from = proto.g2_gregory();
        patch.shape = G2GregoryPatch{from.degree(), Points("g2_gregory.points", from.points())};
        break;
      }
      case v1::Patch::kHosaka:
        patch.shape = Hosaka(proto.hosaka());
        break;
      case v1::Patch::kTriangle: {
        const v1::BezierTriangle& from = proto.triangle();
        patch.shape = BezierTriangle{from.degree(),
                                     Points("triangle.points", from.points()),
                                     {from.weights().begin(), from.weights().end()}};
        break;
      }
      case v1::Patch::SHAPE_NOT_SET:
        Fault(
            "NO_SHAPE", "shape",
            "is missing; one of bezier, bspline, gregory, triangle, brown, gregory_triangle, loft_triangle, "
            "g2_gregory, hosaka is required");
        break;
    }
    return patch;
  }

 private:
  void Fault(std::string_view code, std::string_view field, std::string_view text) {
    Diagnostic fault;
    fault.code = code;
    fault.severity = Severity::kError;
    fault.where.patch_id = id_;
    fault.where.patch_index = index_;
    fault.where.field = fmt::format("patches[{}].{}", index_, field);
    fault.message = fmt::format("{} {}", fault.where.field, text);
    faults_.push_back(std::move(fault));
  }

  std::vector<Vec3> Points(std::string_view field, const Numbers& numbers) {
    if (numbers.size() % 3 != 0) {
      Fault("POINT_COUNT", field, fmt::format("has {} numbers; must be packed x y z", numbers.size()));
    }
    std::vector<Vec3> points(Count(numbers) / 3);
    for (std::size_t i = 0; i < points.size(); ++i) {
      const int k = static_cast<int>(3 * i);
      points[i] = unit_ * Vec3(numbers[k], numbers[k + 1], numbers[k + 2]);
    }
    return points;
  }

  template <class To, class From>
  To Gregory(std::string_view kind, const From& from) {
    To to;
    const std::string field = fmt::format("{}.points", kind);
    const std::vector<Vec3> points = Points(field, from.points());
    if (points.size() == to.points.size()) {
      std::copy(points.begin(), points.end(), to.points.begin());
    } else {
      Fault("POINT_COUNT", field,
            fmt::format("has {} points; must have {}", points.size(), to.points.size()));
    }
    switch (from.blend()) {
      case v1::GREGORY_BLEND_CORNER:
        to.blend = GregoryPatch::Blend::kCorner;
        break;
      case v1::GREGORY_BLEND_EDGE:
        to.blend = GregoryPatch::Blend::kEdge;
        break;
      default:
        Fault("NO_BLEND", fmt::format("{}.blend", kind),
              fmt::format("= {}; must be GREGORY_BLEND_CORNER or GREGORY_BLEND_EDGE",
                          static_cast<int>(from.blend())));
    }
    return to;
  }

  HosakaPatch Hosaka(const v1::HosakaPatch& from) {
    HosakaPatch to;
    to.degree = from.degree();
    to.blend = from.linear() ? HosakaPatch::Blend::kLinear : HosakaPatch::Blend::kSmooth;
    for (const v1::HosakaBreak& b : from.breaks()) {
      if (b.side() >= 0 && b.side() < 4) {
        to.breaks[static_cast<std::size_t>(b.side())].push_back({b.at(), b.value()});
      } else {
        Fault("INVALID_BREAKS", "hosaka.breaks", fmt::format("name side {}; must be in [0, 3]", b.side()));
      }
    }
    if (from.has_inner_degree_u()) to.inner_u = from.inner_degree_u();
    if (from.has_inner_degree_v()) to.inner_v = from.inner_degree_v();
    to.inner_order = from.inner_order() == 0 ? 1 : from.inner_order();
    to.points = Points("hosaka.points", from.points());
    return to;
  }

  double unit_;
  int index_;
  Diagnostics& faults_;
  std::string id_;
};

void AddPoints(const auto& from, Numbers* to) {
  to->Reserve(static_cast<int>(3 * from.size()));
  for (const Vec3& p : from) {
    for (int k = 0; k < 3; ++k) to->Add(p[k]);
  }
}

void Fill(const BezierPatch& from, v1::Patch& to) {
  v1::BezierPatch& shape = *to.mutable_bezier();
  shape.set_degree_u(from.degree_u);
  shape.set_degree_v(from.degree_v);
  AddPoints(from.points, shape.mutable_points());
  shape.mutable_weights()->Add(from.weights.begin(), from.weights.end());
}

void Fill(const BsplinePatch& from, v1::Patch& to) {
  v1::BsplinePatch& shape = *to.mutable_bspline();
  shape.set_degree_u(from.degree_u);
  shape.set_degree_v(from.degree_v);
  shape.mutable_knots_u()->Add(from.knots_u.begin(), from.knots_u.end());
  shape.mutable_knots_v()->Add(from.knots_v.begin(), from.knots_v.end());
  AddPoints(from.points, shape.mutable_points());
  shape.mutable_weights()->Add(from.weights.begin(), from.weights.end());
}

v1::GregoryBlend BlendOf(GregoryPatch::Blend blend) {
  return blend == GregoryPatch::Blend::kCorner ? v1::GREGORY_BLEND_CORNER : v1::GREGORY_BLEND_EDGE;
}

void Fill(const GregoryPatch& from, v1::Patch& to) {
  v1::GregoryPatch& shape = *to.mutable_gregory();
  AddPoints(from.points, shape.mutable_points());
  shape.set_blend(BlendOf(from.blend));
}

void Fill(const BrownPatch& from, v1::Patch& to) {
  v1::BrownPatch& shape = *to.mutable_brown();
  shape.set_degree_u(from.degree_u);
  shape.set_degree_v(from.degree_v);
  AddPoints(from.points, shape.mutable_points());
  shape.mutable_breaks_u()->Add(from.breaks_u.begin(), from.breaks_u.end());
  shape.mutable_breaks_v()->Add(from.breaks_v.begin(), from.breaks_v.end());
}

void Fill(const GregoryTriangle& from, v1::Patch& to) {
  v1::GregoryTriangle& shape = *to.mutable_gregory_triangle();
  AddPoints(from.points, shape.mutable_points());
  shape.set_blend(BlendOf(from.blend));
}

void Fill(const LoftTriangle& from, v1::Patch& to) {
  v1::LoftTriangle& shape = *to.mutable_loft_triangle();
  shape.set_degree(from.degree);
  shape.set_squared(from.squared);
  AddPoints(from.points, shape.mutable_points());
}

void Fill(const G2GregoryPatch& from, v1::Patch& to) {
  v1::G2GregoryPatch& shape = *to.mutable_g2_gregory();
  shape.set_degree(from.degree);
  AddPoints(from.points, shape.mutable_points());
}

void Fill(const HosakaPatch& from, v1::Patch& to) {
  v1::HosakaPatch& shape = *to.mutable_hosaka();
  shape.set_degree(from.degree);
  shape.set_linear(from.blend == HosakaPatch::Blend::kLinear);
  for (int side = 0; side < 4; ++side) {
    for (const HosakaPatch::Break& b : from.breaks[static_cast<std::size_t>(side)]) {
      v1::HosakaBreak& made = *shape.add_breaks();
      made.set_side(side);
      made.set_at(b.at);
      made.set_value(b.value);
    }
  }
  if (from.inner_u >= 0) {
    shape.set_inner_degree_u(from.inner_u);
    shape.set_inner_degree_v(from.inner_v);
    shape.set_inner_order(from.inner_order);
  }
  AddPoints(from.points, shape.mutable_points());
}

void Fill(const BezierTriangle& from, v1::Patch& to) {
  v1::BezierTriangle& shape = *to.mutable_triangle();
  shape.set_degree(from.degree);
  AddPoints(from.points, shape.mutable_points());
  shape.mutable_weights()->Add(from.weights.begin(), from.weights.end());
}

}  // namespace

std::optional<double> MillimetersPer(v1::LengthUnit unit) {
  switch (unit) {
    case v1::LENGTH_UNIT_MILLIMETER:
      return 1.0;
    case v1::LENGTH_UNIT_INCH:
      return 25.4;
    case v1::LENGTH_UNIT_METER:
      return 1000.0;
    default:
      return std::nullopt;
  }
}

namespace {

// What every model has: mm of one unit, and the join tolerance.
struct ModelHead {
  double unit = 1.0;
  std::optional<double> join_tolerance;
};

absl::StatusOr<ModelHead> HeadOf(const v1::PatchModel& proto, std::string_view at) {
  PM_RETURN_IF_ERROR(CheckLimits(proto));
  FieldErrors errors;
  const std::optional<double> unit = MillimetersPer(proto.length_unit());
  if (!unit) {
    errors.Add(At(at, "length_unit"),
               fmt::format("= {}; must be LENGTH_UNIT_MILLIMETER, LENGTH_UNIT_INCH or LENGTH_UNIT_METER",
                           static_cast<int>(proto.length_unit())));
  }
  if (proto.has_network() && !proto.patches().empty()) {
    errors.Add(At(at, "network"), "comes beside patches; give one of the two");
  }
  if (proto.patches().empty() && !proto.has_network()) errors.Missing(At(at, "patches"));
  ModelHead head;
  if (proto.has_join_tolerance_mm()) {
    const double tolerance = proto.join_tolerance_mm();
    Require(errors, At(at, "join_tolerance_mm"), tolerance,
            tolerance > 0.0 && tolerance <= limits::kMaxJoinToleranceMm,
            fmt::format("in (0, {}]", limits::kMaxJoinToleranceMm));
    head.join_tolerance = tolerance;
  }
  PM_RETURN_IF_ERROR(errors.ToStatus());
  head.unit = *unit;
  return head;
}

CheckedNetwork ReadNetwork(const v1::PatchModel& proto, const ModelHead& head) {
  CheckedNetwork checked;
  checked.unit = head.unit;
  checked.network = FromProto(proto.network(), head.unit, checked.faults);
  checked.network.join_tolerance = head.join_tolerance;
  return checked;
}

}  // namespace

absl::StatusOr<CheckedNetwork> NetworkFromProto(const v1::PatchModel& proto, std::string_view at) {
  PM_ASSIGN_OR_RETURN(const ModelHead head, HeadOf(proto, at));
  if (proto.has_network()) return ReadNetwork(proto, head);
  FieldErrors errors;
  errors.Add(At(at, "patches"), "make a model that has no network; must be a network");
  return errors.ToStatus();
}

absl::StatusOr<CheckedModel> FromProto(const v1::PatchModel& proto, std::string_view at,
                                       const RunContext& run) {
  PM_ASSIGN_OR_RETURN(const ModelHead head, HeadOf(proto, at));
  CheckedModel checked;
  checked.model.join_tolerance = head.join_tolerance;
  if (proto.has_network()) {
    CheckedNetwork read = ReadNetwork(proto, head);
    checked.faults = std::move(read.faults);
    if (!checked.faults.empty()) return checked;
    PM_ASSIGN_OR_RETURN(JoinedNetwork joined, JoinNetwork(read.network, run));
    checked.model = std::move(joined.model);
    (HasError(joined.findings) ? checked.faults : checked.remarks) = std::move(joined.findings);
    if (checked.faults.empty()) checked.faults = ValidateModel(checked.model);
    return checked;
  }
  checked.model.patches.reserve(static_cast<std::size_t>(proto.patches_size()));
  for (int i = 0; i < proto.patches_size(); ++i) {
    checked.model.patches.push_back(PatchReader(head.unit, i, checked.faults).Read(proto.patches(i)));
  }
  // A patch the wire already got wrong is not reported twice.
  std::set<int> reported;
  for (const Diagnostic& fault : checked.faults) reported.insert(fault.where.patch_index.value_or(-1));
  for (Diagnostic& fault : ValidateModel(checked.model)) {
    if (fault.where.patch_index && reported.contains(*fault.where.patch_index)) continue;
    checked.faults.push_back(std::move(fault));
  }
  return checked;
}

v1::PatchModel ToProto(const PatchModel& model) {
  v1::PatchModel proto;
  proto.set_length_unit(v1::LENGTH_UNIT_MILLIMETER);
  if (model.join_tolerance) proto.set_join_tolerance_mm(*model.join_tolerance);
  proto.mutable_patches()->Reserve(static_cast<int>(model.patches.size()));
  for (const Patch& patch : model.patches) {
    v1::Patch& to = *proto.add_patches();
    to.set_id(Utf8(patch.id));
    std::visit([&](const auto& shape) { Fill(shape, to); }, patch.shape);
  }
  return proto;
}

}  // namespace patchmill
