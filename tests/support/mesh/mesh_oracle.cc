#include "tests/support/mesh/mesh_oracle.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Simple_cartesian.h>

#include "core/base/status.h"

namespace patchmill::testing {
namespace {

using Kernel = CGAL::Simple_cartesian<double>;
using Triangles = std::vector<Kernel::Triangle_3>;
using Primitive = CGAL::AABB_triangle_primitive<Kernel, Triangles::const_iterator>;
using Tree = CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>>;

constexpr int kFirstDepth = 3;    // rectangles are at most 1/8 of a patch
constexpr int kDeepest = 60;      // halvings of a patch
constexpr int kMostSteps = 4000;  // of a ball on its way down

Kernel::Point_3 ToCgal(const Vec3& p) { return {p.x(), p.y(), p.z()}; }

// Tessellates one patch.
class Divider {
 public:
  Divider(const PatchShape& shape, const MeshParams& params, Triangles& out)
      : shape_(shape), triangle_(IsTriangle(shape)), params_(params), out_(out) {}

  void Run() {
    const Corner at00 = At({0, 0}), at10 = At({1, 0}), at01 = At({0, 1});
    if (triangle_) {
      Divide({at00, at10, at01}, 0);
    } else {
      const Corner at11 = At({1, 1});
      Divide({at00, at10, at11}, 0);
      Divide({at00, at11, at01}, 0);
    }
  }

 private:
  struct Corner {
    Vec2 q;
    Vec3 p;
  };
  using Corners = std::array<Corner, 3>;
  Corner At(const Vec2& q) const {
    return {q, Position(shape_, std::clamp(q.x(), 0.0, 1.0), std::clamp(q.y(), 0.0, 1.0))};
  }

  // The longest side is halved: neighbours that halve another one leave gaps within the error.
  void Divide(const Corners& c, int depth) {
    if (depth >= 2 * kFirstDepth) {
      double off = 0.0;
      Box3 box;
      for (const Corner& corner : c) box.Add(corner.p);
      const auto look = [&](double a, double b) {
        const Vec3 on = At(c[0].q + a * (c[1].q - c[0].q) + b * (c[2].q - c[0].q)).p;
        off = std::max(off, (on - c[0].p - a * (c[1].p - c[0].p) - b * (c[2].p - c[0].p)).norm());
        box.Add(on);
      };
      look(1.0 / 3.0, 1.0 / 3.0);  // most are too large, and seen to be so at once
      for (int i = 0; i < kSamples && off <= 0.5 * params_.error; ++i) {
        for (int j = i == 0 ? 1 : 0; i + j <= kSamples && j < kSamples; ++j)
          look(static_cast<double>(i) / kSamples, static_cast<double>(j) / kSamples);
      }
      if (Outside(box, off)) return;
      PM_CHECK(depth < kDeepest);
      if (off <= 0.5 * params_.error) {
        const Kernel::Triangle_3 t(ToCgal(c[0].p), ToCgal(c[1].p), ToCgal(c[2].p));
        if (!t.is_degenerate()) out_.push_back(t);
        return;
      }
    }
    std::size_t longest = 0;
    double length = -1.0;
    for (std::size_t k = 0; k < 3; ++k) {
      const Corner &from = c[k], &to = c[(k + 1) % 3];
      const double here = depth < 2 * kFirstDepth ? (to.q - from.q).norm() : LengthOf(from, to);
      if (here > length) {
        length = here;
        longest = k;
      }
    }
    const Corner &from = c[longest], &to = c[(longest + 1) % 3], &apex = c[(longest + 2) % 3];
    const Corner middle = At(0.5 * (from.q + to.q));
    Divide({from, middle, apex}, depth + 1);
    Divide({middle, to, apex}, depth + 1);
  }

  // Along the surface: the ends of a side that is folded over lie together.
  double LengthOf(const Corner& from, const Corner& to) const {
    double length = 0.0;
    Vec3 last = from.p;
    for (int k = 1; k < kSamples; ++k) {
      const Vec3 next = At(from.q + static_cast<double>(k) / kSamples * (to.q - from.q)).p;
      length += (next - last).norm();
      last = next;
    }
    return length + (to.p - last).norm();
  }

  bool Outside(const Box3& box, double off) const {
    if (!params_.window) return false;
    const double more = params_.reach + params_.error + 4.0 * off;
    return box.max.x() < params_.window->first.x() - more ||
           box.min.x() > params_.window->second.x() + more ||
           box.max.y() < params_.window->first.y() - more || box.min.y() > params_.window->second.y() + more;
  }

  static constexpr int kSamples = 4;  // a side: 12 places and the corners
  const PatchShape& shape_;
  bool triangle_;
  const MeshParams& params_;
  Triangles& out_;
};

}  // namespace

struct MeshOracle::Mesh {
  Triangles triangles;
  Tree tree;
  double top = -kInfinity, bottom = kInfinity;
};

MeshOracle::MeshOracle(const PatchModel& model, const MeshParams& params) : mesh_(std::make_unique<Mesh>()) {
  for (const Patch& patch : model.patches) Divider(patch.shape, params, mesh_->triangles).Run();
  for (const Kernel::Triangle_3& t : mesh_->triangles) {
    mesh_->top = std::max(mesh_->top, t.bbox().zmax());
    mesh_->bottom = std::min(mesh_->bottom, t.bbox().zmin());
  }
  mesh_->tree.insert(mesh_->triangles.begin(), mesh_->triangles.end());
  mesh_->tree.build();
  mesh_->tree.accelerate_distance_queries();
}

MeshOracle::~MeshOracle() = default;

std::optional<MeshOracle::Bracket> MeshOracle::Height(const Vec2& q, double radius, double within) const {
  // The distance to the triangles tells how far the ball may come down at least, and its nearest point how
  // far it may come down at most.
  Bracket bracket;
  double z = mesh_->top + radius;
  for (int step = 0; step < kMostSteps && z > mesh_->bottom - radius; ++step) {
    const Kernel::Point_3 near = mesh_->tree.closest_point({q.x(), q.y(), z});
    const Vec3 p(near.x(), near.y(), near.z());
    const double rim = radius * radius - (Xy(p) - q).squaredNorm();
    if (rim >= 0.0) bracket.low = std::max(bracket.low, p.z() + std::sqrt(rim));
    if (z - bracket.low <= within) break;
    z -= std::max((Vec3(q.x(), q.y(), z) - p).norm() - radius, 1e-3 * within);
  }
  if (bracket.low == -kInfinity && z <= mesh_->bottom - radius) return std::nullopt;
  bracket.high = std::max(z, bracket.low);
  return bracket;
}

std::size_t MeshOracle::triangle_count() const { return mesh_->triangles.size(); }

}  // namespace patchmill::testing
