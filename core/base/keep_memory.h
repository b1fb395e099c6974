// For programs that do one job after another: memory that a job has freed stays for the next one.
#pragma once

namespace patchmill {

// Changes the allocator of the whole process, so it is for `main`, before threads start. What is freed is
// given back to the system only beyond 128 MB at the end of an arena; arrays of up to 32 MB come from arenas.
// Else a job begins with thousands of page faults: a tenth of its time and more where these are slow. Does
// nothing where malloc is not glibc's.
void KeepFreedMemory();

}  // namespace patchmill
