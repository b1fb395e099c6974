// Heights of eight neighbouring places at once: one leaf against eight balls, a ball to a lane.
//
// The code is written once (lane_visit.h) and compiled for several instruction sets; a lane's result depends
// on that lane alone and on the same operations in the same order everywhere (no contraction), so every
// instruction set gives the same bits. Plain data only: the translation units compiled for a newer processor
// must not leave copies of shared inline functions behind.
#pragma once

#include <cstdint>

#include "cam/location/leaf_errors.h"
#include "core/base/instruction_set.h"

namespace patchmill::internal {

inline constexpr int kLanes = 8;

// Eight balls with their highest contacts so far; see Contact. piece < 0: none yet.
struct alignas(64) LanePacket {
  double qx[kLanes], qy[kLanes];
  double z[kLanes];
  double u[kLanes], v[kLanes];
  double px[kLanes], py[kLanes], pz[kLanes];
  double slope_u[kLanes], slope_v[kLanes];
  std::int64_t piece[kLanes];
};

// A piece's Bernstein net (homogeneous, four numbers a point), or the 20 points of a Gregory quad. Kinds that
// are evaluated in another form have neither: their leaves are bounded in lanes, but searched one by one.
struct LaneNet {
  bool known = true;
  int degree_u = 0, degree_v = 0;
  bool rational = false;
  const double* points = nullptr;
  const double* gregory = nullptr;  // three numbers a point; null: evaluate the net
  bool edge_blend = false;
};

struct LaneLeaf {
  std::int64_t piece;
  double u0, u1, v0, v1;
  const double *center, *axis, *half;      // oriented box, axes column by column
  const double *s, *a, *b, *uu, *uv, *vv;  // LeafModel
  const LeafErrors* errors;
  LaneNet net;
};

// As Ball.
struct LaneLimits {
  double radius, slack;
  double free_f;
  // mm: contacts less than this below the centre graze the ball's equator, where a rounding of the surface is
  // a multiple of itself in height, and f hardly sees what is left to gain. They are left to the scalar
  // search.
  double graze() const { return 0.01 * radius; }
};

// Raises the balls that the leaf touches. Where it is neither proven out of a lane's way nor searched to a
// proven maximum, bit k of the result is set for lane k: that lane needs the scalar search of this leaf.
using LaneVisitor = unsigned (*)(const LaneLeaf& leaf, const LaneLimits& limits, LanePacket& packet);

// Bit k: the ball of lane k meets the leaf's oriented box, of which the rest is not used.
using LaneMeets = unsigned (*)(const LaneLeaf& leaf, const LaneLimits& limits, const LanePacket& packet);

// Where each lane's search begins, on which piece.
struct alignas(64) LaneStart {
  double u[kLanes], v[kLanes];
  std::int64_t piece[kLanes];  // < 0: none
};

// Newton on the whole piece (`piece`: only index, rectangle and net are used) for the lanes that start on it:
// raises their balls where it can, proves nothing.
using LaneApproach = void (*)(const LaneLeaf& piece, const LaneLimits& limits, const LaneStart& start,
                              LanePacket& packet);

struct LaneKernel {
  LaneVisitor visit;
  LaneMeets meets;
  LaneApproach approach;
};

// Of UsedInstructionSet().
const LaneKernel& UsedLaneKernel();

LaneKernel PlainLaneKernel();
#ifdef PATCHMILL_X86_VECTORS
LaneKernel Avx2LaneKernel();
LaneKernel Avx512LaneKernel();
#endif

}  // namespace patchmill::internal
