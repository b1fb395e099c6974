#include "server/services.h"

#include <chrono>
#include <utility>

#include <grpcpp/grpcpp.h>
#include <grpcpp/impl/codegen/proto_utils.h>
#include <spdlog/spdlog.h>

#include "core/base/status.h"
#include "patchmill/v1/analysis_service.grpc.pb.h"
#include "patchmill/v1/model_service.grpc.pb.h"
#include "patchmill/v1/toolpath_service.grpc.pb.h"
#include "server/handlers/handlers.h"
#include "server/limits.h"
#include "server/parse_request.h"
#include "server/raw_service.h"

namespace patchmill {
namespace {

Call MakeCall(ServerEnv* env, const RawCall& raw) {
  Call call;
  call.env = env;
  call.cancelled = [&raw] { return raw.Cancelled(); };
  const auto deadline = raw.deadline();
  if (deadline != std::chrono::system_clock::time_point::max()) {
    call.deadline = RunContext::Clock::now() + (deadline - std::chrono::system_clock::now());
  }
  return call;
}

// Makes one line for the log of a text that may come from a client.
std::string OneLine(std::string text) {
  for (char& c : text) {
    if (c < ' ' || c > '~') c = ' ';
  }
  return text;
}

void Log(const CallRecord& call) {
  spdlog::info("{} {} {:.3f} s {} {}", call.label, absl::StatusCodeToString(call.status.code()), call.seconds,
               call.peer, OneLine(std::string(call.status.message())));
}

void LabelCall(const google::protobuf::Message&, RawCall&) {}
void LabelCall(const v1::GenerateProgramRequest& request, RawCall& call) {
  const std::string id = OneLine(request.request_id().substr(0, limits::kMaxRequestIdBytes));
  if (!id.empty()) call.SetLabel("GenerateProgram [" + id + "]");
}

// Runs a call: counts and parses the request, then calls the handler. The request is freed before the answer
// is sent.
template <class Request, class Body>
absl::Status Run(ServerEnv* env, RawCall& raw, const Body& body) {
  Request request;
  PM_ASSIGN_OR_RETURN(const InFlight::Hold hold, ParseRequest(raw, env->in_flight, request));
  LabelCall(request, raw);
  return body(MakeCall(env, raw), request);
}

template <class Request, class Response>
using UnaryHandler = absl::Status (*)(const Call&, const Request&, Response*);

// An answer in bytes, and what it holds until it is written: a client may take its time to read.
struct Serialized {
  InFlight::Hold held;
  grpc::ByteBuffer bytes;
};

absl::StatusOr<Serialized> Serialize(InFlight& in_flight, const google::protobuf::Message& response) {
  const std::size_t size = response.ByteSizeLong();
  if (size > limits::kMaxMessageBytes) {
    return LimitError("response_bytes", static_cast<double>(limits::kMaxMessageBytes),
                      static_cast<double>(size));
  }
  Serialized answer;
  PM_ASSIGN_OR_RETURN(answer.held, in_flight.Take(size, "response_bytes_in_flight"));
  bool own = false;
  if (!grpc::SerializationTraits<google::protobuf::Message>::Serialize(response, &answer.bytes, &own).ok()) {
    return absl::InternalError("the answer cannot be serialized");
  }
  return answer;
}

// Admission, until the answer is bytes.
template <class Request, class Response>
absl::StatusOr<Serialized> Admitted(ServerEnv* env, RawCall& raw, UnaryHandler<Request, Response> handler) {
  PM_ASSIGN_OR_RETURN(const Admission::Ticket ticket, env->admission.Enter());
  Response response;
  PM_RETURN_IF_ERROR(Run<Request>(
      env, raw, [&](const Call& call, const Request& request) { return handler(call, request, &response); }));
  return Serialize(env->in_flight, response);
}

template <class Request, class Response>
RawMethod Unary(ServerEnv* env, std::string path, UnaryHandler<Request, Response> handler) {
  return {std::move(path), [env, handler](RawCall& raw) -> absl::Status {
            PM_ASSIGN_OR_RETURN(const Serialized answer, Admitted(env, raw, handler));
            return raw.Write(answer.bytes) ? absl::OkStatus() : absl::CancelledError("the client is gone");
          }};
}

template <class Request, class Response>
using StreamHandler = absl::Status (*)(const Call&, const Request&, const Sink<Response>&);

template <class Request, class Response>
RawMethod Stream(ServerEnv* env, std::string path, StreamHandler<Request, Response> handler) {
  return {std::move(path), [env, handler](RawCall& raw) -> absl::Status {
            PM_ASSIGN_OR_RETURN(const Admission::Ticket ticket, env->admission.Enter());
            const Sink<Response> sink = [&raw](const Response& response) { return raw.Write(response); };
            return Run<Request>(env, raw, [&](const Call& call, const Request& request) {
              return handler(call, request, sink);
            });
          }};
}

// Collects the methods of one service.
class ServiceBuilder {
 public:
  ServiceBuilder(ServerEnv* env, const char* name) : env_(env), name_(name) {}

  template <class Request, class Response>
  ServiceBuilder& Add(const char* method, UnaryHandler<Request, Response> handler) {
    methods_.push_back(Unary(env_, Path(method), handler));
    return *this;
  }
  template <class Request, class Response>
  ServiceBuilder& Add(const char* method, StreamHandler<Request, Response> handler) {
    methods_.push_back(Stream(env_, Path(method), handler));
    return *this;
  }
  NamedService Build() {
    return {name_, MakeRawService(std::move(methods_), env_->in_flight,
                                  env_->options.log_requests ? CallLog(Log) : CallLog(),
                                  env_->options.max_write_seconds)};
  }

 private:
  std::string Path(const char* method) const { return std::string("/") + name_ + "/" + method; }

  ServerEnv* env_;
  const char* name_;
  std::vector<RawMethod> methods_;
};

}  // namespace

std::vector<NamedService> MakeServices(ServerEnv* env) {
  std::vector<NamedService> services;
  services.push_back(ServiceBuilder(env, v1::ModelService::service_full_name())
                         .Add("CheckModel", HandleCheckModel)
                         .Add("ConvertModel", HandleConvertModel)
                         .Add("BuildModel", HandleBuildModel)
                         .Add("EditModel", HandleEditModel)
                         .Add("FairNet", HandleFairNet)
                         .Add("FairCurve", HandleFairCurve)
                         .Build());
  services.push_back(ServiceBuilder(env, v1::AnalysisService::service_full_name())
                         .Add("SplitRegions", HandleSplitRegions)
                         .Add("TabulateReach", HandleTabulateReach)
                         .Add("TraceLines", HandleTraceLines)
                         .Add("EvaluateSurface", HandleEvaluateSurface)
                         .Build());
  services.push_back(ServiceBuilder(env, v1::ToolpathService::service_full_name())
                         .Add("GenerateProgram", HandleGenerateProgram)
                         .Add("VerifyProgram", HandleVerifyProgram)
                         .Add("ListPosts", HandleListPosts)
                         .Build());
  return services;
}

}  // namespace patchmill
