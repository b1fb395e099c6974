// Heights of eight neighbouring places at once: one leaf against eight balls, one ball per lane.
//
// The code is written once (lane_visit.h) and compiled for several instruction sets. The result of a lane
// depends on that lane alone. The operations and their order are the same everywhere (no contraction), so
// every instruction set gives the same bits. The code uses plain data only: the translation units compiled
// for a newer processor must not leave copies of shared inline functions behind.
#pragma once

#include <cstdint>

#include "cam/location/leaf_errors.h"
#include "core/base/instruction_set.h"

namespace patchmill::internal {

inline constexpr int kLanes = 8;

// Eight balls with their highest contacts so far, see Contact. piece < 0 means no contact yet.
struct alignas(64) LanePacket {
  double qx[kLanes], qy[kLanes];
  double z[kLanes];
  double u[kLanes], v[kLanes];
  double px[kLanes], py[kLanes], pz[kLanes];
  double slope_u[kLanes], slope_v[kLanes];
  std::int64_t piece[kLanes];
};

// A piece's Bernstein net (homogeneous, four numbers per point), or the 20 points of a Gregory quad. Kinds of
// patches that are evaluated in another form have neither. Their leaves are bounded in lanes but searched one
// by one.
struct LaneNet {
  bool known = true;
  int degree_u = 0, degree_v = 0;
  bool rational = false;
  const double* points = nullptr;
  const double* gregory = nullptr;  // three numbers per point; null: evaluate the net
  bool edge_blend = false;
};

struct LaneLeaf {
  std::int64_t piece;
  double u0, u1, v0, v1;
  const double *center, *axis, *half;      // the oriented box, axes column by column
  const double *s, *a, *b, *uu, *uv, *vv;  // as in LeafModel
  const LeafErrors* errors;
  LaneNet net;
};

// As Ball.
struct LaneLimits {
  double radius, slack;
  double free_f;
  // mm. A contact less than this below the centre grazes the ball's equator. There a small rounding of the
  // surface changes the height by a multiple of itself, and f hardly shows what is left to gain. Such
  // contacts are left to the scalar search.
  double graze() const { return 0.01 * radius; }
};

// Raises the balls that the leaf touches. Bit k of the result is set if the leaf is neither proven to be out
// of the way of lane k nor searched to a proven maximum. Then that lane needs the scalar search of this leaf.
using LaneVisitor = unsigned (*)(const LaneLeaf& leaf, const LaneLimits& limits, LanePacket& packet);

// Bit k is set if the ball of lane k meets the leaf's oriented box. No other part of the leaf is used.
using LaneMeets = unsigned (*)(const LaneLeaf& leaf, const LaneLimits& limits, const LanePacket& packet);

// Where the search of each lane begins, and on which piece.
struct alignas(64) LaneStart {
  double u[kLanes], v[kLanes];
  std::int64_t piece[kLanes];  // < 0: no start
};

// Newton's method on the whole piece, for the lanes that start on it. (Of `piece` only index, rectangle and
// net are used.) It raises their balls where it can, and proves nothing.
using LaneApproach = void (*)(const LaneLeaf& piece, const LaneLimits& limits, const LaneStart& start,
                              LanePacket& packet);

struct LaneKernel {
  LaneVisitor visit;
  LaneMeets meets;
  LaneApproach approach;
};

// The kernel for UsedInstructionSet().
const LaneKernel& UsedLaneKernel();

LaneKernel PlainLaneKernel();
#ifdef PATCHMILL_X86_VECTORS
LaneKernel Avx2LaneKernel();
LaneKernel Avx512LaneKernel();
#endif

}  // namespace patchmill::internal
