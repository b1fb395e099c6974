// The same request gives the same bytes, whatever the number of threads ([verification P5]).
#include "tests/property/same_bytes.h"

namespace patchmill {
namespace {

using namespace testing;  // NOLINT: the support folder's

TEST(Threads, DoNotChangeTheProgram) {
  OnSomeParts(500, [](const PatchModel& model, const Job& job) {
    const JobResult one = Mill(PlacedSurface(model), job, 1);
    for (const int threads : {2, 5}) {
      SCOPED_TRACE(threads);
      ExpectSameBytes(one, Mill(PlacedSurface(model), job, threads));
    }
  });
}

}  // namespace
}  // namespace patchmill
