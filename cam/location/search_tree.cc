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

// The binary tree below one leaf of the surface, in depth-first order as SurfaceNode; indices count from its
// own first node and leaf.
struct LeafTree {
  std::vector<SurfaceNode> nodes;
  std::vector<SearchLeaf> leaves;
};

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

class LeafRefiner {
 public:
  LeafRefiner(const Surface& surface, const SurfaceLeaf& leaf, double radius, LeafTree& out)
      : whole_(leaf),
        piece_(surface.piece(leaf.piece)),
        piece_index_(leaf.piece.value),
        shape_{piece_.net.degree_u, piece_.net.degree_v},
        radius_(radius),
        out_(out) {
    const Rect rect{leaf.u0, leaf.u1, leaf.v0, leaf.v1};
    Vec4* points = levels_[0].data();
    std::copy(piece_.net.points.begin(), piece_.net.points.end(), points);
    RestrictNet(shape_, points, rect.u0, rect.u1, rect.v0, rect.v1);
    Split(points, rect, 0);
  }

 private:
  void Split(const Vec4* points, const Rect& rect, int level) {
    std::array<Vec3, kMaxNetPoints> hull;
    const int hull_count = HullPoints(shape_, points, hull.data());
    RectBounds bounds;
    if (level == 0) {  // the surface has them but for the box
      bounds = {Box3{}, whole_.center, whole_.axis, whole_.half};
      for (int k = 0; k < hull_count; ++k) bounds.box.Add(hull[static_cast<std::size_t>(k)]);
    } else {
      bounds = BoundPoints(shape_, points, hull.data(), hull_count);
    }
    const double mu = 0.5 * (rect.u0 + rect.u1), mv = 0.5 * (rect.v0 + rect.v1);
    const LeafModel model = MakeLeafModel(shape_, points, piece_.net.rational, hull.data(), hull_count,
                                          Evaluate(piece_, mu, mv), rect);
    const std::size_t self = out_.nodes.size();
    out_.nodes.push_back({bounds.box, 0, -1});
    if (level == kMaxHalvings || !NeedsSplit(model, radius_)) {
      out_.nodes[self].leaf = static_cast<std::int32_t>(out_.leaves.size());
      out_.leaves.push_back({bounds.center, bounds.axis, bounds.half, model, piece_index_,
                             static_cast<float>(rect.u0), static_cast<float>(rect.u1),
                             static_cast<float>(rect.v0), static_cast<float>(rect.v1)});
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

  const SurfaceLeaf& whole_;
  const Piece& piece_;
  std::int32_t piece_index_;
  NetShape shape_;
  double radius_;
  LeafTree& out_;
  std::array<std::array<Vec4, kMaxNetPoints>, 2 * kMaxHalvings + 1> levels_;
};

// Writes nodes of four children: each takes the binary node's children and opens the largest ones.
class Collapser {
 public:
  // first_leaf: where the leaves of each part are in `out`.
  Collapser(const Surface& surface, const std::vector<LeafTree>& parts,
            const std::vector<std::int32_t>& first_leaf, SearchTree& out)
      : surface_(surface), parts_(parts), first_leaf_(first_leaf), out_(out) {
    const Item root = Resolve({-1, 0});
    if (IsLeaf(root)) {  // a single leaf: a root with one child
      out_.nodes.emplace_back();
      Fill(0, {root});
    } else {
      Emit(root);
    }
  }

 private:
  // A node of the surface's tree (part < 0) or of one leaf's.
  struct Item {
    std::int32_t part;
    std::int32_t node;
  };

  const SurfaceNode& Node(const Item& i) const {
    return i.part < 0 ? surface_.nodes[static_cast<std::size_t>(i.node)]
                      : parts_[static_cast<std::size_t>(i.part)].nodes[static_cast<std::size_t>(i.node)];
  }
  // A leaf of the surface is the root of its own tree.
  Item Resolve(const Item& i) const { return i.part < 0 && Node(i).leaf >= 0 ? Item{Node(i).leaf, 0} : i; }
  bool IsLeaf(const Item& i) const { return Node(i).leaf >= 0; }

  static double Size(const Box3& box) {
    const Vec3 d = box.max - box.min;
    return d.x() * d.y() + d.y() * d.z() + d.z() * d.x();
  }

  std::int32_t Emit(const Item& item) {
    std::vector<Item> children = {item};
    while (children.size() < 4) {
      std::size_t largest = children.size();
      for (std::size_t k = 0; k < children.size(); ++k) {
        if (IsLeaf(children[k])) continue;
        if (largest == children.size() || Size(Node(children[k]).box) > Size(Node(children[largest]).box)) {
          largest = k;
        }
      }
      if (largest == children.size()) break;
      const Item open = children[largest];
      children[largest] = Resolve({open.part, open.node + 1});
      children.insert(children.begin() + static_cast<std::ptrdiff_t>(largest) + 1,
                      Resolve({open.part, Node(open).right}));
    }
    const auto self = static_cast<std::int32_t>(out_.nodes.size());
    out_.nodes.emplace_back();
    Fill(self, children);
    return self;
  }

  void Fill(std::int32_t self, const std::vector<Item>& children) {
    SearchNode node;
    for (int k = 0; k < 4; ++k) {
      Box3 box;
      node.child[k] = 0;
      if (k < static_cast<int>(children.size())) box = Node(children[static_cast<std::size_t>(k)]).box;
      node.min_x[k] = RoundDown(box.min.x());
      node.min_y[k] = RoundDown(box.min.y());
      node.min_z[k] = RoundDown(box.min.z());
      node.max_x[k] = RoundUp(box.max.x());
      node.max_y[k] = RoundUp(box.max.y());
      node.max_z[k] = RoundUp(box.max.z());
    }
    for (std::size_t k = 0; k < children.size(); ++k) {
      const Item& c = children[k];
      if (IsLeaf(c)) {
        node.child[k] = ~(first_leaf_[static_cast<std::size_t>(c.part)] + Node(c).leaf);
      } else {
        node.child[k] = Emit(c);
      }
    }
    out_.nodes[static_cast<std::size_t>(self)] = node;
  }

  const Surface& surface_;
  const std::vector<LeafTree>& parts_;
  const std::vector<std::int32_t>& first_leaf_;
  SearchTree& out_;
};

}  // namespace

absl::StatusOr<SearchTree> BuildSearchTree(const Surface& surface, double radius, const RunContext& run) {
  const std::size_t count = surface.leaves.size();
  std::vector<LeafTree> parts(count);
  PM_RETURN_IF_ERROR(ParallelFor(run, nullptr, (count + kChunk - 1) / kChunk, [&](std::size_t chunk) {
    for (std::size_t i = chunk * kChunk; i < std::min(count, (chunk + 1) * kChunk); ++i) {
      LeafRefiner(surface, surface.leaves[i], radius, parts[i]);
    }
  }));
  SearchTree tree;
  std::size_t leaves = 0;
  for (const LeafTree& part : parts) leaves += part.leaves.size();
  tree.leaves.reserve(leaves);
  std::vector<std::int32_t> first_leaf(count);
  for (std::size_t i = 0; i < count; ++i) {
    first_leaf[i] = static_cast<std::int32_t>(tree.leaves.size());
    tree.leaves.insert(tree.leaves.end(), parts[i].leaves.begin(), parts[i].leaves.end());
    std::vector<SearchLeaf>().swap(parts[i].leaves);  // never twice in memory
  }
  PM_RETURN_IF_ERROR(run.Check());
  tree.nodes.reserve(leaves / 2 + 1);
  Collapser(surface, parts, first_leaf, tree);
  return tree;
}

}  // namespace patchmill::internal
