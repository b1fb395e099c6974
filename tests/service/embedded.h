// A server inside the test, with stubs for all its services: without a port, or on a free one.
#pragma once

#include <chrono>
#include <memory>
#include <string>
#include <vector>

#include <grpcpp/grpcpp.h>

#include "core/base/status.h"
#include "patchmill/v1/analysis_service.grpc.pb.h"
#include "patchmill/v1/model_service.grpc.pb.h"
#include "patchmill/v1/toolpath_service.grpc.pb.h"
#include "server/server.h"

namespace patchmill::testing {

inline ServerOptions Forgetful(ServerOptions options) {
  options.store_mib = 0;
  return options;
}

struct Embedded {
  // It keeps nothing between calls, so that each request is a new job.
  explicit Embedded(ServerOptions options = {}) : Embedded(StartEmbeddedServer(Forgetful(options)), "") {}
  Embedded(std::unique_ptr<RunningServer> running, const std::string& target)
      : server(std::move(running)),
        channel(target.empty() ? server->InProcessChannel()
                               : grpc::CreateChannel(target, grpc::InsecureChannelCredentials())),
        model(v1::ModelService::NewStub(channel)),
        analysis(v1::AnalysisService::NewStub(channel)),
        toolpath(v1::ToolpathService::NewStub(channel)) {}

  std::unique_ptr<RunningServer> server;
  std::shared_ptr<grpc::Channel> channel;
  std::unique_ptr<v1::ModelService::Stub> model;
  std::unique_ptr<v1::AnalysisService::Stub> analysis;
  std::unique_ptr<v1::ToolpathService::Stub> toolpath;

  struct Stream {
    std::vector<v1::GenerateProgramResponse> events;
    grpc::Status status;

    std::string Program() const {
      std::string text;
      for (const auto& event : events) text += event.program().data();
      return text;
    }
    const v1::Report* Report() const {
      return !events.empty() && events.back().has_report() ? &events.back().report() : nullptr;
    }
  };
  Stream Generate(const v1::GenerateProgramRequest& request, grpc::ClientContext* context) const {
    Stream stream;
    const auto reader = toolpath->GenerateProgram(context, request);
    v1::GenerateProgramResponse response;
    while (reader->Read(&response)) stream.events.push_back(response);
    stream.status = reader->Finish();
    return stream;
  }
  Stream Generate(const v1::GenerateProgramRequest& request) const {
    grpc::ClientContext context;
    return Generate(request, &context);
  }
  grpc::Status Check(const v1::CheckModelRequest& request, v1::CheckModelResponse* response) const {
    grpc::ClientContext context;
    return model->CheckModel(&context, request, response);
  }
};

// On a free port of loopback, for what the in-process transport lacks: connections, drains, compression.
inline Embedded EmbeddedOnAPort() {
  ServerOptions options;
  options.listen = "127.0.0.1:0";
  options.log_requests = false;
  auto started = StartServer(options);
  PM_CHECK(started.ok());
  const std::string target = "127.0.0.1:" + std::to_string((*started)->port());
  return Embedded(*std::move(started), target);
}

}  // namespace patchmill::testing
