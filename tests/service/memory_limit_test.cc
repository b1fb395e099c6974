#include "server/memory_limit.h"

#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include "server/memory_ledger.h"
#include "tests/support/files.h"

namespace patchmill {
namespace {

constexpr std::int64_t kMib = 1 << 20, kGib = 1 << 30;

// A machine of 8 GiB as its files describe it.
class Machine : public ::testing::Test {
 protected:
  void SetUp() override {
    root_ = ::testing::TempDir() + "/machine_" +
            std::to_string(::testing::UnitTest::GetInstance()->random_seed()) +
            ::testing::UnitTest::GetInstance()->current_test_info()->name();
    std::filesystem::remove_all(root_);
    Write("/proc/meminfo", "MemTotal:        8388608 kB\nMemFree: 1 kB\n");
  }
  void TearDown() override { std::filesystem::remove_all(root_); }
  void Write(const std::string& file, const std::string& text) const {
    std::filesystem::create_directories(std::filesystem::path(root_ + file).parent_path());
    std::ofstream(root_ + file) << text;
  }
  std::string root_;
};

TEST_F(Machine, WithoutAGroupThreeQuartersOfTheMemory) { EXPECT_EQ(DefaultMemoryLimit(root_), 6 * kGib); }

TEST_F(Machine, TheGroupOfVersionTwoAndThoseAboveIt) {
  Write("/proc/self/cgroup", "0::/shop/mill\n");
  Write("/sys/fs/cgroup/shop/mill/memory.max", "max\n");
  Write("/sys/fs/cgroup/shop/memory.max", "1073741824\n");
  EXPECT_EQ(DefaultMemoryLimit(root_), kGib);
}

TEST_F(Machine, TheGroupOfVersionOne) {
  Write("/proc/self/cgroup", "5:cpu:/x\n4:memory:/mill\n");
  Write("/sys/fs/cgroup/memory/mill/memory.limit_in_bytes", "536870912\n");
  EXPECT_EQ(DefaultMemoryLimit(root_), kGib / 2);
}

TEST_F(Machine, InsideAContainerTheGroupIsTheRoot) {
  Write("/proc/self/cgroup", "0::/\n");
  Write("/sys/fs/cgroup/memory.max", "2147483648\n");
  EXPECT_EQ(DefaultMemoryLimit(root_), 2 * kGib);
}

TEST(ShareMemory, SharesStayBelowTheLimit) {
  for (const std::int64_t limit : {0L, 32 * kMib, 128 * kMib, kGib, 64 * kGib}) {
    const MemoryShares shares = ShareMemory(limit, 256 * kMib, 256 * kMib);
    EXPECT_LE(shares.in_flight + shares.store + shares.jobs, limit);
    EXPECT_LE(shares.in_flight, 256 * kMib);
    EXPECT_GE(shares.jobs, 0);
  }
  EXPECT_EQ(ShareMemory(kGib, 256 * kMib, 0).store, 0);
}

TEST(MemoryLedger, NeverGivesMoreThanItHas) {
  MemoryLedger ledger(100);
  EXPECT_TRUE(ledger.Take(60));
  EXPECT_FALSE(ledger.Take(41));
  EXPECT_TRUE(ledger.Take(40));
  ledger.Release(60);
  EXPECT_TRUE(ledger.Take(60));
  EXPECT_EQ(ledger.taken(), 100);
}

}  // namespace
}  // namespace patchmill
