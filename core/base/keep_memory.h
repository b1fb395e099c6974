// For programs that do one job after another: memory that a job has freed stays for the next one.
#pragma once

namespace patchmill {

// Changes the allocator of the whole process, so it is for `main`, before threads start. Arrays of up to 32
// MB come from arenas, and these keep what is freed: about the last heap of 64 MB where a thread has its own,
// up to 128 MB at the end of the first one, all that something alive stands behind. Else a job begins with
// thousands of page faults: a tenth of its time and more where these are slow. Does nothing where malloc is
// not glibc's.
void KeepFreedMemory();

}  // namespace patchmill
