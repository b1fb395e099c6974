#include "core/surface/leaf_tree.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <span>

namespace patchmill {
namespace {

constexpr int kBins = 16;

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
  double next_report = 0.0;

  // Where to cut order[begin, end): items below `bin` of `axis` go left. cost is +inf when bins cannot part
  // them.
  struct Cut {
    double cost = kInfinity;
    int axis = 0, bin = 0;
  };

  static int BinOf(double x, double min, double width) {
    return std::clamp(static_cast<int>((x - min) / width * kBins), 0, kBins - 1);
  }

  Cut BestCut(std::span<const std::int32_t> items, const Box3& spread) const {
    Cut best;
    for (int axis = 0; axis < 3; ++axis) {
      const double min = spread.min[axis], width = spread.max[axis] - min;
      if (!(width > 0.0)) continue;
      std::array<Box3, kBins> box;
      std::array<int, kBins> count{};
      for (const std::int32_t item : items) {
        const auto bin =
            static_cast<std::size_t>(BinOf(centers[static_cast<std::size_t>(item)][axis], min, width));
        box[bin].Add(boxes[static_cast<std::size_t>(item)]);
        ++count[bin];
      }
      std::array<double, kBins> right_cost{};
      Box3 right;
      int right_count = 0;
      for (std::size_t b = kBins - 1; b > 0; --b) {
        right.Add(box[b]);
        right_count += count[b];
        right_cost[b] = right_count > 0 ? HalfArea(right) * right_count : 0.0;
      }
      Box3 left;
      int left_count = 0;
      for (std::size_t b = 1; b < kBins; ++b) {
        left.Add(box[b - 1]);
        left_count += count[b - 1];
        if (left_count == 0 || left_count == static_cast<int>(items.size())) continue;
        const double cost = HalfArea(left) * left_count + right_cost[b];
        if (cost < best.cost) best = {cost, axis, static_cast<int>(b)};
      }
    }
    return best;
  }

  // Returns the number of items that go left, at least 1 and fewer than all.
  std::size_t Part(std::span<std::int32_t> items, const Box3& spread, int depth) const {
    const auto center = [&](std::int32_t item) -> const Vec3& {
      return centers[static_cast<std::size_t>(item)];
    };
    const Cut cut = depth < 30 ? BestCut(items, spread) : Cut{};  // too deep: medians end it in log2(n)
    if (cut.cost < kInfinity) {
      const double min = spread.min[cut.axis], width = spread.max[cut.axis] - min;
      const auto middle = std::stable_partition(items.begin(), items.end(), [&](std::int32_t item) {
        return BinOf(center(item)[cut.axis], min, width) < cut.bin;
      });
      return static_cast<std::size_t>(middle - items.begin());
    }
    int axis = 0;
    (spread.max - spread.min).maxCoeff(&axis);
    const std::size_t half = items.size() / 2;
    std::nth_element(items.begin(), items.begin() + static_cast<std::ptrdiff_t>(half), items.end(),
                     [&](std::int32_t a, std::int32_t b) {
                       return std::pair(center(a)[axis], a) < std::pair(center(b)[axis], b);
                     });
    return half;
  }

  void Report() {
    const double share = static_cast<double>(nodes.size()) / (2.0 * static_cast<double>(boxes.size()));
    if (share < next_report) return;
    run.Progress("bounds: tree", share);
    next_report = share + 1.0 / 64.0;
  }

  void Build(std::span<std::int32_t> items, int depth) {
    const std::size_t self = nodes.size();
    nodes.emplace_back();
    Box3 box, spread;
    for (const std::int32_t item : items) {
      box.Add(boxes[static_cast<std::size_t>(item)]);
      spread.Add(centers[static_cast<std::size_t>(item)]);
    }
    nodes[self].box = box;
    if (items.size() == 1) {
      nodes[self].leaf = items.front();
      return;
    }
    if (items.size() > 256) {
      if (run.Cancelled()) return;
      Report();
    }
    const std::size_t left = Part(items, spread, depth);
    Build(items.first(left), depth + 1);
    nodes[self].right = static_cast<std::int32_t>(nodes.size());
    Build(items.subspan(left), depth + 1);
  }
};

}  // namespace

std::vector<SurfaceNode> BuildLeafTree(const std::vector<Box3>& boxes, const RunContext& run) {
  Builder builder{.boxes = boxes, .run = run, .centers = {}, .order = {}, .nodes = {}};
  if (boxes.empty()) return {};
  builder.centers.reserve(boxes.size());
  for (const Box3& box : boxes) builder.centers.push_back(box.Center());
  builder.order.resize(boxes.size());
  std::iota(builder.order.begin(), builder.order.end(), 0);
  builder.nodes.reserve(2 * boxes.size() - 1);
  builder.Build(builder.order, 0);
  return std::move(builder.nodes);
}

}  // namespace patchmill
