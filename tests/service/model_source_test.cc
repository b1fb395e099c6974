#include "server/model_source.h"

#include <random>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <google/protobuf/util/json_util.h>
#include <gtest/gtest.h>

#include "proto/json/json_message.h"
#include "server/digest.h"
#include "tests/fuzz/model_source_contract.h"
#include "tests/service/raw_stub.h"
#include "tests/service/requests.h"
#include "tests/service/status_matchers.h"
#include "tests/support/files.h"

namespace patchmill {
namespace {

using ::testing::_;
using testing::Bump;
using ::testing::HasSubstr;
using testing::StatusIs;
constexpr auto kInvalid = absl::StatusCode::kInvalidArgument;

v1::ModelSource File(const std::string& format, std::string content) {
  v1::ModelSource source;
  source.mutable_file()->set_format(format);
  source.mutable_file()->set_content(std::move(content));
  return source;
}

absl::Status LoadStatus(const v1::ModelSource& source) { return LoadModel(source, "source").status(); }

std::string JsonOf(const v1::PatchModel& model) {
  std::string json;
  EXPECT_TRUE(google::protobuf::util::MessageToJsonString(model, &json).ok());
  return json;
}

// Unknown fields take ten times their bytes.
TEST(LoadModel, TheMessageInAFileIsHeld) {
  InFlight in_flight(std::size_t{1} << 20, {});
  const std::string binary = testing::Bump().SerializeAsString(),
                    unknown = testing::Repeated("\xF8\x07\x01", 30'000);
  EXPECT_TRUE(LoadModel(File("pb", binary), "source", {}, {.in_flight = &in_flight}).ok());
  EXPECT_TRUE(LoadModel(File("json", JsonOf(testing::Bump())), "source", {}, {.in_flight = &in_flight}).ok());
  const auto refused =
      LoadModel(File("pb", binary + testing::Repeated(unknown, 2)), "source", {}, {.in_flight = &in_flight});
  EXPECT_THAT(refused.status(),
              StatusIs(absl::StatusCode::kResourceExhausted, HasSubstr("request_bytes_in_flight")));
  EXPECT_TRUE(in_flight.Take(std::size_t{1} << 20).ok());  // nothing is held any more
  const auto all = in_flight.Take(std::size_t{1} << 20);
  for (const auto& file : {File("pb", binary), File("json", JsonOf(testing::Bump()))}) {
    EXPECT_EQ(LoadModel(file, "source", {}, {.in_flight = &in_flight}).status().code(),
              absl::StatusCode::kResourceExhausted);
    EXPECT_EQ(LoadNetwork(file, "source", {}, {.in_flight = &in_flight}).status().code(),
              absl::StatusCode::kResourceExhausted);
  }
}

TEST(LoadModel, ReadingJsonStopsWhenItIsCancelled) {
  const std::string json = "{\"patches\":[" + testing::Repeated("{},", 200'000) + "{}]}";
  v1::PatchModel model;
  int asked = 0;
  const absl::Status status = ReadJsonMessage(json, model, {}, [&asked] { return ++asked == 3; });
  EXPECT_EQ(status.code(), absl::StatusCode::kCancelled);
  EXPECT_EQ(asked, 3);
  RunContext run;
  run.Cancel();
  EXPECT_EQ(LoadModel(File("json", json), "source", run).status().code(), absl::StatusCode::kCancelled);
}

TEST(LoadModel, MessageJsonAndBinaryAreTheSameModel) {
  v1::ModelSource message;
  *message.mutable_model() = Bump();
  const auto base = LoadModel(message, "source");
  ASSERT_TRUE(base.ok()) << base.status();
  EXPECT_TRUE(base->faults.empty());
  EXPECT_FALSE(base->unitless);
  for (const auto& source :
       {File("json", JsonOf(Bump())), File("", JsonOf(Bump())), File("pb", JsonOf(Bump())),
        File("pb", Bump().SerializeAsString()), File("", Bump().SerializeAsString())}) {
    const auto loaded = LoadModel(source, "source");
    ASSERT_TRUE(loaded.ok()) << loaded.status();
    EXPECT_EQ(Hex(loaded->digest), Hex(base->digest));
  }
}

TEST(LoadModel, TextFilesHaveNoUnitUnlessTheRequestSaysOne) {
  v1::ModelSource source = File("bpt", testing::ReadRepositoryFile("examples/teapot.bpt"));
  const auto loaded = LoadModel(source, "source");
  ASSERT_TRUE(loaded.ok()) << loaded.status();
  EXPECT_EQ(loaded->model.patches.size(), 28u);
  EXPECT_TRUE(loaded->unitless);
  EXPECT_EQ(loaded->path, "source.file.content");
  source.mutable_file()->set_length_unit(v1::LENGTH_UNIT_INCH);
  const auto inches = LoadModel(source, "source");
  ASSERT_TRUE(inches.ok());
  EXPECT_FALSE(inches->unitless);
  EXPECT_NEAR(ControlBox(inches->model).Diagonal(), 25.4 * ControlBox(loaded->model).Diagonal(), 1e-9);
}

TEST(LoadModel, NothingEmptyAndUnknown) {
  EXPECT_THAT(LoadStatus({}), StatusIs(kInvalid, "source is missing; required"));
  v1::ModelSource digest;
  digest.set_model_sha256(std::string(32, 'x'));
  EXPECT_THAT(LoadStatus(digest), StatusIs(absl::StatusCode::kNotFound, HasSubstr("send it inline")));
  for (const char* format : {"", "json", "pb", "bpt", "bv", "patches"}) {
    EXPECT_THAT(LoadStatus(File(format, "")), StatusIs(kInvalid, HasSubstr("empty"))) << format;
  }
  EXPECT_THAT(
      LoadStatus(File("stl", "solid")),
      StatusIs(
          kInvalid,
          HasSubstr(
              "source.file.format = \"stl\"; must be one of bpt, bv, bez, patches, step, iges, json, pb")));
}

TEST(LoadModel, WrongKindsSayWhatTheyAreNot) {
  const std::string bpt = testing::ReadRepositoryFile("examples/teapot.bpt");
  EXPECT_THAT(LoadStatus(File("json", bpt)), StatusIs(kInvalid, HasSubstr("JSON")));
  EXPECT_THAT(LoadStatus(File("pb", bpt)), StatusIs(kInvalid, HasSubstr("binary PatchModel")));
  EXPECT_THAT(
      LoadStatus(File("", bpt)),
      StatusIs(kInvalid, HasSubstr("say which one by the file's ending (.bpt, .bv, .bez, .patches)")));
  EXPECT_THAT(LoadStatus(File("", std::string(1000, '\0'))), StatusIs(kInvalid, _));
  EXPECT_THAT(LoadStatus(File("bpt", JsonOf(Bump()))), StatusIs(kInvalid, HasSubstr("line 1")));
  EXPECT_THAT(LoadStatus(File("bv", Bump().SerializeAsString())), StatusIs(kInvalid, HasSubstr("line ")));
}

TEST(LoadModel, TruncatedAnywhereIsAnErrorAndNeverACrash) {
  const std::string json = JsonOf(Bump()), binary = Bump().SerializeAsString();
  for (std::size_t n = 1; n + 1 < json.size(); n += 7) {
    EXPECT_THAT(LoadStatus(File("json", json.substr(0, n))), StatusIs(kInvalid, _)) << n;
  }
  for (std::size_t n = 1; n < binary.size(); ++n) {
    const auto loaded = LoadModel(File("pb", binary.substr(0, n)), "source");
    EXPECT_TRUE(!loaded.ok() || !loaded->faults.empty()) << n;
  }
  const std::string bpt = testing::ReadRepositoryFile("examples/teapot.bpt");
  for (std::size_t n = 10; n + 10 < bpt.size(); n += 501) {
    EXPECT_THAT(LoadStatus(File("bpt", bpt.substr(0, n))), StatusIs(kInvalid, HasSubstr("line "))) << n;
  }
}

TEST(LoadModel, JsonFaultsCarryTheReason) {
  EXPECT_THAT(LoadStatus(File("json", R"({"length_unit": "LENGTH_UNIT_FURLONG"})")),
              StatusIs(kInvalid, HasSubstr("LENGTH_UNIT_FURLONG")));
  EXPECT_THAT(LoadStatus(File("json", R"({"no_such_field": 1})")),
              StatusIs(kInvalid, HasSubstr("no_such_field")));
  EXPECT_THAT(LoadStatus(File("json", R"({"patches": [{"bezier": {"points": ["x"]}}]})")),
              StatusIs(kInvalid, _));
  EXPECT_THAT(LoadStatus(File("json", R"({"patches": []})")), StatusIs(kInvalid, HasSubstr("length_unit")));
}

TEST(LoadModel, NotFiniteNumbersOfAJsonAreFaultsWithTheirPlace) {
  std::string json = JsonOf(Bump());
  json.replace(json.find("4,"), 1, "\"NaN\"");
  const auto loaded = LoadModel(File("json", json), "source");
  ASSERT_TRUE(loaded.ok()) << loaded.status();
  ASSERT_EQ(loaded->faults.size(), 1u);
  EXPECT_THAT(loaded->faults[0].message, HasSubstr("not finite"));
}

// Small inputs that ask for much: depth, counts, numbers.
TEST(LoadModel, AbsurdInputsCostLittle) {
  std::string deep = R"({"patches": )";
  for (int i = 0; i < 100000; ++i) deep += '[';
  EXPECT_THAT(LoadStatus(File("json", deep)), StatusIs(kInvalid, _));
  EXPECT_FALSE(LoadStatus(File("bpt", "2000000000\n3 3\n")).ok());
  EXPECT_FALSE(LoadStatus(File("bv", "4 2000000000\n1 1 1\n")).ok());
  const std::string commas =
      R"({"patches": [{"bezier": {"points": [)" + std::string(20'000'000, ',') + "]}}]}";
  EXPECT_THAT(LoadStatus(File("json", commas)),
              StatusIs(absl::StatusCode::kResourceExhausted, HasSubstr("json_value_count")));
}

// The fuzz target's corpus as a test: bytes changed at seeded places.
TEST(LoadModel, ChangedBytesKeepTheContract) {
  std::mt19937 random(20261121);
  const std::pair<const char*, std::string> seeds[] = {{"json", JsonOf(Bump())},
                                                       {"pb", Bump().SerializeAsString()}};
  for (const auto& [format, seed] : seeds) {
    EXPECT_TRUE(KeepsModelSourceContract(format, seed));
    for (int round = 0; round < 3000; ++round) {
      std::string bytes = seed;
      for (unsigned changes = 1 + random() % 4; changes > 0; --changes) {
        bytes[random() % bytes.size()] = static_cast<char>(random() % 256);
      }
      ASSERT_TRUE(KeepsModelSourceContract(format, bytes)) << format << " round " << round;
    }
  }
}

TEST(LoadModel, AFieldOfANewerContractIsRefused) {
  v1::PatchModel model = Bump();
  model.mutable_patches(0)->GetReflection()->MutableUnknownFields(model.mutable_patches(0))->AddVarint(99, 1);
  EXPECT_THAT(LoadStatus(File("pb", model.SerializeAsString())),
              StatusIs(kInvalid, HasSubstr("patches[0].#99")));
}

TEST(LoadModel, UnitsOfFileAndRequestMustAgree) {
  v1::ModelSource source = File("json", JsonOf(Bump()));
  source.mutable_file()->set_length_unit(v1::LENGTH_UNIT_INCH);
  EXPECT_THAT(LoadStatus(source), StatusIs(kInvalid, HasSubstr("source.file.length_unit differs")));
}

}  // namespace
}  // namespace patchmill
