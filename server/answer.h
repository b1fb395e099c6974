// The answer of a streaming job as it grows: one job writes it, any number of calls read it.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <variant>
#include <vector>

#include <absl/status/status.h>
#include <grpcpp/support/byte_buffer.h>

#include "server/memory_ledger.h"

namespace patchmill {

// The messages of an answer, in order, without progress.
using Messages = std::vector<grpc::ByteBuffer>;

class Answer {
 public:
  // As long as the messages have at most `kept_bytes` and the ledger has room for them, the whole answer is
  // kept, and any call may read it from its start. Beyond that, messages are dropped once all readers have
  // them, the job waits while a reader is more than limits::kAnswerAheadBytes behind, and no further call may
  // read. The ledger outlives the answer.
  Answer(std::size_t kept_bytes, MemoryLedger& ledger) : kept_bytes_(kept_bytes), ledger_(ledger) {}
  ~Answer();
  Answer(const Answer&) = delete;
  Answer& operator=(const Answer&) = delete;

  // For the job. Adds a message. False: nobody reads any more, or the job is to end.
  bool Write(grpc::ByteBuffer message);
  // The newest progress; it replaces the one before.
  void SetProgress(grpc::ByteBuffer progress);
  // No reader gets a progress from now on, not even one that is set already: the last messages follow.
  void EndProgress();
  void End(absl::Status status);

  // For a reader. Its place in the answer.
  class Reader;
  // Nothing if the beginning of the answer is dropped, or the job is to end.
  std::unique_ptr<Reader> Read();

  // Tells the job to end, because of `reason`. The readers get it as the end of the answer.
  void Stop(absl::Status reason);
  bool stopped() const;
  // Without readers since then; nothing while there are some.
  std::optional<std::chrono::steady_clock::time_point> alone_since() const;
  // All messages, if the answer has ended well and is whole.
  std::optional<Messages> whole() const;

 private:
  friend class Reader;
  struct Item {
    grpc::ByteBuffer bytes;
    bool counted = false;  // in the ledger
  };
  void Drop();  // messages that all readers have
  void DropFirst();
  std::size_t Behind() const;

  const std::size_t kept_bytes_;
  MemoryLedger& ledger_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Item> messages_;
  std::size_t dropped_ = 0, bytes_ = 0;  // messages dropped; bytes of all messages ever written
  bool keeps_ = true;
  grpc::ByteBuffer progress_;
  std::uint64_t progress_number_ = 0;
  bool progress_ended_ = false;
  std::vector<Reader*> readers_;
  std::optional<std::chrono::steady_clock::time_point> alone_since_ = std::chrono::steady_clock::now();
  bool stopped_ = false;
  std::optional<absl::Status> end_;
};

class Answer::Reader {
 public:
  explicit Reader(Answer& answer) : answer_(answer) {}
  ~Reader();
  Reader(const Reader&) = delete;
  Reader& operator=(const Reader&) = delete;

  struct Message {
    grpc::ByteBuffer bytes;
  };
  struct Progress {
    grpc::ByteBuffer bytes;
  };
  struct Nothing {};  // nothing new within the time
  // The next of the answer; its end comes last. Progress is only given if `progress` and no message is there.
  using Event = std::variant<Message, Progress, Nothing, absl::Status>;
  Event Next(bool progress, std::chrono::milliseconds wait);

 private:
  friend class Answer;
  Answer& answer_;
  std::size_t next_ = 0;
  std::uint64_t seen_progress_ = 0;
};

}  // namespace patchmill
