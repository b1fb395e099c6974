// An int as the index of a container.
#pragma once

#include <cstddef>

namespace patchmill {

inline std::size_t At(int i) { return static_cast<std::size_t>(i); }

}  // namespace patchmill
