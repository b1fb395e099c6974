#include "tests/support/golden/job_file.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>

#include <google/protobuf/struct.pb.h>
#include <google/protobuf/util/json_util.h>

#include "core/base/status.h"
#include "proto/json/json_message.h"

namespace patchmill::testing {
namespace {

namespace fs = std::filesystem;
using google::protobuf::Struct;
using google::protobuf::Value;

absl::Status Fault(const std::string& name, const std::string& what) {
  return absl::InvalidArgumentError("golden job " + name + ": " + what);
}

std::optional<std::string> Contents(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) return std::nullopt;
  return std::string(std::istreambuf_iterator<char>(in), {});
}

absl::Status Read(const Value& value, google::protobuf::Message& message) {
  std::string json;
  const auto status = google::protobuf::util::MessageToJsonString(value, &json);
  if (!status.ok()) return absl::InternalError(std::string(status.message()));
  return ReadJsonMessage(json, message);
}

// The lines of a program, one string each.
std::string Lines(const Value& value) {
  std::string text;
  for (const Value& line : value.list_value().values()) text += line.string_value() + '\n';
  return text;
}

absl::Status FillModel(const fs::path& root, const std::string& path, v1::ModelSource& source) {
  const auto content = Contents(root / path);
  if (!content) return absl::NotFoundError("no such model: " + path);
  source.mutable_file()->set_content(*content);
  source.mutable_file()->set_format(fs::path(path).extension().string().substr(1));
  return absl::OkStatus();
}

absl::Status ReadRequest(const fs::path& root, const Struct& file, GoldenJob& job) {
  for (const auto& [key, value] : file.fields()) {
    if (key == "covers") {
      job.covers = value.string_value();
    } else if (key == "generate") {
      PM_RETURN_IF_ERROR(Read(value, job.request.emplace<v1::GenerateProgramRequest>()));
    } else if (key == "verify") {
      PM_RETURN_IF_ERROR(Read(value, job.request.emplace<v1::VerifyProgramRequest>()));
    } else if (key != "model" && key != "program") {
      return absl::InvalidArgumentError("\"" + key + "\" is no key of it");
    }
  }
  auto* verify = std::get_if<v1::VerifyProgramRequest>(&job.request);
  if (file.fields().contains("program") && verify != nullptr) {
    verify->set_program(Lines(file.fields().at("program")));
  }
  if (!file.fields().contains("model")) return absl::OkStatus();
  v1::ModelSource& source =
      verify != nullptr ? *verify->mutable_source()
                        : *std::get<v1::GenerateProgramRequest>(job.request).mutable_job()->mutable_source();
  return FillModel(root, file.fields().at("model").string_value(), source);
}

}  // namespace

absl::StatusOr<GoldenJob> ReadGoldenJob(const std::string& root, const std::string& name) {
  const auto text = Contents(fs::path(root) / "tests/golden/jobs" / (name + ".json"));
  if (!text) return Fault(name, "no such file");
  Struct file;
  const auto status = google::protobuf::util::JsonStringToMessage(*text, &file);
  if (!status.ok()) return Fault(name, std::string(status.message()));
  GoldenJob job;
  job.name = name;
  if (const absl::Status read = ReadRequest(root, file, job); !read.ok()) {
    return Fault(name, std::string(read.message()));
  }
  if (job.covers.empty()) return Fault(name, "does not say what it covers");
  return job;
}

absl::StatusOr<std::vector<GoldenJob>> ReadGoldenJobs(const std::string& root) {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(fs::path(root) / "tests/golden/jobs")) {
    if (entry.path().extension() == ".json") names.push_back(entry.path().stem().string());
  }
  std::sort(names.begin(), names.end());
  std::vector<GoldenJob> jobs;
  for (const std::string& name : names) {
    PM_ASSIGN_OR_RETURN(jobs.emplace_back(), ReadGoldenJob(root, name));
  }
  return jobs;
}

}  // namespace patchmill::testing
