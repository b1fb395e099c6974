// Replaces operator new and operator delete, so that the memory of each job is counted (memory_budget.h).
// Part of the programs that serve, not of the library: a test has the allocator of the system.
#include <cstdlib>
#include <new>

#include <malloc.h>

#include "core/base/polled_run.h"

namespace {

using patchmill::PolledRun;
using patchmill::RunContext;

// A large block is refused before it is taken: the job would end only after it has been filled.
constexpr std::size_t kLarge = std::size_t{8} << 20;

bool MayTake(std::size_t bytes) {
  if (bytes < kLarge) return true;
  const RunContext* run = PolledRun::current();
  return run == nullptr || run->budget() == nullptr || run->budget()->Fits(static_cast<std::int64_t>(bytes));
}

void* Counted(void* block) {
  if (block != nullptr) PolledRun::CountMemory(static_cast<std::int64_t>(malloc_usable_size(block)));
  return block;
}

void* Take(std::size_t bytes) {
  return MayTake(bytes) ? Counted(std::malloc(bytes == 0 ? 1 : bytes)) : nullptr;
}

void* Take(std::size_t bytes, std::align_val_t alignment) {
  const auto align = static_cast<std::size_t>(alignment);
  const std::size_t whole = (bytes + align - 1) / align * align;
  return MayTake(bytes) ? Counted(std::aligned_alloc(align, whole == 0 ? align : whole)) : nullptr;
}

void* OrThrow(void* block) {
  if (block == nullptr) throw std::bad_alloc();
  return block;
}

void Free(void* block) {
  if (block == nullptr) return;
  PolledRun::CountMemory(-static_cast<std::int64_t>(malloc_usable_size(block)));
  std::free(block);
}

}  // namespace

void* operator new(std::size_t bytes) { return OrThrow(Take(bytes)); }
void* operator new[](std::size_t bytes) { return OrThrow(Take(bytes)); }
void* operator new(std::size_t bytes, const std::nothrow_t&) noexcept { return Take(bytes); }
void* operator new[](std::size_t bytes, const std::nothrow_t&) noexcept { return Take(bytes); }
void* operator new(std::size_t bytes, std::align_val_t align) { return OrThrow(Take(bytes, align)); }
void* operator new[](std::size_t bytes, std::align_val_t align) { return OrThrow(Take(bytes, align)); }
void* operator new(std::size_t bytes, std::align_val_t align, const std::nothrow_t&) noexcept {
  return Take(bytes, align);
}
void* operator new[](std::size_t bytes, std::align_val_t align, const std::nothrow_t&) noexcept {
  return Take(bytes, align);
}
void operator delete(void* block) noexcept { Free(block); }
void operator delete[](void* block) noexcept { Free(block); }
void operator delete(void* block, std::size_t) noexcept { Free(block); }
void operator delete[](void* block, std::size_t) noexcept { Free(block); }
void operator delete(void* block, const std::nothrow_t&) noexcept { Free(block); }
void operator delete[](void* block, const std::nothrow_t&) noexcept { Free(block); }
void operator delete(void* block, std::align_val_t) noexcept { Free(block); }
void operator delete[](void* block, std::align_val_t) noexcept { Free(block); }
void operator delete(void* block, std::size_t, std::align_val_t) noexcept { Free(block); }
void operator delete[](void* block, std::size_t, std::align_val_t) noexcept { Free(block); }
