#include "server/operate/callers_file.h"

#include <fstream>

#include <absl/time/time.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/digest.h"
#include "tests/service/process.h"
#include "tests/service/status_matchers.h"

namespace patchmill {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using testing::StatusIs;

constexpr auto kInvalid = absl::StatusCode::kInvalidArgument;
constexpr char kTwo[] =
    "# callers of the workshop\n"
    "[shop a]\r\n"
    "token = sha256:9F86D081884C7D659A2FEAA0C55AD015A3BF4F1B2B0B822CD15D6C15B0F00A08 until 2027-01-31\n"
    "token = text:second-token-of-a\n"
    "places = 2   # both spindles\n"
    "requests_per_minute = 600\n"
    "job_seconds_per_day = 7200\n"
    "store_mib = 64\n"
    "\n"
    "[b]\n"
    "token = text:0123456789abcdef until 2027-01-31T12:00:00+02:00\n";

std::chrono::system_clock::time_point At(const char* time) {
  absl::Time parsed;
  std::string error;
  EXPECT_TRUE(absl::ParseTime(absl::RFC3339_full, time, &parsed, &error)) << error;
  return absl::ToChronoTime(parsed);
}

TEST(CallersFile, HasCallersWithTokensAndQuotas) {
  const auto table = ParseCallers(kTwo, "tokens.conf", false);
  ASSERT_TRUE(table.ok()) << table.status();
  ASSERT_EQ(table->callers.size(), 2u);
  const Quotas& a = table->callers.at("shop a");
  EXPECT_EQ(a.places, 2);
  EXPECT_EQ(a.requests_per_minute, 600);
  EXPECT_EQ(a.job_seconds_per_day, 7200.0);
  EXPECT_EQ(a.store_bytes, std::int64_t{64} << 20);
  EXPECT_FALSE(table->callers.at("b").places);
  ASSERT_EQ(table->tokens.size(), 3u);
  EXPECT_EQ(table->tokens[0].digest, Sha256("test"));  // its SHA-256 is the best known of all
  EXPECT_EQ(table->tokens[0].until, At("2027-02-01T00:00:00Z"));
  EXPECT_EQ(table->tokens[1].digest, Sha256("second-token-of-a"));
  EXPECT_EQ(table->tokens[1].until, std::chrono::system_clock::time_point::max());
  EXPECT_EQ(table->tokens[2].caller, "b");
  EXPECT_EQ(table->tokens[2].until, At("2027-01-31T10:00:00Z"));
}

struct WrongFile {
  const char *text, *message;
};

TEST(CallersFile, AFaultIsNamedWithItsLine) {
  const std::string token = "token = text:0123456789abcdef\n";
  const WrongFile files[] = {
      {"", "has no caller"},
      {"# nothing\n", "has no caller"},
      {"places = 1\n", "line 1: places stands above the first caller"},
      {"[a\n", "line 1: has no ] at its end"},
      {"[]\n", "line 1: the name of a caller must have 1 to 64"},
      {"[a]\nhello\n", "line 2: is no \"key = value\""},
      {"[a]\nplaces = 0\n", "line 2: places = 0; must be a whole number from 1 to 64"},
      {"[a]\nplaces = two\n", "line 2: places = two; must be a whole number"},
      {"[a]\nstore_mib = 1.5\n", "line 2: store_mib = 1.5; must be a whole number"},
      {"[a]\nplaces = 1\nplaces = 2\n", "line 3: places stands twice below [a]"},
      {"[a]\nplace = 1\n", "line 2: unknown key place; a caller has token, places,"},
      {"[a]\n\n[b]\n", "line 1: caller a has no token"},
      {"[a]\ntoken = 0123456789abcdef\n", "line 2: a token begins with sha256: or text:"},
      {"[a]\ntoken = sha256:0123\n", "line 2: sha256: must be followed by 64 hex digits"},
      {"[a]\ntoken = text:short\n", "line 2: text: must be followed by 16 to 512"},
      {"[a]\ntoken = text:0123456789abcdef until tomorrow\n", "line 2: until tomorrow; must be a day"},
      {"[a]\ntoken = text:0123456789abcdef until 2027-02-30\n", "line 2: until 2027-02-30; must be a day"},
      {"[a]\ntoken = text:0123456789abcdef for ever\n", "line 2: a token is sha256:HEX or text:TOKEN"},
      {"[a]\ntoken = text:0123456789abcdef\n[a]\n", "line 3: caller a stands twice"},
      {"[a]\ntoken = text:0123456789abcdef\n[b]\ntoken = text:0123456789abcdef\n",
       "line 4: this token stands in the file already"},
      {"[a]\ntoken = text:0123456789abcde1\ntoken = text:0123456789abcde2\ntoken = text:0123456789abcde3\n",
       "line 4: caller a has more than two tokens"},
  };
  for (const WrongFile& file : files) {
    EXPECT_THAT(ParseCallers(file.text, "tokens.conf", false).status(),
                StatusIs(kInvalid, AllOf(HasSubstr("tokens.conf"), HasSubstr(file.message),
                                         Not(HasSubstr("0123456789")))))
        << file.text;
  }
}

TEST(CallersFile, WithCertificatesACallerMayBeWithoutAToken) {
  EXPECT_TRUE(ParseCallers("[a]\nplaces = 1\n", "tokens.conf", true).ok());
}

TEST(CallersFile, AFileThatIsNotThereAndOneThatIsTooLongAreRefused) {
  const testing::TempDir dir;
  EXPECT_THAT(ReadCallers(dir / "none", false).status(), StatusIs(kInvalid, HasSubstr("cannot be read")));
  EXPECT_THAT(ReadCallers("/", false).status(), StatusIs(kInvalid, HasSubstr("cannot be read")));
  const std::string large = dir.Write("large", std::string(std::size_t{2} << 20, '#'));
  EXPECT_THAT(ReadCallers(large, false).status(),
              StatusIs(kInvalid, HasSubstr("has more than 1048576 bytes")));
}

}  // namespace
}  // namespace patchmill
