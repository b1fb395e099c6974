// Random numbers that are the same on every machine (std distributions are not): splitmix64.
#pragma once

#include <cstdint>

#include "core/base/vec.h"

namespace patchmill::testing {

class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}

  std::uint64_t Bits() {
    std::uint64_t z = (state_ += 0x9e3779b97f4a7c15u);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
  }
  double Unit() { return static_cast<double>(Bits() >> 11) * 0x1p-53; }  // [0,1)
  double Uniform(double lo, double hi) { return lo + (hi - lo) * Unit(); }
  int Int(int count) { return static_cast<int>(Bits() % static_cast<std::uint64_t>(count)); }  // 0 .. count-1
  // Each coordinate in [lo,hi), drawn in the order x, y, z.
  Vec3 Point(double lo, double hi) {
    const double x = Uniform(lo, hi), y = Uniform(lo, hi), z = Uniform(lo, hi);
    return {x, y, z};
  }

 private:
  std::uint64_t state_;
};

}  // namespace patchmill::testing
