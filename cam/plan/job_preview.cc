#include "cam/plan/job_preview.h"

#include <fmt/format.h>

#include "cam/picture/preview.h"

namespace patchmill {
namespace {

// Mountain red, basin blue, neutral green; steep stronger than gentle; neighbours of one class differ a
// little in lightness.
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
      set(120, 120, 120);
      break;
  }
  const int shift = (nth % 3 - 1) * 9;
  for (int& c : rgb) c = std::clamp(c + shift, 0, 255);
  return fmt::format("#{:02x}{:02x}{:02x}", rgb[0], rgb[1], rgb[2]);
}

PreviewInput BaseInput(const Surface& surface, const RegionMap& map, const std::string& title) {
  PreviewInput input;
  input.surface = &surface;
  input.title = title;
  int nth = 0;
  for (const Region& region : map.regions) {
    PreviewRegion r;
    r.unreachable = region.kind == RegionKind::kUnreachable;
    r.color = Color(region, nth++);
    r.name = r.unreachable
                 ? fmt::format("{} unreachable, {}: {:.1f} mm2", region.id, Name(region.reason), region.area)
                 : fmt::format("{} {}, {}: {:.1f} mm2", region.id, Name(region.kind), Name(region.slope),
                               region.area);
    r.border = region.border;
    input.regions.push_back(std::move(r));
  }
  input.region_of = [&map](const SurfacePoint& p) { return map.At(p); };
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
  }
  return "";
}

std::string DrawRegions(const Surface& surface, const RegionMap& regions, const std::string& title) {
  return DrawPreview(BaseInput(surface, regions, title));
}

std::string DrawJob(const Surface& surface, const JobResult& result, const std::string& title) {
  PreviewInput input = BaseInput(surface, result.regions, title);
  input.toolpath = &result.motion.toolpath;
  input.program_zero = result.program_zero;
  for (const CutterPath& pass : result.motion.passes) input.pass_kinds.push_back(pass.kind);
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
