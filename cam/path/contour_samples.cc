#include "cam/path/contour_samples.h"

#include <algorithm>
#include <cmath>

#include "cam/path/chord_thinning.h"
#include "cam/path/spacing.h"
#include "core/base/parallel.h"
#include "core/base/status.h"
#include "core/diffgeo/forms.h"

namespace patchmill {
namespace {

constexpr double kMostSamples = 120000.0;  // about, of a whole surface
constexpr int kMostNodes = 256;            // grid steps of a piece, each way
constexpr double kSlopePerStep = 0.3;      // rad
// mm: a sample's ball may be in the ground by this and still count as free.
constexpr double kFreeSlack = 1e-7;
// mm: how exactly lower ends are found before they are compared, and after.
constexpr double kRoughEnd = 2e-3, kExactEnd = 1e-8;

struct Node {
  Vec3 p = Vec3::Zero();
  Vec3 center = Vec3::Zero();
  double slope = 0.0;
  double step = 0.0;
  bool regular = false;    // has a normal
  bool steep = false;      // slope in the window
  bool reachable = false;  // and the ball is free
};

// Least number of grid steps on a piece, from how its leaves bend: small round features must not fall between
// the nodes.
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

  void Run(const RunContext& run, std::vector<ContourSample>& samples, std::vector<LowerEnd>& ends) {
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
    for (int i = 0; i <= nu; ++i) {
      for (int j = 0; j <= nv; ++j) {
        const Node& n = nodes[index(i, j)];
        double up = 0.0, down = 0.0;
        double top = 0.0, bottom = 0.0;                // the same beyond the window
        Vec3 along[2] = {Vec3::Zero(), Vec3::Zero()};  // half way to the neighbours, from side to side
        const Vec2 uv(double(i) / nu, double(j) / nv);
        for (const auto& [di, dj] : {std::pair{1, 0}, std::pair{0, 1}, std::pair{-1, 0}, std::pair{0, -1}}) {
          if (i + di < 0 || i + di > nu || j + dj < 0 || j + dj > nv) {
            if (n.reachable) BorderEnd(n, i, j, di, dj, nu, nv, ends);
            continue;
          }
          const Node& m = nodes[index(i + di, j + dj)];
          if (!n.reachable) continue;
          if (!m.regular) continue;
          along[dj != 0] += 0.5 * (di + dj) * (m.center - n.center);
          double rise = m.center.z() - n.center.z();
          top = std::max(top, 0.5 * rise);
          bottom = std::max(bottom, -0.5 * rise);
          if (!m.steep) {  // up to where the slope leaves the window
            const double limit = m.slope < n.slope ? params_.window.min : params_.window.max;
            rise *= 2.0 * std::clamp((n.slope - limit) / (n.slope - m.slope), 0.0, 1.0);
          }
          up = std::max(up, 0.5 * rise);
          down = std::max(down, -0.5 * rise);
          if (m.steep && !m.reachable && rise < 0.0)
            ends_.push_back({uv, Vec2(double(i + di) / nu, double(j + dj) / nv), n.center.z(), m.center.z()});
        }
        const double most = 2.0 * spacing_;
        // Levels through a stretch of ground are as long together as it is large, times the sine of its
        // slope.
        const double size = along[0].cross(along[1]).norm() * std::sin(n.slope);
        const double width = top + bottom > 0.0 ? size / (top + bottom) : 0.0;
        if (n.reachable)
          samples.push_back({n.center, std::min(up, most), std::min(down, most), n.step, width});
      }
    }
    SolveEnds(run, ends);
  }

 private:
  Vec3 At(double t, double other, bool along_u) const {
    return along_u ? Position(context_.locator.surface().piece(piece_), t, other)
                   : Position(context_.locator.surface().piece(piece_), other, t);
  }

  bool Free(const Vec3& center) const {
    return center.z() >= params_.floor_z + context_.locator.radius() - kFreeSlack &&
           context_.locator.Free(center, kFreeSlack, CertificateGap(params_));
  }

  Node MakeNode(const Vec2& uv) const {
    Node node;
    const SurfaceJet jet = Evaluate(context_.locator.surface(), piece_, uv.x(), uv.y());
    node.p = jet.p;
    std::optional<Vec3> n = UpwardNormal(jet);
    if (!n) return node;
    node.slope = std::atan2(std::hypot(n->x(), n->y()), n->z());
    const double radius = context_.locator.radius();
    node.center = jet.p + radius * *n;
    node.regular = true;
    if (node.slope < params_.window.min || node.slope > params_.window.max + 1e-6) return node;
    node.steep = true;
    node.reachable = Free(node.center);
    if (!node.reachable && n->z() < 1e-6) {  // a vertical wall has two sides
      const Vec3 other = jet.p - radius * *n;
      if (Free(other)) {
        node.center = other;
        node.reachable = true;
        n = -*n;
      }
    }
    if (!node.reachable) return node;
    // Across the feed: the steepest direction.
    Vec3 steepest = Vec3::UnitZ() - n->z() * *n;
    if (steepest.norm() < 1e-9) steepest = jet.du;
    const double kappa = NormalCurvature(Forms(jet, *n), jet, steepest);
    node.step =
        CenterStep(radius, params_.scallop, std::isfinite(kappa) ? kappa : 0.0) * std::sin(node.slope);
    return node;
  }

  // A grid edge from a reachable node down to one that is not.
  struct EndEdge {
    Vec2 good, bad;
    double good_z = 0.0, bad_z = 0.0;
  };

  // Where along the edge the ball stops being free, until the height is known to `place` (mm).
  void Solve(EndEdge& edge, double place) const {
    for (int k = 0; k < 40 && std::abs(edge.good_z - edge.bad_z) > place; ++k) {
      const Vec2 middle = 0.5 * (edge.good + edge.bad);
      const Node node = MakeNode(middle);
      (node.reachable ? edge.good : edge.bad) = middle;
      if (node.steep) (node.reachable ? edge.good_z : edge.bad_z) = node.center.z();
    }
  }

  // Only ends that share their height with others are worth an exact height: a level can lie there.
  void SolveEnds(const RunContext& run, std::vector<LowerEnd>& ends) {
    for (EndEdge& edge : ends_) {
      if (run.Cancelled()) return;
      Solve(edge, kRoughEnd);
    }
    std::vector<double> rough;
    for (const EndEdge& edge : ends_) rough.push_back(edge.good_z);
    std::sort(rough.begin(), rough.end());
    for (EndEdge& edge : ends_) {
      if (run.Cancelled()) return;
      const auto from = std::lower_bound(rough.begin(), rough.end(), edge.good_z - kRoughEnd);
      const auto to = std::upper_bound(rough.begin(), rough.end(), edge.good_z + kRoughEnd);
      if (to - from < 2) continue;
      Solve(edge, kExactEnd);
      ends.push_back({edge.good_z, spacing_});
    }
  }

  // A reachable node on an open side whose face ends there downward.
  void BorderEnd(const Node& n, int i, int j, int di, int dj, int nu, int nv,
                 std::vector<LowerEnd>& ends) const {
    const int side = dj < 0 ? 0 : di > 0 ? 1 : dj > 0 ? 2 : 3;
    if (context_.sides.At(piece_, side).kind != SideKind::kOpen) return;
    const double t = side % 2 == 0 ? double(i) / nu : double(j) / nv;
    const std::optional<Vec3> out = OutwardTangent(context_.locator.surface(), piece_, side, t);
    if (out && out->z() < -1e-3) ends.push_back({n.center.z(), spacing_});
  }

  const LevelContext& context_;
  const ContourParams& params_;
  PieceId piece_;
  double spacing_;
  Fineness fineness_;
  std::vector<EndEdge> ends_;
};

}  // namespace

absl::StatusOr<ContourGround> SampleGround(const LevelContext& context, const ContourParams& params,
                                           const RunContext& run) {
  const Surface& surface = context.locator.surface();
  double area = 0.0;
  for (const SurfaceLeaf& leaf : surface.leaves) area += 4.0 * leaf.half().x() * leaf.half().y();
  ContourGround ground;
  ground.spacing = std::max(context.locator.radius() / 6.0, std::sqrt(area / kMostSamples));
  std::vector<ContourGround> parts(surface.pieces.size());
  const std::vector<Fineness> fineness = BendOfPieces(context);
  PM_RETURN_IF_ERROR(ParallelFor(run, "contours: ground", parts.size(), [&](std::size_t i) {
    PieceSampler(context, params, PieceId(i), ground.spacing, fineness[i])
        .Run(run, parts[i].samples, parts[i].lower_ends);
  }));
  for (ContourGround& part : parts) {
    ground.samples.insert(ground.samples.end(), part.samples.begin(), part.samples.end());
    ground.lower_ends.insert(ground.lower_ends.end(), part.lower_ends.begin(), part.lower_ends.end());
  }
  return ground;
}

}  // namespace patchmill
