#include "cam/path/contour/level_groups.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "cam/path/contour/level_branches.h"
#include "cam/path/stepover/cheapest_step.h"
#include "core/base/status.h"

namespace patchmill {
namespace {

// Sample spacings: contacts or centres this near to each other are connected.
constexpr double kReachOfSpacing = 3.0;
constexpr double kMostReach = 2.0;         // ball radii: largest reach for uneven spacing
constexpr double kMinGroupHeight = 2.0;    // flat step-overs: lower areas get no levels of their own
constexpr std::size_t kMostGroups = 256;   // smaller areas join the largest
constexpr double kRise = 6.0;              // flat step-overs: least height of a branch
constexpr std::size_t kMostBranches = 12;  // only the largest; smaller ones stay part of their trunk
constexpr double kRulingShare = 0.1;       // share of the surface that may need less than the ruling step
constexpr double kSameNeeds = 0.05;        // relative: steps that differ by less are the same
constexpr double kMaxOverlapLength = 1.0;  // ball radii: length of a contour that may lie over other areas
constexpr int kMostContours = 24;          // traced to see whether they part
constexpr double kLift = 1.5;              // ratio of successive lifts of a base level
constexpr double kMinBranchSaving =
    6.0;  // ball radii that a branch's own levels must save: the estimate's error

std::vector<Vec3> PointsOf(const ContourArea& contour_area, Vec3 ContourSample::*point) {
  std::vector<Vec3> points;
  points.reserve(contour_area.samples.size());
  for (const ContourSample& sample : contour_area.samples) points.push_back(sample.*point);
  return points;
}

}  // namespace

std::optional<double> LevelBelow(std::span<const double> heights, double height, double flat) {
  std::optional<double> highest;
  for (const double z : heights) {
    if (z <= height && z > height - kMostGap * flat && z > highest.value_or(-kInfinity)) highest = z;
  }
  return highest;
}

LevelGroups::LevelGroups(ContourArea all) {
  if (all.samples.empty()) return;
  groups_.push_back(std::move(all));
  base_levels_.emplace_back();
}

// Divides the samples into parts: the connected sets and the branches on them. Joins again the branches that
// do not pay.
class LevelGroups::Builder {
 public:
  Builder(const ContourArea& contour_area, const PointCells& centers, const HeightParams& params,
          const ContoursAt& contours, const RunContext& run)
      : area_(contour_area), centers_(centers), params_(params), contours_(contours), run_(run) {}

  // `set_of` is the set of each sample, counted from 0.
  absl::Status Divide(std::vector<std::size_t> set_of, std::size_t sets, std::vector<LevelBranch> branches) {
    part_of_ = std::move(set_of);
    parts_.resize(sets);
    for (std::size_t k = 0; k < branches.size(); ++k) {
      for (const std::size_t i : branches[k].samples) part_of_[i] = sets + k;
    }
    for (const LevelBranch& branch : branches)
      parts_.push_back({.on = Trunk{part_of_[branch.from], branch.base_level}});
    for (std::size_t i = 0; i < part_of_.size(); ++i) parts_[part_of_[i]].samples.push_back(i);
    for (const LowerEnd& end : area_.lower_ends)
      parts_[part_of_[*centers_.Nearest(end.center)]].ends.push_back(end);
    const std::size_t spared = branches.size() - std::min(branches.size(), kMostBranches);
    for (std::size_t k = 0; k < branches.size(); ++k) {
      run_.Progress("contours: branches", static_cast<double>(k) / static_cast<double>(branches.size()));
      if (k < spared || SameNeeds(sets + k) || !LiftBaseLevel(sets + k)) {
        Join(sets + k, Both(sets + k));
      } else {
        PM_RETURN_IF_ERROR(JoinUnlessShorter(sets + k));
      }
    }
    return absl::OkStatus();
  }

  // Puts the groups in order. A group comes after the one it stands on.
  void Put(LevelGroups& made) {
    std::vector<LevelGroupId> number(parts_.size());
    for (std::size_t left = 1; left > 0;) {
      left = 0;
      for (std::size_t k = 0; k < parts_.size(); ++k) {
        Part& part = parts_[k];
        if (part.samples.empty()) continue;
        if (part.on && !parts_[part.on->part].samples.empty()) {  // the part it stands on comes first
          ++left;
          continue;
        }
        number[k] = LevelGroupId(made.groups_.size());
        std::optional<BaseLevel>& base_level = made.base_levels_.emplace_back();
        if (part.on) base_level = BaseLevel{number[part.on->part], part.on->below};
        made.groups_.push_back(AreaOf(part));
        part.samples.clear();
      }
    }
    made.of_sample_.reserve(part_of_.size());
    for (const std::size_t part : part_of_) made.of_sample_.push_back(number[part]);
  }

 private:
  // The part on which a branch stands, and the height below which the level for it lies.
  struct Trunk {
    std::size_t part = 0;
    double below = 0.0;  // mm, of the centre
  };
  struct Part {  // becomes a group; without samples once it is joined
    std::optional<Trunk> on = std::nullopt;
    std::vector<std::size_t> samples = {};
    std::vector<LowerEnd> ends = {};
    std::optional<LevelPlan> plan = std::nullopt;  // without a base level
  };

  ContourArea AreaOf(const Part& part) const {
    ContourArea contour_area;
    contour_area.spacing = area_.spacing;
    contour_area.lower_ends = part.ends;
    contour_area.samples.reserve(part.samples.size());
    for (const std::size_t i : part.samples) contour_area.samples.push_back(area_.samples[i]);
    return contour_area;
  }

  absl::StatusOr<LevelPlan> LevelPlanOf(const Part& part, std::optional<double> base_level) const {
    HeightParams params = params_;
    params.base_level = base_level;
    return LevelHeights(AreaOf(part), params, run_);
  }

  // Returns part k together with the part it stands on.
  Part Both(std::size_t k) const {
    Part both = parts_[parts_[k].on->part];
    const Part& branch = parts_[k];
    both.samples.insert(both.samples.end(), branch.samples.begin(), branch.samples.end());
    std::sort(both.samples.begin(), both.samples.end());
    both.ends.insert(both.ends.end(), branch.ends.begin(), branch.ends.end());
    both.plan.reset();
    return both;
  }

  // Joins part k to the part it stands on. `both` is Both(k).
  void Join(std::size_t k, Part both) {
    const std::size_t on = parts_[k].on->part;
    for (const std::size_t i : parts_[k].samples) part_of_[i] = on;
    parts_[on] = std::move(both);
    parts_[k] = {};
    for (Part& part : parts_) {
      if (part.on && part.on->part == k) part.on->part = on;
    }
  }

  // Returns the step that all but a tenth of a part's surface between two heights can bear; 0: no surface.
  double NeedOf(const Part& part, double low, double high) const {
    std::vector<StepNeed> needs;
    double total = 0.0;
    for (const std::size_t i : part.samples) {
      const ContourSample& sample = area_.samples[i];
      if (sample.center.z() < low || sample.center.z() > high) continue;
      needs.push_back({sample.step, sample.width});
      total += sample.width;
    }
    std::sort(needs.begin(), needs.end(),
              [](const StepNeed& a, const StepNeed& b) { return a.step < b.step; });
    double passed = 0.0;
    for (const StepNeed& need : needs) {
      passed += need.weight;
      if (passed >= kRulingShare * total) return need.step;
    }
    return 0.0;
  }

  double TopOf(const Part& part) const {
    double top = -kInfinity;
    for (const std::size_t i : part.samples) top = std::max(top, area_.samples[i].center.z());
    return top;
  }

  // Can a branch and the part it stands on share their levels? The steps they need decide.
  bool SameNeeds(std::size_t k) const {
    const double low = parts_[k].on->below, high = TopOf(parts_[k]);
    const double own = NeedOf(parts_[k], low, high), beside = NeedOf(parts_[parts_[k].on->part], low, high);
    return std::abs(own - beside) < kSameNeeds * std::max(own, beside);
  }

  // Does no contour of a height run over both the branch and other areas?
  bool AroundItAlone(std::size_t k, double z) const {
    for (const CutterPath& path : contours_(z)) {
      double lengths[2] = {0.0, 0.0};  // over other areas, over the branch
      const std::size_t n = path.points.size();
      for (std::size_t i = 0; i + (path.closed ? 0 : 1) < n; ++i) {
        const Vec3 &a = path.points[i].center, &b = path.points[(i + 1) % n].center;
        const auto nearest = centers_.Nearest(0.5 * (a + b));
        if (nearest) lengths[part_of_[*nearest] == k] += (b - a).norm();
      }
      if (std::min(lengths[0], lengths[1]) > kMaxOverlapLength * params_.radius) return false;
    }
    return true;
  }

  // Lifts the base level of branch k to where contours go around it alone. Where the surface in between rises
  // gently it has no samples, and the branch begins higher than they show. Returns false if there is no such
  // height at least kRise below the top, or no contour may be traced any more.
  bool LiftBaseLevel(std::size_t k) {
    const double top = TopOf(parts_[k]);
    const std::size_t on = parts_[k].on->part;
    double z = parts_[k].on->below + params_.flat;
    for (double step = params_.flat;; step *= kLift) {
      if (z > top - kRise * params_.flat || contours_left_ == 0) return false;
      --contours_left_;
      if (AroundItAlone(k, z)) break;
      z += step;
    }
    Part &branch = parts_[k], &trunk = parts_[on];
    branch.on->below = z;
    std::erase_if(branch.samples, [&](std::size_t i) {
      if (area_.samples[i].center.z() > z) return false;
      part_of_[i] = on;
      trunk.samples.push_back(i);
      return true;
    });
    std::erase_if(branch.ends, [&](const LowerEnd& end) {
      if (end.center.z() > z) return false;
      trunk.ends.push_back(end);
      return true;
    });
    std::sort(trunk.samples.begin(), trunk.samples.end());
    trunk.plan.reset();
    for (Part& part : parts_) {
      if (part.on && part.on->part == k && part.on->below <= z) part.on->part = on;
    }
    return true;
  }

  absl::Status JoinUnlessShorter(std::size_t k) {
    Part& trunk = parts_[parts_[k].on->part];
    if (!trunk.plan) {
      PM_ASSIGN_OR_RETURN(trunk.plan, LevelPlanOf(trunk, std::nullopt));
    }
    PM_ASSIGN_OR_RETURN(
        const LevelPlan branch,
        LevelPlanOf(parts_[k], LevelBelow(trunk.plan->heights, parts_[k].on->below, params_.flat)));
    Part both = Both(k);
    PM_ASSIGN_OR_RETURN(both.plan, LevelPlanOf(both, std::nullopt));
    const double apart = trunk.plan->length + branch.length;
    if (!(apart < both.plan->length - kMinBranchSaving * params_.radius)) Join(k, std::move(both));
    return absl::OkStatus();
  }

  const ContourArea& area_;
  const PointCells& centers_;
  const HeightParams& params_;
  const ContoursAt& contours_;
  const RunContext& run_;
  int contours_left_ = kMostContours;
  std::vector<std::size_t> part_of_;  // of each sample
  std::vector<Part> parts_;
};

absl::StatusOr<LevelGroups> LevelGroups::Make(const ContourArea& contour_area, const HeightParams& params,
                                              const ContoursAt& contours, const RunContext& run) {
  LevelGroups made;
  const std::size_t count = contour_area.samples.size();
  if (count == 0) return made;
  const double reach = std::max(kReachOfSpacing * contour_area.spacing,
                                std::min(contour_area.widest, kMostReach * params.radius));
  made.centers_ = PointCells(PointsOf(contour_area, &ContourSample::center), reach);
  PM_RETURN_IF_ERROR(run.Check());
  UnionFind sets(count);
  for (const auto& [a, b] : contour_area.neighbors) sets.Join(a, b);
  made.centers_.JoinNear(sets, run);
  PM_RETURN_IF_ERROR(run.Check());
  PointCells(PointsOf(contour_area, &ContourSample::contact), reach).JoinNear(sets, run);
  PM_RETURN_IF_ERROR(run.Check());

  struct Set {
    double low = kInfinity, high = -kInfinity;
    double area = 0.0;  // mm2
    std::size_t number = 0;
  };
  std::map<std::size_t, Set> found;
  for (std::size_t i = 0; i < count; ++i) {
    const ContourSample& sample = contour_area.samples[i];
    Set& set = found[sets.Find(i)];
    set.low = std::min(set.low, sample.center.z() - sample.below);
    set.high = std::max(set.high, sample.center.z() + sample.above);
    set.area += sample.width * (sample.above + sample.below);
  }
  std::vector<Set*> order;
  for (auto& [first, set] : found) order.push_back(&set);
  std::stable_sort(order.begin(), order.end(), [](const Set* a, const Set* b) { return a->area > b->area; });
  std::size_t numbers = 0;
  for (Set* set : order) {
    const bool scrap = set != order.front() &&
                       (set->high - set->low < kMinGroupHeight * params.flat || numbers == kMostGroups);
    set->number = scrap ? 0 : numbers++;
  }
  std::vector<std::size_t> set_of;
  set_of.reserve(count);
  for (std::size_t i = 0; i < count; ++i) set_of.push_back(found[sets.Find(i)].number);
  std::vector<LevelBranch> branches;
  if (contours) {
    PM_ASSIGN_OR_RETURN(
        branches, FindBranches(contour_area, set_of, {.reach = reach, .rise = kRise * params.flat}, run));
    run.Progress("contours: branches", 0.0);
  }
  Builder builder(contour_area, made.centers_, params, contours, run);
  PM_RETURN_IF_ERROR(builder.Divide(std::move(set_of), numbers, std::move(branches)));
  builder.Put(made);
  return made;
}

LevelFamilyId LevelGroups::FamilyUnder(const CutterPath& pass,
                                       std::span<const LevelFamilyId> family_of) const {
  if (groups_.size() == 1) return family_of[0];
  std::map<LevelFamilyId, double> lengths;
  const std::size_t n = pass.points.size();
  for (std::size_t i = 0; i + (pass.closed ? 0 : 1) < n; ++i) {
    const Vec3 &a = pass.points[i].center, &b = pass.points[(i + 1) % n].center;
    const auto nearest = centers_.Nearest(0.5 * (a + b));
    if (nearest) lengths[family_of[of_sample_[*nearest].index()]] += (b - a).norm();
  }
  const auto longest = std::max_element(lengths.begin(), lengths.end(),
                                        [](const auto& a, const auto& b) { return a.second < b.second; });
  return longest == lengths.end() ? LevelFamilyId(0) : longest->first;
}

}  // namespace patchmill
