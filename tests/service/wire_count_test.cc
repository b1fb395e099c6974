#include "server/wire_count.h"

#include <memory>
#include <random>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <google/protobuf/descriptor.pb.h>
#include <google/protobuf/dynamic_message.h>
#include <google/protobuf/text_format.h>
#include <google/protobuf/unknown_field_set.h>
#include <gtest/gtest.h>

#include "patchmill/v1/model_service.pb.h"
#include "patchmill/v1/toolpath_service.pb.h"
#include "server/wire_limits.h"
#include "tests/fuzz/wire_count_contract.h"
#include "tests/service/raw_stub.h"
#include "tests/service/requests.h"
#include "tests/service/status_matchers.h"

namespace patchmill {
namespace {

using google::protobuf::Descriptor;
using ::testing::HasSubstr;
using testing::InfoOf;
using testing::LengthDelimited;
using testing::Repeated;
using testing::StatusIs;

constexpr auto kInvalid = absl::StatusCode::kInvalidArgument;
constexpr auto kExhausted = absl::StatusCode::kResourceExhausted;

// What Patchmill's own messages do not have: groups, maps, recursion, numbers of every kind.
class Schema {
 public:
  Schema() {
    google::protobuf::FileDescriptorProto file;
    const bool parsed = google::protobuf::TextFormat::ParseFromString(
        R"pb(
          name: "test.proto"
          package: "test"
          syntax: "proto2"
          message_type {
            name: "Node"
            field { name: "child" number: 1 label: LABEL_REPEATED type: TYPE_MESSAGE type_name: ".test.Node" }
            field {
              name: "packed"
              number: 2
              label: LABEL_REPEATED
              type: TYPE_INT64
              options { packed: true }
            }
            field { name: "loose" number: 3 label: LABEL_REPEATED type: TYPE_FIXED32 }
            field { name: "names" number: 4 label: LABEL_REPEATED type: TYPE_STRING }
            field {
              name: "part"
              number: 5
              label: LABEL_REPEATED
              type: TYPE_GROUP
              type_name: ".test.Node.Part"
            }
            field {
              name: "map"
              number: 6
              label: LABEL_REPEATED
              type: TYPE_MESSAGE
              type_name: ".test.Node.MapEntry"
            }
            field { name: "only" number: 7 label: LABEL_OPTIONAL type: TYPE_MESSAGE type_name: ".test.Node" }
            field {
              name: "flags"
              number: 8
              label: LABEL_REPEATED
              type: TYPE_BOOL
              options { packed: true }
            }
            nested_type {
              name: "Part"
              field { name: "x" number: 1 label: LABEL_OPTIONAL type: TYPE_DOUBLE }
            }
            nested_type {
              name: "MapEntry"
              field { name: "key" number: 1 label: LABEL_OPTIONAL type: TYPE_STRING }
              field {
                name: "value"
                number: 2
                label: LABEL_OPTIONAL
                type: TYPE_MESSAGE
                type_name: ".test.Node"
              }
              options { map_entry: true }
            }
          })pb",
        &file);
    node_ = parsed ? pool_.BuildFile(file)->FindMessageTypeByName("Node") : nullptr;
  }
  const Descriptor& node() const { return *node_; }
  // From text; serialized.
  std::string Bytes(const std::string& text) {
    const std::unique_ptr<google::protobuf::Message> message(factory_.GetPrototype(node_)->New());
    EXPECT_TRUE(google::protobuf::TextFormat::ParseFromString(text, message.get())) << text;
    return message->SerializeAsString();
  }

 private:
  google::protobuf::DescriptorPool pool_;
  google::protobuf::DynamicMessageFactory factory_{&pool_};
  const Descriptor* node_ = nullptr;
};

class WireCounts : public ::testing::Test {
 protected:
  absl::StatusOr<WireCount> Count(const std::string& bytes, const WireLimits& most = NoWireLimits()) {
    return CountString(bytes, schema_.node(), most);
  }
  absl::StatusOr<WireCount> CountText(const std::string& text) { return Count(schema_.Bytes(text)); }

  Schema schema_;
};

TEST_F(WireCounts, EveryKindOfElement) {
  const auto count = CountText(R"(
    child { child { packed: [1, 300, -1] } names: "a" }
    packed: [7, 8] loose: [1, 2, 3, 4] flags: [true, false]
    Part { x: 1 } Part {}
    map { key: "k" value { loose: 5 } }
    only { only {} })");
  ASSERT_TRUE(count.ok()) << count.status();
  EXPECT_EQ(count->messages, 2u + 2u + 2u + 2u);  // children, parts, the map's entry and its value, only
  EXPECT_EQ(count->numbers, 3u + 2u + 4u + 2u + 1u);
  const auto empty = Count("");
  ASSERT_TRUE(empty.ok());
  EXPECT_EQ(empty->messages + empty->numbers, 0u);
}

// Packed or not, both count alike, as the parser takes both.
TEST_F(WireCounts, PackedOrNotIsTheSameNumber) {
  const std::string loose_varints = Repeated("\x10\x05", 9),
                    packed_varints = LengthDelimited(2, std::string(9, 5));
  const std::string packed_fixed = LengthDelimited(3, std::string(4 * 9, 1));
  const std::string loose_fixed = Repeated(std::string("\x1D\x01\x01\x01\x01", 5), 9);
  for (const std::string& bytes : {loose_varints, packed_varints, packed_fixed, loose_fixed}) {
    const auto count = Count(bytes);
    ASSERT_TRUE(count.ok()) << count.status();
    EXPECT_EQ(count->numbers, 9u);
  }
}

TEST_F(WireCounts, TheFirstLimitThatIsPassedIsNamed) {
  WireLimits most = NoWireLimits();
  most.elements = [](const google::protobuf::FieldDescriptor& field) {
    return field.name() == "names" ? 2u : 1000u;
  };
  EXPECT_TRUE(Count(schema_.Bytes("only { names: ['a', 'b'] }"), most).ok());
  // Of the whole message together.
  EXPECT_THAT(Count(schema_.Bytes("names: 'a' only { names: ['a', 'b'] }"), most).status(),
              StatusIs(kExhausted, HasSubstr("only.names = 3; the limit is 2")));
  most.numbers = 3;
  EXPECT_TRUE(Count(schema_.Bytes("packed: [1, 2] loose: 3"), most).ok());
  const absl::Status numbers = Count(schema_.Bytes("packed: [1, 2] loose: [3, 4]"), most).status();
  EXPECT_THAT(numbers, StatusIs(kExhausted, HasSubstr("repeated_number_count = 4; the limit is 3")));
  EXPECT_THAT(numbers, StatusIs(kExhausted, HasSubstr("at loose")));
  EXPECT_EQ(InfoOf(ToGrpcStatus(numbers)).reason(), "LIMIT_EXCEEDED");
  EXPECT_EQ(InfoOf(ToGrpcStatus(numbers)).limit_value(), 3);
}

// Nothing but nested messages: their sizes in memory are counted, 50 times those on the wire.
TEST_F(WireCounts, NestedBombsStopAtTheMemoryTheyWouldTake) {
  WireLimits most = NoWireLimits();
  most.memory_bytes = 1 << 20;
  const std::string bytes = Repeated(std::string("\x0A\x00", 2), 5'000'000);
  EXPECT_GE(Count(bytes)->memory_bytes, 25 * bytes.size());
  EXPECT_THAT(Count(bytes, most).status(), StatusIs(kExhausted, HasSubstr("message_memory_bytes = ")));
  EXPECT_THAT(Count(Repeated(std::string("\x22\x00", 2), 500'000), most).status(),
              StatusIs(kExhausted, HasSubstr("stopped at names")));
  EXPECT_THAT(Count(LengthDelimited(2, std::string(500'000, 1)), most).status(),
              StatusIs(kExhausted, HasSubstr("stopped at packed")));
  EXPECT_THAT(Count(Repeated("\x2B\x2C", 500'000), most).status(),
              StatusIs(kExhausted, HasSubstr("stopped at part")));
}

// Parsed they would be kept, each with a record of its own.
TEST_F(WireCounts, UnknownFieldsHaveTheirPrice) {
  const std::string varints = Repeated(std::string("\xF8\x01\x00", 3), 1000),
                    texts = Repeated(std::string("\xFA\x01\x00", 3), 1000),
                    groups = Repeated("\xFB\x01\xFC\x01", 1000);
  for (const std::string& bytes : {varints, texts, groups}) {
    const auto count = Count(bytes);
    ASSERT_TRUE(count.ok()) << count.status();
    EXPECT_EQ(count->messages + count->numbers, 0u);
    EXPECT_GE(count->memory_bytes, 1000 * sizeof(google::protobuf::UnknownField));
  }
  // A known field of another wire type is unknown too.
  EXPECT_TRUE(Count(std::string("\x08\x01", 2)).ok());
  EXPECT_EQ(Count(std::string("\x08\x01", 2))->messages, 0u);
}

TEST_F(WireCounts, DepthIsThatOfTheParser) {
  const auto nested = [](int depth) {
    std::string bytes;
    for (int k = 0; k < depth; ++k) bytes = LengthDelimited(7, bytes);
    return bytes;
  };
  EXPECT_TRUE(Count(nested(kMaxWireDepth - 1)).ok());
  EXPECT_THAT(Count(nested(kMaxWireDepth + 1)).status(), StatusIs(kInvalid, HasSubstr("more than 100 deep")));
  EXPECT_THAT(Count(Repeated("\xFB\x01", 1'000'000)).status(),
              StatusIs(kInvalid, HasSubstr("more than 100 deep")));
}

TEST_F(WireCounts, BytesThatAreNoMessageAreRefused) {
  const std::string sound =
      schema_.Bytes(R"(child { packed: [1, 300] names: "abc" } Part { x: 1 } loose: 3)");
  for (std::size_t n = 1; n < sound.size(); ++n) {
    const auto count = Count(sound.substr(0, n));
    EXPECT_TRUE(count.ok() || InfoOf(ToGrpcStatus(count.status())).reason() == "REQUEST_UNREADABLE") << n;
  }
  const std::vector<std::string> wrong = {
      std::string("\x00", 1),          // field 0
      "\x0A",                          // no length
      std::string("\x0A\x02\x10", 3),  // length beyond the end
      "\x0C",                          // end of no group
      "\x2B",                          // group without end
      std::string("\x2B\x34", 2),      // end of another group
      "\x0E",
      "\x0F",                                  // wire types there are not
      std::string("\x12\x01\x80", 3),          // a packed number that does not end
      std::string("\x1A\x03\x01\x01\x01", 5),  // three quarters of a number
      "\xFF\xFF\xFF\xFF\xFF\xFF\xFF\xFF\xFF\xFF\xFF",
      std::string("\x0A\x02\x0A\x01\x00", 5)};  // longer than what it is in
  for (const std::string& bytes : wrong) {
    EXPECT_THAT(Count(bytes).status(), StatusIs(kInvalid, HasSubstr("the request cannot be read at ")))
        << bytes.size();
  }
}

// The price is what Protobuf says a message takes, within the allocator's share and growing lists.
TEST(WireCount, MemoryIsThatOfTheParsedMessage) {
  v1::GenerateProgramRequest job = testing::BumpRequest();
  v1::CheckModelRequest network, many;
  v1::CurveNetwork& net = *network.mutable_source()->mutable_model()->mutable_network();
  for (int k = 0; k < 2000; ++k) {
    for (int i = 0; i < 3; ++i) net.add_vertices()->mutable_position()->Resize(3, k);
    v1::NetworkFace& face = *net.add_faces();
    face.set_id(fmt::format("face number {} of the net", k));
    for (int i = 0; i < 4; ++i) face.add_vertices(k + i);
  }
  for (int k = 0; k < 2000; ++k)
    *many.mutable_source()->mutable_model()->add_patches() = testing::Bump().patches(0);
  for (const google::protobuf::Message* message :
       {static_cast<google::protobuf::Message*>(&job), static_cast<google::protobuf::Message*>(&network),
        static_cast<google::protobuf::Message*>(&many)}) {
    const auto count = CountString(message->SerializeAsString(), *message->GetDescriptor(), NoWireLimits());
    ASSERT_TRUE(count.ok()) << count.status();
    WireCount parsed;
    AddParsed(*message, parsed);
    EXPECT_EQ(count->messages, parsed.messages);
    EXPECT_EQ(count->numbers, parsed.numbers);
    EXPECT_GE(1.5 * static_cast<double>(count->memory_bytes), static_cast<double>(message->SpaceUsedLong()));
    EXPECT_LE(static_cast<double>(count->memory_bytes), 2.0 * static_cast<double>(message->SpaceUsedLong()));
  }
}

// The largest models that the converters take pass, at a price below the default of a server.
TEST(ListLimits, LetTheLargestModelsPass) {
  v1::CheckModelRequest patches, spline;
  for (std::size_t k = 0; k < limits::kMaxPatches; ++k) {
    v1::BezierPatch& bezier = *patches.mutable_source()->mutable_model()->add_patches()->mutable_bezier();
    bezier.set_degree_u(3);
    bezier.mutable_points()->Resize(3 * 16, 1.0);
  }
  v1::BsplinePatch& one = *spline.mutable_source()->mutable_model()->add_patches()->mutable_bspline();
  one.mutable_points()->Resize(3 * static_cast<int>(limits::kMaxControlPoints), 1.0);
  for (const v1::CheckModelRequest& request : {patches, spline}) {
    const auto count = CountString(request.SerializeAsString(), *v1::CheckModelRequest::descriptor(),
                                   ListLimits(std::size_t{limits::kMaxInFlightMib} << 20));
    EXPECT_TRUE(count.ok()) << count.status();
  }
  *patches.mutable_source()->mutable_model()->add_patches() = {};
  EXPECT_THAT(CountString(patches.SerializeAsString(), *v1::CheckModelRequest::descriptor(),
                          ListLimits(std::size_t{1} << 40))
                  .status(),
              StatusIs(kExhausted, HasSubstr("source.model.patches = 100001; the limit is 100000")));
}

// The fuzz target's corpus as a test: bytes changed, cut and put together at seeded places.
TEST(WireCount, ChangedBytesKeepTheContract) {
  std::mt19937 random(20261121);
  v1::GenerateProgramRequest message;
  const std::string seed = testing::BumpRequest().SerializeAsString();
  ASSERT_TRUE(KeepsWireCountContract(seed, message));
  for (int round = 0; round < 5000; ++round) {
    std::string bytes = seed.substr(0, random() % 4 == 0 ? random() % seed.size() : seed.size());
    if (bytes.empty()) continue;
    for (unsigned changes = 1 + random() % 4; changes > 0; --changes) {
      bytes[random() % bytes.size()] = static_cast<char>(random() % 256);
    }
    if (random() % 8 == 0) bytes += seed;
    ASSERT_TRUE(KeepsWireCountContract(bytes, message)) << round;
  }
}

}  // namespace
}  // namespace patchmill
