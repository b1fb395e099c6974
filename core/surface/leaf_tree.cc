#include "core/surface/leaf_tree.h"

#include <algorithm>
#include <array>
#include <limits>
#include <numeric>
#include <span>
#include <utility>

#include "core/base/lanes.h"
#include "core/base/parallel.h"
#include "core/base/resize_polling.h"

namespace patchmill {
namespace {

constexpr int kBins = 16;
constexpr std::size_t kFew = 8, kMostSteps = kBins;
// Subtrees are built in parallel: at least kShares of them, if each has at least kAlone items.
constexpr std::size_t kShares = 32, kAlone = 512;
constexpr float kNarrow = 1e-30F;  // a narrower spread is not cut: its bins would be too narrow for a float

// A box in floats, relative to an origin among all boxes. It only weighs cuts, so its rounding can do no harm
// but a slightly dearer cut.
struct LaneBox {
  Float4 low = Splat(std::numeric_limits<float>::infinity());
  Float4 high = Splat(-std::numeric_limits<float>::infinity());

  void Add(const LaneBox& box) {
    low = Min(low, box.low);
    high = Max(high, box.high);
  }
  Float4 Center() const { return Splat(0.5F) * (low + high); }
};

float HalfArea(const LaneBox& box) {
  const Float4 d = box.high - box.low;
  return d[0] * d[1] + d[1] * d[2] + d[2] * d[0];
}

LaneBox LaneBoxOf(const Box3& box, const Vec3& origin) {
  const auto lanes = [&](const Vec3& p) {
    const Eigen::Vector3f q = (p - origin).cast<float>();
    return Float4{q.x(), q.y(), q.z(), 0.0F};
  };
  return {lanes(box.min), lanes(box.max)};
}

// Bins of equal width over a spread of centres, along each axis.
struct Bins {
  Float4 min, scale;

  explicit Bins(const LaneBox& spread) : min(spread.low) {
    const Float4 width = spread.high - spread.low;
    for (int axis = 0; axis < 4; ++axis) scale[axis] = width[axis] > kNarrow ? kBins / width[axis] : 0.0F;
  }
  bool Parts(int axis) const { return scale[axis] > 0.0F; }
  Int4 Of(const LaneBox& box) const {
    return __builtin_convertvector(Min((box.Center() - min) * scale, Splat(kBins - 1)), Int4);
  }
};

struct Builder {
  const RunContext& run;
  std::vector<LaneBox> boxes;
  std::vector<std::int32_t> order;
  std::vector<SurfaceNode> nodes;

  // A cut of the items: those below `bin` of `axis` go left. The cost is +inf if bins cannot part the items.
  struct Cut {
    float cost = std::numeric_limits<float>::infinity();
    int axis = -1, bin = 0;
  };

  const LaneBox& Box(std::int32_t item) const { return boxes[static_cast<std::size_t>(item)]; }

  // The box and number of some items in a row. After a step, a cut at its bin is possible.
  struct Step {
    LaneBox box;
    int count = 0, bin = 0;
  };
  static void Sweep(std::span<const Step> steps, int axis, Cut& best) {
    std::array<float, kMostSteps> right_cost{};
    LaneBox right;
    int right_count = 0;
    for (std::size_t k = steps.size() - 1; k > 0; --k) {
      right.Add(steps[k].box);
      right_count += steps[k].count;
      right_cost[k] = HalfArea(right) * static_cast<float>(right_count);
    }
    LaneBox left;
    int left_count = 0;
    for (std::size_t k = 0; k + 1 < steps.size(); ++k) {
      left.Add(steps[k].box);
      left_count += steps[k].count;
      const float cost = HalfArea(left) * static_cast<float>(left_count) + right_cost[k + 1];
      if (cost < best.cost) best = {cost, axis, steps[k].bin};
    }
  }

  // Most nodes have few items. These are sorted by their bins, and no bins are filled.
  Cut BestCutOfFew(std::span<const std::int32_t> items, const Bins& bins) const {
    std::array<Int4, kFew> bin;
    for (std::size_t k = 0; k < items.size(); ++k) bin[k] = bins.Of(Box(items[k]));
    Cut best;
    for (int axis = 0; axis < 3; ++axis) {
      if (!bins.Parts(axis)) continue;
      std::array<std::pair<int, std::int32_t>, kFew> in_order;
      for (std::size_t k = 0; k < items.size(); ++k) {
        const std::pair<int, std::int32_t> at(int{bin[k][axis]}, items[k]);
        std::size_t i = k;
        for (; i > 0 && in_order[i - 1].first > at.first; --i) in_order[i] = in_order[i - 1];
        in_order[i] = at;
      }
      std::array<Step, kFew> steps;
      std::size_t count = 0;
      for (std::size_t k = 0; k < items.size(); ++k) {
        if (k > 0 && in_order[k].first != in_order[k - 1].first) ++count;
        Step& step = steps[count];
        step.box.Add(Box(in_order[k].second));
        ++step.count;
        step.bin = in_order[k].first + 1;
      }
      Sweep(std::span(steps).first(count + 1), axis, best);
    }
    return best;
  }

  Cut BestCut(std::span<const std::int32_t> items, const Bins& bins) const {
    if (items.size() <= kFew) return BestCutOfFew(items, bins);
    std::array<std::array<Step, kBins>, 3> filled;
    for (const std::int32_t item : items) {
      const LaneBox& box = Box(item);
      const Int4 at = bins.Of(box);
      for (int axis = 0; axis < 3; ++axis) {
        Step& bin = filled[static_cast<std::size_t>(axis)][static_cast<std::size_t>(at[axis])];
        bin.box.Add(box);
        ++bin.count;
      }
    }
    Cut best;
    for (int axis = 0; axis < 3; ++axis) {
      std::array<Step, kBins>& steps = filled[static_cast<std::size_t>(axis)];
      std::size_t count = 0;
      for (std::size_t b = 0; b < kBins; ++b) {
        if (steps[b].count == 0) continue;
        steps[count] = steps[b];
        steps[count++].bin = static_cast<int>(b) + 1;
      }
      Sweep(std::span(steps).first(count), axis, best);
    }
    return best;
  }

  // Parts the items in place. Returns the number of items that go left, at least 1 and fewer than all.
  std::size_t Part(std::span<std::int32_t> items, int depth) const {
    if (items.size() == 2) return 1;
    LaneBox spread;
    for (const std::int32_t item : items) {
      const Float4 center = Box(item).Center();
      spread.Add({center, center});
    }
    const Bins bins(spread);
    const Cut cut = depth < 30 ? BestCut(items, bins) : Cut{};  // too deep: halving ends it in log2(n)
    if (cut.axis >= 0) {
      const auto middle = std::partition(items.begin(), items.end(), [&](std::int32_t item) {
        return bins.Of(Box(item))[cut.axis] < cut.bin;
      });
      return static_cast<std::size_t>(middle - items.begin());
    }
    const Float4 width = spread.high - spread.low;
    const int axis = width[0] >= std::max(width[1], width[2]) ? 0 : width[1] >= width[2] ? 1 : 2;
    const std::size_t half = items.size() / 2;
    std::nth_element(items.begin(), items.begin() + static_cast<std::ptrdiff_t>(half), items.end(),
                     [&](std::int32_t a, std::int32_t b) {
                       return std::pair(Box(a).Center()[axis], a) < std::pair(Box(b).Center()[axis], b);
                     });
    return half;
  }

  // A node over `items` and all nodes below it. They take 2 items - 1 places from `self` on.
  struct Task {
    std::span<std::int32_t> items;
    std::size_t self = 0;
    int depth = 0;
  };
  // Builds the subtree of `task`. Nodes of at most `enough` items are not built but added to `rest`.
  void Build(const Task& task, std::size_t enough, std::vector<Task>* rest) {
    const auto [items, self, depth] = task;
    if (items.size() <= enough && rest != nullptr) {
      rest->push_back(task);
      return;
    }
    if (items.size() == 1) {
      nodes[self].leaf = items.front();
      return;
    }
    if (items.size() > 256 && run.Cancelled()) return;
    if (rest != nullptr) run.Progress("bounds: tree", 0.0);  // a pass over so many items takes a while
    const std::size_t left = Part(items, depth);
    nodes[self].right = static_cast<std::int32_t>(self + 2 * left);
    Build({items.first(left), self + 1, depth + 1}, enough, rest);
    Build({items.subspan(left), self + 2 * left, depth + 1}, enough, rest);
  }
};

}  // namespace

std::vector<SurfaceNode> BuildLeafTree(const std::vector<Box3>& boxes, const RunContext& run) {
  Builder builder{.run = run, .boxes = {}, .order = {}, .nodes = {}};
  if (boxes.empty()) return {};
  if (!ResizePolling(builder.boxes, boxes.size(), run).ok() ||
      !ResizePolling(builder.order, boxes.size(), run).ok() ||
      !ResizePolling(builder.nodes, 2 * boxes.size() - 1, run).ok()) {
    return {};
  }
  std::transform(boxes.begin(), boxes.end(), builder.boxes.begin(),
                 [&](const Box3& box) { return LaneBoxOf(box, boxes.front().min); });
  std::iota(builder.order.begin(), builder.order.end(), 0);
  run.Progress("bounds: tree", 0.0);
  std::vector<Builder::Task> rest;
  builder.Build({builder.order, 0, 0}, std::max(kAlone, boxes.size() / kShares), &rest);
  // A cancellation shows in `run`.
  ParallelFor(run, "bounds: tree", rest.size(), [&](std::size_t k) {
    builder.Build(rest[k], 0, nullptr);
  }).IgnoreError();
  if (run.Cancelled()) return {};
  // Children come after their parents, so this loop visits them first.
  for (std::size_t i = builder.nodes.size(); i-- > 0;) {
    SurfaceNode& node = builder.nodes[i];
    if (node.leaf >= 0) {
      node.box = boxes[static_cast<std::size_t>(node.leaf)];
    } else {
      node.box = builder.nodes[i + 1].box;
      node.box.Add(builder.nodes[static_cast<std::size_t>(node.right)].box);
    }
  }
  return std::move(builder.nodes);
}

}  // namespace patchmill
