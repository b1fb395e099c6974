#include "server/small_service.h"

#include <chrono>
#include <map>
#include <mutex>
#include <optional>
#include <utility>

#include <grpcpp/alarm.h>
#include <grpcpp/grpcpp.h>
#include <grpcpp/impl/codegen/server_callback_handlers.h>
#include <grpcpp/impl/rpc_service_method.h>
#include <grpcpp/support/byte_buffer.h>
#include <grpcpp/support/server_callback.h>

#include "core/base/status.h"
#include "server/errors.h"
#include "server/limits.h"

namespace patchmill {
namespace {

using Then = SmallMethod::Then;

absl::StatusOr<std::string> SmallText(const grpc::ByteBuffer& bytes) {
  if (bytes.Length() > limits::kMaxSmallMessageBytes) {
    return LimitError("message_bytes", static_cast<double>(limits::kMaxSmallMessageBytes),
                      static_cast<double>(bytes.Length()));
  }
  std::vector<grpc::Slice> slices;
  if (!bytes.Dump(&slices).ok()) return RequestUnreadableError("the request's bytes cannot be read");
  std::string text;
  for (const grpc::Slice& slice : slices)
    text.append(reinterpret_cast<const char*>(slice.begin()), slice.size());
  return text;
}

class SmallCall;

// Those calls that wait for a change.
class Watchers {
 public:
  void Add(const std::shared_ptr<SmallCall>& call) {
    const std::lock_guard<std::mutex> lock(mutex_);
    calls_.emplace(call.get(), call);
  }
  void Remove(SmallCall* call) {
    const std::lock_guard<std::mutex> lock(mutex_);
    calls_.erase(call);
  }
  std::vector<std::shared_ptr<SmallCall>> All() {
    const std::lock_guard<std::mutex> lock(mutex_);
    std::vector<std::shared_ptr<SmallCall>> all;
    for (const auto& [key, weak] : calls_) {
      if (auto call = weak.lock()) all.push_back(std::move(call));
    }
    return all;
  }

 private:
  std::mutex mutex_;
  std::map<SmallCall*, std::weak_ptr<SmallCall>> calls_;
};

struct SmallShared {
  InFlight& in_flight;
  CallRules rules;
  Watchers watchers;
};

// A call from its start to its end. gRPC calls the On... functions, one read and one write at a time.
class SmallCall final : public grpc::ServerBidiReactor<grpc::ByteBuffer, grpc::ByteBuffer>,
                        public std::enable_shared_from_this<SmallCall> {
 public:
  // Lives until gRPC is done with it, and nobody who may end it is at it.
  static SmallCall* Start(const SmallMethod& method, SmallShared& shared,
                          grpc::CallbackServerContext* context) {
    const auto call = std::make_shared<SmallCall>(method, shared, context);
    const std::lock_guard<std::mutex> lock(call->mutex_);
    call->self_ = call;
    if (shared.rules.admit) {
      if (const auto caller = shared.rules.admit(PresentedBy(*context)); !caller.ok()) {
        call->End(caller.status());
        return call.get();
      }
    }
    if (method.then == Then::kWatch) shared.watchers.Add(call);
    call->Read();
    return call.get();
  }

  SmallCall(const SmallMethod& method, SmallShared& shared, grpc::CallbackServerContext* context)
      : method_(method), shared_(shared), context_(context), peer_(context->peer()) {}

  void OnReadDone(bool ok) override {
    const std::lock_guard<std::mutex> lock(mutex_);
    shared_.in_flight.Arrived(expected_, ok ? in_.Length() : 0);
    if (!ok) {
      End(method_.then == Then::kRead ? absl::OkStatus()
                                      : RequestUnreadableError("the call ended before its request had come"));
      return;
    }
    absl::StatusOr<std::string> request = SmallText(in_);
    in_.Clear();
    if (!request.ok()) {
      End(request.status());
      return;
    }
    request_ = *std::move(request);
    Answer();
  }

  void OnWriteDone(bool ok) override {
    late_.reset();
    const std::lock_guard<std::mutex> lock(mutex_);
    writing_ = false;
    out_.Clear();
    held_ = {};
    if (!ok) {
      End(absl::CancelledError("the client is gone"));
    } else if (method_.then == Then::kEnd) {
      End(absl::OkStatus());
    } else if (method_.then == Then::kRead) {
      Read();
    } else {
      Answer();  // to what has changed meanwhile
    }
  }

  void OnCancel() override {
    const std::lock_guard<std::mutex> lock(mutex_);
    End(absl::CancelledError("the client is gone"));
  }

  void OnDone() override {
    if (method_.then == Then::kWatch) shared_.watchers.Remove(this);
    std::shared_ptr<SmallCall> self;
    const std::lock_guard<std::mutex> lock(mutex_);
    self = std::move(self_);
  }

  void Changed() {
    const std::lock_guard<std::mutex> lock(mutex_);
    Answer();
  }

 private:
  // All that follows with the mutex locked. gRPC calls none of the On... functions from within a call to it.

  void Read() {
    if (ended_) return;
    StartRead(&in_);
    const std::weak_ptr<SmallCall> weak = weak_from_this();
    expected_ = shared_.in_flight.Expect(peer_, [weak](const absl::Status& status) {
      const auto call = weak.lock();
      if (!call) return;
      const std::lock_guard<std::mutex> lock(call->mutex_);
      call->End(status);
    });
  }

  // Sends the answer; to a watcher only where it is another one than the last.
  void Answer() {
    if (ended_ || writing_ || !request_) return;
    absl::StatusOr<std::string> answer = method_.answer(*request_);
    if (answer.ok() && method_.then == Then::kWatch && last_ == *answer) return;
    const absl::Status held = answer.ok() ? Hold(answer->size()) : answer.status();
    if (!held.ok()) {
      End(held);
      return;
    }
    const grpc::Slice slice(*answer);
    out_ = grpc::ByteBuffer(&slice, 1);
    if (method_.then == Then::kWatch) last_ = *std::move(answer);
    writing_ = true;
    SetLate();
    StartWrite(&out_);
  }

  absl::Status Hold(std::size_t bytes) {
    PM_ASSIGN_OR_RETURN(held_, shared_.in_flight.Take(bytes));
    return absl::OkStatus();
  }

  // Cuts the call off where its answer has not been taken in time.
  void SetLate() {
    const std::weak_ptr<SmallCall> weak = weak_from_this();
    const auto limit =
        std::chrono::milliseconds(static_cast<std::int64_t>(1000.0 * shared_.rules.write_seconds));
    late_.emplace().Set(std::chrono::system_clock::now() + limit, [weak](bool is_late) {
      const auto call = is_late ? weak.lock() : nullptr;
      if (!call) return;
      const std::lock_guard<std::mutex> lock(call->mutex_);
      if (call->writing_) call->context_->TryCancel();  // while it is written to, gRPC has the call
    });
  }

  void End(const absl::Status& status) {
    if (std::exchange(ended_, true)) return;
    Finish(ToGrpcStatus(status));
  }

  const SmallMethod& method_;
  SmallShared& shared_;
  grpc::CallbackServerContext* const context_;
  const std::string peer_;
  std::shared_ptr<SmallCall> self_;
  InFlight::Id expected_ = 0;
  grpc::ByteBuffer in_, out_;
  std::optional<grpc::Alarm> late_;  // one for each write: an alarm must not be set again before it has fired
  std::mutex mutex_;
  std::optional<std::string> request_;
  std::string last_;
  InFlight::Hold held_;
  bool writing_ = false, ended_ = false;
};

// To gRPC every method is one of two streams, as in raw_service.cc: so a call starts before its request is
// read.
class CallbackSmallService final : public SmallService {
 public:
  CallbackSmallService(std::vector<SmallMethod> methods, InFlight& in_flight, CallRules rules)
      : methods_(std::move(methods)), shared_{in_flight, std::move(rules), {}} {
    for (std::size_t k = 0; k < methods_.size(); ++k) {
      const SmallMethod& method = methods_[k];
      AddMethod(new grpc::internal::RpcServiceMethod(method.path.c_str(),
                                                     grpc::internal::RpcMethod::BIDI_STREAMING, nullptr));
      MarkMethodRawCallback(static_cast<int>(k),
                            new grpc::internal::CallbackBidiHandler<grpc::ByteBuffer, grpc::ByteBuffer>(
                                [&method, this](grpc::CallbackServerContext* c) {
                                  return SmallCall::Start(method, shared_, c);
                                }));
    }
  }

  void Changed() override {
    for (const auto& call : shared_.watchers.All()) call->Changed();
  }

 private:
  const std::vector<SmallMethod> methods_;
  SmallShared shared_;
};

}  // namespace

std::unique_ptr<SmallService> MakeSmallService(std::vector<SmallMethod> methods, InFlight& in_flight,
                                               CallRules rules) {
  return std::make_unique<CallbackSmallService>(std::move(methods), in_flight, std::move(rules));
}

}  // namespace patchmill
