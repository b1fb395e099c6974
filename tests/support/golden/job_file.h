// The jobs of tests/golden/jobs. Each file has a request as JSON and states its purpose.
#pragma once

#include <ostream>
#include <string>
#include <variant>
#include <vector>

#include <absl/status/statusor.h>

#include "patchmill/v1/toolpath_service.pb.h"

namespace patchmill::testing {

struct GoldenJob {
  std::string name;    // of its file, without .json
  std::string covers;  // in one line
  std::variant<v1::GenerateProgramRequest, v1::VerifyProgramRequest> request;

  friend void PrintTo(const GoldenJob& job, std::ostream* out) { *out << job.name; }  // for GoogleTest
};

// {"covers": "...", "model": "examples/teapot.bpt", "generate": {a GenerateProgramRequest}}, or "verify" with
// a VerifyProgramRequest and "program", a list of its lines. The model's bytes become source.file.content;
// left out where the request has the model itself. INVALID_ARGUMENT with the file's name for anything else.
absl::StatusOr<GoldenJob> ReadGoldenJob(const std::string& root, const std::string& name);

// All of them, by name.
absl::StatusOr<std::vector<GoldenJob>> ReadGoldenJobs(const std::string& root);

}  // namespace patchmill::testing
