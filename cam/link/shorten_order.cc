#include "cam/link/shorten_order.h"

#include <algorithm>
#include <cstdint>
#include <limits>

namespace patchmill {
namespace {

constexpr std::ptrdiff_t kLongestRun = 3;   // stops that are moved together
constexpr std::ptrdiff_t kFarthest = 200;   // places that a run may move, each way
constexpr int kMostSweeps = 20;             // over all stops
constexpr double kMinSavingSeconds = 1e-6;  // s; moves that save less are not made

class OrderSearch {
 public:
  OrderSearch(const std::vector<Stop>& stops, std::vector<std::size_t> order, const Vec3& from,
              const TravelTime& travel)
      : stops_(stops), order_(std::move(order)), from_(from), travel_(travel), place_(stops.size()) {
    after_.resize(stops.size());
    for (std::size_t s = 0; s < stops.size(); ++s) {
      for (const std::size_t b : stops[s].before) after_[b].push_back(s);
    }
    for (std::ptrdiff_t i = 0; i < Count(); ++i) place_[At(i)] = i;
  }

  // Tries to move each run once. True if anything was moved.
  bool Sweep(const RunContext& run) {
    bool moved = false;
    for (std::ptrdiff_t i = 0; i < Count() && !run.Cancelled(); ++i) {
      for (std::ptrdiff_t length = 1; length <= kLongestRun && i + length <= Count(); ++length) {
        moved |= MoveRun(i, i + length);
      }
    }
    return moved;
  }

  std::vector<std::size_t> order() && { return std::move(order_); }

 private:
  std::ptrdiff_t Count() const { return static_cast<std::ptrdiff_t>(order_.size()); }
  std::size_t At(std::ptrdiff_t i) const { return order_[static_cast<std::size_t>(i)]; }
  // Time from the stop at place i to the stop at place j, s. i = -1 stands for the start. There is no way
  // after the last stop.
  double Leg(std::ptrdiff_t i, std::ptrdiff_t j) const {
    if (j >= Count()) return 0.0;
    return travel_(i < 0 ? from_ : stops_[At(i)].leave, stops_[At(j)].enter);
  }

  // Moves the stops at [first, end) to the best place that is allowed, if that saves time. True if they
  // moved.
  bool MoveRun(std::ptrdiff_t first, std::ptrdiff_t end) {
    std::ptrdiff_t lowest = std::max<std::ptrdiff_t>(0, first - kFarthest);
    std::ptrdiff_t highest = std::min(Count(), end + kFarthest);
    for (std::ptrdiff_t i = first; i < end; ++i) {
      for (const std::size_t b : stops_[At(i)].before) {
        if (const std::ptrdiff_t p = place_[b]; p < first) lowest = std::max(lowest, p + 1);
      }
      for (const std::size_t a : after_[At(i)]) {
        if (const std::ptrdiff_t p = place_[a]; p >= end) highest = std::min(highest, p);
      }
    }
    const double saved = Leg(first - 1, first) + Leg(end - 1, end) - Leg(first - 1, end);
    double best_gain = kMinSavingSeconds;
    std::ptrdiff_t best = first;
    for (std::ptrdiff_t k = lowest; k <= highest; ++k) {  // to between the stops at k - 1 and k
      if (k >= first && k <= end) continue;
      const double gain = saved - (Leg(k - 1, first) + Leg(end - 1, k) - Leg(k - 1, k));
      if (gain > best_gain) {
        best_gain = gain;
        best = k;
      }
    }
    if (best == first) return false;
    const auto at = [&](std::ptrdiff_t i) { return order_.begin() + i; };
    if (best < first) {
      std::rotate(at(best), at(first), at(end));
    } else {
      std::rotate(at(first), at(end), at(best));
    }
    for (std::ptrdiff_t i = std::min(best, first); i < std::max(best, end); ++i) place_[At(i)] = i;
    return true;
  }

  const std::vector<Stop>& stops_;
  std::vector<std::size_t> order_;
  const Vec3& from_;
  const TravelTime& travel_;
  std::vector<std::ptrdiff_t> place_;            // [stop]
  std::vector<std::vector<std::size_t>> after_;  // [stop]: the stops that must come after it
};

}  // namespace

std::vector<std::size_t> ShortenOrder(const std::vector<Stop>& stops, std::vector<std::size_t> order,
                                      const Vec3& from, const TravelTime& travel, const RunContext& run) {
  OrderSearch search(stops, std::move(order), from, travel);
  for (int sweep = 0; sweep < kMostSweeps && search.Sweep(run); ++sweep) {
  }
  return std::move(search).order();
}

}  // namespace patchmill
