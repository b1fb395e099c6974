// Calls with bytes of the test's own making in place of a request.
#pragma once

#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <grpcpp/generic/generic_stub.h>
#include <grpcpp/grpcpp.h>

namespace patchmill::testing {

constexpr char kCheckModel[] = "/patchmill.v1.ModelService/CheckModel";
constexpr char kGenerateProgram[] = "/patchmill.v1.ToolpathService/GenerateProgram";

constexpr char kEvaluateSurface[] = "/patchmill.v1.AnalysisService/EvaluateSurface";
constexpr char kHealthCheck[] = "/grpc.health.v1.Health/Check";
constexpr char kHealthWatch[] = "/grpc.health.v1.Health/Watch";
constexpr char kReflection[] = "/grpc.reflection.v1alpha.ServerReflection/ServerReflectionInfo";

struct RawCallOptions {
  grpc_compression_algorithm compression = GRPC_COMPRESS_NONE;
  std::chrono::milliseconds timeout{60'000};
};

// The status of a call of that method; what it answers is dropped.
inline grpc::Status CallWithBytes(const std::shared_ptr<grpc::Channel>& channel, const std::string& method,
                                  const std::string& bytes, const RawCallOptions& options = {}) {
  grpc::TemplatedGenericStub<grpc::ByteBuffer, grpc::ByteBuffer> stub(channel);
  grpc::ClientContext context;
  context.set_deadline(std::chrono::system_clock::now() + options.timeout);
  context.set_compression_algorithm(options.compression);
  grpc::Slice slice(bytes);
  const grpc::ByteBuffer request(&slice, 1);
  grpc::CompletionQueue queue;
  const auto reader = stub.PrepareUnaryCall(&context, method, request, &queue);
  reader->StartCall();
  grpc::ByteBuffer response;
  grpc::Status status;
  reader->Finish(&response, &status, nullptr);
  void* tag = nullptr;
  bool ok = false;
  queue.Next(&tag, &ok);
  return status;
}

// A call that is written to and read from message by message, of 30 s at most.
class RawStream {
 public:
  RawStream(const std::shared_ptr<grpc::Channel>& channel, const std::string& method) : stub_(channel) {
    context_.set_deadline(std::chrono::system_clock::now() + std::chrono::seconds(30));
    call_ = stub_.PrepareCall(&context_, method, &queue_);
    call_->StartCall(nullptr);
    Next();
  }
  ~RawStream() {
    if (ended_) return;
    context_.TryCancel();
    End();
  }
  RawStream(const RawStream&) = delete;

  bool Write(const std::string& bytes) {
    grpc::Slice slice(bytes);
    call_->Write(grpc::ByteBuffer(&slice, 1), nullptr);
    return Next();
  }
  // Whether the server has begun to answer. Nothing of the answer is read.
  bool Answered() {
    call_->ReadInitialMetadata(nullptr);
    return Next();
  }
  std::optional<std::string> Read() {
    grpc::ByteBuffer response;
    call_->Read(&response, nullptr);
    std::vector<grpc::Slice> slices;
    if (!Next() || !response.Dump(&slices).ok()) return std::nullopt;
    std::string bytes;
    for (const grpc::Slice& slice : slices)
      bytes.append(reinterpret_cast<const char*>(slice.begin()), slice.size());
    return bytes;
  }
  void Cancel() { context_.TryCancel(); }
  void WritesDone() {
    call_->WritesDone(nullptr);
    Next();
  }
  grpc::Status End() {
    WritesDone();
    return Finish();
  }
  grpc::Status Finish() {
    ended_ = true;
    grpc::Status status;
    call_->Finish(&status, nullptr);
    Next();
    return status;
  }

 private:
  bool Next() {
    void* tag = nullptr;
    bool ok = false;
    return queue_.Next(&tag, &ok) && ok;
  }

  grpc::TemplatedGenericStub<grpc::ByteBuffer, grpc::ByteBuffer> stub_;
  grpc::ClientContext context_;
  grpc::CompletionQueue queue_;
  std::unique_ptr<grpc::ClientAsyncReaderWriter<grpc::ByteBuffer, grpc::ByteBuffer>> call_;
  bool ended_ = false;
};

inline std::string LengthDelimited(int field, const std::string& bytes) {
  std::string out(1, static_cast<char>(field << 3 | 2));
  std::size_t size = bytes.size();
  for (; size > 127; size >>= 7) out += static_cast<char>((size & 127) | 128);
  return out + static_cast<char>(size) + bytes;
}

inline std::string Repeated(const std::string& bytes, std::size_t times) {
  std::string all;
  all.reserve(bytes.size() * times);
  for (std::size_t k = 0; k < times; ++k) all += bytes;
  return all;
}

// A job of that many empty operations, as GenerateProgram takes it.
inline std::string BombOfOperations(std::size_t operations) {
  return LengthDelimited(1, Repeated(std::string("\x1A\x00", 2), operations));
}

}  // namespace patchmill::testing
