// Pseudo-random numbers that depend on their index alone: the same on every machine, thread and run.
#pragma once

#include <cstdint>

namespace patchmill {

// The n-th number, in [0, 1) (SplitMix64 by Steele, Lea and Flood).
inline double Draw(std::uint64_t n) {
  std::uint64_t z = n * 0x9e3779b97f4a7c15ULL;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
  return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-53;
}

}  // namespace patchmill
