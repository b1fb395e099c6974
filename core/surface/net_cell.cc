#include "core/surface/net_cell.h"

#include <vector>

namespace patchmill {
namespace {

// Two nets per halving, reused by every search of a thread.
Vec4* CellBuffer(int halving, int count) {
  thread_local std::array<std::vector<Vec4>, kMaxHalvings + 1> buffers;
  std::vector<Vec4>& buffer = buffers[static_cast<std::size_t>(halving)];
  if (buffer.size() < 2 * static_cast<std::size_t>(count)) buffer.resize(2 * static_cast<std::size_t>(count));
  return buffer.data();
}

}  // namespace

NetCell LeafCell(const BernsteinNet& net, const SurfaceLeaf& leaf, const Vec3& origin) {
  const NetShape shape{net.degree_u, net.degree_v};
  Vec4* points = CellBuffer(0, shape.count());
  for (int i = 0; i < shape.count(); ++i) {
    points[i] = net.points[static_cast<std::size_t>(i)];
    points[i].head<3>() -= points[i].w() * origin;
  }
  RestrictNet(shape, points, {leaf.u0, leaf.u1, leaf.v0, leaf.v1});
  return {points, leaf.u0, leaf.u1, leaf.v0, leaf.v1, 0};
}

std::array<NetCell, 2> Halves(NetShape shape, const NetCell& cell, bool along_u) {
  std::array<NetCell, 2> half{cell, cell};
  half[0].halvings = half[1].halvings = cell.halvings + 1;
  Vec4* low = CellBuffer(cell.halvings + 1, shape.count());
  Vec4* high = low + shape.count();
  HalveNet(shape, cell.points, along_u, low, high);
  half[0].points = low;
  half[1].points = high;
  (along_u ? half[0].u1 : half[0].v1) = (along_u ? half[1].u0 : half[1].v0) =
      along_u ? 0.5 * (cell.u0 + cell.u1) : 0.5 * (cell.v0 + cell.v1);
  return half;
}

}  // namespace patchmill
