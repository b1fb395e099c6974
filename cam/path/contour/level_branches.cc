#include "cam/path/contour/level_branches.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <span>
#include <utility>

#include "core/base/status.h"
#include "core/base/union_find.h"

namespace patchmill {
namespace {

constexpr std::size_t kBetweenPolls = 1024;  // samples between two polls of the run
constexpr std::size_t kNone = static_cast<std::size_t>(-1);

// For each number, the numbers that are paired with it.
class Links {
 public:
  Links(std::size_t count, std::span<const std::pair<std::size_t, std::size_t>> pairs)
      : first_(count + 1, 0) {
    for (const auto& [a, b] : pairs) {
      ++first_[a + 1];
      ++first_[b + 1];
    }
    std::partial_sum(first_.begin(), first_.end(), first_.begin());
    others_.resize(first_.back());
    std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
    for (const auto& [a, b] : pairs) {
      others_[next[a]++] = b;
      others_[next[b]++] = a;
    }
  }
  std::span<const std::size_t> operator[](std::size_t i) const {
    return std::span(others_).subspan(first_[i], first_[i + 1] - first_[i]);
  }

 private:
  std::vector<std::size_t> first_, others_;
};

// The cubes of a lattice that hold points of one set, and the pairs of cubes that touch.
struct Cubes {
  std::vector<std::size_t> of_point;
  std::size_t count = 0;
  std::vector<std::pair<std::size_t, std::size_t>> touching;
};

Cubes CubesOf(std::span<const ContourSample> samples, std::span<const std::size_t> sets,
              Vec3 ContourSample::*point, double side) {
  using Key = std::array<std::int64_t, 4>;
  const auto key_of = [&](std::size_t i) {
    const Vec3& p = samples[i].*point;
    return Key{static_cast<std::int64_t>(sets[i]), static_cast<std::int64_t>(std::floor(p.x() / side)),
               static_cast<std::int64_t>(std::floor(p.y() / side)),
               static_cast<std::int64_t>(std::floor(p.z() / side))};
  };
  std::vector<Key> keys;
  keys.reserve(samples.size());
  for (std::size_t i = 0; i < samples.size(); ++i) keys.push_back(key_of(i));
  std::sort(keys.begin(), keys.end());
  keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
  const auto find = [&](const Key& key) {
    const auto at = std::lower_bound(keys.begin(), keys.end(), key);
    return at != keys.end() && *at == key ? static_cast<std::size_t>(at - keys.begin()) : kNone;
  };
  Cubes cubes;
  cubes.count = keys.size();
  cubes.of_point.reserve(samples.size());
  for (std::size_t i = 0; i < samples.size(); ++i) cubes.of_point.push_back(find(key_of(i)));
  for (std::size_t i = 0; i < keys.size(); ++i) {
    for (int k = 14; k < 27; ++k) {  // half of the 26 cubes around it
      const auto other =
          find({keys[i][0], keys[i][1] + k / 9 - 1, keys[i][2] + k / 3 % 3 - 1, keys[i][3] + k % 3 - 1});
      if (other != kNone) cubes.touching.emplace_back(i, other);
    }
  }
  return cubes;
}

// A connected part above the current height.
struct Part {
  double top = 0.0;   // mm
  double area = 0.0;  // mm2
  std::vector<std::size_t> samples;
};

// Sweeps from the top down. Its nodes are the cubes of centres and, after them, those of contacts.
class Sweep {
 public:
  Sweep(std::size_t nodes, double rise) : rise_(rise), sets_(nodes), parts_(nodes), seen_(nodes, false) {}

  bool Seen(std::size_t node) const { return seen_[node]; }
  void See(std::size_t node, double z) {
    seen_[node] = true;
    parts_[node].top = z;
  }
  void Add(std::size_t node, std::size_t sample, double area) {
    Part& part = parts_[sets_.Find(node)];
    part.samples.push_back(sample);
    part.area += area;
  }
  // Joins two nodes, which are connected from z on down.
  void Join(std::size_t a, std::size_t b, double z) {
    a = sets_.Find(a);
    b = sets_.Find(b);
    if (a == b) return;
    const auto [large, small] = parts_[a].area >= parts_[b].area ? std::pair(a, b) : std::pair(b, a);
    Part whole = std::move(parts_[large]), other = std::move(parts_[small]);
    const bool fork = std::min(whole.top, other.top) - z >= rise_;
    if (fork && !whole.samples.empty() && !other.samples.empty()) {
      branches_.push_back({whole.samples.front(), z, other.area, std::move(other.samples)});
    } else {
      if (whole.samples.size() < other.samples.size()) std::swap(whole.samples, other.samples);
      whole.samples.insert(whole.samples.end(), other.samples.begin(), other.samples.end());
    }
    whole.area += other.area;
    whole.top = std::max(whole.top, other.top);
    sets_.Join(a, b);
    parts_[sets_.Find(a)] = std::move(whole);
  }
  std::vector<LevelBranch> Take() { return std::move(branches_); }

 private:
  double rise_;
  UnionFind sets_;
  std::vector<Part> parts_;  // indexed by the node that stands for its set
  std::vector<bool> seen_;
  std::vector<LevelBranch> branches_;
};

}  // namespace

absl::StatusOr<std::vector<LevelBranch>> FindBranches(const ContourArea& contour_area,
                                                      std::span<const std::size_t> sets,
                                                      const BranchParams& params, const RunContext& run) {
  const std::vector<ContourSample>& samples = contour_area.samples;
  const Cubes centers = CubesOf(samples, sets, &ContourSample::center, params.reach);
  PM_RETURN_IF_ERROR(run.Check());
  const Cubes contacts = CubesOf(samples, sets, &ContourSample::contact, params.reach);
  PM_RETURN_IF_ERROR(run.Check());
  const Links center_links(centers.count, centers.touching), contact_links(contacts.count, contacts.touching),
      neighbors(samples.size(), contour_area.neighbors);
  std::vector<std::size_t> falling(samples.size());
  std::iota(falling.begin(), falling.end(), std::size_t{0});
  std::stable_sort(falling.begin(), falling.end(), [&](std::size_t a, std::size_t b) {
    return samples[a].center.z() > samples[b].center.z();
  });
  Sweep sweep(centers.count + contacts.count, params.rise);
  std::vector<bool> seen(samples.size(), false);
  for (std::size_t n = 0; n < falling.size(); ++n) {
    if (n % kBetweenPolls == 0) PM_RETURN_IF_ERROR(run.Check());
    const std::size_t i = falling[n];
    const double z = samples[i].center.z();
    const std::size_t center = centers.of_point[i], contact = centers.count + contacts.of_point[i];
    const bool new_center = !sweep.Seen(center), new_contact = !sweep.Seen(contact);
    if (new_center) sweep.See(center, z);
    if (new_contact) sweep.See(contact, z);
    sweep.Add(center, i, samples[i].width * (samples[i].above + samples[i].below));
    sweep.Join(center, contact, z);
    const auto join = [&](std::span<const std::size_t> others, std::size_t first, std::size_t to) {
      for (const std::size_t other : others) {
        if (sweep.Seen(first + other)) sweep.Join(to, first + other, z);
      }
    };
    if (new_center) join(center_links[centers.of_point[i]], 0, center);
    if (new_contact) join(contact_links[contacts.of_point[i]], centers.count, contact);
    for (const std::size_t other : neighbors[i]) {
      if (seen[other] && sets[other] == sets[i]) sweep.Join(center, centers.of_point[other], z);
    }
    seen[i] = true;
  }
  std::vector<LevelBranch> branches = sweep.Take();
  std::stable_sort(branches.begin(), branches.end(),
                   [](const LevelBranch& a, const LevelBranch& b) { return a.area < b.area; });
  return branches;
}

}  // namespace patchmill
