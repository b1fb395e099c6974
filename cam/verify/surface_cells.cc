#include "cam/verify/surface_cells.h"

#include "core/base/parallel.h"

namespace patchmill {

namespace {

// Length of the longest of three lines of the net along u, and of three lines along v.
std::pair<double, double> Lengths(NetShape shape, const Vec4* points) {
  const auto at = [&](int i, int j) -> Vec3 {
    const Vec4& p = points[i * (shape.degree_v + 1) + j];
    return p.w() > 0.0 ? Vec3(p.head<3>() / p.w()) : Vec3::Constant(kInfinity);
  };
  const auto step = [](const Vec3& a, const Vec3& b) {
    const double d = (b - a).norm();
    return std::isfinite(d) ? d : 0.0;
  };
  double along_u = 0.0, along_v = 0.0;
  for (const int j : {0, shape.degree_v / 2, shape.degree_v}) {
    double length = 0.0;
    for (int i = 0; i < shape.degree_u; ++i) length += step(at(i, j), at(i + 1, j));
    along_u = std::max(along_u, length);
  }
  for (const int i : {0, shape.degree_u / 2, shape.degree_u}) {
    double length = 0.0;
    for (int j = 0; j < shape.degree_v; ++j) length += step(at(i, j), at(i, j + 1));
    along_v = std::max(along_v, length);
  }
  return {along_u, along_v};
}

}  // namespace

void CellWalker::Load(const CellRect& root) {
  const BernsteinNet& net = surface_.piece(root.piece).net;
  shape_ = {net.degree_u, net.degree_v};
  const auto count = static_cast<std::size_t>(shape_.count());
  nets_.resize(kMaxCellDepth + 1);
  in_use_.resize(kMaxCellDepth + 1);
  hull_.resize(std::max(hull_.size(), count));
  if (nets_[0].size() < 2 * count) nets_[0].resize(2 * count);
  std::copy(net.points.begin(), net.points.end(), nets_[0].begin());
  if (root.u0 > 0.0 || root.u1 < 1.0 || root.v0 > 0.0 || root.v1 < 1.0) {
    RestrictNet(shape_, nets_[0].data(), {root.u0, root.u1, root.v0, root.v1});
  }
  in_use_[0] = nets_[0].data();
}

SurfaceCell CellWalker::View(const CellRect& rect, int depth) {
  SurfaceCell cell;
  cell.rect = rect;
  cell.depth = depth;
  cell.hull_count = HullPoints(shape_, in_use_[static_cast<std::size_t>(depth)], hull_.data());
  cell.hull = hull_.data();
  cell.middle = Position(surface_.piece(rect.piece), rect.u(), rect.v());
  double squared = 0.0;
  for (int k = 0; k < cell.hull_count; ++k)
    squared = std::max(squared, (cell.hull[k] - cell.middle).squaredNorm());
  cell.radius = std::sqrt(squared);
  return cell;
}

bool CellWalker::Halve(int depth) {
  const auto d = static_cast<std::size_t>(depth);
  const auto count = static_cast<std::size_t>(shape_.count());
  if (nets_[d + 1].size() < 2 * count) nets_[d + 1].resize(2 * count);
  const auto [along_u, along_v] = Lengths(shape_, in_use_[d]);
  const bool u = along_u >= along_v;
  HalveNet(shape_, in_use_[d], u, nets_[d + 1].data(), nets_[d + 1].data() + count);
  return u;
}

void CellWalker::Choose(int depth, int which) {
  const auto d = static_cast<std::size_t>(depth);
  in_use_[d + 1] = nets_[d + 1].data() + which * shape_.count();
}

std::vector<CellRect> RootCells(const Surface& surface, double size, const RunContext& run) {
  constexpr int kDeepest = 30;        // halvings
  constexpr std::size_t kChunk = 64;  // pieces in one task
  const std::size_t chunks = (surface.pieces.size() + kChunk - 1) / kChunk;
  std::vector<std::vector<CellRect>> parts(chunks);
  const absl::Status done = ParallelFor(run, "verify: cells", chunks, [&](std::size_t chunk) {
    CellWalker walker(surface);
    const std::size_t end = std::min(surface.pieces.size(), (chunk + 1) * kChunk);
    for (std::size_t i = chunk * kChunk; i < end; ++i) {
      CellRect whole;
      whole.piece = PieceId(i);
      walker.Walk(whole, [&](const SurfaceCell& cell) {
        if (cell.radius > 0.5 * size && cell.depth < kDeepest && !run.Cancelled()) return true;
        parts[chunk].push_back(cell.rect);
        return false;
      });
    }
  });
  std::vector<CellRect> roots;
  if (!done.ok()) return roots;
  for (const auto& part : parts) roots.insert(roots.end(), part.begin(), part.end());
  return roots;
}

double RoughArea(const Surface& surface) {
  double area = 0.0;
  for (const Piece& piece : surface.pieces) {
    for (int i = 0; i < 4; ++i) {
      for (int j = 0; j < 4; ++j) {
        const SurfaceJet jet = Evaluate(piece, (i + 0.5) / 4.0, (j + 0.5) / 4.0);
        area += jet.du.cross(jet.dv).norm() / 16.0;
      }
    }
  }
  return area;
}

}  // namespace patchmill
