// Parts of a leaf's net that searches halve until their answer is proven, without touching the heap.
#pragma once

#include <array>

#include "core/surface/net_kernel.h"

namespace patchmill {

// A cell is halved at most this often below its leaf; the sides are then below rounding.
inline constexpr int kMaxHalvings = 90;

struct NetCell {
  const Vec4* points = nullptr;  // of its net, in buffers of the thread's own
  double u0 = 0.0, u1 = 1.0, v0 = 0.0, v1 = 1.0;
  int halvings = 0;
};

// The leaf's part of its piece's net, relative to `origin`. It lasts until the thread asks for the next
// leaf's, halves until it asks for others of the same halving: one search at a time, depth first.
NetCell LeafCell(const BernsteinNet& net, const SurfaceLeaf& leaf, const Vec3& origin = Vec3::Zero());

// Both halves along u or v, the lower one first. `cell` must have been halved less than kMaxHalvings times.
std::array<NetCell, 2> Halves(NetShape shape, const NetCell& cell, bool along_u);

}  // namespace patchmill
