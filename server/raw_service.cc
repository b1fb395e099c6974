#include "server/raw_service.h"

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <new>
#include <optional>
#include <system_error>
#include <thread>
#include <utility>

#include <fmt/format.h>
#include <grpcpp/grpcpp.h>
#include <grpcpp/impl/codegen/proto_utils.h>
#include <grpcpp/impl/codegen/server_callback_handlers.h>
#include <grpcpp/impl/rpc_service_method.h>
#include <grpcpp/support/server_callback.h>

#include "core/base/status.h"
#include "server/errors.h"
#include "server/limits.h"

namespace patchmill {
namespace {

// The same moment by the steady clock. No value: there is no deadline.
std::optional<std::chrono::steady_clock::time_point> Steady(std::chrono::system_clock::time_point deadline) {
  if (deadline == std::chrono::system_clock::time_point::max()) return std::nullopt;
  return std::chrono::steady_clock::now() + (deadline - std::chrono::system_clock::now());
}

struct Shared {
  InFlight& in_flight;
  CallRules rules;
};

absl::Status Guarded(const RawMethod& method, RawCall& call) {
  try {
    return method.run(call);
  } catch (const std::bad_alloc&) {
    return absl::ResourceExhaustedError("the request needs more memory than there is");
  } catch (const std::exception& e) {
    return absl::InternalError(fmt::format("unexpected: {}", e.what()));
  }
}

// The common name in the certificate of the other side.
std::string CertificateName(const grpc::CallbackServerContext& context) {
  const auto authentic = context.auth_context();
  if (!authentic || !authentic->IsPeerAuthenticated()) return {};
  const auto names = authentic->FindPropertyValues("x509_common_name");
  return names.empty() ? std::string() : std::string(names.front().data(), names.front().size());
}

absl::StatusOr<std::string> CallerOf(const Shared& shared, const grpc::CallbackServerContext& context) {
  return shared.rules.admit ? shared.rules.admit(PresentedBy(context)) : CertificateName(context);
}

std::int64_t NextNumber() {
  static std::atomic<std::int64_t> number{0};
  return ++number;
}

std::string RequestIdOf(const grpc::CallbackServerContext& context) {
  const auto at = context.client_metadata().find("x-request-id");
  if (at == context.client_metadata().end()) return {};
  return std::string(at->second.data(), std::min(at->second.size(), limits::kMaxRequestIdBytes));
}

// A call from its start to its end. gRPC calls the On... functions from its own threads.
class Reactor final : public grpc::ServerBidiReactor<grpc::ByteBuffer, grpc::ByteBuffer>, public RawCall {
 public:
  // The call lives until gRPC is done with it and no thread that may refuse it still uses it.
  static Reactor* Start(const RawMethod& method, Shared& shared, grpc::CallbackServerContext* context) {
    const auto reactor = std::make_shared<Reactor>(method, shared, context);
    const std::lock_guard<std::mutex> lock(reactor->mutex_);
    reactor->self_ = reactor;
    if (shared.rules.begins) shared.rules.begins(reactor->Record());
    if (!reactor->admitted_.ok()) {
      reactor->End(Phase::kReceiving, reactor->admitted_);
      return reactor.get();
    }
    reactor->StartRead(&reactor->request_);  // begins once gRPC has the reactor
    const std::weak_ptr<Reactor> weak = reactor;
    reactor->expected_ = shared.in_flight.Expect(reactor->peer_, [weak](const absl::Status& status) {
      if (const auto call = weak.lock()) call->End(Phase::kReceiving, status);
    });
    return reactor.get();
  }

  Reactor(const RawMethod& method, Shared& shared, grpc::CallbackServerContext* context)
      : method_(method),
        shared_(shared),
        context_(context),
        begin_(std::chrono::steady_clock::now()),
        deadline_(Steady(context->deadline())),
        peer_(context->peer()),
        number_(NextNumber()),
        request_id_(RequestIdOf(*context)) {
    absl::StatusOr<std::string> caller = CallerOf(shared, *context);
    admitted_ = caller.status();
    if (caller.ok()) caller_ = *std::move(caller);
  }

  grpc::ByteBuffer& request() override { return request_; }
  void DropRequest() override {
    request_.Clear();
    held_ = {};
  }
  const std::string& caller() const override { return caller_; }
  std::optional<std::chrono::steady_clock::time_point> deadline() const override { return deadline_; }
  bool Cancelled() const override { return cancelled_.load(); }
  void SetRequestId(std::string id) override { request_id_ = std::move(id); }

  bool ReadNext() override {
    if (Cancelled()) return false;
    request_.Clear();
    held_ = {};
    std::unique_lock<std::mutex> lock(mutex_);
    reading_ = true;
    const std::weak_ptr<Reactor> weak = self_;
    expected_ = shared_.in_flight.Expect(peer_, [weak](const absl::Status& status) {
      if (const auto call = weak.lock()) call->RefuseRest(status);
    });
    lock.unlock();
    StartRead(&request_);
    lock.lock();
    read_.wait(lock, [this] { return !reading_; });
    return read_ok_;
  }

  bool Write(const google::protobuf::Message& response) override {
    if (Cancelled()) return false;
    grpc::ByteBuffer bytes;
    bool own = false;
    return grpc::SerializationTraits<google::protobuf::Message>::Serialize(response, &bytes, &own).ok() &&
           Write(bytes);
  }

  bool Write(const grpc::ByteBuffer& response) override {
    if (Cancelled()) return false;
    response_ = response;
    std::unique_lock<std::mutex> lock(mutex_);
    writing_ = true;
    lock.unlock();
    StartWrite(&response_);
    lock.lock();
    const auto written = [this] { return !writing_; };
    if (!written_.wait_for(lock, std::chrono::duration<double>(shared_.rules.write_seconds), written)) {
      late_ = true;
      context_->TryCancel();  // gRPC gives the message up, and tells that it is not written
      written_.wait(lock, written);
    }
    response_.Clear();
    return write_ok_;
  }

  void OnReadDone(bool ok) override {
    const std::lock_guard<std::mutex> lock(mutex_);
    const std::size_t bytes = ok ? request_.Length() : 0;
    shared_.in_flight.Arrived(expected_, bytes);
    if (reading_) {
      RestRead(ok, bytes);
      return;
    }
    if (!ok) {
      End(Phase::kReceiving, RequestUnreadableError("the call ended before its request had come"));
      return;
    }
    absl::StatusOr<InFlight::Hold> held = CheckedHold(bytes);
    if (!held.ok()) {
      End(Phase::kReceiving, held.status());
      return;
    }
    Phase receiving = Phase::kReceiving;
    if (!phase_.compare_exchange_strong(receiving, Phase::kRunning)) return;  // refused meanwhile
    held_ = *std::move(held);
    try {
      thread_ = std::thread([this] { Run(); });
    } catch (const std::system_error&) {
      DropRequest();
      End(Phase::kRunning,
          absl::ResourceExhaustedError("the server has no thread for the call; try again later"));
    }
  }

  void OnWriteDone(bool ok) override {
    const std::lock_guard<std::mutex> lock(mutex_);
    writing_ = false;
    write_ok_ = ok;
    written_.notify_all();
  }

  void OnCancel() override { cancelled_.store(true); }

  void OnDone() override {
    std::shared_ptr<Reactor> self;
    std::thread thread;
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      self = std::move(self_);
      thread = std::move(thread_);
    }
    if (thread.joinable()) thread.join();  // it has no work left
  }

 private:
  enum class Phase { kReceiving, kRunning, kEnded };

  void Run() {
    const absl::Status status = Guarded(method_, *this);
    DropRequest();
    const absl::Status refused = Refused();
    End(Phase::kRunning, late_ ? LateError() : refused.ok() ? status : refused);
  }

  absl::Status Refused() {
    const std::lock_guard<std::mutex> lock(mutex_);
    return refused_;
  }

  // A further message of the request has come, or none will.
  void RestRead(bool ok, std::size_t bytes) {
    read_ok_ = ok;
    if (ok) {
      absl::StatusOr<InFlight::Hold> held = CheckedHold(bytes);
      if (held.ok()) {
        held_ = *std::move(held);
      } else {
        refused_ = held.status();
        read_ok_ = false;
      }
    }
    reading_ = false;
    read_.notify_all();
  }

  // A further message on its way is refused. gRPC then ends the read.
  void RefuseRest(const absl::Status& status) {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (!reading_) return;
    refused_ = status;
    context_->TryCancel();
  }

  absl::StatusOr<InFlight::Hold> CheckedHold(std::size_t bytes) {
    if (bytes > limits::kMaxMessageBytes) {
      return LimitError("message_bytes", static_cast<double>(limits::kMaxMessageBytes),
                        static_cast<double>(bytes));
    }
    return shared_.in_flight.Take(bytes);
  }

  absl::Status LateError() const {
    return absl::DeadlineExceededError(
        fmt::format("the client has not taken an answer within {} s", shared_.rules.write_seconds));
  }

  CallRecord Record() const {
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin_;
    return {
        number_, method_.path.substr(method_.path.rfind('/') + 1), caller_, peer_, request_id_, took.count(),
        {}};
  }

  // A client cancels its call when its deadline passes: then the deadline is the reason.
  absl::Status TrueReason(const absl::Status& status) const {
    constexpr std::chrono::milliseconds kWay{100};  // by which the client's clock may be ahead
    if (!absl::IsCancelled(status) || !deadline_) return status;
    if (*deadline_ - std::chrono::steady_clock::now() > kWay) return status;
    return absl::DeadlineExceededError("the deadline of the caller has passed");
  }

  // Ends the call with `status` if it is in the phase `in`. No member may be used afterwards.
  void End(Phase in, const absl::Status& status) {
    if (!phase_.compare_exchange_strong(in, Phase::kEnded)) return;
    if (shared_.rules.ends) {
      CallRecord record = Record();
      record.status = TrueReason(status);
      shared_.rules.ends(record);
    }
    if (const auto delay = RetryDelay(status))
      context_->AddTrailingMetadata("grpc-retry-pushback-ms", std::to_string(delay->count()));
    Finish(ToGrpcStatus(status));
  }

  const RawMethod& method_;
  Shared& shared_;
  grpc::CallbackServerContext* const context_;
  const std::chrono::steady_clock::time_point begin_;
  const std::optional<std::chrono::steady_clock::time_point> deadline_;
  const std::string peer_;
  const std::int64_t number_;
  std::string caller_, request_id_;
  absl::Status admitted_;  // whether the call may be made
  std::shared_ptr<Reactor> self_;
  InFlight::Id expected_ = 0;
  grpc::ByteBuffer request_, response_;
  InFlight::Hold held_;
  std::atomic<Phase> phase_{Phase::kReceiving};
  std::atomic<bool> cancelled_{false};
  std::thread thread_;
  std::mutex mutex_;  // orders the writes of gRPC's threads before the reads of the call's own
  std::condition_variable written_;
  std::condition_variable read_;
  bool writing_ = false, write_ok_ = false;
  bool reading_ = false, read_ok_ = false;  // of a further message
  absl::Status refused_;                    // why further messages were refused
  bool late_ = false;                       // of the call's own thread only
};

// For gRPC every method has a stream in both directions, so that a call starts before its request is read. A
// client of a unary or server-streaming method sees no difference.
class RawService final : public grpc::Service {
 public:
  RawService(std::vector<RawMethod> methods, InFlight& in_flight, CallRules rules)
      : methods_(std::move(methods)), shared_{in_flight, std::move(rules)} {
    for (std::size_t k = 0; k < methods_.size(); ++k) {
      const RawMethod& method = methods_[k];
      AddMethod(new grpc::internal::RpcServiceMethod(method.path.c_str(),
                                                     grpc::internal::RpcMethod::BIDI_STREAMING, nullptr));
      MarkMethodRawCallback(static_cast<int>(k),
                            new grpc::internal::CallbackBidiHandler<grpc::ByteBuffer, grpc::ByteBuffer>(
                                [&method, this](grpc::CallbackServerContext* c) {
                                  return Reactor::Start(method, shared_, c);
                                }));
    }
  }

 private:
  const std::vector<RawMethod> methods_;
  Shared shared_;
};

}  // namespace

Presented PresentedBy(const grpc::CallbackServerContext& context) {
  Presented presented;
  presented.certificate = CertificateName(context);
  const auto [first, last] = context.client_metadata().equal_range("authorization");
  if (first != last) presented.authorization.emplace(first->second.data(), first->second.size());
  return presented;
}

std::unique_ptr<grpc::Service> MakeRawService(std::vector<RawMethod> methods, InFlight& in_flight,
                                              CallRules rules) {
  return std::make_unique<RawService>(std::move(methods), in_flight, std::move(rules));
}

}  // namespace patchmill
