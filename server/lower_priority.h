// Priorities of threads: a call of milliseconds should not wait for the time slices of jobs.
#pragma once

namespace patchmill {

// The calling thread gives way to threads of normal priority from now on. Does nothing where the system has
// no priorities of threads.
void LowerPriorityOfThread();

// The threads that help in parallel loops give way, too: all that start after this call. Call it once, before
// the first loop.
void LowerPriorityOfWorkers();

}  // namespace patchmill
