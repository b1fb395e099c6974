#include "server/operate/log.h"

#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace patchmill {
namespace {

TEST(LogLine, TextHasFieldsBehindItsMessage) {
  EXPECT_EQ(LogLine(LogFormat::kText, LogLevel::kInfo, "call ends",
                    {{"call", std::int64_t{17}}, {"code", "OK"}, {"seconds", 0.25}}),
            "info call ends: call=17 code=OK seconds=0.25");
  EXPECT_EQ(LogLine(LogFormat::kText, LogLevel::kError, "stopped", {}), "error stopped");
}

TEST(LogLine, JsonIsOneObject) {
  EXPECT_EQ(LogLine(LogFormat::kJson, LogLevel::kWarning, "call ends",
                    {{"call", std::int64_t{17}}, {"limit_value", 67108864.0}}),
            R"("level":"warning","message":"call ends","call":17,"limit_value":67108864)");
  EXPECT_EQ(LogLine(LogFormat::kJson, LogLevel::kInfo, "m", {{"v", std::numeric_limits<double>::infinity()}}),
            R"("level":"info","message":"m","v":null)");
}

TEST(LogLine, NothingFromOutsideEndsALineOrAString) {
  const LogFields fields = {{"request_id", std::string("a\n\"b\\\xC3\xA4")}};
  EXPECT_EQ(LogLine(LogFormat::kText, LogLevel::kInfo, "m", fields), R"(info m: request_id="a?\"b\\??")");
  EXPECT_EQ(LogLine(LogFormat::kJson, LogLevel::kInfo, "m\n", fields),
            R"("level":"info","message":"m?","request_id":"a?\"b\\??")");
}

TEST(LogLine, EmptyTextsAreLeftOut) {
  EXPECT_EQ(LogLine(LogFormat::kText, LogLevel::kInfo, "m", {{"caller", ""}, {"code", "OK"}}),
            "info m: code=OK");
}

}  // namespace
}  // namespace patchmill
