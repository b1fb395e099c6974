// The contract judged by its own descriptors: units in names, enums with a zero, no unsigned numbers, a
// comment on everything, errors listed at every call.
#include <array>
#include <fstream>
#include <set>

#include <google/protobuf/descriptor.h>
#include <google/protobuf/descriptor.pb.h>
#include <gtest/gtest.h>

namespace patchmill {
namespace {

using google::protobuf::DescriptorPool;
using google::protobuf::FieldDescriptor;

const DescriptorPool& Pool() {
  static const DescriptorPool* pool = [] {
    std::ifstream in(PATCHMILL_DESCRIPTORS, std::ios::binary);
    google::protobuf::FileDescriptorSet files;
    EXPECT_TRUE(files.ParseFromIstream(&in)) << PATCHMILL_DESCRIPTORS;
    auto* made = new DescriptorPool();
    for (const char* name : {"google/protobuf/any.proto", "google/protobuf/duration.proto"}) {
      google::protobuf::FileDescriptorProto imported;
      google::protobuf::FileDescriptor const* known = DescriptorPool::generated_pool()->FindFileByName(name);
      if (known == nullptr) continue;
      known->CopyTo(&imported);
      made->BuildFile(imported);
    }
    // Files come in the order of the command line; imports may come later.
    for (int round = 0; round < files.file_size(); ++round) {
      for (const auto& file : files.file()) {
        if (made->FindFileByName(file.name()) != nullptr) continue;
        bool ready = true;
        for (const std::string& import : file.dependency())
          ready = ready && made->FindFileByName(import) != nullptr;
        if (ready) {
          EXPECT_NE(made->BuildFile(file), nullptr) << file.name();
        }
      }
    }
    return made;
  }();
  return *pool;
}

constexpr std::array kFiles = {"analysis_service", "diagnostic", "editing",        "fairing",
                               "geometry",         "job",        "lines",          "model",
                               "model_service",    "network",    "operation",      "outline",
                               "region",           "report",     "server_service", "setup",
                               "status",           "tool",       "toolpath",       "toolpath_service"};

template <class Visit>
void ForEachFile(const Visit& visit) {
  for (const char* name : kFiles) {
    const auto* file = Pool().FindFileByName(std::string("patchmill/v1/") + name + ".proto");
    ASSERT_NE(file, nullptr) << name;
    visit(*file);
  }
}

template <class Visit>
void ForEachField(const Visit& visit) {
  ForEachFile([&](const auto& file) {
    for (int m = 0; m < file.message_type_count(); ++m) {
      const auto& message = *file.message_type(m);
      EXPECT_EQ(message.nested_type_count(), 0) << message.full_name();
      for (int f = 0; f < message.field_count(); ++f) visit(*message.field(f));
    }
  });
}

template <class Descriptor>
void ExpectComment(const Descriptor& descriptor) {
  google::protobuf::SourceLocation location;
  ASSERT_TRUE(descriptor.GetSourceLocation(&location)) << descriptor.full_name();
  EXPECT_GE(location.leading_comments.size() + location.trailing_comments.size(), 3u)
      << descriptor.full_name() << " has no comment";
}

TEST(Contract, DimensionedNumbersCarryTheirUnit) {
  const std::set<std::string> units = {"mm", "mm2", "mm3", "deg", "s", "s2", "min", "rpm"};
  // Numbers without a dimension, and coordinates in the unit their model states.
  const std::set<std::string> plain = {
      "scale", "fraction", "overall_fraction", "max_unreached_fraction", "u", "v", "knots_u", "knots_v",
      "weights", "points", "limit_value", "actual_value", "at", "value", "knots", "position", "direction",
      "gamma", "curvature", "amount", "start_tangent", "end_tangent", "start_direction", "end_direction",
      "start_curvature", "end_curvature", "derivative", "origin", "chord", "start_derivative",
      "end_derivative", "extra_terms", "part_start", "part_end", "start_twist", "end_twist", "breaks_u",
      "breaks_v", "first_derivative", "second_derivative", "energies", "curvatures_before",
      "curvatures_after", "uv", "normal", "arc_turns", "parameter", "normals", "principal_directions",
      "level", "levels", "detail", "up_to_scallops",
      // in the unit of the model that is edited
      "near", "distance", "to", "through", "fullness", "band", "target", "reached", "by"};
  int seen = 0;
  ForEachField([&](const FieldDescriptor& field) {
    const bool single = field.cpp_type() == FieldDescriptor::CPPTYPE_FLOAT;
    const std::string& message = field.containing_type()->name();
    if (single && message != "MeshBlock" && message != "PathBlock")  // what is drawn needs no more
      ADD_FAILURE() << field.full_name() << " is a float";
    if (!single && field.cpp_type() != FieldDescriptor::CPPTYPE_DOUBLE) return;
    ++seen;
    const std::string suffix = field.name().substr(field.name().rfind('_') + 1);
    EXPECT_TRUE(units.contains(suffix) || plain.contains(field.name()) || field.name() == "seconds")
        << field.full_name() << " says no unit";
  });
  EXPECT_GT(seen, 50);
}

TEST(Contract, NoUnsignedNumbers) {
  ForEachField([](const FieldDescriptor& field) {
    EXPECT_NE(field.cpp_type(), FieldDescriptor::CPPTYPE_UINT32) << field.full_name();
    EXPECT_NE(field.cpp_type(), FieldDescriptor::CPPTYPE_UINT64) << field.full_name();
  });
}

TEST(Contract, CountsInReportsAreInt32BecauseJsonMakesStringsOfInt64) {
  const auto* report = Pool().FindMessageTypeByName("patchmill.v1.Report");
  ASSERT_NE(report, nullptr);
  for (int f = 0; f < report->field_count(); ++f) {
    EXPECT_NE(report->field(f)->cpp_type(), FieldDescriptor::CPPTYPE_INT64) << report->field(f)->full_name();
  }
}

TEST(Contract, EnumsStartUnspecified) {
  int seen = 0;
  ForEachFile([&](const auto& file) {
    for (int e = 0; e < file.enum_type_count(); ++e, ++seen) {
      const auto& zero = *file.enum_type(e)->value(0);
      EXPECT_EQ(zero.number(), 0) << zero.full_name();
      EXPECT_TRUE(zero.name().ends_with("_UNSPECIFIED")) << zero.full_name();
    }
  });
  EXPECT_GT(seen, 10);
}

TEST(Contract, EverythingHasAComment) {
  ForEachField([](const FieldDescriptor& field) { ExpectComment(field); });
  ForEachFile([](const auto& file) {
    for (int m = 0; m < file.message_type_count(); ++m) ExpectComment(*file.message_type(m));
    for (int e = 0; e < file.enum_type_count(); ++e) {
      ExpectComment(*file.enum_type(e));
      for (int v = 0; v < file.enum_type(e)->value_count(); ++v) ExpectComment(*file.enum_type(e)->value(v));
    }
  });
}

TEST(Contract, EveryCallListsItsErrors) {
  int seen = 0;
  ForEachFile([&](const auto& file) {
    for (int s = 0; s < file.service_count(); ++s) {
      ExpectComment(*file.service(s));
      for (int m = 0; m < file.service(s)->method_count(); ++m, ++seen) {
        const auto& method = *file.service(s)->method(m);
        google::protobuf::SourceLocation location;
        ASSERT_TRUE(method.GetSourceLocation(&location));
        EXPECT_NE(location.leading_comments.find("Errors:"), std::string::npos) << method.full_name();
      }
    }
  });
  EXPECT_EQ(seen, 17);
}

}  // namespace
}  // namespace patchmill
