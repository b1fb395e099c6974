#include "cam/location/limits/mask_proximity.h"

#include <algorithm>
#include <array>

#include "core/base/parallel.h"
#include "core/base/status.h"

namespace patchmill {
namespace {

constexpr std::size_t kLeafBalls = 8;
constexpr double kBulge = 1.1;  // reach of a cell, as a multiple of the reach of nine of its points

double Squared(const Box3& box, const Vec3& p) {
  return (box.min - p).cwiseMax(p - box.max).cwiseMax(0.0).squaredNorm();
}

}  // namespace

absl::StatusOr<MaskProximity> MaskProximity::Make(const Surface& surface, const SurfaceMask& mask,
                                                  const RunContext& run) {
  const int n = mask.cells();
  std::vector<std::vector<Ball>> found(surface.pieces.size());
  PM_RETURN_IF_ERROR(ParallelFor(run, nullptr, found.size(), [&](std::size_t k) {
    const PieceId piece(k);
    const auto inside = [&](int i, int j) {
      return i >= 0 && j >= 0 && i < n && j < n && mask.HasCell(piece, i, j);
    };
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j < n; ++j) {
        if (!inside(i, j)) continue;
        if (inside(i - 1, j) && inside(i + 1, j) && inside(i, j - 1) && inside(i, j + 1)) continue;
        std::array<Vec3, 9> p;
        for (int m = 0; m < 9; ++m) {
          const double u = (i + 0.5 * (m / 3)) / n, v = (j + 0.5 * (m % 3)) / n;
          p[static_cast<std::size_t>(m)] = Evaluate(surface, piece, u, v).p;
        }
        Ball ball{p[4], 0.0};
        for (const Vec3& q : p) ball.radius = std::max(ball.radius, kBulge * (q - p[4]).norm());
        found[k].push_back(ball);
      }
    }
  }));
  MaskProximity near;
  for (const auto& of_piece : found) near.balls_.insert(near.balls_.end(), of_piece.begin(), of_piece.end());
  if (!near.balls_.empty()) near.Build(0, near.balls_.size());
  return near;
}

void MaskProximity::Build(std::size_t begin, std::size_t end) {
  const std::size_t here = nodes_.size();
  nodes_.emplace_back();
  Box3 box;
  for (std::size_t i = begin; i < end; ++i) {
    box.Add(balls_[i].center - Vec3::Constant(balls_[i].radius));
    box.Add(balls_[i].center + Vec3::Constant(balls_[i].radius));
  }
  nodes_[here].box = box;
  if (end - begin <= kLeafBalls) {
    nodes_[here].first = static_cast<std::int32_t>(begin);
    nodes_[here].right = static_cast<std::int32_t>(end);
    return;
  }
  int axis = 0;
  (box.max - box.min).maxCoeff(&axis);
  const auto at = [&](std::size_t i) { return balls_.begin() + static_cast<std::ptrdiff_t>(i); };
  const std::size_t middle = begin + (end - begin) / 2;
  std::nth_element(at(begin), at(middle), at(end),
                   [axis](const Ball& a, const Ball& b) { return a.center[axis] < b.center[axis]; });
  Build(begin, middle);
  nodes_[here].right = static_cast<std::int32_t>(nodes_.size());
  Build(middle, end);
}

bool MaskProximity::Within(const Vec3& p, double distance) const {
  if (nodes_.empty()) return false;
  std::array<std::int32_t, 64> stack;
  std::size_t depth = 0;
  stack[depth++] = 0;
  while (depth > 0) {
    const std::int32_t at = stack[--depth];
    const Node& node = nodes_[static_cast<std::size_t>(at)];
    if (Squared(node.box, p) > distance * distance) continue;
    if (node.first < 0) {
      stack[depth++] = node.right;
      stack[depth++] = at + 1;
      continue;
    }
    for (std::int32_t i = node.first; i < node.right; ++i) {
      const Ball& ball = balls_[static_cast<std::size_t>(i)];
      if ((ball.center - p).norm() <= distance + ball.radius) return true;
    }
  }
  return false;
}

}  // namespace patchmill
