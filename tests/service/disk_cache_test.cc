#include "server/disk_cache.h"

#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include "tests/support/files.h"

namespace patchmill {
namespace {

namespace fs = std::filesystem;

class DiskCacheTest : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = ::testing::TempDir() + "/disk_cache_" +
              ::testing::UnitTest::GetInstance()->current_test_info()->name();
    fs::remove_all(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::unique_ptr<DiskCache> Open(std::int64_t limit = 1 << 20,
                                  std::chrono::seconds lifetime = std::chrono::hours(1)) const {
    auto cache = DiskCache::Open({folder_, limit, lifetime});
    EXPECT_TRUE(cache.ok()) << cache.status();
    return *std::move(cache);
  }
  static Messages Answer(const std::vector<std::string>& texts) {
    Messages messages;
    for (const std::string& text : texts) {
      const grpc::Slice slice(text);
      messages.emplace_back(&slice, 1);
    }
    return messages;
  }
  static std::string Text(const Messages& messages) {
    std::string all;
    for (const grpc::ByteBuffer& message : messages) {
      std::vector<grpc::Slice> slices;
      EXPECT_TRUE(message.Dump(&slices).ok());
      for (const grpc::Slice& slice : slices)
        all.append(reinterpret_cast<const char*>(slice.begin()), slice.size());
      all += '|';
    }
    return all;
  }
  static StoreKey Key(const std::string& digest, const std::string& caller = "") {
    return {Stored::kAnswer, caller, digest};
  }
  std::vector<fs::path> Files() const {
    std::vector<fs::path> files;
    for (const auto& entry : fs::directory_iterator(folder_)) files.push_back(entry.path());
    return files;
  }
  std::string folder_;
};

TEST_F(DiskCacheTest, AnotherServerFindsTheAnswerOfTheSameCaller) {
  Open()->Put(Key("k", "ann"), "m", Answer({"one", "", "three"}));
  const auto cache = Open();
  const auto found = cache->Find(Key("k", "ann"), "m");
  ASSERT_TRUE(found.has_value());
  EXPECT_EQ(Text(*found), "one||three|");
  EXPECT_FALSE(cache->Find(Key("k", "bob"), "m").has_value());
  EXPECT_FALSE(cache->Find(Key("k", "ann"), "n").has_value());
  EXPECT_FALSE(cache->Find(Key("l", "ann"), "m").has_value());
}

TEST_F(DiskCacheTest, OnlyTheOwnerReadsItsFiles) {
  Open()->Put(Key("k"), "", Answer({"secret"}));
  ASSERT_EQ(Files().size(), 1u);
  struct stat about {};
  ASSERT_EQ(stat(Files()[0].c_str(), &about), 0);
  EXPECT_EQ(about.st_mode & 0777, 0600u);
  ASSERT_EQ(stat(folder_.c_str(), &about), 0);
  EXPECT_EQ(about.st_mode & 0777, 0700u);
}

// Every byte counts: whichever is changed, the answer is not used, and the file is gone.
TEST_F(DiskCacheTest, ADamagedFileIsRemoved) {
  const auto cache = Open();
  cache->Put(Key("k"), "", Answer({"abc", "de"}));
  ASSERT_EQ(Files().size(), 1u);
  const fs::path path = Files()[0];
  const std::string good = testing::ReadFile(path.string()).value();
  for (std::size_t at = 0; at <= good.size(); ++at) {
    std::string bad = good;
    if (at < good.size()) {
      bad[at] = static_cast<char>(bad[at] ^ 0x20);
    } else {
      bad.pop_back();
    }
    std::ofstream(path, std::ios::binary) << bad;
    EXPECT_FALSE(cache->Find(Key("k"), "").has_value()) << at;
    EXPECT_FALSE(fs::exists(path)) << at;
  }
  std::ofstream(path, std::ios::binary) << good;
  EXPECT_TRUE(cache->Find(Key("k"), "").has_value());
}

TEST_F(DiskCacheTest, OldAndFutureFilesAreNotUsed) {
  const auto cache = Open();
  for (const int hours : {-2, 2}) {
    cache->Put(Key("k"), "", Answer({"x"}));
    fs::last_write_time(Files()[0], fs::file_time_type::clock::now() + std::chrono::hours(hours));
    EXPECT_FALSE(cache->Find(Key("k"), "").has_value());
    EXPECT_TRUE(Files().empty());
  }
}

TEST_F(DiskCacheTest, TheOldestLeaveWhenThereIsNoRoom) {
  const auto cache = Open(10'000);
  for (int k = 0; k < 6; ++k) {
    cache->Put(Key(std::string(1, static_cast<char>('a' + k))), "", Answer({std::string(2'000, 'x')}));
    for (const fs::path& file : Files())  // an hour's steps in a moment
      fs::last_write_time(file, fs::last_write_time(file) - std::chrono::seconds(10));
  }
  EXPECT_FALSE(cache->Find(Key("a"), "").has_value());
  EXPECT_TRUE(cache->Find(Key("f"), "").has_value());
  EXPECT_LE(Files().size(), 4u);
  cache->Put(Key("large"), "", Answer({std::string(3'000, 'x')}));  // above a quarter
  EXPECT_FALSE(cache->Find(Key("large"), "").has_value());
}

TEST_F(DiskCacheTest, ACallerBeyondItsShareLosesItsOwnOldest) {
  const auto cache = Open();
  const std::int64_t share = 9'000;
  cache->Put(Key("of another", "bob"), "m", Answer({std::string(2'000, 'x')}), share);
  for (const char* answer : {"a", "b", "c", "d", "e"}) {
    for (const fs::path& file : Files())
      fs::last_write_time(file, fs::last_write_time(file) - std::chrono::seconds(10));
    cache->Put(Key(answer, "ann"), answer, Answer({std::string(2'000, 'x')}), share);
  }
  EXPECT_FALSE(cache->Find(Key("a", "ann"), "a").has_value());
  EXPECT_TRUE(cache->Find(Key("b", "ann"), "b").has_value());
  EXPECT_TRUE(cache->Find(Key("e", "ann"), "e").has_value());
  EXPECT_TRUE(cache->Find(Key("of another", "bob"), "m").has_value());            // the oldest of all
  cache->Put(Key("large", "ann"), "", Answer({std::string(2'500, 'x')}), share);  // above a quarter
  EXPECT_FALSE(cache->Find(Key("large", "ann"), "").has_value());
  EXPECT_TRUE(cache->Find(Key("b", "ann"), "b").has_value());
}

TEST_F(DiskCacheTest, AForgottenModelTakesItsAnswersAlong) {
  const auto cache = Open();
  cache->Put(Key("1", "ann"), "m", Answer({"x"}));
  cache->Put(Key("2", "ann"), "n", Answer({"x"}));
  cache->Put(Key("3", "bob"), "m", Answer({"x"}));
  cache->ForgetModel("ann", "m");
  EXPECT_FALSE(cache->Find(Key("1", "ann"), "m").has_value());
  EXPECT_TRUE(cache->Find(Key("2", "ann"), "n").has_value());
  EXPECT_TRUE(cache->Find(Key("3", "bob"), "m").has_value());
}

TEST_F(DiskCacheTest, FilesOfOthersStay) {
  fs::create_directories(folder_);
  std::ofstream(folder_ + "/notes.txt") << "mine";
  fs::last_write_time(folder_ + "/notes.txt", fs::file_time_type::clock::now() - std::chrono::hours(1000));
  Open(1'000)->Put(Key("k"), "", Answer({"x"}));
  EXPECT_TRUE(fs::exists(folder_ + "/notes.txt"));
}

TEST_F(DiskCacheTest, AFolderThatCannotBeWrittenIsNamed) {
  EXPECT_THAT(std::string(DiskCache::Open({"/proc/nowhere"}).status().message()),
              ::testing::HasSubstr("--cache-dir /proc/nowhere: cannot be written"));
}

TEST_F(DiskCacheTest, AFolderThatIsLostCostsOnlyTheCache) {
  const auto cache = Open();
  fs::remove_all(folder_);
  cache->Put(Key("k"), "", Answer({"x"}));
  EXPECT_FALSE(cache->Find(Key("k"), "").has_value());
}

}  // namespace
}  // namespace patchmill
