// What the system says of the memory of this process, and freed memory that goes back to it.
#include "server/process_memory.h"

#include <cstring>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/sanitized.h"

namespace patchmill {
namespace {

constexpr std::int64_t kMib = 1 << 20;

// 64 MiB in blocks of 16 KiB, each of which has been written to.
std::vector<std::unique_ptr<char[]>> ManyBlocks() {
  std::vector<std::unique_ptr<char[]>> blocks;
  for (int k = 0; k < 4096; ++k) {
    blocks.push_back(std::make_unique_for_overwrite<char[]>(16384));
    std::memset(blocks.back().get(), k, 16384);
  }
  return blocks;
}

TEST(ProcessMemory, GrowsByWhatIsWrittenTo) {
  const std::int64_t before = ResidentBytes();
  EXPECT_GT(before, kMib);
  const auto blocks = ManyBlocks();
  EXPECT_NEAR(static_cast<double>(ResidentBytes() - before), 64.0 * kMib, 8.0 * kMib);
}

TEST(ProcessMemory, ALimitBelowWhatThereIsLeavesNoRoom) {
  const std::int64_t now = ResidentBytes();
  EXPECT_FALSE(ProcessHasRoom(0, now));
  EXPECT_TRUE(ProcessHasRoom(0, 2 * now));
  EXPECT_FALSE(ProcessHasRoom(2 * now, 2 * now));
}

// The last block is still there, so that free alone cannot give back what lies below it.
TEST(ProcessMemory, FreedMemoryMakesRoom) {
  if (testing::kSanitized) GTEST_SKIP() << "a sanitizer keeps what is freed";
  std::vector<std::unique_ptr<char[]>> blocks = ManyBlocks();
  const std::int64_t full = ResidentBytes();
  std::unique_ptr<char[]> last = std::move(blocks.back());
  const std::int64_t limit = (full - 48 * kMib) / 15 * 16;
  EXPECT_FALSE(ProcessHasRoom(0, limit));
  blocks.clear();
  EXPECT_TRUE(ProcessHasRoom(0, limit));
}

}  // namespace
}  // namespace patchmill
