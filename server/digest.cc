#include "server/digest.h"

#include <cstdint>

namespace patchmill {
namespace {

void AddOptional(const std::optional<double>& value, Canonical& out) {
  out.Add(std::int64_t{value.has_value()}).Add(value.value_or(0.0));
}

void AddPoint(const Vec3& p, Canonical& out) { out.Add(p.x()).Add(p.y()).Add(p.z()); }

void AddPoints(const auto& points, Canonical& out) {
  out.Add(static_cast<std::int64_t>(points.size()));
  for (const Vec3& p : points) AddPoint(p, out);
}

void AddNumbers(const std::vector<double>& numbers, Canonical& out) {
  out.Add(static_cast<std::int64_t>(numbers.size()));
  for (const double x : numbers) out.Add(x);
}

void AddShape(const BezierPatch& p, Canonical& out) {
  out.Add("bezier").Add(std::int64_t{p.degree_u}).Add(std::int64_t{p.degree_v});
  AddPoints(p.points, out);
  AddNumbers(p.weights, out);
}

void AddShape(const BsplinePatch& p, Canonical& out) {
  out.Add("bspline").Add(std::int64_t{p.degree_u}).Add(std::int64_t{p.degree_v});
  AddNumbers(p.knots_u, out);
  AddNumbers(p.knots_v, out);
  AddPoints(p.points, out);
  AddNumbers(p.weights, out);
}

// A quad without bulges keeps the digest of the time before bulges existed.
void AddBulges(const std::vector<Bulge>& bulges, Canonical& out) {
  if (bulges.empty()) return;
  out.Add("bulges").Add(static_cast<std::int64_t>(bulges.size()));
  for (const Bulge& b : bulges) out.Add(b.u).Add(b.v).Add(b.by.x()).Add(b.by.y()).Add(b.by.z());
}

void AddShape(const GregoryPatch& p, Canonical& out) {
  out.Add(p.blend == GregoryPatch::Blend::kCorner ? "gregory-corner" : "gregory-edge");
  AddPoints(p.points, out);
  AddBulges(p.bulges, out);
}

void AddShape(const BrownPatch& p, Canonical& out) {
  out.Add("brown").Add(std::int64_t{p.degree_u}).Add(std::int64_t{p.degree_v});
  AddPoints(p.points, out);
  AddBulges(p.bulges, out);
  if (p.breaks_u.empty() && p.breaks_v.empty())
    return;  // the digest is that of the time before breaks existed
  out.Add("breaks");
  AddNumbers(p.breaks_u, out);
  AddNumbers(p.breaks_v, out);
}

void AddShape(const GregoryTriangle& p, Canonical& out) {
  out.Add(p.blend == GregoryPatch::Blend::kCorner ? "gregory-triangle-corner" : "gregory-triangle-edge");
  AddPoints(p.points, out);
}

void AddShape(const LoftTriangle& p, Canonical& out) {
  out.Add(p.squared ? "loft-triangle-squared" : "loft-triangle").Add(std::int64_t{p.degree});
  AddPoints(p.points, out);
}

void AddShape(const G2GregoryPatch& p, Canonical& out) {
  out.Add("g2-gregory").Add(std::int64_t{p.degree});
  AddPoints(p.points, out);
  AddBulges(p.bulges, out);
}

void AddShape(const HosakaPatch& p, Canonical& out) {
  out.Add(p.blend == HosakaPatch::Blend::kLinear ? "hosaka-linear" : "hosaka").Add(std::int64_t{p.degree});
  for (const auto& side : p.breaks) {
    out.Add(static_cast<std::int64_t>(side.size()));
    for (const auto& b : side) out.Add(b.at).Add(b.value);
  }
  out.Add(std::int64_t{p.inner_u}).Add(std::int64_t{p.inner_v}).Add(std::int64_t{p.inner_order});
  AddPoints(p.points, out);
  AddBulges(p.bulges, out);
}

void AddShape(const BezierTriangle& p, Canonical& out) {
  out.Add("triangle").Add(std::int64_t{p.degree});
  AddPoints(p.points, out);
  AddNumbers(p.weights, out);
}

// A model without faces keeps the digest of the time before faces existed.
void AddFaces(const PatchModel& model, Canonical& out) {
  if (model.faces.empty()) return;
  out.Add("faces").Add(static_cast<std::int64_t>(model.faces.size()));
  for (const ModelFace& face : model.faces) {
    out.Add(face.id).Add(face.name).Add(face.body).Add(face.layer);
    out.Add(face.rgb ? std::int64_t{*face.rgb} : -1).Add(static_cast<std::int64_t>(face.kind));
    out.Add(face.radius).Add(std::int64_t{face.hollow}).Add(face.entity);
    if (face.skipped) out.Add("skipped");
  }
  for (const Patch& patch : model.patches) out.Add(patch.face ? std::int64_t{patch.face->value} : -1);
}

void AddRing(const Ring& ring, Canonical& out) {
  out.Add(static_cast<std::int64_t>(ring.size()));
  for (const Vec2& p : ring) out.Add(p.x()).Add(p.y());
}

void AddNames(const std::vector<std::string>& names, Canonical& out) {
  out.Add(static_cast<std::int64_t>(names.size()));
  for (const std::string& name : names) out.Add(name);
}

void AddPlacement(const Placement& placement, Canonical& out) {
  out.Add(placement.scale).Add(static_cast<std::int64_t>(placement.up));
  AddPoint(placement.translation, out);
  if (!placement.turn) return;
  out.Add("turn");
  for (const double x : placement.turn->reshaped()) out.Add(x);
}

void AddWallSides(const std::vector<WallSide>& sides, Canonical& out) {
  for (const WallSide& side : sides) {
    out.Add("wall side").Add(side.name);
    AddPoint(side.air, out);
  }
}

// The stock beyond its top and its allowance.
void AddStock(const Setup& setup, Canonical& out) {
  if (setup.allowance_stated) out.Add("allowance stated");
  if (!setup.allowance.IsOne()) out.Add("floor allowance").Add(setup.allowance.floors);
  if (!setup.zero_stated) out.Add("zero assumed");
  AddWallSides(setup.wall_sides, out);
  if (const auto* block = std::get_if<BlockStock>(&setup.stock_body)) out.Add("block").Add(block->margin);
  if (const auto* outline = std::get_if<OutlineStock>(&setup.stock_body)) {
    out.Add("outline");
    AddRing(outline->outline, out);
  }
  if (const auto* cylinder = std::get_if<CylinderStock>(&setup.stock_body)) {
    out.Add("cylinder").Add(cylinder->diameter);
    if (cylinder->center) out.Add(cylinder->center->x()).Add(cylinder->center->y());
  }
  if (const auto* model = std::get_if<ModelStock>(&setup.stock_body))
    out.Add("stock model").Add(model->digest);
}

void AddMachine(const Machine& machine, Canonical& out) {
  out.Add("machine").Add(machine.name).Add(machine.junction_deviation);
  out.Add(machine.spindle_min).Add(machine.spindle_max);
  for (const MachineAxis& axis : machine.axes)
    out.Add(axis.travel_min).Add(axis.travel_max).Add(axis.rapid).Add(axis.feed).Add(axis.acceleration);
  if (machine.work_zero) AddPoint(*machine.work_zero, out);
}

// Leads, links and their feeds.
void AddMotion(const Operation& op, Canonical& out) {
  const Operation usual;
  if (op.high_rapids) out.Add("high rapids");
  if (op.lead_radius) out.Add("lead radius").Add(*op.lead_radius);
  if (op.lead_sweep != usual.lead_sweep) out.Add("lead sweep").Add(op.lead_sweep);
  if (op.plunge_angle != usual.plunge_angle) out.Add("plunge angle").Add(op.plunge_angle);
  if (op.keep_feed) out.Add("keep feed");
  if (op.link_feed) out.Add("link feed").Add(*op.link_feed);
  if (op.lead_feed) out.Add("lead feed").Add(*op.lead_feed);
  if (op.corner_feed) out.Add("corner feed").Add(*op.corner_feed);
  if (op.max_unreached != usual.max_unreached) out.Add("max unreached").Add(op.max_unreached);
  if (op.accept_depth != 0.0) out.Add("accept depth").Add(op.accept_depth);
}

// Adds the limits that are set, each under its name. A job without any of them keeps the digest that it had
// before they existed.
void AddLimits(const Job& job, Canonical& out) {
  const Selection& s = job.operation.selection;
  if (!s.patches.empty()) {
    out.Add("patches");
    AddNames(s.patches, out);
  }
  if (!s.avoid.empty()) {
    out.Add("avoid").Add(s.avoid_margin);
    AddNames(s.avoid, out);
  }
  if (!s.boundary.empty()) {
    out.Add("boundary").Add(static_cast<std::int64_t>(s.boundary_mode)).Add(s.boundary_offset);
    out.Add(static_cast<std::int64_t>(s.boundary.size()));
    for (const Ring& ring : s.boundary) AddRing(ring, out);
  }
  if (s.mill_outside) out.Add("outside");
  if (job.operation.detail != Operation().detail) out.Add("detail").Add(job.operation.detail);
  if (!job.operation.regions_sha256.empty()) out.Add("regions").Add(job.operation.regions_sha256);
  for (const RegionOverride& change : job.operation.overrides) {
    out.Add("override").Add(std::int64_t{change.region.value}).Add(std::int64_t{change.skip});
    AddPoint(change.at.value_or(Vec3::Zero()), out);
    out.Add(change.strategy ? static_cast<std::int64_t>(*change.strategy) : -1);
    AddOptional(change.zigzag_angle, out);
    AddOptional(change.scallop, out);
    if (change.one_way) out.Add("one way").Add(std::int64_t{*change.one_way});
  }
  if (job.setup.up_auto) out.Add("up auto");
  if (!job.setup.up_face.empty()) out.Add("up face").Add(job.setup.up_face);
  if (job.setup.cap_holes) out.Add("cap holes").Add(*job.setup.cap_holes);
  if (job.operation.one_way) out.Add("one way");
  AddStock(job.setup, out);
  if (job.setup.machine) AddMachine(*job.setup.machine, out);
  AddMotion(job.operation, out);
  if (job.operation.spirals) out.Add("spirals");
  if (!job.operation.border_passes) out.Add("no border passes");
  if (!job.operation.round_lines) out.Add("no round lines");
  if (job.operation.angle_auto) out.Add("angle auto");
  if (job.operation.top_z) out.Add("top").Add(*job.operation.top_z);
  for (const ObstacleOutline& o : job.setup.obstacles) {
    out.Add("obstacle").Add(o.id).Add(o.top_z).Add(o.margin);
    AddRing(o.outline, out);
  }
}

// What differs from the post that Patchmill brings along under this name.
void AddPost(const Job& job, Canonical& out) {
  const Dialect* known = FindDialect(job.dialect.name);
  if (known == nullptr || known->text != job.dialect.text) out.Add(job.dialect.text);
  if (job.program_number != 1) out.Add(std::int64_t{job.program_number});
  if (job.control_deviation) out.Add(*job.control_deviation);
  if (!job.arcs) out.Add("straight moves only");
  if (job.unit == ProgramUnit::kInch) out.Add("inch");
  if (job.restart_points) out.Add("restart points");
  if (job.line_number_step.value_or(job.dialect.line_number_step) != job.dialect.line_number_step)
    out.Add("line numbers").Add(std::int64_t{*job.line_number_step});
}

}  // namespace

std::string ModelDigest(const PatchModel& model) {
  Canonical out;
  out.Add("patchmill model 1").Add(model.join_tolerance.value_or(-1.0));
  out.Add(static_cast<std::int64_t>(model.patches.size()));
  for (const Patch& patch : model.patches) {
    out.Add(patch.id);
    std::visit([&](const auto& shape) { AddShape(shape, out); }, patch.shape);
  }
  AddFaces(model, out);
  return out.Digest();
}

std::string PlacementDigest(const Setup& setup, std::string_view model_digest) {
  Canonical out;
  out.Add("patchmill placement 1").Add(model_digest);
  AddPlacement(setup.placement, out);
  AddWallSides(setup.wall_sides, out);
  if (setup.cap_holes) out.Add("cap holes").Add(*setup.cap_holes / setup.placement.scale);
  return out.Digest();
}

std::string JobDigest(const Job& job, std::string_view model_digest, std::string_view name) {
  Canonical out;
  out.Add("patchmill job 1").Add(model_digest).Add(name);
  const Setup& setup = job.setup;
  AddPlacement(setup.placement, out);
  out.Add(static_cast<std::int64_t>(setup.zero));
  AddPoint(setup.zero_point, out);
  AddOptional(setup.stock_top_z, out);
  out.Add(setup.allowance.walls);
  const Operation& op = job.operation;
  const Tool& tool = op.tool;
  out.Add(std::int64_t{tool.number}).Add(tool.name).Add(BallRadius(tool));
  AddOptional(tool.flute_length, out);
  AddOptional(tool.shank_diameter, out);
  AddOptional(tool.stickout, out);
  if (!tool.holder.empty()) {
    out.Add("holder").Add(tool.holder_clearance);
    for (const HolderSegment& segment : tool.holder)
      out.Add(segment.length).Add(segment.lower_diameter).Add(segment.upper_diameter);
  }
  out.Add(tool.spindle_rpm).Add(tool.feed).Add(tool.plunge_feed).Add(static_cast<std::int64_t>(tool.coolant));
  out.Add(op.scallop).Add(op.tolerance).Add(op.leave).Add(op.steep_angle);
  out.Add(static_cast<std::int64_t>(op.strategy)).Add(op.zigzag_angle).Add(op.zigzag_bend);
  out.Add(static_cast<std::int64_t>(op.contour_direction)).Add(static_cast<std::int64_t>(op.edge_rule));
  AddOptional(op.clearance_z, out);
  AddOptional(op.clearance_z ? op.clearance_above : op.clearance_above.value_or(kDefaultClearanceAbove), out);
  AddOptional(op.floor_z, out);
  out.Add(op.approach_gap).Add(job.dialect.name).Add(job.work_offset);
  AddPost(job, out);
  if (job.default_tool_number) out.Add("tool number assumed");
  out.Add(std::int64_t{job.default_cutting_data}).Add(std::int64_t{job.unitless_file});
  AddLimits(job, out);
  return out.Digest();
}

}  // namespace patchmill
