#include "core/surface/surface.h"

#include <algorithm>
#include <atomic>
#include <cmath>

#include <absl/strings/str_cat.h>

#include "core/base/parallel.h"
#include "core/base/progress_throttle.h"
#include "core/base/share_progress.h"
#include "core/base/status.h"
#include "core/patch/split_pieces.h"
#include "core/surface/air_sides.h"
#include "core/surface/leaf_tree.h"
#include "core/surface/net_kernel.h"
#include "core/surface/write_nodes.h"

namespace patchmill {
namespace {

// A planar leaf may be large, but not curled. The box of an arc longer than a quarter circle is mostly empty.
constexpr double kMaxCurl = 0.1;

constexpr std::size_t kBatch = 2048;  // pieces per batch
constexpr const char* kStage = "bounds";

struct Leaves {
  std::vector<SurfaceLeaf> leaves;
  std::vector<Box3> boxes;  // one box per leaf

  void Append(const Leaves& more) { Append(more, 0, more.leaves.size()); }
  void Append(const Leaves& more, std::size_t from, std::size_t to) {
    leaves.insert(leaves.end(), more.leaves.data() + from, more.leaves.data() + to);
    boxes.insert(boxes.end(), more.boxes.data() + from, more.boxes.data() + to);
  }
};

// Shared by the pieces of one attempt, which gives up as soon as all leaves exceed the budget. Whether they
// do does not depend on the order of work.
struct Budget {
  double thickness;
  int max_depth;
  std::int64_t max_leaves;
  const RunContext& run;
  ShareProgress progress;
  std::atomic<std::int64_t> leaves{0};
  std::atomic<bool> exceeded{false};
};

class LeafSplitter {
 public:
  LeafSplitter(PieceId id, const BernsteinNet& net, Budget& budget)
      : id_(id), shape_{net.degree_u, net.degree_v}, budget_(budget) {
    // Two halves per level of the recursion.
    buffer_.resize(static_cast<std::size_t>(2 * (2 * budget.max_depth) * shape_.count()));
    Split(net.points.data(), {}, 0);
  }
  Leaves Take() { return std::move(out_); }

 private:
  struct Rect {
    double u0 = 0, u1 = 1, v0 = 0, v1 = 1;
    int depth_u = 0, depth_v = 0;
  };
  enum class Cut { kNone, kU, kV };

  Cut Choose(const Vec4* points, const RectBounds& bounds, const Rect& rect) const {
    const bool thick = bounds.half.z() > budget_.thickness;
    const NetBend bend = MeasureBend(shape_, points, bounds.axis.col(2), 8.0 * budget_.thickness);
    bool u = bend.curl_u > kMaxCurl, v = bend.curl_v > kMaxCurl;
    if (thick) {
      u = v = true;
    } else if (!u && !v) {
      return Cut::kNone;
    }
    u = u && rect.depth_u < budget_.max_depth;
    v = v && rect.depth_v < budget_.max_depth;
    if (!u && !v) return Cut::kNone;
    if (u != v) {
      // The other direction has reached max_depth or is straight. A cut in this one must still help.
      const double help = u ? bend.normal_u : bend.normal_v;
      const double curl = u ? bend.curl_u : bend.curl_v;
      const bool twisted = bend.normal_u + bend.normal_v < budget_.thickness;
      if (thick && !(help > 0.5 * budget_.thickness) && !twisted && !(curl > kMaxCurl)) return Cut::kNone;
      return u ? Cut::kU : Cut::kV;
    }
    // Twist alone (the lines do not bend) is halved by either cut. The longer side is cut.
    if (!thick || std::max(bend.normal_u, bend.normal_v) < 0.25 * bounds.half.z()) {
      return bend.length_u >= bend.length_v ? Cut::kU : Cut::kV;
    }
    return bend.normal_u >= bend.normal_v ? Cut::kU : Cut::kV;
  }

  void Split(const Vec4* points, const Rect& rect, int level) {
    if (budget_.exceeded.load(std::memory_order_relaxed)) return;
    std::array<Vec3, kMaxNetPoints> hull;
    const int hull_count = HullPoints(shape_, points, hull.data());
    const RectBounds bounds = BoundPoints(shape_, points, hull.data(), hull_count);
    const Cut cut = Choose(points, bounds, rect);
    if (cut == Cut::kNone) {
      Keep(bounds, rect, hull.data(), hull_count);
      return;
    }
    Vec4* low = buffer_.data() + 2 * level * shape_.count();
    Vec4* high = low + shape_.count();
    HalveNet(shape_, points, cut == Cut::kU, low, high);
    Rect first = rect, second = rect;
    if (cut == Cut::kU) {
      first.u1 = second.u0 = 0.5 * (rect.u0 + rect.u1);
      first.depth_u = second.depth_u = rect.depth_u + 1;
    } else {
      first.v1 = second.v0 = 0.5 * (rect.v0 + rect.v1);
      first.depth_v = second.depth_v = rect.depth_v + 1;
    }
    Split(low, first, level + 1);
    Split(high, second, level + 1);
  }

  void Keep(const RectBounds& bounds, const Rect& rect, const Vec3* hull, int hull_count) {
    SurfaceLeaf leaf;
    leaf.piece = id_;
    leaf.u0 = static_cast<float>(rect.u0);
    leaf.u1 = static_cast<float>(rect.u1);
    leaf.v0 = static_cast<float>(rect.v0);
    leaf.v1 = static_cast<float>(rect.v1);
    leaf.SetBox(bounds.axis, hull, hull_count);
    out_.leaves.push_back(leaf);
    out_.boxes.push_back(bounds.box);
    budget_.progress.Add(rect.depth_u + rect.depth_v);
    const bool poll = out_.leaves.size() % 256 == 0;
    if (budget_.leaves.fetch_add(1, std::memory_order_relaxed) >= budget_.max_leaves ||
        (poll && budget_.run.Cancelled())) {
      budget_.exceeded.store(true, std::memory_order_relaxed);
    }
  }

  PieceId id_;
  NetShape shape_;
  Budget& budget_;
  std::vector<Vec4> buffer_;
  Leaves out_;
};

absl::Status CheckParams(const PatchNetwork& network, const SurfaceParams& params) {
  if (network.model.patches.empty())
    return absl::InvalidArgumentError("model.patches is empty; must hold at least 1 patch");
  if (!(params.leaf_thickness > 0.0)) {
    return absl::InvalidArgumentError(
        absl::StrCat("leaf_thickness = ", params.leaf_thickness, " mm; must be > 0"));
  }
  if (params.max_depth < 0 || params.max_depth > 20) {
    return absl::InvalidArgumentError(absl::StrCat("max_depth = ", params.max_depth, "; must be in [0, 20]"));
  }
  return absl::OkStatus();
}

// Empties a patch whose points are the net of its one piece. So no net is kept twice.
void LeavePointsTo(const std::vector<Piece>& pieces, PatchShape& shape) {
  if (pieces.size() != 1 || pieces[0].speed != Vec2(1.0, 1.0)) return;
  const bool bezier = std::holds_alternative<BezierPatch>(shape);
  const auto* spline = std::get_if<BsplinePatch>(&shape);
  const bool one_span = spline != nullptr && spline->points.size() == pieces[0].net.points.size();
  if (bezier || one_span) shape = BezierPatch{pieces[0].net.degree_u, pieces[0].net.degree_v, {}, {}};
}

// True for a patch that LeavePointsTo has emptied.
bool IsHeldByPiece(const PatchShape& shape) {
  const auto* bezier = std::get_if<BezierPatch>(&shape);
  return bezier != nullptr && bezier->points.empty();
}

absl::Status MakePieces(Surface& surface, const RunContext& run) {
  std::vector<Patch>& patches = surface.network.model.patches;
  std::vector<std::vector<Piece>> parts(patches.size());
  PM_RETURN_IF_ERROR(ParallelFor(run, "pieces", patches.size(), [&](std::size_t i) {
    parts[i] = SplitIntoPieces(PatchId(i), patches[i].shape, run);
    LeavePointsTo(parts[i], patches[i].shape);
  }));
  std::size_t count = 0;
  for (const auto& part : parts) count += part.size();
  surface.pieces.reserve(count);
  surface.first_piece.reserve(patches.size());
  for (auto& part : parts) {
    surface.first_piece.emplace_back(surface.pieces.size());
    std::move(part.begin(), part.end(), std::back_inserter(surface.pieces));
  }
  return absl::OkStatus();
}

// One attempt, in batches of pieces. Returns false if the budget does not suffice.
absl::StatusOr<bool> MakeLeaves(const Surface& surface, Budget& budget, std::vector<Leaves>& batches) {
  batches.clear();
  const std::size_t count = surface.pieces.size();
  std::vector<Leaves> parts(std::min(count, kBatch));
  for (std::size_t begin = 0; begin < count; begin += kBatch) {
    const std::size_t here = std::min(count - begin, kBatch);
    PM_RETURN_IF_ERROR(ParallelFor(budget.run, nullptr, here, [&](std::size_t k) {
      const std::size_t i = begin + k;
      if (!budget.exceeded.load(std::memory_order_relaxed)) {
        parts[k] = LeafSplitter(PieceId(i), surface.pieces[i].net, budget).Take();
      }
    }));
    if (budget.exceeded.load()) return false;
    std::size_t leaves = 0;
    for (std::size_t k = 0; k < here; ++k) leaves += parts[k].leaves.size();
    Leaves& batch = batches.emplace_back();
    batch.leaves.reserve(leaves);
    batch.boxes.reserve(leaves);
    ProgressThrottle throttle;
    for (std::size_t k = 0; k < here; ++k) {
      if (k % 64 == 0) PM_RETURN_IF_ERROR(budget.run.Check());
      batch.Append(parts[k]);
      if (!throttle.Due()) continue;
      throttle.Report();
      budget.run.Progress(kStage, static_cast<double>(begin + here) / static_cast<double>(count));
    }
  }
  return true;
}

// Joins the leaves of all batches. Each batch is freed before the next one is copied.
absl::StatusOr<Leaves> Joined(std::vector<Leaves> batches, const RunContext& run) {
  if (batches.size() == 1) return std::move(batches.front());
  std::size_t count = 0;
  for (const Leaves& batch : batches) count += batch.leaves.size();
  Leaves all;
  all.leaves.reserve(count);
  all.boxes.reserve(count);
  for (Leaves& batch : batches) {
    run.Progress(kStage, 1.0);
    constexpr std::size_t kBetweenPolls = 1 << 14;
    for (std::size_t from = 0; from < batch.leaves.size(); from += kBetweenPolls) {
      PM_RETURN_IF_ERROR(run.Check());
      all.Append(batch, from, std::min(from + kBetweenPolls, batch.leaves.size()));
    }
    batch = {};
  }
  return all;
}

// Estimates the number of leaves for a thickness from the bend of whole pieces. The estimate is rather too
// high.
double EstimateLeaves(const std::vector<Piece>& pieces, double thickness, int max_depth) {
  const auto parts = [&](double bend) {
    return std::clamp(std::sqrt(bend / thickness), 1.0, std::ldexp(1.0, max_depth));
  };
  double sum = 0.0;
  for (const Piece& piece : pieces) {
    const NetShape shape{piece.net.degree_u, piece.net.degree_v};
    const NetBend bend =
        MeasureBend(shape, piece.net.points.data(), BoundNet(piece.net).axis.col(2), kInfinity);
    sum += parts(bend.normal_u) * parts(bend.normal_v);
  }
  return sum;
}

}  // namespace

absl::StatusOr<Surface> BuildSurface(PatchNetwork network, const SurfaceParams& params,
                                     const RunContext& run) {
  PM_RETURN_IF_ERROR(CheckParams(network, params));
  Surface surface;
  surface.network = std::move(network);
  PM_RETURN_IF_ERROR(MakePieces(surface, run));

  const auto pieces = static_cast<std::int64_t>(surface.pieces.size());
  const std::int64_t max_leaves = std::max<std::int64_t>(params.max_leaves, pieces);
  double thickness = params.leaf_thickness;
  std::vector<Leaves> batches;
  for (int max_depth = params.max_depth;;) {
    Budget budget{thickness, max_depth, max_leaves, run, {run, kStage, surface.pieces.size()}};
    PM_ASSIGN_OR_RETURN(const bool fits, MakeLeaves(surface, budget, batches));
    if (fits) break;
    // Skips a thickness that is hopeless even if the estimate is 16 times too high.
    do {
      PM_RETURN_IF_ERROR(run.Check());
      thickness *= 4.0;
      if (max_depth > 0 && thickness > 1e3 * params.leaf_thickness) --max_depth;  // ends in a leaf per piece
    } while (EstimateLeaves(surface.pieces, thickness, max_depth) > 16.0 * static_cast<double>(max_leaves));
  }

  PM_ASSIGN_OR_RETURN(Leaves all, Joined(std::move(batches), run));
  run.Progress("bounds: tree", 0.0);
  surface.leaves = std::move(all.leaves);
  surface.nodes = BuildLeafTree(all.boxes, run);
  PM_RETURN_IF_ERROR(run.Check());
  PM_RETURN_IF_ERROR(WriteNodes(surface.nodes, run, surface.box_nodes));
  surface.box = surface.nodes.front().box;
  surface.scale = std::max(surface.box.min.cwiseAbs().maxCoeff(), surface.box.max.cwiseAbs().maxCoeff());
  PM_RETURN_IF_ERROR(ParallelFor(run, nullptr, surface.pieces.size(), [&](std::size_t i) {
    surface.pieces[i].sides.upright = UprightOf(surface.pieces[i]);
  }));
  PM_ASSIGN_OR_RETURN(AirSides sides, FindAirSides(surface, run));
  SetAirSides(sides, surface.pieces);
  surface.two_sided_walls = std::move(sides.undecided);
  return surface;
}

SurfaceJet Evaluate(const Surface& s, PatchId id, double u, double v) {
  const PatchShape& shape = s.network.model.patches[id.index()].shape;
  if (IsHeldByPiece(shape)) return Evaluate(s, s.first_piece[id.index()], u, v);
  return Evaluate(shape, u, v);
}

PatchShape ShapeOf(const Surface& s, PatchId id) {
  const PatchShape& shape = s.network.model.patches[id.index()].shape;
  if (!IsHeldByPiece(shape)) return shape;
  const BernsteinNet& net = s.piece(s.first_piece[id.index()]).net;
  BezierPatch whole{net.degree_u, net.degree_v, {}, {}};
  for (const Vec4& p : net.points) {
    whole.points.emplace_back(p.head<3>() / p.w());
    if (net.rational) whole.weights.push_back(p.w());
  }
  return whole;
}

}  // namespace patchmill
