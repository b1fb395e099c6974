// Random tests draw more, and others, when the environment says so. 50 random B-spline parts, none of them
// among those of every day:
//   export PATCHMILL_FUZZ_JOBS=50 PATCHMILL_FUZZ_SEED=100
//   build/release/tests/property_tests --file=tests/property/random_smooth_jobs_test.cc
#pragma once

#include <algorithm>
#include <cstdlib>

#include <gtest/gtest.h>

namespace patchmill::testing {

inline int FromEnvironment(const char* name, int usual) {
  const char* asked = std::getenv(name);
  return asked != nullptr ? std::max(0, std::atoi(asked)) : usual;
}

// PATCHMILL_LONG=1 (scripts/long_tests.sh whole): tests take every value of their lists, and all of their
// random parts. CI takes some.
inline bool LongTests() { return FromEnvironment("PATCHMILL_LONG", 0) != 0; }

// How many: `in_ci` of `all`.
inline int CountOf(int in_ci, int all) { return LongTests() ? all : in_ci; }

// Seeds of random jobs: `usual` of them from `first` on. PATCHMILL_FUZZ_JOBS sets how many,
// PATCHMILL_FUZZ_SEED how far from `first` they begin.
inline auto JobSeeds(int first, int usual) {
  const int from = first + FromEnvironment("PATCHMILL_FUZZ_SEED", 0);
  return ::testing::Range(from, from + std::max(1, FromEnvironment("PATCHMILL_FUZZ_JOBS", usual)));
}

}  // namespace patchmill::testing
