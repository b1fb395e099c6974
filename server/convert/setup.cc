#include "server/convert/setup.h"

#include <fmt/format.h>

#include "server/convert/enums.h"
#include "server/convert/fields.h"
#include "server/convert/machine.h"
#include "server/convert/outline.h"
#include "server/convert/stock.h"
#include "server/limits.h"

namespace patchmill {
namespace {

std::optional<double> Positive(bool has, double value, std::string field, FieldErrors& errors) {
  if (!has) return std::nullopt;
  Require(errors, std::move(field), value, value > 0.0 && value <= limits::kMaxCoordinateMm,
          fmt::format("in (0, {}]", limits::kMaxCoordinateMm));
  return value;
}

void ReadObstacles(const google::protobuf::RepeatedPtrField<v1::Obstacle>& list, std::string_view at,
                   Setup& setup, FieldErrors& errors) {
  if (list.size() > limits::kMaxObstacles) {
    errors.Add(At(at, "obstacles"),
               fmt::format("has {} elements; must have at most {}", list.size(), limits::kMaxObstacles));
    return;
  }
  std::size_t points = 0;
  for (int i = 0; i < list.size(); ++i) {
    const v1::Obstacle& proto = list[i];
    const std::string path = fmt::format("{}[{}]", At(at, "obstacles"), i);
    RequireBytes(errors, At(path, "id"), proto.id(), limits::kMaxIdBytes);
    ObstacleOutline obstacle;
    obstacle.id = proto.id();
    obstacle.outline = ReadRing(proto.outline_xy_mm(), At(path, "outline_xy_mm"), points, errors);
    obstacle.top_z = proto.top_z_mm();
    Require(errors, At(path, "top_z_mm"), obstacle.top_z,
            std::abs(obstacle.top_z) <= limits::kMaxCoordinateMm,
            fmt::format("in [{}, {}]", -limits::kMaxCoordinateMm, limits::kMaxCoordinateMm));
    obstacle.margin = proto.margin_mm();
    Require(errors, At(path, "margin_mm"), obstacle.margin,
            obstacle.margin >= 0.0 && obstacle.margin <= limits::kMaxOutlineOffsetMm,
            fmt::format("in [0, {}]", limits::kMaxOutlineOffsetMm));
    setup.obstacles.push_back(std::move(obstacle));
  }
}

void ReadWallSides(const google::protobuf::RepeatedPtrField<v1::WallSide>& list, std::string_view at,
                   Setup& setup, FieldErrors& errors) {
  if (list.size() > limits::kMaxObstacles) {
    errors.Add(At(at, "wall_sides"),
               fmt::format("has {} elements; must have at most {}", list.size(), limits::kMaxObstacles));
    return;
  }
  for (int i = 0; i < list.size(); ++i) {
    const std::string path = fmt::format("{}[{}]", At(at, "wall_sides"), i);
    if (list[i].patch_id().empty()) errors.Missing(At(path, "patch_id"));
    RequireBytes(errors, At(path, "patch_id"), list[i].patch_id(), limits::kMaxIdBytes);
    if (!list[i].has_air()) errors.Missing(At(path, "air"));
    setup.wall_sides.push_back({list[i].patch_id(), ReadPoint(list[i].air(), At(path, "air"), errors)});
  }
}

void CheckCuttingData(const v1::Tool& proto, std::string_view at, CuttingData needed, FieldErrors& errors) {
  const auto check = [&](const char* name, double value, double least, double most) {
    if (needed == CuttingData::kOptional && value == 0.0) return;
    Require(errors, At(at, name), value, value >= least && value <= most,
            fmt::format("in [{:g}, {:g}]", least, most));
  };
  check("spindle_rpm", proto.spindle_rpm(), limits::kMinRpm, limits::kMaxRpm);
  check("feed_mm_per_min", proto.feed_mm_per_min(), limits::kMinFeed, limits::kMaxFeed);
  check("plunge_feed_mm_per_min", proto.plunge_feed_mm_per_min(), limits::kMinFeed, limits::kMaxFeed);
}

void ReadHolder(const v1::Tool& proto, std::string_view at, Tool& tool, FieldErrors& errors) {
  if (proto.holder_size() > static_cast<int>(kMaxHolderSegments)) {
    errors.Add(At(at, "holder"),
               fmt::format("has {} segments; must be at most {}", proto.holder_size(), kMaxHolderSegments));
    return;
  }
  for (int k = 0; k < proto.holder_size(); ++k) {
    const v1::HolderSegment& segment = proto.holder(k);
    const auto read = [&](const char* name, double value) {
      const std::string field = fmt::format("holder[{}].{}", k, name);
      Require(errors, At(at, field), value, value > 0.0 && value <= limits::kMaxCoordinateMm,
              fmt::format("in (0, {}]", limits::kMaxCoordinateMm));
      return value;
    };
    tool.holder.push_back({read("length_mm", segment.length_mm()),
                           read("lower_diameter_mm", segment.lower_diameter_mm()),
                           read("upper_diameter_mm", segment.upper_diameter_mm())});
  }
  if (proto.has_holder_clearance_mm()) {
    tool.holder_clearance = proto.holder_clearance_mm();
    Require(errors, At(at, "holder_clearance_mm"), tool.holder_clearance,
            tool.holder_clearance >= 0.0 && tool.holder_clearance <= 100.0, "in [0, 100]");
  }
  if (!tool.holder.empty() && !proto.has_stickout_mm()) {
    errors.Add(At(at, "stickout_mm"), "is missing; required with a holder: it says where that begins");
  }
}

}  // namespace

Vec3 FromProto(const v1::Point3& proto) { return {proto.x_mm(), proto.y_mm(), proto.z_mm()}; }

Vec3 ReadPoint(const v1::Point3& p, const std::string& at, FieldErrors& errors) {
  constexpr double kMost = limits::kMaxCoordinateMm;
  const auto check = [&](const char* name, double x) {
    Require(errors, At(at, name), x, std::abs(x) <= kMost, fmt::format("in [{}, {}]", -kMost, kMost));
  };
  check("x_mm", p.x_mm());
  check("y_mm", p.y_mm());
  check("z_mm", p.z_mm());
  return FromProto(p);
}

v1::Point3 ToProto(const Vec3& p) {
  v1::Point3 proto;
  proto.set_x_mm(p.x());
  proto.set_y_mm(p.y());
  proto.set_z_mm(p.z());
  return proto;
}

Setup FromProto(const v1::Setup& proto, std::string_view at, FieldErrors& errors) {
  Setup setup;
  setup.up_auto = proto.up() == v1::UP_AXIS_AUTO;
  if (!setup.up_auto) setup.placement.up = FromProto(proto.up(), At(at, "up"), errors);
  RequireBytes(errors, At(at, "up_face"), proto.up_face(), limits::kMaxIdBytes);
  setup.up_face = proto.up_face();
  if (!setup.up_face.empty() && proto.up() != v1::UP_AXIS_UNSPECIFIED)
    errors.Add(At(at, "up"), "is set together with up_face; set one of them");
  if (proto.has_cap_holes_mm()) {
    setup.cap_holes = proto.cap_holes_mm();
    Require(errors, At(at, "cap_holes_mm"), proto.cap_holes_mm(),
            proto.cap_holes_mm() > 0.0 && proto.cap_holes_mm() <= 1e5, "in (0, 1e5]");
  }
  if (proto.has_scale()) {
    setup.placement.scale = proto.scale();
    Require(errors, At(at, "scale"), proto.scale(),
            proto.scale() >= limits::kMinScale && proto.scale() <= limits::kMaxScale,
            fmt::format("in [{:g}, {:g}]", limits::kMinScale, limits::kMaxScale));
  }
  if (proto.has_translation()) {
    setup.placement.translation = ReadPoint(proto.translation(), At(at, "translation"), errors);
  }
  if (proto.has_program_zero()) {
    setup.zero_point = ReadPoint(proto.program_zero(), At(at, "program_zero"), errors);
  } else {
    setup.zero = FromProto(proto.zero_anchor(), At(at, "zero_anchor"), errors);
    setup.zero_stated = proto.zero_anchor() != v1::ZERO_ANCHOR_UNSPECIFIED;
  }
  ReadStock(proto.stock(), At(at, "stock"), setup, errors);
  ReadObstacles(proto.obstacles(), at, setup, errors);
  ReadWallSides(proto.wall_sides(), at, setup, errors);
  if (proto.has_machine()) setup.machine = FromProto(proto.machine(), At(at, "machine"), errors);
  return setup;
}

Tool FromProto(const v1::Tool& proto, std::string_view at, CuttingData cutting_data, FieldErrors& errors) {
  Tool tool;
  const bool number_needed = cutting_data == CuttingData::kRequired || proto.number() != 0;
  if (number_needed) {
    Require(errors, At(at, "number"), proto.number(),
            proto.number() >= 1 && proto.number() <= limits::kMaxToolNumber,
            fmt::format("in [1, {}]", limits::kMaxToolNumber));
    tool.number = proto.number();
  }
  RequireBytes(errors, At(at, "name"), proto.name(), limits::kMaxNameBytes);
  tool.name = proto.name();
  if (proto.has_ball_end()) {
    const double diameter = proto.ball_end().diameter_mm();
    Require(errors, At(at, "ball_end.diameter_mm"), diameter,
            diameter >= limits::kMinDiameterMm && diameter <= limits::kMaxDiameterMm,
            fmt::format("in [{}, {}]", limits::kMinDiameterMm, limits::kMaxDiameterMm));
    tool.cutter = BallEnd{0.5 * diameter};
  } else {
    errors.Missing(At(at, "ball_end"));
  }
  tool.flute_length =
      Positive(proto.has_flute_length_mm(), proto.flute_length_mm(), At(at, "flute_length_mm"), errors);
  tool.shank_diameter =
      Positive(proto.has_shank_diameter_mm(), proto.shank_diameter_mm(), At(at, "shank_diameter_mm"), errors);
  tool.stickout = Positive(proto.has_stickout_mm(), proto.stickout_mm(), At(at, "stickout_mm"), errors);
  if (tool.shank_diameter && !tool.flute_length && *tool.shank_diameter > 2.0 * BallRadius(tool)) {
    errors.Add(At(at, "flute_length_mm"),
               fmt::format("is missing; required when shank_diameter_mm = {:.10g} is wider "
                           "than the cutter",
                           *tool.shank_diameter));
  }
  ReadHolder(proto, at, tool, errors);
  CheckCuttingData(proto, at, cutting_data, errors);
  tool.spindle_rpm = proto.spindle_rpm();
  tool.feed = proto.feed_mm_per_min();
  tool.plunge_feed = proto.plunge_feed_mm_per_min();
  tool.coolant = FromProto(proto.coolant(), At(at, "coolant"), errors);
  return tool;
}

v1::Setup ToProto(const Setup& setup) {
  v1::Setup proto;
  if (setup.up_face.empty()) {
    proto.set_up(ToProto(setup.placement.up));
  } else {
    proto.set_up_face(Utf8(setup.up_face));
  }
  proto.set_scale(setup.placement.scale);
  *proto.mutable_translation() = ToProto(setup.placement.translation);
  if (!setup.zero_stated) {
    proto.set_zero_anchor(v1::ZERO_ANCHOR_UNSPECIFIED);
  } else if (setup.zero == Setup::Zero::kPoint) {
    *proto.mutable_program_zero() = ToProto(setup.zero_point);
  } else {
    proto.set_zero_anchor(ToProto(setup.zero));
  }
  if (setup.cap_holes) proto.set_cap_holes_mm(*setup.cap_holes);
  *proto.mutable_stock() = StockToProto(setup);
  for (const WallSide& side : setup.wall_sides) {
    v1::WallSide& out = *proto.add_wall_sides();
    out.set_patch_id(Utf8(side.name));
    *out.mutable_air() = ToProto(side.air);
  }
  if (setup.machine) *proto.mutable_machine() = ToProto(*setup.machine);
  for (const ObstacleOutline& o : setup.obstacles) {
    v1::Obstacle& obstacle = *proto.add_obstacles();
    obstacle.set_id(Utf8(o.id));
    WriteRing(o.outline, obstacle.mutable_outline_xy_mm());
    obstacle.set_top_z_mm(o.top_z);
    obstacle.set_margin_mm(o.margin);
  }
  return proto;
}

v1::Tool ToProto(const Tool& tool) {
  v1::Tool proto;
  proto.set_number(tool.number);
  proto.set_name(Utf8(tool.name));
  proto.mutable_ball_end()->set_diameter_mm(2.0 * BallRadius(tool));
  if (tool.flute_length) proto.set_flute_length_mm(*tool.flute_length);
  if (tool.shank_diameter) proto.set_shank_diameter_mm(*tool.shank_diameter);
  if (tool.stickout) proto.set_stickout_mm(*tool.stickout);
  for (const HolderSegment& segment : tool.holder) {
    v1::HolderSegment& out = *proto.add_holder();
    out.set_length_mm(segment.length);
    out.set_lower_diameter_mm(segment.lower_diameter);
    out.set_upper_diameter_mm(segment.upper_diameter);
  }
  if (!tool.holder.empty()) proto.set_holder_clearance_mm(tool.holder_clearance);
  proto.set_spindle_rpm(tool.spindle_rpm);
  proto.set_feed_mm_per_min(tool.feed);
  proto.set_plunge_feed_mm_per_min(tool.plunge_feed);
  proto.set_coolant(ToProto(tool.coolant));
  return proto;
}

}  // namespace patchmill
