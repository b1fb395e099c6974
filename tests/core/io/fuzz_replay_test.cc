// The fuzz corpus as a test: every model file, cut short at many places and with bytes changed, through every
// reader.
#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "core/io/bez.h"
#include "core/io/bpt.h"
#include "core/io/bv.h"
#include "core/io/patches.h"
#include "tests/fuzz/reader_contract.h"
#include "tests/support/files.h"
#include "tests/support/random.h"

namespace patchmill {
namespace {

constexpr std::size_t kLargest = 40'000;  // bytes of a seed; the few larger files are taken as they are

std::vector<std::string> Seeds() {
  std::vector<std::string> files;
  for (const char* folder : {"examples", "tests/models", "tests/models/malformed"}) {
    for (const auto& entry :
         std::filesystem::directory_iterator(std::string(PATCHMILL_SOURCE_DIR "/") + folder)) {
      if (entry.is_regular_file()) files.push_back(entry.path().string());
    }
  }
  std::sort(files.begin(), files.end());
  return files;
}

// What no file of the corpus has: a mesh beside patches, and a rational triangle.
constexpr std::string_view kMeshAndTriangle =
    "Group 1 net\n1\n4 2\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2\n4 0 1 2 3\n"
    "11 2\n0 0 0 1\n0.5 0 0.5 1\n1 0 1 1\n0 0.5 0.5 1\n0.7 0.7 0.7 0.7\n0 1 1 1\n";

// All readers see all files: a format is never guessed, so the wrong reader must only refuse.
void ExpectContract(std::string_view text, const std::string& what) {
  ASSERT_TRUE(KeepsReaderContract(text, ReadBpt(text))) << what << " as .bpt: " << ReadBpt(text).status();
  ASSERT_TRUE(KeepsReaderContract(text, ReadBez(text))) << what << " as .bez: " << ReadBez(text).status();
  ASSERT_TRUE(KeepsReaderContract(text, ReadBv(text))) << what << " as .bv: " << ReadBv(text).status();
  ASSERT_TRUE(KeepsReaderContract(text, ReadPatches(text)))
      << what << " as .patches: " << ReadPatches(text).status();
}

TEST(FuzzReplay, WholeFiles) {
  const std::vector<std::string> seeds = Seeds();
  EXPECT_GT(seeds.size(), 70u);
  for (const std::string& file : seeds) ExpectContract(*testing::ReadFile(file), file);
  EXPECT_TRUE(ReadBv(kMeshAndTriangle).ok()) << ReadBv(kMeshAndTriangle).status();
  ExpectContract(kMeshAndTriangle, "mesh and triangle");
}

TEST(FuzzReplay, TruncatedFiles) {
  for (const std::string& file : Seeds()) {
    const std::string text = *testing::ReadFile(file);
    if (text.size() > kLargest) continue;
    const std::size_t step = std::max<std::size_t>(1, text.size() / 60);
    for (std::size_t size = 0; size < text.size(); size += step) {
      ExpectContract(std::string_view(text).substr(0, size), file + " cut to " + std::to_string(size));
    }
  }
  for (std::size_t size = 0; size < kMeshAndTriangle.size(); ++size) {
    ExpectContract(kMeshAndTriangle.substr(0, size), "mesh and triangle cut");
  }
}

TEST(FuzzReplay, ChangedBytes) {
  testing::Random random(20261121);
  constexpr std::string_view kLikely = "0123456789.-+eE \n\r\tnaifx";
  std::vector<std::pair<std::string, std::string>> seeds = {
      {"mesh and triangle", std::string(kMeshAndTriangle)}};
  for (const std::string& file : Seeds()) seeds.emplace_back(file, *testing::ReadFile(file));
  for (const auto& [file, text] : seeds) {
    if (text.empty() || text.size() > kLargest) continue;
    for (int round = 0; round < 60; ++round) {
      std::string changed = text;
      for (int k = 0; k <= round % 4; ++k) {
        const auto at = static_cast<std::size_t>(random.Int(static_cast<int>(changed.size())));
        const bool likely = random.Int(3) != 0;
        changed[at] = likely ? kLikely[static_cast<std::size_t>(random.Int(static_cast<int>(kLikely.size())))]
                             : static_cast<char>(random.Int(256));
      }
      ExpectContract(changed, file + " round " + std::to_string(round));
    }
  }
}

}  // namespace
}  // namespace patchmill
