// The memory of this process as the system sees it: with the blocks that were freed and that the allocator
// keeps, and with what nobody counts.
#pragma once

#include <cstdint>

namespace patchmill {

// Resident bytes of the process (/proc/self/statm, proc(5)); 0 where the system does not state them. Takes
// some microseconds and allocates nothing.
std::int64_t ResidentBytes();

// Whether the process may take `bytes` more and stay below `limit_bytes`, less a sixteenth: several jobs may
// take what they were granted at the same time. If not at first, freed memory goes back to the system
// (malloc_trim(3)), which takes milliseconds. Any thread; it allocates nothing.
bool ProcessHasRoom(std::int64_t bytes, std::int64_t limit_bytes);

}  // namespace patchmill
