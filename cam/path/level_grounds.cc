#include "cam/path/level_grounds.h"

#include <algorithm>
#include <map>
#include <utility>

#include "core/base/status.h"

namespace patchmill {
namespace {

constexpr double kReachOfSpacing = 3.0;
constexpr double kMostReach = 2.0;         // ball radii
constexpr double kScrap = 2.0;             // flat steps high
constexpr std::size_t kMostGrounds = 256;  // smaller ones go with the largest

std::vector<Vec3> PointsOf(const ContourGround& ground, Vec3 ContourSample::*point) {
  std::vector<Vec3> points;
  points.reserve(ground.samples.size());
  for (const ContourSample& sample : ground.samples) points.push_back(sample.*point);
  return points;
}

}  // namespace

LevelGrounds::LevelGrounds(ContourGround all) {
  if (!all.samples.empty()) grounds_.push_back(std::move(all));
}

absl::StatusOr<LevelGrounds> LevelGrounds::Make(const ContourGround& ground, double radius, double flat,
                                                const RunContext& run) {
  LevelGrounds made;
  const std::size_t count = ground.samples.size();
  if (count == 0) return made;
  const double reach =
      std::max(kReachOfSpacing * ground.spacing, std::min(ground.widest, kMostReach * radius));
  made.centers_ = PointCells(PointsOf(ground, &ContourSample::center), reach);
  PM_RETURN_IF_ERROR(run.Check());
  UnionFind sets(count);
  for (const auto& [a, b] : ground.neighbors) sets.Join(a, b);
  made.centers_.JoinNear(sets, run);
  PM_RETURN_IF_ERROR(run.Check());
  PointCells(PointsOf(ground, &ContourSample::contact), reach).JoinNear(sets, run);
  PM_RETURN_IF_ERROR(run.Check());

  struct Set {
    double low = kInfinity, high = -kInfinity;
    double area = 0.0;  // mm2
    std::size_t number = 0;
  };
  std::map<std::size_t, Set> found;
  for (std::size_t i = 0; i < count; ++i) {
    const ContourSample& sample = ground.samples[i];
    Set& set = found[sets.Find(i)];
    set.low = std::min(set.low, sample.center.z() - sample.down);
    set.high = std::max(set.high, sample.center.z() + sample.up);
    set.area += sample.width * (sample.up + sample.down);
  }
  std::vector<Set*> order;
  for (auto& [first, set] : found) order.push_back(&set);
  std::stable_sort(order.begin(), order.end(), [](const Set* a, const Set* b) { return a->area > b->area; });
  for (Set* set : order) {
    const bool scrap = set != order.front() &&
                       (set->high - set->low < kScrap * flat || made.grounds_.size() == kMostGrounds);
    set->number = scrap ? 0 : made.grounds_.size();
    if (!scrap) made.grounds_.emplace_back().spacing = ground.spacing;
  }
  if (made.grounds_.size() == 1) {
    made.grounds_.front() = ground;
    return made;
  }
  made.of_sample_.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    made.of_sample_.push_back(found[sets.Find(i)].number);
    made.grounds_[made.of_sample_.back()].samples.push_back(ground.samples[i]);
  }
  for (const LowerEnd& end : ground.lower_ends) {
    const auto nearest = made.centers_.Nearest(end.center);
    made.grounds_[made.of_sample_[*nearest]].lower_ends.push_back(end);
  }
  return made;
}

std::size_t LevelGrounds::FamilyUnder(const CutterPath& pass, std::span<const std::size_t> family_of) const {
  if (grounds_.size() == 1) return family_of[0];
  std::map<std::size_t, double> lengths;
  const std::size_t n = pass.points.size();
  for (std::size_t i = 0; i + (pass.closed ? 0 : 1) < n; ++i) {
    const Vec3 &a = pass.points[i].center, &b = pass.points[(i + 1) % n].center;
    const auto nearest = centers_.Nearest(0.5 * (a + b));
    if (nearest) lengths[family_of[of_sample_[*nearest]]] += (b - a).norm();
  }
  const auto longest = std::max_element(lengths.begin(), lengths.end(),
                                        [](const auto& a, const auto& b) { return a.second < b.second; });
  return longest == lengths.end() ? 0 : longest->first;
}

}  // namespace patchmill
