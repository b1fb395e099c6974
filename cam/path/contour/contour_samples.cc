#include "cam/path/contour/contour_samples.h"

#include <algorithm>
#include <cmath>

#include "cam/path/chord/chord_thinning.h"
#include "cam/path/reach/cell_reach.h"
#include "cam/path/stepover/step_over.h"
#include "core/base/parallel.h"
#include "core/base/status.h"
#include "core/diffgeo/forms.h"

namespace patchmill {
namespace {

constexpr double kMostSamples = 120000.0;  // about; samples of a whole surface
constexpr int kMostNodes = 256;            // grid steps of a piece, each way
constexpr double kSlopePerStep = 0.3;      // rad: largest change of slope per grid step
constexpr std::size_t kNone = ~std::size_t{0};
constexpr double kAtLimit = 1e-6;  // rad: the window is wider by this at its steep end
// mm: a sample's ball may enter the surface by this much and still count as free.
constexpr double kFreeSlack = 1e-7;
// mm: accuracy of the lower ends before they are compared, and after.
constexpr double kRoughEnd = 2e-3, kExactEnd = 1e-8;

struct Node {
  Vec3 p = Vec3::Zero();
  Vec3 normal = Vec3::UnitZ();  // towards the side of the ball
  double turn = 1.0;            // 1 where du x dv points to that side, else -1
  Vec3 center = Vec3::Zero();
  double slope = 0.0;
  double step = 0.0;
  bool regular = false;    // has a normal
  bool steep = false;      // slope in the window
  bool reachable = false;  // steep, and the ball is free
  // mm: the step on the other side of a vertical face if the ball is free there too; else 0.
  double other_step = 0.0;
};

// Least number of grid steps on a piece, from the bend of its leaves. Small round features must not fall
// between the nodes.
struct Fineness {
  int u = 1, v = 1;
};

std::vector<Fineness> BendOfPieces(const LevelContext& context) {
  const Surface& surface = context.locator.surface();
  std::vector<Fineness> all(surface.pieces.size());
  for (std::size_t i = 0; i < surface.leaves.size(); ++i) {
    const SurfaceLeaf& leaf = surface.leaves[i];
    const SlopeRange slope = SlopesOf(context.bounds.Normals(i));
    const double cuts = std::clamp(std::ceil((slope.max - slope.min) / kSlopePerStep), 1.0, 4.0);
    Fineness& f = all[leaf.piece.index()];
    f.u = std::max(f.u, std::min(kMostNodes, static_cast<int>(cuts / (leaf.u1 - leaf.u0))));
    f.v = std::max(f.v, std::min(kMostNodes, static_cast<int>(cuts / (leaf.v1 - leaf.v0))));
  }
  return all;
}

class PieceSampler {
 public:
  PieceSampler(const LevelContext& context, const ContourParams& params, PieceId piece, double spacing,
               const Fineness& fineness)
      : context_(context), params_(params), piece_(piece), spacing_(spacing), fineness_(fineness) {}

  void Run(const RunContext& run, ContourArea& contour_area) {
    const auto count = [&](bool along_u) {
      double longest = 0.0;
      for (const double other : {0.0, 0.5, 1.0}) {
        double length = 0.0;
        Vec3 last = At(0.0, other, along_u);
        for (int k = 1; k <= 8; ++k) {
          const Vec3 next = At(k / 8.0, other, along_u);
          length += (next - last).norm();
          last = next;
        }
        longest = std::max(longest, length);
      }
      return std::clamp(static_cast<int>(std::ceil(longest / spacing_)), along_u ? fineness_.u : fineness_.v,
                        kMostNodes);
    };
    const int nu = count(true), nv = count(false);
    std::vector<Node> nodes(static_cast<std::size_t>((nu + 1) * (nv + 1)));
    const auto index = [&](int i, int j) { return static_cast<std::size_t>(i * (nv + 1) + j); };
    for (int i = 0; i <= nu; ++i) {
      if (run.Cancelled()) return;
      for (int j = 0; j <= nv; ++j) nodes[index(i, j)] = MakeNode(Vec2(double(i) / nu, double(j) / nv));
    }
    std::vector<std::size_t> sample(nodes.size(), kNone);
    for (int i = 0; i <= nu; ++i) {
      for (int j = 0; j <= nv; ++j) {
        const Node& n = nodes[index(i, j)];
        if (!n.reachable) continue;
        const Vec2 uv(double(i) / nu, double(j) / nv);
        // Extents on the node's side of the surface, and on the other side.
        Extent here, beyond;
        for (const auto& [di, dj] : {std::pair{1, 0}, std::pair{0, 1}, std::pair{-1, 0}, std::pair{0, -1}}) {
          if (i + di < 0 || i + di > nu || j + dj < 0 || j + dj > nv) {
            BorderEnd(n, uv, {di, dj}, contour_area.lower_ends);
            continue;
          }
          const Node& m = nodes[index(i + di, j + dj)];
          if (!m.regular) continue;
          const double rise = Add(n, m, 1.0, {di, dj}, here);
          if (n.other_step > 0.0) Add(n, m, -1.0, {di, dj}, beyond);
          if (m.steep && !m.reachable && rise < 0.0)
            ends_.push_back({uv, Vec2(double(i + di) / nu, double(j + dj) / nv), n.center, m.center.z()});
          if (m.reachable && di + dj < 0) {  // m has its sample already
            contour_area.neighbors.emplace_back(sample[index(i + di, j + dj)], contour_area.samples.size());
            contour_area.widest = std::max(contour_area.widest, (m.p - n.p).norm());
          }
        }
        sample[index(i, j)] = contour_area.samples.size();
        contour_area.samples.push_back(SampleOf(n, here, n.center, n.step));
        if (n.other_step > 0.0) {
          contour_area.neighbors.emplace_back(contour_area.samples.size() - 1, contour_area.samples.size());
          const Vec3 center = n.p - context_.locator.radius() * n.normal;
          contour_area.samples.push_back(SampleOf(n, beyond, center, n.other_step));
        }
      }
    }
    SolveEnds(run, contour_area.lower_ends);
  }

 private:
  // The heights that the sample of a node stands for: half way to the centres over its neighbours, mm in z,
  // from the centre over the node.
  struct Extent {
    double above = 0.0, below = 0.0;
    double all_above = 0.0, all_below = 0.0;  // the same, outside of the slope window too
    // Along u and along v: the way of the centre from half way to the neighbour before to half way to the
    // next.
    Vec3 along[2] = {Vec3::Zero(), Vec3::Zero()};
  };

  // From a node to one of its neighbours on the grid: one of the two is 1 or -1, the other 0.
  struct GridStep {
    int i = 0, j = 0;
  };

  // Extends the extent of node n towards its neighbour m. The ball is on the node's side of the surface
  // (`side` 1) or on the other one (-1). Returns by how much (mm) the centre over m is higher than that over
  // n.
  double Add(const Node& n, const Node& m, double side, const GridStep& to, Extent& extent) const {
    const double radius = context_.locator.radius();
    // The ball stays on the same side of the surface at m, even if that side looks down there.
    const Vec3 normal_n = side * n.normal, normal_m = side * n.turn * m.turn * m.normal;
    const Vec3 way = (m.p + radius * normal_m) - (n.p + radius * normal_n);
    const double slope = normal_m.z() < 0.0 ? kPi - m.slope : m.slope;
    extent.along[to.j != 0] += 0.5 * (to.i + to.j) * way;
    double rise = way.z();
    extent.all_above = std::max(extent.all_above, 0.5 * rise);
    extent.all_below = std::max(extent.all_below, -0.5 * rise);
    if (slope < params_.pass.window.min || slope > params_.pass.window.max + kAtLimit) {
      // Count only the part up to where the slope leaves the window.
      const double limit = slope < n.slope ? params_.pass.window.min : params_.pass.window.max;
      rise *= 2.0 * std::clamp((n.slope - limit) / (n.slope - slope), 0.0, 1.0);
    }
    extent.above = std::max(extent.above, 0.5 * rise);
    extent.below = std::max(extent.below, -0.5 * rise);
    return way.z();
  }

  ContourSample SampleOf(const Node& n, const Extent& extent, const Vec3& center, double step) const {
    const double most = 2.0 * spacing_;
    // Levels a height dz apart have on an area the total length area sin(slope) / dz. Here dz = high.
    const double size = extent.along[0].cross(extent.along[1]).norm() * std::sin(n.slope);
    const double high = extent.all_above + extent.all_below;
    return {center, std::min(extent.above, most),   std::min(extent.below, most),
            step,   high > 0.0 ? size / high : 0.0, n.p};
  }

  Vec3 At(double t, double other, bool along_u) const {
    return along_u ? Position(context_.locator.surface().piece(piece_), t, other)
                   : Position(context_.locator.surface().piece(piece_), other, t);
  }

  bool Free(const Vec3& center) const {
    return center.z() >= params_.pass.floor_z + context_.locator.radius() - kFreeSlack &&
           context_.locator.Free(center, kFreeSlack, CertificateGap(params_.pass));
  }

  Node MakeNode(const Vec2& uv) const {
    Node node;
    const SurfaceJet jet = Evaluate(context_.locator.surface(), piece_, uv.x(), uv.y());
    node.p = jet.p;
    const std::optional<Vec3> n = UpwardNormal(jet);
    if (!n) return node;
    // A wall that overhangs a little counts as steep as a vertical one.
    node.slope = std::atan2(std::hypot(n->x(), n->y()), std::max(n->z(), 0.0));
    const double radius = context_.locator.radius();
    node.normal = *n;
    node.turn = n->dot(jet.du.cross(jet.dv)) < 0.0 ? -1.0 : 1.0;
    node.center = jet.p + radius * *n;
    node.regular = true;
    if (node.slope < params_.pass.window.min || node.slope > params_.pass.window.max + kAtLimit) return node;
    node.steep = true;
    node.reachable = Free(node.center);
    const bool beyond = HasTwoSides(jet, *n) && Free(jet.p - radius * *n);
    if (!node.reachable && beyond) {
      node.normal = -*n;
      node.turn = -node.turn;
      node.center = jet.p - radius * *n;
    }
    // The direction across the feed is the steepest one.
    const auto step = [&](const Vec3& e) {
      Vec3 steepest = Vec3::UnitZ() - e.z() * e;
      if (steepest.norm() < 1e-9) steepest = jet.du;
      const double kappa = NormalCurvature(Forms(jet, e), jet, steepest);
      return CenterStep(radius, params_.pass.scallop, std::isfinite(kappa) ? kappa : 0.0) *
             std::sin(node.slope);
    };
    if (node.reachable && beyond) node.other_step = step(-node.normal);
    node.reachable = node.reachable || beyond;
    if (node.reachable) node.step = step(node.normal);
    return node;
  }

  // A grid edge from a reachable node down to one that is not.
  struct EndEdge {
    Vec2 good, bad;
    Vec3 good_center;
    double bad_z = 0.0;
  };

  // Halves the grid edge until the height of the last free centre on it is known to `place` (mm).
  void Solve(EndEdge& edge, double place) const {
    for (int k = 0; k < 40 && std::abs(edge.good_center.z() - edge.bad_z) > place; ++k) {
      const Vec2 middle = 0.5 * (edge.good + edge.bad);
      const Node node = MakeNode(middle);
      (node.reachable ? edge.good : edge.bad) = middle;
      if (node.reachable) {
        edge.good_center = node.center;
      } else if (node.steep) {
        edge.bad_z = node.center.z();
      }
    }
  }

  // Solves the lower ends: first roughly, then exactly those that lie at the same height as others, since a
  // level can lie there.
  void SolveEnds(const RunContext& run, std::vector<LowerEnd>& ends) {
    for (EndEdge& edge : ends_) {
      if (run.Cancelled()) return;
      Solve(edge, kRoughEnd);
    }
    std::vector<double> rough;
    for (const EndEdge& edge : ends_) rough.push_back(edge.good_center.z());
    std::sort(rough.begin(), rough.end());
    for (EndEdge& edge : ends_) {
      if (run.Cancelled()) return;
      const auto from = std::lower_bound(rough.begin(), rough.end(), edge.good_center.z() - kRoughEnd);
      const auto to = std::upper_bound(rough.begin(), rough.end(), edge.good_center.z() + kRoughEnd);
      if (to - from < 2) continue;
      Solve(edge, kExactEnd);
      ends.push_back({edge.good_center, spacing_});
    }
  }

  // Adds a lower end at a reachable node on a side of the piece, if that side is open and the face descends
  // towards it. The node is at `uv`; the grid step `over` leads from it out of the piece.
  void BorderEnd(const Node& n, const Vec2& uv, const GridStep& over, std::vector<LowerEnd>& ends) const {
    const int side = over.j < 0 ? 0 : over.i > 0 ? 1 : over.j > 0 ? 2 : 3;
    if (context_.sides.At(piece_, side).kind != SideKind::kOpen) return;
    const double t = side % 2 == 0 ? uv.x() : uv.y();
    const std::optional<Vec3> out = OutwardTangent(context_.locator.surface(), piece_, side, t);
    if (out && out->z() < -1e-3) ends.push_back({n.center, spacing_});
  }

  const LevelContext& context_;
  const ContourParams& params_;
  PieceId piece_;
  double spacing_;
  Fineness fineness_;
  std::vector<EndEdge> ends_;
};

}  // namespace

absl::StatusOr<ContourArea> SampleContourArea(const LevelContext& context, const ContourParams& params,
                                              const RunContext& run) {
  const Surface& surface = context.locator.surface();
  double area = 0.0;
  for (const SurfaceLeaf& leaf : surface.leaves) area += 4.0 * leaf.half().x() * leaf.half().y();
  ContourArea contour_area;
  contour_area.spacing = std::max(context.locator.radius() / 6.0, std::sqrt(area / kMostSamples));
  std::vector<ContourArea> parts(surface.pieces.size());
  const std::vector<Fineness> fineness = BendOfPieces(context);
  PM_RETURN_IF_ERROR(ParallelFor(run, "contours: samples", parts.size(), [&](std::size_t i) {
    PieceSampler(context, params, PieceId(i), contour_area.spacing, fineness[i]).Run(run, parts[i]);
  }));
  for (ContourArea& part : parts) {
    const std::size_t before = contour_area.samples.size();
    for (const auto& [a, b] : part.neighbors) contour_area.neighbors.emplace_back(before + a, before + b);
    contour_area.widest = std::max(contour_area.widest, part.widest);
    contour_area.samples.insert(contour_area.samples.end(), part.samples.begin(), part.samples.end());
    contour_area.lower_ends.insert(contour_area.lower_ends.end(), part.lower_ends.begin(),
                                   part.lower_ends.end());
  }
  return contour_area;
}

}  // namespace patchmill
