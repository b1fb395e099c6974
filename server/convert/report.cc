#include "server/convert/report.h"

#include <algorithm>
#include <cmath>
#include <unordered_set>

#include <fmt/format.h>

#include "cam/plan/job_findings.h"
#include "cam/post/program_assumptions.h"
#include "cam/region/map/regions_digest.h"
#include "server/convert/enums.h"
#include "server/convert/setup.h"
#include "server/digest.h"
#include "server/limits.h"

namespace patchmill {
namespace {

// JSON has no NaN and no infinity. A value that does not exist becomes zero, or is left out if the field is
// optional.
double Number(double x) { return std::isfinite(x) ? x : 0.0; }

v1::CheckState State(bool ok) { return ok ? v1::CHECK_STATE_PASSED : v1::CHECK_STATE_FAILED; }

void AddTimes(const ToolpathTimes& times, v1::Report& report) {
  for (const MoveKind kind : Enumerators<MoveKind>()) {
    if (times.of_kind[kind] <= 0.0) continue;
    v1::TimeOfKind& to = *report.add_times_of_kinds();
    to.set_kind(ToProto(kind));
    to.set_time_s(Number(times.of_kind[kind]));
  }
  for (const double time : times.of_region) report.add_region_time_s(Number(time));
}

v1::LeadFigures LeadsToProto(const std::vector<LeadFigure>& leads) {
  v1::LeadFigures proto;
  double least = kInfinity;
  for (const LeadFigure& lead : leads) {
    if (lead.kind != LeadKind::kArc && lead.kind != LeadKind::kBack) continue;
    least = std::min(least, lead.radius);
  }
  for (const LeadFigure& lead : leads) {
    switch (lead.kind) {
      case LeadKind::kBack:
        proto.set_back_count(proto.back_count() + 1);
        [[fallthrough]];
      case LeadKind::kArc:
        proto.set_arc_count(proto.arc_count() + 1);
        if (lead.whole) proto.set_whole_radius_count(proto.whole_radius_count() + 1);
        break;
      case LeadKind::kRamp:
        proto.set_ramp_count(proto.ramp_count() + 1);
        break;
      case LeadKind::kStraight:
        if (lead.in) {
          proto.set_steep_count(proto.steep_count() + 1);
        } else {
          proto.set_straight_out_count(proto.straight_out_count() + 1);
        }
        break;
    }
  }
  if (proto.arc_count() > 0) proto.set_least_radius_mm(least);
  return proto;
}

v1::Place PlaceToProto(const VerifyPlace& place, const Vec3& zero) {
  v1::Place proto;
  *proto.mutable_point() = ToProto(Vec3(place.point - zero));
  proto.set_patch_id(Utf8(place.patch_id));
  proto.set_face_id(Utf8(place.face_id));
  proto.set_patch_index(place.patch_index);
  proto.set_line(place.line);
  return proto;
}

constexpr UnreachableReason kReasons[] = {UnreachableReason::kUndercut, UnreachableReason::kConcave,
                                          UnreachableReason::kFloor,    UnreachableReason::kAvoided,
                                          UnreachableReason::kStrategy, UnreachableReason::kShank,
                                          UnreachableReason::kHolder,   UnreachableReason::kOutside};

// Without a program nothing was verified. The unreachable areas then come from the regions.
void FillUnreachableFromRegions(const JobReport& from, const Vec3& zero, v1::Report* report) {
  const std::vector<Region>& regions = from.regions;
  const auto skipped = [&](const Region& region) { return from.choices[region.id.index()].skip; };
  const auto area = [&](const Region& region) {
    return Number(region.area * from.figures[region.id.index()].selected_share);
  };
  double unreachable = 0.0, reachable = 0.0;
  for (const UnreachableReason reason : kReasons) {
    v1::UnreachablePart part;
    for (const Region& region : regions) {
      if (region.reason != reason || skipped(region) || !(area(region) > 0.0)) continue;
      part.set_area_mm2(part.area_mm2() + area(region));
      if (region.deepest_leftover >= part.deepest_leftover_mm()) {
        part.set_deepest_leftover_mm(Number(region.deepest_leftover));
        *part.mutable_deepest_at()->mutable_point() = ToProto(Vec3(region.inside - zero));
        part.mutable_deepest_at()->set_patch_index(-1);
      }
    }
    if (part.area_mm2() <= 0.0) continue;
    part.set_reason(ToProto(reason));
    unreachable += part.area_mm2();
    *report->add_unreachable() = std::move(part);
  }
  for (const Region& region : regions) {
    if (region.reason == UnreachableReason::kNone && !skipped(region)) reachable += area(region);
  }
  report->set_unreachable_area_mm2(unreachable);
  report->set_reachable_area_mm2(reachable);
  report->set_total_area_mm2(unreachable + reachable);
}

void AddLeftoverClasses(const VerifyReport& verify, v1::Report* report) {
  double all = 0.0;
  for (const double area : verify.leftover_area) all += area;
  for (std::size_t k = 0; k < kLeftoverClasses; ++k) {
    v1::LeftoverClass& to = *report->add_leftover_classes();
    if (k < kLeftoverEdges.size()) to.set_up_to_scallops(kLeftoverEdges[k]);
    to.set_area_mm2(Number(verify.leftover_area[k]));
    to.set_fraction(all > 0.0 ? Number(verify.leftover_area[k] / all) : 0.0);
  }
}

void SetChoice(const RegionChoice& choice, SlopeClass slope, const Vec3& zero, v1::Region& proto) {
  Strategy strategy = choice.strategy;
  if (strategy == Strategy::kAuto) {
    strategy = slope == SlopeClass::kSteep ? Strategy::kContour : Strategy::kZigzag;
  }
  proto.set_strategy(ToProto(strategy));
  proto.set_scallop_mm(choice.scallop);
  for (const CircularComponent& round : choice.around) {
    v1::Point2& center =
        proto.has_lines_around() ? *proto.add_more_lines_around() : *proto.mutable_lines_around();
    center.set_x_mm(round.lines.center.x() - zero.x());
    center.set_y_mm(round.lines.center.y() - zero.y());
  }
  if (strategy != Strategy::kZigzag || choice.all_circular) return;
  proto.set_zigzag_angle_deg(Degrees(choice.zigzag_angle));
  proto.set_one_way_lines(choice.one_way);
}

// The faces that the region has a part of, in the order of the patches.
void AddFaceIds(const Region& region, const std::vector<std::string>& face_ids, v1::Region& proto) {
  std::unordered_set<std::string_view> met;
  for (const PatchId patch : region.patches) {
    const std::string& id = face_ids[patch.index()];
    if (!id.empty() && met.insert(id).second) proto.add_face_ids(Utf8(id));
  }
}

}  // namespace

v1::Diagnostic ToProto(const Diagnostic& diagnostic, const Vec3& zero) {
  v1::Diagnostic proto;
  proto.set_code(Utf8(diagnostic.code));
  proto.set_severity(ToProto(diagnostic.severity));
  proto.set_message(Utf8(diagnostic.message));
  const Where& from = diagnostic.where;
  v1::Where& where = *proto.mutable_where();
  where.set_patch_id(Utf8(from.patch_id));
  if (from.patch_index) where.set_patch_index(*from.patch_index);
  if (from.uv && from.uv->allFinite()) {
    where.set_u(from.uv->x());
    where.set_v(from.uv->y());
  }
  if (from.point && from.point->allFinite()) *where.mutable_point() = ToProto(Vec3(*from.point - zero));
  if (from.region_id) where.set_region_id(*from.region_id);
  if (from.line) where.set_line(*from.line);
  where.set_field(Utf8(from.field));
  where.set_face_id(Utf8(from.face_id));
  return proto;
}

void AddDiagnostics(const Diagnostics& from, const Vec3& zero,
                    google::protobuf::RepeatedPtrField<v1::Diagnostic>* to) {
  const std::size_t count = std::min(from.size(), limits::kMaxDiagnostics);
  for (std::size_t i = 0; i < count; ++i) *to->Add() = ToProto(from[i], zero);
  if (count < from.size()) {
    *to->Add() = ToProto(
        MakeInfo("MORE_FINDINGS", fmt::format("{} more findings are not listed", from.size() - count)), zero);
  }
}

v1::Box ToProto(const Box3& box, const Vec3& zero) {
  v1::Box proto;
  if (box.Empty()) return proto;
  *proto.mutable_min() = ToProto(Vec3(box.min - zero));
  *proto.mutable_max() = ToProto(Vec3(box.max - zero));
  return proto;
}

void AddPoints(const std::vector<Vec3>& points, const Vec3& zero,
               google::protobuf::RepeatedField<double>* to) {
  to->Reserve(to->size() + static_cast<int>(3 * points.size()));
  for (const Vec3& p : points) {
    for (int k = 0; k < 3; ++k) to->Add(Number(p[k] - zero[k]));
  }
}

v1::Region ToProto(const Region& region, const RegionChoice& choice, const RegionFigures& figures,
                   const Vec3& zero, Detail detail) {
  v1::Region proto;
  proto.set_id(region.id.value);
  proto.set_kind(ToProto(region.kind));
  proto.set_area_mm2(Number(region.area));
  proto.set_selected_area_mm2(Number(region.area * figures.selected_share));
  *proto.mutable_inside_point() = ToProto(Vec3(region.inside - zero));
  proto.set_min_z_mm(Number(region.z_min - zero.z()));
  proto.set_max_z_mm(Number(region.z_max - zero.z()));
  if (region.reason != UnreachableReason::kNone) {
    proto.set_unreachable_reason(ToProto(region.reason));
    proto.set_largest_tool_diameter_mm(Number(region.largest_tool_diameter));
    proto.set_deepest_leftover_mm(Number(region.deepest_leftover));
  }
  if (region.kind != RegionKind::kUnreachable) {
    proto.set_slope(ToProto(region.slope));
    proto.set_step_min_mm(Number(figures.step_min));
    proto.set_step_max_mm(Number(figures.step_max));
    if (!choice.skip) {
      SetChoice(choice, region.slope, zero, proto);
      proto.set_cut_otherwise_area_mm2(Number(region.area * figures.otherwise_share));
    }
  }
  proto.set_skipped(choice.skip);
  if (detail == Detail::kFigures) return proto;
  for (const PatchId patch : region.patches) proto.add_patch_index(patch.value);
  for (const std::vector<Vec3>& loop : region.border)
    AddPoints(loop, zero, proto.add_border()->mutable_points_mm());
  return proto;
}

google::protobuf::RepeatedPtrField<std::string> PatchIds(const PatchModel& model) {
  google::protobuf::RepeatedPtrField<std::string> ids;
  const auto named = [](const Patch& patch) { return !patch.id.empty(); };
  if (std::none_of(model.patches.begin(), model.patches.end(), named)) return ids;
  for (const Patch& patch : model.patches) *ids.Add() = Utf8(patch.id);
  return ids;
}

std::vector<std::string> FaceIds(const PatchModel& model) {
  std::vector<std::string> ids;
  if (model.faces.empty()) return ids;
  for (const Patch& patch : model.patches)
    ids.push_back(patch.face ? model.faces[patch.face->index()].id : std::string());
  return ids;
}

v1::RegionMap ToProto(const RegionMap& map, const std::vector<RegionChoice>& choices,
                      const std::vector<RegionFigures>& figures, const Vec3& zero,
                      const std::vector<std::string>& face_ids) {
  v1::RegionMap proto;
  proto.set_regions_sha256(RegionsDigest(map));
  for (std::size_t id = 0; id < map.regions.size(); ++id) {
    v1::Region& region = *proto.add_regions();
    region = ToProto(map.regions[id], choices[id], figures[id], zero, Detail::kAll);
    if (!face_ids.empty()) AddFaceIds(map.regions[id], face_ids, region);
  }
  for (const BorderLine& line : map.border_lines) {
    v1::BorderLine& border = *proto.add_border_lines();
    border.set_kind(ToProto(line.kind));
    border.set_region_id(line.region.value);
    border.set_other_region_id(line.other.value);
    border.set_closed(line.closed);
    if (!line.closed) {
      border.set_from_node(line.from);
      border.set_to_node(line.to);
    }
    AddPoints(line.points, zero, border.mutable_points_mm());
  }
  for (const Vec3& node : map.nodes) *proto.add_nodes() = ToProto(Vec3(node - zero));
  return proto;
}

v1::SetupSheet ToProto(const Resolved& resolved, const Job& job) {
  const Vec3& zero = resolved.program_zero;
  v1::SetupSheet sheet;
  *sheet.mutable_program_zero() = ToProto(zero);
  sheet.set_work_offset(job.work_offset);
  sheet.set_tool_number(job.operation.tool.number);
  sheet.set_tool_diameter_mm(2.0 * resolved.radius);
  sheet.set_clearance_z_mm(Number(resolved.clearance_z - zero.z()));
  sheet.set_floor_z_mm(Number(resolved.floor_z - zero.z()));
  sheet.set_stock_top_z_mm(Number(resolved.stock_top_z - zero.z()));
  const StockDepth& allowance = job.setup.allowance;
  sheet.set_stock_allowance_mm(allowance.Most());
  if (!allowance.IsOne()) {
    sheet.set_stock_wall_allowance_mm(allowance.walls);
    sheet.set_stock_floor_allowance_mm(allowance.floors);
  }
  *sheet.mutable_model_box() = ToProto(resolved.box, zero);
  if (resolved.stock_box) *sheet.mutable_stock_model_box() = ToProto(*resolved.stock_box, zero);
  return sheet;
}

void FillFromVerifier(const VerifyReport& verify, const Vec3& zero, bool scallop_judged, v1::Report* report) {
  report->set_gouge_check(State(verify.gouge_ok));
  report->set_finish_check(scallop_judged ? State(verify.finish_ok) : v1::CHECK_STATE_NOT_CHECKED);
  report->set_motion_check(State(verify.motion_ok));
  report->set_holder_check(verify.holder_ok ? State(*verify.holder_ok) : v1::CHECK_STATE_NOT_CHECKED);
  const bool in_stock = std::any_of(verify.findings.begin(), verify.findings.end(), [](const Diagnostic& d) {
    return d.code == "RAPID_IN_STOCK" || d.code == "RAPID_DOG_LEG";
  });
  report->set_stock_check(State(!in_stock));
  for (std::string& code : AssumptionCodes(verify.findings)) report->add_assumption_codes(std::move(code));
  report->set_max_gouge_mm(Number(verify.max_gouge));
  *report->mutable_max_gouge_at() = PlaceToProto(verify.max_gouge_at, zero);
  report->set_max_leftover_mm(Number(verify.max_leftover));
  *report->mutable_max_leftover_at() = PlaceToProto(verify.max_leftover_at, zero);
  report->set_leftover_above_limit_area_mm2(Number(verify.leftover_above_limit_area));
  report->set_tip_z_min_mm(Number(verify.tip_z_min));
  if (!verify.tip_box.Empty()) *report->mutable_tip_box() = ToProto(verify.tip_box, Vec3::Zero());
  report->set_required_stickout_mm(Number(verify.required_stickout));
  report->set_reachable_area_mm2(Number(verify.reachable_area));
  report->set_total_area_mm2(Number(verify.total_area));
  report->set_underside_area_mm2(Number(verify.underside_area));
  double unreachable = 0.0;
  for (const UncutReason reason : Enumerators<UncutReason>()) {
    const double area = Number(verify.unreachable_area[reason]);
    if (area <= 0.0) continue;
    unreachable += area;
    v1::UnreachablePart& part = *report->add_unreachable();
    part.set_reason(ToProto(reason));
    part.set_area_mm2(area);
    part.set_deepest_leftover_mm(Number(verify.deepest_unreachable[reason]));
    *part.mutable_deepest_at() = PlaceToProto(verify.deepest_unreachable_at[reason], zero);
    if (reason == UncutReason::kFloor && verify.finishing_floor_z) {
      // Rounded down again: program zero may lie between thousandths.
      part.set_finishing_floor_z_mm(std::floor((*verify.finishing_floor_z - zero.z()) * 1e3) / 1e3);
    }
    if (reason == UncutReason::kShank && verify.finishing_flute_length) {
      part.set_finishing_flute_length_mm(*verify.finishing_flute_length);
    }
    if (reason == UncutReason::kHolder && verify.finishing_stickout) {
      part.set_finishing_stickout_mm(*verify.finishing_stickout);
    }
  }
  report->set_unreachable_area_mm2(unreachable);
  if (scallop_judged) AddLeftoverClasses(verify, report);
  report->set_cut_length_mm(Number(verify.cut_length));
  report->set_rapid_length_mm(Number(verify.rapid_length));
  report->set_feed_block_count(verify.feed_blocks);
  report->set_arc_block_count(verify.arc_blocks);
  report->set_points_per_mm(verify.cut_length > 0.0 ? Number(verify.feed_blocks / verify.cut_length) : 0.0);
  report->set_steepest_descent_deg(Number(Degrees(verify.steepest_descent)));
}

// The search of a region may stop a twentieth above its deepest place (Region.deepest_leftover_mm), and
// the verifier samples. The region of that reason on the patch of the verifier's deepest place, and the
// part of the report, get the larger of the two figures. STRATEGY is left out: there the region has an
// estimate of what a program would leave, and the verifier has what this program leaves. So are areas that
// are selected in part.
void AgreeOnDepths(const std::vector<Region>& regions, v1::Report& report) {
  for (v1::UnreachablePart& part : *report.mutable_unreachable()) {
    if (part.reason() == v1::UNREACHABLE_REASON_STRATEGY) continue;
    const PatchId patch(part.deepest_at().patch_index());
    v1::Region* deepest = nullptr;
    bool whole = true;  // all areas with this reason are selected
    for (v1::Region& region : *report.mutable_regions()) {
      if (region.unreachable_reason() != part.reason() || region.skipped()) continue;
      whole = whole && region.selected_area_mm2() == region.area_mm2();
      const std::vector<PatchId>& patches = regions[static_cast<std::size_t>(region.id())].patches;
      const bool holds = std::binary_search(patches.begin(), patches.end(), patch);
      if (holds && (deepest == nullptr || region.deepest_leftover_mm() > deepest->deepest_leftover_mm()))
        deepest = &region;
    }
    if (deepest == nullptr || !whole) continue;
    const double depth = std::max(deepest->deepest_leftover_mm(), part.deepest_leftover_mm());
    deepest->set_deepest_leftover_mm(depth);
    part.set_deepest_leftover_mm(depth);
  }
}

v1::Report ToProto(const JobReport& from, const Job& job, const Resolved& resolved,
                   std::string_view program) {
  v1::Report report;
  const Vec3& zero = resolved.program_zero;
  report.set_outcome(ToProto(from.outcome));
  if (from.outcome == Outcome::kNothingToCut || from.outcome == Outcome::kNeedsRoughing) {
    report.set_gouge_check(v1::CHECK_STATE_NOT_CHECKED);
    report.set_finish_check(v1::CHECK_STATE_NOT_CHECKED);
    report.set_motion_check(v1::CHECK_STATE_NOT_CHECKED);
    report.set_holder_check(v1::CHECK_STATE_NOT_CHECKED);
    report.set_stock_check(v1::CHECK_STATE_NOT_CHECKED);
    FillUnreachableFromRegions(from, zero, &report);
  } else {
    FillFromVerifier(from.verify, zero, /*scallop_judged=*/true, &report);
  }
  *report.mutable_setup_sheet() = ToProto(resolved, job);
  for (const Diagnostic& d : from.diagnostics)
    if (IsToCheckBeforeStart(d.code)) report.add_check_before_start_codes(d.code);
  if (std::isfinite(from.min_concave_radius)) report.set_min_concave_radius_mm(from.min_concave_radius);
  report.set_estimated_time_s(Number(from.times ? from.times->total : from.motion.time));
  report.set_time_basis(from.times ? "accelerations" : "feeds only");
  if (from.times) AddTimes(*from.times, report);
  report.set_least_cut_length_mm(Number(from.least_cut_length));
  report.set_point_count(from.point_count);
  report.set_retract_count(from.motion.retract_count);
  *report.mutable_leads() = LeadsToProto(from.leads);
  report.set_rapids_saved_by_stated_stock_mm(
      StockIsStated(job.setup) ? 0.0 : Number(from.motion.saved_by_low_rapids));
  report.set_corner_feed_length_mm(Number(from.motion.corner_length));
  report.set_certificate_defect_count(static_cast<int>(from.certificate_defects));
  for (std::size_t id = 0; id < from.regions.size(); ++id) {
    *report.add_regions() =
        ToProto(from.regions[id], from.choices[id], from.figures[id], zero, Detail::kFigures);
  }
  AgreeOnDepths(from.regions, report);
  AddDiagnostics(from.diagnostics, zero, report.mutable_diagnostics());
  for (const StageTime& stage : from.stages) {
    v1::Stage& to = *report.add_stages();
    to.set_name(stage.name);
    to.set_seconds(Number(stage.seconds));
  }
  report.set_program_size_bytes(static_cast<int>(program.size()));
  if (!program.empty()) report.set_program_sha256(Sha256(program));
  report.set_controller_tolerance_mm(Number(from.controller_tolerance));
  return report;
}

}  // namespace patchmill
