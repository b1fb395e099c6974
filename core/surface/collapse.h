// Turns a binary tree of boxes into one with four children per node. It is half as deep, and four boxes are
// tested at once.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <absl/status/statusor.h>

#include "core/base/run_context.h"

namespace patchmill {

struct SurfaceNode;

// Capacity of the stack of a depth-first walk. The stack holds at most three siblings per level.
inline constexpr std::size_t kMaxPending = 512;

// The children of a node: their indices in the binary tree, and their indices among the nodes of four
// children (leaves as ~leaf).
struct FourChildren {
  std::array<std::int32_t, 4> binary{}, child{};
  std::size_t count = 1;
};

// Each node takes the children of its binary node and opens the largest ones. The root comes first. A tree of
// one leaf is a root with one child. Serial. CANCELLED and DEADLINE_EXCEEDED from `run`.
absl::StatusOr<std::vector<FourChildren>> Collapse(const std::vector<SurfaceNode>& binary,
                                                   const RunContext& run);

}  // namespace patchmill
