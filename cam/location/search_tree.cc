#include "cam/location/search_tree.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/parallel.h"
#include "core/base/status.h"

namespace patchmill::internal {
namespace {

constexpr int kMaxHalvings = 2;
constexpr std::size_t kChunk = 64;  // leaves per task

float RoundDown(double x) { return std::nextafterf(static_cast<float>(x), -HUGE_VALF); }
float RoundUp(double x) { return std::nextafterf(static_cast<float>(x), HUGE_VALF); }

SearchNode Node(const Box3& box) {
  return {RoundDown(box.min.x()),
          RoundDown(box.min.y()),
          RoundDown(box.min.z()),
          RoundUp(box.max.x()),
          RoundUp(box.max.y()),
          RoundUp(box.max.z()),
          0,
          -1};
}

// Could the ball rest somewhere inside the leaf, without its convexity being proven?
bool NeedsSplit(const LeafModel& m, double radius) {
  Vec3 n = m.a.cross(m.b);
  const double length = n.norm();
  if (!(length > 0.0)) return true;
  n *= (n.z() < 0.0 ? -radius : radius) / length;
  const double size = radius + m.reach;
  const double e_uu = m.gram_uu + size * m.drift_uu, e_uv = m.gram_uv + size * m.drift_uv,
               e_vv = m.gram_vv + size * m.drift_vv;
  const double a = m.a.squaredNorm() - n.dot(m.uu), b = m.a.dot(m.b) - n.dot(m.uv),
               c = m.b.squaredNorm() - n.dot(m.vv);
  const double low_a = a - e_uu - e_uv, low_c = c - e_vv - e_uv;
  if (low_a > 0.0 && low_c > 0.0 && low_a * low_c > b * b) return false;
  // Too hollow for the ball all over: no contact inside, other tests exclude it.
  const double high_a = a + e_uu + e_uv, high_c = c + e_vv + e_uv;
  return high_a > 0.0 && high_c > 0.0 && high_a * high_c > b * b;
}

// The tree below one leaf of the surface; indices count from its own first node and leaf.
class LeafRefiner {
 public:
  LeafRefiner(const Piece& piece, std::int32_t piece_index, const Rect& rect, double radius, SearchTree& out)
      : piece_(piece),
        piece_index_(piece_index),
        shape_{piece.net.degree_u, piece.net.degree_v},
        radius_(radius),
        out_(out) {
    Vec4* points = levels_[0].data();
    std::copy(piece.net.points.begin(), piece.net.points.end(), points);
    RestrictNet(shape_, points, rect.u0, rect.u1, rect.v0, rect.v1);
    Split(points, rect, 0);
  }

 private:
  void Split(const Vec4* points, const Rect& rect, int level) {
    std::array<Vec3, kMaxNetPoints> hull;
    const int hull_count = HullPoints(shape_, points, hull.data());
    const RectBounds bounds = BoundPoints(shape_, points, hull.data(), hull_count);
    const double mu = 0.5 * (rect.u0 + rect.u1), mv = 0.5 * (rect.v0 + rect.v1);
    const LeafModel model = MakeLeafModel(shape_, points, piece_.net.rational, hull.data(), hull_count,
                                          Evaluate(piece_, mu, mv), rect);
    const std::size_t self = out_.nodes.size();
    out_.nodes.push_back(Node(bounds.box));
    if (level == kMaxHalvings || !NeedsSplit(model, radius_)) {
      out_.nodes[self].leaf = static_cast<std::int32_t>(out_.leaves.size());
      out_.leaves.push_back({bounds.center, bounds.axis, bounds.half, model, rect, piece_index_});
      return;
    }
    const bool along_u = model.a.squaredNorm() >= model.b.squaredNorm();
    Vec4* low = levels_[static_cast<std::size_t>(2 * level + 1)].data();
    Vec4* high = levels_[static_cast<std::size_t>(2 * level + 2)].data();
    HalveNet(shape_, points, along_u, low, high);
    Rect first = rect, second = rect;
    (along_u ? first.u1 : first.v1) = along_u ? mu : mv;
    (along_u ? second.u0 : second.v0) = along_u ? mu : mv;
    Split(low, first, level + 1);
    out_.nodes[self].right = static_cast<std::int32_t>(out_.nodes.size());
    Split(high, second, level + 1);
  }

  const Piece& piece_;
  std::int32_t piece_index_;
  NetShape shape_;
  double radius_;
  SearchTree& out_;
  std::array<std::array<Vec4, kMaxNetPoints>, 2 * kMaxHalvings + 1> levels_;
};

// The parts of one chunk of leaves, each with its own tree.
struct ChunkTrees {
  SearchTree all;
  std::vector<std::int32_t> first_node;  // of each leaf of the chunk
  std::vector<std::int32_t> first_leaf;
};

}  // namespace

SearchTree BuildSearchTree(const Surface& surface, double radius) {
  const std::size_t count = surface.leaves.size();
  std::vector<ChunkTrees> chunks((count + kChunk - 1) / kChunk);
  const RunContext run;
  const absl::Status status = ParallelFor(run, nullptr, chunks.size(), [&](std::size_t k) {
    ChunkTrees& chunk = chunks[k];
    for (std::size_t i = k * kChunk; i < std::min(count, (k + 1) * kChunk); ++i) {
      const SurfaceLeaf& leaf = surface.leaves[i];
      SearchTree part;
      LeafRefiner(surface.piece(leaf.piece), leaf.piece.value, {leaf.u0, leaf.u1, leaf.v0, leaf.v1}, radius,
                  part);
      chunk.first_node.push_back(static_cast<std::int32_t>(chunk.all.nodes.size()));
      chunk.first_leaf.push_back(static_cast<std::int32_t>(chunk.all.leaves.size()));
      chunk.all.nodes.insert(chunk.all.nodes.end(), part.nodes.begin(), part.nodes.end());
      chunk.all.leaves.insert(chunk.all.leaves.end(), part.leaves.begin(), part.leaves.end());
    }
    chunk.first_node.push_back(static_cast<std::int32_t>(chunk.all.nodes.size()));
    chunk.first_leaf.push_back(static_cast<std::int32_t>(chunk.all.leaves.size()));
  });
  PM_CHECK(status.ok());

  // Leaves in the order the tree meets them: neighbours in space are neighbours in memory.
  SearchTree tree;
  std::vector<std::int32_t> moved(surface.nodes.size());  // new index of each surface node
  for (std::size_t n = 0; n < surface.nodes.size(); ++n) {
    const SurfaceNode& node = surface.nodes[n];
    moved[n] = static_cast<std::int32_t>(tree.nodes.size());
    if (node.leaf < 0) {
      tree.nodes.push_back(Node(node.box));
      tree.nodes.back().right = node.right;  // still the old index
      continue;
    }
    const std::size_t leaf = static_cast<std::size_t>(node.leaf);
    const ChunkTrees& chunk = chunks[leaf / kChunk];
    const std::size_t in_chunk = leaf % kChunk;
    const auto leaf_shift = static_cast<std::int32_t>(tree.leaves.size());
    for (std::int32_t k = chunk.first_leaf[in_chunk]; k < chunk.first_leaf[in_chunk + 1]; ++k) {
      tree.leaves.push_back(chunk.all.leaves[static_cast<std::size_t>(k)]);
    }
    for (std::int32_t k = chunk.first_node[in_chunk]; k < chunk.first_node[in_chunk + 1]; ++k) {
      SearchNode part = chunk.all.nodes[static_cast<std::size_t>(k)];
      if (part.leaf >= 0) {
        part.leaf += leaf_shift;
      } else {
        part.right = -1 - (part.right + moved[n]);  // already new: told apart by the sign
      }
      tree.nodes.push_back(part);
    }
  }
  for (SearchNode& node : tree.nodes) {
    if (node.leaf >= 0) continue;
    node.right = node.right < 0 ? -1 - node.right : moved[static_cast<std::size_t>(node.right)];
  }
  return tree;
}

}  // namespace patchmill::internal
