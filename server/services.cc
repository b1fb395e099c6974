#include "server/services.h"

#include <chrono>

#include <grpcpp/grpcpp.h>
#include <spdlog/spdlog.h>

#include "core/base/status.h"
#include "patchmill/v1/analysis_service.grpc.pb.h"
#include "patchmill/v1/model_service.grpc.pb.h"
#include "patchmill/v1/toolpath_service.grpc.pb.h"
#include "server/handlers/handlers.h"
#include "server/limits.h"

namespace patchmill {
namespace {

Call MakeCall(ServerEnv* env, grpc::ServerContext* context) {
  Call call;
  call.env = env;
  call.cancelled = [context] { return context->IsCancelled(); };
  const auto deadline = context->deadline();
  if (deadline != std::chrono::system_clock::time_point::max()) {
    call.deadline = RunContext::Clock::now() + (deadline - std::chrono::system_clock::now());
  }
  return call;
}

// One line of a log, whatever a client put into it.
std::string OneLine(std::string text) {
  for (char& c : text) {
    if (c < ' ' || c > '~') c = ' ';
  }
  return text;
}

// Admission, the handler, the status on the wire, one line in the log.
template <class Body>
grpc::Status Run(ServerEnv* env, grpc::ServerContext* context, const std::string& method, const Body& body) {
  const auto begin = std::chrono::steady_clock::now();
  const absl::Status status = [&]() -> absl::Status {
    PM_ASSIGN_OR_RETURN(const Admission::Ticket ticket, env->admission.Enter());
    return body(MakeCall(env, context));
  }();
  if (env->options.log_requests) {
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
    spdlog::info("{} {} {:.3f} s {} {}", method, absl::StatusCodeToString(status.code()), took.count(),
                 context->peer(), OneLine(std::string(status.message())));
  }
  return ToGrpcStatus(status);
}

template <class Response>
Sink<Response> SinkOf(grpc::ServerWriter<Response>* writer) {
  return [writer](const Response& response) { return writer->Write(response); };
}

class ModelServiceImpl final : public v1::ModelService::Service {
 public:
  explicit ModelServiceImpl(ServerEnv* env) : env_(env) {}
  grpc::Status CheckModel(grpc::ServerContext* context, const v1::CheckModelRequest* request,
                          v1::CheckModelResponse* response) override {
    return Run(env_, context, "CheckModel",
               [&](const Call& call) { return HandleCheckModel(call, *request, response); });
  }
  grpc::Status BuildModel(grpc::ServerContext* context, const v1::BuildModelRequest* request,
                          v1::BuildModelResponse* response) override {
    return Run(env_, context, "BuildModel",
               [&](const Call& call) { return HandleBuildModel(call, *request, response); });
  }
  grpc::Status EditModel(grpc::ServerContext* context, const v1::EditModelRequest* request,
                         v1::EditModelResponse* response) override {
    return Run(env_, context, "EditModel",
               [&](const Call& call) { return HandleEditModel(call, *request, response); });
  }
  grpc::Status FairNet(grpc::ServerContext* context, const v1::FairNetRequest* request,
                       v1::FairNetResponse* response) override {
    return Run(env_, context, "FairNet",
               [&](const Call& call) { return HandleFairNet(call, *request, response); });
  }
  grpc::Status FairCurve(grpc::ServerContext* context, const v1::FairCurveRequest* request,
                         v1::FairCurveResponse* response) override {
    return Run(env_, context, "FairCurve",
               [&](const Call& call) { return HandleFairCurve(call, *request, response); });
  }

 private:
  ServerEnv* env_;
};

class AnalysisServiceImpl final : public v1::AnalysisService::Service {
 public:
  explicit AnalysisServiceImpl(ServerEnv* env) : env_(env) {}
  grpc::Status SplitRegions(grpc::ServerContext* context, const v1::SplitRegionsRequest* request,
                            v1::SplitRegionsResponse* response) override {
    return Run(env_, context, "SplitRegions",
               [&](const Call& call) { return HandleSplitRegions(call, *request, response); });
  }
  grpc::Status TabulateReach(grpc::ServerContext* context, const v1::TabulateReachRequest* request,
                             v1::TabulateReachResponse* response) override {
    return Run(env_, context, "TabulateReach",
               [&](const Call& call) { return HandleTabulateReach(call, *request, response); });
  }
  grpc::Status TraceLines(grpc::ServerContext* context, const v1::TraceLinesRequest* request,
                          v1::TraceLinesResponse* response) override {
    return Run(env_, context, "TraceLines",
               [&](const Call& call) { return HandleTraceLines(call, *request, response); });
  }
  grpc::Status EvaluateSurface(grpc::ServerContext* context, const v1::EvaluateSurfaceRequest* request,
                               v1::EvaluateSurfaceResponse* response) override {
    return Run(env_, context, "EvaluateSurface",
               [&](const Call& call) { return HandleEvaluateSurface(call, *request, response); });
  }

 private:
  ServerEnv* env_;
};

class ToolpathServiceImpl final : public v1::ToolpathService::Service {
 public:
  explicit ToolpathServiceImpl(ServerEnv* env) : env_(env) {}
  grpc::Status GenerateProgram(grpc::ServerContext* context, const v1::GenerateProgramRequest* request,
                               grpc::ServerWriter<v1::GenerateProgramResponse>* writer) override {
    const std::string id = OneLine(request->request_id().substr(0, limits::kMaxRequestIdBytes));
    return Run(env_, context, id.empty() ? "GenerateProgram" : "GenerateProgram [" + id + "]",
               [&](const Call& call) { return HandleGenerateProgram(call, *request, SinkOf(writer)); });
  }
  grpc::Status VerifyProgram(grpc::ServerContext* context, const v1::VerifyProgramRequest* request,
                             grpc::ServerWriter<v1::VerifyProgramResponse>* writer) override {
    return Run(env_, context, "VerifyProgram",
               [&](const Call& call) { return HandleVerifyProgram(call, *request, SinkOf(writer)); });
  }

 private:
  ServerEnv* env_;
};

}  // namespace

std::vector<NamedService> MakeServices(ServerEnv* env) {
  std::vector<NamedService> services;
  services.push_back({v1::ModelService::service_full_name(), std::make_unique<ModelServiceImpl>(env)});
  services.push_back({v1::AnalysisService::service_full_name(), std::make_unique<AnalysisServiceImpl>(env)});
  services.push_back({v1::ToolpathService::service_full_name(), std::make_unique<ToolpathServiceImpl>(env)});
  return services;
}

}  // namespace patchmill
