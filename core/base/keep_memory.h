// For programs that do one job after another: memory that one job has freed stays for the next one.
#pragma once

namespace patchmill {

// Changes the allocator of the whole process. Call it in `main`, before threads start. Arrays of up to 32
// MB then come from arenas, and these keep freed memory: an arena of a thread keeps about its last heap of
// 64 MB; the first arena keeps up to 128 MB at its end, and all memory that lies before a live block.
// Without this, a job begins with thousands of page faults, which cost a tenth of its time or more where
// they are slow. There is one arena for each core, and two at least: with glibc's eight a core, the memory
// of a server under 64 clients was three times as large and grew for ten minutes
// (tests/service/mixed_clients.py). Does nothing where malloc is not that of glibc.
void KeepFreedMemory();

}  // namespace patchmill
