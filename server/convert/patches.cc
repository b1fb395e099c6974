#include "server/convert/patches.h"

#include <algorithm>
#include <utility>
#include <variant>

#include "core/network/control_points.h"
#include "server/convert/fields.h"
#include "server/limits.h"

namespace patchmill {
namespace {

using Numbers = google::protobuf::RepeatedField<double>;

std::size_t Count(const Numbers& numbers) { return static_cast<std::size_t>(numbers.size()); }

class PatchReader {
 public:
  PatchReader(double unit, int index, Diagnostics& faults) : unit_(unit), index_(index), faults_(faults) {}

  Patch Read(const v1::Patch& proto) {
    Patch patch;
    patch.id = id_ = proto.id();
    if (proto.has_face_index()) patch.face = FaceId(proto.face_index());
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
    ReadBulges(proto, patch.shape);
    return patch;
  }

 private:
  void Fault(std::string_view code, std::string_view field, std::string_view text) {
    std::string path = fmt::format("patches[{}].{}", index_, field);
    std::string message = fmt::format("{} {}", path, text);
    faults_.push_back(MakeError(code, std::move(message),
                                {.patch_id = id_, .patch_index = index_, .field = std::move(path)}));
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

  void ReadBulges(const v1::Patch& from, PatchShape& shape) {
    if (from.bulges().empty()) return;
    std::vector<Bulge> bulges;
    for (const v1::Bulge& bulge : from.bulges()) {
      const Numbers& by = bulge.by();
      if (by.size() != 3) {
        Fault("INVALID_BULGE", "bulges",
              fmt::format("have one with {} numbers in `by`; must have x y z", by.size()));
        return;
      }
      bulges.push_back({bulge.u(), bulge.v(), unit_ * Vec3(by[0], by[1], by[2])});
    }
    std::visit(
        [&](auto& s) {
          if constexpr (requires { s.bulges; }) {
            s.bulges = std::move(bulges);
          } else {
            Fault("INVALID_BULGE", "bulges",
                  "are given; only gregory, brown, g2_gregory and hosaka patches have some");
          }
        },
        shape);
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

Patch FromProto(const v1::Patch& proto, double unit, int index, Diagnostics& faults) {
  return PatchReader(unit, index, faults).Read(proto);
}

v1::Patch ToProto(const Patch& patch) {
  v1::Patch to;
  to.set_id(Utf8(patch.id));
  if (patch.face) to.set_face_index(patch.face->value);
  std::visit([&](const auto& shape) { Fill(shape, to); }, patch.shape);
  for (const Bulge& bulge : Bulges(patch.shape)) {
    v1::Bulge& made = *to.add_bulges();
    made.set_u(bulge.u);
    made.set_v(bulge.v);
    for (int k = 0; k < 3; ++k) made.add_by(bulge.by[k]);
  }
  return to;
}

}  // namespace patchmill
