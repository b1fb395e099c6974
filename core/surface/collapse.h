// A binary tree of boxes with four children a node: half as deep, and four boxes at once.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <absl/status/statusor.h>

#include "core/base/run_context.h"

namespace patchmill {

struct SurfaceNode;

// Of a walk that keeps what it has not visited on a stack: three siblings a level.
inline constexpr std::size_t kMaxPending = 512;

// Of a node: in the binary tree, and where they stand among the nodes of four (leaves as ~leaf).
struct FourChildren {
  std::array<std::int32_t, 4> binary{}, child{};
  std::size_t count = 1;
};

// Each node takes the binary node's children and opens the largest ones. The root comes first; a tree of one
// leaf is a root with one child. Serial. CANCELLED and DEADLINE_EXCEEDED from `run`.
absl::StatusOr<std::vector<FourChildren>> Collapse(const std::vector<SurfaceNode>& binary,
                                                   const RunContext& run);

}  // namespace patchmill
