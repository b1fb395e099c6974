#include "server/services.h"

#include <atomic>
#include <chrono>
#include <utility>
#include <variant>

#include <grpcpp/grpcpp.h>
#include <grpcpp/impl/codegen/proto_utils.h>

#include "core/base/digest.h"
#include "core/base/status.h"
#include "patchmill/v1/analysis_service.grpc.pb.h"
#include "patchmill/v1/model_service.grpc.pb.h"
#include "patchmill/v1/server_service.grpc.pb.h"
#include "patchmill/v1/status.pb.h"
#include "patchmill/v1/toolpath_service.grpc.pb.h"
#include "server/answer.h"
#include "server/errors.h"
#include "server/handlers/get_capabilities.h"
#include "server/handlers/handlers.h"
#include "server/importer.h"
#include "server/limits.h"
#include "server/operate/log.h"
#include "server/parse_request.h"
#include "server/raw_service.h"
#include "server/running_jobs.h"

namespace patchmill {
namespace {

Call MakeCall(ServerEnv* env, const RawCall& raw) {
  Call call;
  call.env = env;
  call.caller = raw.caller();
  call.cancelled = [&raw] { return raw.Cancelled(); };
  call.deadline = raw.deadline();
  return call;
}

// The reason that a program switches on; empty for OK.
v1::ErrorInfo InfoOf(const absl::Status& status) {
  v1::ErrorInfo info;
  v1::Status wire;
  if (!status.ok() && wire.ParseFromString(ToGrpcStatus(status).error_details()) && wire.details_size() > 0)
    wire.details(0).UnpackTo(&info);
  return info;
}

LogFields FieldsOf(const CallRecord& call) {
  return {{"call", call.number},
          {"method", call.method},
          {"request_id", call.request_id},
          {"caller", call.caller},
          {"peer", call.peer}};
}

void LogBegin(const CallRecord& call) { Log(LogLevel::kInfo, "call begins", FieldsOf(call)); }

// Whether the message of a status has words of our own only. Others may have words of a model.
bool IsOurs(const absl::Status& status) {
  return absl::IsInternal(status) || absl::IsCancelled(status) || absl::IsDeadlineExceeded(status) ||
         absl::IsUnavailable(status);
}

void LogEnd(const CallRecord& call, const v1::ErrorInfo& info) {
  LogFields fields = FieldsOf(call);
  fields.emplace_back("code", absl::StatusCodeToString(call.status.code()));
  fields.emplace_back("reason", info.reason());
  if (!info.limit().empty()) {
    fields.emplace_back("limit", info.limit());
    fields.emplace_back("limit_value", info.limit_value());
    fields.emplace_back("actual_value", info.actual_value());
  }
  if (info.violation_count() > 0) fields.emplace_back("wrong_fields", std::int64_t{info.violation_count()});
  if (IsOurs(call.status)) fields.emplace_back("what", std::string(call.status.message()));
  fields.emplace_back("seconds", call.seconds);
  const bool notable = absl::IsUnauthenticated(call.status) || absl::IsResourceExhausted(call.status);
  const LogLevel level = absl::IsInternal(call.status) ? LogLevel::kError
                         : notable                     ? LogLevel::kWarning
                                                       : LogLevel::kInfo;
  Log(level, "call ends", fields);
}

void NameRequest(const google::protobuf::Message&, RawCall&) {}
void NameRequest(const v1::GenerateProgramRequest& request, RawCall& call) {
  if (!request.request_id().empty())
    call.SetRequestId(request.request_id().substr(0, limits::kMaxRequestIdBytes));
}

// Runs a call: counts and parses the request, then calls the handler. The request is freed before the answer
// is sent.
template <class Request, class Body>
absl::Status Run(ServerEnv* env, RawCall& raw, const Body& body) {
  Request request;
  PM_ASSIGN_OR_RETURN(const InFlight::Hold hold, ParseRequest(raw, env->in_flight, request));
  NameRequest(request, raw);
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

// The answer of a call as bytes. No call begins while the server drains.
template <class Request, class Response>
absl::StatusOr<Serialized> AnswerOf(ServerEnv* env, RawCall& raw, UnaryHandler<Request, Response> handler) {
  PM_RETURN_IF_ERROR(env->quick.CheckOpen());
  Response response;
  PM_RETURN_IF_ERROR(Run<Request>(
      env, raw, [&](const Call& call, const Request& request) { return handler(call, request, &response); }));
  return Serialize(env->in_flight, response);
}

absl::Status Gone() { return absl::CancelledError("the client is gone"); }

template <class Request, class Response>
RawMethod Unary(ServerEnv* env, std::string path, UnaryHandler<Request, Response> handler) {
  return {std::move(path), [env, handler](RawCall& raw) -> absl::Status {
            PM_ASSIGN_OR_RETURN(const Serialized answer, AnswerOf(env, raw, handler));
            return raw.Write(answer.bytes) ? absl::OkStatus() : Gone();
          }};
}

template <class Request, class Response>
using StreamHandler = absl::Status (*)(const Call&, const Request&, const Sink<Response>&);

// Sends an answer as it grows, until its end, or until this call ends.
absl::Status Follow(RawCall& raw, Answer::Reader& reader) {
  const auto deadline = raw.deadline();
  while (true) {
    auto event = reader.Next(true, std::chrono::milliseconds(limits::kCancelPollMs));
    if (auto* message = std::get_if<Answer::Reader::Message>(&event)) {
      if (!raw.Write(message->bytes)) return Gone();
    } else if (auto* progress = std::get_if<Answer::Reader::Progress>(&event)) {
      if (!raw.Write(progress->bytes)) return Gone();
    } else if (auto* end = std::get_if<absl::Status>(&event)) {
      return *end;
    }
    if (raw.Cancelled()) return absl::CancelledError("cancelled by the caller");
    if (deadline && std::chrono::steady_clock::now() >= *deadline)
      return absl::DeadlineExceededError("the deadline has passed");
  }
}

grpc::ByteBuffer BytesOf(const google::protobuf::Message& message) {
  grpc::ByteBuffer bytes;
  bool own = false;
  PM_CHECK(grpc::SerializationTraits<google::protobuf::Message>::Serialize(message, &bytes, &own).ok());
  return bytes;
}

// What an answer does not depend on. A wrong value makes another answer: it stays in the request.
struct Apart {
  std::string request_id;
  int max_threads = 0;
};
Apart TakeApart(v1::GenerateProgramRequest& request) {
  Apart apart;
  if (CheckRequestId(request.request_id()).ok())
    apart.request_id = std::exchange(*request.mutable_request_id(), {});
  if (CheckThreads(request.max_threads(), "max_threads").ok()) {
    apart.max_threads = request.max_threads();
    request.clear_max_threads();
  }
  return apart;
}
void PutBack(Apart apart, v1::GenerateProgramRequest& request) {
  if (!apart.request_id.empty()) request.set_request_id(std::move(apart.request_id));
  if (apart.max_threads != 0) request.set_max_threads(apart.max_threads);
}
Apart TakeApart(v1::VerifyProgramRequest& request) {
  Apart apart;
  if (CheckThreads(request.max_threads(), "max_threads").ok()) {
    apart.max_threads = request.max_threads();
    request.clear_max_threads();
  }
  return apart;
}
void PutBack(const Apart& apart, v1::VerifyProgramRequest& request) {
  if (apart.max_threads != 0) request.set_max_threads(apart.max_threads);
}

const std::string& ModelIn(const v1::GenerateProgramRequest& request) {
  return request.job().source().model_sha256();
}
const std::string& ModelIn(const v1::VerifyProgramRequest& request) {
  return request.source().model_sha256();
}

// What an answer depends on, but for its caller: the method, the request without its Apart, the findings of
// the model that it names, and the programs that make the answer. The bytes of the request are counted as in
// flight while they are hashed.
template <class Request>
absl::StatusOr<std::string> AnswerDigest(ServerEnv* env, const std::string& path, const std::string& caller,
                                         Request& request) {
  Apart apart = TakeApart(request);
  PM_ASSIGN_OR_RETURN(const InFlight::Hold held, env->in_flight.Take(request.ByteSizeLong()));
  Canonical digest;
  digest.Add("patchmill answer 1").Add(path).Add(ServerVersion()).Add(ImporterStamp());
  digest.Add(Sha256(request.SerializeAsString()));
  digest.Add(FindingsOfStored(env->store, {Stored::kModel, caller, ModelIn(request)}));
  PutBack(std::move(apart), request);
  return digest.Digest();
}

bool SendKept(RawCall& raw, const Messages& messages) {
  for (const grpc::ByteBuffer& message : messages) {
    if (!raw.Write(message)) return false;
  }
  return true;
}

// A request that its job owns.
template <class Request>
struct Owned {
  InFlight::Hold held;
  Request request;
};

// Whether no progress may follow this message in the order of the stream.
bool EndsProgress(const v1::GenerateProgramResponse& response) {
  return response.has_artifact() || response.has_program() || response.has_report();
}
bool EndsProgress(const v1::VerifyProgramResponse& response) { return !response.has_progress(); }

// The job of a request. It ends when nobody reads its answer any more. The deadlines of its readers are
// theirs.
template <class Request, class Response>
RunningJobs::Job JobOf(ServerEnv* env, StoreKey key, std::shared_ptr<Owned<Request>> owned,
                       StreamHandler<Request, Response> handler) {
  RunningJobs::Job job;
  job.from = ModelIn(owned->request);
  job.key = std::move(key);
  const std::string caller = job.key.caller;
  job.work = [env, owned = std::move(owned), handler, caller](Answer& answer,
                                                              const std::function<bool()>& gone) {
    Call call;
    call.env = env;
    call.caller = caller;
    call.cancelled = gone;
    const Sink<Response> sink = [&](const Response& response) {
      if (EndsProgress(response)) answer.EndProgress();
      if (!response.has_progress()) return answer.Write(BytesOf(response));
      answer.SetProgress(BytesOf(response));
      return !gone();
    };
    return handler(call, owned->request, sink);
  };
  return job;
}

template <class Request, class Response>
RawMethod Stream(ServerEnv* env, std::string path, StreamHandler<Request, Response> handler) {
  const std::string method = path;
  return {std::move(path), [env, handler, method](RawCall& raw) -> absl::Status {
            PM_RETURN_IF_ERROR(env->jobs.CheckOpen());
            auto owned = std::make_shared<Owned<Request>>();
            PM_ASSIGN_OR_RETURN(owned->held, ParseRequest(raw, env->in_flight, owned->request));
            NameRequest(owned->request, raw);
            StoreKey key{Stored::kAnswer, raw.caller(), {}};
            PM_ASSIGN_OR_RETURN(key.digest, AnswerDigest(env, method, key.caller, owned->request));
            if (const auto kept = env->answers.Find(key, ModelIn(owned->request))) {
              owned.reset();
              return SendKept(raw, *kept) ? absl::OkStatus() : Gone();
            }
            PM_ASSIGN_OR_RETURN(RunningJobs::Reading reading,
                                env->running.Start(JobOf(env, std::move(key), std::move(owned), handler)));
            return Follow(raw, *reading.reader);
          }};
}

// A request of several messages.
template <class Request, class Response>
using UploadHandler = absl::Status (*)(const Call&, const NextMessage<Request>&, Response*);

template <class Request, class Response>
RawMethod Upload(ServerEnv* env, std::string path, UploadHandler<Request, Response> handler) {
  return {std::move(path), [env, handler](RawCall& raw) -> absl::Status {
            PM_RETURN_IF_ERROR(env->quick.CheckOpen());
            InFlight::Hold held;
            bool first = true;
            const NextMessage<Request> next = [&](Request& message) -> absl::StatusOr<bool> {
              held = {};
              if (!std::exchange(first, false) && !raw.ReadNext()) return false;
              message.Clear();
              PM_ASSIGN_OR_RETURN(held, ParseRequest(raw, env->in_flight, message));
              return true;
            };
            Response response;
            PM_RETURN_IF_ERROR(handler(MakeCall(env, raw), next, &response));
            PM_ASSIGN_OR_RETURN(const Serialized answer, Serialize(env->in_flight, response));
            return raw.Write(answer.bytes) ? absl::OkStatus() : Gone();
          }};
}

// The same method, whose running calls are counted.
RawMethod Counted(ServerEnv* env, RawMethod method) {
  return {method.path, [env, run = std::move(method.run)](RawCall& raw) {
            struct Count {
              explicit Count(std::atomic<int>& calls) : calls_(calls) { calls_.fetch_add(1); }
              ~Count() { calls_.fetch_sub(1); }
              std::atomic<int>& calls_;
            };
            const Count count(env->calls);
            return run(raw);
          }};
}

// Collects the methods of one service.
class ServiceBuilder {
 public:
  ServiceBuilder(ServerEnv* env, const char* name) : env_(env), name_(name) {}

  template <class Request, class Response>
  ServiceBuilder& Add(const char* method, UnaryHandler<Request, Response> handler) {
    methods_.push_back(Counted(env_, Unary(env_, Path(method), handler)));
    return *this;
  }
  template <class Request, class Response>
  ServiceBuilder& Add(const char* method, StreamHandler<Request, Response> handler) {
    methods_.push_back(Counted(env_, Stream(env_, Path(method), handler)));
    return *this;
  }
  template <class Request, class Response>
  ServiceBuilder& Add(const char* method, UploadHandler<Request, Response> handler) {
    methods_.push_back(Counted(env_, Upload(env_, Path(method), handler)));
    return *this;
  }
  NamedService Build() {
    CallRules rules;
    const bool logs = env_->options.log_requests;
    if (logs) rules.begins = LogBegin;
    rules.ends = [env = env_, logs](const CallRecord& call) {
      const v1::ErrorInfo info = InfoOf(call.status);
      env->metrics.CallEnded(call.method, call.status, info.reason(), call.seconds);
      if (logs) LogEnd(call, info);
    };
    rules.admit = [env = env_](const Presented& presented) { return env->callers.Admit(presented); };
    rules.write_seconds = env_->options.max_write_seconds;
    return {name_, MakeRawService(std::move(methods_), env_->in_flight, std::move(rules))};
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
                         .Add("UploadModel", HandleUploadModel)
                         .Add("ForgetModel", HandleForgetModel)
                         .Build());
  services.push_back(ServiceBuilder(env, v1::AnalysisService::service_full_name())
                         .Add("SplitRegions", HandleSplitRegions)
                         .Add("TabulateReach", HandleTabulateReach)
                         .Add("TraceLines", HandleTraceLines)
                         .Add("EvaluateSurface", HandleEvaluateSurface)
                         .Add("Preview", HandlePreview)
                         .Build());
  services.push_back(ServiceBuilder(env, v1::ToolpathService::service_full_name())
                         .Add("GenerateProgram", HandleGenerateProgram)
                         .Add("VerifyProgram", HandleVerifyProgram)
                         .Add("ListPosts", HandleListPosts)
                         .Build());
  services.push_back(ServiceBuilder(env, v1::ServerService::service_full_name())
                         .Add("GetCapabilities", HandleGetCapabilities)
                         .Build());
  return services;
}

}  // namespace patchmill
