#include "core/crossing/embed_faces.h"

#include <algorithm>
#include <cmath>
#include <queue>
#include <set>
#include <tuple>

#include <Eigen/Eigenvalues>

#include "core/base/index.h"

namespace patchmill {
namespace {

constexpr int kSteps = 12;

struct HalfEdge {
  int edge = 0, end = 0;  // leaves the node at this end of the edge
  auto operator<=>(const HalfEdge&) const = default;
};

class Embedder {
 public:
  Embedder(const CurveGraph& graph, const std::optional<Vec3>& direction)
      : graph_(graph), direction_(direction) {}

  Embedding Embed() {
    result_.normals.assign(graph_.nodes.size(), Vec3::Zero());
    Groups();
    if (direction_) {
      std::ranges::fill(result_.normals, direction_->normalized());
    } else {
      FitNormals();
      CarrySenses();
      FillPlainNodes();
    }
    TraceFaces();
    return std::move(result_);
  }

 private:
  Vec3 Tangent(const HalfEdge& h) const { return graph_.edges[At(h.edge)].Tangent(h.end == 0); }
  int Node(const HalfEdge& h) const {
    const GraphEdge& e = graph_.edges[At(h.edge)];
    return h.end == 0 ? e.start : e.end;
  }
  std::vector<HalfEdge> Around(int node) const {
    std::vector<HalfEdge> list;
    for (const auto& [edge, end] : graph_.ends[At(node)]) list.push_back({edge, end});
    return list;
  }

  void Groups() {
    group_.assign(graph_.nodes.size(), -1);
    for (int root = 0; root < static_cast<int>(group_.size()); ++root) {
      if (group_[At(root)] >= 0) continue;
      std::vector<int> open = {root};
      group_[At(root)] = result_.groups;
      while (!open.empty()) {
        const int n = open.back();
        open.pop_back();
        for (const HalfEdge& h : Around(n)) {
          const int far = Node({h.edge, 1 - h.end});
          if (group_[At(far)] < 0) group_[At(far)] = result_.groups, open.push_back(far);
        }
      }
      ++result_.groups;
    }
  }

  void FitNormals() {
    flatness_.assign(graph_.nodes.size(), 0.0);
    for (int n = 0; n < static_cast<int>(graph_.nodes.size()); ++n) {
      const std::vector<HalfEdge> ends = Around(n);
      if (ends.size() < 3) continue;
      Vec3 mean = Vec3::Zero();
      for (const HalfEdge& h : ends) mean += Tangent(h) / double(ends.size());
      Mat3 sum = Mat3::Zero();
      for (const HalfEdge& h : ends) sum += (Tangent(h) - mean) * (Tangent(h) - mean).transpose();
      const Eigen::SelfAdjointEigenSolver<Mat3> solver(sum);
      result_.normals[At(n)] = solver.eigenvectors().col(0);
      flatness_[At(n)] = solver.eigenvalues()[1];
    }
  }

  // A normal moved along a curve without turning about it.
  static Vec3 Carry(Vec3 normal, const std::vector<Vec3>& points) {
    Vec3 before = Vec3::Zero();
    for (std::size_t k = 1; k < points.size(); ++k) {
      const Vec3 step = points[k] - points[k - 1];
      if (!(step.norm() > 0.0)) continue;
      const Vec3 now = step.normalized();
      if (!before.isZero()) normal = Eigen::Quaterniond::FromTwoVectors(before, now) * normal;
      before = now;
    }
    return normal;
  }

  std::vector<Vec3> PointsFrom(const HalfEdge& h) const {
    std::vector<Vec3> points = graph_.edges[At(h.edge)].Points(kSteps);
    if (h.end == 1) std::ranges::reverse(points);
    return points;
  }

  void CarrySenses() {
    const std::size_t count = graph_.nodes.size();
    std::vector<bool> settled(count, false);
    for (int group = 0; group < result_.groups; ++group) {
      int root = -1;
      for (int n = 0; n < static_cast<int>(count); ++n) {
        if (group_[At(n)] != group || graph_.ends[At(n)].size() < 3) continue;
        if (root < 0 || flatness_[At(n)] > flatness_[At(root)]) root = n;
      }
      if (root < 0) continue;
      // The side that shows upwards, or towards +x or +y of an upright plane, is the first one.
      Vec3& first = result_.normals[At(root)];
      if (std::tuple(first.z() < -1e-9, std::abs(first.z()) <= 1e-9 && first.x() + first.y() < 0) >
          std::tuple(false, false)) {
        first = -first;
      }
      settled[At(root)] = true;
      std::priority_queue<std::tuple<double, int, int, double>> queue;  // agreement, -to, -from, sense
      const auto push = [&](int from) {
        for (const HalfEdge& h : Around(from)) {
          HalfEdge now = h;
          std::vector<Vec3> points = PointsFrom(h);
          int far = Node({h.edge, 1 - h.end});
          // On through nodes of two edges, which have no plane of their own.
          for (int guard = 0; graph_.ends[At(far)].size() == 2 && guard < 1000; ++guard) {
            const auto next = Around(far);
            now = next[0].edge == now.edge ? next[1] : next[0];
            const std::vector<Vec3> more = PointsFrom(now);
            points.insert(points.end(), more.begin(), more.end());
            far = Node({now.edge, 1 - now.end});
          }
          if (settled[At(far)] || graph_.ends[At(far)].size() < 3) continue;
          const double dot = Carry(result_.normals[At(from)], points).dot(result_.normals[At(far)]);
          queue.emplace(std::abs(dot), -far, -from, dot < 0 ? -1.0 : 1.0);
        }
      };
      push(root);
      while (!queue.empty()) {
        const auto [agreement, far, from, sense] = queue.top();
        queue.pop();
        if (settled[At(-far)]) continue;
        settled[At(-far)] = true;
        result_.normals[At(-far)] *= sense;
        push(-far);
      }
    }
  }

  // Nodes of two edges get the normal of a neighbour, carried along; a loop of them that of its area.
  void FillPlainNodes() {
    for (bool again = true; again;) {
      again = false;
      for (int n = 0; n < static_cast<int>(graph_.nodes.size()); ++n) {
        if (!result_.normals[At(n)].isZero()) continue;
        for (const HalfEdge& h : Around(n)) {
          const int far = Node({h.edge, 1 - h.end});
          if (result_.normals[At(far)].isZero()) continue;
          result_.normals[At(n)] =
              Carry(result_.normals[At(far)], PointsFrom({h.edge, 1 - h.end})).normalized();
          again = true;
          break;
        }
      }
    }
    for (int n = 0; n < static_cast<int>(graph_.nodes.size()); ++n) {
      if (!result_.normals[At(n)].isZero() || graph_.ends[At(n)].empty()) continue;
      Vec3 area = Vec3::Zero();
      const Vec3 origin = graph_.nodes[At(n)].position;
      HalfEdge h = Around(n)[0];
      for (std::size_t guard = 0; guard <= graph_.edges.size(); ++guard) {
        const std::vector<Vec3> points = PointsFrom(h);
        for (std::size_t k = 1; k < points.size(); ++k)
          area += (points[k - 1] - origin).cross(points[k] - origin);
        const int far = Node({h.edge, 1 - h.end});
        if (far == n) break;
        const auto next = Around(far);
        if (next.size() < 2) break;
        h = next[0].edge == h.edge ? next[1] : next[0];
      }
      if (area.z() < 0) area = -area;
      area = area.isZero() ? Vec3(Vec3::UnitZ()) : Vec3(area.normalized());
      for (int m = 0; m < static_cast<int>(graph_.nodes.size()); ++m) {
        if (group_[At(m)] == group_[At(n)]) result_.normals[At(m)] = area;
      }
    }
  }

  void TraceFaces() {
    // The end after each one, clockwise around the node: the next side of the face on its left.
    std::vector<std::array<HalfEdge, 2>> next(graph_.edges.size());
    for (int n = 0; n < static_cast<int>(graph_.nodes.size()); ++n) {
      std::vector<HalfEdge> ends = Around(n);
      if (ends.empty()) continue;
      const Vec3& normal = result_.normals[At(n)];
      const Vec3 first = Tangent(ends[0]);
      std::vector<std::pair<double, HalfEdge>> order;
      for (const HalfEdge& h : ends)
        order.emplace_back(h == ends[0] ? 0.0 : AngleAbout(normal, first, Tangent(h)), h);
      std::ranges::sort(order);
      for (std::size_t k = 0; k < order.size(); ++k) {
        const HalfEdge& h = order[k].second;
        next[At(h.edge)][At(h.end)] = order[(k + order.size() - 1) % order.size()].second;
      }
    }
    std::set<HalfEdge> seen;
    struct Loop {
      GraphFace face;
      double turning = 0.0;
      int group = 0;
    };
    std::vector<Loop> loops;
    for (int e = 0; e < static_cast<int>(graph_.edges.size()); ++e) {
      for (const int end : {0, 1}) {
        HalfEdge h{e, end};
        if (seen.contains(h)) continue;
        Loop loop;
        loop.group = group_[At(Node(h))];
        while (seen.insert(h).second) {
          loop.face.sides.push_back({h.edge, h.end == 0});
          h = next[At(h.edge)][At(1 - h.end)];
        }
        loop.turning = Turning(loop.face);
        loops.push_back(std::move(loop));
      }
    }
    // Around a face the curves turn left by about a full turn; around the outside of a border they do not.
    for (Loop& loop : loops)
      (loop.turning < 0.5 * kPi ? result_.outer : result_.faces).push_back(std::move(loop.face));
  }

  // Sum of the turns to the left along a loop, on the surface: between straight steps about the normals
  // carried from node to node, and at the nodes.
  double Turning(const GraphFace& face) const {
    double sum = 0.0;
    const std::size_t count = face.sides.size();
    for (std::size_t k = 0; k < count; ++k) {
      const GraphSide& side = face.sides[k];
      const GraphSide& after = face.sides[(k + 1) % count];
      const HalfEdge h{side.edge, side.forward ? 0 : 1};
      const std::vector<Vec3> points = PointsFrom(h);
      const Vec3 n0 = result_.normals[At(Node(h))], n1 = result_.normals[At(Node({h.edge, 1 - h.end}))];
      for (std::size_t i = 1; i + 1 < points.size(); ++i) {
        const Vec3 a = points[i] - points[i - 1], b = points[i + 1] - points[i];
        const double share = double(i) / double(points.size() - 1);
        const Vec3 n = (1 - share) * n0 + share * n1;
        if (n.isZero()) continue;
        sum += std::atan2(n.normalized().dot(a.cross(b)), a.dot(b));
      }
      const HalfEdge back{side.edge, side.forward ? 1 : 0}, on{after.edge, after.forward ? 0 : 1};
      sum += kPi - AngleAbout(n1, Tangent(on), Tangent(back));
    }
    return sum;
  }

  const CurveGraph& graph_;
  const std::optional<Vec3>& direction_;
  Embedding result_;
  std::vector<int> group_;
  std::vector<double> flatness_;
};

}  // namespace

double AngleAbout(const Vec3& n, const Vec3& a, const Vec3& b) {
  const Vec3 u = a - n * n.dot(a), v = b - n * n.dot(b);
  const double angle = std::atan2(n.dot(u.cross(v)), u.dot(v));
  return angle < 0.0 ? angle + 2 * kPi : angle;
}

Embedding EmbedFaces(const CurveGraph& graph, const std::optional<Vec3>& direction) {
  return Embedder(graph, direction).Embed();
}

}  // namespace patchmill
