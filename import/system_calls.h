// What the importer may ask of the system: it reads files of strangers with a large library.
#pragma once

namespace patchmill {

enum class SystemCalls {
  kLimited,     // from now on
  kNotLimited,  // the kernel cannot, or libseccomp was missing when the program was built
  kFailed       // the kernel can, but refuses
};

// Leaves this process and its threads what reading takes: memory, its open descriptors, files opened for
// reading, clocks, locks between threads, and the end. Every other call fails with EPERM: nothing is
// written but to descriptors that are open, nothing is started, nothing is sent. Sanitizers need more, so
// that nothing is limited in their builds.
SystemCalls LimitSystemCalls();

}  // namespace patchmill
