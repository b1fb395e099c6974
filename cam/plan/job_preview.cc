#include "cam/plan/job_preview.h"

#include <algorithm>
#include <memory>
#include <optional>

#include <fmt/format.h>

#include "cam/picture/preview.h"
#include "cam/plan/program_sections.h"

namespace patchmill {
namespace {

// Mountain red, basin blue, neutral green; steep stronger than gentle; out of reach grey, violet where the
// ball is too large, brown below the floor, teal under a wide shank, steel blue under the holder; what
// forced passes leave yellow; neighbours of one class differ a little in lightness.
std::string Color(const Region& region, int nth) {
  int rgb[3];
  const bool steep = region.slope == SlopeClass::kSteep;
  const auto set = [&](int r, int g, int b) {
    rgb[0] = r;
    rgb[1] = g;
    rgb[2] = b;
  };
  switch (region.kind) {
    case RegionKind::kMountain:
      steep ? set(230, 120, 95) : set(250, 205, 175);
      break;
    case RegionKind::kBasin:
      steep ? set(95, 145, 225) : set(180, 212, 250);
      break;
    case RegionKind::kNeutral:
      steep ? set(120, 185, 110) : set(205, 232, 195);
      break;
    case RegionKind::kUnreachable:
      region.reason == UnreachableReason::kConcave   ? set(150, 120, 165)
      : region.reason == UnreachableReason::kFloor   ? set(165, 150, 105)
      : region.reason == UnreachableReason::kShank   ? set(95, 145, 140)
      : region.reason == UnreachableReason::kHolder  ? set(70, 110, 150)
      : region.reason == UnreachableReason::kOutside ? set(175, 175, 180)
                                                     : set(120, 120, 120);
      break;
  }
  if (region.reason == UnreachableReason::kStrategy) set(245, 220, 90);
  const int shift = (nth % 3 - 1) * 9;
  for (int& c : rgb) c = std::clamp(c + shift, 0, 255);
  return fmt::format("#{:02x}{:02x}{:02x}", rgb[0], rgb[1], rgb[2]);
}

// The part of the surface that is to be finished: the selection without the skipped regions.
class WantedCells {
 public:
  WantedCells(const Surface& surface, const RegionMap& map, const std::vector<RegionChoice>& choices,
              const Containment& containment)
      : surface_(surface), containment_(containment), parts_(PartsOf(map, choices)) {}

  bool Has(const SurfacePoint& p) const {
    if (!IsWanted(containment_, surface_.piece(p.piece).patch, p.p)) return false;
    return std::any_of(parts_.begin(), parts_.end(), [&](const PlanPart& part) {
      return part.where == nullptr || part.where->Has(p.piece, p.u, p.v);
    });
  }

 private:
  const Surface& surface_;
  const Containment& containment_;
  std::vector<PlanPart> parts_;
};

// Which regions have a selected place, among up to about 2,000 cells of each: even the smallest is met.
std::vector<bool> SeenRegions(const Surface& surface, const RegionMap& map, const WantedCells& wanted) {
  constexpr std::size_t kMostCells = 2000;
  std::vector<std::size_t> cells(map.regions.size(), 0);
  std::vector<std::size_t> met(map.regions.size(), 0);
  for (const std::vector<RegionId>& labels : map.labels) {
    for (const RegionId id : labels) {
      if (id != kNoRegion) ++cells[id.index()];
    }
  }
  std::vector<bool> seen(map.regions.size(), false);
  for (std::size_t piece = 0; piece < map.labels.size(); ++piece) {
    for (int k = 0; k < map.cells * map.cells; ++k) {
      const RegionId label = map.labels[piece][static_cast<std::size_t>(k)];
      if (label == kNoRegion) continue;
      const std::size_t id = label.index();
      if (met[id]++ % (1 + cells[id] / kMostCells) != 0 || seen[id]) continue;
      const double u = (k / map.cells + 0.5) / map.cells, v = (k % map.cells + 0.5) / map.cells;
      const PieceId at(piece);
      seen[id] = wanted.Has({at, u, v, Evaluate(surface, at, u, v).p});
    }
  }
  return seen;
}

struct BorderStyle {
  BorderKind kind;
  const char* color;
  std::optional<Paint> on;
};
constexpr BorderStyle kBorderStyles[] = {{BorderKind::kReach, "#303030", std::nullopt},
                                         {BorderKind::kSlope, "#c2410c", Paint::kSlope},
                                         {BorderKind::kCurvature, "#0f766e", Paint::kCurvature},
                                         {BorderKind::kSilhouette, "#7c3aed", Paint::kCurvature},
                                         {BorderKind::kWatershed, "#1d4ed8", std::nullopt},
                                         {BorderKind::kSeam, "#be185d", std::nullopt},
                                         {BorderKind::kStrategy, "#854d0e", std::nullopt}};

double Length(const BorderLine& line) {
  double sum = line.closed ? (line.points.front() - line.points.back()).norm() : 0.0;
  for (std::size_t i = 1; i < line.points.size(); ++i) sum += (line.points[i] - line.points[i - 1]).norm();
  return sum;
}

// The borders of what is seen, by kind, also between two reasons, and the nodes on them. Open edges of the
// sheet are drawn anyway.
void AddBorders(const RegionMap& map, const std::vector<bool>& seen, PreviewInput& input) {
  const auto shown = [&](RegionId id) { return id != kNoRegion && seen[id.index()]; };
  std::vector<char> met(map.nodes.size(), 0);
  for (const BorderStyle& style : kBorderStyles) {
    PreviewLines drawn;
    double length = 0.0;
    for (const BorderLine& line : map.border_lines) {
      if (line.kind != style.kind || !(shown(line.region) || shown(line.other))) continue;
      length += Length(line);
      drawn.polylines.push_back(line.points);
      if (line.closed) drawn.polylines.back().push_back(line.points.front());
      for (const int node : {line.from, line.to}) {
        if (node >= 0) met[static_cast<std::size_t>(node)] = 1;
      }
    }
    if (drawn.polylines.empty()) continue;
    drawn.name = fmt::format("{}: {:.1f} mm", Name(style.kind), length);
    drawn.color = style.color;
    drawn.on = style.on;
    input.borders.push_back(std::move(drawn));
  }
  for (std::size_t i = 0; i < met.size(); ++i) {
    if (met[i]) input.nodes.push_back(map.nodes[i]);
  }
}

PreviewInput BaseInput(const Surface& surface, const RegionMap& map, const std::vector<RegionChoice>& choices,
                       const Resolved& resolved, const std::string& title) {
  PreviewInput input;
  input.surface = &surface;
  input.title = title;
  const auto wanted = std::make_shared<const WantedCells>(surface, map, choices, resolved.containment);
  const std::vector<bool> seen = SeenRegions(surface, map, *wanted);
  std::vector<int> index(map.regions.size(), -1);
  for (const Region& region : map.regions) {
    const std::size_t id = region.id.index();
    if (!seen[id]) continue;
    PreviewRegion r;
    const bool unreachable = region.reason != UnreachableReason::kNone;
    r.color = Color(region, region.id.value);
    r.area = region.area;
    r.label = fmt::format("{}", region.id.value);
    r.name = unreachable ? fmt::format("{} {}: {:.1f} mm2, {:.2f} mm stays", region.id.value,
                                       Name(region.reason), region.area, region.deepest_leftover)
                         : fmt::format("{} {}, {}: {:.1f} mm2", region.id.value, Name(region.kind),
                                       Name(region.slope), region.area);
    index[id] = static_cast<int>(input.regions.size());
    input.regions.push_back(std::move(r));
  }
  AddBorders(map, seen, input);
  input.region_of = [&map, wanted, index](const SurfacePoint& p) {
    const RegionId id = map.At(p);
    return id != kNoRegion && wanted->Has(p) ? index[id.index()] : -1;
  };
  return input;
}

}  // namespace

const char* Name(Outcome outcome) {
  switch (outcome) {
    case Outcome::kComplete:
      return "COMPLETE";
    case Outcome::kCompleteWhereReachable:
      return "COMPLETE_WHERE_REACHABLE";
    case Outcome::kNothingToCut:
      return "NOTHING_TO_CUT";
    case Outcome::kVerificationFailed:
      return "VERIFICATION_FAILED";
    case Outcome::kNeedsRoughing:
      return "NEEDS_ROUGHING";
    case Outcome::kTooMuchUnreached:
      return "TOO_MUCH_UNREACHED";
  }
  return "";
}

std::string DrawRegions(const Surface& surface, const ChosenRegions& regions, const Resolved& resolved,
                        double steep_angle, const std::string& title) {
  PreviewInput input = BaseInput(surface, regions.map, regions.chosen.choices, resolved, title);
  input.shadings = true;
  input.scales = {steep_angle, resolved.plan_radius};
  return DrawPreview(input);
}

std::string DrawJob(const Surface& surface, const JobResult& result, const Resolved& resolved,
                    const std::string& title) {
  PreviewInput input = BaseInput(surface, result.regions, result.report.choices, resolved, title);
  input.nodes.clear();  // passes are to be seen
  input.toolpath = &result.posted;
  input.program_zero = result.program_zero;
  for (const CutterPath& pass : result.motion.passes) input.pass_kinds.push_back(pass.kind);
  for (const ProgramSection& section :
       SectionsOf(result.posted, result.motion, result.regions, result.program_zero)) {
    if (!section.continued) input.section_passes.push_back(section.first_pass);
  }
  const VerifyReport& v = result.report.verify;
  double unreachable = 0.0;
  for (const double area : v.unreachable_area) unreachable += area;
  input.notes.push_back(fmt::format(
      "{}   largest gouge {:.4f} mm, largest leftover {:.4f} mm, unreachable {:.1f} of {:.1f} mm2",
      Name(result.report.outcome), v.max_gouge, v.max_leftover, unreachable, v.total_area));
  input.notes.push_back(
      fmt::format("{} passes, {:.1f} m of cutting, {} retracts, {:.1f} min at the given feeds",
                  result.motion.passes.size(), result.motion.stats.cut_length / 1000.0,
                  result.motion.stats.retract_count, result.motion.stats.time / 60.0));
  return DrawPreview(input);
}

}  // namespace patchmill
