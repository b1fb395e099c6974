#include "cam/path/contour/contour_paths.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include "cam/path/chord/certify_centers.h"
#include "cam/path/chord/chord_thinning.h"
#include "cam/path/contour/contour_findings.h"
#include "cam/path/contour/contour_levels.h"
#include "cam/path/contour/contour_samples.h"
#include "cam/path/contour/level_groups.h"
#include "cam/path/contour/level_heights.h"
#include "cam/path/contour/loop_clip.h"
#include "cam/path/stepover/step_over.h"
#include "cam/path/zlevel/level_trace.h"
#include "cam/toolpath/counted_loop.h"
#include "core/base/parallel.h"
#include "core/base/status.h"

namespace patchmill {
namespace {

// Ball radii: contours are traced this far from the samples of their group, half way around a knife's edge.
constexpr double kBesideSamples = 1.5;
// Gap between the order keys of two families: their passes are no neighbours (order_passes.h).
constexpr int kBetweenFamilies = 4;
constexpr double kSameHeight = 1e-6;  // mm

struct LevelPasses {
  std::vector<CutterPath> paths;
  LevelContours level;  // without its loops
};

// The levels of one group, or of several groups that need the same levels.
struct LevelFamily {
  std::vector<PlannedLevel> levels;
  std::vector<Vec3> centers;           // centres of their samples
  std::optional<NearSpotsMask> where;  // places where their contours may run; none: everywhere
};

bool SameLevels(const std::vector<PlannedLevel>& a, const std::vector<PlannedLevel>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const PlannedLevel& x, const PlannedLevel& y) {
    return x.partial == y.partial && std::abs(x.z - y.z) <= kSameHeight;
  });
}

struct LevelFamilies {
  std::vector<LevelFamily> families;    // [family]
  std::vector<LevelFamilyId> of_group;  // [group]
  std::size_t levels = 0;
};

std::vector<double> FullLevels(const LevelFamily& family) {
  std::vector<double> heights;
  for (const PlannedLevel& level : family.levels) {
    if (!level.partial) heights.push_back(level.z);
  }
  return heights;
}

absl::StatusOr<LevelFamilies> PlanFamilies(const LevelGroups& groups, const ContourParams& params,
                                           double radius, const RunContext& run) {
  LevelFamilies planned;
  std::vector<LevelFamily>& families = planned.families;
  const double flat = HeightParamsOf(params, radius).flat;
  for (std::size_t k = 0; k < groups.size(); ++k) {
    const LevelGroupId group(k);
    std::optional<double> base_level;
    if (const auto& on = groups.base_level(group)) {
      const LevelFamilyId below = planned.of_group[on->group.index()];
      base_level = LevelBelow(FullLevels(families[below.index()]), on->below, flat);
    }
    PM_ASSIGN_OR_RETURN(std::vector<PlannedLevel> levels,
                        PlanLevels(groups[group], params, radius, base_level, run));
    const auto same = std::find_if(families.begin(), families.end(), [&](const LevelFamily& family) {
      return SameLevels(family.levels, levels);
    });
    const LevelFamilyId id(static_cast<std::size_t>(same - families.begin()));
    planned.of_group.push_back(id);
    if (same == families.end()) {
      planned.levels += levels.size();
      families.push_back({std::move(levels), {}, std::nullopt});
    } else {
      for (std::size_t i = 0; i < levels.size(); ++i) {
        std::vector<Vec3>& spots = same->levels[i].spots;
        spots.insert(spots.end(), levels[i].spots.begin(), levels[i].spots.end());
      }
    }
    for (const ContourSample& sample : groups[group].samples)
      families[id.index()].centers.push_back(sample.center);
  }
  if (families.size() > 1) {
    for (LevelFamily& family : families) family.where.emplace(family.centers, kBesideSamples * radius);
  }
  return planned;
}

// A level of a family, with its order key.
struct FamilyLevel {
  LevelFamilyId family;
  std::size_t level = 0;  // of the family
  int line = 0;
};

class PassTracer {
 public:
  PassTracer(const LevelContext& context, const LevelGroups& groups, const LevelFamilies& planned,
             const ContourParams& params, const RunContext& run)
      : context_(context),
        groups_(groups),
        families_(planned.families),
        family_of_(planned.of_group),
        params_(params),
        run_(run) {}

  LevelPasses At(const FamilyLevel& at) const {
    const LevelFamily& family = families_[at.family.index()];
    const PlannedLevel& planned = family.levels[at.level];
    ClipParams clip;
    clip.window = params_.pass.window;
    clip.roll = params_.pass.roll;
    clip.overlap = 0.5 * CenterStep(context_.locator.radius(), params_.pass.scallop, 0.0);
    std::optional<NearSpotsMask> near_spots;
    if (planned.partial) {
      clip.spots = planned.spots;
      clip.near = ReachOfSpot(groups_[LevelGroupId(0)].spacing, planned.gap);
      near_spots.emplace(planned.spots, clip.near + 2.0 * clip.overlap);
    }
    const std::optional<NearSpotsMask>& where = near_spots ? near_spots : family.where;
    LevelPasses passes{{}, TracePasses(context_, planned.z, where ? &*where : nullptr, params_, run_)};
    const std::vector<CutterPath> loops = std::exchange(passes.level.loops, {});
    for (const CutterPath& loop : loops) {
      if (run_.Cancelled()) break;
      for (CutterPath& part : ClipLoop(context_, loop, clip)) {
        if (families_.size() > 1 && groups_.FamilyUnder(part, family_of_) != at.family) continue;
        CertifyCenters(context_.locator, CertificateGap(params_.pass), part);
        part.order_key = at.line;
        passes.paths.push_back(std::move(part));
      }
    }
    return passes;
  }

 private:
  const LevelContext& context_;
  const LevelGroups& groups_;
  const std::vector<LevelFamily>& families_;
  const std::vector<LevelFamilyId>& family_of_;  // [group]
  const ContourParams& params_;
  const RunContext& run_;
};

}  // namespace

absl::StatusOr<ContourResult> ContourPaths(const Locator& locator, const ContourParams& params,
                                           const RunContext& run) {
  const LevelContext context(locator, run);
  PM_RETURN_IF_ERROR(run.Check());
  PM_ASSIGN_OR_RETURN(ContourArea contour_area, SampleContourArea(context, params, run));
  const double radius = locator.radius();
  const HeightParams heights = HeightParamsOf(params, radius);
  const auto contours = [&](double z) -> std::vector<CutterPath> {
    std::vector<Vec3> here;  // elsewhere this height has no passes, and none that are connected
    for (const ContourSample& s : contour_area.samples) {
      if (z > s.center.z() - s.below - heights.flat && z < s.center.z() + s.above + heights.flat)
        here.push_back(s.center);
    }
    if (here.empty()) return {};
    const NearSpotsMask where(here, kBesideSamples * radius);
    return TracePasses(context, z, &where, params, run).loops;
  };
  PM_ASSIGN_OR_RETURN(LevelGroups groups, LevelGroups::Make(contour_area, heights, contours, run));
  PM_ASSIGN_OR_RETURN(LevelFamilies planned, PlanFamilies(groups, params, radius, run));
  if (planned.levels > kMostLevels) {  // apart the groups need too many; as one they may need fewer
    groups = LevelGroups(std::move(contour_area));
    PM_ASSIGN_OR_RETURN(planned, PlanFamilies(groups, params, radius, run));
  }
  if (planned.levels > kMostLevels) {
    return TooManyLevels(static_cast<double>(planned.levels));
  }
  const std::vector<LevelFamily>& families = planned.families;
  std::vector<FamilyLevel> levels;
  int line = 0;
  for (std::size_t k = 0; k < families.size(); ++k) {
    for (std::size_t i = 0; i < families[k].levels.size(); ++i)
      levels.push_back({LevelFamilyId(k), i, line++});
    line += kBetweenFamilies;
  }
  const PassTracer tracer(context, groups, planned, params, run);
  std::vector<LevelPasses> passes(levels.size());
  PM_RETURN_IF_ERROR(CountedFor(run, "contours", levels.size(), params.pass.budget, [&](std::size_t i) {
    passes[i] = tracer.At(levels[i]);
    return AmountOf(passes[i].paths);
  }));
  PM_RETURN_IF_ERROR(run.Check());
  ContourResult result;
  ContourFindings findings(params.resolution);
  for (LevelPasses& of : passes) {
    for (CutterPath& path : of.paths) result.paths.push_back(std::move(path));
    findings.Take(of.level);
  }
  result.findings = findings.Findings();
  return result;
}

}  // namespace patchmill
