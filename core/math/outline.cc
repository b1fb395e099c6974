#include "core/math/outline.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace patchmill {
namespace {

constexpr int kLeafEdges = 4;
constexpr double kLeastWidth = 1e-6;  // mm

double SegmentDistance2(const Vec2& q, const Vec2& a, const Vec2& b) {
  const Vec2 d = b - a;
  const double l2 = d.squaredNorm();
  const double t = l2 > 0.0 ? std::clamp((q - a).dot(d) / l2, 0.0, 1.0) : 0.0;
  return (q - a - t * d).squaredNorm();
}

}  // namespace

std::string OutlineFault(const std::vector<Ring>& rings) {
  if (rings.empty()) return "has no ring; must have at least one";
  for (std::size_t r = 0; r < rings.size(); ++r) {
    const Ring& ring = rings[r];
    if (ring.size() < 3) return fmt::format("ring {} has {} points; must have at least 3", r, ring.size());
    Vec2 far = ring.front();
    for (std::size_t i = 0; i < ring.size(); ++i) {
      if (!ring[i].allFinite()) {
        return fmt::format("ring {}, point {} = ({:g}, {:g}); must be finite", r, i, ring[i].x(),
                           ring[i].y());
      }
      if ((ring[i] - ring[0]).norm() > (far - ring[0]).norm()) far = ring[i];
    }
    const Vec2 along = (far - ring[0]).normalized();
    double width = 0.0;
    for (const Vec2& p : ring) width = std::max(width, std::abs(Cross(along, p - ring[0])));
    if (!(width > kLeastWidth)) {
      return fmt::format("ring {} has all its points on one line; must enclose something", r);
    }
  }
  return "";
}

Outline::Outline(const std::vector<Ring>& rings) : rings_(rings) {
  for (const Ring& ring : rings_) {
    for (std::size_t i = 0; i < ring.size(); ++i) edges_.push_back({ring[i], ring[(i + 1) % ring.size()]});
  }
  if (!edges_.empty()) Build(0, static_cast<int>(edges_.size()));
}

// Neighbours along a ring are neighbours in the plan, so halving the list gives a good tree.
int Outline::Build(int first, int count) {
  const int id = static_cast<int>(nodes_.size());
  nodes_.emplace_back();
  Node node;
  node.first = first;
  node.count = count;
  node.min = node.max = edges_[static_cast<std::size_t>(first)].a;
  for (int i = first; i < first + count; ++i) {
    const Edge& e = edges_[static_cast<std::size_t>(i)];
    node.min = node.min.cwiseMin(e.a.cwiseMin(e.b));
    node.max = node.max.cwiseMax(e.a.cwiseMax(e.b));
  }
  if (count > kLeafEdges) {
    Build(first, count / 2);
    node.right = Build(first + count / 2, count - count / 2);
  }
  nodes_[static_cast<std::size_t>(id)] = node;
  return id;
}

double Outline::Distance2(int id, const Vec2& q, double best) const {
  const Node& node = nodes_[static_cast<std::size_t>(id)];
  const Vec2 off = (node.min - q).cwiseMax(q - node.max).cwiseMax(0.0);
  if (off.squaredNorm() >= best) return best;
  if (node.right < 0) {
    for (int i = node.first; i < node.first + node.count; ++i) {
      const Edge& e = edges_[static_cast<std::size_t>(i)];
      best = std::min(best, SegmentDistance2(q, e.a, e.b));
    }
    return best;
  }
  return Distance2(node.right, q, Distance2(id + 1, q, best));
}

// Parity of the edges that a ray towards +x crosses. An edge contains its lower end and not its upper one.
bool Outline::Odd(int id, const Vec2& q) const {
  const Node& node = nodes_[static_cast<std::size_t>(id)];
  if (q.y() < node.min.y() || q.y() >= node.max.y() || q.x() > node.max.x()) return false;
  if (node.right >= 0) return Odd(id + 1, q) != Odd(node.right, q);
  bool odd = false;
  for (int i = node.first; i < node.first + node.count; ++i) {
    const Edge& e = edges_[static_cast<std::size_t>(i)];
    if ((e.a.y() <= q.y()) == (e.b.y() <= q.y())) continue;
    const bool up = e.b.y() > e.a.y();
    const Vec2 &low = up ? e.a : e.b, &high = up ? e.b : e.a;
    if (Cross(high - low, q - low) > 0.0) odd = !odd;
  }
  return odd;
}

double Outline::SignedDistance(const Vec2& q) const {
  if (nodes_.empty()) return -kInfinity;
  const double distance = std::sqrt(Distance2(0, q, kInfinity));
  return Odd(0, q) ? distance : -distance;
}

}  // namespace patchmill
