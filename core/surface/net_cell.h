// Parts of a leaf's net. Searches halve them until their answer is proven, without touching the heap.
#pragma once

#include <array>

#include "core/surface/net_kernel.h"

namespace patchmill {

// A cell is halved at most this often below its leaf. Its sides are then below rounding.
inline constexpr int kMaxHalvings = 90;

struct NetCell {
  const Vec4* points = nullptr;  // of its net, in buffers that belong to the thread
  double u0 = 0.0, u1 = 1.0, v0 = 0.0, v1 = 1.0;
  int halvings = 0;
};

// The leaf's part of its piece's net, relative to `origin`. The cell is valid until the thread asks for the
// next leaf. Halves are valid until the thread asks for other halves of the same depth. So a thread can run
// one search at a time, depth first.
NetCell LeafCell(const BernsteinNet& net, const SurfaceLeaf& leaf, const Vec3& origin = Vec3::Zero());

// Both halves along u or v, the lower one first. `cell` must have been halved fewer than kMaxHalvings times.
std::array<NetCell, 2> Halves(NetShape shape, const NetCell& cell, bool along_u);

}  // namespace patchmill
