#include "server/convert/stock.h"

#include <cmath>
#include <string>
#include <variant>

#include <fmt/format.h>

#include "server/convert/fields.h"
#include "server/convert/outline.h"
#include "server/limits.h"

namespace patchmill {
namespace {

constexpr double kMostCoordinate = limits::kMaxCoordinateMm;

void RequireCoordinate(FieldErrors& errors, std::string field, double value) {
  Require(errors, std::move(field), value, std::abs(value) <= kMostCoordinate,
          fmt::format("in [{}, {}]", -kMostCoordinate, kMostCoordinate));
}

CylinderStock ReadCylinder(const v1::CylinderStock& proto, const std::string& at, FieldErrors& errors) {
  CylinderStock cylinder;
  cylinder.diameter = proto.diameter_mm();
  Require(errors, At(at, "diameter_mm"), cylinder.diameter,
          cylinder.diameter > 0.0 && cylinder.diameter <= kMostCoordinate,
          fmt::format("in (0, {}]", kMostCoordinate));
  if (proto.center_xy_mm().empty()) return cylinder;
  if (proto.center_xy_mm_size() != 2) {
    errors.Add(At(at, "center_xy_mm"),
               fmt::format("has {} numbers; must have 2, x and y", proto.center_xy_mm_size()));
    return cylinder;
  }
  for (int k = 0; k < 2; ++k)
    RequireCoordinate(errors, fmt::format("{}[{}]", At(at, "center_xy_mm"), k), proto.center_xy_mm(k));
  cylinder.center = Vec2(proto.center_xy_mm(0), proto.center_xy_mm(1));
  return cylinder;
}

void ReadAllowance(const v1::Stock& proto, std::string_view at, Setup& setup, FieldErrors& errors) {
  const auto read = [&](const char* field, double value) {
    Require(errors, At(at, field), value, value >= 0.0 && value <= limits::kMaxAllowanceMm,
            fmt::format("in [0, {}]", limits::kMaxAllowanceMm));
    setup.allowance_stated = true;
    return value;
  };
  if (proto.has_allowance_mm()) setup.allowance = read("allowance_mm", proto.allowance_mm());
  if (proto.has_wall_allowance_mm())
    setup.allowance.walls = read("wall_allowance_mm", proto.wall_allowance_mm());
  if (proto.has_floor_allowance_mm())
    setup.allowance.floors = read("floor_allowance_mm", proto.floor_allowance_mm());
  if (proto.has_allowance_mm() || proto.has_wall_allowance_mm() == proto.has_floor_allowance_mm()) return;
  errors.Add(At(at, proto.has_wall_allowance_mm() ? "floor_allowance_mm" : "wall_allowance_mm"),
             proto.has_wall_allowance_mm()
                 ? "is missing; required with wall_allowance_mm: state it, or allowance_mm for both"
                 : "is missing; required with floor_allowance_mm: state it, or allowance_mm for both");
}

}  // namespace

void ReadStock(const v1::Stock& proto, std::string_view at, Setup& setup, FieldErrors& errors) {
  if (proto.has_top_z_mm()) {
    RequireCoordinate(errors, At(at, "top_z_mm"), proto.top_z_mm());
    setup.stock_top_z = proto.top_z_mm();
  }
  ReadAllowance(proto, at, setup, errors);
  if (proto.has_block()) {
    const double margin = proto.block().margin_mm();
    Require(errors, At(at, "block.margin_mm"), margin, margin >= 0.0 && margin <= limits::kMaxStockMarginMm,
            fmt::format("in [0, {}]", limits::kMaxStockMarginMm));
    setup.stock_body = BlockStock{margin};
  } else if (proto.has_outline()) {
    std::size_t points = 0;
    setup.stock_body = OutlineStock{
        ReadRing(proto.outline().outline_xy_mm(), At(at, "outline.outline_xy_mm"), points, errors)};
  } else if (proto.has_cylinder()) {
    setup.stock_body = ReadCylinder(proto.cylinder(), At(at, "cylinder"), errors);
  } else if (proto.has_model()) {
    setup.stock_body = ModelStock{};  // LoadStock reads it
  }
}

v1::Stock StockToProto(const Setup& setup) {
  v1::Stock proto;
  if (setup.stock_top_z) proto.set_top_z_mm(*setup.stock_top_z);
  if (setup.allowance_stated && setup.allowance.IsOne()) proto.set_allowance_mm(setup.allowance.walls);
  if (setup.allowance_stated && !setup.allowance.IsOne()) {
    proto.set_wall_allowance_mm(setup.allowance.walls);
    proto.set_floor_allowance_mm(setup.allowance.floors);
  }
  if (const auto* block = std::get_if<BlockStock>(&setup.stock_body)) {
    proto.mutable_block()->set_margin_mm(block->margin);
  } else if (const auto* outline = std::get_if<OutlineStock>(&setup.stock_body)) {
    WriteRing(outline->outline, proto.mutable_outline()->mutable_outline_xy_mm());
  } else if (const auto* cylinder = std::get_if<CylinderStock>(&setup.stock_body)) {
    proto.mutable_cylinder()->set_diameter_mm(cylinder->diameter);
    if (cylinder->center) {
      proto.mutable_cylinder()->add_center_xy_mm(cylinder->center->x());
      proto.mutable_cylinder()->add_center_xy_mm(cylinder->center->y());
    }
  } else if (const auto* model = std::get_if<ModelStock>(&setup.stock_body)) {
    proto.mutable_model()->set_model_sha256(model->digest);
  }
  return proto;
}

}  // namespace patchmill
