// The main program of every test program: GoogleTest's own. --file=NAME runs the tests of one source file,
// which is what ctest asks for (contour_paths_test.cc, or more of its path where two have the same name).
#include <cstdio>
#include <string>
#include <string_view>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace {

constexpr std::string_view kFlag = "--file=";

bool IsOf(std::string_view path, std::string_view file) {
  return path == file || (path.ends_with(file) && path[path.size() - file.size() - 1] == '/');
}

// Adds all tests of other files to what --gtest_filter leaves out; false if none is left.
bool KeepFile(std::string_view file) {
  std::string& filter = testing::GTEST_FLAG(filter);
  bool found = false;
  const testing::UnitTest& all = *testing::UnitTest::GetInstance();
  for (int i = 0; i < all.total_test_suite_count(); ++i) {
    const testing::TestSuite& suite = *all.GetTestSuite(i);
    for (int k = 0; k < suite.total_test_count(); ++k) {
      const testing::TestInfo& test = *suite.GetTestInfo(k);
      if (IsOf(test.file(), file)) {
        found = true;
        continue;
      }
      filter += filter.find('-') == std::string::npos ? '-' : ':';
      filter += std::string(suite.name()) + '.' + test.name();
    }
  }
  return found;
}

}  // namespace

int main(int argc, char** argv) {
  testing::InitGoogleMock(&argc, argv);  // takes its own flags away
  for (int i = 1; i < argc; ++i) {
    const std::string_view argument = argv[i];
    if (!argument.starts_with(kFlag)) {
      std::fprintf(stderr, "%s: unknown argument %s\n", argv[0], argv[i]);
      return 2;
    }
    if (!KeepFile(argument.substr(kFlag.size()))) {
      std::fprintf(stderr, "%s: no tests come from %s\n", argv[0], argv[i] + kFlag.size());
      return 2;
    }
  }
  return RUN_ALL_TESTS();
}
