// The benchmarks, with the allocator as a server sets it: memory that was freed stays.
#include <benchmark/benchmark.h>

#include "core/base/keep_memory.h"

int main(int argc, char** argv) {
  patchmill::KeepFreedMemory();
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
}
