#include "server/operate/file_watch.h"

#include <atomic>
#include <filesystem>
#include <thread>

#include <gtest/gtest.h>

#include "tests/service/process.h"

namespace patchmill {
namespace {

using namespace std::chrono_literals;

bool Becomes(const std::atomic<int>& count, int wanted) {
  for (int k = 0; k < 2000 && count < wanted; ++k) std::this_thread::sleep_for(1ms);
  return count == wanted;
}

TEST(FileWatch, SeesAFileThatIsWrittenReplacedOrRemoved) {
  const testing::TempDir dir;
  const std::string path = dir.Write("a", "one"), other = dir.Write("b", "one");
  std::atomic<int> changes{0};
  FileWatch watch(
      {path, other}, [&] { ++changes; }, 2ms);
  dir.Write("a", "longer");
  EXPECT_TRUE(Becomes(changes, 1));
  std::filesystem::rename(dir.Write("new", "longer"), path);
  EXPECT_TRUE(Becomes(changes, 2));
  std::filesystem::remove(other);
  EXPECT_TRUE(Becomes(changes, 3));
  watch.Poke();
  EXPECT_TRUE(Becomes(changes, 4));
}

TEST(FileWatch, FollowsLinksAsSecretsOfKubernetesAreMounted) {
  const testing::TempDir dir;
  std::filesystem::create_directory(dir / "v1");
  std::filesystem::create_directory(dir / "v2");
  dir.Write("v1/a", "one");
  dir.Write("v2/a", "two");
  std::filesystem::create_directory_symlink("v1", dir / "data");
  std::filesystem::create_symlink("data/a", dir / "a");
  std::atomic<int> changes{0};
  FileWatch watch(
      {dir / "a"}, [&] { ++changes; }, 2ms);
  std::filesystem::create_directory_symlink("v2", dir / "data2");
  std::filesystem::rename(dir / "data2", dir / "data");
  EXPECT_TRUE(Becomes(changes, 1));
}

}  // namespace
}  // namespace patchmill
