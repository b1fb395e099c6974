#include "core/surface/leaf_tree.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <span>
#include <utility>

#include "core/base/grow.h"
#include "core/base/parallel.h"

namespace patchmill {
namespace {

constexpr int kBins = 16;
constexpr std::size_t kFew = 8, kMostSteps = kBins;
// Subtrees are built in parallel, at least so many where there are enough items.
constexpr std::size_t kShares = 32, kAlone = 512;

double HalfArea(const Box3& box) {
  const Vec3 d = box.max - box.min;
  return d.x() * d.y() + d.y() * d.z() + d.z() * d.x();
}

struct Builder {
  const std::vector<Box3>& boxes;
  const RunContext& run;
  std::vector<Vec3> centers;
  std::vector<std::int32_t> order;
  std::vector<SurfaceNode> nodes;

  // Where to cut order[begin, end): items below `bin` of `axis` go left. cost is +inf when bins cannot part
  // them.
  struct Cut {
    double cost = kInfinity;
    int axis = 0, bin = 0;
  };

  static int BinOf(double x, double min, double width) {
    return std::clamp(static_cast<int>((x - min) / width * kBins), 0, kBins - 1);
  }
  const Vec3& Center(std::int32_t item) const { return centers[static_cast<std::size_t>(item)]; }
  const Box3& Box(std::int32_t item) const { return boxes[static_cast<std::size_t>(item)]; }

  // Of some boxes in a row, after each of which a cut at the given bin is possible.
  struct Step {
    Box3 box;
    int count = 0, bin = 0;
  };
  static void Sweep(std::span<const Step> steps, int axis, Cut& best) {
    std::array<double, kMostSteps> right_cost{};
    Box3 right;
    int right_count = 0;
    for (std::size_t k = steps.size() - 1; k > 0; --k) {
      right.Add(steps[k].box);
      right_count += steps[k].count;
      right_cost[k] = HalfArea(right) * right_count;
    }
    Box3 left;
    int left_count = 0;
    for (std::size_t k = 0; k + 1 < steps.size(); ++k) {
      left.Add(steps[k].box);
      left_count += steps[k].count;
      const double cost = HalfArea(left) * left_count + right_cost[k + 1];
      if (cost < best.cost) best = {cost, axis, steps[k].bin};
    }
  }

  // Most nodes have few items: these are put in order of their bins, and no bins are filled.
  Cut BestCutOfFew(std::span<const std::int32_t> items, const Box3& spread) const {
    Cut best;
    for (int axis = 0; axis < 3; ++axis) {
      const double min = spread.min[axis], width = spread.max[axis] - min;
      if (!(width > 0.0)) continue;
      std::array<std::pair<int, std::int32_t>, kFew> in_order;
      for (std::size_t k = 0; k < items.size(); ++k) {
        const std::pair<int, std::int32_t> at(BinOf(Center(items[k])[axis], min, width), items[k]);
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

  Cut BestCut(std::span<const std::int32_t> items, const Box3& spread) const {
    if (items.size() <= kFew) return BestCutOfFew(items, spread);
    std::array<std::array<Step, kBins>, 3> bins;
    const Vec3 width = spread.max - spread.min;
    for (const std::int32_t item : items) {
      const Box3& box = Box(item);
      const Vec3& center = Center(item);
      for (int axis = 0; axis < 3; ++axis) {
        if (!(width[axis] > 0.0)) continue;
        Step& bin = bins[static_cast<std::size_t>(axis)]
                        [static_cast<std::size_t>(BinOf(center[axis], spread.min[axis], width[axis]))];
        bin.box.Add(box);
        ++bin.count;
      }
    }
    Cut best;
    for (int axis = 0; axis < 3; ++axis) {
      if (!(width[axis] > 0.0)) continue;
      std::array<Step, kBins>& steps = bins[static_cast<std::size_t>(axis)];
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

  // Returns the number of items that go left, at least 1 and fewer than all.
  std::size_t Part(std::span<std::int32_t> items, const Box3& spread, int depth) const {
    const Cut cut = depth < 30 ? BestCut(items, spread) : Cut{};  // too deep: medians end it in log2(n)
    if (cut.cost < kInfinity) {
      const double min = spread.min[cut.axis], width = spread.max[cut.axis] - min;
      const auto middle = std::stable_partition(items.begin(), items.end(), [&](std::int32_t item) {
        return BinOf(Center(item)[cut.axis], min, width) < cut.bin;
      });
      return static_cast<std::size_t>(middle - items.begin());
    }
    int axis = 0;
    (spread.max - spread.min).maxCoeff(&axis);
    const std::size_t half = items.size() / 2;
    std::nth_element(items.begin(), items.begin() + static_cast<std::ptrdiff_t>(half), items.end(),
                     [&](std::int32_t a, std::int32_t b) {
                       return std::pair(Center(a)[axis], a) < std::pair(Center(b)[axis], b);
                     });
    return half;
  }

  // A node over `items` and all below it; they take 2 items - 1 places from `self` on.
  struct Task {
    std::span<std::int32_t> items;
    std::size_t self = 0;
    int depth = 0;
  };
  // Nodes of at most `enough` items are left to be built: they go to `rest`.
  void Build(const Task& task, std::size_t enough, std::vector<Task>* rest) {
    const auto [items, self, depth] = task;
    if (items.size() <= enough && rest != nullptr) {
      rest->push_back(task);
      return;
    }
    SurfaceNode& node = nodes[self];
    Box3 spread;
    for (const std::int32_t item : items) {
      node.box.Add(Box(item));
      spread.Add(Center(item));
    }
    if (items.size() == 1) {
      node.leaf = items.front();
      return;
    }
    if (items.size() > 256 && run.Cancelled()) return;
    if (rest != nullptr) run.Progress("bounds: tree", 0.0);  // a pass over so many items takes a while
    const std::size_t left = Part(items, spread, depth);
    node.right = static_cast<std::int32_t>(self + 2 * left);
    Build({items.first(left), self + 1, depth + 1}, enough, rest);
    Build({items.subspan(left), self + 2 * left, depth + 1}, enough, rest);
  }
};

}  // namespace

std::vector<SurfaceNode> BuildLeafTree(const std::vector<Box3>& boxes, const RunContext& run) {
  Builder builder{.boxes = boxes, .run = run, .centers = {}, .order = {}, .nodes = {}};
  if (boxes.empty()) return {};
  if (!Grow(builder.centers, boxes.size(), run).ok() || !Grow(builder.order, boxes.size(), run).ok() ||
      !Grow(builder.nodes, 2 * boxes.size() - 1, run).ok()) {
    return {};
  }
  std::transform(boxes.begin(), boxes.end(), builder.centers.begin(),
                 [](const Box3& b) { return b.Center(); });
  std::iota(builder.order.begin(), builder.order.end(), 0);
  run.Progress("bounds: tree", 0.0);
  std::vector<Builder::Task> rest;
  builder.Build({builder.order, 0, 0}, std::max(kAlone, boxes.size() / kShares), &rest);
  // A cancel shows in `run`.
  ParallelFor(run, "bounds: tree", rest.size(), [&](std::size_t k) {
    builder.Build(rest[k], 0, nullptr);
  }).IgnoreError();
  return std::move(builder.nodes);
}

}  // namespace patchmill
