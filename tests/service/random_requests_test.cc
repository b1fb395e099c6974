// Requests of every RPC that are a little or badly wrong: each is answered, and every error has a code and a
// reason. The worked requests of the documentation are where the random ones start from.
#include <limits>
#include <map>
#include <random>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <google/protobuf/descriptor.h>
#include <google/protobuf/dynamic_message.h>
#include <google/protobuf/util/json_util.h>
#include <gtest/gtest.h>

#include "tests/service/embedded.h"
#include "tests/service/raw_stub.h"
#include "tests/service/status_matchers.h"
#include "tests/support/files.h"
#include "tests/support/fuzz.h"

namespace patchmill {
namespace {

using google::protobuf::Descriptor;
using google::protobuf::FieldDescriptor;
using google::protobuf::Message;
using google::protobuf::MethodDescriptor;
using google::protobuf::Reflection;
using grpc::StatusCode;
using testing::Embedded;
using testing::EmbeddedOnAPort;
using testing::RawStream;

// Changes messages at random, through their descriptors.
class Mutator {
 public:
  explicit Mutator(unsigned seed) : random_(seed) {}

  std::size_t Below(std::size_t n) { return std::uniform_int_distribution<std::size_t>(0, n - 1)(random_); }
  bool Chance(double p) { return std::uniform_real_distribution<>(0.0, 1.0)(random_) < p; }

  // Changes one field of `message`, or of a message in it.
  void Change(Message& message, int depth = 0) {
    const Descriptor& type = *message.GetDescriptor();
    if (type.field_count() == 0) return;
    const Reflection& reflection = *message.GetReflection();
    std::vector<const FieldDescriptor*> set;
    reflection.ListFields(message, &set);
    // Mostly a field that is there: a change deep inside a good request gets farthest.
    const FieldDescriptor& field =
        !set.empty() && Chance(0.8)
            ? *set[Below(set.size())]
            : *type.field(static_cast<int>(Below(static_cast<std::size_t>(type.field_count()))));
    if (Chance(0.05)) {
      reflection.ClearField(&message, &field);
    } else if (field.is_repeated()) {
      ChangeList(message, field, depth);
    } else if (field.cpp_type() == FieldDescriptor::CPPTYPE_MESSAGE) {
      if (depth < 12) Change(*reflection.MutableMessage(&message, &field), depth + 1);
    } else {
      SetValue(message, field);
    }
  }

  std::string Damaged(std::string bytes) {
    if (bytes.empty()) return "\xFF";
    switch (Below(3)) {
      case 0:
        bytes[Below(bytes.size())] ^= static_cast<char>(1 << Below(8));
        break;
      case 1:
        bytes.resize(Below(bytes.size()));
        break;
      default:
        bytes.insert(Below(bytes.size()), bytes.substr(Below(bytes.size()), 20));
    }
    return bytes;
  }

 private:
  double Number() {
    constexpr double kOdd[] = {
        0.0,  -0.0,  -1.0, 1.0,  1e-300, 1e300, std::numeric_limits<double>::quiet_NaN(),
        1e-9, 1e9,   0.5,  45.0, 1e5,    -1e5,  std::numeric_limits<double>::infinity(),
        1e-4, 1000.0};
    return Chance(0.5) ? kOdd[Below(std::size(kOdd))] : std::normal_distribution<>(0.0, 20.0)(random_);
  }
  std::int64_t Integer() {
    constexpr std::int64_t kOdd[] = {0, 1, -1, 2, 3, 15, 16, 64, 1000, 2147483647, -2147483648LL};
    return kOdd[Below(std::size(kOdd))];
  }
  std::string Text() {
    const std::string kOdd[] = {"",    "f12", "G54",  "linuxcnc", "x", std::string(300, 'y'),
                                "\n(", "ä",   "json", "step"};
    return kOdd[Below(std::size(kOdd))];
  }

  void ChangeList(Message& message, const FieldDescriptor& field, int depth) {
    const Reflection& reflection = *message.GetReflection();
    const int size = reflection.FieldSize(message, &field);
    if (size > 0 && Chance(0.15)) {
      reflection.RemoveLast(&message, &field);
    } else if (size > 1 && Chance(0.1)) {
      reflection.SwapElements(&message, &field, static_cast<int>(Below(static_cast<std::size_t>(size))), 0);
    } else if (field.cpp_type() == FieldDescriptor::CPPTYPE_MESSAGE) {
      if (size == 0 || Chance(0.1)) {
        reflection.AddMessage(&message, &field);
      } else if (depth < 12) {
        const int at = static_cast<int>(Below(static_cast<std::size_t>(size)));
        Change(*reflection.MutableRepeatedMessage(&message, &field, at), depth + 1);
      }
    } else {
      SetElement(message, field,
                 size == 0 || Chance(0.1) ? -1 : static_cast<int>(Below(static_cast<std::size_t>(size))));
    }
  }

  void SetValue(Message& m, const FieldDescriptor& f) {
    const Reflection& r = *m.GetReflection();
    switch (f.cpp_type()) {
      case FieldDescriptor::CPPTYPE_DOUBLE:
        return r.SetDouble(&m, &f, Number());
      case FieldDescriptor::CPPTYPE_FLOAT:
        return r.SetFloat(&m, &f, static_cast<float>(Number()));
      case FieldDescriptor::CPPTYPE_INT32:
        return r.SetInt32(&m, &f, static_cast<std::int32_t>(Integer()));
      case FieldDescriptor::CPPTYPE_INT64:
        return r.SetInt64(&m, &f, Integer());
      case FieldDescriptor::CPPTYPE_UINT32:
        return r.SetUInt32(&m, &f, static_cast<std::uint32_t>(Integer()));
      case FieldDescriptor::CPPTYPE_UINT64:
        return r.SetUInt64(&m, &f, static_cast<std::uint64_t>(Integer()));
      case FieldDescriptor::CPPTYPE_BOOL:
        return r.SetBool(&m, &f, Chance(0.5));
      case FieldDescriptor::CPPTYPE_ENUM:
        return r.SetEnumValue(&m, &f, static_cast<int>(Below(9)));
      case FieldDescriptor::CPPTYPE_STRING:
        return r.SetString(&m, &f, Text());
      case FieldDescriptor::CPPTYPE_MESSAGE:
        return;
    }
  }
  void SetElement(Message& m, const FieldDescriptor& f, int at) {
    const Reflection& r = *m.GetReflection();
    switch (f.cpp_type()) {
      case FieldDescriptor::CPPTYPE_DOUBLE:
        return at < 0 ? r.AddDouble(&m, &f, Number()) : r.SetRepeatedDouble(&m, &f, at, Number());
      case FieldDescriptor::CPPTYPE_INT32: {
        const auto value = static_cast<std::int32_t>(Integer());
        return at < 0 ? r.AddInt32(&m, &f, value) : r.SetRepeatedInt32(&m, &f, at, value);
      }
      case FieldDescriptor::CPPTYPE_ENUM: {
        const int value = static_cast<int>(Below(9));
        return at < 0 ? r.AddEnumValue(&m, &f, value) : r.SetRepeatedEnumValue(&m, &f, at, value);
      }
      case FieldDescriptor::CPPTYPE_STRING:
        return at < 0 ? r.AddString(&m, &f, Text()) : r.SetRepeatedString(&m, &f, at, Text());
      default:
        return;
    }
  }

  std::mt19937 random_;
};

struct Rpc {
  const MethodDescriptor* method;
  std::vector<std::string> request;  // serialized messages of a request that succeeds
};

std::string PathOf(const MethodDescriptor& method) {
  return "/" + method.service()->full_name() + "/" + method.name();
}

std::unique_ptr<Message> New(const Descriptor& type) {
  return std::unique_ptr<Message>(
      google::protobuf::MessageFactory::generated_factory()->GetPrototype(&type)->New());
}

// The documents of a file: one, or one a line.
std::vector<Rpc> AllRpcs() {
  std::vector<Rpc> rpcs;
  const auto& pool = *google::protobuf::DescriptorPool::generated_pool();
  for (const char* name : {v1::ModelService::service_full_name(), v1::AnalysisService::service_full_name(),
                           v1::ToolpathService::service_full_name()}) {
    const google::protobuf::ServiceDescriptor& service = *pool.FindServiceByName(name);
    for (int k = 0; k < service.method_count(); ++k) {
      const MethodDescriptor& method = *service.method(k);
      const std::string text = testing::ReadRepositoryFile("docs/requests/" + method.name() + ".json");
      std::vector<std::string> documents = {text};
      if (method.client_streaming()) {
        documents.clear();
        std::istringstream lines(text);
        for (std::string line; std::getline(lines, line);) documents.push_back(line);
      }
      Rpc rpc{&method, {}};
      for (const std::string& document : documents) {
        const auto message = New(*method.input_type());
        const auto status = google::protobuf::util::JsonStringToMessage(document, message.get());
        EXPECT_TRUE(status.ok()) << method.name() << ": " << status.ToString();
        rpc.request.push_back(message->SerializeAsString());
      }
      rpcs.push_back(std::move(rpc));
    }
  }
  return rpcs;
}

grpc::Status Send(const Embedded& embedded, const Rpc& rpc, const std::vector<std::string>& messages) {
  RawStream stream(embedded.channel, PathOf(*rpc.method));
  for (const std::string& message : messages) {
    if (!stream.Write(message)) break;
  }
  stream.WritesDone();
  while (stream.Read()) {
  }
  return stream.Finish();
}

Embedded SmallServer(double max_job_seconds) {
  ServerOptions options;
  options.listen = "127.0.0.1:0";
  options.log_requests = false;
  options.max_job_seconds = max_job_seconds;
  options.store_mib = 16;
  auto started = StartServer(options);
  PM_CHECK(started.ok());
  const std::string target = "127.0.0.1:" + std::to_string((*started)->port());
  Embedded embedded(*std::move(started), target);
  grpc::ChannelArguments arguments;
  arguments.SetMaxReceiveMessageSize(-1);  // answers may have 64 MiB
  embedded.channel = grpc::CreateCustomChannel(target, grpc::InsecureChannelCredentials(), arguments);
  return embedded;
}

TEST(RandomRequests, EveryWorkedRequestSucceeds) {
  const Embedded embedded = SmallServer(60.0);
  const std::vector<Rpc> rpcs = AllRpcs();
  EXPECT_GE(rpcs.size(), 15u);
  for (const Rpc& rpc : rpcs) {
    const grpc::Status status = Send(embedded, rpc, rpc.request);
    EXPECT_TRUE(status.ok()) << rpc.method->name() << ": " << status.error_message();
  }
}

TEST(RandomRequests, AreAnsweredWithACodeAndAReason) {
  const Embedded embedded = SmallServer(1.0);
  const std::vector<Rpc> rpcs = AllRpcs();
  std::map<std::string, int> succeeded, failed;
  const int count = testing::FromEnvironment("PATCHMILL_FUZZ_JOBS", 480);
  for (int k = 0; k < count; ++k) {
    const Rpc& rpc = rpcs[static_cast<std::size_t>(k) % rpcs.size()];
    Mutator mutator(static_cast<unsigned>(k + testing::FromEnvironment("PATCHMILL_FUZZ_SEED", 0)));
    std::vector<std::string> messages = rpc.request;
    std::string& changed = messages[mutator.Below(messages.size())];
    if (mutator.Chance(0.1)) {
      // As it is.
    } else if (mutator.Chance(0.1)) {
      changed = mutator.Damaged(changed);
    } else {
      const auto message = New(*rpc.method->input_type());
      ASSERT_TRUE(message->ParseFromString(changed));
      for (std::size_t n = 1 + mutator.Below(3); n > 0; --n) mutator.Change(*message);
      changed = message->SerializeAsString();
    }
    const grpc::Status status = Send(embedded, rpc, messages);
    const std::string& name = rpc.method->name();
    if (status.ok()) {
      ++succeeded[name];
      continue;
    }
    ++failed[name];
    const std::string reason = testing::InfoOf(status).reason();
    EXPECT_NE(reason, "") << name << " " << k << ": " << status.error_code() << " " << status.error_message();
    EXPECT_NE(status.error_code(), StatusCode::INTERNAL)
        << name << " " << k << ": " << status.error_message();
    EXPECT_NE(status.error_code(), StatusCode::UNKNOWN) << name << " " << k << ": " << status.error_message();
    EXPECT_NE(status.error_message(), "") << name << " " << k;
  }
  for (const Rpc& rpc : rpcs) {
    EXPECT_GT(succeeded[rpc.method->name()], 0) << rpc.method->name();
    EXPECT_GT(failed[rpc.method->name()], 0) << rpc.method->name();
  }
}

}  // namespace
}  // namespace patchmill
