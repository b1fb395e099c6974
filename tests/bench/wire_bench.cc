// Whole jobs as a client sees them: the request to the service in this process, until its stream has ended.
#include <benchmark/benchmark.h>
#include <grpcpp/grpcpp.h>

#include "patchmill/v1/toolpath_service.grpc.pb.h"
#include "server/convert/job.h"
#include "server/convert/model.h"
#include "server/server.h"
#include "tests/bench/bench_parts.h"

namespace patchmill::bench {
namespace {

v1::GenerateProgramRequest RequestOf(Part part) {
  v1::GenerateProgramRequest request;
  *request.mutable_job() = ToProto(JobOf(part), "", "");
  *request.mutable_job()->mutable_source()->mutable_model() = ToProto(ModelOf(part));
  return request;
}

// As Job, from the message to the last byte of the program.
void JobOverWire(benchmark::State& state, Part part) {
  const v1::GenerateProgramRequest request = RequestOf(part);
  ServerOptions options;
  options.log_requests = false;
  options.store_mib = 0;  // a kept answer is no job
  const auto server = StartEmbeddedServer(options);
  const auto toolpath = v1::ToolpathService::NewStub(server->InProcessChannel());
  std::size_t bytes = 0;
  for (auto _ : state) {
    grpc::ClientContext context;
    const auto reader = toolpath->GenerateProgram(&context, request);
    bytes = 0;
    for (v1::GenerateProgramResponse response; reader->Read(&response);) {
      bytes += response.program().data().size();
    }
    const grpc::Status status = reader->Finish();
    if (!status.ok()) return state.SkipWithError(status.error_message().c_str());
    if (bytes == 0) return state.SkipWithError("no program");
  }
  state.counters["request_MB"] = 1e-6 * static_cast<double>(request.ByteSizeLong());
  state.counters["program_MB"] = 1e-6 * static_cast<double>(bytes);
}
BENCHMARK_CAPTURE(JobOverWire, two_hills, Part::kTwoHills)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK_CAPTURE(JobOverWire, teapot, Part::kTeapot)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
}  // namespace patchmill::bench
